"""Variants by mechanism, and the head of a case file."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...machine.crank import Crank, Rotor
from ...machine.friction import COEFFICIENT, RollerFriction
from ...machine.groups.lever import LeverGroup
from ...machine.groups.rocker import RockerGroup
from ...machine.groups.slider import SliderGroup
from ...machine.groups.yoke import YokeGroup
from ...machine.loads import ProcessForce
from ...numbers import checks
from ...numbers.units import quoted
from .drives import DriveTable
from .parts import Groups, Loads, field_of
from .tables import BalancingTable, Cam, GravityTable, LinkTable, RollerTable, Table, value_in
from .texts import (
    Angle,
    AngularAcceleration,
    Coordinate,
    CubicStiffness,
    GuidePoints,
    Length,
    Mass,
    Period,
    Point,
    Sampling,
    Sense,
    Speed,
    Stiffness,
    value_reader,
)

SliderAssembly = Annotated[Any, BeforeValidator(value_reader(SliderGroup.RULES.rules["assembly"]))]
RockerAssembly = Annotated[Any, BeforeValidator(value_reader(RockerGroup.RULES.rules["assembly"]))]
LeverAssembly = Annotated[Any, BeforeValidator(value_reader(LeverGroup.RULES.rules["assembly"]))]
Reaction = Annotated[Any, BeforeValidator(value_reader(ProcessForce.RULES.rules["reaction"]))]
Name = Annotated[Any, BeforeValidator(value_reader(checks.Name()))]
Bearings = field_of(Crank.RULES.rules["bearings"])
Plane, CoupleUnbalance = (field_of(Rotor.RULES.rules[name]) for name in ("plane", "couple_unbalance"))


class SpringTable(Table):
    stiffness: Stiffness
    """Of all springs; "balance the slider": its mass times crank speed squared at their end."""
    free_position: Coordinate
    """Coordinate of the slider's pin along its guide at which they are free."""
    cubic: CubicStiffness = 0.0
    """The force grows by so much times the cube of the elongation."""
    mass: Mass = 0.0
    """Of all springs together: a third moves with the slider, half of it shakes the frame."""


class ProcessForceTable(Table):
    force: value_in("N") | None = None  # type: ignore[valid-type]
    """On the slider, positive in the direction of its guide; or a file of values."""
    table: str | None = None
    """CSV file of crank angle and force."""
    period: Period = None
    """Crank angle after which that table repeats: one turn unless told."""
    reaction: Reaction = "outside"
    """What takes the opposite force: "outside", or the "frame" of the machine."""

    @model_validator(mode="after")
    def _one_of_two(self):
        if (self.force is None) == (self.table is None):
            raise ValueError('needs either force, such as "-2 kN", or table, a CSV file by crank angle')
        if self.period is not None and self.table is None:
            raise ValueError("has a period, but no table: only a table repeats after one")
        return self


def _coefficient(value):
    number = isinstance(value, int | float) and not isinstance(value, bool)
    found, problem = COEFFICIENT.check(float(value) if number else value, "")
    if problem or not number:
        raise ValueError(f"must be a number of at least 0, such as 0.1, found {quoted(value)}")
    return found


class FrictionTable(Table):
    """Friction at a joint; its keys tell its kind, which must be that of the joint."""

    mu: Annotated[float, BeforeValidator(_coefficient), "1"]
    """Coefficient of friction."""
    radius: Length | None = None
    """Of a pin."""
    half_length: Length | None = None
    """Half the length of the shoe in a guide or slot, so that its couple rubs too."""
    pin_radius: Length | None = None
    """Of the pin of a cam roller."""
    roller_radius: Length | None = None
    """Of a cam roller."""
    rolling_arm: field_of(RollerFriction.RULES.rules["rolling_arm"]) | None = None  # type: ignore[valid-type]
    """Arm of rolling friction of a cam roller: the cam's force acts by so much ahead of the contact."""


class MechanismVariant(Table):
    """Keys common to every mechanism."""

    reference: Name | None = None
    """Variant that this one is compared with, the case's unless told; one that names itself is compared with none."""
    crank_speed: Speed
    """Counter-clockwise; negative turns clockwise."""
    crank_acceleration: AngularAcceleration = 0.0
    """Counter-clockwise."""
    sense: Sense | None = None
    """Which way a crank at rest is about to turn: 1 counter-clockwise, -1 clockwise."""
    crank: LinkTable = LinkTable()
    """Mass properties, from O along the crank."""
    gravity: GravityTable | None = None
    """Weight; without it there is none. An empty table: 9.81 m/s^2 straight down (standard: 9.80665)."""
    balancing: BalancingTable | None = None
    """Counterweights to be found."""
    drive: DriveTable | None = None
    """Motor and flywheel."""
    loads: Loads = ()
    """A table for each load, under [[common.loads]] or [[variants.NAME.loads]]."""
    friction: dict[str, FrictionTable] = Field(default_factory=dict)
    """A table for each joint that rubs, by its name: O, A, B, guide, slot, cam; contact of a roller follower."""


class RotorTable(LinkTable):
    plane: Plane | None = None  # type: ignore[valid-type]
    """Position of the mass centre along the crankshaft."""
    couple_unbalance: CoupleUnbalance | None = None  # type: ignore[valid-type]
    """Sum of mass times distance from that plane times (along, across)."""


class ChainVariant(MechanismVariant):
    """A crank and whatever groups hang on it."""

    mechanism: Literal["chain"] = "chain"
    """A crank and the groups that hang on it."""
    name: Name = "chain"
    """What messages call the mechanism."""
    crank_length: Length | None = None
    """O to A; left out where a cam roller sits on a slotted crank, or a follower on a cam alone."""
    crank: RotorTable = RotorTable()
    """Mass properties, from O along the crank."""
    bearings: Bearings | None = None  # type: ignore[valid-type]
    """Positions of the left and right main bearing along the crankshaft."""
    groups: Groups
    """A table for each group, in the order in which motion flows: [[common.groups]]."""


class GuideVariant(MechanismVariant):
    """Keys common to every mechanism of one slider."""

    guide_angle: Angle | None = None
    """Direction of the guide, from +x."""
    guide_offset: Coordinate | None = None
    """Distance of the guide from O, to the left of its direction."""
    guide_through: GuidePoints | None = None
    """Two points that the guide runs through, in place of angle and offset."""
    slider: LinkTable = LinkTable()
    """Mass properties of the slider, from B along the guide."""
    spring: SpringTable | None = None
    """Springs along the guide."""
    process_force: ProcessForceTable | None = None
    """Force on the slider along the guide."""


class SliderVariant(GuideVariant):
    """Keys common to every mechanism that ends in a slider group."""

    assembly: SliderAssembly = 1
    """1: slider ahead of A along the guide, -1: behind; the words go on through change points."""
    coupler: LinkTable = LinkTable()
    """Mass properties of the coupler, from A toward B."""


class CrankSliderVariant(SliderVariant):
    mechanism: Literal["crank-slider"]
    """Crank O-A, coupler A-B, slider B on a guide."""
    crank_length: Length
    """O to A."""
    coupler_length: Length
    """A to B."""


class CamVariant(SliderVariant):
    mechanism: Literal["cam-crank-slider"]
    """Slotted crank, block with a roller on a fixed cam, coupler and slider."""
    cam: Cam
    """The path of the roller centre A about O."""
    coupler_length: Length | None = None
    """A to B; left out for a cosine-law cam, whose mean it then is."""
    block: LinkTable = LinkTable()
    """Mass properties of block and roller, from A along the crank."""
    roller: RollerTable | None = None
    """Size and material of the roller, for its contact pressure."""


class RockerVariant(MechanismVariant):
    """Keys common to every four-bar."""

    crank_length: Length
    """O to A."""
    coupler_length: Length
    """A to B."""
    rocker_length: Length
    """O2 to B."""
    assembly: RockerAssembly = 1
    """1: B to the left of the direction from A to O2, -1: right; the words go on through change points."""
    coupler: LinkTable = LinkTable()
    """Mass properties of the coupler, from A toward B."""
    rocker: LinkTable = LinkTable()
    """Mass properties of the rocker, from O2 toward B."""


class FourBarVariant(RockerVariant):
    mechanism: Literal["four-bar"]
    """Crank O-A, coupler A-B, rocker O2-B."""
    rocker_pivot: Point
    """O2."""


class ChainUnitVariant(RockerVariant):
    mechanism: Literal["chain-unit"]
    """A four-bar with O2 as far below O as the rocker is long."""
    pivot_x: Length | None = None
    """x of O2; left out, crank and rocker are parallel as the crank points along +y."""


class SlottedLeverVariant(MechanismVariant):
    mechanism: Literal["slotted-lever"]
    """Crank O-A, block at A sliding in a lever about O2."""
    crank_length: Length
    """O to A."""
    lever_pivot: Point
    """O2."""
    slot_offset: Coordinate = 0.0
    """Of the slot's axis to the left of the pivot."""
    assembly: LeverAssembly = 1
    """1: the slot points to the block, -1: away from it; the words go on through change points."""
    lever: LinkTable = LinkTable()
    """Mass properties of the lever, from O2 along the slot."""
    block: LinkTable = LinkTable()
    """Mass properties of the block, from A along the slot."""


class ScotchYokeVariant(GuideVariant):
    mechanism: Literal["scotch-yoke"]
    """Crank O-A, block at A in the slot of a slider."""
    crank_length: Length
    """O to A."""
    slot_angle: Angle = YokeGroup.slot_angle
    """From the guide's direction."""
    block: LinkTable = LinkTable()
    """Mass properties of the block, from A along the slot."""


class PublishedTable(Table):
    """Published figures as printed, by the row of the comparison table they belong beside.

    `ratio` holds those of reference / balanced, `value` those of the balanced mechanism; `balancing` those of the
    balancing table, for every variant and link, taken at a crank-angle step of `sampling`; `linkage` those of the
    four-bar table, for every variant. `where` names the table or figure that prints them, `note` says how to read them
    beside ours, `figures` which figure of the source each of ours redraws.
    """

    ratio: dict[str, str] = Field(default_factory=dict)
    """Of reference / this variant, by the row of the comparison that they belong beside."""
    value: dict[str, str] = Field(default_factory=dict)
    """Of the balanced mechanism, by row."""
    sampling: Sampling = None
    """Step of the crank angle at which a study took its largest forces."""
    balancing: dict[str, dict[str, str]] = Field(default_factory=dict)
    """Of the balancing table: by row, then by variant and link."""
    linkage: dict[str, dict[str, str]] = Field(default_factory=dict)
    """Of the four-bar table: by row, then by variant."""
    where: str = ""
    """The table or figure of the source that prints them, "table 1"."""
    note: str = ""
    """How to read them beside ours."""
    figures: dict[str, str] = Field(default_factory=dict)
    """Which figure of the source each of ours redraws, by the name of ours: torque = "6a"."""


class CaseTable(Table):
    """The head of a case file; its variants are read one by one with what they have in common, so are its designs."""

    title: str
    """Of all that is drawn and printed."""
    source: str = ""
    """Where the numbers come from."""
    reference: str
    """Name of the variant that others are compared with, unless they name one of their own."""
    common: dict = Field(default_factory=dict)
    """What all variants have in common; a variant may give any of it anew."""
    variants: dict[str, dict] = Field(min_length=1)
    """By name, a table of what each has of its own: [variants.NAME]."""
    published: PublishedTable = PublishedTable()
    """Published figures, shown beside ours."""
    tolerances: dict[str, str] = Field(default_factory=dict)
    """How numbers spread, by path."""
    design: dict[str, dict] = Field(default_factory=dict)
    """By name, what is to be found: [design.NAME]."""
    sizing: dict[str, dict] = Field(default_factory=dict)
    """By name, a part that forces size: [sizing.NAME], with its kind and the arguments of its function."""


VARIANTS = {
    "crank-slider": CrankSliderVariant,
    "cam-crank-slider": CamVariant,
    "four-bar": FourBarVariant,
    "chain-unit": ChainUnitVariant,
    "slotted-lever": SlottedLeverVariant,
    "scotch-yoke": ScotchYokeVariant,
    "chain": ChainVariant,
}

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
    """Stiffness of all springs; "balance the slider": its mass times crank speed squared, at their end."""
    free_position: Coordinate
    """Coordinate of the slider's pin along its guide at which they are free."""
    cubic: CubicStiffness = 0.0
    """Factor of the cube of the elongation in the force."""
    mass: Mass = 0.0
    """Mass of all springs: a third moves with the slider, half of it shakes the frame."""


class ProcessForceTable(Table):
    force: value_in("N") | None = None  # type: ignore[valid-type]
    """On the slider, positive in the direction of its guide; or a file of values."""
    table: str | None = None
    """CSV file of crank angle and force."""
    period: Period = None
    """Crank angle after which the table repeats; by default one turn."""
    reaction: Reaction = "outside"
    """Body that takes the opposite force: "outside", or the "frame" of the machine."""

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
    """Friction at a joint; its keys give its kind, which must suit the joint."""

    mu: Annotated[float, BeforeValidator(_coefficient), "1"]
    """Coefficient of friction."""
    radius: Length | None = None
    """Radius of a pin."""
    half_length: Length | None = None
    """Half the length of the shoe in a guide or slot, to include friction from its couple."""
    pin_radius: Length | None = None
    """Radius of the pin of a cam roller."""
    roller_radius: Length | None = None
    """Radius of a cam roller."""
    rolling_arm: field_of(RollerFriction.RULES.rules["rolling_arm"]) | None = None  # type: ignore[valid-type]
    """Arm of rolling friction of a cam roller: distance of the cam's force ahead of the contact."""


class MechanismVariant(Table):
    """Keys common to every mechanism."""

    reference: Name | None = None
    """Reference of this variant, by default the case's; a variant that names itself has no reference."""
    crank_speed: Speed
    """Crank speed, positive counter-clockwise."""
    crank_acceleration: AngularAcceleration = 0.0
    """Counter-clockwise."""
    sense: Sense | None = None
    """Sense in which a crank at rest is about to turn: 1 counter-clockwise, -1 clockwise."""
    crank: LinkTable = LinkTable()
    """Mass properties, from O along the crank."""
    gravity: GravityTable | None = None
    """Weight, absent without this table. An empty table: 9.81 m/s^2 straight down (standard: 9.80665)."""
    balancing: BalancingTable | None = None
    """Counterweights to compute."""
    drive: DriveTable | None = None
    """Motor and flywheel."""
    loads: Loads = ()
    """A table for each load, under [[common.loads]] or [[variants.NAME.loads]]."""
    friction: dict[str, FrictionTable] = Field(default_factory=dict)
    """A table for each joint with friction, by name: O, A, B, guide, slot, cam; contact of a roller follower."""


class RotorTable(LinkTable):
    plane: Plane | None = None  # type: ignore[valid-type]
    """Position of the mass centre along the crankshaft."""
    couple_unbalance: CoupleUnbalance | None = None  # type: ignore[valid-type]
    """Sum of mass times distance from that plane times (along, across)."""


class ChainVariant(MechanismVariant):
    """A crank and any groups attached to it."""

    mechanism: Literal["chain"] = "chain"
    """A crank and the groups attached to it."""
    name: Name = "chain"
    """Name of the mechanism in messages."""
    crank_length: Length | None = None
    """Distance O to A; absent for a cam roller on a slotted crank, or with only followers."""
    crank: RotorTable = RotorTable()
    """Mass properties, from O along the crank."""
    bearings: Bearings | None = None  # type: ignore[valid-type]
    """Positions of the left and right main bearing along the crankshaft."""
    groups: Groups
    """A table for each group, in the order of motion: [[common.groups]]."""


class GuideVariant(MechanismVariant):
    """Keys common to every mechanism of one slider."""

    guide_angle: Angle | None = None
    """Direction of the guide, from +x."""
    guide_offset: Coordinate | None = None
    """Distance of the guide from O, to the left of its direction."""
    guide_through: GuidePoints | None = None
    """Two points of the guide, instead of angle and offset."""
    slider: LinkTable = LinkTable()
    """Mass properties of the slider, from B along the guide."""
    spring: SpringTable | None = None
    """Springs along the guide."""
    process_force: ProcessForceTable | None = None
    """Force on the slider along the guide."""


class SliderVariant(GuideVariant):
    """Keys common to every mechanism that ends in a slider group."""

    assembly: SliderAssembly = 1
    """1: slider ahead of A along the guide, -1: behind; the words pass change points."""
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
    """Distance A to B; by default determined by a cosine-law cam."""
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
    """1: B to the left of the direction from A to O2, -1: right; the words pass change points."""
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
    """x of O2; by default crank and rocker are parallel when the crank points along +y."""


class SlottedLeverVariant(MechanismVariant):
    mechanism: Literal["slotted-lever"]
    """Crank O-A, block at A sliding in a lever about O2."""
    crank_length: Length
    """O to A."""
    lever_pivot: Point
    """O2."""
    slot_offset: Coordinate = 0.0
    """Distance of the slot's axis to the left of the pivot."""
    assembly: LeverAssembly = 1
    """1: the slot points to the block, -1: away from it; the words pass change points."""
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
    """Angle of the slot from the guide's direction."""
    block: LinkTable = LinkTable()
    """Mass properties of the block, from A along the slot."""


class PublishedTable(Table):
    """Published figures as printed, by row of the comparison table.

    `ratio` are ratios reference / balanced, `value` values of the balanced mechanism. `balancing` are figures of the
    balancing table, for every variant and link, at a crank-angle step of `sampling`. `linkage` are figures of the
    four-bar table, for every variant. `where` names the printed table or figure, `note` is a remark on the comparison
    with ours, `figures` maps our figures to those of the source.
    """

    ratio: dict[str, str] = Field(default_factory=dict)
    """Ratios reference / this variant, by row of the comparison."""
    value: dict[str, str] = Field(default_factory=dict)
    """Values of the balanced mechanism, by row."""
    sampling: Sampling = None
    """Step of the crank angle in the study's search for largest forces."""
    balancing: dict[str, dict[str, str]] = Field(default_factory=dict)
    """Figures of the balancing table: by row, then by variant and link."""
    linkage: dict[str, dict[str, str]] = Field(default_factory=dict)
    """Figures of the four-bar table: by row, then by variant."""
    where: str = ""
    """The table or figure of the source that prints them, "table 1"."""
    note: str = ""
    """Remark on their comparison with ours."""
    figures: dict[str, str] = Field(default_factory=dict)
    """Figure of the source for each of our figures, by name: torque = "6a"."""


class CaseTable(Table):
    """Top level of a case file. Each variant and design inherits [common] and is read separately."""

    title: str
    """Title of figures and printed results."""
    source: str = ""
    """Source of the numbers."""
    reference: str
    """Name of the reference variant of all variants that do not name their own."""
    common: dict = Field(default_factory=dict)
    """Keys shared by all variants; a variant may override each of them."""
    variants: dict[str, dict] = Field(min_length=1)
    """Tables of the variants' own keys, by name: [variants.NAME]."""
    published: PublishedTable = PublishedTable()
    """Published figures, shown with ours."""
    tolerances: dict[str, str] = Field(default_factory=dict)
    """Spread of numbers, by path."""
    design: dict[str, dict] = Field(default_factory=dict)
    """Searches, by name: [design.NAME]."""
    sizing: dict[str, dict] = Field(default_factory=dict)
    """Parts to be sized, by name: [sizing.NAME], with kind and arguments of the function."""


VARIANTS = {
    "crank-slider": CrankSliderVariant,
    "cam-crank-slider": CamVariant,
    "four-bar": FourBarVariant,
    "chain-unit": ChainUnitVariant,
    "slotted-lever": SlottedLeverVariant,
    "scotch-yoke": ScotchYokeVariant,
    "chain": ChainVariant,
}

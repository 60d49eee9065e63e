"""Variants by their mechanism, and the head of a case file."""

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from ...machine.friction import COEFFICIENT
from ...machine.lever_group import LeverGroup
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.yoke_group import YokeGroup
from ...numbers import checks
from ...numbers.units import shown
from .drives import DriveTable
from .parts import Groups, Loads, by
from .tables import BalancingTable, Cam, GravityTable, LinkTable, RollerTable, Table, value_in
from .texts import (
    Angle,
    AngularAcceleration,
    Coordinate,
    CubicStiffness,
    GuidePoints,
    Length,
    Period,
    Point,
    Sampling,
    Speed,
    Stiffness,
)

SliderAssembly = Annotated[Any, BeforeValidator(by(SliderGroup.RULES.rules["assembly"]))]
RockerAssembly = Annotated[Any, BeforeValidator(by(RockerGroup.RULES.rules["assembly"]))]
LeverAssembly = Annotated[Any, BeforeValidator(by(LeverGroup.RULES.rules["assembly"]))]
Name = Annotated[Any, BeforeValidator(by(checks.Name()))]


class SpringTable(Table):
    stiffness: Stiffness
    free_position: Coordinate
    cubic: CubicStiffness = 0.0


class ProcessForceTable(Table):
    force: value_in("N") | None = None  # type: ignore[valid-type]
    table: str | None = None
    period: Period = None

    @model_validator(mode="after")
    def _one_of_two(self):
        if (self.force is None) == (self.table is None):
            raise ValueError('needs either force, such as "-2 kN", or table, a CSV file by crank angle')
        if self.period is not None and self.table is None:
            raise ValueError("has a period, but no table: only a table repeats after one")
        return self


def _coefficient(value):
    number = isinstance(value, int | float) and not isinstance(value, bool)
    found, problem = COEFFICIENT.taken(float(value) if number else value, "")
    if problem or not number:
        raise ValueError(f"must be a number of at least 0, such as 0.1, found {shown(value)}")
    return found


class FrictionTable(Table):
    """Friction at a joint; its keys tell its kind, which must be that of the joint."""

    mu: Annotated[float, BeforeValidator(_coefficient), "1"]
    radius: Length | None = None
    half_length: Length | None = None
    pin_radius: Length | None = None
    roller_radius: Length | None = None


class MechanismVariant(Table):
    """Keys common to every mechanism."""

    crank_speed: Speed
    crank_acceleration: AngularAcceleration = 0.0
    crank: LinkTable = LinkTable()
    gravity: GravityTable | None = None
    balancing: BalancingTable | None = None
    drive: DriveTable | None = None
    loads: Loads = ()
    friction: dict[str, FrictionTable] = Field(default_factory=dict)


class ChainVariant(MechanismVariant):
    """A crank and whatever groups hang on it."""

    mechanism: Literal["chain"] = "chain"
    name: Name = "chain"
    crank_length: Length | None = None
    groups: Groups


class GuideVariant(MechanismVariant):
    """Keys common to every mechanism of one slider."""

    guide_angle: Angle | None = None
    guide_offset: Coordinate | None = None
    guide_through: GuidePoints | None = None
    slider: LinkTable = LinkTable()
    spring: SpringTable | None = None
    process_force: ProcessForceTable | None = None


class SliderVariant(GuideVariant):
    """Keys common to every mechanism that ends in a slider group."""

    assembly: SliderAssembly = 1
    coupler: LinkTable = LinkTable()


class CrankSliderVariant(SliderVariant):
    mechanism: Literal["crank-slider"]
    crank_length: Length
    coupler_length: Length


class CamVariant(SliderVariant):
    mechanism: Literal["cam-crank-slider"]
    cam: Cam
    coupler_length: Length | None = None
    block: LinkTable = LinkTable()
    roller: RollerTable | None = Field(None, description="size and material of the roller, for its contact pressure")


class RockerVariant(MechanismVariant):
    """Keys common to every four-bar."""

    crank_length: Length
    coupler_length: Length
    rocker_length: Length
    assembly: RockerAssembly = 1
    coupler: LinkTable = LinkTable()
    rocker: LinkTable = LinkTable()


class FourBarVariant(RockerVariant):
    mechanism: Literal["four-bar"]
    rocker_pivot: Point


class ChainUnitVariant(RockerVariant):
    mechanism: Literal["chain-unit"]
    pivot_x: Length | None = None


class SlottedLeverVariant(MechanismVariant):
    mechanism: Literal["slotted-lever"]
    crank_length: Length
    lever_pivot: Point
    slot_offset: Coordinate = 0.0
    assembly: LeverAssembly = 1
    lever: LinkTable = LinkTable()
    block: LinkTable = LinkTable()


class ScotchYokeVariant(GuideVariant):
    mechanism: Literal["scotch-yoke"]
    crank_length: Length
    slot_angle: Angle = YokeGroup.slot_angle
    block: LinkTable = LinkTable()


class PublishedTable(Table):
    """Published figures as printed, by the row of the comparison table they belong beside.

    `ratio` holds those of reference / balanced, `value` those of the balanced mechanism; `balancing` those of the
    balancing table, for every variant and link, taken at a crank-angle step of `sampling`; `linkage` those of the
    four-bar table, for every variant. `note` says how to read them beside ours.
    """

    ratio: dict[str, str] = Field(default_factory=dict)
    value: dict[str, str] = Field(default_factory=dict)
    sampling: Sampling = None
    balancing: dict[str, dict[str, str]] = Field(default_factory=dict)
    linkage: dict[str, dict[str, str]] = Field(default_factory=dict)
    note: str = ""


class CaseTable(Table):
    """The head of a case file; its variants are read one by one with what they have in common, so are its designs."""

    title: str
    source: str = ""
    reference: str
    common: dict = Field(default_factory=dict)
    variants: dict[str, dict] = Field(min_length=1)
    published: PublishedTable = PublishedTable()
    tolerances: dict[str, str] = Field(default_factory=dict)
    design: dict[str, dict] = Field(default_factory=dict)


VARIANTS = {
    "crank-slider": CrankSliderVariant,
    "cam-crank-slider": CamVariant,
    "four-bar": FourBarVariant,
    "chain-unit": ChainUnitVariant,
    "slotted-lever": SlottedLeverVariant,
    "scotch-yoke": ScotchYokeVariant,
    "chain": ChainVariant,
}

"""What a case file may hold, as pydantic models: keys, units, allowed values. `case` turns them into mechanisms."""

import math
from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from ..design.balancing import RATIOS
from ..machine.loads import WholeTurns
from ..numbers.checks import choice
from ..numbers.units import shown, to_si


def _reader(unit, *, low=None, strict=False):
    """Function that reads text with a unit, within bounds."""

    def read(text):
        value = to_si(text, unit)
        if low is not None and (value <= low if strict else value < low):
            raise ValueError(f"must be {'greater than' if strict else 'at least'} {low:g} {unit}, found {text!r}")
        return value

    return read


# each type ends with its SI unit, by which `parameters` finds what a design may vary
Length = Annotated[float, BeforeValidator(_reader("m", low=0.0, strict=True)), "m"]
Coordinate = Annotated[float, BeforeValidator(_reader("m")), "m"]
Angle = Annotated[float, BeforeValidator(_reader("rad")), "rad"]
Mass = Annotated[float, BeforeValidator(_reader("kg", low=0.0)), "kg"]
Inertia = Annotated[float, BeforeValidator(_reader("kg m^2", low=0.0)), "kg m^2"]
Force = Annotated[float, BeforeValidator(_reader("N")), "N"]
Speed = Annotated[float, BeforeValidator(_reader("rad/s")), "rad/s"]
AngularAcceleration = Annotated[float, BeforeValidator(_reader("rad/s^2")), "rad/s^2"]
GravityAcceleration = Annotated[float, BeforeValidator(_reader("m/s^2", low=0.0)), "m/s^2"]

_STIFFNESS = _reader("N/m", low=0.0)
_COORDINATE = _reader("m")
MID_LENGTH = "mid-length"
BALANCE_THE_SLIDER = "balance the slider"


def _or_words(words, read, text):
    try:
        return read(text)
    except ValueError as error:
        raise ValueError(f'{error}; or write "{words}"') from None


def _stiffness(text):
    return text if text == BALANCE_THE_SLIDER else _or_words(BALANCE_THE_SLIDER, _STIFFNESS, text)


def _point(value):
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f'must be a pair such as ["10 mm", "0 mm"], found {shown(value)}')
    return tuple(to_si(part, "m") for part in value)


def _centre(value):
    if isinstance(value, str) and value == MID_LENGTH:
        return value
    return _point(value) if isinstance(value, list) else (_or_words(MID_LENGTH, _COORDINATE, value), 0.0)


def _sampling(text):
    value = to_si(text, "rad")
    if not math.radians(0.001) <= value <= math.pi:
        raise ValueError(f"must be a step of the crank angle from 0.001 to 180 deg, found {text!r}")
    return value


def _sign(value):
    if isinstance(value, bool):
        raise ValueError(f'must be 1, -1, "open" or "crossed", found {value!r}')
    return value


def _two_points(value):
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f'must be two points such as [["0 m", "0 m"], ["1 m", "0 m"]], found {shown(value)}')
    return tuple(_point(part) for part in value)


def _period(text):
    period, problem = WholeTurns().taken(to_si(text, "rad"))
    if problem:
        raise ValueError(f'must be a whole number of turns, such as "720 deg", found {text!r}')
    return period


Weight = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0)]
Point = Annotated[tuple[float, float], BeforeValidator(_point), "m"]
GuidePoints = Annotated[tuple[tuple[float, float], ...], BeforeValidator(_two_points)]
Centre = Annotated[tuple[float, float] | str, BeforeValidator(_centre), "m"]


class Table(BaseModel):
    """A table of a case file: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class LinkTable(Table):
    mass: Mass = 0.0
    centre: Centre = (0.0, 0.0)
    inertia: Inertia = 0.0


class GravityTable(Table):
    acceleration: GravityAcceleration = 9.81
    direction: Angle = -math.pi / 2


class SpringTable(Table):
    stiffness: Annotated[float | str, BeforeValidator(_stiffness), "N/m"]
    free_position: Coordinate


class ProcessForceTable(Table):
    force: Force | None = None
    table: str | None = None
    period: Annotated[float | None, BeforeValidator(_period)] = None

    @model_validator(mode="after")
    def _one_of_two(self):
        if (self.force is None) == (self.table is None):
            raise ValueError('needs either force, such as "-2 kN", or table, a CSV file by crank angle')
        if self.period is not None and self.table is None:
            raise ValueError("has a period, but no table: only a table repeats after one")
        return self


class CircleTable(Table):
    kind: Literal["circle"]
    radius: Length
    centre: Point = (0.0, 0.0)


class CosineLawTable(Table):
    kind: Literal["cosine-law"]
    amplitude: Length
    mean: Length


class SampledTable(Table):
    kind: Literal["sampled"]
    table: str


def _ratio(value):
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    problem = None if number else choice("ratio", value, tuple(RATIOS))
    if problem:
        raise ValueError(f"must be a number or a name: {problem}")
    return value


class CounterweightTable(Table):
    mass: Mass | None = None
    arm: Coordinate | None = None
    whole_link: Annotated[bool, Field(strict=True)] = False
    largest_mass: Mass | None = None
    largest_arm: Length | None = None
    keep_out: Length | None = None


class BalancingTable(Table):
    method: Literal["full", "partial", "optimal"]
    ratio: Annotated[float | str, BeforeValidator(_ratio)] = "overall"
    norm: Literal["largest", "mean", "along", "across", "weighted"] = "largest"
    weights: tuple[Weight, Weight] = (1.0, 0.0)
    phase: Annotated[bool, Field(strict=True)] = False
    crank: CounterweightTable | None = None
    coupler: CounterweightTable | None = None
    rocker: CounterweightTable | None = None


class MechanismVariant(Table):
    """Keys common to every mechanism."""

    crank_speed: Speed
    crank_acceleration: AngularAcceleration = 0.0
    assembly: Annotated[Literal[1, -1, "open", "crossed"], BeforeValidator(_sign)] = 1
    crank: LinkTable = LinkTable()
    coupler: LinkTable = LinkTable()
    gravity: GravityTable | None = None
    balancing: BalancingTable | None = None


class SliderVariant(MechanismVariant):
    """Keys common to every mechanism that ends in a slider group."""

    guide_angle: Angle | None = None
    guide_offset: Coordinate | None = None
    guide_through: GuidePoints | None = None
    slider: LinkTable = LinkTable()
    spring: SpringTable | None = None
    process_force: ProcessForceTable | None = None


class CrankSliderVariant(SliderVariant):
    mechanism: Literal["crank-slider"]
    crank_length: Length
    coupler_length: Length


class FourBarVariant(MechanismVariant):
    mechanism: Literal["four-bar"]
    crank_length: Length
    coupler_length: Length
    rocker_length: Length
    rocker_pivot: Point
    rocker: LinkTable = LinkTable()


class ChainUnitVariant(MechanismVariant):
    mechanism: Literal["chain-unit"]
    crank_length: Length
    coupler_length: Length
    rocker_length: Length
    pivot_x: Length | None = None
    rocker: LinkTable = LinkTable()


CAM_KINDS = ("circle", "cosine-law", "sampled")


class CamVariant(SliderVariant):
    mechanism: Literal["cam-crank-slider"]
    cam: Annotated[CircleTable | CosineLawTable | SampledTable, Field(discriminator="kind")]
    coupler_length: Length | None = None
    block: LinkTable = LinkTable()


class PublishedTable(Table):
    """Published figures as printed, by the row of the comparison table they belong beside.

    `ratio` holds those of reference / balanced, `value` those of the balanced mechanism; `balancing` those of the
    balancing table, for every variant and link, taken at a crank-angle step of `sampling`; `linkage` those of the
    four-bar table, for every variant. `note` says how to read them beside ours.
    """

    ratio: dict[str, str] = Field(default_factory=dict)
    value: dict[str, str] = Field(default_factory=dict)
    sampling: Annotated[float | None, BeforeValidator(_sampling)] = None
    balancing: dict[str, dict[str, str]] = Field(default_factory=dict)
    linkage: dict[str, dict[str, str]] = Field(default_factory=dict)
    note: str = ""


class CaseTable(Table):
    """The head of a case file; its variants are read one by one with what they have in common."""

    title: str
    source: str = ""
    reference: str
    common: dict = Field(default_factory=dict)
    variants: dict[str, dict] = Field(min_length=1)
    published: PublishedTable = PublishedTable()
    tolerances: dict[str, str] = Field(default_factory=dict)


VARIANTS = {
    "crank-slider": CrankSliderVariant,
    "cam-crank-slider": CamVariant,
    "four-bar": FourBarVariant,
    "chain-unit": ChainUnitVariant,
}

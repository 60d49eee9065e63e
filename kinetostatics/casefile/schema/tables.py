"""Tables within a variant: links, cams, counterweights, files of values, and how one of several kinds is told."""

import math
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag

from ...design.balancing import RATIOS
from ...machine.cams import Harmonic
from ...machine.roller import LARGEST_RATIO
from ...numbers.checks import choice, nearest
from ...numbers.units import shown
from .texts import (
    Angle,
    Centre,
    Coordinate,
    GravityAcceleration,
    Inertia,
    Length,
    Mass,
    Modulus,
    Period,
    Point,
    Weight,
    or_else,
    reader,
    series_of,
)


class Table(BaseModel):
    """A table of a case file: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True)


TAGS: dict[str, Any] = {}
"""By the tag that stands among the keys of a problem: the table, of several kinds, that was chosen there."""


def kinds(tag):
    """Words for the kinds that might stand in place of a tagged one."""
    family = tag.partition(":")[0]
    return [other.partition(":")[2] for other in TAGS if other.startswith(f"{family}:")]


def one_of(family, models: dict[str, Any]) -> Any:
    """Type of a table of one of several kinds, told by its key `kind`; a word like an allowed one is taken for it."""
    TAGS.update({f"{family}:{word}": model for word, model in models.items()})

    def tag(raw):
        word = raw.get("kind") if isinstance(raw, dict) else getattr(raw, "kind", None)
        meant = word if isinstance(word, str) and word in models else nearest(word, models) if word else None
        return meant and f"{family}:{meant}"

    choices: Any = None
    for word, model in models.items():
        tagged: Any = Annotated[model, Tag(f"{family}:{word}")]
        choices = tagged if choices is None else choices | tagged
    wrong: Any = {"custom_error_type": "kind", "custom_error_message": f"{family}:"}
    return Annotated[choices, Discriminator(tag, **wrong)]


def list_of(kind, name, least=0) -> Any:
    """Type of a list of so many tables or more."""

    def read(value):
        if not isinstance(value, list) or len(value) < least:
            raise ValueError(f"must be a list of tables, each under [[{name}]], {least} at least, found {shown(value)}")
        return value

    return Annotated[tuple[kind, ...], BeforeValidator(read)]


class LinkTable(Table):
    mass: Mass = 0.0
    centre: Centre = (0.0, 0.0)
    inertia: Inertia = 0.0


class GravityTable(Table):
    acceleration: GravityAcceleration = 9.81
    direction: Angle = -math.pi / 2


# Values of loads


class ValuesTable(Table):
    """Values by crank angle or by travel, in a CSV file; pressures with the area that they act on."""

    file: str
    over: Literal["angle", "travel"] | None = None
    area: Annotated[float | None, BeforeValidator(reader("m^2"))] = None
    period: Period = None
    slider: str | None = None


TAGS |= {"value:text": Table, "value:file": ValuesTable}


def value_in(unit) -> Any:
    """Type of what is a text with a unit, or a table that names a file."""
    text = BeforeValidator(or_else(reader(unit), 'a table, { file = "values.csv" }'))
    choices = Annotated[float, text, Tag("value:text")] | Annotated[ValuesTable, Tag("value:file")]
    by_type = Discriminator(lambda raw: "value:file" if isinstance(raw, dict | ValuesTable) else "value:text")
    return Annotated[choices, by_type, unit]


# Cams


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
    noise: Length | None = None


class HarmonicTable(Table):
    kind: Literal["harmonic"]
    cosine: Annotated[Any, BeforeValidator(series_of("m")), Harmonic.RULES.rules["cosine"]]
    sine: Annotated[Any, BeforeValidator(series_of("m")), Harmonic.RULES.rules["sine"]] = ()


CAMS = {"circle": CircleTable, "cosine-law": CosineLawTable, "harmonic": HarmonicTable, "sampled": SampledTable}
Cam = one_of("cam", CAMS)


# Rollers

PoissonsRatio = Annotated[float, Field(strict=True, ge=0.0, le=LARGEST_RATIO, allow_inf_nan=False), "1"]


class RollerTable(Table):
    """A cam's roller with its materials: with it "contact_pressure" is an output."""

    radius: Length = Field(description="radius of the roller")
    width: Length = Field(description="width of the contact")
    youngs_modulus: Modulus = Field(description="Young's modulus of the roller, and of the cam unless that is told")
    poissons_ratio: PoissonsRatio = Field(
        description="Poisson's ratio of the roller, from 0 to 0.5, and of the cam unless that is told"
    )
    cam_youngs_modulus: Modulus | None = Field(None, description="Young's modulus of the cam")
    cam_poissons_ratio: PoissonsRatio | None = Field(None, description="Poisson's ratio of the cam")


# Counterweights


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

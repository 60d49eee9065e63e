"""Tables within a variant: links, cams, rollers, counterweights, files of values; validation of tables in sentences.

`one_of` is a table of one of several kinds, chosen by its key `kind`. `validate` returns one sentence per fault.
"""

import math
import typing
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BaseModel, BeforeValidator, ConfigDict, Discriminator, Field, Tag, model_validator

from ...design.balancing import NAMED_RATIOS, ratio_problem
from ...errors import ParameterError
from ...machine.cams.cams import Harmonic
from ...machine.cams.roller import MAX_POISSONS_RATIO
from ...numbers import checks
from ...numbers.checks import choice, nearest
from ...numbers.units import quoted
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
    Sense,
    Weight,
    Zero,
    list_reader,
    reader,
    series_of,
    with_alternative,
)


class Table(BaseModel):
    """A table of a case file: unknown keys are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def must_describe(name) -> Any:
    """Validator of tables: the described object, their attribute of this name, can be constructed."""

    def check(table):
        try:
            getattr(table, name)
        except ParameterError as error:
            raise ValueError(f"is no {name}: {str(error).partition(': ')[2]}") from None
        return table

    return model_validator(mode="after")(check)


TAGS: dict[str, Any] = {}
"""Table by pydantic's tag among the keys of a fault in a table of several kinds."""


def kinds(tag):
    """Names of the kinds in the family of a tag."""
    family = tag.partition(":")[0]
    return [other.partition(":")[2] for other in TAGS if other.startswith(f"{family}:")]


def one_of(family, models: dict[str, Any]) -> Any:
    """Type of a table of one of several kinds by its key `kind`; a near word selects the nearest kind."""
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
    """Type of a list of at least `least` tables."""
    words = f"a list of tables, each under [[{name}]], {least} at least"
    return Annotated[tuple[kind, ...], BeforeValidator(list_reader(lambda part: part, words, least=least))]


class LinkTable(Table):
    mass: Mass = 0.0
    """Of the link."""
    centre: Centre = (0.0, 0.0)
    """Mass centre, along the link from its reference joint, or [along, across]; "mid-length" of a coupler or rocker."""
    inertia: Inertia = 0.0
    """Moment of inertia about the mass centre."""


class GravityTable(Table):
    acceleration: GravityAcceleration = 9.81
    """Of free fall."""
    direction: Angle = -math.pi / 2
    """Direction of the pull, from +x."""


# Values of loads


class ValuesTable(Table):
    """Values by crank angle or by travel, in a CSV file; pressures need the piston area."""

    file: str
    """CSV file beside the case; each column headed by its name and unit: travel [mm], force [kN]."""
    over: Literal["angle", "travel"] | None = None
    """Column to use if the file has both."""
    area: Annotated[float | None, BeforeValidator(reader("m^2"))] = None
    """Piston area for forces along the guide from pressures; negative if they push against its direction."""
    period: Period = None
    """Crank angle after which the table repeats: by default one turn, two for four strokes."""
    slider: str | None = None
    """The slider whose travel or dead centre is read; by default the one that the load acts on."""
    zero: Zero = None
    """Crank angle at which the table's angle is 0: "TDC" or "BDC", dead centres of the slider, or an angle from +x."""
    sense: Sense = 1
    """Direction in which the table's angle increases: 1 counter-clockwise, -1 clockwise."""


TAGS |= {"value:text": Table, "value:file": ValuesTable}


def value_in(unit) -> Any:
    """Type of a text with a unit, or a table that names a file."""
    text = BeforeValidator(with_alternative(reader(unit), 'a table, { file = "values.csv" }'))
    choices = Annotated[float, text, Tag("value:text")] | Annotated[ValuesTable, Tag("value:file")]
    by_type = Discriminator(lambda raw: "value:file" if isinstance(raw, dict | ValuesTable) else "value:text")
    return Annotated[choices, by_type, unit]


# Cams


class CircleTable(Table):
    kind: Literal["circle"]
    """A circle."""
    radius: Length
    """Radius of the circle of roller centres."""
    centre: Point = (0.0, 0.0)
    """Centre of the circle, from O."""


class CosineLawTable(Table):
    kind: Literal["cosine-law"]
    """A curve that moves the slider exactly by a cosine."""
    amplitude: Length
    """Half the stroke of the slider."""
    mean: Length
    """Coordinate of the slider at mid-stroke."""


class SampledTable(Table):
    kind: Literal["sampled"]
    """A curve through measured points."""
    table: str
    """CSV file of crank angle and radius of the roller centre."""
    noise: Length | None = None
    """Standard deviation of the radii, for smoothing; without it the curve passes through all of them."""


class HarmonicTable(Table):
    kind: Literal["harmonic"]
    """A series of cosines and sines."""
    cosine: Annotated[Any, BeforeValidator(series_of("m")), Harmonic.RULES.rules["cosine"]]
    """Mean radius, then coefficients of the cosines of 1, 2 ... times the crank angle from the guide."""
    sine: Annotated[Any, BeforeValidator(series_of("m")), Harmonic.RULES.rules["sine"]] = ()
    """Coefficients of the sines of 1, 2 ... times the crank angle from the guide."""


CAMS = {"circle": CircleTable, "cosine-law": CosineLawTable, "harmonic": HarmonicTable, "sampled": SampledTable}
Cam = one_of("cam", CAMS)


# Rollers and faces

PoissonsRatio = Annotated[float, Field(strict=True, ge=0.0, le=MAX_POISSONS_RATIO, allow_inf_nan=False), "1"]


class FaceTable(Table):
    """Width and materials of a flat face on a cam: with it "contact_pressure" is an output."""

    width: Length
    """Width of the contact."""
    youngs_modulus: Modulus
    """Young's modulus of the roller or face, and by default of the cam."""
    poissons_ratio: PoissonsRatio
    """Poisson's ratio of the roller or face, from 0 to 0.5, and by default of the cam."""
    cam_youngs_modulus: Modulus | None = None
    """Of the cam."""
    cam_poissons_ratio: PoissonsRatio | None = None
    """Of the cam."""


class RollerTable(FaceTable):
    """A cam's roller with its materials: with it "contact_pressure" is an output."""

    radius: Length
    """Radius of the roller."""


# Counterweights


def _ratio(value):
    number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    problem = None if number else choice("ratio", value, tuple(NAMED_RATIOS))
    if problem:
        raise ValueError(f"must be a number or a name: {problem}")
    if number and (problem := ratio_problem(value)):
        raise ValueError(problem.removeprefix("ratio "))
    return value


class CounterweightTable(Table):
    mass: Mass | None = None
    """Mass of the counterweight; its arm follows."""
    arm: Coordinate | None = None
    """Distance of its centre from the link's reference joint; negative behind the joint. Its mass follows."""
    whole_link: Annotated[bool, Field(strict=True)] = False
    """Whether mass and arm are those of the link including its counterweight."""
    largest_mass: Mass | None = None
    """Limit of the mass."""
    largest_arm: Length | None = None
    """Limit of the arm."""
    keep_out: Length | None = None
    """Radius around the reference joint in which it must not lie."""


class BalancingTable(Table):
    method: Literal["full", "partial", "optimal"]
    """Full, partial (by the crank only) or optimal (least norm) balancing of the shaking force."""
    ratio: Annotated[float | str, BeforeValidator(_ratio)] = "overall"
    """Ratio for partial balancing: "across", "along", "overall", or a number."""
    norm: Literal["largest", "mean", "along", "across", "weighted", "largest moment", "largest weighted"] = "largest"
    """Norm that optimal balancing minimises."""
    about: Point = (0.0, 0.0)
    """Point of the shaking moment."""
    weights: tuple[Weight, Weight] = (1.0, 0.0)
    """Weights of force, 1/N, and moment, 1/(N m), for the norms "weighted" and "largest weighted"."""
    phase: Annotated[bool, Field(strict=True)] = False
    """Whether a counterweight may be off its link's line."""
    crank: CounterweightTable | None = None
    """Counterweight on the crank."""
    coupler: CounterweightTable | None = None
    """Counterweight on the coupler."""
    rocker: CounterweightTable | None = None
    """Counterweight on the rocker."""


def validate(model, raw, place):
    """The model or None, and a sentence per fault; ``place(keys)`` gives the keys in the file."""
    table, found = validate_by_keys(model, raw, place)
    return table, [sentence for _, sentence in found]


def validate_by_keys(model, raw, place=tuple):
    """The model or None, and the keys and sentence of each fault, as by `validate`."""
    try:
        return model.model_validate(raw), []
    except pydantic.ValidationError as error:
        return None, [(_keys(item), _sentence(model, item, place)) for item in error.errors()]


def _keys(item):
    return tuple(key for key in item["loc"] if key not in TAGS)


NOT_A_TABLE = ("model_type", "dict_type")
"""Pydantic's names of the fault of a value instead of a table."""


def _sentence(model, item, place):
    keys = _keys(item)
    path = key_path(place(keys))
    found = item["input"]
    if item["type"] == "missing":
        return f"{path} is missing"
    if item["type"] == "extra_forbidden":
        allowed = [key for table in _tables_at(model, item["loc"][:-1]) for key in table.model_fields]
        return f"{path} is not a key here{checks.hint(keys[-1], allowed)} (allowed: {', '.join(allowed)})"
    if item["type"] == "kind":
        allowed = kinds(item["msg"])
        if not isinstance(found, dict):
            return f"{path} must be a table with a kind, of {', '.join(map(repr, allowed))}, found {quoted(found)}"
        if "kind" not in found:
            return f"{path}.kind is missing; allowed: {', '.join(map(repr, allowed))}"
        return checks.choice(f"{path}.kind", found["kind"], allowed)
    if item["type"] == "literal_error" and keys[-1] == "kind":
        return checks.choice(path, found, kinds(item["loc"][-2]))
    if item["type"] in NOT_A_TABLE:
        return f"{path} must be a table of keys and values, found {quoted(found)}"
    if item["type"] == "value_error":
        return f"{path} {item['ctx']['error']}"
    return f"{path}: {item['msg'][0].lower()}{item['msg'][1:]}, found {quoted(found)}"


def key_path(keys):
    """Keys as text: "variants.plain.cam.centre[1]"."""
    text = ""
    for key in keys:
        text += f"[{key + 1}]" if isinstance(key, int) else f".{key}" if text else str(key)
    return text


def _tables_at(model, keys):
    """Tables allowed at a path of the model."""
    candidates = [model]
    for key in keys:
        if key in TAGS:
            candidates = [TAGS[key]]
        elif any(key in table.model_fields for table in candidates):  # others are numbers in a list, and names
            fields = [table.model_fields[key].annotation for table in candidates if key in table.model_fields]
            candidates = [inner for annotation in fields for inner in tables_in(annotation)]
    return candidates


def tables_in(annotation):
    """Tables within a type."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return [annotation]
    return [table for part in typing.get_args(annotation) for table in tables_in(part)]

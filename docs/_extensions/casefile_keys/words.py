"""What may stand at a key and what holds where it is left out, in words, from what the schema reads."""

import functools
import inspect
import json
import math
import typing

import pydantic

from kinetostatics.casefile.schema import parts, tables, texts, variants
from kinetostatics.machine.loads.balance_shaft import RatioRule
from kinetostatics.numbers import checks

from .examples import toml
from .sections import anchor, flattened, titles

DIMENSIONS = {
    "m": "length",
    "m^2": "area",
    "m^3": "volume",
    "rad": "angle",
    "kg": "mass",
    "kg m": "unbalance",
    "kg m^2": "moment of inertia",
    "rad/s": "angular speed",
    "rad/s^2": "angular acceleration",
    "m/s^2": "acceleration",
    "N": "force",
    "N m": "torque",
    "N/m": "stiffness",
    "N/m^3": "cubic stiffness",
    "N m/rad": "torsional stiffness",
    "N s/m": "damping",
    "N m s": "torsional damping",
    "W": "power",
    "Pa": "pressure",
    "1": "number",
}


def takes(field):
    """What may stand at a key."""
    said = [words for kind, extra in flattened(field.annotation, tuple(field.metadata)) for words in one(kind, extra)]
    return ", or ".join(dict.fromkeys(said))


def default(field):
    """What holds where a key is left out."""
    if field.is_required():
        return "required"
    value = field.get_default(call_default_factory=True)
    if value is None or value in ({}, ()) or value == "":
        return "none"
    if isinstance(value, pydantic.BaseModel):
        return "no mass" if isinstance(value, tables.LinkTable) else "none"
    if isinstance(value, float) and math.isclose(abs(value), math.pi / 2):
        return f"{math.degrees(value):g} deg"
    if isinstance(value, tuple):
        return f"`{toml(list(value))}`"
    if isinstance(value, bool | str):
        return f"`{json.dumps(value)}`"
    return f"{value:g}"


def one(kind, extra):
    """Words for one type with what is said of it."""
    if kind is type(None):
        return
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if isinstance(kind, type) and issubclass(kind, pydantic.BaseModel):
        yield linked(kind)
    elif origin is typing.Literal:
        yield ", ".join(f"`{json.dumps(word)}`" for word in arguments)
    elif origin is tuple and any(is_table(part) for part in arguments):
        yield f"list of {' or '.join(words_of_tables(arguments[0]))}"
    elif origin is dict and any(is_table(part) for part in arguments):
        yield f"tables of {' or '.join(words_of_tables(arguments[1]))}"
    else:
        yield read_by(extra) or plain(kind)


def is_table(annotation):
    """Whether a type is one of tables."""
    return any(isinstance(kind, type) and issubclass(kind, tables.Table) for kind, _ in flattened(annotation))


def words_of_tables(annotation):
    """Links to all tables within a type; one to the family of several kinds."""
    found = [linked(kind) for kind, _ in flattened(annotation)]
    return list(dict.fromkeys(found))


def linked(model):
    """Link to the section of a table, or to the first of its family."""
    title = titles().get(model)
    if title is None:
        return "table"
    family, _, word = title.partition(": ")
    first = next(other for other in titles().values() if other.partition(": ")[0] == family)
    return f"[{family.lower()}](#{anchor(first)})" if word else f"[{title.lower()}](#{anchor(title)})"


def read_by(extra):
    """Words for what a function of the schema reads, or none."""
    for said in extra:
        if isinstance(said, pydantic.BeforeValidator):
            words = words_of(said.func)
            if words:
                return words
    return next(
        (by_rule(said) for said in extra if isinstance(said, checks.Pair | parts.PlaceRule | parts.PlacePairRule)), ""
    )


def words_of(function):
    """Words for what one function reads, by what it closes over or by its name."""
    inside = inspect.getclosurevars(function).nonlocals
    if "unit" in inside:
        return in_unit(inside["unit"], inside.get("low"), inside.get("strict"))
    if isinstance(inside.get("read_part"), functools.partial):
        return f"{'pair' if inside['size'] == 2 else 'list'} of {in_unit(inside['read_part'].keywords['unit'])}"
    if "rule" in inside:
        return by_rule(inside["rule"])
    if "read" in inside:
        return words_of(inside["read"])
    return {
        texts._stiffness: f'{in_unit("N/m", 0.0, False)} or `"{texts.BALANCE_THE_SLIDER}"`',
        texts._centre: f'{in_unit("m")}, a pair of them, or `"{texts.MID_LENGTH}"`',
        texts._sampling: in_unit("rad"),
        texts._period: f"{in_unit('rad')}, whole turns",
        texts._two_points: "two points, pairs of length [m]",
        texts.point: "pair of length [m]",
        variants._coefficient: "number, not negative",
        tables._ratio: f"number, {', '.join(f'`{json.dumps(word)}`' for word in tables.NAMED_RATIOS)}",
        parts._read_point: "point: joint, place on a link, or fixed",
        parts._read_two_points: "two points",
    }.get(function, "")


def by_rule(rule):
    """Words for a rule of the library's classes."""
    if isinstance(rule, checks.Optional):
        return by_rule(rule.rule)
    if isinstance(rule, checks.Sign):
        return ", ".join(["`1`", "`-1`", *(f"`{json.dumps(word)}`" for word in rule.words)])
    if isinstance(rule, checks.Word):
        return ", ".join(f"`{json.dumps(word)}`" for word in rule.words)
    if isinstance(rule, checks.Number):
        return in_unit(rule.unit, rule.low, rule.strict)
    if isinstance(rule, RatioRule):
        return 'number or fraction, `-1`, `0.5`, `"1/3"`'
    if isinstance(rule, checks.Pair):
        return f"pair of {in_unit(rule.unit)}"
    return "name" if isinstance(rule, checks.Name) else "names of two joints"


def in_unit(unit, low=None, strict=False):
    """Words for a number with a unit."""
    unit = unit.replace("**", "^").replace("*", " ")
    bound = "" if low is None else (", above " if strict else ", at least ") + f"{low:g}"
    shown = DIMENSIONS[unit] if unit == "1" else f"{DIMENSIONS[unit]} [{unit}]"
    return shown + bound


def plain(kind):
    """Words for a type of TOML's own."""
    origin, arguments = typing.get_origin(kind), typing.get_args(kind)
    if origin is tuple:
        return f"list of {plain(next(flattened(arguments[0]))[0])}s"
    if origin is dict:
        inner, _ = next(flattened(arguments[1]))
        of = {str: "texts", tuple: "pairs of texts"}.get(typing.get_origin(inner) or inner, "tables")
        return f"{of}, by name"
    words = {str: "text", bool: "true or false", int: "whole number", float: "number", dict: "table"}
    return words.get(kind, "text")

"""The case-file reference, made of the schema: every key with what may stand there, default, meaning and example.

Meanings are the texts below the keys in ``kinetostatics/casefile/schema``, and its `MEANINGS` for groups and loads;
examples come from the shipped cases and their starters, where they have the key.
"""

import ast
import inspect
import json
import math
import re
import tomllib
import types
import typing
from functools import cache
from itertools import pairwise
from pathlib import Path
from textwrap import dedent
from typing import Any, NamedTuple

import pydantic

from kinetostatics.casefile import schema
from kinetostatics.casefile.schema import designs, drives, parts, tables, texts, variants
from kinetostatics.numbers import checks

ROOT = Path(__file__).parents[2]
PLACE = "<!-- every key -->"
LONGEST = 64
"""Letters of an example."""
DIMENSIONS = {
    "m": "length",
    "m^2": "area",
    "rad": "angle",
    "kg": "mass",
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
    "N m s/rad": "torsional damping",
    "W": "power",
    "Pa": "pressure",
    "1": "number",
}
BY_KEY: dict[str, list[Any]] = {
    "against": ["coupler"],
    "along": ["coupler"],
    "assembly": [1],
    "at": ["B", ["0.2 m", "0.05 m"]],
    "between": [["B", ["1 m", "0 m"]]],
    "cubic": ["1 MN/m^3", ["0 N/m^3", "50 MN/m^3"]],
    "cosine": [["300 mm", "-2 mm"]],
    "ends": [["1.7 m", "2.3 m"]],
    "figures": [{"torque": "6a"}],
    "file": ["values.csv"],
    "free_position": ["2 m"],
    "guide_offset": ["-20 mm"],
    "guide_through": [[["0 mm", "-20 mm"], ["300 mm", "-20 mm"]]],
    "inertia": ["0.9 kg m^2"],
    "lever_pivot": [["0 mm", "-240 mm"]],
    "maximise": ["ratio mean_absolute balancing_torque"],
    "minimise": ["largest O", ["mean_absolute balancing_torque", "largest O"]],
    "noise": ["0.01 mm"],
    "note": ["Read from figure 6."],
    "crank": [{"mass": "25 kg"}, {"arm": "-80 mm"}],
    "coupler": [{"mass": "38 kg", "centre": "160 mm"}],
    "slider": [{"mass": "120 kg"}, "slider2"],
    "block": [{"mass": "2 kg"}],
    "rocker": [{"mass": "30 kg", "centre": "mid-length"}, {"arm": "-80 mm"}],
    "lever": [{"mass": "25 kg", "centre": "230 mm"}],
    "rod": [{"mass": "0.5 kg", "centre": "80 mm"}],
    "cylinder": [{"mass": "2 kg", "centre": "60 mm"}],
    "spring": [{"stiffness": "700 kN/m", "free_position": "2 m"}],
    "process_force": [{"force": "-500 N"}],
    "gravity": [{}],
    "friction": [{"O": {"mu": 0.05, "radius": "30 mm"}}],
    "on": ["A", ["B", "C"]],
    "pin.on": ["coupler"],
    "pin.name": ["C"],
    "dyad.pin": ["D"],
    "dyad1": [{"mass": "2 kg", "centre": "200 mm"}],
    "dyad2": [{"mass": "2 kg", "centre": "200 mm"}],
    "spring.on": ["slider"],
    "process force.on": ["slider2"],
    "torque.on": ["rocker"],
    "torsion spring.on": ["rocker"],
    "torsion damper.on": ["rocker"],
    "pivot": [["0 mm", "-240 mm"]],
    "pivot_name": ["O3"],
    "points": [9],
    "poissons_ratio": [0.3],
    "radius": ["300 mm"],
    "ratio": ["across", {"mean |balancing torque|": "6.77"}],
    "seed": [1],
    "sine": [4, ["0.5 mm"]],
    "source": ["drawing 4711"],
    "speed": ["1475 rpm", ["0 rpm", "1500 rpm"]],
    "spreads": [{"coupler_length": "normal 0 mm +- 0.1 mm"}],
    "starts": [8],
    "stiffness": ["700 kN/m"],
    "table": ["values.csv"],
    "title": ["Crank press"],
    "tolerances": [{"slider.mass": "588..612 kg"}],
    "torque": ["90 N m", ["90 N m", "0 N m"]],
    "trim": [0.01],
    "value": ["-500 N", "-20 N m", {"largest cam force": "49 kN"}],
    "vary": [{"slider.mass": ["500 kg", "600 kg"]}],
    "weights": [[1.0, 0.1]],
    "where": ["table 1"],
}
"""Values tried before those of shipped cases, the first that a key takes is its example."""
HEADINGS = {
    "common": "[common]",
    "variants": "[variants.plain]",
    "published": "[published]",
    "design": "[design.best]",
    "groups": "[[common.groups]]",
    "loads": "[[common.loads]]",
    "balancing": "[variants.best.balancing]",
    "roller": "[common.roller]",
    "linkage": '[published.linkage."psi max [deg]"]',
    "motor": "[common.drive.motor]",
    "drive": "[common.drive]",
    "robust": "[design.best.robust]",
}
"""What tables begin with that are too long for a line."""
BY_UNIT = (
    "100 mm",
    "80 cm^2",
    "30 deg",
    "2 kg",
    "0.01 kg m^2",
    "300 rpm",
    "5 rad/s^2",
    "9.81 m/s^2",
    "-500 N",
    "90 N m",
    "20 kN/m",
    "10 N m/rad",
    "50 N s/m",
    "2 N m s/rad",
    "55 kW",
    "210 GPa",
)
"""Values tried where no shipped case has a key."""
BY_TYPE = (True, 0.5, 8, 1, 720, 0.3)


class Key(NamedTuple):
    """A row of the reference."""

    name: str
    takes: str
    default: str
    meaning: str
    example: str


class Part(NamedTuple):
    """A table of a case file: heading, what it says of itself, its keys."""

    anchor: str
    title: str
    about: str
    keys: list[Key]


# Tables and where they stand


def sections():
    """Every table of a case file: heading, model, and the keys left out because they stand in another section."""
    named = list(named_sections())
    yield from named
    for model in sorted(reached(model for _, model, _ in named) - {model for _, model, _ in named}, key=repr):
        yield re.sub(r"(?<!^)([A-Z])", r" \1", model.__name__.removesuffix("Table")).capitalize(), model, ()


def reached(models):
    """Every table that stands in one of these, or in what stands there."""
    found, left = set(), list(models)
    while left:
        model = left.pop()
        found.add(model)
        kinds = [kind for field in model.model_fields.values() for kind in tables_within(field.annotation)]
        left += [kind for kind in kinds if kind not in found]
    return found - {tables.Table}


def tables_within(annotation):
    """Tables within a type."""
    for kind, _ in flattened(annotation):
        if isinstance(kind, type) and issubclass(kind, tables.Table):
            yield kind
        else:
            for part in typing.get_args(kind):
                yield from tables_within(part)


def named_sections():
    """The sections in the order of the page; tables that it lacks follow."""
    yield "Head of the file", variants.CaseTable, ()
    yield "Every mechanism", variants.MechanismVariant, ()
    common = set(variants.MechanismVariant.model_fields)
    for word, model in variants.VARIANTS.items():
        yield f"Mechanism: {word}", model, common
    yield "Link", tables.LinkTable, ()
    yield "Gravity", tables.GravityTable, ()
    yield "Springs along the guide", variants.SpringTable, ()
    yield "Force along the guide", variants.ProcessForceTable, ()
    for word, model in tables.CAMS.items():
        yield f"Cam: {word}", model, ()
    for word, model in of_kinds(parts.GROUPS).items():
        yield f"Group: {word}", model, ()
    for word, model in of_kinds(parts.LOADS).items():
        yield f"Load: {word}", model, ()
    yield "File of values", tables.ValuesTable, ()
    yield "Friction", variants.FrictionTable, ()
    yield "Balancing", tables.BalancingTable, ()
    yield "Counterweight", tables.CounterweightTable, ()
    yield "Drive", drives.DriveTable, ()
    for word, model in chosen("motor").items():
        yield f"Motor: {word}", model, ()
    for word, model in designs.KINDS.items():
        yield f"Design: {word}", model, ()
    yield "Robust design", designs.RobustTable, ()
    yield "Published figures", variants.PublishedTable, ()


def of_kinds(kinds):
    """Tables of groups or loads by their word."""
    made = {kind: model for model, kind in schema.MADE_OF.items()}
    return {word: made[kind] for word, kind in kinds.items()}


def chosen(family):
    """Tables of several kinds, by their word."""
    tagged = ((tag.partition(":"), model) for tag, model in schema.TAGS.items())
    return {word: model for (name, _, word), model in tagged if name == family}


def parts_of_the_reference():
    """All of it."""
    return [
        Part(anchor(title), title, inspect.cleandoc(own_text(model)), keys(model, left_out))
        for title, model, left_out in sections()
    ]


def own_text(model):
    """What a table says of itself."""
    if model in schema.MADE_OF:
        return inspect.getdoc(schema.MADE_OF[model]).partition("\n\n")[0]
    return vars(model).get("__doc__") or ""


def anchor(title):
    """Where links to a heading lead."""
    return "key-" + title.lower().replace(": ", "-").replace(" ", "-")


@cache
def titles():
    """Heading of each table."""
    return {model: title for title, model, _ in sections()}


# Keys


def keys(model, left_out=()):
    """Rows of a table, first those that must be there."""
    found = [
        Key(name, takes(field), default(field), meaning(model, name), example(model, name, field))
        for name, field in model.model_fields.items()
        if name not in left_out
    ]
    return sorted(found, key=lambda key: (key.name not in ("kind", "mechanism"), key.default != "required"))


def meaning(model, name):
    """The text of a key."""
    if model in schema.MADE_OF:
        if name == "kind":
            return "Which kind it is."
        known = parts.MEANINGS.get(f"{word_of(model)}.{name}") or parts.MEANINGS.get(name)
        return known or parameter(schema.MADE_OF[model], name)
    owners = [base for base in model.__mro__ if name in vars(base).get("__annotations__", ())]
    told = model.model_fields[name].description or (texts_below(owners[0]).get(name, "") if owners else "")
    return told[:1].upper() + told[1:].removesuffix(".") + "." if told else ""


def parameter(kind, name):
    """What the docstring of a class says of a parameter."""
    text = re.search(rf"^{name} : .*\n((?:    .*(?:\n|\Z))+)", inspect.getdoc(kind), flags=re.MULTILINE)
    return " ".join(text[1].split()) if text else ""


@cache
def texts_below(model):
    """Texts that stand below the fields of a class."""
    body = ast.parse(dedent(inspect.getsource(model))).body[0].body
    return {
        field.target.id: text.value.value
        for field, text in pairwise(body)
        if isinstance(field, ast.AnnAssign)
        and isinstance(text, ast.Expr)
        and isinstance(text.value, ast.Constant)
        and isinstance(text.value.value, str)
    }


def flattened(annotation, extra=()):
    """All types within an annotation, each with what is said of it."""
    origin = typing.get_origin(annotation)
    if origin is typing.Annotated:
        inner, *more = typing.get_args(annotation)
        yield from flattened(inner, (*extra, *more))
    elif origin in (typing.Union, types.UnionType):
        for part in typing.get_args(annotation):
            yield from flattened(part, extra)
    else:
        yield annotation, extra


def takes(field):
    """What may stand at a key."""
    said = [words for kind, extra in flattened(field.annotation, tuple(field.metadata)) for words in one(kind, extra)]
    return ", or ".join(dict.fromkeys(said))


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
    return next((by_rule(said) for said in extra if isinstance(said, checks.Pair | parts.Place | parts.Between)), "")


def words_of(function):
    """Words for what one function reads, by what it closes over or by its name."""
    inside = inspect.getclosurevars(function).nonlocals
    if "unit" in inside:
        measure = in_unit(inside["unit"], inside.get("low"), inside.get("strict"))
        shape = function.__qualname__.partition(".")[0]
        return {"pair_of": f"pair of {measure}", "series_of": f"list of {measure}", "_row": f"list of {measure}"}.get(
            shape, measure
        )
    if "rule" in inside:
        return by_rule(inside["rule"])
    if "words" in inside:
        return words_of(inside["read"])
    return {
        texts._stiffness: f'{in_unit("N/m", 0.0, False)} or `"{texts.BALANCE_THE_SLIDER}"`',
        texts._centre: f'{in_unit("m")}, a pair of them, or `"{texts.MID_LENGTH}"`',
        texts._sampling: in_unit("rad"),
        texts._period: f"{in_unit('rad')}, whole turns",
        texts._two_points: "two points, pairs of length [m]",
        texts.point: "pair of length [m]",
        variants._coefficient: "number, not negative",
        tables._ratio: f"number, {', '.join(f'`{json.dumps(word)}`' for word in tables.RATIOS)}",
        parts._place: "point: joint, place on a link, or fixed",
        parts._two_places: "two points",
    }.get(function, "")


def by_rule(rule):
    """Words for a rule of the library's classes."""
    if isinstance(rule, checks.Optional):
        return by_rule(rule.rule)
    if isinstance(rule, checks.Sign):
        return ", ".join(["`1`", "`-1`", *(f"`{json.dumps(word)}`" for word in rule.words)])
    if isinstance(rule, checks.Number):
        return in_unit(rule.unit, rule.low, rule.strict)
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


# Examples


@cache
def written():
    """Every value that shipped cases and starters have, by key."""
    found: dict[str, list[Any]] = {}
    files = [*sorted((ROOT / "kinetostatics/casefile/starters").glob("*.toml")), *sorted(ROOT.glob("cases/*.toml"))]
    for path in files:
        collect(tomllib.loads(path.read_text(encoding="utf-8")), found)
    return found


def collect(value, found):
    """Add the values of a table, and of tables within it, to those found."""
    for item in value if isinstance(value, list) else []:
        collect(item, found)
    for key, item in value.items() if isinstance(value, dict) else []:
        found.setdefault(key, []).append(item)
        collect(item, found)


def example(model, name, field):
    """A line that a case may have: the heading of a table, or the first value that the key takes, as TOML."""
    if name in HEADINGS:
        return HEADINGS[name]
    annotation = field.annotation
    for said in field.metadata:
        annotation = typing.Annotated[annotation, said]
    reads = pydantic.TypeAdapter(annotation)
    words = [typing.get_args(kind)[0] for kind, _ in flattened(field.annotation) if is_literal(kind)]
    given = (*BY_KEY.get(f"{word_of(model)}.{name}", ()), *BY_KEY.get(name, ()))
    for value in (*words, *given, *written().get(name, ()), *BY_UNIT, *BY_TYPE):
        line = f"{name} = {toml(value)}"
        if len(line) <= LONGEST and takes_it(reads, value):
            return line
    return ""


def word_of(model):
    """The kind of a group or load, as its tables say it."""
    return typing.get_args(model.model_fields["kind"].annotation)[0] if model in schema.MADE_OF else ""


def is_literal(kind):
    """Whether a type is one of some words."""
    return typing.get_origin(kind) is typing.Literal


def takes_it(reads, value):
    """Whether a value is one that a key takes."""
    try:
        reads.validate_python(value)
    except pydantic.ValidationError:
        return False
    return True


def toml(value):
    """A value as TOML has it."""
    if isinstance(value, dict):
        return (
            "{}" if not value else "{ " + ", ".join(f"{bare(key)} = {toml(part)}" for key, part in value.items()) + " }"
        )
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def bare(key):
    """A key as TOML has it."""
    return key if re.fullmatch(r"[\w-]+", key) else json.dumps(key)


# The page


def page():
    """The reference as Markdown."""
    lines = []
    for part in parts_of_the_reference():
        lines += [f"({part.anchor})=", f"## {part.title}", "", part.about, ""]
        if not part.keys:
            continue
        lines += ["| key | takes | default | meaning | example |", "|---|---|---|---|---|"]
        for key in part.keys:
            shown = f"`{key.example}`" if key.example else ""
            said = key.meaning.replace("[[", "\\[\\[")
            row = (f"`{key.name}`", key.takes, key.default, said, shown)
            lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |")
        lines.append("")
    return "\n".join(lines)


def fill(app, docname, source):
    """Put the reference in its place."""
    if PLACE in source[0]:
        source[0] = source[0].replace(PLACE, page())


def setup(app):
    """Fill the page as it is read."""
    app.connect("source-read", fill)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}

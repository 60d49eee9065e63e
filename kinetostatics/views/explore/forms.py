"""Fields of a form for a table of a case file, from its schema, and their texts as values of the table.

A field is a dict: `key`, with a point into inner tables ("coupler.mass"), `text`, its meaning, `unit` in SI, `form`,
`required`, `default` and `choices` as texts. Lists are texts with commas; semicolons separate points and segments.
"""

import copy
import math
import typing

from ...casefile.build import unit_or_rule
from ...casefile.schema.meanings import meaning
from ...casefile.schema.parts import MADE_OF
from ...casefile.schema.tables import ValuesTable, tables_in
from ...machine.groups.rocker import TwoJoints
from ...machine.loads.balance_shaft import RatioRule
from ...machine.loads.points import PlacePairRule, PlaceRule
from ...numbers import checks
from ...numbers.units import to_si

FILE_KEYS = ("file", "table")
"""Keys of tables that name a file."""
SEGMENT_KEYS = {"dwell": ("position", "angle"), "harmonic": ("start", "end", "angle")}
"""Keys of the segments of a law in the order of their texts; of all curves those of "harmonic"."""
SEGMENTS = [
    {"kind": "cycloidal", "start": "50 mm", "end": "70 mm", "angle": "120 deg"},
    {"kind": "dwell", "position": "70 mm", "angle": "60 deg"},
    {"kind": "cycloidal", "start": "70 mm", "end": "50 mm", "angle": "120 deg"},
    {"kind": "dwell", "position": "50 mm", "angle": "60 deg"},
]
"""Segments of a law that rises, dwells and returns."""
BY_RULE: dict[type, str] = {
    checks.Name: "text",
    checks.Pair: "list",
    checks.Series: "list",
    TwoJoints: "list",
    PlaceRule: "place",
    PlacePairRule: "places",
    RatioRule: "number",
}
"""Form of a field by the rule of its value."""


def fields(model, raw, prefix="", needed=True):
    """Fields of a table and its inner tables, the required ones first."""
    found = []
    for name, field in model.model_fields.items():
        inner = [table for table in tables_in(field.annotation) if table is not ValuesTable]
        required, text = (
            needed and field.is_required(),
            plain(meaning(model, name)).replace("; or a file of values", ""),
        )
        entry = {"key": f"{prefix}{name}", "text": text, "required": required}
        if name == "segments":
            example = {"text": f"{text} For example {text_of(SEGMENTS)}."}
            found.append(entry | example | {"unit": "", "form": "segments", "default": "", "choices": []})
        elif not inner and name not in ("kind", *FILE_KEYS):
            found.append(entry | _entry(model, name, field))
        elif inner and typing.get_origin(field.annotation) not in (tuple, dict):
            found += _inner_fields(inner, raw.get(name), entry)
    return sorted(found, key=lambda field: not field["required"])


def _inner_fields(inner, raw, entry):
    """Fields of an inner table; one of several kinds has its kind first."""
    own, chosen, found = raw if isinstance(raw, dict) else {}, inner[0], []
    if len(inner) > 1:
        by_kind = {typing.get_args(table.model_fields["kind"].annotation)[0]: table for table in inner}
        chosen = by_kind.get(own.get("kind"), chosen)
        offered = [word for word, table in by_kind.items() if not any(name in FILE_KEYS for name in table.model_fields)]
        kind = {"key": f"{entry['key']}.kind", "unit": "", "form": "choice", "default": "", "choices": offered}
        found.append(entry | kind)
    return found + fields(chosen, own, f"{entry['key']}.", needed=entry["required"] or bool(own))


def plain(text):
    """A text of the reference without its marks."""
    return text.replace("`", '"')


def _entry(model, name, field):
    """Unit, form, default and choices of a field without inner table."""
    made_of = MADE_OF.get(model)
    rule = made_of.RULES.rules.get(name) if made_of else None
    while isinstance(rule, checks.Optional | checks.OrFunction):
        rule = rule.rule
    meant = unit_or_rule(field)
    rule = meant if rule is None and hasattr(meant, "numbers") else rule
    unit = meant if isinstance(meant, str) else getattr(meant, "unit", "")
    choices = _choices(rule, field.annotation)
    form = "choice" if choices else _form(rule, field.annotation, unit)
    value = None if field.is_required() else field.get_default(call_default_factory=True)
    return {
        "unit": "" if unit == "1" else unit,
        "form": form,
        "default": _default_text(value, unit),
        "choices": list(map(text_of, choices)),
    }


def _choices(rule, annotation):
    if isinstance(rule, checks.Sign):
        return (1, -1, *rule.words)
    if isinstance(rule, checks.Word):
        return rule.words
    if isinstance(rule, checks.Truth):
        return (False, True)
    return typing.get_args(annotation) if typing.get_origin(annotation) is typing.Literal else ()


def _form(rule, annotation, unit):
    by_rule = next((form for kind, form in BY_RULE.items() if isinstance(rule, kind)), None)
    if by_rule:
        return by_rule
    types = str(annotation)
    if "tuple[tuple" in types:
        return "places"
    if "tuple" in types:
        return "place" if "str" in types else "list"
    return "number" if unit == "1" else "text"


def _default_text(value, unit):
    if isinstance(value, tuple):
        return ", ".join(_default_text(part, unit) for part in value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        return text_of(value) if value else ""
    if unit == "rad":
        return f"{math.degrees(value):g} deg"
    return f"{value:g}" if unit in ("", "1") else f"{value:g} {unit}"


def text_of(value):
    """Text in a field of a value of a table; empty for an absent one."""
    if isinstance(value, dict):  # a segment of a law
        return ", ".join(map(text_of, value.values()))
    if isinstance(value, list):
        return ("; " if any(isinstance(part, list | dict) for part in value) else ", ").join(map(text_of, value))
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else str(value)


def value_of(text, form):
    """Value of a table from the text in a field; the schema finds its faults."""
    text = text.strip()
    if form == "segments":
        return [_segment(part) for part in text.strip("; ").split(";")]
    if form == "places":
        return [value_of(part, "place") for part in text.split(";")]
    if form == "list" or (form == "place" and "," in text):
        return [part.strip() for part in text.split(",")]
    if form == "choice" and text in ("true", "false"):
        return text == "true"
    if form in ("number", "choice"):
        try:
            number = float(text)
        except ValueError:
            return text
        return text if not math.isfinite(number) else int(number) if form == "choice" else number
    return text


def _segment(text):
    """Segment of a law from its kind and the values of its keys, in the order of the schema."""
    kind, *values = (part.strip() for part in text.split(","))
    names = SEGMENT_KEYS.get(kind, SEGMENT_KEYS["harmonic"])
    names = (*names, *(f"value {number}" for number in range(len(names) + 1, len(values) + 1)))
    return {"kind": kind, **dict(zip(names, values, strict=False))}


def with_texts(model, raw, texts):
    """Copy of a table with other texts by key; an empty text takes a key away. Raises `ParameterError`."""
    found = copy.deepcopy(raw)
    for key, text in texts.items():
        known = {field["key"]: field for field in fields(model, found)}
        checks.require("explore", checks.choice("key", key, tuple(known)))
        checks.require("explore", None if isinstance(text, str) else f"{key} must be a text, got {checks.shown(text)}")
        *outer, name = key.split(".")
        inner = found
        for step in outer:
            if not isinstance(inner.get(step), dict):
                inner[step] = {}
            inner = inner[step]
        if text.strip():
            inner[name] = value_of(text, known[key]["form"])
        else:
            inner.pop(name, None)
        if outer and not inner:
            found.pop(outer[0])
    return found


SHOWN_UNITS = {"m": "mm", "rad": "deg", "rad/s": "rpm"}
"""Unit of texts by SI unit, where the text has exactly the number."""


def number_text(value, unit):
    """Text of a number in SI that is read as exactly this number; one without unit stays a number."""
    if unit == "1":
        return float(value)
    if unit in SHOWN_UNITS:
        shown = SHOWN_UNITS[unit]
        text = f"{value / to_si(f'1 {shown}', unit):.12g} {shown}"
        if to_si(text, unit) == value:
            return text
    return f"{value!r} {unit}"

"""What designs may vary: paths into a variant of a case file, as in scenes: "spring.stiffness", "slider2.mass"."""

import typing
from typing import NamedTuple

from ..numbers import paths as tree
from .schema import MADE_OF, Table

PARTS = {"x": 0, "y": 1, "along": 0, "across": 1}
"""Names of the components of a pair."""
GUIDE = ("guide_angle", "guide_offset")
"""What two points of the guide fix, if they are given."""


class Place(NamedTuple):
    """Where a number stands in a validated table: fields and numbers of items, from the outermost; and its unit."""

    steps: tuple[str | int, ...]
    unit: str


def paths(table, prefix="", label="") -> dict[str, Place]:
    """Place by path of all numbers in a validated table that can be varied; a label goes behind the first name."""
    names = getattr(MADE_OF.get(type(table)), "PATHS", {})
    found: dict[str, Place] = {}
    for name, field in type(table).model_fields.items() if not _is_in_file(table) else ():
        if name in GUIDE and getattr(table, "guide_through", None):
            continue
        value = getattr(table, name)
        if isinstance(value, tuple) and value and isinstance(value[0], Table):
            inner = _of_parts(table, value)
        elif isinstance(value, dict):
            inner = {
                path: place._replace(steps=(key, *place.steps))
                for key, part in value.items()
                for path, place in paths(part, f"{prefix}{name}.{key}.").items()
                if getattr(part, str(place.steps[0])) is not None
            }
        else:
            inner = _of_value(table, name, value, field, f"{prefix}{names.get(name, name)}{label}")
        found |= {path: place._replace(steps=(name, *place.steps)) for path, place in inner.items()}
    return found


def _of_parts(table, parts):
    """Those of groups or loads; the second load of a kind is numbered so, after one that has a table of its own."""
    found: dict[str, Place] = {}
    counts: dict[str, int] = {}
    for number, part in enumerate(parts):
        named = getattr(MADE_OF[type(part)], "PATH", "")
        counts[named] = counts.get(named, int(bool(named and getattr(table, named, None)))) + 1
        again = str(counts[named]) if counts[named] > 1 else ""
        label = getattr(part, "label", getattr(part, "name", ""))
        inner = paths(part, f"{named}{again}.") if named else paths(part, "", label)
        found |= {path: place._replace(steps=(number, *place.steps)) for path, place in inner.items()}
    return found


def _of_value(table, name, value, field, path):
    if isinstance(value, Table):
        return paths(value, f"{path}.")
    meant = _meant(field)
    if hasattr(meant, "numbers"):
        return {f"{path}.{part}": Place(steps, rule.unit) for part, steps, rule in meant.numbers(value)}
    if meant is None:
        return {}
    if isinstance(value, tuple):
        parts = ("along", "across") if name == "centre" and hasattr(table, "mass") else ("x", "y")
        return {f"{path}.{part}": Place((PARTS[part],), meant) for part in parts}
    return {path: Place((), meant)}


def _file_of(table):
    """Name of the file in which the numbers are that a table stands for, or None."""
    found = (getattr(table, key, None) for key in ("file", "table"))
    return next((name for name in found if name is not None), None)


def _is_in_file(table):
    """Whether a table stands for numbers in a file."""
    return _file_of(table) is not None


def _meant(field):
    """SI unit of a field, or the rule of its numbers, from its annotation; None if it is no number."""
    candidates = [field.metadata, *(getattr(part, "__metadata__", ()) for part in typing.get_args(field.annotation))]
    found = (item for metadata in candidates for item in metadata if isinstance(item, str) or hasattr(item, "numbers"))
    return next(found, None)


def unit(table, keys):
    """SI unit of the field that keys lead to."""
    return _meant(type(value(table, keys[:-1])).model_fields[keys[-1]])


def value(table, steps):
    """Value at a place of a validated table: a number in SI, or the word that stands there."""
    for step in steps:
        table = table[step] if isinstance(step, int) or isinstance(table, dict) else getattr(table, step)
    return table


def with_values(table, values: dict):
    """Copy of a validated table with values by steps, as they are: numbers or arrays of designs."""
    return tree.with_values(table, values, lambda part, **fields: part.model_copy(update=fields))


def files(table, keys=()):
    """Keys that lead to each table that stands for numbers in a file, that table, and the file's name."""
    if isinstance(table, tuple):
        for number, part in enumerate(table):
            yield from files(part, (*keys, number))
    elif isinstance(table, Table):
        if _is_in_file(table):
            yield keys, table, _file_of(table)
        for name in type(table).model_fields:
            yield from files(getattr(table, name), (*keys, name))

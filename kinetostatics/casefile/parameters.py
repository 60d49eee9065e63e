"""What designs may vary: paths into a variant of a case file, such as "spring.stiffness" or "cam.centre.x"."""

import typing
from typing import Any

from .schema import Table

PARTS = {"x": 0, "y": 1, "along": 0, "across": 1}
"""Names of the components of a pair."""
GUIDE = ("guide_angle", "guide_offset")
"""What two points of the guide fix, if they are given."""


def paths(table) -> dict[str, str]:
    """Paths of all numbers in a validated table that can be varied, with their SI units."""
    found: dict[str, str] = {}
    if getattr(table, "table", None):  # a file of numbers
        return found
    for name, field in type(table).model_fields.items():
        value = getattr(table, name)
        unit = _unit(field)
        if name in GUIDE and getattr(table, "guide_through", None):
            continue
        if isinstance(value, Table):
            found |= {f"{name}.{path}": inner for path, inner in paths(value).items()}
        elif unit and isinstance(value, tuple):
            parts = ("along", "across") if name == "centre" and hasattr(table, "mass") else ("x", "y")
            found |= {f"{name}.{part}": unit for part in parts}
        elif unit:
            found[name] = unit
    return found


def _unit(field):
    """SI unit of a field: the text in its annotation; None if it is no number."""
    candidates = [field.metadata, *(getattr(part, "__metadata__", ()) for part in typing.get_args(field.annotation))]
    return next((item for metadata in candidates for item in metadata if isinstance(item, str)), None)


def value(table, path):
    """Value at a path of a validated table: a number in SI, or the word that stands there."""
    for name in path.split("."):
        table = getattr(table, name) if isinstance(table, Table) else table[PARTS[name]]
    return table


def with_values(table, values):
    """Copy of a validated table with values at some paths, as they are: numbers or arrays of designs."""
    own: dict[str, Any] = {}
    inner: dict[str, dict[str, Any]] = {}
    for path, value in values.items():
        name, _, rest = path.partition(".")
        if not rest:
            own[name] = value
        else:
            inner.setdefault(name, {})[rest] = value
    for name, changes in inner.items():
        current = getattr(table, name)
        if isinstance(current, Table):
            own[name] = with_values(current, changes)
        else:
            parts = list(current)
            for part, value in changes.items():
                parts[PARTS[part]] = value
            own[name] = tuple(parts)
    return table.model_copy(update=own)

"""Paths of the numbers in a parameter tree: "crank_length", "slider2.mass", "cam.centre.x", as in case files.

The rules of a part name its numbers and their units. `PATHS` of a part renames fields; "" drops the field's name.
`Batched` parameters may be arrays of designs.
"""

from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from . import checks
from .checks import broadcast_problem
from .lazy import cached_property
from .parameter_tree import Leaves, broadcast_shape, flatten, is_structural


class Place(NamedTuple):
    """Place of a number in a tree: field names and item indices from the outermost, and its rule."""

    steps: tuple[str | int, ...]
    rule: checks.Number

    def value(self, item) -> Any:
        for step in self.steps:
            item = item[step] if isinstance(step, int) else getattr(item, step)
        return item


def places_by_path(item, prefix="", label="", absent=False) -> dict[str, Place]:
    """Place by path of every number of a part, also zeros; a label is appended to the first name.

    With `absent` also the numbers that are None.
    """
    names = getattr(type(item), "PATHS", {})
    found = {}
    for field, rule in _rules(item).items():
        name = names.get(field, field)
        path = f"{prefix}{name}{label}" if name else prefix.removesuffix(".")
        for inner, place in _of_value(getattr(item, field), rule, path, label if not name else "", absent).items():
            found[inner] = place._replace(steps=(field, *place.steps))
    return found


def _rules(item):
    rules = getattr(item, "RULES", None)
    if rules is not None:
        return rules.rules
    if not is_dataclass(item):
        return {}
    return {field.name: checks.Number("") for field in fields(item) if not is_structural(field)}


def _of_value(value, rule, path, label, absent):
    rule = rule.rule if isinstance(rule, checks.Optional | checks.OrFunction) else rule
    if isinstance(rule, checks.Number) and (_is_number(value) or (absent and value is None)):
        return {path: Place((), rule)}
    if hasattr(rule, "numbers") and value is not None:
        return {f"{path}.{name}": Place(steps, inner) for name, steps, inner in rule.numbers(value)}
    if isinstance(value, tuple):
        found: dict[str, Place] = {}
        counts: dict[str, int] = {}
        for number, part in enumerate(value):
            named = getattr(part, "PATH", "")
            counts[named] = counts.get(named, 0) + 1
            again = str(counts[named]) if named and counts[named] > 1 else ""
            inner = places_by_path(part, f"{named}{again}." if named else "", getattr(part, "label", ""), absent)
            found |= {name: place._replace(steps=(number, *place.steps)) for name, place in inner.items()}
        return found
    return places_by_path(value, f"{path}." if path else "", label, absent)


def replace_checked(item, **values):
    """Copy of a dataclass with some fields changed, checked as by its constructor."""
    made = object.__new__(type(item))
    for field in fields(item):
        object.__setattr__(made, field.name, values.get(field.name, getattr(item, field.name)))
    if hasattr(made, "__post_init__"):
        made.__post_init__()
    elif hasattr(made, "RULES"):
        made.RULES.admit(made)
    return made


def with_values(item, values: dict, changed=replace_checked):
    """Copy of a tree with other values by steps; ``changed(part, **fields)`` copies a part, by default with checks.

    A tree consists of tuples, mappings, and parts with fields.
    """
    if () in values:
        return values[()]
    inner: dict[Any, dict] = {}
    for (first, *rest), value in values.items():
        inner.setdefault(first, {})[tuple(rest)] = value

    def anew(place, part):
        return with_values(part, inner[place], changed) if place in inner else part

    if isinstance(item, tuple):
        return tuple(anew(place, part) for place, part in enumerate(item))
    if isinstance(item, dict):
        return {name: anew(name, part) for name, part in item.items()}
    return changed(item, **{name: anew(name, getattr(item, name)) for name in inner})


def _is_number(value):
    """Whether a value is a number, or an array with one for each design."""
    return isinstance(value, float) or (isinstance(value, np.ndarray) and value.shape[-1:] in ((), (1,)))


class Batched:
    """A dataclass of parameters, which may be arrays of designs."""

    @cached_property
    def batch(self):
        """Common shape of the arrays of designs among the parameters; () for a single design.

        An array of one axis is a table of a cam or load, not a batch.
        """
        leaves = Leaves()
        flatten(self, leaves)
        try:
            return broadcast_shape((), *(leaf for leaf in (*leaves.numbers, *leaves.tables) if np.ndim(leaf) > 1))
        except ValueError:
            raise _shape_error(self) from None


def _shape_error(item):
    """Error that names the arrays of designs in an item whose shapes do not broadcast."""
    shapes = {path: np.shape(place.value(item)) for path, place in places_by_path(item).items()}
    problem = broadcast_problem(**{path: shape for path, shape in shapes.items() if len(shape) > 1})
    return ParameterError(f"{getattr(item, 'name', type(item).__name__)}: {problem}")

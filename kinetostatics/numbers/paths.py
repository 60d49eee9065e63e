"""Names of the numbers in a parameter tree: "crank_length", "slider2.mass", "cam.centre.x", as in case files.

A part tells by the rules of its fields (`checks.fields`) what its numbers are, with their units, and by `PATHS` what a
field is called where that is not its name; "" stands for a part whose fields are called as they are.

Parameters that may be arrays of designs, and the shape that these have in common.
"""

from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from . import checks
from .checks import fitting
from .lazy import cached_property
from .parameter_tree import Leaves, broadcast_shape, flatten, is_structural


class Place(NamedTuple):
    """Where a number stands in a tree: names of fields and numbers of items, from the outermost; and its rule."""

    steps: tuple[str | int, ...]
    rule: checks.Number

    def value(self, item) -> Any:
        for step in self.steps:
            item = item[step] if isinstance(step, int) else getattr(item, step)
        return item


def places_by_path(item, prefix="", label="", absent=False) -> dict[str, Place]:
    """Place by path of every number of a part, zeros among them; a label goes behind the first name.

    If wanted, those `absent` too: numbers that might stand where there is None.
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
    """Copy of a dataclass with other values in some fields, checked as its constructor does."""
    made = object.__new__(type(item))
    for field in fields(item):
        object.__setattr__(made, field.name, values.get(field.name, getattr(item, field.name)))
    if hasattr(made, "__post_init__"):
        made.__post_init__()
    elif hasattr(made, "RULES"):
        made.RULES.admit(made)
    return made


def with_values(item, values: dict, changed=replace_checked):
    """Copy of a tree with other values, by steps; ``changed(part, **fields)`` copies a part: checked anew, unless told.

    A tree is made of tuples, mappings, and parts with fields.
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
    """Whether a value is one number, or one for each of some designs."""
    return isinstance(value, float) or (isinstance(value, np.ndarray) and value.shape[-1:] in ((), (1,)))


class Batched:
    """A dataclass of parameters, which may be arrays of designs."""

    @cached_property
    def batch(self):
        """Shape that arrays of designs among the parameters have in common; () for a single design.

        An array of one axis is a table (of a cam, of a load over the crank angles), not a batch.
        """
        leaves = Leaves()
        flatten(self, leaves)
        try:
            return broadcast_shape((), *(leaf for leaf in (*leaves.numbers, *leaves.tables) if np.ndim(leaf) > 1))
        except ValueError:
            raise _shape_error(self) from None


def _shape_error(item):
    """Error that names the arrays of designs in an item, which do not fit together."""
    shapes = {path: np.shape(place.value(item)) for path, place in places_by_path(item).items()}
    problem = fitting(**{path: shape for path, shape in shapes.items() if len(shape) > 1})
    return ParameterError(f"{getattr(item, 'name', type(item).__name__)}: {problem}")

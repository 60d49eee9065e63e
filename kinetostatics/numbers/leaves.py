"""Parameter trees: what a scene is apart from its numbers, the numbers, and both put together again.

A scene is a tree of dataclasses and tuples. Its *structure*, a hashable nest of tuples, tells the kinds of parts,
names, assemblies, and what is absent: a plain zero. Its *leaves* are the numbers, in the order of the structure, each a
float or an array of designs (..., 1); its *tables* are arrays with a value for each crank angle. Programs are kept by
structure, so that new numbers never make a new program.
"""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from .lazy import cached_property


class _Mark:
    """Stands in a structure where a leaf was taken out."""

    def __init__(self, name):
        self._name = name

    def __repr__(self):
        return self._name

    def __reduce__(self):
        return self._name


NUMBER, TABLE, PART = _Mark("NUMBER"), _Mark("TABLE"), _Mark("PART")
STRUCTURAL = (bool, int, str)
"""Types of dataclass fields that are no numbers: an assembly, a name; others may say so, by their metadata."""
FLOATS = frozenset((float,))


class Kept(float):
    """A zero that stays a leaf, so that it can be given another value."""


class Axis(tuple):
    """Unit vector along an axis, which belongs to the structure, so that what it turns is known to be exact."""

    @staticmethod
    def of(pair):
        """A pair, as an axis if it is one of plain numbers."""
        if set(map(type, pair)) != FLOATS or sorted(map(abs, pair)) != [0.0, 1.0]:
            return pair
        return Axis(part + 0.0 for part in pair)  # structures that are equal have one zero, which has no sign


class Leaves:
    """Leaves of an item, in the order of its structure.

    Attributes
    ----------
    numbers : list of float or array (..., 1)
    tables : list of array
        With a value for each crank angle.
    parts : list
        That declare `TABULATED`, as sampled cams do: they are computed beforehand, not recorded.
    lasting : bool
        Whether the structure tells all else; False with objects of the user's that may change unseen.
    """

    def __init__(self):
        self.numbers, self.tables, self.parts, self.lasting = [], [], [], True

    @cached_property
    def are_plain(self):
        """Whether all are plain numbers, and the structure tells all else."""
        return self.lasting and not self.tables and FLOATS.issuperset(map(type, self.numbers))

    def shape(self, angles):
        """Shape (..., N) of scalar results at crank angles of a shape."""
        if self.are_plain:
            return angles
        arrays = [leaf.shape for leaf in (*self.numbers, *self.tables) if type(leaf) is not float]
        return np.broadcast_shapes(angles, *arrays) if arrays else angles

    def with_numbers(self, numbers):
        """The same with other numbers, in the same order."""
        other = Leaves()
        other.numbers, other.tables, other.parts, other.lasting = numbers, self.tables, self.parts, self.lasting
        return other


def put_together(structure, number: Callable[[], Any], table: Callable[[], Any], part: Callable[[], Any]):
    """The item of a structure, with leaves from functions that are called in order; nothing is checked anew."""
    if structure is NUMBER:
        return number()
    if structure is TABLE:
        return table()
    if structure is PART:
        return part()
    if isinstance(structure, Opaque):
        return structure.item
    if type(structure) is not tuple:
        return structure
    kind: Any = structure[0].item if isinstance(structure[0], Opaque) else structure[0]
    parts = structure[1:]
    made = [put_together(item, number, table, part) for item in parts]
    if kind is tuple:
        return tuple(made)
    return _filled(kind, made) if is_dataclass(kind) else kind(*made)


def _filled(kind: Any, values):
    """Item of a dataclass with values in its fields, nothing checked."""
    return made(kind, **{field.name: value for field, value in zip(fields(kind), values, strict=True)})


class Opaque:
    """A function or an object that is compared by what it is made of, and never looked into."""

    __slots__ = ("_key", "item")

    def __init__(self, item, key):
        self.item, self._key = item, key

    def __eq__(self, other):
        return isinstance(other, Opaque) and self._key == other._key

    def __hash__(self):
        return hash(self._key)


def mapped(item, number, special=None):
    """Copy of an item with ``number(value)`` in place of each leaf, nothing checked anew.

    `special` holds by type functions that copy an item in their own way.
    """
    for kind, copied in (special or {}).items():
        if isinstance(item, kind):
            return copied(item)
    if is_dataclass(item) and not getattr(item, "TABULATED", False):
        return with_fields(
            item,
            **{
                name: mapped(getattr(item, name), number, special)
                for name, structural in field_kinds(item)
                if not structural
            },
        )
    if isinstance(item, tuple | list):
        return tuple(mapped(part, number, special) for part in item)
    if isinstance(item, int | float | np.number) and item == 0:
        return item
    return number(item) if isinstance(item, int | float | np.number | np.ndarray) else item


def made(kind: Any, /, **values):
    """Item of a dataclass with values in its fields, nothing checked."""
    whole = object.__new__(kind)
    whole.__dict__.update(values)
    return whole


def with_fields(item, **changes):
    """Copy of a dataclass with some fields changed and nothing checked."""
    return made(type(item), **{field.name: getattr(item, field.name) for field in fields(item)} | changes)


def is_structural(field):
    """Whether a field of a dataclass belongs to the structure, and is no number."""
    return field.type in STRUCTURAL or bool(field.metadata.get("structural"))


def field_kinds(kind):
    """Names of the fields of a dataclass, and whether each belongs to the structure."""
    for field in fields(kind):
        yield field.name, is_structural(field)


def wider(shape, *parts):
    """Shape of results that depend on these parts too: numbers, arrays, or parameters with a `batch`."""
    more = [found for part in parts if (found := getattr(part, "batch", None) or getattr(part, "shape", ()))]
    return np.broadcast_shapes(shape, *more) if more else shape


# How each type is taken apart

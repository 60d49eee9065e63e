"""Parameter trees: a scene is flattened into a structure and its numbers, and rebuilt from them.

A scene is a tree of dataclasses and tuples. Its *structure*, a hashable nest of tuples, holds the kinds of parts,
names, assembly modes, and zeros, which count as absent. Its *leaves* are the numbers in the order of the structure,
each a float or an array of designs (..., 1). Its *tables* are arrays with a value for each crank angle. Programs are
cached by structure, so new numbers never make a new program. `flatten` runs for every scene that is solved, so it takes
microseconds: one function per type, written for its fields. `StructureCache` keeps results that all items of one
structure share.
"""

import itertools
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from functools import lru_cache
from types import FunctionType
from typing import Any

import numpy as np

from .fingerprint import LIBRARY, class_key, key_of
from .lazy import cached_property


class _Mark:
    """Place of a leaf in a structure."""

    def __init__(self, name):
        self._name = name

    def __repr__(self):
        return self._name

    def __reduce__(self):
        return self._name


NUMBER, TABLE, PART = _Mark("NUMBER"), _Mark("TABLE"), _Mark("PART")
STRUCTURAL_TYPES = (bool, int, str)
"""Types of dataclass fields that belong to the structure; metadata ``structural`` marks others."""
FLOATS = frozenset((float,))


class KeptZero(float):
    """A zero that stays a leaf, so that it can change."""


class Axis(tuple):
    """Unit vector along an axis; it belongs to the structure, so rotations by it are exact."""

    @staticmethod
    def of(pair):
        """The pair as an `Axis` if it is a unit vector of plain numbers along one, else unchanged."""
        if set(map(type, pair)) != FLOATS or sorted(map(abs, pair)) != [0.0, 1.0]:
            return pair
        return Axis(part + 0.0 for part in pair)  # no -0.0, so that equal structures are the same


class Leaves:
    """Leaves of an item, in the order of its structure.

    `numbers` are floats or arrays (..., 1), `tables` arrays with a value for each crank angle. `parts` declare
    `TABULATED`, as sampled cams do: they are evaluated beforehand, not recorded. `lasting`: structure and leaves are
    complete; False with user objects that may change unnoticed.
    """

    def __init__(self):
        self.numbers, self.tables, self.parts, self.lasting = [], [], [], True

    @cached_property
    def are_plain(self):
        """Whether all leaves are floats, and structure and leaves are complete."""
        return self.lasting and not self.tables and FLOATS.issuperset(map(type, self.numbers))

    def shape(self, angles):
        """Shape (..., N) of scalar results at crank angles of a shape."""
        if self.are_plain:
            return angles
        arrays = [leaf.shape for leaf in (*self.numbers, *self.tables) if type(leaf) is not float]
        return np.broadcast_shapes(angles, *arrays) if arrays else angles

    def with_numbers(self, numbers):
        """Copy with other numbers, in the same order."""
        other = Leaves()
        other.numbers, other.tables, other.parts, other.lasting = numbers, self.tables, self.parts, self.lasting
        return other


def unflatten(structure, number: Callable[[], Any], table: Callable[[], Any], part: Callable[[], Any]):
    """Item of a structure; the functions are called in order, one for each leaf; no checks."""
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
    made = [unflatten(item, number, table, part) for item in structure[1:]]
    if kind is tuple:
        return tuple(made)
    if is_dataclass(kind):
        return construct_unchecked(kind, **dict(zip((field.name for field in fields(kind)), made, strict=True)))
    return kind(*made)


class Opaque:
    """A function or object in a structure, compared by its key alone."""

    __slots__ = ("_key", "item")

    def __init__(self, item, key):
        self.item, self._key = item, key

    def __eq__(self, other):
        return isinstance(other, Opaque) and self._key == other._key

    def __hash__(self):
        return hash(self._key)


def map_numbers(item, number, special=None):
    """Copy of an item with ``number(value)`` in place of each leaf, without checks.

    `special` maps types to functions that copy items of these types instead.
    """
    for kind, copied in (special or {}).items():
        if isinstance(item, kind):
            return copied(item)
    if is_dataclass(item) and not getattr(item, "TABULATED", False):
        return replace_unchecked(
            item,
            **{
                name: map_numbers(getattr(item, name), number, special)
                for name, structural in field_kinds(item)
                if not structural
            },
        )
    if isinstance(item, tuple | list):
        return tuple(map_numbers(part, number, special) for part in item)
    if isinstance(item, int | float | np.number) and item == 0:
        return item
    return number(item) if isinstance(item, int | float | np.number | np.ndarray) else item


def construct_unchecked(kind: Any, /, **values):
    """Item of a dataclass with values by field, without checks."""
    whole = object.__new__(kind)
    whole.__dict__.update(values)
    return whole


def replace_unchecked(item, **changes):
    """Copy of a dataclass with some fields changed, without checks."""
    return construct_unchecked(
        type(item), **{field.name: getattr(item, field.name) for field in fields(item)} | changes
    )


def is_structural(field):
    """Whether a dataclass field belongs to the structure and has no number."""
    return field.type in STRUCTURAL_TYPES or bool(field.metadata.get("structural"))


def field_kinds(kind):
    """Name of each field of a dataclass, and whether it belongs to the structure."""
    for field in fields(kind):
        yield field.name, is_structural(field)


def broadcast_shape(shape, *parts):
    """Shape of results that also depend on these numbers, arrays, or parameters with a `batch`."""
    more = [found for part in parts if (found := getattr(part, "batch", None) or getattr(part, "shape", ()))]
    return np.broadcast_shapes(shape, *more) if more else shape


def flatten(item, leaves: Leaves):
    """Structure of an item; appends its leaves to `leaves`."""
    return _FLATTENERS[type(item)](item, leaves)


def _flatten_number(item, leaves):
    if item == 0.0:
        return 0.0
    leaves.numbers.append(float(item))
    return NUMBER


def _flatten_kept_zero(item, leaves):
    leaves.numbers.append(float(item))
    return NUMBER


def _flatten_array(item, leaves):
    if item.dtype != float:
        return _flatten_by_identity(item, leaves)
    if not item.shape:
        return _flatten_number(item, leaves)
    if item.shape[-1] == 1:
        leaves.numbers.append(item)
        return NUMBER
    leaves.tables.append(item)
    return TABLE


def _flatten_constants(item, leaves):
    """Array of one axis that is no function of the crank angle: its values belong to the structure."""
    if item.ndim == 1 and item.size > 1:
        return Opaque(item, (item.shape, item.tobytes()))
    return _flatten_array(item, leaves)


def _flatten_tabulated(item, leaves):
    leaves.parts.append(item)
    return PART


def _flatten_tuple(item, leaves):
    if FLOATS.issuperset(map(type, item)):  # most are
        leaves.numbers += filter(None, item)
        return (tuple, *[NUMBER if part else 0.0 for part in item])
    return (tuple, *[_FLATTENERS[type(part)](part, leaves) for part in item])


def _unchanged(item, leaves):
    return item


def _flatten_by_content(item, leaves):
    """Function or object compared by its key; without a key it may change unnoticed."""
    key = key_of(item)
    return _flatten_by_identity(item, leaves) if key is None else Opaque(item, key)


def _flatten_by_identity(item, leaves):
    leaves.lasting = False
    return Opaque(item, (id(item),))


class _Flatteners(dict):
    """Function that flattens items of a type, by type; made at the first item of a type."""

    def __missing__(self, kind):
        if getattr(kind, "TABULATED", False):
            found = _flatten_tabulated
        elif is_dataclass(kind):
            found = _dataclass_flattener(kind)
        elif issubclass(kind, tuple) and hasattr(kind, "_fields"):
            found = _named_tuple_flattener(kind)
        else:
            found = _flatten_number if issubclass(kind, np.floating | np.integer) else _flatten_by_identity
        self[kind] = found
        return found


_FLATTENERS: dict[Any, Callable] = _Flatteners()
_FLATTENERS |= dict.fromkeys((bool, str, type(None), Axis), _unchanged)
_FLATTENERS |= dict.fromkeys((float, int), _flatten_number)
_FLATTENERS |= dict.fromkeys((tuple, list), _flatten_tuple)
_FLATTENERS |= {np.ndarray: _flatten_array, KeptZero: _flatten_kept_zero, FunctionType: _flatten_by_content}
_CONSTANT_TYPES = frozenset((bool, int, float, str, type(None)))


_STRUCTURAL_SOURCE = """
    field_{name} = item.{name}
    if type(field_{name}) not in CONSTANT_TYPES:
        field_{name} = by_content(field_{name}, leaves)"""
_NUMERIC_SOURCE = """
    field_{name} = item.{name}
    if type(field_{name}) is float:
        if field_{name}:
            append(field_{name})
            field_{name} = NUMBER
        else:
            field_{name} = 0.0
    elif type(field_{name}) is ndarray:
        field_{name} = {of_array}(field_{name}, leaves)
    elif field_{name} is not None:
        field_{name} = by_type[type(field_{name})](field_{name}, leaves)"""
_READ_SOURCE, _, _TYPE_SOURCE = _NUMERIC_SOURCE.partition("item.{name}")
_ABSENT_SOURCE = (
    f"{_READ_SOURCE}item.{{name}}\n    if field_{{name}} is not None:{_TYPE_SOURCE.replace('    ', '        ')}"
)
"""The same for a field that is None by default: whether it is given comes first."""


def _dataclass_flattener(kind):
    """Function that flattens items of a dataclass; it runs for each part of each scene that is solved.

    Its source names the fields one after another, because Python 3.11 finds named attributes at a known place. A loop
    with `getattr` looks each up again, which made a scene's flattening 1.6 times as long.
    """
    over_angles = getattr(kind, "OVER_ANGLES", ())
    source = "def flattened(item, leaves):\n    append = leaves.numbers.append"
    absent = [field.name for field in fields(kind) if field.default is None]
    for name, structural in field_kinds(kind):
        of_array = "of_table" if name in over_angles else "of_constants"
        numeric = _ABSENT_SOURCE if name in absent else _NUMERIC_SOURCE
        source += (_STRUCTURAL_SOURCE if structural else numeric).format(name=name, of_array=of_array)
    source += f"\n    return (kind, {' '.join(f'field_{field.name},' for field in fields(kind))})"
    scope = {"kind": kind, "NUMBER": NUMBER, "CONSTANT_TYPES": _CONSTANT_TYPES, "by_type": _FLATTENERS}
    scope |= {"by_content": _flatten_by_content, "of_table": _flatten_array, "of_constants": _flatten_constants}
    exec(source, scope | {"ndarray": np.ndarray}, scope)
    flattened: Any = scope["flattened"]
    return flattened if kind.__module__.partition(".")[0] == LIBRARY else _with_class_key(kind, flattened)


def _with_class_key(kind, flattened):
    """The flattener for a user's class, whose methods and constants belong to the structure."""

    def with_key(item, leaves):
        key = class_key(kind, (kind,))
        own = _flatten_by_identity(kind, leaves) if key is None else Opaque(kind, key)
        return (own, *flattened(item, leaves)[1:])

    return with_key


def _named_tuple_flattener(kind):
    return lambda item, leaves: (kind, *[flatten(part, leaves) for part in item])


MAX_STRUCTURES = 256
"""Largest number of cached structures; the least recently used is dropped first."""


class LeafIndex(int):
    """Index of a number among the leaves of an item."""


class StructureCache:
    """A structure, as `flatten` returns it, and cached results valid for all its items, by question."""

    def __init__(self, structure):
        self.structure, self.known = structure, {}

    def __reduce__(self):
        return StructureCache, (self.structure,)

    @cached_property
    def numbered(self) -> Any:
        """The item with a `LeafIndex` in place of each number."""
        places = itertools.count()
        return unflatten(self.structure, lambda: LeafIndex(next(places)), lambda: None, lambda: None)

    def answer(self, question):
        """Result of ``question(self)``, computed once."""
        if question not in self.known:
            self.known[question] = question(self)
        return self.known[question]


@lru_cache(MAX_STRUCTURES)
def structure_cache(structure) -> StructureCache:
    """Cache of a structure."""
    return StructureCache(structure)


def come_from_one_class(kind, name, *others):
    """Whether `name` comes from the same class as the nearest definition of one of `others`.

    A subclass that overrides `push` alone makes an inherited `rate` wrong.
    """
    giving = (vars(one) for one in kind.__mro__ if not vars(one).keys().isdisjoint(others))
    return name in next(giving, ())

"""Scenes taken apart: the structure of each, and its leaves, in one pass by functions written for each type.

It is done for every scene that is solved, so it must take microseconds.
"""

from collections.abc import Callable
from dataclasses import fields, is_dataclass
from types import FunctionType
from typing import Any

import numpy as np

from .fingerprint import LIBRARY, key_of, of_class
from .leaves import NUMBER, PART, TABLE, Axis, Kept, Leaves, Opaque, field_kinds


def taken_apart(item, leaves: Leaves):
    """Structure of an item; its leaves are appended to `leaves`."""
    kind = type(item)
    if kind is float:
        if item == 0.0:
            return 0.0
        leaves.numbers.append(item)
        return NUMBER
    return (_TAKERS.get(kind) or _taker(kind))(item, leaves)


def _array(item, leaves):
    shape = item.shape
    if item.dtype != float:
        return _passing(item, leaves)
    if not shape:
        return taken_apart(float(item), leaves)
    if shape[-1] == 1:
        leaves.numbers.append(item)
        return NUMBER
    return _table(item, leaves)


def _table(item, leaves):
    leaves.tables.append(item)
    return TABLE


def _constants(item, leaves):
    """Array of one axis that has nothing to do with crank angles: what it holds belongs to the structure."""
    if item.ndim == 1 and item.size > 1:
        return Opaque(item, (item.shape, item.tobytes()))
    return taken_apart(item, leaves)


def _part(item, leaves):
    leaves.parts.append(item)
    return PART


def _tuple(item, leaves):
    found: list[Any] = [tuple]
    for part in item:
        kind = type(part)
        if kind is not float:
            found.append((_TAKERS.get(kind) or _taker(kind))(part, leaves))
        elif part != 0.0:
            leaves.numbers.append(part)
            found.append(NUMBER)
        else:
            found.append(0.0)
    return tuple(found)


def _as_it_is(item, leaves):
    return item


def _number(item, leaves):
    return taken_apart(float(item), leaves)


def _kept(item, leaves):
    leaves.numbers.append(float(item))
    return NUMBER


def _by_content(item, leaves):
    """What is compared by what it is made of, or taken apart each time where that may change unseen."""
    key = key_of(item)
    return _passing(item, leaves) if key is None else Opaque(item, key)


def _passing(item, leaves):
    leaves.lasting = False
    return Opaque(item, (id(item),))


_TAKERS: dict[type, Callable] = {
    int: _number,
    bool: _as_it_is,
    str: _as_it_is,
    type(None): _as_it_is,
    Axis: _as_it_is,
    tuple: _tuple,
    list: _tuple,
    np.ndarray: _array,
    Kept: _kept,
    FunctionType: _by_content,
}
_AS_THEY_ARE = frozenset((bool, int, float, str, type(None)))


def _taker(kind):
    """How items of a type are taken apart, found once: dataclasses and named tuples field by field."""
    if getattr(kind, "TABULATED", False):
        taker = _part
    elif is_dataclass(kind):
        taker = _of_dataclass(kind)
    elif issubclass(kind, tuple) and hasattr(kind, "_fields"):
        taker = _of_named_tuple(kind)
    else:
        taker = _number if issubclass(kind, np.floating | np.integer) else _passing
    _TAKERS[kind] = taker
    return taker


def _of_dataclass(kind):
    """Function written for the type, as a hand would write it: it runs for each part of each scene that is solved."""
    over_angles = getattr(kind, "OVER_ANGLES", ())
    lines = ["def taker(item, leaves):", "    append = leaves.numbers.append"]
    for place, (name, structural) in enumerate(field_kinds(kind)):
        array, value = "taken_apart" if name in over_angles else "constants", f"v{place}"
        lines.append(f"    {value} = item.{name}")
        if structural:
            lines.append(f"    if {value}.__class__ not in as_they_are: {value} = structural({value}, leaves)")
        else:
            lines += [
                f"    if {value}.__class__ is float:",
                *_of_float(value, 8),
                f"    elif {value}.__class__ is pair and len({value}) == 2:",
                f"        first, second = {value}",
                "        if first.__class__ is second.__class__ is float:",
                *_of_float("first", 12),
                *_of_float("second", 12),
                f"            {value} = pair, first, second",
                f"        else: {value} = taken_apart({value}, leaves)",
                f"    elif {value} is not None:",
                f"        kind = type({value})",
                f"        if kind is array: {value} = {array}({value}, leaves)",
                f"        else: {value} = (takers.get(kind) or taker_of(kind))({value}, leaves)",
            ]
    lines.append(f"    return (whole, {' '.join(f'v{place},' for place in range(len(fields(kind))))})")
    scope = {"whole": kind, "NUMBER": NUMBER, "taken_apart": taken_apart, "constants": _constants, "pair": tuple}
    scope |= {"structural": _by_content, "as_they_are": _AS_THEY_ARE, "array": np.ndarray}
    scope |= {"takers": _TAKERS, "taker_of": _taker}
    exec("\n".join(lines), scope)
    return scope["taker"] if kind.__module__.partition(".")[0] == LIBRARY else _with_its_class(kind, scope["taker"])


def _of_float(value, indent):
    """Lines that take a float."""
    lines = f"if {value} != 0.0:", f"    append({value})", f"    {value} = NUMBER", f"else: {value} = 0.0"
    return [" " * indent + line for line in lines]


def _with_its_class(kind, taker):
    """The same for a class of the user's: what its methods and constants are belongs to the structure."""

    def whole(item, leaves):
        key = of_class(kind, (kind,))
        if key is None:
            leaves.lasting = False
            key = (id(kind),)
        return (Opaque(kind, key), *taker(item, leaves)[1:])

    return whole


def _of_named_tuple(kind):
    return lambda item, leaves: (kind, *[taken_apart(part, leaves) for part in item])

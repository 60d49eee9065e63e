"""What a value is: a number, an array of numbers, or something else, and what to hand in instead."""

import datetime as dt
import numbers
from copy import copy
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from .measured import plain
from .problems import MEMORY

PLAIN = (int, float, np.integer, np.floating, Fraction, Decimal)


class UnfitError(Exception):
    """A value that is no number; the message says what it is and what to hand in."""


def known(value):
    """Whether the values can be looked at now."""
    if isinstance(value, np.ndarray):
        return value.dtype != object
    return value is None or isinstance(value, numbers.Real | str | list | tuple)


@cache
def _unfit(kind: Any):
    """Why no value of this type is a number, and what to hand in; None if it may be one."""
    for kinds, words in (
        ((bool, np.bool_), "a truth value; give a number"),
        ((complex, np.complexfloating), "a complex number; give a real one"),
        ((str, bytes), "a text; write a plain number in SI units, without quotes"),
        ((dt.date, dt.time, dt.timedelta, np.timedelta64), "a time; give a number in SI units"),
    ):
        if issubclass(kind, kinds):
            return words
    if issubclass(kind, (*PLAIN, list, tuple)) or kind is np.ndarray:
        return None
    if hasattr(kind, "units") or hasattr(kind, "unit"):
        return "a quantity with its unit; give the plain number in SI units, as by .to('{unit}').magnitude"
    if hasattr(kind, "to_numpy"):
        return "a labelled table; give its numbers, .to_numpy(), and as .to_numpy()[:, None] for a batch of designs"
    if issubclass(kind, np.ma.MaskedArray):
        return "a masked array; give a plain one, .filled(...)"
    if issubclass(kind, np.ndarray):
        return None
    arithmetic = all(hasattr(kind, f"__{name}__") for name in ("add", "sub", "mul", "truediv", "neg"))
    return None if arithmetic and not issubclass(kind, np.generic) else "no number"


def unfit(value):
    """Why a value is no number, and what to hand in; None if it may be one."""
    kind: Any = type(value)
    return _unfit(kind)


def number(value, table, unit=""):
    """The value as a float or a locked array of floats; as it came if its values cannot be looked at now.

    A quantity with its unit is converted to the one wanted.
    """
    value = plain(value, unit)
    if table and hasattr(value, "to_numpy") and np.ndim(value) == 1:
        value = plain(value.to_numpy(), unit)
    if words := unfit(value):
        raise UnfitError(words)
    if isinstance(value, PLAIN):
        try:
            return float(value)
        except OverflowError:
            raise UnfitError("too large") from None
    if isinstance(value, list | tuple):
        if not table:
            raise UnfitError(_as_designs(value))
        value = _array(value)
    elif isinstance(value, np.ndarray):
        value = np.asarray(value)
    shape = tuple(getattr(value, "shape", ()))
    if 0 in shape:
        raise UnfitError(f"of shape {shape}, which holds nothing")
    if not table and shape not in ((), (1,)) and (len(shape) < 2 or shape[-1] != 1):
        raise UnfitError(f"of shape {shape}; its last axis would be the crank angle, add one of length 1: [..., None]")
    if shape == () or (shape == (1,) and not table):
        return number(value.ravel()[0], table) if isinstance(value, np.ndarray) else value
    return _locked(value) if isinstance(value, np.ndarray) else value


def _as_designs(values):
    """What to write for a list or tuple where an array of designs may stand."""
    short = repr(values) if len(repr(values)) <= 60 else "..."
    kind, axis = type(values).__name__, "" if values and isinstance(values[0], list | tuple) else "[:, None]"
    return f"a {kind}; for a batch of designs write np.array({short}){axis}"


def _array(values):
    """The items of a list as an array."""
    for kind in set(map(type, values)):
        if words := _unfit(kind):
            raise UnfitError(f"with {words}")
    try:
        return np.array(values)
    except ValueError:
        raise UnfitError("of rows of unequal length") from None


def _locked(array):
    """A copy of an array as floats that nobody writes to; of objects if they are numbers of another kind."""
    if array.dtype == float and array.flags.owndata and not array.flags.writeable:
        return array
    if array.size * 8 > MEMORY:
        raise UnfitError(f"of {array.size} numbers, which would take {array.size * 8 // 10**9} GB of memory")
    kind: type = float
    if array.dtype == object:
        kinds = set(map(type, array.flat))
        for item in kinds:
            if words := _unfit(item):
                raise UnfitError(f"with {words}")
        kind = float if all(issubclass(item, PLAIN) for item in kinds) else object
    elif array.dtype.kind not in "iuf":
        raise UnfitError(f"of {array.dtype}; give real numbers")
    try:
        array = array.astype(kind)
    except OverflowError:
        raise UnfitError("with one that is too large") from None
    array.flags.writeable = False
    return array


def kept(item):
    """An object of the user's own as it is now: what is changed of it later is not seen."""
    values = getattr(item, "__dict__", {})
    arrays = {name: part.copy() for name, part in values.items() if isinstance(part, np.ndarray)}
    frozen = getattr(type(item), "__dataclass_params__", None)
    if not arrays and (not values or (frozen is not None and frozen.frozen)):
        return item
    item = copy(item)
    vars(item).update(arrays)
    return item

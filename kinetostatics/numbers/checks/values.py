"""Recognition and conversion of values: numbers, arrays, pint quantities; why a value is no number.

pint is not imported here: the caller of a quantity has imported pint, and its registry converts it. As in
case files an angle is no plain number: a quantity must contain as many radians as the unit, so 5 Hz is no crank speed.
"""

import datetime as dt
import numbers
import sys
from copy import copy
from decimal import Decimal
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np

from ...errors import ParameterError
from .messages import MAX_TABLE_MEMORY


class DimensionError(Exception):
    """A quantity has another dimension than the unit wanted; the message names both."""


def to_plain(value, unit):
    """Quantities, also in lists and object arrays, as numbers in a unit; other values unchanged.

    `DimensionError` if one has another dimension.
    """
    pint = sys.modules.get("pint")
    if pint is None or isinstance(value, int | float | np.floating) or not hasattr(pint, "Quantity"):
        return value
    if isinstance(value, pint.Quantity):
        return _converted(value, unit)
    if isinstance(value, pint.Unit):
        raise DimensionError(f"must be a number, got the unit {value} without one")
    if isinstance(value, list | tuple):
        held = any(issubclass(kind, pint.Quantity | pint.Unit | list | tuple) for kind in set(map(type, value)))
        parts = [to_plain(part, unit) for part in value] if held else value
        return tuple(parts) if isinstance(value, tuple) else parts
    if isinstance(value, np.ndarray) and value.dtype == object:
        parts = value.ravel().tolist()
        held = any(isinstance(part, pint.Quantity | pint.Unit) for part in parts)
        return np.array([to_plain(part, unit) for part in parts], dtype=object).reshape(value.shape) if held else value
    inner = getattr(value, "data", None) if hasattr(value, "to_numpy") else None  # of xarray, whose to_numpy drops it
    return _converted(inner, unit) if isinstance(inner, pint.Quantity) else value


def to_plain_named(owner, name, value, unit):
    """As `to_plain`, with a `ParameterError` that names the value."""
    try:
        return to_plain(value, unit)
    except DimensionError as fault:
        raise ParameterError(f"{owner}: {name} {fault}") from None


def is_quantity(value):
    """Whether a value is a pint quantity."""
    pint = sys.modules.get("pint")
    return isinstance(value, getattr(pint, "Quantity", ()))


def _converted(quantity, unit):
    from pint import UndefinedUnitError

    if not unit:
        raise DimensionError(f"must be a plain number, as its unit is unknown, got {_quantity_text(quantity)}")
    registry = quantity._REGISTRY
    try:
        wanted = registry.parse_units("" if unit == "1" else unit)
    except UndefinedUnitError as fault:
        raise DimensionError(
            f"must be a number in {unit}, got {_quantity_text(quantity)}, in whose registry {fault}; "
            "give the plain number"
        ) from None
    given, expected = (_dimension(registry, units) for units in (quantity.units, wanted))
    if given != expected:
        raise DimensionError(
            f"must measure {_dimension_text(expected)}, {'as a ratio' if unit == '1' else f'in {unit}'}, got "
            f"{_quantity_text(quantity)}, which measures {_dimension_text(given)}"
            + (_NO_NUMBER.format(unit) if given | _NO_ANGLE == expected | _NO_ANGLE else "")
        )
    return _magnitude_in(quantity, wanted)


ANGLE = "[angle]"
_NO_ANGLE = {ANGLE: 0}
_NO_NUMBER = "; an angle is no plain number here: give .to('{}') where that is meant"


def _dimension(registry, units):
    """Powers of the dimensions, including the angle."""
    return {**registry.get_dimensionality(units), ANGLE: registry.get_root_units(units)[1]._units.get("radian", 0)}


def _magnitude_in(quantity, wanted):
    """Magnitude in a unit of the same dimension."""
    magnitude = quantity.magnitude
    if isinstance(magnitude, bool | complex | str) or getattr(magnitude, "dtype", np.dtype(float)).kind not in "iufO":
        return magnitude  # `to_number` refuses it
    if getattr(magnitude, "dtype", np.dtype(float)) in (np.float16, np.float32):  # otherwise converted in few digits
        quantity = quantity._REGISTRY.Quantity(magnitude.astype(float), quantity.units)
    try:
        return quantity.to(wanted).magnitude
    except TypeError:  # decimals in a registry of floats, or the other way round
        own, other = (float(quantity._REGISTRY.get_root_units(units)[0]) for units in (quantity.units, wanted))
        return np.asarray(magnitude, dtype=float)[()] * (own / other)


def _dimension_text(dimension):
    """Powers of dimensions as text."""
    over, under = (
        [name if abs(power) == 1 else f"{name}^{abs(power):g}" for name, power in dimension.items() if sign * power > 0]
        for sign in (1, -1)
    )
    return " / ".join([" ".join(over) or "1", *under]) if over or under else "a plain number"


def _quantity_text(quantity):
    """Short text of a quantity."""
    if np.ndim(quantity.magnitude):
        return f"an array in {quantity.units}"
    text = " ".join(str(quantity).split())
    return text if len(text) <= 80 else f"{text[:80]}..."


NUMBER_TYPES = (int, float, np.integer, np.floating, Fraction, Decimal)


class NotANumberError(Exception):
    """A value is not a number; the message gives its kind and the right argument."""


def has_known_values(value):
    """Whether the value can be compared now; False for traced numbers and enclosures."""
    if isinstance(value, np.ndarray):
        return value.dtype != object
    return value is None or isinstance(value, numbers.Real | str | list | tuple)


@cache
def _type_problem(kind: Any):
    """Reason why values of this type are not numbers, and the right argument; None if they may be numbers."""
    for kinds, words in (
        ((bool, np.bool_), "a truth value; give a number"),
        ((complex, np.complexfloating), "a complex number; give a real one"),
        ((str, bytes), "a text; write a plain number in SI units, without quotes"),
        ((dt.date, dt.time, dt.timedelta, np.timedelta64), "a time; give a number in SI units"),
    ):
        if issubclass(kind, kinds):
            return words
    if issubclass(kind, (*NUMBER_TYPES, list, tuple)) or kind is np.ndarray:
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


def not_a_number(value):
    """Reason why a value is not a number, and the right argument; None if it may be a number."""
    kind: Any = type(value)
    return _type_problem(kind)


def to_number(value, table, unit=""):
    """The value as a float or read-only array of floats, in a unit; traced numbers unchanged."""
    value = to_plain(value, unit)
    if table and hasattr(value, "to_numpy") and np.ndim(value) == 1:
        value = to_plain(value.to_numpy(), unit)
    if words := not_a_number(value):
        raise NotANumberError(words)
    if isinstance(value, NUMBER_TYPES):
        try:
            return float(value)
        except OverflowError:
            raise NotANumberError("too large") from None
    if isinstance(value, list | tuple):
        if not table:
            raise NotANumberError(_as_designs(value))
        value = _array_of_list(value)
    elif isinstance(value, np.ndarray):
        value = np.asarray(value)
    shape = tuple(getattr(value, "shape", ()))
    if 0 in shape:
        raise NotANumberError(f"of shape {shape}, which is empty")
    if not table and shape not in ((), (1,)) and (len(shape) < 2 or shape[-1] != 1):
        raise NotANumberError(
            f"of shape {shape}; its last axis would be the crank angle, add one of length 1: [..., None]"
        )
    if shape == () or (shape == (1,) and not table):
        return to_number(value.ravel()[0], table) if isinstance(value, np.ndarray) else value
    return _read_only_copy(value) if isinstance(value, np.ndarray) else value


def _as_designs(values):
    """Advice for a list or tuple in place of an array of designs."""
    short = repr(values) if len(repr(values)) <= 60 else "..."
    kind, axis = type(values).__name__, "" if values and isinstance(values[0], list | tuple) else "[:, None]"
    return f"a {kind}; for a batch of designs write np.array({short}){axis}"


def _array_of_list(values):
    """The items of a list as an array."""
    for kind in set(map(type, values)):
        if words := _type_problem(kind):
            raise NotANumberError(f"with {words}")
    try:
        return np.array(values)
    except ValueError:
        raise NotANumberError("of rows of unequal length") from None


def _read_only_copy(array):
    """Read-only copy of an array as floats; as objects if they are numbers of another kind."""
    if array.dtype == float and array.flags.owndata and not array.flags.writeable:
        return array
    if array.size * 8 > MAX_TABLE_MEMORY:
        raise NotANumberError(f"of {array.size} numbers, which would need {array.size * 8 // 10**9} GB of memory")
    kind: type = float
    if array.dtype == object:
        kinds = set(map(type, array.flat))
        for item in kinds:
            if words := _type_problem(item):
                raise NotANumberError(f"with {words}")
        kind = float if all(issubclass(item, NUMBER_TYPES) for item in kinds) else object
    elif array.dtype.kind not in "iuf":
        raise NotANumberError(f"of {array.dtype}; give real numbers")
    try:
        array = array.astype(kind)
    except OverflowError:
        raise NotANumberError("with one that is too large") from None
    array.flags.writeable = False
    return array


def snapshot(item):
    """Copy of a user's object, so that later changes have no effect; the object itself if it is immutable."""
    values = getattr(item, "__dict__", {})
    arrays = {name: part.copy() for name, part in values.items() if isinstance(part, np.ndarray)}
    frozen = getattr(type(item), "__dataclass_params__", None)
    if not arrays and (not values or (frozen is not None and frozen.frozen)):
        return item
    item = copy(item)
    vars(item).update(arrays)
    return item

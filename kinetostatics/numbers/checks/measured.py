"""Quantities of pint as plain numbers in the unit wanted; pint is not imported for it.

Whoever hands in a quantity has imported pint, and its own registry converts it. As in case files, an angle is no plain
number: a quantity must count as many radians as the unit wanted does, so 5 Hz is no crank speed.
"""

import sys

import numpy as np

from ...errors import ParameterError


class DimensionError(Exception):
    """A quantity of another dimension than is wanted; the message says of which."""


def plain(value, unit):
    """A quantity, or each that a list or array of objects holds, as numbers in a unit; all else as it is.

    Raises
    ------
    DimensionError
        It measures something else.
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
        parts = [plain(part, unit) for part in value] if held else value
        return tuple(parts) if isinstance(value, tuple) else parts
    if isinstance(value, np.ndarray) and value.dtype == object:
        parts = value.ravel().tolist()
        held = any(isinstance(part, pint.Quantity | pint.Unit) for part in parts)
        return np.array([plain(part, unit) for part in parts], dtype=object).reshape(value.shape) if held else value
    inner = getattr(value, "data", None) if hasattr(value, "to_numpy") else None  # of xarray, whose to_numpy drops it
    return _converted(inner, unit) if isinstance(inner, pint.Quantity) else value


def converted(owner, name, value, unit):
    """The same, with a `ParameterError` that calls the value by its name."""
    try:
        return plain(value, unit)
    except DimensionError as fault:
        raise ParameterError(f"{owner}: {name} {fault}") from None


def is_quantity(value):
    """Whether a value is a quantity itself."""
    pint = sys.modules.get("pint")
    return isinstance(value, getattr(pint, "Quantity", ()))


def _converted(quantity, unit):
    from pint import UndefinedUnitError

    if not unit:
        raise DimensionError(f"must be a plain number, as nothing tells its unit, got {_shown(quantity)}")
    registry = quantity._REGISTRY
    try:
        wanted = registry.parse_units("" if unit == "1" else unit)
    except UndefinedUnitError as fault:
        raise DimensionError(
            f"must be a number in {unit}, got {_shown(quantity)}, in whose registry {fault}; give the plain number"
        ) from None
    given, expected = (_dimension(registry, units) for units in (quantity.units, wanted))
    if given != expected:
        raise DimensionError(
            f"must measure {_named(expected)}, {'as a ratio' if unit == '1' else f'in {unit}'}, got "
            f"{_shown(quantity)}, which measures {_named(given)}"
            + (_NO_NUMBER.format(unit) if given | _NO_ANGLE == expected | _NO_ANGLE else "")
        )
    return _scaled(quantity, wanted)


ANGLE = "[angle]"
_NO_ANGLE = {ANGLE: 0}
_NO_NUMBER = "; an angle is no plain number here: give .to('{}') where that is meant"


def _dimension(registry, units):
    """Powers of the dimensions, the angle's among them."""
    return {**registry.get_dimensionality(units), ANGLE: registry.get_root_units(units)[1]._units.get("radian", 0)}


def _scaled(quantity, wanted):
    """The magnitude in a unit of the same dimension."""
    magnitude = quantity.magnitude
    if isinstance(magnitude, bool | complex | str) or getattr(magnitude, "dtype", np.dtype(float)).kind not in "iufO":
        return magnitude  # is refused for what it is
    if getattr(magnitude, "dtype", np.dtype(float)) in (np.float16, np.float32):  # else converted in so few digits
        quantity = quantity._REGISTRY.Quantity(magnitude.astype(float), quantity.units)
    try:
        return quantity.to(wanted).magnitude
    except TypeError:  # decimals in a registry of floats, or the other way round
        own, other = (float(quantity._REGISTRY.get_root_units(units)[0]) for units in (quantity.units, wanted))
        return np.asarray(magnitude, dtype=float)[()] * (own / other)


def _named(dimension):
    """Powers of dimensions as text."""
    over, under = (
        [name if abs(power) == 1 else f"{name}^{abs(power):g}" for name, power in dimension.items() if sign * power > 0]
        for sign in (1, -1)
    )
    return " / ".join([" ".join(over) or "1", *under]) if over or under else "a plain number"


def _shown(quantity):
    """The quantity, short."""
    if np.ndim(quantity.magnitude):
        return f"an array in {quantity.units}"
    text = " ".join(str(quantity).split())
    return text if len(text) <= 80 else f"{text[:80]}..."

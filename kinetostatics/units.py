"""Text with a unit ("300 mm", "320 rpm") to SI, read with pint. An angle is no plain number: 5 Hz is no crank speed."""

import math
import re
import tokenize
from functools import cache

_NUMBER_AND_UNIT = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(\S.*?)?\s*")


@cache
def _registry():
    import pint

    return pint.UnitRegistry(preprocessors=[lambda text: re.sub(r"\b(mm|cm|m|s)([23])\b", r"\1^\2", text)])


def to_si(text, unit):
    """Value in SI of a text such as "300 mm".

    Parameters
    ----------
    text : str
        A number and its unit.
    unit : str
        The SI unit wanted; anything that converts to it will do.

    Returns
    -------
    float

    Raises
    ------
    ValueError
        No number, no unit, an unknown unit or one of another dimension; the message says which.
    """
    found = _NUMBER_AND_UNIT.fullmatch(text) if isinstance(text, str) else None
    if found is None:
        raise ValueError(f"must be text of a number and a unit that converts to {unit}, found {text!r}")
    number, given = found.groups()
    if given is None:
        raise ValueError(f'has no unit; write for example "{number} {unit}"')
    value = float(number) * factor(given, unit)
    if not math.isfinite(value):
        raise ValueError(f"must be finite, found {text!r}")
    return value


@cache
def factor(given, unit):
    """What a number in a given unit is multiplied by to be in the SI unit; `ValueError` if it does not convert."""
    import pint

    registry = _registry()
    try:
        scale, base = registry.get_base_units(registry.parse_units(given))
    except (pint.PintError, ValueError, TypeError, AttributeError, SyntaxError, AssertionError, tokenize.TokenError):
        raise ValueError(f'unit "{given}" is not known; give one that converts to "{unit}"') from None
    if base != registry.get_base_units(registry.parse_units(unit))[1]:
        raise ValueError(f'"{given}" does not measure the same as "{unit}"; give a unit that converts to it')
    return scale


def base_factor(given):
    """What a number in a given unit is multiplied by to be in SI base units."""
    return factor(given, given)

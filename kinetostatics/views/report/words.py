"""Words and numbers as a reader wants them."""

import math
from decimal import ROUND_CEILING, Context, Decimal

DIGITS = 6
"""Significant digits of a number in a table, at most."""
PLAIN = 1e9
"""Size up to which a number is written without a power of ten."""
SIGNS = {"m2": "m²", "m3": "m³", "s2": "s²", "m^2": "m²", "m^3": "m³", "s^2": "s²", "deg": "°"}


def pretty(unit):
    """A unit with raised exponents and dots between its parts: "kg·m²", "m/s²"."""
    if unit in ("", "1"):
        return ""
    over = [_product(part) for part in unit.replace("**", "^").split("/")]
    return "/".join(over)


def _product(unit):
    return "·".join(SIGNS.get(part, part) for part in unit.replace("*", " ").split())


def number(value, digits=DIGITS):
    """A number with significant digits; "" for NaN."""
    if isinstance(value, str):
        return value
    value = float(value)
    if math.isnan(value):
        return ""
    digits = max(1, min(digits, DIGITS))
    text = f"{value + 0.0:.{digits}g}"
    if "e+" in text and abs(value) < PLAIN:  # then the last figures before the point are zeros
        text = f"{float(text):.0f}"
    return text.replace("inf", "∞")


def at_most(bound):
    """A bound with two digits, rounded up."""
    return number(float(Decimal(float(bound)).normalize(Context(2, ROUND_CEILING))), 2)


def angle(value):
    """A crank angle in degrees, to a hundredth."""
    return "" if math.isnan(value) else f"{round(value, 2) + 0.0:.2f}"

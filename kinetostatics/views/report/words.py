"""Words and numbers as a reader wants them."""

import math

from ...numbers import formatting as shown
from ...numbers.formatting import DIGITS

SIGNS = {"m2": "m²", "m3": "m³", "s2": "s²", "m^2": "m²", "m^3": "m³", "s^2": "s²", "deg": "°"}


def pretty(unit):
    """A unit with raised exponents and dots between its parts: "kg·m²", "m/s²"."""
    if unit in ("", "1"):
        return ""
    over = [_product(part) for part in unit.replace("**", "^").split("/")]
    return "/".join(over)


def _product(unit):
    return "·".join(SIGNS.get(part, part) for part in unit.replace("*", " ").split())


def number(value, digits=DIGITS, bound=0.0):
    """A number as all tables show it, infinity by its sign."""
    return shown.number(value, digits, bound).replace("inf", "∞")


def angle(value):
    """A crank angle in degrees, to a hundredth."""
    return "" if math.isnan(value) else f"{round(value, 2) + 0.0:.2f}"

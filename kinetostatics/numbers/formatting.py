"""How a number is shown to people, in every table and text: no digit that is not known, none that nobody reads."""

import math
from decimal import ROUND_CEILING, Context, Decimal

DIGITS = 6
"""Significant digits that are shown, at most."""
PLAIN = 1e9
"""Size up to which a number is written without a power of ten."""


def number(value, digits=DIGITS, bound=0.0):
    """A number as text; "" for NaN, a text as it is.

    Parameters
    ----------
    value : float or str
    digits : int
        Significant digits wanted.
    bound : float
        By how much it may be wrong, if that is known: it has no digit below the first of this, and is 0 within it.
    """
    if isinstance(value, str):
        return value
    value = float(value)
    if math.isnan(value):
        return ""
    if value == 0.0 or math.isinf(value):
        return f"{value + 0.0:g}"
    digits = max(1, min(digits, DIGITS))
    whole = digits == DIGITS
    if 0.0 < bound < math.inf:
        if abs(value) <= bound:
            return "0"
        known = power_of(value) - power_of(bound) + 1
        digits, whole = min(digits, known), whole and bound < 10.0
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < PLAIN:  # else the last figures before the point are zeros
        text = f"{value if whole else float(text):.0f}"
    return text


def power_of(value):
    """Power of ten of the first digit of a number."""
    return int(f"{value:e}".partition("e")[2])


def at_most(bound):
    """A bound with two digits, rounded up."""
    return number(float(Decimal(float(bound)).normalize(Context(2, ROUND_CEILING))), 2)


def about(uncertainty):
    """An uncertainty with two digits, rounded up, but not for less than a thousandth of it: 0.1 mm stay 0.1 mm."""
    return at_most(0.999 * uncertainty)

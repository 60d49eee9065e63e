"""Numbers, units and headings as people read them: in every table, text and explanation no digit that is not known.

This module alone decides how many digits a number has; command line, report, explanations and frames call it. Messages
of errors write the few numbers that they name themselves, with six digits as here.
"""

import math
import re
from decimal import ROUND_CEILING, Context, Decimal

from . import checks
from .texts import normalise
from .units import factor

DIGITS = 6
"""Significant digits that are shown, at most."""
MAX_PLAIN_NUMBER = 1e9
"""Size up to which a number is written without a power of ten."""
ANGLE_DECIMALS = 3
"""Decimals of a crank angle in degrees: as many as six digits of a turn have."""
DIGITS_OF = {"ratio": 4, "share [%]": 4, "power residual": 2}
"""Digits of what no reader takes so exactly, by column or row."""
UNIT_SIGNS = {"m2": "m²", "m3": "m³", "s2": "s²", "m^2": "m²", "m^3": "m³", "s^2": "s²", "deg": "°"}
_HEADING = re.compile(r"([^\[\]]*)(?:\[([^\[\]]*)\])?")
_ROUND_BRACKETS = re.compile(r"(.*?)\s*\(([^()]*)\)")
"""A heading with its unit in brackets that are not meant for it."""


def number(value, digits=DIGITS, bound=0.0, infinity="inf"):
    """A number as text; "" for NaN, a text as it is.

    Parameters
    ----------
    value : float or str
    digits : int
        Significant digits wanted.
    bound : float
        By how much it may be wrong, if that is known: it has no digit below the first of this, and is 0 within it.
    infinity : str
        Sign for infinity.
    """
    if isinstance(value, str):
        return value
    value = float(value)
    if math.isnan(value):
        return ""
    if math.isinf(value):
        return f"{'-' if value < 0.0 else ''}{infinity}"
    if value == 0.0:
        return "0"
    digits = max(1, min(digits, DIGITS))
    whole = digits == DIGITS
    if 0.0 < bound < math.inf:
        if abs(value) <= bound:
            return "0"
        known = power_of(value) - power_of(bound) + 1
        digits, whole = min(digits, known), whole and bound < 10.0
    text = f"{value:.{digits}g}"
    if "e+" in text and abs(value) < MAX_PLAIN_NUMBER:  # else the last figures before the point are zeros
        text = f"{value if whole else float(text):.0f}"
    return text


def power_of(value):
    """Power of ten of the first digit of a number."""
    return int(f"{value:e}".partition("e")[2])


def round_bound_up(bound):
    """A bound with two digits, rounded up."""
    return number(float(Decimal(float(bound)).normalize(Context(2, ROUND_CEILING))), 2)


def round_uncertainty_up(uncertainty):
    """An uncertainty with two digits, rounded up, but not for less than a thousandth of it: 0.1 mm stay 0.1 mm."""
    return round_bound_up(0.999 * uncertainty)


def angle(degrees):
    """A crank angle in degrees as text; "" for NaN, a text as it is."""
    return number(degrees if isinstance(degrees, str) else round(degrees, ANGLE_DECIMALS))


def shortest_exact(value):
    """A number as short as tells it exactly."""
    return repr(value).removesuffix(".0")


def digits_of(row, column=""):
    """Digits in which a number is told."""
    return DIGITS_OF.get(row, DIGITS_OF.get(column, DIGITS))


def pretty_unit(unit):
    """A unit with raised exponents and dots between its parts: "kg·m²", "m/s²"."""
    if unit in ("", "1"):
        return ""
    over = [_pretty_product(part) for part in unit.replace("**", "^").split("/")]
    return "/".join(over)


def _pretty_product(unit):
    return "·".join(UNIT_SIGNS.get(part, part) for part in unit.replace("*", " ").split())


def heading(name, unit):
    """Heading of a column."""
    return f"{name} [{unit}]"


def parse_heading(text):
    """Name and unit of a heading; the unit is empty where there is none."""
    found = _HEADING.fullmatch(str(text).strip())
    return (found[1].strip(), (found[2] or "").strip()) if found else (str(text).strip(), "")


def parse_user_heading(text):
    """Name and unit of a heading of a user's file, as the library writes them.

    Capital letters, blanks and hyphens in the name are no difference, and the unit may stand in round brackets:
    "Crank angle (deg)" heads crank_angle.
    """
    name, unit = parse_heading(text)
    rounded = None if unit else _ROUND_BRACKETS.fullmatch(name)
    name, unit = rounded.groups() if rounded else (name, unit)
    return "_".join(normalise(name).lower().replace("-", " ").split()), unit.strip()


def si_columns(columns, known=None, unknown=None):
    """Name and factor to SI of each column of a table of designs, and what is wrong with them.

    Parameters
    ----------
    columns : sequence of str
        Names, with the unit in brackets ("spring.stiffness [kN/m]") or none for SI.
    known : mapping of name to SI unit, optional
        What there is to vary; any name and unit will do if not given.
    unknown : function, optional
        Says what is wrong with a name that is none of these.

    Returns
    -------
    columns : tuple of (column, name, factor)
    problems : list of str
    """
    found: dict[str, tuple[str, str, float]] = {}
    problems = []
    for column in columns:
        name, unit = parse_heading(column)
        problem = None
        if known is not None and name not in known:
            problem = _round_bracket_problem(name, known)
            problem = problem or (unknown(name) if unknown else checks.choice("parameter", name, tuple(known)))
        if name in found:
            problem = f"parameter {name!r} has two columns"
        scale = 1.0
        if unit and not problem:
            try:
                scale = factor(unit, unit if known is None else known[name])
            except ValueError as error:
                problem = f"parameter {column!r}: {error}"
        found[name] = (column, name, scale)
        problems += [problem] if problem else []
    return tuple(found.values()), problems


def _round_bracket_problem(text, known):
    """What is wrong with the heading of a known name that has its unit in round brackets, or None."""
    found = _ROUND_BRACKETS.fullmatch(text)
    if not found or found[1] not in known:
        return None
    return f"parameter {text!r} has its unit in round brackets; write {heading(*found.groups())!r}"

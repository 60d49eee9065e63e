"""Numbers, units and headings as text for people: no table, text or explanation shows an uncertain digit.

This module alone decides the number of digits; command line, report, explanations and frames call it. Error messages
format their few numbers themselves, with six digits as here.
"""

import math
import re
import unicodedata
from dataclasses import fields
from decimal import ROUND_CEILING, Context, Decimal
from typing import TypeVar

from . import checks
from .units import factor

Result = TypeVar("Result")
DIGITS = 6
"""Largest number of significant digits shown."""
MAX_PLAIN_NUMBER = 1e9
"""Size below which a number has no power of ten."""
ANGLE_DECIMALS = 3
"""Decimals of a crank angle in degrees: six digits of a full turn."""
MAX_LISTED = 8
"""Numbers of an array that the text of a result lists; of a longer one it gives the shape."""
DIGITS_OF = {"ratio": 4, "share [%]": 4, "of total [%]": 4, "power residual": 2}
"""Significant digits of rough quantities, by column or row."""
UNIT_SIGNS = {"m2": "m²", "m3": "m³", "s2": "s²", "m^2": "m²", "m^3": "m³", "s^2": "s²", "deg": "°"}
_HEADING = re.compile(r"([^\[\]]*)(?:\[([^\[\]]*)\])?")
_ROUND_BRACKETS = re.compile(r"(.*?)\s*\(([^()]*)\)")
"""A heading with its unit in round brackets."""


def number(value, digits=DIGITS, bound=0.0, infinity="inf"):
    """A number as text, with at most `DIGITS` significant digits; "" for NaN, a text unchanged.

    No digit below the first digit of the `bound` on its error is shown, and a number within it is "0".
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


def plain(value, unit=""):
    """A value of a result with its unit as text; numbers in tuples, dicts and short arrays too have `DIGITS` digits."""
    if isinstance(value, dict):
        text = f"{{{', '.join(f'{key!r}: {plain(part)}' for key, part in value.items())}}}"
    elif isinstance(value, tuple) and not hasattr(value, "_fields"):
        text = f"({', '.join(map(plain, value))}{',' * (len(value) == 1)})"
    elif hasattr(value, "shape") and math.prod(value.shape) > MAX_LISTED:
        text = f"<array of shape {value.shape}>"
    elif getattr(value, "shape", ()):
        text = f"[{', '.join(map(plain, value))}]"
    elif isinstance(value, str | bool | int) or not hasattr(value, "__float__"):
        return repr(value)
    else:
        text = number(value) or "nan"
    return f"{text} {unit}" if unit not in ("", "1") else text


def with_units(**units):
    """Decorator of a dataclass or named tuple of results, whose `repr` gets these SI units by field.

    Fields that are None, or have ``repr=False``, are left out.
    """

    def text(result):
        own = getattr(result, "_fields", None) or [field.name for field in fields(result) if field.repr]
        values = ((name, getattr(result, name)) for name in own)
        shown = [f"{name}={plain(found, units.get(name, ''))}" for name, found in values if found is not None]
        return f"{type(result).__name__}({', '.join(shown)})"

    def decorate(kind: Result) -> Result:
        setattr(kind, "__repr__", text)  # noqa: B010 - an assignment to a method is no type
        return kind

    return decorate


def power_of(value):
    """Power of ten of the first digit of a number."""
    return int(f"{value:e}".partition("e")[2])


def round_bound_up(bound):
    """A bound as text with two digits, rounded up."""
    return number(float(Decimal(float(bound)).normalize(Context(2, ROUND_CEILING))), 2)


def round_uncertainty_up(uncertainty):
    """An uncertainty as text with two digits, rounded up unless by less than a thousandth: 0.1 mm stays 0.1 mm."""
    return round_bound_up(0.999 * uncertainty)


def angle(degrees):
    """A crank angle in degrees as text; "" for NaN, a text unchanged."""
    return number(degrees if isinstance(degrees, str) else round(degrees, ANGLE_DECIMALS))


def shortest_exact(value):
    """Shortest text that gives the number exactly."""
    return repr(value).removesuffix(".0")


def digits_of(row, column=""):
    """Significant digits of a number in this row and column."""
    return DIGITS_OF.get(row, DIGITS_OF.get(column, DIGITS))


def pretty_unit(unit):
    """A unit with superscripts and dots: "kg·m²", "m/s²"."""
    if unit in ("", "1"):
        return ""
    products = [factors.replace("*", " ").split() for factors in unit.replace("**", "^").split("/")]
    return "/".join("·".join(UNIT_SIGNS.get(part, part) for part in product) for product in products)


def heading(name, unit):
    """Heading of a column."""
    return f"{name} [{unit}]"


def normalise(text):
    """Text in Unicode's composed form (NFC), in which names are compared; any other value unchanged."""
    return unicodedata.normalize("NFC", text) if isinstance(text, str) else text


def parse_heading(text):
    """Name and unit of a heading "name [unit]"; the unit may be empty."""
    found = _HEADING.fullmatch(str(text).strip())
    return (found[1].strip(), (found[2] or "").strip()) if found else (str(text).strip(), "")


def parse_user_heading(text):
    """Name and unit of a heading in a user's file: "Crank angle (deg)" gives "crank_angle", "deg".

    Case, blanks and hyphens in the name do not matter, and the unit may stand in round brackets.
    """
    name, unit = parse_heading(text)
    rounded = None if unit else _ROUND_BRACKETS.fullmatch(name)
    name, unit = rounded.groups() if rounded else (name, unit)
    return "_".join(normalise(name).lower().replace("-", " ").split()), unit.strip()


def si_columns(columns, known=None, unknown=None):
    """Name and factor to SI of each column of a table of designs, and their faults.

    `columns` are names, with the unit in brackets ("spring.stiffness [kN/m]") or none for SI. `known` maps the numbers
    that can vary to their SI units; without it any name and unit is allowed. ``unknown(name)`` gives the fault of a
    name that is not known. Returns tuples of (column, name, factor), and a list of texts.
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
    """Fault of a known name with its unit in round brackets, as a sentence, or None."""
    found = _ROUND_BRACKETS.fullmatch(text)
    if not found or found[1] not in known:
        return None
    return f"parameter {text!r} has its unit in round brackets; write {heading(*found.groups())!r}"

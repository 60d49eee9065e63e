"""Units: text such as "300 mm" or "320 rpm" to SI, and the unit of a product of powers.

Numbers are written in ASCII digits with a decimal point and no thousands separators. A unit is a product or quotient of
names with small whole powers ("kN/mm", "kg m^2", "1/s"), read from left to right. An angle is no plain number: 5 Hz is
no crank speed. A table holds the usual names; pint, which takes half a second to load, converts others and gets only
names and powers.

A dimension is the tuple of the powers of m, kg and s; radians count as 1.
"""

import math
import re
import unicodedata
from fractions import Fraction
from functools import cache, partial

NUMBER = r"(?:[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?)"
"""Regular expression of a number in case files, tables and spreads."""
MAX_TEXT_LENGTH = 200
"""Largest number of characters of a text with a unit."""
_NUMBER_AND_UNIT = re.compile(
    rf"\s*({NUMBER})(?:\s*(?![eE][-+]?[0-9])((?:[^\W\d_]|[°%]).*?)|\s+(1(?:\s*(?:/|per\b).*?)?))?\s*", re.DOTALL
)
_USUAL = {"m": ("300", "mm"), "rad": ("90", "deg"), "rad/s": ("300", "rpm")}
"""Examples by SI unit as engineers write them, for advice."""
_FACTOR = re.compile(r"([^\W\d_][A-Za-z_]*|°[CF]?|%)(?:(?:\^|\*\*)?([-+]?[1-9])|([²³]))?")
_BETWEEN = re.compile(r"\s*(?:[*/·⋅]|\bper\b)\s*|\s+")
_DIGITS = re.compile(r"[-+−–]?\d(?:[\d.,'’_\s]*\d)?")
_SEPARATOR = re.compile(r"[.,'’_\s]")


ALSO_TAKEN = {"N m s": "N m s/rad"}
"""Unit with the angle that is accepted for a unit without it: of torsional dampers."""
BASES = ("meter", "kilogram", "second", "radian")
"""Base units by pint's names."""
_PREFIXES: dict[str, Fraction | int] = {"": 1, "k": 10**3, "M": 10**6, "m": Fraction(1, 10**3)}
_POWERS = {
    "m": (1, 0, 0, 0),
    "kg": (0, 1, 0, 0),
    "s": (0, 0, 1, 0),
    "rad": (0, 0, 0, 1),
    "N": (1, 1, -2, 0),
    "Pa": (-1, 1, -2, 0),
    "J": (2, 1, -2, 0),
    "W": (2, 1, -3, 0),
    "rad/s": (0, 0, -1, 1),
    "1": (0, 0, 0, 0),
}
"""Powers of the base units."""
_MULTIPLES: dict[str, tuple[Fraction | int, str]] = {
    **{prefix + "g": (scale / Fraction(1000), "kg") for prefix, scale in _PREFIXES.items()},
    **{
        prefix + unit: (scale, unit)
        for prefix, scale in _PREFIXES.items()
        for unit in ("m", "s", "N", "Pa", "J", "W", "rad")
    },
    "cm": (Fraction(1, 100), "m"),
    "t": (1000, "kg"),
    "min": (60, "s"),
    "h": (3600, "s"),
    "GPa": (10**9, "Pa"),
    "bar": (10**5, "Pa"),
    "deg": (Fraction(math.pi) / 180, "rad"),
    "degree": (Fraction(math.pi) / 180, "rad"),
    "rpm": (Fraction(math.pi) / 30, "rad/s"),
    "percent": (Fraction(1, 100), "1"),
}
USUAL_UNITS = {name: (scale, _POWERS[unit]) for name, (scale, unit) in _MULTIPLES.items()}
"""Exact factor to SI base units by name, and powers of these."""


@cache
def _registry():
    import pint

    return pint.UnitRegistry()


def to_si(text, unit):
    """Value in an SI unit of a text of a number and its unit, such as "300 mm".

    `ValueError` if the text has no number or no unit, or the unit is unknown or of another dimension.
    """
    readable = isinstance(text, str) and len(text) <= MAX_TEXT_LENGTH
    found = _NUMBER_AND_UNIT.fullmatch(text) if readable else None
    if found is None:
        advice = respelling_advice(text, _NUMBER_AND_UNIT.fullmatch) if readable else ""
        is_number = type(text) in (int, float) and math.isfinite(text)
        example = _spelling_examples(text, unit) if is_number else f'"{" ".join(_USUAL.get(unit, ("1.5", unit)))}"'
        raise ValueError(
            f"must be text of a number and a unit that converts to {unit}, found {quoted(text)}"
            + (advice or f"; write for example {example}")
        )
    number, given = found[1], found[2] or found[3]
    if given is None:
        raise ValueError(f"has no unit; write for example {_spelling_examples(number, unit)}")
    value = float(number) * factor(given, unit)
    if not math.isfinite(value) or (value == 0.0 and re.search("[1-9]", re.split("[eE]", number)[0])):
        raise ValueError(f"is too {'small' if value == 0.0 else 'large'} for double precision, found {text!r}")
    return value


def _spelling_examples(number, unit):
    """Examples of the number in the engineers' unit and in the SI unit."""
    return " or ".join(f'"{number} {one}"' for one in dict.fromkeys((_USUAL.get(unit, ("", unit))[1], unit)))


@cache
def factor(given, unit):
    """Factor from a given unit to the SI unit; `ValueError` if it does not convert."""
    scale, base = _base(given, unit)
    if base not in (_base(unit, unit)[1], _base(ALSO_TAKEN.get(unit.replace("*", " "), unit), unit)[1]):
        raise ValueError(f'"{given}" does not measure the same as "{unit}"; give a unit that converts to it')
    return scale


def unit_of_quantity(quantity):
    """Unit of a pint quantity as text; `ValueError` if its registry defines the unit differently."""
    unit = f"{quantity.units:~C}" or "1"
    base_factor(unit)
    theirs = quantity._REGISTRY.Quantity(1.0, quantity.units).to_root_units()
    ours = _registry().Quantity(1.0, _spelled_for_pint(_parts(unit))).to_root_units()
    if str(theirs.units) != str(ours.units) or not math.isclose(theirs.magnitude, ours.magnitude, rel_tol=1e-12):
        raise ValueError(f'unit "{unit}" is another in the registry of the quantity than here; give it in one of SI')
    return unit


def base_factor(given):
    """Factor from a given unit to SI base units."""
    return factor(given, given)


def base_dimensions(unit):
    """Powers of the base units in a unit, a frozenset of (name, power); `ValueError` for an unknown unit."""
    return frozenset(_base(unit, unit)[1].items())


@cache
def _base(given, unit):
    """Factor to base units, and their powers by name; the message names the wanted `unit`."""
    try:
        parts = _parts(given)
        scale, base, zero = _by_table(parts) if USUAL_UNITS.keys() >= {name for name, _ in parts} else _by_pint(parts)
    except ValueError:
        scale = None
    if scale is None or not 0 < scale < math.inf:
        remedy = "" if given == unit else f'; give one that converts to "{unit}"'
        raise ValueError(f'unit "{quoted(given)[1:-1]}" is not known{remedy}')
    if zero != 0.0:
        raise ValueError(
            f'unit "{given}" has its own zero point and is not proportional; give a unit whose '
            "zero is absolute, as K, or delta_degC for a difference"
        )
    return scale, base


def _by_table(parts):
    """Factor to base units, their powers, and the value 0.0 of a zero in base units."""
    scale, base = Fraction(1), dict.fromkeys(BASES, 0)
    for name, power in parts:
        size, powers = USUAL_UNITS[name]
        scale *= Fraction(size) ** power
        for part, exponent in zip(BASES, powers, strict=True):
            base[part] += power * exponent
    return float(scale), {part: exponent for part, exponent in base.items() if exponent}, 0.0


def _by_pint(parts):
    """Factor, powers and zero by pint; `ValueError` for an unknown name."""
    import pint

    registry = _registry()
    try:
        units = registry.parse_units(_spelled_for_pint(parts))
        scale, base = registry.get_base_units(units)
        return scale, dict(base._units), registry.Quantity(0.0, units).to_base_units().magnitude
    except (pint.PintError, TypeError, AttributeError) as error:
        raise ValueError(str(error)) from None


def _spelled_for_pint(parts):
    return "*".join(f"{name}**{power}" for name, power in parts) or "1"


def _parts(text):
    """Names and powers of the factors of a unit; `ValueError` if it has another form."""
    if len(text) > MAX_TEXT_LENGTH:
        raise ValueError("too long")
    reciprocal = re.match(r"\s*1\s*(?=/|per\b|$)", text)
    parts: list[tuple[str, int]] = []
    place = reciprocal.end() if reciprocal else 0
    while place < len(text):
        sign = 1
        if parts or reciprocal:
            between = _BETWEEN.match(text, place)
            if not between:
                raise ValueError("two names touch")
            sign = -1 if between[0].strip() in ("/", "per") else 1
            place = between.end()
        found = _FACTOR.match(text, place)
        if not found:
            raise ValueError("no name of a unit")
        if found[1] in ("ton", "tons"):
            raise ValueError("short, long or metric; t and tonne are clear")
        power = found[2] or ("3" if found[3] == "³" else "2" if found[3] else "1")
        parts.append((found[1].replace("°", "degree").replace("%", "percent"), sign * int(power)))
        place = found.end()
    if not parts and not reciprocal:
        raise ValueError("no unit")
    return tuple(parts)


def quoted(value, most=80):
    """The value as Python writes it, shortened."""
    if isinstance(value, dict | list | tuple | set):
        return f"a {type(value).__name__}"
    text = repr(value[: most + 1] if isinstance(value, str) else value)
    return text if len(text) <= most + 2 else f"{text[:most]}..."


def respelling_advice(text, readable):
    """Advice on numbers in a text that cannot be read; empty unless the new text is `readable`.

    A comma or blank counts as decimal point; before three digits also as thousands separator.
    """
    advice = []
    for choice in (0, -1):
        parts = re.split(r"(\.\.+)", text)
        read = [part if ".." in part else _DIGITS.sub(partial(_reading, choice), part) for part in parts]
        advice.append("".join(read).strip())
    advice = [f'"{found}"' for found in dict.fromkeys(advice) if found != text.strip() and readable(found)]
    return f"; write {' or '.join(advice)}" if advice else ""


def _reading(choice, found):
    return (_readings(found[0]) or [found[0]])[choice]


def _readings(text):
    """Possible readings of digits with separators, in plain ASCII."""
    text = "".join(str(unicodedata.digit(sign)) if sign.isdecimal() else sign for sign in text)
    text = re.sub("[−–]", "-", text)
    if re.fullmatch(NUMBER, text):
        return [text]
    found = _SEPARATOR.findall(text)
    first, *groups = _SEPARATOR.split(text)
    if not groups or any(len(group) != 3 for group in groups[:-1]) or len(set(found[:-1])) > 1:
        return []
    readings = []
    if found[-1] not in found[:-1] and (found[-1] in ".," or found == [" "]):
        readings.append("".join([first, *groups[:-1]]) + "." + groups[-1])
    if len(set(found)) == 1 and len(groups[-1]) == 3:
        readings.append(first + "".join(groups))
    return readings


DIMENSIONLESS = (0.0, 0.0, 0.0)


def dimension(unit):
    """Powers of m, kg and s of a unit such as "N*m*s/rad" or "m/s2"."""
    powers = _base(unit, unit)[1] if unit else {}
    return tuple(float(powers.get(base, 0)) for base in BASES[:3])


UNIT_NAMES = {
    dimension(name): name
    for name in (
        *("1", "m", "m2", "m3", "m4", "1/m", "1/m2", "kg", "kg m", "kg m2", "rad/s", "rad2/s2", "m/s", "m/s2"),
        *("N", "N/m", "N m", "N m2", "W", "N s", "N s/m", "Pa"),
    )
}


def unit_name(dimension):
    """Name of the unit with these powers of m, kg and s."""
    if dimension in UNIT_NAMES:
        return UNIT_NAMES[dimension]
    named = zip(("m", "kg", "s"), dimension, strict=True)
    return " ".join(base + (f"{count:g}" if count != 1 else "") for base, count in named if count)

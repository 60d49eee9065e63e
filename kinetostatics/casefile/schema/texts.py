"""Texts of a case file: numbers with units, or words instead, as pydantic types.

Each type ends with its SI unit; with it `build.places_by_path` finds the numbers that designs may vary.
"""

import math
from functools import partial
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from ...machine.loads import DEAD_CENTRES, WholeTurns
from ...numbers import checks
from ...numbers.units import quoted, to_si

MID_LENGTH = "mid-length"
BALANCE_THE_SLIDER = "balance the slider"


def reader(unit, *, low=None, strict=False):
    """Function that reads text with a unit, within bounds."""

    def read(text):
        value = to_si(text, unit)
        if low is not None and (value <= low if strict else value < low):
            raise ValueError(f"must be {'greater than' if strict else 'at least'} {low:g} {unit}, found {text!r}")
        return value

    return read


def value_reader(rule):
    """Function that returns the value to keep by a rule, or raises `ValueError`."""

    def take(value):
        found, problem = rule.check(value)
        if problem and isinstance(rule, checks.Sign):
            others = f", or one of {', '.join(map(repr, rule.words))}" if rule.words else ""
            raise ValueError(f"must be 1 or -1{others}, found {quoted(value)}")
        if problem:
            raise ValueError(problem.strip())
        return found

    return take


Length = Annotated[float, BeforeValidator(reader("m", low=0.0, strict=True)), "m"]
Coordinate = Annotated[float, BeforeValidator(reader("m")), "m"]
CubicStiffness = Annotated[float, BeforeValidator(reader("N/m^3")), "N/m^3"]
Angle = Annotated[float, BeforeValidator(reader("rad")), "rad"]
Mass = Annotated[float, BeforeValidator(reader("kg", low=0.0)), "kg"]
Inertia = Annotated[float, BeforeValidator(reader("kg m^2", low=0.0)), "kg m^2"]
Speed = Annotated[float, BeforeValidator(reader("rad/s")), "rad/s"]
AngularAcceleration = Annotated[float, BeforeValidator(reader("rad/s^2")), "rad/s^2"]
Modulus = Annotated[float, BeforeValidator(reader("Pa", low=0.0, strict=True)), "Pa"]
GravityAcceleration = Annotated[float, BeforeValidator(reader("m/s^2", low=0.0)), "m/s^2"]

_STIFFNESS = reader("N/m", low=0.0)
_COORDINATE = reader("m")


def with_alternative(read, words):
    """Function that reads a text; its error names the alternative in `words`."""

    def read_or_say(text):
        try:
            return read(text)
        except ValueError as error:
            raise ValueError(f"{error}; or write {words}") from None

    return read_or_say


def _stiffness(text):
    return text if text == BALANCE_THE_SLIDER else with_alternative(_STIFFNESS, f'"{BALANCE_THE_SLIDER}"')(text)


def list_reader(read_part, words, size=None, least=0):
    """Function that reads a list of `size` parts, or of at least `least` parts; `words` describe the list."""

    def read(value):
        if not isinstance(value, list | tuple) or len(value) < (size or least) or len(value) > (size or len(value)):
            raise ValueError(f"must be {words}, found {quoted(value)}")
        return tuple(map(read_part, value))

    return read


def pair_of(unit):
    """Function that reads a pair of texts with units."""
    return list_reader(partial(to_si, unit=unit), f'a pair such as ["0.1 {unit}", "0 {unit}"]', 2)


def series_of(unit, first="0.3", second="0.02", least=0):
    """Function that reads a list of texts with units; the example has two numbers."""
    words = f'a list such as ["{first} {unit}", "{second} {unit}"]'
    return list_reader(partial(to_si, unit=unit), words, least=least)


point = pair_of("m")
_two_points = list_reader(point, 'two points such as [["0 m", "0 m"], ["1 m", "0 m"]]', 2)


def _centre(value):
    if isinstance(value, str) and value == MID_LENGTH:
        return value
    return point(value) if isinstance(value, list) else (with_alternative(_COORDINATE, f'"{MID_LENGTH}"')(value), 0.0)


def _sampling(text):
    value = to_si(text, "rad")
    if not math.radians(0.001) <= value <= math.pi:
        raise ValueError(f"must be a step of the crank angle from 0.001 to 180 deg, found {text!r}")
    return value


def _period(text):
    period, problem = WholeTurns().check(to_si(text, "rad"))
    if problem:
        raise ValueError(f'must be a whole number of turns, such as "720 deg", found {text!r}')
    return period


def _zero(text):
    return text if text in DEAD_CENTRES else with_alternative(reader("rad"), '"TDC" or "BDC"')(text)


Weight = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0.0)]
Point = Annotated[tuple[float, float], BeforeValidator(point), "m"]
GuidePoints = Annotated[tuple[tuple[float, float], ...], BeforeValidator(_two_points)]
Centre = Annotated[tuple[float, float] | str, BeforeValidator(_centre), "m"]
Stiffness = Annotated[float | str, BeforeValidator(_stiffness), "N/m"]
Period = Annotated[float | None, BeforeValidator(_period)]
Sampling = Annotated[float | None, BeforeValidator(_sampling)]
Zero = Annotated[float | str | None, BeforeValidator(_zero)]
Sense = Annotated[Any, BeforeValidator(value_reader(checks.Sign()))]

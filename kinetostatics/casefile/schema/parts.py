"""Tables of groups and loads, made of the rules of their classes: keys, units and bounds are those of the fields."""

import re
from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BeforeValidator

from ...machine.cam_roller import CamRoller
from ...machine.cylinder_group import CylinderGroup
from ...machine.dyad import Dyad
from ...machine.guide import Guide
from ...machine.lever_group import LeverGroup
from ...machine.links import Link
from ...machine.loads import KINDS, Gravity, ProcessForce, Spring
from ...machine.loads.places import WORDS, Between, Place
from ...machine.pin import Pin
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.yoke_group import YokeGroup
from ...numbers import checks
from ...numbers.units import shown, to_si
from .tables import Cam, LinkTable, RollerTable, Table, list_of, one_of, value_in
from .texts import Angle, Coordinate, GuidePoints, Stiffness, pair_of, reader

GUIDE = {
    "guide_angle": (Angle | None, None),
    "guide_offset": (Coordinate | None, None),
    "guide_through": (GuidePoints | None, None),
}
"""Keys of a guide."""
MADE_OF: dict[type[Table], Any] = {}
"""Class of the group or load by its table."""


def field_of(rule) -> Any:
    """Type of what a rule allows, as a case file has it."""
    if isinstance(rule, checks.Optional):
        return field_of(rule.rule)
    if isinstance(rule, checks.OrFunction):
        return value_in(_spelled(rule.rule.unit))
    if isinstance(rule, checks.Number):
        unit = _spelled(rule.unit)
        return Annotated[float, BeforeValidator(reader(unit, low=rule.low, strict=rule.strict)), unit]
    if isinstance(rule, checks.Pair | Place | Between):
        return Annotated[Any, BeforeValidator(_numbers(rule)), rule]
    return Annotated[Any, BeforeValidator(by(rule))]


def _spelled(unit):
    """A unit as case files have it."""
    return unit.replace("**", "^").replace("*", " ")


def by(rule):
    """Function that takes a value by a rule."""

    def take(value):
        found, problem = rule.taken(value)
        if problem and isinstance(rule, checks.Sign):
            others = f", or one of {', '.join(map(repr, rule.words))}" if rule.words else ""
            raise ValueError(f"must be 1 or -1{others}, found {shown(value)}")
        if problem:
            raise ValueError(problem.strip())
        return found

    return take


def _numbers(rule):
    """Function that takes a pair, a point or two of them, numbers as text."""
    if isinstance(rule, Between):
        return _two_places
    return _place if isinstance(rule, Place) else pair_of(_spelled(rule.unit))


_NUMBER = re.compile(r"\s*[-+−–]?[.,]?\d")
"""What begins as a number does, so that it names no link."""
POINT = f'{WORDS}, such as "B", ["coupler", "0.5 m", "0.1 m"] or ["1 m", "0 m"]'


def _place(value):
    if isinstance(value, list) and len(value) in (2, 3):
        named = value[:1] if len(value) == 3 or not _NUMBER.match(str(value[0])) else []
        value = [*named, *(to_si(part, "m") for part in value[len(named) :])]
    elif not isinstance(value, str):
        raise ValueError(f"must be {POINT}, found {shown(value)}")
    return by(Place())(value)


def _two_places(value):
    if not isinstance(value, list) or len(value) != 2:
        raise ValueError(f"must be a pair of points, each {POINT}, found {shown(value)}")
    return tuple(map(_place, value))


def _table(word, kind, **other) -> Any:
    """Table of a kind, with other types of some fields; None leaves a field out."""
    defaults = {field.name: field.default for field in fields(kind)}
    found: dict[str, Any] = {"kind": (Literal[word], ...)}
    for name, rule in kind.RULES.rules.items():
        if other.get(name, rule) is None:
            continue
        if isinstance(rule, checks.Made) and rule.kind is Guide:
            found |= GUIDE
        elif isinstance(rule, checks.Made) and rule.kind is Link:
            found[name] = (LinkTable, LinkTable())
        else:
            default = ... if defaults[name] is MISSING else defaults[name]
            found[name] = (other.get(name) or field_of(rule), default)
    made = pydantic.create_model(f"{kind.__name__}Table", __base__=Table, __module__=__name__, **found)
    MADE_OF[made] = kind
    globals()[made.__name__] = made  # where pickle, on its way to workers, looks for it
    return made


GROUPS = {
    "slider": SliderGroup,
    "rocker": RockerGroup,
    "lever": LeverGroup,
    "cylinder": CylinderGroup,
    "yoke": YokeGroup,
    "dyad": Dyad,
    "pin": Pin,
    "cam roller": CamRoller,
}
OTHERS: dict[Any, dict[str, Any]] = {
    CamRoller: {"cam": Cam, "roller": RollerTable | None},
    Spring: {"stiffness": Stiffness},
    ProcessForce: {"period": None},  # a table has one, a constant none
}
"""Fields that a case file has in another way than their rules say."""
LOADS = {kind.PATH.replace("_", " "): kind for kind in KINDS if kind is not Gravity}


def _tables(kinds):
    return {word: _table(word, kind, **OTHERS.get(kind, {})) for word, kind in kinds.items()}


Groups = list_of(one_of("group", _tables(GROUPS)), "groups", 1)
Loads = list_of(one_of("load", _tables(LOADS)), "loads")

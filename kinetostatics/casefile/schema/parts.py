"""Tables of groups and loads from the rules of their classes: keys, units and bounds are those of the fields."""

import re
from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BeforeValidator

from ...machine.cams.cam_roller import CamRoller
from ...machine.crank import Pin
from ...machine.followers.swinging import SwingingFollower
from ...machine.followers.translating import FlatFollower, RollerFollower
from ...machine.groups.lever import CylinderGroup, LeverGroup
from ...machine.groups.planetary_crank import PlanetaryCrank
from ...machine.groups.rocker import Dyad, RockerGroup
from ...machine.groups.slider import SliderGroup
from ...machine.groups.yoke import YokeGroup
from ...machine.guide import Guide
from ...machine.links import Link
from ...machine.loads import KINDS, Gravity, ProcessForce, Sawing, Spring
from ...machine.loads.points import PLACE_FORMS, PlacePairRule, PlaceRule
from ...numbers import checks
from ...numbers.units import quoted, to_si
from .laws import Law
from .tables import Cam, FaceTable, LinkTable, RollerTable, Table, list_of, one_of, value_in
from .texts import Angle, Coordinate, GuidePoints, Stiffness, list_reader, pair_of, reader, value_reader

GUIDE_FIELDS = {
    "guide_angle": (Angle | None, None),
    "guide_offset": (Coordinate | None, None),
    "guide_through": (GuidePoints | None, None),
}
"""Keys of a guide."""
MADE_OF: dict[type[Table], Any] = {}
"""Class of a group or load by its table."""


def field_of(rule) -> Any:
    """Type of a field of a case file with this rule."""
    if isinstance(rule, checks.Optional):
        return field_of(rule.rule)
    if isinstance(rule, checks.OrFunction):
        return value_in(_case_unit(rule.rule.unit))
    if isinstance(rule, checks.Number) and rule.unit == "1":
        return Annotated[float, BeforeValidator(_ratio_reader(rule)), "1"]
    if isinstance(rule, checks.Number):
        unit = _case_unit(rule.unit)
        return Annotated[float, BeforeValidator(reader(unit, low=rule.low, strict=rule.strict)), unit]
    if isinstance(rule, checks.Pair | PlaceRule | PlacePairRule):
        read = _read_two_points if isinstance(rule, PlacePairRule) else _read_point
        if isinstance(rule, checks.Pair):
            read = pair_of(_case_unit(rule.unit))
        return Annotated[Any, BeforeValidator(read), rule]
    return Annotated[Any, BeforeValidator(value_reader(rule))]


def _case_unit(unit):
    """A unit in the spelling of case files."""
    return unit.replace("**", "^").replace("*", " ")


def _ratio_reader(rule):
    """Function that reads a plain number by the rule of a ratio."""
    take = value_reader(rule)

    def read(value):
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"must be a plain number, such as 1.3, found {quoted(value)}")
        return take(float(value))

    return read


_NUMBER = re.compile(r"\s*[-+−–]?[.,]?\d")
"""Begin of a number, which is no name of a link."""
POINT_FORMS = f'{PLACE_FORMS}, such as "B", ["coupler", "0.5 m", "0.1 m"] or ["1 m", "0 m"]'


def _read_point(value):
    if isinstance(value, list) and len(value) in (2, 3):
        named = value[:1] if len(value) == 3 or not _NUMBER.match(str(value[0])) else []
        value = [*named, *(to_si(part, "m") for part in value[len(named) :])]
    elif not isinstance(value, str):
        raise ValueError(f"must be {POINT_FORMS}, found {quoted(value)}")
    return value_reader(PlaceRule())(value)


_read_two_points = list_reader(_read_point, f"a pair of points, each {POINT_FORMS}", 2)


def _table_model(word, kind, **other) -> Any:
    """Pydantic model of a group or load, with other types for some fields; None omits a field."""
    defaults = {field.name: field.default for field in fields(kind)}
    found: dict[str, Any] = {"kind": (Literal[word], ...)}
    for name, rule in kind.RULES.rules.items():
        if other.get(name, rule) is None:
            continue
        if isinstance(rule, checks.InstanceOf) and rule.kind is Guide:
            found |= GUIDE_FIELDS
        elif isinstance(rule, checks.InstanceOf) and rule.kind is Link:
            found[name] = (LinkTable, LinkTable())
        else:
            default = ... if defaults[name] is MISSING else defaults[name]
            found[name] = (other.get(name) or field_of(rule), default)
    made = pydantic.create_model(f"{kind.__name__}Table", __base__=Table, __module__=__name__, **found)
    MADE_OF[made] = kind
    globals()[made.__name__] = made  # pickle looks for it here
    return made


GROUPS = {
    "slider": SliderGroup,
    "rocker": RockerGroup,
    "lever": LeverGroup,
    "cylinder": CylinderGroup,
    "yoke": YokeGroup,
    "planetary crank": PlanetaryCrank,
    "dyad": Dyad,
    "pin": Pin,
    "cam roller": CamRoller,
    "roller follower": RollerFollower,
    "flat follower": FlatFollower,
    "swinging follower": SwingingFollower,
}
SPECIAL_FIELDS: dict[Any, dict[str, Any]] = {
    CamRoller: {"cam": Cam, "roller": RollerTable | None},
    RollerFollower: {"cam": Law, "roller": RollerTable | None},
    FlatFollower: {"cam": Law, "face": FaceTable | None},
    SwingingFollower: {"cam": Law, "roller": RollerTable | None},
    Spring: {"stiffness": Stiffness},
    ProcessForce: {"period": None},  # a table has one, a constant none
    Sawing: {"resistance": field_of(Sawing.RULES.rules["resistance"].rule), "pitch": None},  # no functions in files
}
"""Fields whose type in a case file differs from their rule."""
LOADS = {kind.PATH.replace("_", " "): kind for kind in KINDS if kind is not Gravity}


_tables = {word: _table_model(word, kind, **SPECIAL_FIELDS.get(kind, {})) for word, kind in (GROUPS | LOADS).items()}
Groups = list_of(one_of("group", {word: _tables[word] for word in GROUPS}), "groups", 1)
Loads = list_of(one_of("load", {word: _tables[word] for word in LOADS}), "loads")

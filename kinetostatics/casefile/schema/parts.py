"""Tables of groups and loads, made of the rules of their classes: keys, units and bounds are those of the fields."""

import re
from dataclasses import MISSING, fields
from typing import Annotated, Any, Literal

import pydantic
from pydantic import BeforeValidator

from ...machine.cams.cam_roller import CamRoller
from ...machine.crank import Pin
from ...machine.groups.lever import CylinderGroup, LeverGroup
from ...machine.groups.rocker import Dyad, RockerGroup
from ...machine.groups.slider import SliderGroup
from ...machine.groups.yoke import YokeGroup
from ...machine.guide import Guide
from ...machine.links import Link
from ...machine.loads import KINDS, Gravity, ProcessForce, Spring
from ...machine.loads.points import PLACE_FORMS, PlacePairRule, PlaceRule
from ...numbers import checks
from ...numbers.units import quoted, to_si
from .tables import Cam, LinkTable, RollerTable, Table, list_of, one_of, value_in
from .texts import Angle, Coordinate, GuidePoints, Stiffness, list_reader, pair_of, reader

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
    "dyad": Dyad,
    "pin": Pin,
    "cam roller": CamRoller,
}
SPECIAL_FIELDS: dict[Any, dict[str, Any]] = {
    CamRoller: {"cam": Cam, "roller": RollerTable | None},
    Spring: {"stiffness": Stiffness},
    ProcessForce: {"period": None},  # a table has one, a constant none
}
"""Fields whose type in a case file differs from their rule."""
LOADS = {kind.PATH.replace("_", " "): kind for kind in KINDS if kind is not Gravity}


_tables = {word: _table_model(word, kind, **SPECIAL_FIELDS.get(kind, {})) for word, kind in (GROUPS | LOADS).items()}
Groups = list_of(one_of("group", {word: _tables[word] for word in GROUPS}), "groups", 1)
Loads = list_of(one_of("load", {word: _tables[word] for word in LOADS}), "loads")

MEANINGS = {
    "guide_angle": "Direction of the guide, from +x.",
    "guide_offset": "Distance of the guide from O, to the left of its direction.",
    "guide_through": "Two points that the guide runs through, in place of angle and offset.",
    "label": "Put behind the names of its links and forces, to tell groups of one kind apart.",
    "on": "Joint that it hangs on.",
    "pin": "Name of the joint that it adds.",
    "pivot": "Fixed pivot.",
    "pivot_name": "Name of the joint at the pivot.",
    "coupler": "Mass properties of the coupler, from the joint that it hangs on toward `pin`.",
    "against": "Link that takes the opposite torque; the frame unless told.",
    "between": "Two points; at most one of them fixed.",
    # groups
    "slider.coupler_length": "From the joint that it hangs on to `pin`.",
    "slider.assembly": "1: slider ahead of the inner joint along the guide, -1: behind; the words pass change points.",
    "slider.slider": "Mass properties of the slider, from `pin` along the guide.",
    "rocker.coupler_length": "From the joint that it hangs on to `pin`.",
    "rocker.rocker_length": "From the pivot to `pin`.",
    "rocker.assembly": "1: `pin` left of the direction from inner joint to pivot; the words pass change points.",
    "rocker.rocker": "Mass properties of the rocker, from the pivot toward `pin`.",
    "lever.offset": "Of the slot's axis to the left of the pivot.",
    "lever.lever": "Mass properties of the lever, from the pivot along the slot.",
    "lever.block": "Mass properties of the block, from its pin along the slot.",
    "lever.assembly": "1: the slot points to the block, -1: away from it; the words pass change points.",
    "cylinder.rod": "Mass properties of the rod, from its pin toward the pivot.",
    "cylinder.cylinder": "Mass properties of the cylinder, from the pivot toward the rod's pin.",
    "yoke.slot_angle": "From the guide's direction.",
    "yoke.slider": "Mass properties of the slider, from `pin` along the guide.",
    "yoke.block": "Mass properties of the block, from its pin along the slot.",
    "dyad.length1": "From the first of both joints to `pin`.",
    "dyad.length2": "From the second of both joints to `pin`.",
    "dyad.on": "Both joints that it hangs on.",
    "dyad.assembly": "1: `pin` left of the direction from the first joint to the second, -1: right.",
    "dyad.dyad1": "Mass properties of the first link, from its joint toward `pin`.",
    "dyad.dyad2": "Mass properties of the second link, from its joint toward `pin`.",
    "pin.on": 'Link that it is fixed to, or "frame".',
    "pin.at": "From the link's reference joint along it and across it; on the frame x and y from O.",
    "pin.name": "Name of the joint that it adds.",
    "cam roller.cam": "The path of the roller centre A about O.",
    "cam roller.block": "Mass properties of block and roller, from A along the crank.",
    "cam roller.roller": "Size and material of the roller, for its contact pressure.",
    # loads
    "spring.stiffness": 'Of all springs together; "balance the slider": slider mass times crank speed squared.',
    "spring.free_position": "Coordinate of the slider's pin along its guide at which they are free.",
    "spring.on": "Slider that it acts on.",
    "spring.cubic": "The force grows by so much times the cube of the elongation.",
    "process force.force": "Positive in the direction of the slider's guide; or a file of values.",
    "process force.on": "Slider that it acts on.",
    "force.value": "The force; or a file of values.",
    "force.at": "Point where it acts.",
    "force.direction": "From +x, or from the axis of the link `along`.",
    "force.along": "Link that the direction turns with.",
    "point force.value": "Positive pushes the points apart; or a file of values.",
    "point spring.stiffness": "Of the spring.",
    "point spring.free_length": "Of the spring.",
    "point damper.coefficient": "Of the damper, along the line of the points.",
    "torque.value": "Counter-clockwise on the link; or a file of values.",
    "torque.on": "Link that it acts on.",
    "torsion spring.stiffness": "Of the spring.",
    "torsion spring.free_angle": "Angle of the link at which it is free, from +x or from the axis of `against`.",
    "torsion spring.on": "Link that it acts on.",
    "torsion spring.moment": "A constant couple besides.",
    "torsion damper.coefficient": "Of the damper.",
    "torsion damper.on": "Link that it acts on.",
}
"""Meaning of the keys of groups and loads, by kind and key, or by key alone."""

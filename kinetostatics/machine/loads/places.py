"""Places at which loads act: a joint, a place on a link, or a fixed point."""

from typing import Any

import numpy as np

from ...numbers import checks
from ...numbers.planar import moment
from ..group import FRAME, Point
from ..links import Wrench, arm, present

NUMBER = checks.Number("m")
WORDS = 'a joint ("B"), a place on a link ("coupler", along, across) or a fixed point (x, y)'


class Place:
    """Rule of a place; kept as a name, as (link, along, across), or as (x, y)."""

    def quick(self, value):
        if type(value) is str and value and value.isprintable():
            return value
        if type(value) is tuple and len(value) in (2, 3) and (len(value) == 3) == (type(value[0]) is str):
            numbers = [NUMBER.quick(part) for part in value[-2:]]
            return checks.UNSURE if checks.UNSURE in numbers else (*value[:-2], *numbers)
        return checks.UNSURE

    def taken(self, value, field=""):
        if isinstance(value, str):
            return checks.Name().taken(value, field)
        wrong = f"{field} must be {WORDS}, got {checks.shown(value)}"
        try:
            parts = list(value)
        except TypeError:
            return value, wrong
        names = [str(part) for part in parts[:1] if isinstance(part, str)]
        numbers = parts[len(names) :]
        if names and len(numbers) == 1:
            numbers = [*numbers, 0.0]
        if len(numbers) != 2 or any(isinstance(part, str) for part in numbers):
            return value, wrong
        of = ("along", "across") if names else ("x", "y")
        found = [NUMBER.taken(part, f"{field} {name}") for part, name in zip(numbers, of, strict=True)]
        return (*names, *(part for part, _ in found)), found[0][1] or found[1][1]

    def numbers(self, value):
        """Name, steps and rule of each number of a place, for paths."""
        if isinstance(value, str):
            return
        names = ("along", "across") if isinstance(value[0], str) else ("x", "y")
        for place, name in enumerate(names, len(value) - 2):
            yield name, (place,), NUMBER


class Between:
    """Rule of a pair of places."""

    rule = Place()

    def quick(self, value):
        if type(value) is not tuple or len(value) != 2:
            return checks.UNSURE
        found = tuple(self.rule.quick(part) for part in value)
        return checks.UNSURE if checks.UNSURE in found else found

    def taken(self, value, field=""):
        if not isinstance(value, tuple | list) or len(value) != 2:
            return value, f"{field} must be a pair of points, each {WORDS}, got {checks.shown(value)}"
        found = [self.rule.taken(part, f"{field} {number}") for number, part in enumerate(value, 1)]
        return tuple(part for part, _ in found), "; ".join(problem for _, problem in found if problem) or None

    def numbers(self, value):
        """Name, steps and rule of each number of both places, for paths."""
        for number, part in enumerate(value):
            for name, steps, rule in self.rule.numbers(part):
                yield f"{number + 1}.{name}", (number, *steps), rule


PLACE = Place()


def carrier(mechanism, place) -> Point:
    """The point of a link that a place is; a joint fixed to the frame is one of the link that turns about it."""
    if not isinstance(place, str):
        return Point(*place) if isinstance(place[0], str) else Point(FRAME, *place)
    point = mechanism.joints[place]
    turning = (link for link, joint in mechanism.references.items() if joint == place and point.link == FRAME)
    return next(map(Point, turning), point)


def acting(motion, place, force):
    """Link that a force at a place acts on, and its wrench there."""
    point = carrier(motion.mechanism, place)
    if point.link == FRAME:
        return FRAME, Wrench(force, None)
    direction = motion.placement.links[point.link].direction
    lever = arm(direction, present(point.along), present(point.across))
    return point.link, Wrench(force, moment(lever, force))


def problem(owner, field, place, mechanism) -> Any:
    """What is wrong with a place on a mechanism, as a sentence, or None."""
    if isinstance(place, str):
        if place in mechanism.links and place not in mechanism.joints:
            return f'{owner}: {field} is {place!r}, a link; name a place on it, ("{place}", along, across)'
        return checks.choice(f"{owner}: {field}", place, tuple(mechanism.joints))
    if isinstance(place[0], str):
        return checks.choice(f"{owner}: link of {field}", place[0], (*mechanism.links, FRAME))
    return None


def spelled(place):
    """How a place looks in a message."""
    if isinstance(place, str):
        return repr(place)
    words = (repr(part) if isinstance(part, str) else f"{part:.6g}" for part in place if not np.ndim(part))
    return f"({', '.join(words)})"

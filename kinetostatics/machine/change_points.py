"""Change points: where all links of a linkage lie in one line, found when it is made, and passed as inertia carries it.

Crank a, coupler b, rocker h and ground d of a four-bar; psi, the crank angle from the direction O -> O2, is never
reduced to one turn. With A -> O2 of length e, four times the area of the triangle A B O2 is the root of
((b+h)^2 - e^2) (e^2 - (b-h)^2), and

    e^2 = (d+a)^2 - 4 a d cos^2(psi/2) = (d-a)^2 + 4 a d sin^2(psi/2)

so that one factor is a whole square where a + d = b + h ("far": A is farthest from O2), the other where
|d - a| = |b - h| ("near"). Its root with its sign, cos(psi/2) or sin(psi/2), is smooth through the change point, and is
divided out of the rates. Where both hold the linkage is a parallelogram or a kite, whose other branch is its mirror
image in the line A O2; where a = d and b = h A meets O2 ("meeting"), and sin(psi/2) is divided out of e as well.

All vectors are taken in the frame that turns half as fast as the crank, in which A -> O2 is
((d-a) cos(psi/2), -(d+a) sin(psi/2)).

A slotted lever with its slot at offset o left of O2 carries A at s = +-2 sqrt(a d) sin(psi/2) along it where
|d - a| = |o|, with its sign through the change point; where a = d and o = 0 A meets O2, and the lever keeps to the left
normal of that frame.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from ..numbers.parameter_tree import with_fields
from ..numbers.planar import unturned

SIDES: dict[Any, int] = {"open": 1, "crossed": -1}
"""Words for an assembly that passes change points, and the side that it has where there is none."""
FAR, NEAR, MEETING, PARALLEL, KITE, RHOMBUS = "far", "near", "meeting", "parallel", "kite", "rhombus"
BOTH = "both"
"""Slider group with a coupler as long as the crank, on a guide through O."""
OPPOSITE = "opposite"
"""Slotted lever like one of the kind "near", mirrored."""
TWICE = (FAR, NEAR, MEETING, OPPOSITE)
"""Kinds of which a branch closes after two turns."""
ULPS = 8
"""Units in the last place of the longest length by which lengths that are meant to be equal may differ."""
CALLED = {
    "": "none",
    FAR: "a + d = b + h",
    NEAR: "|d - a| = |b - h|",
    MEETING: "a = d and b = h",
    PARALLEL: "a = h and b = d",
    KITE: "a = b and d = h",
    RHOMBUS: "a = b = h = d",
}
"""Kinds of four-bars as messages call them: crank a, coupler b, rocker h, ground d."""
SLIDING = {"": "none", FAR: "l = a - e", NEAR: "l = a + e", BOTH: "l = a and e = 0"}
"""Kinds of slider groups: crank a, coupler l, offset e of the guide."""
SLOTTED = {"": "none", MEETING: "a = d and o = 0", NEAR: "o = d - a", OPPOSITE: "o = a - d"}
"""Kinds of slotted levers: crank a, distance d from O to the pivot, offset o of the slot."""
FACING = {0: "x >= 0", 1: "x < 0 <= y", -1: "x < 0, y < 0"}
"""Quadrants in which a direction (x, y) is halved, its angle counted from -pi to pi."""


def of_rocker_group(group, throws):
    """How a rocker group on a pin of a crank passes its change points: its kind, and where O2 stands; "" without any.

    Raises
    ------
    ParameterError
        It hangs on no crank pin, or the designs of a batch are not all of one kind.
    """
    a, x, y, b, h = _known("rocker group", group, throws, group.pivot, group.coupler_length, group.rocker_length)
    d = np.sqrt(x * x + y * y)
    unit = _unit(a, b, h, d)
    far, near = abs(a + d - b - h) <= unit, abs(abs(d - a) - abs(b - h)) <= unit
    far, near = far & (d > unit), near & (d > unit)
    meeting = near & (abs(d - a) <= unit)
    kite = abs(a - b) + abs(d - h) < abs(a - h) + abs(d - b)
    cases = [far & meeting, far & near & kite, far & near, far, meeting, near]
    kind = np.select(cases, [RHOMBUS, KITE, PARALLEL, FAR, MEETING, NEAR], "")
    return _joined("rocker group", kind, CALLED, _facing(x, y))


def of_slider_group(group, throws):
    """How a slider group on a crank passes its change points, as `of_rocker_group` tells of a rocker group."""
    x, y = group.guide.direction
    a, x, y, b, e = _known("slider group", group, throws, (y, -x), group.coupler_length, group.guide.guide_offset)
    unit = _unit(a, b, abs(e))
    far, near = abs(b + e - a) <= unit, abs(b - e - a) <= unit
    kind = np.select([far & near, far, near], [BOTH, FAR, NEAR], "")
    return _joined("slider group", kind, SLIDING, _facing(x, y))


def of_lever_group(group, throws):
    """How a lever group on a crank passes its change points, as `of_rocker_group` tells of a rocker group."""
    a, x, y, o = _known("lever group", group, throws, group.pivot, group.offset)
    d = np.sqrt(x * x + y * y)
    unit = _unit(a, abs(o), d)
    near, opposite = abs(d - a - o) <= unit, abs(d - a + o) <= unit
    near, opposite = near & (d > unit), opposite & (d > unit)
    kind = np.select([near & opposite, near, opposite], [MEETING, NEAR, OPPOSITE], "")
    return _joined("lever group", kind, SLOTTED, _facing(x, y))


def _known(owner, group, throws, start, *lengths):
    """Distance of the pin from O, a direction as the pin sees it at crank angle 0, and lengths, all beyond double."""
    problem, throw = None, throws.get(group.on)
    if throw is None:
        where = f"it hangs on {group.on!r}" if group.on != "A" else "the crank pin slides in its slot"
        problem = f"assembly {group.assembly!r} is for a group on a pin of the crank at a constant radius, but {where}"
    elif not all(map(checks.known, (*throw.at, *start, *lengths))):
        problem = f"assembly {group.assembly!r} needs lengths that are known when the mechanism is made"
    checks.require(owner, f"{problem}; give +1 or -1" if problem else None)
    parts = (np.asarray(part, dtype=np.longdouble) for part in (*throw.at, *start, *lengths))
    *at, x, y = np.broadcast_arrays(*parts)[:4]
    radius, direction = throw._replace(at=at).polar
    x, y = unturned((x, y), direction)
    if direction is not None:
        y = np.where(abs(y) <= _unit(x), 0.0, y)
    return np.broadcast_arrays(radius, x, y, *(np.asarray(part, dtype=np.longdouble) for part in lengths))


def _unit(*lengths):
    return ULPS * np.spacing(np.max(lengths, axis=0).astype(float))


def _facing(x, y):
    return np.where(x >= 0, 0, np.where(y >= 0, 1, -1))


def _joined(owner, kind, called, facing):
    """Kind and facing in one text, where all designs have the same."""
    problems = [_several(kind, "change points", called)]
    if kind.flat[0]:
        problems.append(_several(facing, "directions", FACING))
    checks.require(owner, *problems)
    return f"{kind.flat[0]} {facing.flat[0]}" if kind.flat[0] else ""


def _several(found, what, called):
    """What is wrong with designs that are not of one kind, or None."""
    kinds, counts = np.unique(found, return_counts=True)
    if kinds.size == 1:
        return None
    texts = "; ".join(called[kind] for kind in kinds.tolist())
    return checks.Problem(
        f"designs that pass change points must be of one kind, but these have {what} {texts} (equal within {ULPS} ulp "
        "of the longest length); make a batch of each",
        found != kinds[counts.argmax()],
    )


def kink(group, throws):
    """What a chosen side makes of the motion at change points, in words; "" where there are none."""
    if type(group.assembly) is not int or group.on not in throws:
        return ""
    try:
        passing = replace(group, assembly="open").on_crank(throws)
        angles = passing.change_points(throws)
    except ParameterError:  # a batch of several kinds, or of several change points
        return ""
    if not angles:
        return ""
    named = dict.fromkeys(angles, "a kink")
    if parted(passing.passage)[0] in (MEETING, RHOMBUS):
        at = angles[0] if len(angles) == 1 else _first(throws[group.on], group.pivot) % (2 * math.pi)
        named[at] = f"a jump, as {group.on} meets the pivot"
    texts = " and ".join(f"{what} at {math.degrees(angle):.6g} deg" for angle, what in named.items())
    return f'assembly {group.assembly:+d} keeps to its side at change points: {texts}; "open" or "crossed" passes them'


def _first(throw, start):
    """Crank angle at which a pin of the crank stands in a direction, rad."""
    x, y = unturned(start, throw.polar[1])
    return math.atan2(y, x)


def parted(passage):
    """Kind, and where the direction from which the crank angle is halved points."""
    kind, facing = passage.split()
    return kind, int(facing)


def turns(passage):
    """Turns after which a branch closes."""
    return 2 if passage and parted(passage)[0] in TWICE else 1


def angles(group, throws, start):
    """Crank angles in [0, 2 pi) at which change points are passed, rad, from the direction that the kinds refer to."""
    if not group.passage:
        return ()
    throw = throws[group.on]
    several = "the designs of a batch pass change points at crank angles of their own: ask a single design"
    checks.require("change points", several if any(map(np.ndim, (*start, *throw.at))) else None)
    kind, first = parted(group.passage)[0], _first(throw, start)
    at = {FAR: (math.pi,), NEAR: (0.0,), MEETING: (0.0,), OPPOSITE: (0.0,)}.get(kind, (0.0, math.pi))
    turn = 2 * math.pi
    return tuple(
        sorted((first + angle) % turn % turn for angle in at)
    )  # what lies just below 0 is rounded up to a turn


class Passer:
    """What groups that may pass change points have in common.

    They give ``found_on(throws)``, how they pass them as `passage` tells, and ``start``, the direction from which their
    crank angle is halved.
    """

    assembly: Any
    passage: Any
    on: str
    is_close: bool
    through: bool
    found_on: Any
    start: Any

    @property
    def side(self):
        """+1 or -1: its side where no change point is passed."""
        return SIDES.get(self.assembly, self.assembly)

    def on_crank(self, throws):
        passage = self.found_on(throws) if self.through else ""
        throw = throws.get(self.on)
        is_close = not passage and throw is not None and self.comes_close(throw)
        if passage == self.passage and is_close is self.is_close:
            return self
        return with_fields(self, passage=passage, is_close=is_close)

    def comes_close(self, throw):
        """Whether it only just clears a limit position, where other formulas save digits."""
        return False

    def kink(self, throws):
        return kink(self, throws)

    @property
    def turns(self):
        return turns(self.passage)

    def change_points(self, throws):
        return angles(self, throws, self.start)

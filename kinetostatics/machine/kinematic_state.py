"""Kinematic state of a mechanism: joints and links at its crank angles, and the sense of rotation.

Each group adds its joints and links to a `Placement`, from the crank outwards; a user's own groups are checked as they
do. A `Course` describes a joint's motion without the rounding of its position.

The sense of rotation is +1 counter-clockwise, -1 clockwise: the sign of the crank speed, at rest that of the crank
acceleration. Friction and loads with values for the return stroke depend on it.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from ..numbers.arithmetic import sign, where_zero
from ..numbers.planar import (
    add_vectors,
    left,
    length,
    length_with_error,
    number_or_zero,
    scale_vector,
    subtract_vectors,
)
from .links import Joint, LinkMotion, present


class Throw(NamedTuple):
    """Pin of the crank by its place on it, along and across, m; `ahead`: on the crank ray, like A."""

    at: Any
    ahead: bool = False

    @property
    def polar(self):
        """Distance from O, m, and unit vector at crank angle 0; None: along the crank ray."""
        if self.ahead:
            return self.at[0], None
        radius = length(self.at)
        return radius, (self.at[0] / radius, self.at[1] / radius)

    @property
    def radius_and_rest(self):
        """Distance from O, and its rounding error."""
        return (self.at[0], None) if self.ahead else length_with_error(self.at)


class Swing(NamedTuple):
    """Motion of a joint on a circle about a fixed place: centre, radius, unit vector from centre to joint."""

    centre: Any
    radius: Any
    direction: Any


class Orbit(NamedTuple):
    """Distance from O of a joint on the crank ray: a constant length, and the rest by which it is farther."""

    length: Any
    farther: Any


class Course(NamedTuple):
    """Known motion of a joint, without the rounding of its position; None: unknown.

    A pin of the crank has a `throw`, a joint that a link swings about a fixed place a `swing`, one on the crank ray an
    `orbit`. `departure` is the sum of position and second derivative; zero for a throw, and left out.
    """

    throw: Throw | None = None
    swing: Swing | None = None
    orbit: Orbit | None = None
    departure: Any = None


UNKNOWN_COURSE = Course()


@dataclass
class Placement:
    """Mechanism at its crank angles, in tables that the groups fill from the crank outwards.

    `ray` is the direction of the crank. `joints` and `links` are by name; `travels` holds coordinates along guides with
    kinematic coefficients by slider, `courses` a `Course` by joint if known, `details` the motion that a group
    needs again, by its first link.
    """

    angle: Any
    ray: Any
    joints: dict[str, Joint] = field(default_factory=dict)
    links: dict[str, LinkMotion] = field(default_factory=dict)
    travels: dict[str, Joint] = field(default_factory=dict)
    courses: dict[str, Course] = field(default_factory=dict)
    details: dict[str, Any] = field(default_factory=dict)

    def course(self, joint) -> Course:
        """`Course` of a joint."""
        return self.courses.get(joint, UNKNOWN_COURSE)

    def rate_from(self, joint, link):
        """First kinematic coefficient of a joint as seen from a link, or from the frame."""
        position, first, _ = self.joints[joint]
        if link == "frame":
            return first
        body = self.links[link]
        carried = scale_vector(body.ratio, left(subtract_vectors(position, body.joint.position)))
        return subtract_vectors(first, add_vectors(body.joint.first, carried))


def place(group, placement):
    """Place a group; a user's own group must add all parts that it declares."""
    if group.trusted:
        group.place(placement)
        return
    owner = type(group).__name__
    try:
        group.place(placement)
    except KeyError as error:
        hung = ", ".join(map(repr, group.hangs_on)) or "no joint"
        raise ParameterError(
            f"{owner} is attached to {hung}, but its place asks for {error}; it finds the joints and links of earlier "
            "parts of the chain, and its own"
        ) from error
    problems = [
        f"its place must put a {kind.__name__} for the {what} {name!r} into placement.{table}, as its {declaring} "
        f"declare, but puts {checks.shown(found[name]) if name in found else 'none'}"
        for what, table, declaring, kind in PLACED
        for found in (getattr(placement, table),)
        for name in getattr(group, declaring)
        if not isinstance(found.get(name), kind)
    ]
    checks.require(owner, *problems)


PLACED = (
    ("joint", "joints", "joints", Joint),
    ("link", "links", "links", LinkMotion),
    ("travel of", "travels", "guides", Joint),
)
"""Word for what a group places, its table in a `Placement`, the group's table that declares it, and its class."""


def margin(group, placement, shape):
    """Closure margin of a group; that of a user's own group must broadcast to the shape of the crank angles."""
    found = group.closure(placement)
    if group.trusted:
        return found
    words = "one value, not several" if isinstance(found, list | tuple) else checks.not_a_number(found)
    if getattr(found, "dtype", None) == np.dtype(bool):
        words = "truth values; give numbers"
    if words is None and not _fits(np.shape(found), tuple(shape)):
        words = f"of shape {np.shape(found)}"
    if words:
        text = "its closure must return its margin, a number, or an array with a value for each crank angle"
        checks.require(type(group).__name__, f"{text}, got {checks.shown(found)}, {words}")
    return found


def _fits(shape, wanted):
    """Whether arrays of a shape broadcast to the wanted one."""
    try:
        return np.broadcast_shapes(shape, wanted) == wanted
    except ValueError:
        return False


def require_positions(group, placement, margins):
    """Refuse a user's own group with margins that are not negative where it has no position."""
    joints = (part for name in group.joints for part in placement.joints[name].position)
    directions = (part for name in group.links for part in placement.links[name].direction)
    known = np.isfinite(sum(np.asarray(part, dtype=float) for part in (*joints, *directions)))
    wrong, value, angle = np.broadcast_arrays(~known & ~(margins < 0.0) | np.isnan(margins), margins, placement.angle)
    if wrong.any():
        text = "its closure must be a number, negative where its place finds no position, but is"
        where = f"crank angles, the first {np.degrees(angle[wrong][0]):.6g} deg"
        checks.require(type(group).__name__, f"{text} {value[wrong][0]:.6g} at {wrong.sum()} {where}")


SPEED_WEIGHT = 2.0**600
"""Factor of the crank speed in its sum with the crank acceleration, so that its sign decides."""
SENSE_REMEDY = (
    "but crank_speed and crank_acceleration are both 0: give sense=+1 or sense=-1, the way the crank is about to turn, "
    "or a crank_acceleration"
)
"""Remedy in the message on a scene at rest."""


def sense_of(speed, acceleration):
    """Sense of rotation: sign of the crank speed, at rest of the acceleration; +1 where both are 0."""
    speed, acceleration = present(speed), present(acceleration)
    if speed is None or acceleration is None:
        return sign(number_or_zero(acceleration if speed is None else speed) + 0.0)
    return sign(speed * SPEED_WEIGHT + acceleration + 0.0)


def has_no_sense(scene):
    """Where a crank stands and its sense of rotation is unknown: an array of bool."""
    if scene.sense is not None:
        return np.False_
    return np.logical_and(where_zero(scene.crank_speed), where_zero(scene.crank_acceleration))


def require_sense(reason, motion):
    """Raise `ParameterError` where a crank stands and its sense is unknown; the reason begins the message."""
    still = has_no_sense(motion)
    if still.any():
        raise ParameterError(f"{reason}, {SENSE_REMEDY}", still.any(axis=-1) if still.ndim > 1 else None)

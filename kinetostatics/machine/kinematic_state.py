"""Where a mechanism is at its crank angles, and what is known of how its joints move besides.

The sense of rotation: which way a crank turns, or at rest is about to turn, +1 counter-clockwise and -1 clockwise.

Friction, tables with values for the stroke back and functions of the motion depend on it. A scene at rest gives it as
`sense`, or by the sign of its crank acceleration.
"""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from ..numbers.arithmetic import sign, where_zero
from ..numbers.planar import length, length_with_error, number_or_zero
from .links import Joint, LinkMotion, present


class Throw(NamedTuple):
    """A pin of the crank by its place on it, along and across; `ahead`: on the crank ray itself, like A."""

    at: Any
    ahead: bool = False

    @property
    def polar(self):
        """Distance from O, and direction at the crank angle 0 as a unit vector; None: that of the crank ray."""
        if self.ahead:
            return self.at[0], None
        radius = length(self.at)
        return radius, (self.at[0] / radius, self.at[1] / radius)

    @property
    def radius_and_rest(self):
        """Distance from O, and what rounding took off it."""
        return (self.at[0], None) if self.ahead else length_with_error(self.at)


class Swing(NamedTuple):
    """What swings a joint about a fixed place: the place, its distance, and the unit vector from there to the joint."""

    centre: Any
    radius: Any
    direction: Any


class Orbit(NamedTuple):
    """A joint on the crank ray: a length that no crank angle changes, and how much farther from O it is."""

    length: Any
    farther: Any


class Course(NamedTuple):
    """How a joint moves, where that is known without the rounding of its position; None: it is not.

    Attributes
    ----------
    throw : Throw
        Of a pin of the crank.
    swing : Swing
        Of a joint that a link swings about a fixed place.
    orbit : Orbit
        Of a joint on the crank ray.
    departure : vector
        Position and second derivative together; that of a throw is zero, and is not told.
    """

    throw: Throw | None = None
    swing: Swing | None = None
    orbit: Orbit | None = None
    departure: Any = None


UNKNOWN_COURSE = Course()


@dataclass
class Placement:
    """The mechanism at its crank angles: motion flows outward from the crank into these tables.

    Attributes
    ----------
    angle, ray : array and unit vector
        Crank angle, and direction of the crank.
    joints, links : dict
        A `Joint` or `LinkMotion` by name.
    travels : dict
        By slider its coordinate along its guide, with kinematic coefficients.
    courses : dict
        By joint a `Course`, of those of which there is one.
    details : dict
        What a group wants to find again.
    """

    angle: Any
    ray: Any
    joints: dict[str, Joint] = field(default_factory=dict)
    links: dict[str, LinkMotion] = field(default_factory=dict)
    travels: dict[str, Joint] = field(default_factory=dict)
    courses: dict[str, Course] = field(default_factory=dict)
    details: dict[str, Any] = field(default_factory=dict)

    def course(self, joint) -> Course:
        """What is known of how a joint moves."""
        return self.courses.get(joint, UNKNOWN_COURSE)


def place(group, placement):
    """Place a group; one of the user's own must add all that it declares."""
    if group.trusted:
        group.place(placement)
        return
    owner = type(group).__name__
    try:
        group.place(placement)
    except KeyError as error:
        hung = ", ".join(map(repr, group.hangs_on)) or "no joint"
        raise ParameterError(
            f"{owner} hangs on {hung}, but its place asks for {error}; it finds there what earlier parts of the chain "
            "place, and what it adds itself"
        ) from error
    declared = (
        ("joint", "joints", group.joints, Joint),
        ("link", "links", group.links, LinkMotion),
        ("travel of", "travels", group.guides, Joint),
    )
    checks.require(
        owner,
        *(
            f"its place must put a {kind.__name__} for the {what} {name!r} into placement.{table}, as its "
            f"{'guides' if table == 'travels' else table} declare, but puts {_shown(getattr(placement, table), name)}"
            for what, table, names, kind in declared
            for name in names
            if not isinstance(getattr(placement, table).get(name), kind)
        ),
    )


def _shown(table, name):
    return checks.shown(table[name]) if name in table else "none"


def margin(group, placement, shape):
    """Closure margin of a group; of one of the user's own it must be of the shape of the crank angles, or fit it."""
    found = group.closure(placement)
    if group.trusted:
        return found
    words = "one value, not several" if isinstance(found, list | tuple) else checks.not_a_number(found)
    if getattr(found, "dtype", np.dtype(float)) == np.dtype(bool):
        words = "truth values; give numbers"
    if words is None and not _fits(np.shape(found), shape):
        words = f"of shape {np.shape(found)}"
    text = "a number, or an array with a value for each crank angle"
    checks.require(
        type(group).__name__,
        words and f"its closure must return its margin, {text}, got {checks.shown(found)}, {words}",
    )
    return found


def _fits(shape, wanted):
    try:
        return np.broadcast_shapes(shape, wanted) == tuple(wanted)
    except ValueError:
        return False


def require_positions(group, placement, margins):
    """Refuse a group of the user's own whose margins say that it closes where it has no position."""
    joints = (part for name in group.joints for part in placement.joints[name].position)
    directions = (part for name in group.links for part in placement.links[name].direction)
    known = np.isfinite(sum(np.asarray(part, dtype=float) for part in (*joints, *directions)))
    wrong, value, angle = np.broadcast_arrays(~known & ~(margins < 0.0) | np.isnan(margins), margins, placement.angle)
    checks.require(
        type(group).__name__,
        f"its closure must be a number, negative where its place finds no position, but is {value[wrong][0]:.6g} at "
        f"{wrong.sum()} such crank angles, the first {np.degrees(angle[wrong][0]):.6g} deg"
        if wrong.any()
        else None,
    )


SPEED_WEIGHT = 2.0**600
"""Factor by which a crank speed counts before the crank acceleration."""
SENSE_REMEDY = (
    "but crank_speed and crank_acceleration are both 0: give sense=+1 or sense=-1, the way the crank is about to turn, "
    "or a crank_acceleration"
)
"""How to mend a scene at rest."""


def sense_of(speed, acceleration):
    """Which way a crank turns: the sign of its speed, at rest of its acceleration; +1 where both are 0."""
    speed, acceleration = present(speed), present(acceleration)
    if speed is None or acceleration is None:
        return sign(number_or_zero(acceleration if speed is None else speed) + 0.0)
    return sign(speed * SPEED_WEIGHT + acceleration + 0.0)


def has_no_sense(scene):
    """Where a crank stands and is about to turn neither way, as far as is known: an array of bool."""
    if scene.sense is not None:
        return np.False_
    return np.logical_and(where_zero(scene.crank_speed), where_zero(scene.crank_acceleration))


def require_sense(reason, motion):
    """Raise `ParameterError` where a crank stands and is about to turn neither way; the reason says what needs it."""
    still = has_no_sense(motion)
    if still.any():
        raise ParameterError(f"{reason}, {SENSE_REMEDY}", still.any(axis=-1) if still.ndim > 1 else None)

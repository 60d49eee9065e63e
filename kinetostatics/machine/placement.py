"""Where a mechanism is at its crank angles, and what is known of how its joints move besides."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

from ..numbers.planar import length, length_and_rest
from .links import Joint, LinkMotion


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
        return (self.at[0], None) if self.ahead else length_and_rest(self.at)


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


UNKNOWN = Course()


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
        return self.courses.get(joint, UNKNOWN)

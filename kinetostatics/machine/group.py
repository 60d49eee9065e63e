"""What a structural group is: the protocol by which everything else asks it.

Motion flows outward from the crank, group by group; forces flow inward from the last group to the crank. A group is a
frozen dataclass derived from `Group`. It declares, by name,

    links       the links it adds, each a `Link`
    references  the joint by which each link is placed
    joints      the joints it adds, each a `Point` of a link, or of the frame
    hangs_on    the joints it hangs on
    bars        the links that keep two joints at a distance
    outputs     the reactions and other forces it finds, each an `Output` with its unit

and computes, by kernels without branches on values,

    place(placement)                  its joints and links, from the joints it hangs on
    closure(placement)                margin: negative where it cannot be assembled, small near a limit position
    requirement(placement)            what must hold for it to be assembled, with its numbers, for the error message
    resolve(placement, loads, along)  the forces on its links, and what they demand of other links: a `Resolved`
    follow(placement, joints)         its links where the joints it adds are known: for methods under study

`loads` are wrenches by link about its reference joint, `along` the forces along a guide by slider, kept apart from them
since they may cancel with inertia.

Nothing else in the library knows what a group looks like, nor the names of its links.
"""

from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from .links import Wrench

FRAME = "frame"
"""Link that does not move."""
MEMBERS = ("links", "references", "joints", "outputs", "bars", "place", "closure", "requirement", "resolve")
RATES = ("_rate", "_angular_acceleration")
"""Endings that make quantities of a link's name."""
TRAVELS = ("_position", "_velocity", "_acceleration")
"""Endings that make quantities of a slider's name."""
RESERVED = ("balancing_torque_by_power", "shaking_force", "shaking_moment")
"""Quantities that every mechanism has besides those that its parts declare."""


class Point(NamedTuple):
    """A point of a link: so far along its direction from its reference joint and across it, to the left, m."""

    link: str
    along: Any = 0.0
    across: Any = 0.0


class Bar(NamedTuple):
    """A link that keeps joint `end` at a constant distance from joint `start`, its reference joint."""

    start: str
    end: str
    link: str
    length: Any


class Output(NamedTuple):
    """What a quantity is: its SI unit, whether it is a vector, and what it acts on and from what, in words."""

    unit: str
    vector: bool = False
    text: str = ""


class Resolved(NamedTuple):
    """What a group finds, and what it passes on.

    `demands` holds wrenches that other links must supply: under a joint's name the force and couple through that joint,
    under a link's name a wrench about that link's reference joint.
    """

    reactions: dict[str, Any]
    scalars: dict[str, Any]
    demands: dict[str, Wrench]


@dataclass
class Placement:
    """The mechanism at its crank angles: motion flows outward from the crank into these tables.

    `travels` holds by slider its coordinate along its guide, with kinematic coefficients; `details` what a group wants
    to find again.
    """

    angle: Any
    ray: Any
    joints: dict = field(default_factory=dict)
    links: dict = field(default_factory=dict)
    travels: dict = field(default_factory=dict)
    details: dict = field(default_factory=dict)


class Group:
    """What follows from what a group declares; see the module for what that is."""

    label = ""
    TRUSTED = False
    """Whether its forces are known to balance and its names to come from its texts: the library's own, as tested."""
    trusted = False
    """Whether its class itself says so: one derived from it may do otherwise."""

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        cls.trusted = vars(cls).get("TRUSTED", False)

    @property
    def follows(self):
        """Whether `follow` belongs to the class that places it, and so knows its joints."""
        placing = next(kind for kind in type(self).__mro__ if "place" in vars(kind))
        return "follow" in vars(placing)

    @property
    def names(self):
        """What its names come from."""
        return [value for value in vars(self).values() if type(value) is str]

    @property
    def hangs_on(self):
        return (self.on,)

    @property
    def lengths(self):
        """All lengths it has, places of mass centres among them, for a first look at the condition."""
        return [bar.length for bar in self.bars]

    @property
    def shortest(self):
        """Its shortest link or cam radius."""
        return reduce(np.minimum, (bar.length for bar in self.bars), np.inf)

    @property
    def bars(self):
        return ()

    def with_link(self, name, link):
        """The group with other mass properties of one link, whose field is called as the link but for the label."""
        return replace(self, **{name.removesuffix(self.label): link})

    @property
    def guides(self):
        """Guide by name of each link that slides along one."""
        return {}

    @property
    def motions(self):
        """Quantities of its motion besides those of joints and links, each an `Output`; ``motion(name, placement)``."""
        return {}

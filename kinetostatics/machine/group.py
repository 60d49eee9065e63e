"""What a structural group is: the protocol by which everything else asks it.

Motion flows outward from the crank, group by group; forces flow inward from the last group to the crank. A group is a
frozen dataclass derived from `Group`. It declares, by name,

    links       the links it adds, each a `Link`
    references  the joint by which each link is placed
    joints      the joints it adds, each a `Point` of a link, its own or one placed before it, or of the frame
    hangs_on    the joints it hangs on
    bars        the links that keep two joints at a distance
    guides      the guide of each link that slides along one, without turning
    slots       the links in which a joint slides, each a `Slot`
    led         the joints that a cam leads, each a `Led`
    knots       where the law of a cam bends or jumps, each a `law.Breakpoint`
    curves      the joints that run on a curve, with what drawings call it
    rollers     radii of rollers, by the joints that are their centres
    outlines    curves fixed to links, as cams are, points (2, K) by link, in its axes
    outputs     the reactions and other forces it finds, each an `Output` with its unit
    motions     quantities of its motion besides those of joints and links, each an `Output`
    contacts    line contacts by the name of their pressure, each a `roller.LineContact`
    pairs       which of its links rub against what, by reaction, each a pair of `pairs`

(those that it has none of are left out: `Group` says so), and computes, by kernels without branches on values,

    place(placement)                  its joints and links, from the joints it hangs on
    closure(placement)                margin, a number for each crank angle: negative where it cannot be assembled (and
                                      `place` finds no position), small near a limit position
    requirement(placement)            what must hold for it to be assembled, with its numbers, for the error message
    resolve(placement, loads, along)  the forces on its links, and what they demand of other links: a `Resolved`
    follow(placement, joints)         its links where the joints it adds are known: for methods under study
    motion(name, placement)           a quantity of `motions`
    elongation(placement, position)   coordinate of a slider less a position, where that can be had without cancellation
    departure(placement, position)    second derivative of that coordinate plus the elongation, in the same way, or None
    outward(placement, position)      the elongation, or its opposite, as a length of the design and some more, or None
    sliding(name, placement)          direction and rate of a sliding pair: a `pairs.Slide`
    relative_radius(name, placement, side)  of both curvatures of a contact together, by the sign of its force

The last seven may be missing. A field called ``cam`` holds a curve with ``polar(angle, ray) -> r, r', r''``, which need
not be arithmetic: engines then tabulate it.

How to write one
----------------
*Fields.* A frozen dataclass (``eq=False``) of lengths, a `Guide` or a pivot, an assembly of +1 or -1, a `Link` for
each link, called as the link but for the label; ``on`` and ``pin``, names of joints; ``label``, put behind the names of
links and forces so that a mechanism may have two of the kind. ``PATHS`` renames fields in paths such as
"coupler_length2"; "" leaves a name out. Lengths may be arrays (designs, 1): write kernels with ``+ - * /`` and
`numbers.elementary`, never with ``if``, ``max`` or ``math``; then they also run on recorded numbers, on numbers with
derivatives and on enclosures. ``None`` stands for a zero that costs nothing (`numbers.planar` adds such numbers).

*place.* Read ``placement.joints[self.on]``, a `Joint`: position, first and second derivative by the crank angle, each
(x, y). Put into ``placement.joints`` each joint of `joints`, into ``placement.links`` a `LinkMotion` for each link: its
reference joint, its direction (unit vector), d theta / d phi and the slope of that (None: it never turns); into
``placement.travels`` for each slider its coordinate along its guide with both derivatives; into ``placement.details``
what `resolve` wants to find again; into ``placement.courses`` a `Course` for a joint whose motion is known without
the rounding of its position.

*resolve.* A pure function from what acts on its links to what it finds: nothing is written to, and nothing is kept.
``loads`` holds by link the wrench on it, inertia, weight and all that groups further out ask of it, a force and its
moment about the link's reference joint, None where there is none. ``along`` holds by slider the applied force along its
guide, apart since it may nearly cancel with inertia. Write down the equilibrium of the links for the unknown forces
*on* them; what the group needs from others, joints of `hangs_on` and the crank, goes into ``demands`` with the sign
that it has on the group: the mechanism sees to the reaction on the link that carries the joint.

*Change points.* Most groups have none to pass. One that does says in `on_crank(throws)` how, by a text `passage` that
belongs to its structure, and gives `turns` and `change_points`; `kink(throws)` says what becomes of a side there. What
its structure owes to lengths of groups beside it, `beside(groups, throws)` says.

*Friction.* Where links rub, `resolve` is asked several times: what it finds must be linear in the loads.
*outputs.* Each name that `resolve` returns, reactions as vectors, with its unit. From these declarations alone come
tables, figures and sweeps. `ks.check(group)` tests them; tests/machine/test_group.py has a whole example.
*Hand calculations.* `Solution.explain` tells what the kernels compute, under the names of local variables. The module
may say in ``TERMS`` how an engineer writes a variable, and what it is: ``{"across": ("d", "from pin to guide")}``, of
one kernel alone as ``"resolve.across"``, which may be an argument too; primes count derivatives, ``"r'"``.

Nothing else in the library knows what a group looks like, nor the names of its links. Methods under study make their
equations of `joints`, `bars`, `guides`, `slots`, `led` and `pairs` alone.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..numbers.parameter_tree import come_from_one_class
from .kinematic_state import Throw
from .links import Wrench

FRAME = "frame"
"""Link that does not move."""
MEMBERS = ("links", "references", "joints", "outputs", "bars", "place", "closure", "requirement", "resolve")
RATES = ("_rate", "_angular_acceleration")
"""Endings that make quantities of a link's name."""
TRAVELS = ("_position", "_velocity", "_acceleration")
"""Endings that make quantities of a slider's name."""
RESERVED = (
    "balancing_torque_by_power",
    "shaking_force",
    "shaking_moment",
    "reduced_inertia",
    "reduced_inertia_slope",
    "kinetic_energy",
    "potential_energy",
    "load_torque",
)
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
    """What a quantity is: its SI unit, whether it is a vector, and what it acts on and from what, in words.

    `at` is the joint that a reaction acts at, where it is not called like it.
    """

    unit: str
    vector: bool = False
    text: str = ""
    at: str = ""


class Resolved(NamedTuple):
    """What a group finds, and what it passes on.

    `demands` holds wrenches that other links must supply: under a joint's name the force and couple through that joint,
    under a link's name a wrench about that link's reference joint.
    """

    reactions: dict[str, Any]
    scalars: dict[str, Any]
    demands: dict[str, Wrench]


class Group:
    """What follows from what a group declares; see the module for what that is."""

    TRUSTED = False
    """Whether its forces are known to balance and its names to come from its texts: the library's own, as tested."""
    trusted = False
    """Whether its class itself says so: one derived from it may do otherwise."""

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        cls.trusted = vars(cls).get("TRUSTED", False)

    @property
    def label(self):
        """What tells its names, and paths of its numbers, from those of another of its kind."""
        return ""

    @property
    def follows(self):
        """Whether `follow` belongs to the class that places it, and so knows its joints."""
        return come_from_one_class(type(self), "follow", "place")

    @property
    def names(self):
        """What its names come from."""
        return [value for value in self.__dict__.values() if value.__class__ is str]

    @property
    def hangs_on(self: Any):
        """Joints it hangs on; unless told, the one named `on`."""
        return (self.on,)

    @property
    def pairs(self):
        """Which links turn or slide against what, by the name of the reaction or force."""
        return {}

    def rigid_on(self, owners):
        """Link that each of its links never turns against, by name, of `owners`, which carry the joints it hangs on."""
        return {}

    @property
    def lengths(self):
        """All lengths it has, places of mass centres among them, for a first look at the condition."""
        return [bar.length for bar in self.bars]

    @property
    def reaches(self):
        """Lengths of its bars and cam radii, the shortest of which counts for a first look at the condition."""
        return [bar.length for bar in self.bars]

    @property
    def bars(self):
        """Links that keep two joints at a distance, each a `Bar`."""
        return ()

    @property
    def slots(self):
        """Links in which a joint slides, each a `Slot`."""
        return ()

    @property
    def led(self):
        """Joints that a cam leads, each a `Led`."""
        return ()

    @property
    def knots(self):
        """Where the law of a cam that leads it bends or jumps, each a `Breakpoint`."""
        return ()

    @property
    def curves(self):
        """Joints that run on a curve, with what drawings call it."""
        return {}

    @property
    def rollers(self):
        """Radii of rollers by the joints that are their centres, m; None where it is not known."""
        return {}

    @property
    def outlines(self):
        """Curves fixed to links, points (2, K) in the axes of each."""
        return {}

    @property
    def own_names(self: Any):
        """What each of its links is called without the label: what it is, whatever else the mechanism has."""
        return {name: name.removesuffix(self.label) or name for name in self.links}

    def with_link(self: Any, name, link):
        """The group with other mass properties of one link, whose field is called as the link but for the label."""
        return replace(self, **{self.own_names[name]: link})

    @property
    def guides(self):
        """Guide by name of each link that slides along one."""
        return {}

    @property
    def throws(self) -> dict[str, Throw]:
        """Pins of the crank that it adds."""
        return {}

    def on_crank(self, throws):
        """The group as it is on the pins of a crank: what its structure owes to lengths that are not its own."""
        return self

    def beside(self, groups, throws):
        """The group as it is beside others of a chain, on the pins of a crank: what its structure owes to theirs."""
        return self

    LAW = ("r", "m")
    """What a curve in its field `cam` gives: its letter, and unit."""
    passage, is_close = "", False
    """How it passes change points, "" for none; whether it is so close to a limit that forces may outgrow torque."""

    @property
    def passes(self):
        """Whether it passes change points: motion is smooth there, but forces grow without bound."""
        return self.passage != ""

    @property
    def through(self):
        """Whether it is to pass change points, had it any."""
        return type(getattr(self, "assembly", 1)) is str

    def kink(self, throws):
        """What becomes of its motion at change points that it does not pass, in words; "" without any."""
        return ""

    @property
    def turns(self):
        """Turns of the crank after which its branch closes."""
        return 1

    def change_points(self, throws):
        """Crank angles in [0, 2 pi) of the change points that it passes on the pins of a crank, rad."""
        return ()

    @property
    def motions(self):
        """Quantities of its motion besides those of joints and links, each an `Output`; ``motion(name, placement)``."""
        return {}

    @property
    def contacts(self):
        """Line contacts by the name of their pressure, each a `LineContact`; see `relative_radius`."""
        return {}


def joint_reaction(link, joint):
    """Output of the reaction on a link at a joint that it hangs on."""
    return Output("N", True, f"on the {link}, from what carries {joint}", joint)


def separation(placement, first, second):
    """What messages on closure begin with: how far two joints are from each other at the crank angles."""
    start, end = (placement.joints[name].position for name in (first, second))
    apart = np.hypot(end[0] - start[0], end[1] - start[1])
    return f"the distance from {first} to {second}, {apart.min():.6g} to {apart.max():.6g} m here, must"

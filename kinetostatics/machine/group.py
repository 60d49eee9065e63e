"""Structural group: the protocol through which the library sees the parts of a mechanism.

Motion flows outward from the crank, group by group; forces flow inward from the last group to the crank. A group is a
frozen dataclass (``eq=False``) derived from `Group`. The library knows its links and names through this protocol only.

Declarations
------------
`LINKS` maps each field with a `Link` to the field that names its reference joint. `declaration` returns the other parts
in a `Declaration`, named without the label; `Group` adds the label and makes the tables

    links, references, joints, bars, guides, slots, led, pairs, outputs, motions, contacts, lengths

A group may override the property of a table; its names must then have the label. `outputs`, the reactions and forces
with their units, follows from `pairs`. Other lists are

    hangs_on     joints that the group is attached to
    knots        each `Breakpoint` of the law of a cam that leads it
    curves       joints that run on a curve, with its name in drawings
    rollers      radii by joint
    outlines     curves (2, K) fixed to links, in their axes
    dimensions   lengths and angles of a drawing (`machine.dimensions`)

Kernels, without branches on values
-----------------------------------
    place(placement)                  adds its joints and links, found from the joints it is attached to
    closure(placement)                margin at each crank angle: negative where it is open, small near a limit position
    requirement(placement)            text for the error message: condition for its assembly, with the lengths
    resolve(placement, loads, along)  forces on its links, and the wrenches that other links supply: a `Resolved`

and optionally

    follow(placement, joints)         places its links at known joints: for methods under study
    motion(name, placement)           value of a quantity of `motions`
    elongation(placement, position)   coordinate of a slider less a position, without cancellation
    departure(placement, position)    second derivative of that coordinate plus the elongation, or None
    outward(placement, position)      elongation up to its sign, as a pair: constant length and small rest; or None
    sliding(name, placement)          direction and rate of a sliding pair: a `Slide`
    relative_radius(name, placement, side)  radius of the relative curvature of a contact, for a sign of its force

*Fields.* Lengths, a `Guide` or a pivot, an assembly of +1 or -1, the links, and the names of joints ``on`` and ``pin``.
``label`` is the suffix of link and force names where a mechanism has two groups of a kind. ``plane`` is its position
along the crankshaft, or None (`machine.planes`), by the rule `PLANE`. ``PATHS`` renames fields in paths
such as "coupler_length2"; a field renamed "" has no name there. A field ``cam`` holds a curve with ``polar(angle, ray)
-> r, r', r''``; its code is free, because engines tabulate it. Lengths may be arrays (designs, 1): write kernels with
``+ - * /`` and `numbers.arithmetic`, never with ``if``, ``max`` or ``math``; then they also run on recorded numbers and
on enclosures. ``None`` is a zero that costs no time; the functions of `numbers.planar` accept it.

*place* reads ``placement.joints[self.on]``, a `Joint`: position, first and second derivative by the crank angle, each
(x, y). `enter` adds each joint of `joints` and a `LinkMotion` for each link (reference joint, unit vector, d theta / d
phi and its slope; None: it never turns). For each slider it adds the coordinate along its guide with both derivatives.
It also keeps the motion that `resolve` needs again. ``place`` may add a `Course` to ``placement.courses`` for a joint
whose motion is known without the rounding of its position.

*resolve* is a pure function. ``loads`` maps each link to the wrench on it about its reference joint: inertia, weight
and the demands of outer groups. ``along`` maps each slider to the applied force along its guide, kept separate because
it may nearly cancel with inertia. The equilibrium of the links gives the unknown forces *on* them. They must be linear
in the loads, because friction superposes loads. ``demands`` are the wrenches on the group that other links supply.

*Change points.* Groups that pass them derive from `groups.branches.Branch`. ``on_crank(throws)`` returns a group with
the text `passage`, part of the structure; `turns`, `change_points` and `kink` follow from it. ``beside(groups,
throws)`` returns the group specialised for its neighbours (toggles, and change points on a rocker).

*Hand calculations.* `Solution.explain` shows the values of the kernels under the names of their local variables. The
group's module may give symbols and meanings in ``TERMS``: ``{"across": ("d", "from pin to guide")}``. The key
``"resolve.across"`` is for one kernel, and may name an argument. Primes count derivatives: ``"r'"``.

`ks.check(group)` tests a group; tests/machine/test_group.py has a whole example.
"""

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.lazy import cached_property
from .links import CamDriven, Link, Meshing, Rolling, Sliding, Slot, Turning, Wrench, present

FRAME, CRANK = "frame", "crank"
"""Names of the fixed link and of the crank's link."""
MEMBERS = ("links", "references", "joints", "outputs", "bars", "place", "closure", "requirement", "resolve")
RATES = ("_rate", "_angular_acceleration")
"""Endings of the quantities of a link."""
TRAVELS = ("_position", "_velocity", "_acceleration")
"""Endings of the quantities of a slider."""
GROUND = "ground"
"""Name of the sum of the forces on the frame, and first word of the name of each."""
ROCKING, SHAFT_TORQUE = "rocking_moment", "shaft_torque"
"""Quantities of a mechanism with planes: the moment, and first word of the torques in its crankshaft."""
BEARINGS = {"O left": "left", "O right": "right"}
"""Quantities of a crankshaft on two bearings: the reactions at O by the bearing."""
POSITION = checks.Number("m", usual=checks.PLAUSIBLE_BY_UNIT["m"])
PLANE = checks.Optional(POSITION)
"""Rules of a position along the crankshaft, m, and of the plane of a group or pin, which may be None."""
RESERVED = (
    "balancing_torque_by_power",
    "shaking_force",
    "shaking_moment",
    ROCKING,
    *BEARINGS,
    "reduced_inertia",
    "reduced_inertia_slope",
    "kinetic_energy",
    "potential_energy",
    "load_torque",
    GROUND,
)
"""Quantities of every mechanism besides those that its parts declare."""


class Point(NamedTuple):
    """Point of a link: along its direction and across it, to the left, from its reference joint; m."""

    link: str
    along: Any = 0.0
    across: Any = 0.0


class Bar(NamedTuple):
    """A link that keeps joint `end` at a constant distance from its reference joint `start`."""

    start: str
    end: str
    link: str
    length: Any


class Output(NamedTuple):
    """Declaration of a quantity: SI unit, vector or not, a text that names both bodies, joint `at` which it acts."""

    unit: str
    vector: bool = False
    text: str = ""
    at: str = ""


class Resolved(NamedTuple):
    """Reactions (vectors) and scalars by name, and the wrenches that other links must supply.

    `demands` maps a joint to the force and couple through it, a link to a wrench about its reference joint. For a whole
    mechanism, it maps the first link of a group to the wrench on the crank about O.
    """

    reactions: dict[str, Any]
    scalars: dict[str, Any]
    demands: dict[str, Wrench]


EMPTY: Mapping[str, Any] = MappingProxyType({})


class Declaration(NamedTuple):
    """Parts of a group, named without the label.

    `Group` names and describes the reactions of `pairs`. `lengths` holds all lengths except those of mass centres: by
    default bars, offsets of guides and slots, and coordinates of fixed joints, m.
    """

    joints: Mapping[str, Point] = EMPTY
    bars: tuple[Bar, ...] = ()
    guides: Mapping[str, Any] = EMPTY
    slots: tuple[Slot, ...] = ()
    led: tuple[CamDriven, ...] = ()
    pairs: tuple[Turning | Sliding | Rolling | Meshing, ...] = ()
    motions: Mapping[str, Output] = EMPTY
    contacts: Mapping[str, Any] = EMPTY
    lengths: tuple[Any, ...] = ()


NAMES = ("link", "against", "rod", "force", "couple")
"""Fields of declared parts that hold names of links and forces."""


def _declared(table, doc):
    """Property: parts of one kind that a group declares, with the label on names of links and forces."""

    def entries(group):
        found = getattr(group.declaration, table)
        if isinstance(found, tuple):
            return tuple(map(group._renamed, found))
        return {group.called(name): group._renamed(part) for name, part in found.items()}

    return property(entries, doc=doc)


class Part:
    """Crank or structural group: tables of its links, joints and forces, named with the label; see the module."""

    LINKS: ClassVar[dict[str, str]] = {}
    """Fields that hold links (and name them), each with the field that names its reference joint."""
    TRUSTED = False
    """Whether tests prove that its forces balance and its fields of text give all names; True for the library's own."""
    trusted = False
    """`TRUSTED` as this class sets it; it is not inherited, for a derived class may have other forces."""
    declaration: Any = Declaration()
    label: Any = ""
    """Suffix of its names and parameter paths, for a second group of its kind."""
    curves: Any = EMPTY
    """Joints that run on a curve, each with the name of the curve in drawings."""
    rollers: Any = EMPTY
    """Radius of each roller by the joint at its centre, m; None if unknown."""
    sign_forces: Any = ()
    """Forces, by name, at whose change of sign other forces have a kink."""
    throws: Any = EMPTY
    """Pins of the crank that it adds, each a `Throw`."""
    dimensions: Any = EMPTY
    """Dimensions on a drawing, by field names and indices of the number measured (`machine.dimensions`)."""

    def __init_subclass__(cls, **options):
        super().__init_subclass__(**options)
        cls.trusted = vars(cls).get("TRUSTED", False)

    # Names

    @property
    def names(self):
        """Values of its text fields, from which the names of its parts follow."""
        return [value for value in self.__dict__.values() if value.__class__ is str]

    def called(self, name):
        """Name of one of its links, forces or quantities, with the label."""
        return name + self.label

    def _renamed(self, part):
        """A declared part with the label on the names of links and forces in it."""
        names = {field: getattr(part, field, "") for field in NAMES} if self.label else {}
        own = {field: self.called(name) for field, name in names.items() if name not in ("", FRAME, CRANK)}
        return part._replace(**own) if own else part

    # Tables

    @property
    def hangs_on(self: Any):
        """Joints it is attached to: by default the one named `on`."""
        return (self.on,)

    @property
    def links(self) -> dict[str, Any]:
        return {self.called(name): getattr(self, name) for name in self.LINKS}

    @property
    def references(self) -> dict[str, str]:
        return {self.called(name): getattr(self, joint) for name, joint in self.LINKS.items()}

    @property
    def own_names(self: Any):
        """Name without the label of each of its links."""
        return {name: name.removesuffix(self.label) or name for name in self.links}

    @property
    def joints(self) -> dict[str, Point]:
        return {name: self._renamed(point) for name, point in self.declaration.joints.items()}

    bars = _declared("bars", "Links that keep two joints at a distance.")
    guides = _declared("guides", "Guide by name of each link that slides along one.")
    slots = _declared("slots", "Links in which a joint slides.")
    led = _declared("led", "Joints that a cam leads.")
    motions = _declared("motions", "Quantities of its motion besides those of joints and links, by `motion`.")
    contacts = _declared("contacts", "Line contacts by the name of their pressure, each a `LineContact`.")

    @property
    def lengths(self):
        """All lengths, including the coordinates of mass centres, to estimate the condition number; m."""
        own = self.declaration.lengths
        if not own:
            fixed = (point for point in self.joints.values() if point.link == FRAME)
            own = [bar.length for bar in self.bars] + [guide.guide_offset for guide in self.guides.values()]
            own += [part for point in fixed for part in point[1:]] + [slot.offset for slot in self.slots]
        return (*own, *(part for link in self.links.values() for part in link.centre))

    @property
    def reaches(self):
        """Lengths of bars, of cams the smallest radius, m; the shortest of a mechanism enters the condition number."""
        return [bar.length for bar in self.bars]

    # Forces and quantities

    @property
    def pairs(self) -> dict[str, Any]:
        """Pairs of links, by the name of the reaction or force.

        A reaction has the name of its joint. At a joint to which the group is attached, the label follows; if there are
        several, also the link precedes. Other pairs have a `name`.
        """
        found: dict[str, Any] = {}
        for pair in self.declaration.pairs:
            if not isinstance(pair, Turning):
                name = self.called(pair.name)
            elif pair.joint not in self.hangs_on:
                name = pair.joint
            else:
                name = self.called(pair.joint) if len(self.hangs_on) == 1 else f"{self.called(pair.link)}_{pair.joint}"
            found[name] = self._renamed(pair)
        return found

    @cached_property
    def outputs(self):
        """Reactions and other forces by name, those of guides last."""
        found: dict[str, Output] = {}
        for name, pair in sorted(self.pairs.items(), key=lambda item: item[1].against == FRAME):
            if isinstance(pair, Rolling):
                continue  # its group declares the force
            if isinstance(pair, Sliding):
                guided = pair.against == FRAME
                on = f"{'ground' if guided else pair.against} on {pair.link}"
                slots = [slot for slot in self.slots if slot.link == pair.against]
                inclined = any(present(slot.angle) is not None for slot in slots)
                of = "slot's left normal" if inclined else f"left normal of the {pair.against}"
                if guided:
                    of, found[name] = "guide's left normal", Output("N", True, on, pair.joint)
                found[pair.force] = Output("N", False, f"{on} along the {of}")
                found[pair.couple] = Output("N m", False, f"{on} about {pair.about or pair.joint}", pair.about)
            elif isinstance(pair, Meshing):
                found[name] = Output("N", True, f"ring on {pair.link}", pair.joint)
                found[pair.force] = Output("N", False, f"ring on {pair.link} across the arm, counter-clockwise about O")
            elif pair.joint in self.hangs_on:
                found[name] = Output("N", True, f"on the {pair.link}, from what carries {pair.joint}", pair.joint)
            else:
                found[name] = Output("N", True, f"{pair.against or 'ground'} on {pair.link}")
        return found


class Group(Part):
    """Structural group: tables, placement and forces; see the module."""

    plane: Any = None
    """Position along the crankshaft, m; None: the plane of the joint it is attached to (`machine.planes`)."""
    LAW = ("r", "m")
    """Letter and unit of the values of a curve in the field `cam`."""
    passage, is_close = "", False
    """Kind of change points that it passes, "" for none; whether it needs kernels for close limit positions."""
    is_rigid_triangle = False
    """Whether its links never turn relative to the single link that carries all joints it is attached to."""
    knots: Any = ()
    """Breakpoints of the law of a cam that leads it, each a `Breakpoint`."""
    outlines: Any = EMPTY
    """Curves fixed to links, points (2, K) in the axes of the link, m."""
    turns: Any = 1
    """Turns of the crank after which its motion repeats: 2 for some change points."""
    carrier: Any = ""
    """Name of the rocker that carries it, if it passes change points on its pin; "" otherwise."""

    def with_link(self: Any, name, link):
        """A copy with other mass properties of the link `name`, given with the label."""
        return replace(self, **{self.own_names[name]: link})

    def of_links(self, table) -> Any:
        """Entries of a table by link, for its own links in the order of `LINKS`; None where the table has none."""
        return [table.get(self.called(name)) for name in self.LINKS]

    def enter(self, placement, motion, joints=EMPTY, links=None, travels=EMPTY):
        """Add to a placement joints by name, links and travels by name without the label, and `motion` for `placed`.

        By default the links are the first fields of `motion`, in the order of `LINKS`. Their reference joints are added
        too, except those that the group is attached to. `placement.details` keeps `motion` by the first link's name.
        """
        placement.joints.update(joints)
        if links is None:
            links = dict(zip(self.LINKS, motion, strict=False))
            for link, joint in zip(links.values(), self.references.values(), strict=True):
                if joint not in self.hangs_on:
                    placement.joints[joint] = link.joint
        placement.links.update({self.called(name): link for name, link in links.items()})
        placement.travels.update({self.called(name): travel for name, travel in travels.items()})
        placement.details[self._key] = motion

    def placed(self, placement):
        """The `motion` that `enter` has kept for `resolve`."""
        return placement.details[self._key]

    @property
    def _key(self):
        return self.called(next(iter(self.LINKS)))

    def resolved(self, reactions, scalars=(), demands=None) -> Resolved:
        """Result of `resolve`, from vectors and scalars in the order of `outputs`.

        By default the first vector is the only demand, at the joint that the group is attached to.
        """
        names: dict[bool, list[str]] = {True: [], False: []}
        for name, output in self.outputs.items():
            names[output.vector].append(name)
        vectors = dict(zip(names[True], reactions, strict=True))
        if demands is None:
            demands = {self.hangs_on[0]: Wrench(reactions[0], None)}
        return Resolved(vectors, dict(zip(names[False], scalars, strict=True)), demands)

    # Change points

    def on_crank(self, throws):
        """The group specialised for the pins of a crank, whose lengths may decide its structure; or itself."""
        return self

    def beside(self, groups, throws):
        """The group specialised for the other groups of its chain and the pins of the crank; or itself."""
        return self

    @property
    def passes(self):
        """Whether it passes change points: motion is smooth there, but forces grow without bound."""
        return self.passage != ""

    @property
    def through(self):
        """Whether its `assembly` is a word, "open" or "crossed", which asks for a passage through change points."""
        return type(getattr(self, "assembly", 1)) is str

    def kink(self, throws):
        """Sentence on the kink of its motion at change points that it does not pass; "" if it has none."""
        return ""

    def change_points(self, throws):
        """Crank angles in [0, 2 pi) of the change points that it passes on the pins of a crank, rad."""
        return ()


class LinkRule(checks.InstanceOf):
    """Rule of the link of a group, which lies in one plane; only a crank may be a rotor."""

    def check(self, value, field=""):
        found, problem = super().check(value, field)
        if problem is None and found.plane is not None:
            problem = f"{field} must be a Link: a Rotor is for the crank, and a group has its own plane"
        return found, problem


LINK = LinkRule(Link, "a Link")
GroupLink = Annotated[Link, LINK]
Name = Annotated[str, checks.Name()]
Label = Annotated[str, checks.Name(may_be_empty=True)]
Plane = Annotated[Any, PLANE]
"""Types of a group's fields for links, names of joints, the label and the plane, with their rules."""


def separation(placement, first, second):
    """Begin of a requirement: the range of the distance between two joints over the crank angles, m."""
    start, end = (placement.joints[name].position for name in (first, second))
    apart = np.hypot(end[0] - start[0], end[1] - start[1])
    return f"the distance from {first} to {second}, {apart.min():.6g} to {apart.max():.6g} m here, must"

"""RRR groups: coupler from a pin to a rocker about a fixed pivot, in either assembly; dyad between two moving joints.

Let d be the vector from joint A to the pivot O2, a = |d|, c the coupler length and h the rocker length. Joint B is from
A at (a^2 + c^2 - h^2) / (2 a^2) d +- area / (2 a^2) left(d). Here area = sqrt((a+c+h)(a+c-h)(a-c+h)(c+h-a)) is four
times that of the triangle A B O2 (Heron). The sine of the transmission angle, which divides all rates and forces, is
area / (2 c h). It is a product of lengths, so no digit is lost near a toggle, where it vanishes.

On a chosen side the motion has a kink at a change point; the words "open" and "crossed" pass it (`change_points`).

Seen from its second joint a dyad is a rocker group whose pivot stands still.
"""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import clamped_sqrt, guarded_divisor, offset_from_zero, sqrt
from ...numbers.parameter_tree import replace_unchecked
from ...numbers.planar import (
    add_vectors,
    cross,
    dot,
    minus,
    number_or_zero,
    plus,
    product,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
    work,
)
from ..dimensions import Span, of_fixed_point
from ..group import FRAME, Bar, Declaration, Group, GroupLink, Label, Name, Plane, Point, Resolved, separation
from ..kinematic_state import Course, Swing
from ..links import Joint, Link, LinkMotion, Turning, Wrench, joint_at, link_between
from . import carriers, change_points, near_dead_centre
from .branches import Branch, equality
from .change_points import FAR, KITE, MEETING, NEAR, PARALLEL, RHOMBUS, divide

MIN_SINE = 2.0**-53
"""Least sine of the transmission angle by which rates and forces are divided."""
TERMS = {
    "d": ("d", "from the inner joint to the pivot"),
    "square": ("D", "square of that distance"),
    "a": ("a", "that distance"),
    "heron": ("H", "square of four times the area of the triangle of both links, by Heron"),
    "size": ("S", "four times that area"),
    "along": ("xi", "share of d by which the pin lies along it"),
    "across": ("eta", "share of d by which the pin lies across it, to the left"),
    "reach": ("w", "from the inner joint to the pin"),
    "divided": ("sigma", "sine of the transmission angle"),
    "cosine": ("kappa", "cosine of the transmission angle"),
    "lag": ("q", "length of the first link times the square of its ratio"),
    "swing_lag": ("z", "length of the second link times the square of its ratio"),
    "along_coupler": ("U", "force of the pin on the second link along the first"),
    "along_rocker": ("V", "force of the pin on the second link along itself"),
}


class RockerMotion(NamedTuple):
    """A placed rocker group; `closure` is the squared sine of the transmission angle, without change points.

    `divisor` is that sine to divide by, as `change_points.divide` takes it. `by_carrier`, of a group that passes change
    points on a rocker: velocity of the inner joint and ratios of both links, by the angle of that rocker.
    """

    coupler: LinkMotion
    rocker: LinkMotion
    pin: Joint
    divisor: tuple[Any, Any]
    closure: Any
    by_carrier: Any = None


def place(joint, coupler_length, rocker_length, pivot, assembly):
    """Coupler and rocker for a given inner joint (kernel)."""
    c, h = coupler_length, rocker_length
    d = (offset_from_zero(pivot[0] - joint.position[0], c + h), pivot[1] - joint.position[1])
    square = dot(d, d)
    a = sqrt(square)
    gap = c - h
    heron = (a + c + h) * (a + gap) * (a - gap) * (c + h - a)
    product = 2.0 * c * h
    unit = product * product
    size = clamped_sqrt(heron, unit)
    area, divided = assembly * size, assembly * guarded_divisor(size, MIN_SINE * product) / product
    along, across = (square + gap * (c + h)) / (2.0 * square), area / (2.0 * square)
    reach = (along * d[0] - across * d[1], along * d[1] + across * d[0])
    q = (reach[0] / c, reach[1] / c)
    p = ((reach[0] - d[0]) / h, (reach[1] - d[1]) / h)
    cosine = (c * c + h * h - square) / product

    first, second = vector_or_zero(joint.first), vector_or_zero(joint.second)
    ratio = -dot(first, p) / (c * divided)
    swing = -dot(first, q) / (h * divided)
    lag, swing_lag = c * ratio * ratio, h * swing * swing
    ratio_slope = (lag * cosine - swing_lag - dot(second, p)) / (c * divided)
    swing_slope = (lag - swing_lag * cosine - dot(second, q)) / (h * divided)

    links = (q, ratio, ratio_slope), (p, swing, swing_slope)
    return motion_of(joint, h, pivot, *links, (divided, None), heron / unit)


def motion_of(joint, rocker_length, pivot, coupler, rocker, *last):
    """Motion of the group from direction, ratio and slope of both links, and its last fields (kernel)."""
    rocker = LinkMotion(Joint(pivot, None, None), *rocker)
    return RockerMotion(LinkMotion(joint, *coupler), rocker, joint_at(rocker, rocker_length), *last)


def resolve(motion, coupler_length, rocker_length, coupler_load, rocker_load):
    """Forces on the coupler at its inner joint, on the rocker at its pin and at its pivot (kernel).

    Loads are wrenches about the links' reference joints, with the demands of further groups. Moments of the coupler
    about A and of the rocker about O2 give the pin force by its parts along both links.
    """
    q, p = motion.coupler.direction, motion.rocker.direction
    by_rocker = number_or_zero(rocker_load.moment) / rocker_length
    by_coupler = number_or_zero(coupler_load.moment) / coupler_length
    if motion.divisor[1] is None:
        along_coupler, along_rocker = divide((by_rocker, by_coupler), motion.divisor)
        pin = add_vectors(scale_vector(along_coupler, q), scale_vector(along_rocker, p))
    else:  # as a whole, so that what does not grow at the change point is not lost in what does
        whole = add_vectors(scale_vector(by_rocker, q), scale_vector(by_coupler, p))
        pin = divide(whole, motion.divisor)
    pivot = subtract_vectors(subtract_vectors(None, pin), rocker_load.force)
    return subtract_vectors(pin, coupler_load.force), pin, pivot


class TwoJoints:
    """Rule of the two joints of a dyad."""

    rule = checks.Name()

    def quick(self, value):
        named = type(value) is tuple and len(value) == 2 and all(self.rule.quick(name) is name for name in value)
        return value if named and value[0] != value[1] else checks.UNDECIDED

    def check(self, value, field=""):
        if not isinstance(value, tuple | list) or len(value) != 2:
            return value, f"{field} must be the names of two joints, got {checks.shown(value)}"
        found = [self.rule.check(name, f"{field} {place}") for place, name in enumerate(value, 1)]
        problem = found[0][1] or found[1][1]
        if problem is None and value[0] == value[1]:
            problem = f"{field} must name two different joints, got {value[0]!r} twice"
        return tuple(name for name, _ in found), problem


def relative(first, second, length1, length2, assembly):
    """Both links for two moving joints, by the motion of the first one as seen from the second (kernel)."""
    passing = (subtract_vectors(first.first, second.first), subtract_vectors(first.second, second.second))
    seen = place(Joint(first.position, *passing), length1, length2, second.position, assembly)
    pin = Joint(
        seen.pin.position, add_vectors(seen.pin.first, second.first), add_vectors(seen.pin.second, second.second)
    )
    return seen._replace(coupler=seen.coupler._replace(joint=first), rocker=seen.rocker._replace(joint=second), pin=pin)


class RRRGroup(checks.Checked, Group):
    """Two links that meet at the joint `pin`, the ends of their bars."""

    pin: str
    LENGTHS: ClassVar[str]
    """Their lengths in the requirement."""
    closure = Branch.closure

    def _enter(self, placement, motion):
        self.enter(placement, motion, {self.pin: motion.pin})

    def follow(self, placement, joints):
        """Place both links at known joints."""
        for name, point in self.joints.items():
            if point.link == FRAME:
                placement.joints[name] = Joint(point[1:], None, None)
        pin = joints[self.pin]
        first, second = (link_between(placement.joints[bar.start], pin, bar.length) for bar in self.bars)
        divisor = cross(first.direction, second.direction), None
        self._enter(placement, RockerMotion(first, second, pin, divisor, None))

    def requirement(self, placement):
        first, second = self.bars
        low, high = np.min(abs(first.length - second.length)), np.max(first.length + second.length)
        apart = separation(placement, first.start, second.start)
        lengths = self.LENGTHS.format(first.link, second.link)
        return f"{apart} lie between the difference and the sum of {lengths}, {low:.6g} and {high:.6g} m"

    def _forces(self, placement, loads):
        lengths = (bar.length for bar in self.declaration.bars)
        return resolve(self.placed(placement), *lengths, *self.of_links(loads))


@dataclass(frozen=True, eq=False)
class RockerGroup(Branch, RRRGroup):
    """Coupler from joint `on` to joint `pin` of a rocker about the fixed joint `pivot_name`.

    Parameters
    ----------
    coupler_length, rocker_length : float or array
        m.
    pivot : (x, y)
        Fixed pivot O2, m.
    assembly : +1, -1, "open" or "crossed"
        +1: the pin to the left of the direction from the inner joint to the pivot. The words are for a group on A or
        another pin of the crank, as for `four_bar`, or on the pin of another rocker, which counts as its crank.
    coupler, rocker : Link
    on, pin, pivot_name : str
        Names of the joint it is attached to and of the joints it adds.
    label : str
        Appended to the names of links and forces of a second rocker group in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        A value is impossible; the mechanism raises it where the group cannot pass change points that way.

    Notes
    -----
    Reactions, vectors in N:

    - `on`: on the coupler, from the link that carries the joint.
    - `pin`: coupler on rocker.
    - `pivot_name`: ground on rocker.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> bars = ks.Mechanism("four-bar", ks.Crank(0.1), (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)),))
    >>> s = ks.solve(bars, 0.7, crank_speed=10.0)
    >>> round(float(np.hypot(*(s.position("B") - s.position("A")))), 12)
    0.4
    """

    coupler_length: Annotated[Any, checks.Number("m", "coupler length", low=0.0, strict=True)]
    rocker_length: Annotated[Any, checks.Number("m", "rocker length", low=0.0, strict=True)]
    pivot: Annotated[Any, checks.Pair("m", "rocker pivot")]
    assembly: Annotated[int, checks.Sign(tuple(change_points.SIDES))] = 1
    coupler: GroupLink = Link()
    rocker: GroupLink = Link()
    on: Name = "A"
    pin: Name = "B"
    pivot_name: Name = "O2"
    label: Label = ""
    plane: Plane = None
    toggle: str = field(default="", init=False, repr=False)
    """Axis of the toggle that it makes with a slider."""

    LINKS: ClassVar = {"coupler": "on", "rocker": "pivot_name"}
    LENGTHS = "coupler and rocker lengths"
    IS_ON_ROCKERS = True
    TRUSTED = True
    PATHS: ClassVar = {"pivot": "rocker_pivot", "plane": "coupler_plane"}
    KINDS: ClassVar = {
        "": "none",
        FAR: "a + d = b + h",
        NEAR: "|d - a| = |b - h|",
        MEETING: "a = d and b = h",
        PARALLEL: "a = h and b = d",
        KITE: "a = b and d = h",
        RHOMBUS: "a = b = h = d",
    }
    """Crank a, coupler b, rocker h, ground d."""
    RULES = checks.Rules("rocker group")

    @property
    def declaration(self):
        return Declaration(
            joints={self.pin: Point("rocker", self.rocker_length), self.pivot_name: Point(FRAME, *self.pivot)},
            bars=(
                Bar(self.on, self.pin, "coupler", self.coupler_length),
                Bar(self.pivot_name, self.pin, "rocker", self.rocker_length),
            ),
            pairs=(
                Turning("coupler", self.on),
                Turning("rocker", self.pin, "coupler"),
                Turning("rocker", self.pivot_name),
            ),
        )

    @property
    def dimensions(self):
        lengths = {("coupler_length",): Span(self.on, self.pin), ("rocker_length",): Span(self.pivot_name, self.pin)}
        return {**lengths, **of_fixed_point("pivot", self.pivot_name)}

    @property
    def sizes(self):
        return self.coupler_length, self.rocker_length

    def change_kinds(self, a, d, b, h):
        unit = equality(a, b, h, d)
        far, near = abs(a + d - b - h) <= unit, abs(abs(d - a) - abs(b - h)) <= unit
        far, near = far & (d > unit), near & (d > unit)
        meeting = near & (abs(d - a) <= unit)
        kite = abs(a - b) + abs(d - h) < abs(a - h) + abs(d - b)
        both = far & near
        return {RHOMBUS: far & meeting, KITE: both & kite, PARALLEL: both, FAR: far, MEETING: meeting, NEAR: near}

    def beside(self, groups, throws):
        """The group with the axis of its toggle if a slider is on its pin, or with its passage on a rocker."""
        throw, toggle = throws.get(self.on), ""
        if throw is not None:
            guides = [guide for other in groups if self.pin in other.hangs_on for guide in other.guides.values()]
            axes = (near_dead_centre.toggle_axis(self, guide, throw) for guide in guides)
            toggle = next(filter(None, axes), "")
        elif self.through:
            return carriers.on_rocker(self, groups, throws)
        return self if toggle == self.toggle else replace_unchecked(self, toggle=toggle)

    def place(self, placement):
        joint, given = placement.joints[self.on], (self.coupler_length, self.rocker_length, self.pivot)
        if self.passage:
            found = change_points.place(placement, self.on, *given, self.passage, self.side)
        elif placement.course(self.on).throw is not None:
            found = near_dead_centre.place(placement, self.on, *given, self.side, self.is_close)
        else:
            return self._enter(placement, place(joint, *given, self.side))
        coupler, rocker, *rest = found
        if self.toggle:
            p = near_dead_centre.straighten_rocker(rocker[0], coupler[0], joint, *given, self.toggle)
            rocker = (p, *rocker[1:])
        return self._enter(placement, motion_of(joint, *given[1:], coupler, rocker, *rest))

    follow = RRRGroup.follow

    def _enter(self, placement, motion):
        super()._enter(placement, motion)
        swing = Swing(self.pivot, self.rocker_length, motion.rocker.direction)
        placement.courses[self.pin] = Course(swing=swing)

    def resolve(self, placement, loads, along) -> Resolved:
        """Forces as of every group; of a rocker that carries it the moment by virtual work, finite at change points."""
        forces, by_carrier = self._forces(placement, loads), self.placed(placement).by_carrier
        if by_carrier is None:
            return self.resolved(forces)
        velocity, *ratios = by_carrier
        coupler, rocker = self.of_links(loads)
        power = plus(product(coupler.moment, ratios[0]), product(rocker.moment, ratios[1]))
        moment = minus(None, plus(work(coupler.force, velocity), power))
        link = change_points.parse_carrier(self.passage).link
        return self.resolved(forces, demands={link: Wrench(forces[0], moment)})


@dataclass(frozen=True, eq=False)
class Dyad(RRRGroup):
    """Two links from the joints `on` to a joint `pin` that they share, as between two arms of a Watt chain.

    Parameters
    ----------
    length1, length2 : float or array
        From the first and from the second joint to the pin, m.
    on : (str, str)
        Names of the joints it is attached to; both may move.
    pin : str
        Name of the joint it adds.
    assembly : +1 or -1
        +1: the pin to the left of the direction from the first joint to the second.
    dyad1, dyad2 : Link
        Reference joints are the joints in `on`; directions run from there to the pin.
    label : str
        Appended to the names of links and forces of a second dyad in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        A value is impossible, or the same joint twice.

    Notes
    -----
    Reactions, vectors in N:

    - "dyad1_B": on the first link, from the link that carries B (its joint in `on`).
    - "dyad2_C": on the second link, from the link that carries C.
    - `pin`: first link on second.

    Examples
    --------
    Two cranks of one shaft, and a rod on each:

    >>> import kinetostatics as ks
    >>> parts = ks.Pin(on="crank", at=(0.0, 0.1), name="C"), ks.Dyad(0.3, 0.4, on=("A", "C"))
    >>> s = ks.solve(ks.Mechanism("rigid triangle", ks.Crank(0.1), parts), 0.0, crank_speed=10.0)
    >>> bool(abs(s.rate("dyad1") - 10.0) < 1e-12)
    True
    """

    length1: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    length2: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    on: Annotated[Any, TwoJoints()] = ("B", "C")
    pin: Name = "D"
    assembly: Annotated[int, checks.Sign()] = 1
    dyad1: GroupLink = Link()
    dyad2: GroupLink = Link()
    label: Label = ""
    plane: Plane = None

    LINKS: ClassVar = {"dyad1": "on", "dyad2": "on"}
    LENGTHS = "the lengths of {} and {}"
    TRUSTED = is_rigid_triangle = True
    PATHS: ClassVar = {"length1": "dyad1_length", "length2": "dyad2_length", "plane": "dyad1_plane"}
    RULES = checks.Rules("dyad")

    @property
    def hangs_on(self):
        return self.on

    @property
    def names(self):
        return [*super().names, *self.on]

    @property
    def references(self):
        return dict(zip(self.links, self.on, strict=True))

    @property
    def declaration(self):
        first, second = self.on
        return Declaration(
            joints={self.pin: Point("dyad2", self.length2)},
            bars=(Bar(first, self.pin, "dyad1", self.length1), Bar(second, self.pin, "dyad2", self.length2)),
            pairs=(Turning("dyad1", first), Turning("dyad2", second), Turning("dyad2", self.pin, "dyad1")),
        )

    @property
    def dimensions(self):
        first, second = self.on
        return {("length1",): Span(first, self.pin), ("length2",): Span(second, self.pin)}

    def place(self, placement):
        first, second = (placement.joints[name] for name in self.on)
        self._enter(placement, relative(first, second, self.length1, self.length2, self.assembly))

    follow = RRRGroup.follow

    def resolve(self, placement, loads, along) -> Resolved:
        first, pin, second = self._forces(placement, loads)
        demands = {name: Wrench(force, None) for name, force in zip(self.on, (first, second), strict=True)}
        return self.resolved((first, second, pin), demands=demands)

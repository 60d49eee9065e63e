"""Lever group (RPR): block on a pin, sliding in a slotted lever about a fixed pivot; and its inversion, the cylinder.

Let d be the vector from the pivot to the pin. The slot at offset e left of the pivot carries the pin at s along it, s =
+-sqrt((|d| - e)(|d| + e)). The lever's direction is d (s - i e) / |d|^2 in complex numbers. No angle is formed, and s
is a product, so it keeps its digits near zero, where it divides rates and forces.

Where the crank is as long as the pivot's distance, A meets the pivot. On a chosen side the lever reverses there; the
words "open" and "crossed" carry the block to the other side of the pivot (`change_points`).

The swinging cylinder is the inversion of the lever, without offset: its rod points at the pivot, the
reference point for the couple of the pair.
"""

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import clamped_sqrt, guarded_divisor, offset_from_zero, sqrt
from ...numbers.planar import (
    cross,
    dot,
    left,
    minus,
    number_or_zero,
    plus,
    product,
    rotate_back,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
)
from ..dimensions import Span, of_fixed_point
from ..group import FRAME, Declaration, Group, GroupLink, Label, Name, Output, Plane, Point, Resolved, separation
from ..links import Joint, Link, LinkMotion, Slide, Sliding, Slot, Turning, present
from . import change_points, near_dead_centre
from .branches import Branch, equality
from .change_points import MEETING, NEAR, OPPOSITE, divide

MIN_REACH_SHARE = 2.0**-53
"""Least reach along the slot over the distance from pivot to pin, by which rates and forces are divided."""
TERMS = {
    "d": ("d", "from the pivot to the joint"),
    "square": ("D", "square of that distance"),
    "distance": ("a", "that distance"),
    "reach": ("w", "coordinate of the joint along the slot"),
    "along": ("t", "derivative by phi of the joint along the slot"),
    "across": ("n", "derivative by phi of the joint across the slot"),
    "sliding": ("z", "rate at which the joint slides along the slot"),
    "swing": ("q", "part of the acceleration across the slot from turning and sliding together"),
    "resolve.moment": ("K", "moment of both links about the pivot"),
    "resolve.on_block": ("Q", "force of the slot on the block"),
}


class LeverMotion(NamedTuple):
    """A placed lever: `reach` is the pin's coordinate along the slot, `divisor` the same as a divisor.

    `change_points.divide` takes the divisor. `closure` is the reach squared over the squares of distance and speed of
    the pin, without change points: small where the lever spins fast.
    """

    lever: LinkMotion
    block: LinkMotion
    reach: Any
    divisor: tuple[Any, Any]
    closure: Any


def place(joint, pivot, offset, assembly):
    """Direction of the lever for a given joint, its ratio and slope, then the last fields of `LeverMotion` (kernel).

    An offset of None is zero.
    """
    d = (offset_from_zero(joint.position[0] - pivot[0], abs(pivot[0]) + abs(pivot[1])), joint.position[1] - pivot[1])
    square = dot(d, d)
    distance = sqrt(square)
    if offset is None:
        reach = divided = assembly * distance
        reach_square = square
        direction = (d[0] / reach, d[1] / reach)
    else:
        reach_square = (distance - offset) * (distance + offset)
        size = clamped_sqrt(reach_square, square)
        reach, divided = assembly * size, assembly * guarded_divisor(size, MIN_REACH_SHARE * distance)
        direction = rotate_back((d[0] / distance, d[1] / distance), (reach / distance, offset / distance))
    first, second = vector_or_zero(joint.first), vector_or_zero(joint.second)
    along, across = rotate_back(first, direction)
    ratio = across / divided
    sliding = plus(along, product(offset, ratio))
    swing = minus(2.0 * sliding, product(offset, ratio)) * ratio
    ratio_slope = (cross(direction, second) - swing) / divided
    return direction, ratio, ratio_slope, reach, (divided, None), reach_square / (square + dot(first, first))


def resolve(motion, lever_load, block_load):
    """Forces on the block at its joint and on the lever at its pivot, and of the slot on the block (kernel).

    Loads are wrenches about the links' reference joints, with the demands of further groups. Moments of both links
    together about the pivot give the force across the slot.
    """
    moment, across = number_or_zero(plus(lever_load.moment, block_load.moment)), left(motion.lever.direction)
    if motion.divisor[1] is None:
        (slot,) = divide((moment,), motion.divisor)
        on_block = scale_vector(slot, across)
    else:
        slot, *on_block = divide((moment, *scale_vector(moment, across)), motion.divisor)
    inner = subtract_vectors(subtract_vectors(None, on_block), block_load.force)
    return (inner, subtract_vectors(on_block, lever_load.force)), slot


class RPRGroup(checks.Checked, Branch, Group):
    """Group of a `LEVER` about the fixed joint `pivot_name` and a `BLOCK` on joint `on` that slides in it."""

    pivot: Any
    on: str
    pivot_name: str

    LEVER: ClassVar[str]
    BLOCK: ClassVar[str]
    PAIR: ClassVar[str]
    """Name of the sliding pair."""
    is_rod = False
    """Whether the block is a rod that points at the pivot; the couple of the pair is then taken about that."""
    kernels = change_points.slotted, near_dead_centre.slotted

    @property
    def declaration(self):
        about = self.pivot_name if self.is_rod else ""
        pair = Sliding(self.BLOCK, self.on, self.LEVER, f"{self.PAIR}_force", f"{self.PAIR}_moment", about)
        return Declaration(
            joints={self.pivot_name: Point(FRAME, *self.pivot)},
            slots=(Slot(self.LEVER, self.on, self.BLOCK if self.is_rod else "", self.offset),),
            pairs=(Turning(self.BLOCK, self.on), Turning(self.LEVER, self.pivot_name), pair),
        )

    @property
    def dimensions(self):
        lever = self.called(self.LEVER)
        slot = Span((lever, 0.0, 0.0), (lever, 0.0, self.offset))
        return {**of_fixed_point("pivot", self.pivot_name), ("offset",): slot}

    def sliding(self, name, placement):
        motion, offset = self.placed(placement), present(self.offset)
        slid = dot(vector_or_zero(motion.block.joint.first), motion.lever.direction)
        return Slide(motion.lever.direction, plus(slid, product(offset, motion.lever.ratio)), minus(None, offset))

    def motion(self, name, placement):
        return self.placed(placement).reach

    def place(self, placement):
        joint, given = placement.joints[self.on], (self.pivot, present(self.offset))
        found = self.by_branch(placement, *given) or place(joint, *given, self.side)
        lever = LinkMotion(Joint(self.pivot, None, None), *found[:3])
        block = lever._replace(joint=joint)
        if self.is_rod:
            block = block._replace(direction=scale_vector(-1.0, lever.direction))
        links = {self.LEVER: lever, self.BLOCK: block}
        self.enter(placement, LeverMotion(lever, block, *found[3:]), {self.pivot_name: lever.joint}, links)

    def follow(self, placement, joints):
        """Place both links, which add no moving joint."""
        self.place(placement)

    def resolve(self, placement, loads, along) -> Resolved:
        lever_load, block_load = (loads[self.called(name)] for name in (self.LEVER, self.BLOCK))
        reactions, slot = resolve(self.placed(placement), lever_load, block_load)
        couple = lever_load.moment if self.is_rod else minus(None, block_load.moment)
        return self.resolved(reactions, (slot, number_or_zero(couple)))


@dataclass(frozen=True, eq=False)
class LeverGroup(RPRGroup):
    """Block on joint `on`, sliding in a slotted lever about the fixed joint `pivot_name`: crank shaper, Whitworth.

    With the pivot outside the circle of the pin the lever rocks; inside it the lever makes full turns. The distance
    from pivot to pin must stay above the offset.

    With the pivot on the circle of the pin, or as far from it as the offset, the lever has a change point. There the
    block is at the foot of the pivot on the slot, or at the pivot.

    Parameters
    ----------
    pivot : (x, y)
        Fixed pivot of the lever, m.
    on, pivot_name : str
        Names of the joint it is attached to and of the joint it adds.
    offset : float or array
        Of the slot's axis to the left of the pivot, m; 0: the slot points at the pivot.
    lever : Link
        Reference joint `pivot_name`, along the slot toward the block (of assembly +1).
    block : Link
        Reference joint `on`, along the slot as the lever; it turns with it.
    label : str
        Appended to the names of links and forces of a second lever group in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).
    assembly : +1, -1, "open" or "crossed"
        +1: the slot points to the block, -1: away from it. The words are for a group on A or another pin of the crank,
        as for `slotted_lever`.

    Raises
    ------
    ParameterError
        A value is impossible.

    Notes
    -----
    Results:

    - `on` (N): on the block, from the link that carries the joint.
    - `pivot_name` (N): ground on lever.
    - "slot_force" (N): lever on block along the lever's left normal; "slot_moment" (N m): about `on`.
    - "block_position" (m): coordinate of the block along the slot, from the foot of the pivot; negative where the slot
      points away from the block.

    Attach further groups to a `Pin` of the lever: ``ks.Pin(on="lever", at=(0.9, 0.0))``.

    Examples
    --------
    The lever of a crank shaper swings by asin(r / d) to each side:

    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> shaper = ks.slotted_lever(0.1, pivot=(0.0, -0.2))
    >>> s = ks.solve(shaper, np.radians(30.0), crank_speed=6.0)
    >>> bool(abs(s.rate("lever")) < 1e-15)
    False
    >>> dead = ks.solve(shaper, -np.arcsin(0.5), crank_speed=6.0)
    >>> bool(abs(dead.rate("lever")) < 1e-14)
    True
    """

    pivot: Annotated[Any, checks.Pair("m", "lever pivot")]
    on: Name = "A"
    offset: Annotated[Any, checks.Number("m", "slot offset")] = 0.0
    lever: GroupLink = Link()
    block: GroupLink = Link()
    pivot_name: Name = "O2"
    label: Label = ""
    assembly: Annotated[int, checks.Sign(tuple(change_points.SIDES))] = 1
    plane: Plane = None
    LINKS: ClassVar = {"lever": "pivot_name", "block": "on"}
    LEVER, BLOCK, PAIR = "lever", "block", "slot"
    TRUSTED = True
    PATHS: ClassVar = {"pivot": "lever_pivot", "offset": "slot_offset", "plane": "lever_plane"}
    KINDS: ClassVar = {"": "none", MEETING: "a = d and o = 0", NEAR: "o = d - a", OPPOSITE: "o = a - d"}
    """Crank a, distance d from O to the pivot, offset o of the slot."""
    RULES = checks.Rules("lever group")

    @property
    def motions(self):
        text = f"of {self.on} along the slot, from the foot of {self.pivot_name}"
        return {f"{self.called('block')}_position": Output("m", False, text)}

    @property
    def sizes(self):
        return (self.offset,)

    def change_kinds(self, a, d, o):
        unit = equality(a, abs(o), d)
        near, opposite = abs(d - a - o) <= unit, abs(d - a + o) <= unit
        near, opposite = near & (d > unit), opposite & (d > unit)
        return {MEETING: near & opposite, NEAR: near, OPPOSITE: opposite}

    def requirement(self, placement):
        offset = np.max(np.abs(self.offset))
        return f"{separation(placement, self.on, self.pivot_name)} be greater than the slot's offset, {offset:.6g} m"


@dataclass(frozen=True, eq=False)
class CylinderGroup(RPRGroup):
    """Rod on joint `on`, sliding in a cylinder about the fixed joint `pivot_name`: swinging cylinder.

    The pin must not meet the pivot. A fluid's pressure is a `PointForce` between places on rod and cylinder, as
    ``between=(("rod", along, 0.0), "O2")``; the joint `on` itself belongs to another link.

    Parameters
    ----------
    pivot : (x, y)
        Fixed pivot of the cylinder, m.
    on, pivot_name : str
        Names of the joint it is attached to and of the joint it adds.
    rod : Link
        Reference joint `on`, along the rod into the cylinder, toward the pivot.
    cylinder : Link
        Reference joint `pivot_name`, along the cylinder toward the rod's pin.
    label : str
        Appended to the names of links and forces of a second cylinder group in one mechanism.
    plane : float or array, optional
        Position along the crankshaft, m; by default the plane of the joint it is attached to (`machine.planes`).

    Raises
    ------
    ParameterError
        A value is impossible.

    Notes
    -----
    Results:

    - `on` (N): on the rod, from the link that carries the joint.
    - `pivot_name` (N): ground on cylinder.
    - "cylinder_force" (N): cylinder on rod along the cylinder's left normal; "cylinder_moment" (N m): about the pivot.
    - "cylinder_length" (m): distance from pivot to pin.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> engine = ks.Mechanism("oscillating engine", ks.Crank(0.1), (ks.CylinderGroup((0.0, -0.4)),))
    >>> round(float(ks.solve(engine, 0.0, crank_speed=6.0).measure("cylinder_length")), 6)
    0.412311
    """

    pivot: Annotated[Any, checks.Pair("m", "cylinder pivot")]
    on: Name = "A"
    rod: GroupLink = Link()
    cylinder: GroupLink = Link()
    pivot_name: Name = "O2"
    label: Label = ""
    plane: Plane = None

    LINKS: ClassVar = {"rod": "on", "cylinder": "pivot_name"}
    LEVER, BLOCK, PAIR = "cylinder", "rod", "cylinder"
    TRUSTED = is_rod = True
    PATHS: ClassVar = {"pivot": "cylinder_pivot", "plane": "rod_plane"}
    assembly: ClassVar = 1
    RULES = checks.Rules("cylinder group")

    @property
    def motions(self):
        return {self.called("cylinder_length"): Output("m", False, f"from {self.pivot_name} to {self.on}")}

    def requirement(self, placement):
        return f"{separation(placement, self.on, self.pivot_name)} be greater than zero"

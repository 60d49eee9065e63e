"""Lever group (RPR): block on a pin, sliding in a straight slot of a lever that turns about a fixed pivot.

With d the vector from the pivot to the pin, the slot at offset e left of the pivot carries the pin at s along it,
s = +-sqrt((|d| - e)(|d| + e)), and the lever's direction is d (s - i e) / |d|^2 in complex numbers: no angle is formed,
and s is a product, so no digit is lost where it vanishes, which divides rates and forces.

Where the crank is as long as the pivot's distance, A meets the pivot: on a chosen side the lever turns about there at
once, the words "open" and "crossed" carry the block on to the other side of the pivot (`change_points`).
"""

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

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
from ..group import FRAME, Declaration, Group, Output, Point, Resolved, rules_of_parts, separation
from ..links import Joint, Link, LinkMotion, Slide, Sliding, Slot, Turning, Wrench, present
from . import change_points, near_dead_centre
from .branches import Branch, equality
from .change_points import MEETING, NEAR, OPPOSITE

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
    "swing": ("q", "what turning and sliding together add across the slot"),
    "resolve.moment": ("K", "moment of both links about the pivot"),
    "resolve.on_block": ("Q", "force of the slot on what slides in it"),
}
"""Symbols and meanings of kernel lines in hand calculations."""


class LeverMotion(NamedTuple):
    """A placed lever: `reach` is the pin's coordinate along the slot, `divisor` the same to divide by, never zero.

    `closure` is the reach squared over the squares of distance and speed of the pin: small where the lever spins fast.
    On a branch through a change point `divisor` is two factors, of which the second is smallest there, and `closure`
    leaves that out.
    """

    lever: LinkMotion
    block: LinkMotion
    reach: Any
    divisor: Any
    closure: Any


class LeverForces(NamedTuple):
    """`inner`: on the block at its joint; `slot`: lever on block, along the lever's left normal; `pivot`: ground on
    lever.
    """

    inner: Any
    slot: Any
    pivot: Any


def place(joint, pivot, offset, assembly):
    """Lever and block for a given joint (kernel); an offset of None is zero."""
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
    lever = LinkMotion(Joint(pivot, None, None), direction, ratio, ratio_slope)
    closure = reach_square / (square + dot(first, first))
    return LeverMotion(lever, lever._replace(joint=joint), reach, divided, closure)


def passed(placement, on, pivot, offset, slotted, *branch):
    """Lever and block for the pin `on` of a crank, by the kernel `slotted` of a branch (kernel)."""
    direction, ratio, slope, *rest = slotted(placement, on, pivot, offset, *branch)
    lever = LinkMotion(Joint(pivot, None, None), direction, ratio, slope)
    return LeverMotion(lever, lever._replace(joint=placement.joints[on]), *rest)


def resolve(motion, lever_load, block_load):
    """Forces on lever and block (kernel).

    Loads are wrenches about the links' reference joints, with the demands of further groups. Moments of both links
    together about the pivot give the force across the slot.
    """
    moment, across = number_or_zero(plus(lever_load.moment, block_load.moment)), left(motion.lever.direction)
    if isinstance(motion.divisor, tuple):
        slot, *on_block = change_points.divide_by_factors((moment, *scale_vector(moment, across)), motion.divisor)
    else:
        slot = moment / motion.divisor
        on_block = scale_vector(slot, across)
    return LeverForces(
        inner=subtract_vectors(subtract_vectors(None, on_block), block_load.force),
        slot=slot,
        pivot=subtract_vectors(on_block, lever_load.force),
    )


@dataclass(frozen=True, eq=False)
class LeverGroup(checks.Checked, Branch, Group):
    """Block on joint `on`, sliding in a slotted lever about the fixed joint `pivot_name`: crank shaper, Whitworth.

    With the pivot outside the circle of the pin the lever rocks; inside it the lever makes full turns. The distance
    from pivot to pin must stay above the offset.

    With the pivot on the circle of the pin, or as far from it as the offset, the lever has a change point, where the
    block stands at the foot of the pivot on the slot, or at the pivot.

    Parameters
    ----------
    pivot : (x, y)
        Fixed pivot of the lever, m.
    on, pivot_name : str
        Names of the joint it hangs on and of the joint it adds.
    offset : float or array
        Of the slot's axis to the left of the pivot, m; 0: the slot points at the pivot.
    lever : Link
        Reference joint `pivot_name`, along the slot toward the block (of assembly +1).
    block : Link
        Reference joint `on`, along the slot as the lever; it turns with it.
    label : str
        Appended to the names of links and forces of a second lever group in one mechanism.
    assembly : +1, -1, "open" or "crossed"
        +1: the slot points to the block, -1: away from it. "open" and "crossed" are so in the half turn behind the
        direction O -> O2; on A, or another pin of the crank, they go on through change points, so that the lever of a
        crank as long as the pivot's distance turns half as fast as that, and keep their side where there are none.

    Raises
    ------
    ParameterError
        A value no machine can have.

    Notes
    -----
    Reactions: `on` (N) on the block, from what carries the joint; `pivot_name` (N), ground on lever; "slot_force" (N),
    lever on block along the lever's left normal, and "slot_moment" (N m) about `on`. "block_position" (m) is the
    coordinate of the block along the slot, from the foot of the pivot; negative where the slot points away from it.

    Further groups hang on a `Pin` of the lever: ``ks.Pin(on="lever", at=(0.9, 0.0))``.

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

    pivot: Any
    on: str = "A"
    offset: Any = 0.0
    lever: Link = Link()
    block: Link = Link()
    pivot_name: str = "O2"
    label: str = ""
    assembly: int = 1
    LINKS: ClassVar = {"lever": "pivot_name", "block": "on"}
    TRUSTED = True
    PATHS: ClassVar = {"pivot": "lever_pivot", "offset": "slot_offset"}
    KINDS: ClassVar = {"": "none", MEETING: "a = d and o = 0", NEAR: "o = d - a", OPPOSITE: "o = a - d"}
    """Crank a, distance d from O to the pivot, offset o of the slot."""
    kernels = change_points.slotted, near_dead_centre.slotted
    RULES = checks.Rules(
        "lever group",
        pivot=checks.Pair("m", "lever pivot"),
        offset=checks.Number("m", "slot offset"),
        assembly=checks.Sign(tuple(change_points.SIDES)),
        **rules_of_parts(("lever", "block"), "on", "pivot_name"),
    )

    @property
    def declaration(self):
        return Declaration(
            joints={self.pivot_name: Point(FRAME, *self.pivot)},
            slots=(Slot("lever", self.on, offset=self.offset),),
            inner=(Turning("block", self.on),),
            pairs=(Turning("lever", self.pivot_name), Sliding("block", self.on, "lever", "slot_force", "slot_moment")),
            lengths=(*self.pivot, self.offset),
        )

    @property
    def motions(self):
        text = f"of {self.on} along the slot, from the foot of {self.pivot_name}"
        return {f"{self.called('block')}_position": Output("m", False, text)}

    def sliding(self, name, placement):
        motion, offset = self.placed(placement), present(self.offset)
        rate = plus(slid(motion), product(offset, motion.lever.ratio))
        return Slide(motion.lever.direction, rate, minus(None, offset))

    def motion(self, name, placement):
        return self.placed(placement).reach

    @property
    def clearance(self):
        """Offset and pivot, for `near_dead_centre.has_small_clearance`."""
        return self.offset, self.pivot

    def passage_on(self, throw):
        """Kind of its change points on a pin of the crank, and quadrant of `start`; "" without any."""
        a, x, y, o = self.known(throw, self.offset)
        d = np.sqrt(x * x + y * y)
        unit = equality(a, abs(o), d)
        near, opposite = abs(d - a - o) <= unit, abs(d - a + o) <= unit
        near, opposite = near & (d > unit), opposite & (d > unit)
        kind = np.select([near & opposite, near, opposite], [MEETING, NEAR, OPPOSITE], "")
        return self.one_passage(kind, x, y)

    def place(self, placement):
        given = self.pivot, present(self.offset)
        if self.branch:
            motion = passed(placement, self.on, *given, *self.branch)
        else:
            motion = place(placement.joints[self.on], *given, self.side)
        self.enter(placement, motion)

    def follow(self, placement, joints):
        """Place lever and block, which add no moving joint."""
        self.place(placement)

    def requirement(self, placement):
        offset = np.max(np.abs(self.offset))
        return f"{separation(placement, self.on, self.pivot_name)} be greater than the slot's offset, {offset:.6g} m"

    def resolve(self, placement, loads, along) -> Resolved:
        lever_load, block_load = self.of_links(loads)
        found = resolve(self.placed(placement), lever_load, block_load)
        scalars = found.slot, number_or_zero(minus(None, block_load.moment))
        return self.resolved((found.inner, found.pivot), scalars, {self.on: Wrench(found.inner, None)})


def slid(motion):
    """Rate of the pin along the lever."""
    return dot(vector_or_zero(motion.block.joint.first), motion.lever.direction)

"""The branch of a group on a crank: through change points, close to a limit position, or by the plain kernel.

A mixin for each kind of group that may have change points. It keeps two facts of the structure: `passage`, the kind of
change points that the branch passes, and `is_close`, whether the group comes so close to a limit position that
`near_dead_centre` saves digits.
"""

from dataclasses import dataclass, field
from typing import Any, ClassVar

from ...numbers.parameter_tree import replace_unchecked
from . import change_points, near_dead_centre

TERMS = {"_from.short": ("f", "by how much the coupler's reach along the guide falls short of its length")}
"""Symbols and meanings of kernel lines in hand calculations."""


@dataclass(frozen=True, eq=False)
class Branch:
    """Branch of a group with the fields `assembly` and `on`.

    Its kinds give the direction `start` from which the crank angle is halved, ``classify(group, throws)``, the passage,
    and ``comes_close(throw)``.
    """

    passage: str = field(default="", init=False, repr=False)
    is_close: bool = field(default=False, init=False, repr=False)

    classify: ClassVar[Any]
    kernels: ClassVar[tuple[Any, Any]]
    """Kernels through change points and close to limit positions."""
    start: ClassVar[Any]
    comes_close: ClassVar[Any]

    @property
    def side(self: Any):
        """+1 or -1: its side where no change point is passed."""
        return change_points.SIDES.get(self.assembly, self.assembly)

    @property
    def branch(self):
        """Kernel and arguments of its branch; empty for the plain kernel."""
        passing, close = self.kernels
        if self.passage:
            return passing, self.passage, self.side
        return (close, self.side) if self.is_close else ()

    def on_crank(self: Any, throws):
        passage = type(self).classify(self, throws) if self.through else ""
        throw = throws.get(self.on)
        is_close = not passage and throw is not None and self.comes_close(throw)
        if passage == self.passage and is_close is self.is_close:
            return self
        return replace_unchecked(self, passage=passage, is_close=is_close)

    def kink(self, throws):
        return change_points.kink_sentence(self, throws)

    @property
    def turns(self):
        kind = change_points.parse_passage(self.passage)[0] if self.passage else ""
        return 2 if kind in change_points.TWO_TURN_KINDS else 1

    def change_points(self, throws):
        return change_points.crank_angles(self, throws, self.start)


@dataclass(frozen=True, eq=False)
class RockerBranch(Branch):
    """Branch of a rocker group, and the toggle that it may be with a slider."""

    toggle: str = field(default="", init=False, repr=False)

    classify = staticmethod(change_points.rocker_passage)

    @property
    def start(self: Any):
        return self.pivot

    def comes_close(self: Any, throw):
        """Whether the pin comes close to the pivot."""
        return near_dead_centre.passes_near_pivot(throw, 0.0, self.pivot)

    def beside(self, groups, throws):
        """The group with the axis of the toggle that it is with a slider beside it."""
        toggle = near_dead_centre.toggle_axis(self, groups, throws)
        return self if toggle == self.toggle else replace_unchecked(self, toggle=toggle)


class LeverBranch(Branch):
    """Branch of a slotted lever."""

    classify = staticmethod(change_points.lever_passage)
    kernels = change_points.slotted, near_dead_centre.slotted

    @property
    def start(self: Any):
        return self.pivot

    def comes_close(self: Any, throw):
        """Whether the pin comes close to the pivot, or the block to the foot of the pivot on the slot."""
        return near_dead_centre.passes_near_pivot(throw, self.offset, self.pivot)


class SliderBranch(Branch):
    """Branch of a slider group, and the coordinate of its slider without the rounding of the whole."""

    classify = staticmethod(change_points.slider_passage)
    kernels = change_points.slid, near_dead_centre.slid

    @property
    def start(self: Any):
        x, y = self.guide.direction
        return y, -x

    def comes_close(self: Any, throw):
        """Whether the coupler, nearly as long as it must be, comes to stand nearly across the guide."""
        return near_dead_centre.has_small_clearance(throw, self.guide.guide_offset, self.coupler_length)

    def elongation(self: Any, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m, without the rounding of the coordinate."""
        if self.passage:
            return placement.travels[self.called("slider")].position - free_position
        return near_dead_centre.elongation(placement, *self._from(free_position, placement))

    def departure(self: Any, placement, position):
        """Second derivative of that coordinate plus its elongation from a position, m; None where both are large."""
        drawn_in = self.placed(placement).drawn_in
        if self.passage or drawn_in is None:
            return None
        return near_dead_centre.departure(placement, drawn_in, *self._from(position, placement))

    def outward(self, placement, position):
        """That elongation, or its opposite, as a length of the design and some more, m; None if it is not known so."""
        return near_dead_centre.outward(placement, *self._from(position, placement))

    def _from(self: Any, position, placement):
        """Arguments of `near_dead_centre.elongation` from a position."""
        motion, length, side = self.placed(placement), self.coupler_length, self.side
        short = side * near_dead_centre.shortfall(length, motion.sine, side * motion.cosine)
        return self.on, self.guide.line.direction, side * length - position, short

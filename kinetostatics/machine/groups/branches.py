"""The branch of a group on a crank: through change points, close to a limit position, or by the plain kernel.

The user chooses the assembly mode by the field `assembly` of a group, +1, -1, "open" or "crossed". `Branch.side` is its
sign, which the kernels take.

`Branch` keeps two facts of the structure. `passage` is the kind of change points that the branch passes. `is_close`
is True if the group comes so close to a limit position that it needs the kernels of `near_dead_centre`.
"""

import math
import operator
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.parameter_tree import replace_unchecked
from ...numbers.planar import rotate_back
from . import near_dead_centre
from .change_points import FAR, MEETING, RHOMBUS, SIDES, TWO_TURN_KINDS, parse_carrier

MAX_ULPS = 8
"""Largest difference of equal lengths, in units of the last place of the longest length."""
SEVERAL_DESIGNS = "the designs of a batch pass change points at different crank angles; solve a single design"
QUADRANTS = {0: "x >= 0", 1: "x < 0 <= y", -1: "x < 0, y < 0"}
"""Quadrants of a direction (x, y) whose angle, from -pi to pi, is halved."""


def equality(*lengths):
    """Largest difference at which lengths count as equal, m."""
    return MAX_ULPS * np.spacing(np.max(lengths, axis=0).astype(float))


@dataclass(frozen=True, eq=False)
class Branch:
    """Branch of a group with the fields `assembly` and `on`; the crank angle is halved from the direction `start`."""

    passage: str = field(default="", init=False, repr=False)
    is_close: bool = field(default=False, init=False, repr=False)

    KINDS: ClassVar[dict[str, str]] = {}
    """Kinds of change points, in messages."""
    kernels: ClassVar[tuple[Any, Any]]
    """Kernels through change points and close to limit positions."""
    offset = 0.0
    IS_ON_ROCKERS = False
    """Whether it also passes change points on the pin of a rocker (`carriers`)."""

    @property
    def sizes(self):
        """Lengths that decide on change points, besides the radius of the pin and the length of `start`."""
        return ()

    def change_kinds(self, radius, distance, *sizes):
        """Masks of designs by kind of change points, the first of which counts, from lengths in m."""
        return {}

    @property
    def start(self: Any):
        """Direction from which the crank angle is halved."""
        return self.pivot

    @property
    def clearance(self: Any):
        """Offset, and length or pivot, for `has_small_clearance`."""
        return self.offset, self.pivot

    @property
    def side(self: Any):
        """+1 or -1: its side without change points."""
        return SIDES.get(self.assembly, self.assembly)

    def by_branch(self: Any, placement, *given):
        """Result of the kernel of its branch for a pin of the crank; None for the plain kernel."""
        passing, close = self.kernels
        if self.passage:
            return passing(placement, self.on, *given, self.passage, self.side)
        return close(placement, self.on, *given, self.side) if self.is_close else None

    def closure(self: Any, placement):
        """Margin of its motion at each crank angle."""
        return self.placed(placement).closure

    def on_crank(self: Any, throws):
        throw = throws.get(self.on)
        passage = self.passage_on(throw) if self.through else ""
        is_close = not passage and throw is not None and near_dead_centre.has_small_clearance(throw, *self.clearance)
        if passage == self.passage and is_close is self.is_close:
            return self
        return replace_unchecked(self, passage=passage, is_close=is_close)

    def refuse_word(self: Any, pins):
        """Raise `ParameterError`: a group passes change points only on these pins."""
        where = f"it is attached to {self.on!r}" if self.on != "A" else "the crank pin slides in its slot"
        problem = f"assembly {self.assembly!r} is for a group on {pins}, but {where}; give +1 or -1"
        checks.require(self.RULES.owner, problem)

    def passage_on(self: Any, throw, centre=(0.0, 0.0)):
        """Kind of the change points on a pin that turns about a place, and quadrant of `start` from it; or ""."""
        if throw is None and self.IS_ON_ROCKERS:
            return self.passage  # `beside` finds it
        if throw is None:
            self.refuse_word("a pin of the crank at a constant radius")
        given = (*map(operator.sub, self.start, centre), *self.sizes)
        known = all(map(checks.has_known_values, (*throw.at, *given)))
        problem = f"assembly {self.assembly!r} needs lengths that are known when the mechanism is made; give +1 or -1"
        checks.require(self.RULES.owner, None if known else problem)
        parts = (np.asarray(part, dtype=np.longdouble) for part in (*throw.at, *given))
        along, across, x, y, *sizes = np.broadcast_arrays(*parts)
        radius, direction = throw._replace(at=(along, across)).polar
        x, y = rotate_back((x, y), direction)
        if direction is not None:
            y = np.where(abs(y) <= equality(x), 0.0, y)
        masks: dict = self.change_kinds(radius, np.sqrt(x * x + y * y), *sizes)
        kind = np.select(list(masks.values()), list(masks), "")
        facing = np.where(x >= 0, 0, np.where(y >= 0, 1, -1))
        problems = []
        for found, what, called in ((kind, "change points", self.KINDS), (facing, "directions", QUADRANTS)):
            kinds, counts = np.unique(found, return_counts=True)
            if kinds.size > 1:
                texts = "; ".join(called[each] for each in kinds.tolist())
                text = (
                    f"designs that pass change points must be of one kind, but these have {what} {texts} "
                    f"(equal within {MAX_ULPS} ulp of the longest length); make a batch of each"
                )
                problems.append(checks.Problem(text, found != kinds[counts.argmax()]))
            if not kind.flat[0]:
                break
        checks.require(self.RULES.owner, *problems)
        return f"{kind.flat[0]} {facing.flat[0]}" if kind.flat[0] else ""

    def kink(self: Any, throws):
        """Sentence on kinks or jumps of the motion at change points that a chosen side does not pass, or ""."""
        if not self.KINDS or type(self.assembly) is not int or self.on not in throws:
            return ""
        try:
            passing = replace(self, assembly="open").on_crank(throws)
            angles = passing.change_points(throws)
        except ParameterError:  # a batch of several kinds, or of several change points
            return ""
        if not angles:
            return ""
        named = dict.fromkeys(angles, "a kink")
        if passing.kind in (MEETING, RHOMBUS):
            at = angles[0] if len(angles) == 1 else self._first(throws) % (2 * math.pi)
            named[at] = f"a jump, as {self.on} meets the pivot"
        texts = " and ".join(f"{what} at {math.degrees(angle):.6g} deg" for angle, what in named.items())
        return (
            f'assembly {self.assembly:+d} keeps to its side at change points: {texts}; "open" or "crossed" passes them'
        )

    def _first(self: Any, throws):
        """Crank angle at which its pin is in the direction `start`, rad."""
        x, y = rotate_back(self.start, throws[self.on].polar[1])
        return math.atan2(y, x)

    @property
    def kind(self):
        """Kind of the change points that it passes, "" without any."""
        return self.passage.partition(" ")[0]

    @property
    def turns(self):
        carrier = parse_carrier(self.passage)
        return 2 if self.kind in TWO_TURN_KINDS and (carrier is None or carrier.turns % 2) else 1

    @property
    def carrier(self):
        found = parse_carrier(self.passage)
        return found.link if found else ""

    def change_points(self: Any, throws):
        if not self.passage or self.on not in throws:
            return ()
        checks.require(
            "change points", SEVERAL_DESIGNS if any(map(np.ndim, (*self.start, *throws[self.on].at))) else None
        )
        first, turn = self._first(throws), 2 * math.pi
        at = {FAR: [math.pi]}.get(self.kind, [0.0] if self.turns == 2 else [0.0, math.pi])
        return tuple(sorted((first + angle) % turn % turn for angle in at))  # just below 0 rounds up to a turn

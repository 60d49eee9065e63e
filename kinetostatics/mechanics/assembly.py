"""Assembly of a mechanism: crank angles at which its groups close, and the errors where they do not.

The closure margin of a group is negative where its links cannot be assembled, and 0 at a limit position. Gaps are
crank-angle intervals in rad, within one turn or the turns after which the motion repeats.
"""

import numpy as np

from ..errors import AssemblyError, ParameterError
from ..machine.kinematic_state import require_positions
from ..machine.loads import TURN
from ..numbers.arithmetic import SQUARE_TOLERANCE
from ..numbers.brackets import find_minima, find_roots
from . import quantities

MARGIN_SAMPLES = 720
"""Crank angles a turn at which margins are sampled."""
HALF_DIGITS_CONDITION = 1e8
"""Condition number that costs half of the digits."""
NO_DIGITS_CONDITION = 1e16
"""Condition number that leaves rates and forces without a correct digit."""


def check(solution):
    """Raise `AssemblyError` if the mechanism does not close at some angle.

    Returns
    -------
    list of array (..., N)
        Margins of the groups, without margins of unknown value; empty if numbers are not in double precision.
    """
    placement, margins = solution.placement, []
    in_double_precision = getattr(solution.crank_angle, "dtype", None) != np.dtype(object)
    found = solution.mechanism.margins(placement, solution.shape)
    for group, margin in zip(solution.mechanism.groups, found, strict=True):
        try:
            margin = np.asarray(margin, dtype=float)
        except (TypeError, ValueError):  # its value is unknown, as under ``jax.jit``
            continue
        margins.append(margin)
        if not group.trusted and in_double_precision:
            require_positions(group, placement, margin)
        smallest = margin.min()
        if smallest >= 0.0:
            continue
        if not np.all(np.isfinite(placement.angle)):
            raise ParameterError("crank angles must be finite; found NaN or infinity")
        if smallest < -SQUARE_TOLERANCE:
            gap, design = margin < 0, ""
            where: tuple[int, ...] = ()
            if margin.ndim > 1:
                where = tuple(int(i) for i in np.argwhere(gap.any(axis=-1))[0])
                design = f" (first in design {where[0] if len(where) == 1 else where})"
            gaps = ClosureMargin(solution.mechanism, group, where).gaps(np.ravel(placement.angle))
            place = f"at {int(gap.sum())} of {margin.size} crank angles{design}"
            raise _assembly_error(solution.mechanism, group, placement, place, gaps)
    return margins if in_double_precision else []


def unbounded_force_problem(solution, name, values):
    """Sentence on forces that grow without bound near change points that the mechanism passes, or None."""
    sizes = np.abs(values) if values.shape == solution.shape else np.abs(values).max(axis=0)
    terms = np.maximum(solution.largest_force_term, solution.largest_torque_term)
    with np.errstate(invalid="ignore"):
        beyond = sizes > HALF_DIGITS_CONDITION * np.expand_dims(terms, -1)
    if not np.any(beyond):
        return None
    worst = int(np.argmax(np.where(beyond, sizes, 0.0)))
    angle, size = np.broadcast_to(solution.crank_angle, sizes.shape).flat[worst], sizes.flat[worst]
    found = "infinite" if np.isinf(size) else f"{size:.3g} {quantities.unit_of(solution, name)}"
    return (
        f"{solution.mechanism.name}: {name} is {found} at crank angle {np.degrees(angle):.9g} deg, at a change point "
        "that the mechanism passes. There it has a second freedom for an instant, and its joints carry no load; motion "
        f"and balancing torque are right ({int(np.sum(beyond))} of {sizes.size} crank angles)"
    )


def _assembly_error(mechanism, group, placement, where, gaps, *remedy):
    text = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g} deg" for start, stop in gaps)
    why = group.requirement(placement) or f"the closure of {type(group).__name__} is negative there"
    return AssemblyError(
        f"{mechanism.name} cannot be assembled {where}: {why}. It does not close for crank angles {text}", gaps, *remedy
    )


class ClosureMargin:
    """Closure margin of a group, in one design of a batch, as a function of the crank angle."""

    def __init__(self, mechanism, group, design=()):
        self.mechanism, self.group, self.design = mechanism, group, design
        self.period = TURN * mechanism.turns
        self.grid = np.linspace(0.0, self.period, MARGIN_SAMPLES * mechanism.turns, endpoint=False)

    def __call__(self, angle):
        with np.errstate(invalid="ignore"):
            found = self.group.closure(self.mechanism.place(angle))
        return np.broadcast_to(found, np.broadcast_shapes(np.shape(found), angle.shape))[self.design]

    def minima(self, below):
        """Crank angles of the local minima that are less than `below`, rad."""
        samples = self(self.grid)
        before, after = np.roll(samples, 1), np.roll(samples, -1)
        bend = np.abs(before - 2.0 * samples + after)
        place = self.grid[(samples <= before) & (samples <= after) & (samples - bend < below) & (bend > 0)]
        if not place.size:
            return place
        step = TURN / MARGIN_SAMPLES
        found = find_minima(lambda angle, _: self(angle), (place - step, place, place + step))
        lowest = np.where(self(found) < self(place) - SQUARE_TOLERANCE, found, place)
        return lowest[self(lowest) < below]

    def open_angles(self):
        """Crank angles half a degree apart, and minima between them, if the group is open at one; or None."""
        angle = np.concatenate([self.grid, self.minima(0.0)])
        return angle if (self(angle) < -SQUARE_TOLERANCE).any() else None

    def gaps(self, angles=()):
        """Crank-angle intervals where the group does not close, rad, by roots between a grid, `angles` and minima."""
        grid = np.unique(np.mod(np.concatenate([self.grid, angles, self.minima(0.0)]), self.period))
        gap = self(grid) < 0
        if gap.all():
            return ((0.0, self.period),)
        ends = np.append(grid, grid[0] + self.period)
        change = np.flatnonzero(gap != np.roll(gap, -1))
        if not change.size:
            return tuple((float(angle), float(angle)) for angle in angles[self(angles) < 0])
        edges = find_roots(lambda angle, _: self(angle), ends[change], ends[change + 1])
        starts, stops = edges[~gap[change]], edges[gap[change]]
        if stops.size and stops[0] < starts[0]:
            stops = np.roll(stops, -1)
            stops[-1] += self.period
        # the others are change points, open by rounding only
        real = self((starts + stops) / 2) < -SQUARE_TOLERANCE
        kept = real if real.any() else ~real
        return tuple((float(start), float(stop)) for start, stop in zip(starts[kept], stops[kept], strict=True))


def limit_angles(mechanism, below):
    """Crank angles, rad, at which the closure margin of a group has a minimum below `below`."""
    found = [ClosureMargin(mechanism, group).minima(below) for group in mechanism.groups]
    return np.unique(np.mod(np.concatenate([np.empty(0), *found]), TURN * mechanism.turns))


def gap_intervals(mechanism):
    """Crank-angle intervals where some group does not close, rad, in order and without overlap."""
    found: list[tuple[float, float]] = []
    whole = TURN * mechanism.turns
    for group in mechanism.groups:
        margin = ClosureMargin(mechanism, group)
        found += margin.gaps() if margin.open_angles() is not None else ()
    united: list[tuple[float, float]] = []
    for start, stop in sorted(found):
        if united and start <= united[-1][1]:
            united[-1] = united[-1][0], max(stop, united[-1][1])
        else:
            united.append((start, stop))
    if len(united) > 1 and united[-1][1] >= united[0][0] + whole:
        start, stop = united.pop()
        united[0] = start, max(united[0][1] + whole, stop)
    return tuple(sorted(united))


def require_turn(mechanism):
    """Raise `AssemblyError` if the mechanism does not close all round the turn, between samples too."""
    for group in mechanism.groups:
        margin = ClosureMargin(mechanism, group)
        angle = margin.open_angles()
        if angle is not None:
            where, remedy = "all round the turn", " so that the crank turns all round"
            raise _assembly_error(mechanism, group, mechanism.place(angle), where, margin.gaps(), remedy)

"""Where a mechanism can be assembled: the check behind `solve`, and the crank-angle intervals for its message."""

import warnings

import numpy as np

from .elementary import ROUNDING
from .errors import AssemblyError, ConditionWarning, ParameterError

TURN = 2 * np.pi
GRID = np.linspace(0.0, TURN, 721)[:-1]
NEAR_LIMIT = 1e-8
"""Closure margin below which half the digits of velocities and forces are gone."""


def check(mechanism, placement):
    """Raise `AssemblyError` if the mechanism does not close at some angle; warn if it nearly does not."""
    for group in mechanism.groups:
        margin = _looked_at(group.closure(placement))
        if margin is None:
            continue
        smallest = margin.min()
        if smallest >= NEAR_LIMIT:
            continue
        if not np.all(np.isfinite(placement.angle)):
            raise ParameterError("crank angles must be finite; found NaN or infinity")
        if smallest >= -ROUNDING:
            _warn_near_limit(mechanism, placement, margin, smallest)
        else:
            raise _error(mechanism, group, placement, margin)


def _looked_at(margin):
    """The margin as a NumPy array; None where it has no value yet, as under ``jax.jit``."""
    if isinstance(margin, np.ndarray) and margin.dtype == float:
        return margin
    try:
        return np.asarray(margin, dtype=float)
    except (TypeError, ValueError):
        return None


def _warn_near_limit(mechanism, placement, margin, smallest):
    angle = np.broadcast_to(placement.angle, margin.shape).flat[int(np.argmin(margin))]
    smallest = max(smallest, 0.0)
    lost = np.inf if smallest == 0 else -np.log10(smallest)
    warnings.warn(
        f"{mechanism.name}: at crank angle {np.degrees(angle):.9g} deg it is near a limit position: the sine "
        f"or cosine that divides rates and forces is {np.sqrt(smallest):.3g} (squared {smallest:.3g}); they have about "
        f"{max(0.0, 16 - lost):.0f} correct digits there and grow without bound (solution.condition says how many "
        "times errors are magnified, angle by angle)",
        ConditionWarning,
        stacklevel=5,
    )


def _error(mechanism, group, placement, margin):
    open_ = margin < 0
    count = int(open_.sum())
    design = ""
    where: tuple[int, ...] = ()
    if margin.ndim > 1:
        where = tuple(int(i) for i in np.argwhere(open_.any(axis=-1))[0])
        design = f" (first in design {where[0] if len(where) == 1 else where})"
    gaps = intervals(mechanism, group, where, np.ravel(placement.angle))
    text = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(end):.6g} deg" for start, end in gaps)
    return AssemblyError(
        f"{mechanism.name} cannot be assembled at {count} of {margin.size} crank angles{design}: "
        f"{group.requirement(placement)}. It does not close for crank angles {text}",
        gaps,
    )


def intervals(mechanism, group, design=(), angles=()):
    """Crank-angle intervals within one turn where a group does not close, to rounding accuracy.

    Found on a grid of half a degree, at the given angles and where the closure margin is smallest between them, each
    end by root finding on the margin.
    """
    from scipy.optimize import elementwise

    margin = _margin(mechanism, group, design)
    grid = np.concatenate([GRID, np.mod(angles, TURN)])
    with np.errstate(invalid="ignore"):
        grid = np.unique(np.concatenate([grid, np.mod(_lowest(margin, 0.0), TURN)]))
        gap = margin(grid) < 0
        if gap.all():
            return ((0.0, TURN),)
        ends = np.append(grid, grid[0] + TURN)
        change = np.flatnonzero(gap != np.roll(gap, -1))
        if not change.size:
            return tuple((float(angle), float(angle)) for angle in angles[margin(angles) < 0])
        root = elementwise.find_root(margin, (ends[change], ends[change + 1]))
    edges = root.x
    starts, stops = edges[~gap[change]], edges[gap[change]]
    if stops.size and stops[0] < starts[0]:
        stops = np.roll(stops, -1)
        stops[-1] += TURN
    return tuple((float(start), float(stop)) for start, stop in zip(starts, stops, strict=True))


def near_limits(mechanism, below):
    """Crank angles within one turn, rad, where the closure margin of a group is smallest, and less than `below`."""
    found = [_lowest(_margin(mechanism, group), below) for group in mechanism.groups]
    return np.unique(np.mod(np.concatenate([np.empty(0), *found]), TURN))


def gaps(mechanism):
    """Crank-angle intervals within one turn where some group does not close, in order; they do not overlap."""
    found = []
    for group in mechanism.groups:
        margin = _margin(mechanism, group)
        with np.errstate(invalid="ignore"):
            angle = np.concatenate([GRID, _lowest(margin, 0.0)])
            if (margin(angle) < -ROUNDING).any():
                found += intervals(mechanism, group)
    return _united(found)


def require_turn(mechanism):
    """Raise `AssemblyError` if the mechanism does not close somewhere in the turn, be it between any samples."""
    for group in mechanism.groups:
        margin = _margin(mechanism, group)
        with np.errstate(invalid="ignore"):
            angle = np.concatenate([GRID, _lowest(margin, 0.0)])
            found = margin(angle)
        if (found < -ROUNDING).any():
            where = intervals(mechanism, group)
            text = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g} deg" for start, stop in where)
            raise AssemblyError(
                f"{mechanism.name} cannot be assembled all round the turn: "
                f"{group.requirement(mechanism.place(angle))}. It does not close for crank angles {text}",
                where,
            )


def _margin(mechanism, group, design=()):
    """Closure margin of a group, of one design of a batch, as a function of the crank angle."""

    def margin(angle):
        found = group.closure(mechanism.place(angle))
        return np.broadcast_to(found, np.broadcast_shapes(np.shape(found), angle.shape))[design]

    return margin


def _lowest(margin, below):
    """Crank angles of the local minima of a margin that may be less than `below`, found between half degrees."""
    from scipy.optimize import elementwise

    samples = margin(GRID)
    before, after = np.roll(samples, 1), np.roll(samples, -1)
    bend = np.abs(before - 2.0 * samples + after)
    place = GRID[(samples <= before) & (samples <= after) & (samples - bend < below) & (bend > 0)]
    if not place.size:
        return place
    step = TURN / GRID.size
    with np.errstate(invalid="ignore"):
        found = elementwise.find_minimum(margin, (place - step, place, place + step))
    lowest = np.where(margin(found.x) < margin(place) - ROUNDING, found.x, place)
    return lowest[margin(lowest) < below]


def _united(intervals):
    """The same intervals in order, those that overlap as one."""
    united: list[tuple[float, float]] = []
    for start, stop in sorted(intervals):
        if united and start <= united[-1][1]:
            united[-1] = united[-1][0], max(stop, united[-1][1])
        else:
            united.append((start, stop))
    if len(united) > 1 and united[-1][1] >= united[0][0] + TURN:
        start, stop = united.pop()
        united[0] = start - TURN, max(united[0][1], stop - TURN)
        united = [(united[0][0] + TURN, united[0][1] + TURN), *united[1:]]
    return tuple(sorted(united))

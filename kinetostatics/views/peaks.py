"""Crank angles that a curve must not miss: extremes between those solved, kinks, and both sides of jumps."""

import numpy as np

from ..errors import KinetostaticsError
from ..results.extremes import extrema
from ..results.rounding import PLACED
from ..solution.drive_and_loads import over_the_angles

AT = 1e-12
"""Distance from a kink, rad, within which samples of the turn stand at it or at a side of a jump."""


def with_peaks(named, *quantities):
    """Solutions by label with more crank angles: those of extremes of quantities, and of kinks of tables and friction.

    All have those of all, so that curves that cover each other still do. A solution stays as it is where there is
    nothing between its crank angles, or these do not rise.

    Parameters
    ----------
    named : mapping of label to Solution
        Each of one design.
    quantities : str or function
        As for `extremes`; vectors by their magnitude.
    """
    more = np.concatenate([np.empty(0), *(_of(solution, item) for solution in named.values() for item in quantities)])
    return {name: _with_angles(solution, np.unique(more)) for name, solution in named.items()}


def _of(solution, quantity):
    """Crank angles in a period that a curve of a quantity must not miss; none where its extremes cannot be told."""
    if not _is_known_between(solution):
        return np.empty(0)
    try:
        found = extrema(solution, quantity)
    except KinetostaticsError:  # a force that does not repeat, for one, can still be drawn where it is solved
        return np.empty(0)
    return between(solution, found.angle[np.isfinite(found.value)])


def between(solution, extremes):
    """Crank angles of extremes where the solution has none, and of kinks and both sides of jumps, rising."""
    there = np.abs(extremes[:, None] - np.mod(solution.crank_angle, solution.period)).min(axis=1) < PLACED
    return np.unique(np.concatenate([extremes[~there], _corners(solution.sampled)]))


def _corners(turn):
    """Samples of a turn at kinks and at both sides of jumps."""
    if not turn.kinks.size:
        return turn.kinks
    kinks = np.concatenate([turn.kinks[-1:] - turn.period, turn.kinks, turn.kinks[:1] + turn.period])
    behind = np.searchsorted(kinks, turn.angle).clip(1, kinks.size - 1)
    distance = np.minimum(turn.angle - kinks[behind - 1], kinks[behind] - turn.angle)
    return turn.angle[distance < AT]


def _is_known_between(solution):
    angle = solution.crank_angle
    return np.ndim(angle) == 1 and not over_the_angles(solution) and angle.size > 1 and bool(np.all(np.diff(angle) > 0))


def _with_angles(solution, more):
    """The solution with such crank angles of its period besides its own, as far as these go round."""
    if not more.size or not _is_known_between(solution):
        return solution
    own, period = solution.crank_angle, solution.period
    span = own[-1] - own[0]
    turns = np.round((span + np.max(np.diff(own))) / period)
    whole = abs(span + np.max(np.diff(own)) - turns * period) < 1e-9 * period
    end = own[0] + (turns * period if whole else span)
    again = period * np.arange(np.floor(own[0] / period), np.floor(end / period) + 1.0)
    more = np.ravel(np.mod(more, period) + again[:, None])
    return solution.at(np.union1d(own, more[(more > own[0]) & (more < end)]))

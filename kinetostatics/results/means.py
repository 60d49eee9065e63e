"""Means over the period: integrals that know where their functions jump, have kinks or change their sign."""

import math
import warnings
from typing import NamedTuple

import numpy as np

from ..engines.error_bounds import SAFE
from ..errors import ConditionWarning, ParameterError
from ..machine.loads import TURN
from ..mechanics import jamming
from ..numbers.arithmetic import UNIT_ROUNDOFF
from ..numbers.brackets import find_roots
from .extremes import extrema, warning
from .turn import USABLE, require_single

_HALF = np.array([0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363]) / 2
NODES = 0.5 + np.concatenate([-_HALF[::-1], _HALF])
"""Of Gauss's quadrature, in shares of a panel (Abramowitz and Stegun, table 25.4)."""
_HALF = np.array([0.362683783378362, 0.31370664587788727, 0.22238103445337448, 0.10122853629037626]) / 2
WEIGHTS = np.concatenate([_HALF[::-1], _HALF])
"""Theirs, right to the last digit: those of `numpy.polynomial` are off by up to 72 `UNIT_ROUNDOFF`."""
SPLIT = 0.4
"""Where a panel is parted: not in the middle, on both sides of which nodes lie alike, so that jumps there hide."""
CLOSE = 1e-14
"""Share of the integral, divided by the panels, that parting a panel may change for it to be done."""
PRECISE = 1e-9
"""Error of a mean, relative to it, from which a warning tells."""
SMALLEST = 1e-14
"""Panel, in periods, that is not parted any more."""
LARGEST = 2**17
"""Crank angles evaluated at a time."""
WORK = 2**17
"""Panels after which the quadrature stops."""
SUMMED = NODES.size + 4
"""Roundings, at most, that a value meets on its way into a mean: of its weight, in the sum of its panel, of the product
with its width, in the sum of all, which is rounded once, and of the quotient by the period."""
ROUNDED = 1e-14
"""Share of the largest term of a sum that is its rounding."""


def mean_absolute_torque(solution):
    """Integral mean of the absolute balancing torque over the period of the solution, N m.

    By Gauss quadrature between changes of sign, on panels that are parted where the parts do not agree with the whole,
    which closes in on jumps, corners and narrow pulses of a load. The nodes of the first panels are a fiftieth of a
    degree apart at most where a load is a function; a pulse between them may pass unseen.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    JammingError
        Friction jams somewhere in the turn.

    Warns
    -----
    ConditionWarning
        The torque grows without bound at a limit position, so the mean is infinite; values around it that have no
        correct digit do not count; or the load is so uneven that fewer digits of the mean are right.
    """
    turn = closed_turn(solution, "mean torque")
    peaks = extrema(solution, "balancing_torque")
    words = [warning(solution, [peaks])]
    mean = np.inf
    if not np.isinf(peaks.value).any():
        mean, error, floor, _ = _mean_of_absolute_torque(turn)
        if error > PRECISE * mean + floor:
            words.append(f"mean torque: it is right to about {error:.2g} N m of {mean:.6g} only, so uneven is the load")
    for text in filter(None, words):
        warnings.warn(text, ConditionWarning, stacklevel=2)
    return mean


class MeanErrors(NamedTuple):
    """By how much a mean may be wrong.

    Attributes
    ----------
    rounding : float
        Proven bound on what all rounding errors make of the sum that the mean is: by how much it is off the same sum,
        of the same nodes and panels, in exact arithmetic.
    quadrature : float
        About what that sum differs by from the mean of the function, which it samples.
    """

    rounding: float
    quadrature: float


def mean_absolute_torque_errors(solution):
    """Errors of `mean_absolute_torque`, N m; both infinite as it is.

    Raises
    ------
    NotGivenError
        As for `Solution.error_bound`.
    """
    turn = closed_turn(solution, "mean torque")
    if np.isinf(extrema(solution, "balancing_torque").value).any():
        return MeanErrors(np.inf, np.inf)
    mean, error, _, panels = _mean_of_absolute_torque(turn)

    def bounds(angle):
        return turn.at.at(turn.clear(angle)).error_bound("balancing_torque")[None]

    bound = _sum(_integrals(bounds, *panels)) / turn.period  # of a value with a sign, or of the absolute one
    return MeanErrors(SAFE * float(bound[0] + SUMMED * UNIT_ROUNDOFF * mean), error)


def _torque(turn, angle):
    return turn.at.at(turn.clear(angle)).balancing_torque


def _mean_of_absolute_torque(turn):
    """Mean, about how much it may be wrong, rounding of the values, and panels of the sum."""

    def torque(angle):
        return _torque(turn, angle)

    floor = ROUNDED * turn.at.at(turn.angle[turn.usable]).largest_torque_term
    grid = _grid(turn)
    samples = torque(grid)
    change = np.flatnonzero(samples[:-1] * samples[1:] < 0)
    ends = grid[change], grid[change + 1]
    zeros = find_roots(lambda angle, _: torque(angle), *ends) if change.size else []
    (mean,), (error,), panels = _summed(lambda angle: np.abs(torque(angle))[None], turn, floor, zeros)
    return float(mean), float(error), floor, panels


def energy_per_turn(solution):
    """Work of the balancing torque in a turn of the crank, J: what the loads take of the drive, negative if they give.

    The integral over the period of the solution, as of `mean_absolute_torque`, by its turns.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    """
    turn = closed_turn(solution, "energy per turn")
    at = turn.at.at(turn.angle[turn.usable])
    floor = ROUNDED * at.largest_torque_term
    (mean,), _ = means(lambda angle: turn.at.at(turn.clear(angle)).balancing_torque[None], turn, floor)
    return TURN * float(mean) * (-1.0 if np.any(np.asarray(at.crank_sense) < 0.0) else 1.0)


def closed_turn(solution, owner):
    """Turn of a single design that closes all round, and does not jam."""
    require_single(solution, owner, "balancing_torque")
    turn = solution.sampled
    if turn.gaps:
        raise ParameterError(f"{owner}: {solution.mechanism.name} {turn.unclosed}")
    jamming.require_free(turn.at, owner)
    return turn


def means(function, turn, floor, edges=()):
    """Means over the turn of functions of the crank angle, and about how much each may be wrong.

    Parameters
    ----------
    function : function
        From crank angles (N,) to values (functions, N).
    turn : Turn
    floor : float or array (functions,)
        Rounding of the values.
    edges : array, optional
        Crank angles where functions jump or have a kink, besides those that the turn knows.
    """
    return _summed(function, turn, floor, edges)[:2]


def _summed(function, turn, floor, edges):
    """Means, about how much each may be wrong, and the panels of the sums: where they start, and their widths."""
    edges = np.unique(np.concatenate([_grid(turn), edges]))
    floor = np.reshape(floor, (-1, 1))
    profile = np.fmin(turn.condition, USABLE) * (turn.limits.size > 0)
    noise = np.abs(function(edges)).max(axis=-1, keepdims=True) * UNIT_ROUNDOFF * profile
    start, width = edges[:-1], np.diff(edges)
    whole, parts, panels = _integrals(function, start, width), [], []
    size, wrong, room = 0.0, 0.0, WORK
    while start.size:
        left, right = SPLIT * width, (1.0 - SPLIT) * width
        halves = np.array([start, start + left]), np.array([left, right])
        both = _integrals(function, *map(np.ravel, halves)).reshape(-1, 2, start.size)
        error = np.abs(both.sum(axis=1) - whole)
        room -= 2 * start.size
        largest = (size + np.abs(both).sum(axis=(1, 2)))[:, None]
        rounding = np.array([np.interp(start, turn.angle, row) for row in noise])
        rough = (error > width * (floor + rounding) + 1e-16 * largest) & (error > CLOSE * largest / start.size)
        rough = rough.any(axis=0) & (left > SMALLEST * turn.period) & (room >= 0)
        parts.append(both[..., ~rough].reshape(both.shape[0], -1))
        panels.append([np.ravel(half[:, ~rough]) for half in halves])
        size = size + np.abs(parts[-1]).sum(axis=-1)
        wrong = wrong + error[:, ~rough].sum(axis=-1)
        start, width = (np.ravel(half[:, rough]) for half in halves)
        whole = both[..., rough].reshape(both.shape[0], -1)
    total = _sum(np.concatenate(parts, axis=-1))
    return total / turn.period, wrong / turn.period, [np.concatenate(part) for part in zip(*panels, strict=True)]


def _integrals(function, start, width):
    """Integral of each function over each panel."""
    parts = []
    for some in np.array_split(np.arange(start.size), 1 + start.size * NODES.size // LARGEST):
        angle = start[some, None] + width[some, None] * NODES
        parts.append(function(angle.ravel()).reshape(-1, *angle.shape) @ WEIGHTS)
    return width * np.concatenate(parts, axis=-1)


def _sum(parts):
    """Sum of each row, rounded once."""
    return np.array([math.fsum(row) for row in parts])


def _grid(turn):
    even = np.linspace(0.0, turn.period, turn.panels + 1)
    return np.unique(np.concatenate([even, turn.limits % turn.period, turn.kinks]))

"""Means over the period: adaptive Gauss quadrature between the kinks, jumps and sign changes of functions."""

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
from .turn import MAX_CONDITION, require_single

_HALF = np.array([0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363]) / 2
NODES = 0.5 + np.concatenate([-_HALF[::-1], _HALF])
"""Gauss points, relative to a panel (Abramowitz and Stegun, table 25.4)."""
_HALF = np.array([0.362683783378362, 0.31370664587788727, 0.22238103445337448, 0.10122853629037626]) / 2
WEIGHTS = np.concatenate([_HALF[::-1], _HALF])
"""Their weights, right to the last digit: those of `numpy.polynomial` are off by up to 72 `UNIT_ROUNDOFF`."""
SPLIT = 0.4
"""Place at which a panel is split; not the middle, about which the nodes are symmetrical and hide jumps."""
SPLIT_TOLERANCE = 1e-14
"""Change of the integral by a split, relative to it and divided by the panels, at which a panel is done."""
WARNING_ERROR = 1e-9
"""Relative error of a mean above which a warning is due."""
MIN_PANEL = 1e-14
"""Smallest panel, relative to the period, that is split."""
MAX_ANGLES = 2**17
"""Crank angles evaluated at a time."""
MAX_PANELS = 2**17
"""Panels after which the quadrature stops."""
ROUNDINGS = NODES.size + 4
"""Roundings of a value on its way into a mean, at most: weight, sum of its panel, product with its width, sum of all
panels (rounded once), quotient by the period."""
TERM_ROUNDING = 1e-14
"""Rounding of a sum relative to its largest term."""


def mean_absolute_torque(solution):
    """Integral mean of the absolute balancing torque over the period of the solution, N m.

    By Gauss quadrature between changes of sign. Panels are split until the parts agree with the whole, which closes in
    on jumps, kinks and narrow pulses of a load. The nodes of the first panels are a fiftieth of a degree apart at most
    where a load is a function; a pulse between them may be missed.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    JammingError
        Friction jams somewhere in the turn.

    Warns
    -----
    ConditionWarning
        The torque grows without bound at a limit position, so the mean is infinite; values around it without a correct
        digit do not count; or the load is so uneven that fewer digits of the mean are right.
    """
    turn = closed_turn(solution, "mean torque")
    peaks = extrema(solution, "balancing_torque")
    words = [warning(solution, [peaks])]
    mean = np.inf
    if not np.isinf(peaks.value).any():
        mean, error, floor, _ = _mean_of_absolute_torque(turn)
        if error > WARNING_ERROR * mean + floor:
            words.append(f"mean torque: it is right to about {error:.2g} N m of {mean:.6g} only, so uneven is the load")
    for text in filter(None, words):
        warnings.warn(text, ConditionWarning, stacklevel=2)
    return mean


class MeanErrors(NamedTuple):
    """Errors of a mean.

    Attributes
    ----------
    rounding : float
        Proven bound on the rounding error: distance from the same sum, of the same nodes and panels, in exact
        arithmetic.
    quadrature : float
        Estimate of the distance of that sum from the integral mean.
    """

    rounding: float
    quadrature: float


def mean_absolute_torque_errors(solution):
    """`MeanErrors` of `mean_absolute_torque`, N m; both infinite where the mean is.

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

    bound = _sum(_integrals(bounds, *panels)) / turn.period  # also bounds the error of the magnitude
    return MeanErrors(SAFE * float(bound[0] + ROUNDINGS * UNIT_ROUNDOFF * mean), error)


def _mean_of_absolute_torque(turn):
    """Mean, estimate of its error, rounding of the values, and panels of the sum."""

    def torque(angle):
        return turn.at.at(turn.clear(angle)).balancing_torque

    floor = TERM_ROUNDING * turn.at.at(turn.angle[turn.usable]).largest_torque_term
    grid = _grid(turn)
    samples = torque(grid)
    change = np.flatnonzero(samples[:-1] * samples[1:] < 0)
    ends = grid[change], grid[change + 1]
    zeros = find_roots(lambda angle, _: torque(angle), *ends) if change.size else []
    (mean,), (error,), panels = means(lambda angle: np.abs(torque(angle))[None], turn, floor, zeros)
    return float(mean), float(error), floor, panels


def energy_per_turn(solution):
    """Work of the balancing torque in a turn of the crank, J: energy from drive to loads, negative if they give it.

    Over the period of the solution, as for `mean_absolute_torque`, divided by its turns.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    """
    turn = closed_turn(solution, "energy per turn")
    at = turn.at.at(turn.angle[turn.usable])
    floor = TERM_ROUNDING * at.largest_torque_term
    (mean,), *_ = means(lambda angle: turn.at.at(turn.clear(angle)).balancing_torque[None], turn, floor)
    return TURN * float(mean) * (-1.0 if np.any(np.asarray(at.crank_sense) < 0.0) else 1.0)


def closed_turn(solution, owner):
    """`Turn` of a single design; refused where it does not close all round or jams."""
    require_single(solution, owner, "balancing_torque")
    turn = solution.sampled
    if turn.gaps:
        raise ParameterError(f"{owner}: {solution.mechanism.name} {turn.unclosed}")
    jamming.require_free(turn.at, owner)
    return turn


def means(function, turn, floor, edges=()):
    """Means over the period of functions of the crank angle, estimates of their errors, starts and widths of panels.

    Parameters
    ----------
    function : function
        From crank angles (N,) to values (functions, N).
    turn : Turn
    floor : float or array (functions,)
        Rounding of the values.
    edges : array, optional
        Crank angles where functions jump or have a kink, besides the turn's own.
    """
    edges = np.unique(np.concatenate([_grid(turn), edges]))
    floor = np.reshape(floor, (-1, 1))
    profile = np.fmin(turn.condition, MAX_CONDITION) * (turn.limits.size > 0)
    noise = np.abs(function(edges)).max(axis=-1, keepdims=True) * UNIT_ROUNDOFF * profile
    start, width = edges[:-1], np.diff(edges)
    whole, parts, panels = _integrals(function, start, width), [], []
    size, wrong, room = 0.0, 0.0, MAX_PANELS
    while start.size:
        left, right = SPLIT * width, (1.0 - SPLIT) * width
        halves = np.array([start, start + left]), np.array([left, right])
        both = _integrals(function, *map(np.ravel, halves)).reshape(-1, 2, start.size)
        error = np.abs(both.sum(axis=1) - whole)
        room -= 2 * start.size
        largest = (size + np.abs(both).sum(axis=(1, 2)))[:, None]
        rounding = np.array([np.interp(start, turn.angle, row) for row in noise])
        rough = error > width * (floor + rounding) + 1e-16 * largest
        rough &= error > SPLIT_TOLERANCE * largest / start.size
        rough = rough.any(axis=0) & (left > MIN_PANEL * turn.period) & (room >= 0)
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
    for some in np.array_split(np.arange(start.size), 1 + start.size * NODES.size // MAX_ANGLES):
        angle = start[some, None] + width[some, None] * NODES
        parts.append(function(angle.ravel()).reshape(-1, *angle.shape) @ WEIGHTS)
    return width * np.concatenate(parts, axis=-1)


def _sum(parts):
    """Sum of each row, rounded once."""
    return np.array([math.fsum(row) for row in parts])


def _grid(turn):
    """Ends of the first panels: two samples wide, and at limit positions and kinks."""
    even = np.linspace(0.0, turn.period, round(turn.period / np.diff(turn.angle).max() / 2) + 1)
    return np.unique(np.concatenate([even, turn.limits % turn.period, turn.kinks]))

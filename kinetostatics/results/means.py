"""Means over the period: integrals that know where their functions jump, have kinks or change their sign."""

import warnings
from typing import NamedTuple

import numpy as np

from ..errors import ConditionWarning, ParameterError
from ..machine.loads import TURN
from ..mechanics import jamming
from ..numbers.elementary import UNIT
from .extremes import extrema, warning
from .turn import USABLE, require_single

ORDER = 8
"""Nodes of a panel of the quadrature."""
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
SUMMED = 64
"""Roundings, at most, that a value of a panel meets on its way into the sum of all."""
FLOOR = 1e-14
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
        floor = FLOOR * turn.at.at(turn.angle[turn.usable]).largest_torque_term
        (mean,), (error,) = _means_of_absolute(lambda angle: [_torque(turn, angle)], turn, floor)
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
        What all rounding errors of the values and of their sum make at most: the mean of the values' proven bounds.
    quadrature : float
        About what the mean differs by from that of the function between the nodes.
    """

    rounding: float
    quadrature: float


def mean_absolute_torque_errors(solution):
    """Errors of `mean_absolute_torque`, N m.

    Raises
    ------
    NotGivenError
        As for `Solution.error_bound`.
    """
    turn = closed_turn(solution, "mean torque")
    floor = FLOOR * turn.at.at(turn.angle[turn.usable]).largest_torque_term

    def torque_and_bound(angle):
        at = turn.at.at(turn.clear(angle))
        return [at.balancing_torque, at.error_bound("balancing_torque")]

    (mean, bound), (wrong, _) = _means_of_absolute(torque_and_bound, turn, floor)
    return MeanErrors(float(bound + SUMMED * UNIT * mean), float(wrong))


def _torque(turn, angle):
    return turn.at.at(turn.clear(angle)).balancing_torque


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
    floor = FLOOR * at.largest_torque_term
    (mean,), _ = means(lambda angle: turn.at.at(turn.clear(angle)).balancing_torque[None], turn, floor)
    return TURN * float(mean) * (-1.0 if np.any(np.asarray(at.crank_speed) < 0) else 1.0)


def closed_turn(solution, owner):
    """Turn of a single design that closes all round, and does not jam."""
    require_single(solution, owner, "balancing_torque")
    turn = solution.sampled
    if turn.gaps:
        where = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g}" for start, stop in turn.gaps)
        raise ParameterError(f"{owner}: {solution.mechanism.name} does not close for crank angles {where} deg")
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
    nodes, weights = (part / 2 for part in np.polynomial.legendre.leggauss(ORDER))
    edges = np.unique(np.concatenate([_grid(turn), edges]))
    floor = np.reshape(floor, (-1, 1))
    profile = np.fmin(turn.condition, USABLE) * (turn.limits.size > 0)
    noise = np.abs(function(edges)).max(axis=-1, keepdims=True) * UNIT * profile

    def integrals(start, width):
        parts = []
        for some in np.array_split(np.arange(start.size), 1 + start.size * ORDER // LARGEST):
            angle = start[some, None] + width[some, None] * (0.5 + nodes)
            parts.append(function(angle.ravel()).reshape(-1, *angle.shape) @ weights)
        return width * np.concatenate(parts, axis=-1)

    start, width = edges[:-1], np.diff(edges)
    whole, total, size, wrong, room = integrals(start, width), 0.0, 0.0, 0.0, WORK
    while start.size:
        left, right = SPLIT * width, (1.0 - SPLIT) * width
        both = integrals(np.concatenate([start, start + left]), np.concatenate([left, right]))
        both = both.reshape(-1, 2, start.size)
        error = np.abs(both.sum(axis=1) - whole)
        room -= 2 * start.size
        largest = (size + np.abs(both).sum(axis=(1, 2)))[:, None]
        rounding = np.array([np.interp(start, turn.angle, row) for row in noise])
        rough = (error > width * (floor + rounding) + 1e-16 * largest) & (error > CLOSE * largest / start.size)
        rough = rough.any(axis=0) & (left > SMALLEST * turn.period) & (room >= 0)
        total = total + both[..., ~rough].sum(axis=(1, 2))
        size = size + np.abs(both[..., ~rough]).sum(axis=(1, 2))
        wrong = wrong + error[:, ~rough].sum(axis=-1)
        start = np.concatenate([start[rough], start[rough] + left[rough]])
        width, whole = np.concatenate([left[rough], right[rough]]), both[..., rough].reshape(both.shape[0], -1)
    return total / turn.period, wrong / turn.period


def _grid(turn):
    even = np.linspace(0.0, turn.period, turn.panels + 1)
    return np.unique(np.concatenate([even, turn.limits % turn.period, turn.kinks]))


def _means_of_absolute(functions, turn, floor):
    """Means of the absolute values of functions of the crank angle, and about how much they may be wrong.

    ``functions(angle)`` gives a row for each; of the first, whose rounding is `floor`, the sign changes.
    """
    from scipy.optimize import elementwise

    def first(angle):
        return functions(angle)[0]

    grid = _grid(turn)
    samples = first(grid)
    change = np.flatnonzero(samples[:-1] * samples[1:] < 0)
    zeros = elementwise.find_root(first, (grid[change], grid[change + 1])).x if change.size else []
    return means(lambda angle: np.abs(functions(angle)), turn, floor, zeros)

"""Means over the period: integrals of series on pieces between the kinks, jumps and sign changes of functions."""

import math
import warnings
from typing import NamedTuple

import numpy as np

from ..engines.error_bounds import SAFE
from ..errors import ConditionWarning, ParameterError
from ..machine.loads import TURN
from ..mechanics import jamming
from ..numbers.arithmetic import UNIT_ROUNDOFF
from .extremes import extrema, warning
from .limit_positions import MAX_CONDITION, require_single
from .piecewise import Pieces

SPLIT_TOLERANCE = 1e-14
"""Error of the integral over a piece, relative to the whole and divided by the pieces, at which it is resolved."""
WARNING_ERROR = 1e-9
"""Relative error of a mean above which a warning follows."""
ROUNDINGS = 4
"""Largest number of roundings of a value in a mean, besides the sum of its piece. They are weight, product with its
width, sum of all pieces (rounded once), quotient by the period."""
TERM_ROUNDING = 1e-14
"""Rounding of a sum relative to its largest term."""
ZERO_MEAN = 1e-12
"""Mean, relative to that of the magnitude, that counts as 0."""


def mean_absolute_torque(solution):
    """Integral mean of the absolute balancing torque over the period of the solution, N m.

    The integral uses Chebyshev series between changes of sign. Pieces are halved until the series are exact to
    rounding, which locates jumps and kinks. Load functions without `kinks` are sampled at the `resolution` of the
    solution; a narrower pulse may be missed.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    JammingError
        Friction jams somewhere in the turn.

    Warns
    -----
    ConditionWarning
        The torque grows without bound at a limit position, so the mean is infinite. Values without a correct digit do
        not count. Or the load is too uneven for full accuracy.
    """
    turn = closed_turn(solution, "mean torque")
    peaks = extrema(solution, "balancing_torque")
    words = [warning(solution, [peaks])]
    mean = np.inf
    if not np.isinf(peaks.value).any():
        mean, error, floor, _ = _mean_of_absolute_torque(turn)
        if error > WARNING_ERROR * mean + floor:
            words.append(f"mean torque: it is accurate only to {error:.2g} N m of {mean:.6g}: the load is uneven")
    for text in filter(None, words):
        warnings.warn(text, ConditionWarning, stacklevel=2)
    return mean


class MeanErrors(NamedTuple):
    """Errors of a mean.

    Attributes
    ----------
    rounding : float
        Proven bound on the rounding error: difference from the same sum of points and pieces in exact
        arithmetic.
    quadrature : float
        Estimate of the difference of the exact sum from the integral mean.
    """

    rounding: float
    quadrature: float


def mean_absolute_torque_errors(solution):
    """`MeanErrors` of `mean_absolute_torque`, N m; both infinite if the mean is infinite.

    Raises
    ------
    NotGivenError
        As for `Solution.error_bound`.
    """
    turn = closed_turn(solution, "mean torque")
    if np.isinf(extrema(solution, "balancing_torque").value).any():
        return MeanErrors(np.inf, np.inf)
    mean, error, _, pieces = _mean_of_absolute_torque(turn)

    bounds = turn.at.moved_to(turn.clear(pieces.angle.ravel())).error_bound("balancing_torque")
    bound = math.fsum(pieces.piece_integrals(bounds.reshape(pieces.angle.shape))) / turn.period  # also of the magnitude
    return MeanErrors(SAFE * (bound + (pieces.count + ROUNDINGS) * UNIT_ROUNDOFF * mean), error)


def _mean_of_absolute_torque(turn):
    """Mean, estimate of its error, rounding of the values, and pieces of the sum."""

    def torque(angle):
        return turn.at.moved_to(turn.clear(angle)).balancing_torque[None]

    floor = TERM_ROUNDING * turn.at.moved_to(turn.angle[turn.usable]).largest_torque_term
    _, (error,), pieces, values = means(torque, turn, floor)
    place, piece = pieces.zeros(values[0, :, 1:-1])
    parts = Pieces(np.union1d(pieces.edges, pieces.angle_at(piece, place)), pieces.count)
    sizes = np.abs(torque(parts.angle.ravel())).reshape(parts.angle.shape)
    return math.fsum(parts.piece_integrals(sizes)) / turn.period, float(error), floor, parts


class DriveMeans(NamedTuple):
    """Means of the balancing torque over the period: `torque`, N m, its `power`, W, its `energy` per turn, J.

    The torque is the mean over the crank angle, the power the mean over time, energy from drive to loads is positive.
    """

    torque: float
    power: float
    energy: float


def drive_means(solution):
    """`DriveMeans` of a solution of one design; by Chebyshev series, as for `mean_absolute_torque`.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    JammingError
        Friction jams somewhere in the turn.

    Warns
    -----
    ConditionWarning
        The load is so uneven that fewer digits of the means are right.
    """
    turn = closed_turn(solution, "mean torque")
    at = turn.at.moved_to(turn.angle[turn.usable])
    floor, varies = TERM_ROUNDING * at.largest_torque_term, np.ndim(at.crank_speed) > 0

    def by_angle(angle):
        there = turn.at.moved_to(turn.clear(angle))
        time = 1.0 / np.abs(there.crank_speed) if varies else 1.0
        return np.array([there.balancing_torque, np.broadcast_to(time, angle.shape)])

    (torque, time), (error, _), pieces, values = means(by_angle, turn, [floor, 0.0])
    size = math.fsum(pieces.piece_integrals(np.abs(values[0, :, 1:-1]))) / turn.period
    if error > WARNING_ERROR * size + floor:
        text = f"mean torque: it is accurate only to {error:.2g} N m of {torque:.6g}: the load is uneven"
        warnings.warn(text, ConditionWarning, stacklevel=5)
    torque = 0.0 if abs(torque) <= ZERO_MEAN * size + floor else float(torque)
    energy = TURN * torque * (-1.0 if np.any(np.asarray(at.crank_sense) < 0.0) else 1.0)
    power = energy / (TURN * float(time)) if varies else torque * float(at.crank_speed)
    return DriveMeans(torque, power + 0.0, energy + 0.0)


def closed_turn(solution, owner):
    """`Turn` of a single design; an error if it does not close all round or jams."""
    require_single(solution, owner, "balancing_torque")
    turn = solution.sampled
    if turn.gaps:
        raise ParameterError(f"{owner}: {solution.mechanism.name} {turn.unclosed}")
    jamming.require_free(turn.even, owner)
    return turn


def means(function, turn, floor):
    """Means over the period of functions of the crank angle, estimates of their errors, pieces, and values on them.

    Parameters
    ----------
    function : function
        From crank angles (N,) to values (functions, N).
    turn : Turn
    floor : float or array (functions,)
        Rounding of the values.
    """

    def evaluate(angle, _=None):
        return function(angle.ravel()).reshape(-1, *angle.shape)

    first = evaluate(turn.pieces.check_angles)
    profile = np.fmin(turn.condition, MAX_CONDITION) * (turn.limits.size > 0)
    noise = np.abs(first).max(axis=(1, 2))[:, None] * UNIT_ROUNDOFF

    def unresolved(pieces, errors, values):
        width = 2.0 * pieces.half[:, 0]
        whole = np.abs(pieces.piece_integrals(values[..., 1:-1])).sum(axis=-1, keepdims=True)
        rounding = np.reshape(floor, (-1, 1)) + noise * np.interp(pieces.edges[:-1], turn.angle, profile)
        error = errors * width
        rough = (errors > rounding) & (error > 1e-16 * whole) & (error > SPLIT_TOLERANCE * whole / width.size)
        return rough.any(axis=0)

    pieces, values, _ = turn.pieces.resolved(first, evaluate, unresolved)
    total = np.array([math.fsum(row) for row in pieces.piece_integrals(values[..., 1:-1])])
    return total / turn.period, pieces.tails(values[..., 1:-1]) @ pieces.half[:, 0] / turn.period, pieces, values

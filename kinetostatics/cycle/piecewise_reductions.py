"""Reductions of a quantity of many designs from its values on pieces of the period, and derivatives of reductions.

For small changes of a design a reduction is a weighted sum of the values at the points. With the same weights the
derivatives of the values give the derivative of the reduction.
"""

from dataclasses import replace

import numpy as np

from .piecewise import rolled, rule
from .reductions import OVER_THE_ANGLE, PEAKS, combined_peaks, is_rough, signs

MAX_OUTPUT_ERROR = 1e-9
"""Default goal: largest error of an output relative to the largest value of its quantity."""
TYPICAL_UNCERTAIN_PIECES = 8
"""Pieces that typically share the error of an integral: one piece may cause this part of the goal."""
ERROR_FACTOR = 4.0
"""Error of a series relative to its last known terms; near a kink the terms left out decrease slowly."""


def averaged(pieces, output, values, vector=False):
    """Mean, rms or amplitude of a harmonic of each design, (designs,), and weights (pieces, points) of the values.

    Values of a `vector` are magnitudes, so "mean_absolute" is their mean.
    """
    kind, order = output.reduction, output.order
    weights = pieces.half * rule(pieces.count).weights / pieces.period
    if order is not None:
        wave = np.exp(1j * order * pieces.angle) * weights * (1.0 if order == 0 else 2.0)
        amplitude = pieces.sums((wave * values).sum(axis=1))
        found = np.abs(amplitude)
        towards = np.conj(amplitude) / np.where(found == 0.0, 1.0, found)
        return found, np.real(towards[pieces.owner, None] * wave)
    if kind == "rms":
        found = np.sqrt(pieces.sums((weights * values * values).sum(axis=1)))
        return found, weights * values / np.where(found == 0.0, 1.0, found)[pieces.owner, None]
    if kind == "mean_absolute" and not vector:
        weights = _weights_of_magnitudes(pieces, values) / pieces.period
    return pieces.sums((weights * values).sum(axis=1)), weights


def _weights_of_magnitudes(pieces, values):
    """Weights (pieces, points) with which values give the integral of their magnitude.

    The sign between two zeros is that of the integral between them: single values there may be 0 or rounding.
    """
    found = np.where(values < 0.0, -1.0, 1.0) * rule(pieces.count).weights
    series = pieces.series(values)
    changing = np.flatnonzero(np.abs(series[0]) < np.abs(series[1:]).sum(axis=0))
    place, piece = pieces.zeros(values[changing])
    place, piece = np.append(place, np.ones(changing.size)), np.append(changing[piece], changing)
    order = np.lexsort((place, piece))
    place, piece = place[order], piece[order]
    up_to = pieces.weights_up_to(place)
    between = up_to - np.where(np.diff(piece, prepend=-1) == 0, 1.0, 0.0)[:, None] * rolled(up_to.T, 1).T
    signs_between = np.sign((between * values[piece]).sum(axis=1))
    found[changing] = 0.0
    np.add.at(found, piece, signs_between[:, None] * between)
    return pieces.half * found


def gained(pieces, values):
    """Integral (pieces, points) over the crank angle, rad, from the start of the period, of values less their mean."""
    mean = pieces.sums(pieces.piece_integrals(values)) / pieces.period
    return pieces.integral_from_start(values - mean[pieces.owner, None])


def _peaks(pieces, reduction, values, vector):
    """Reduction (designs,) to a peak, for "largest_at" and "smallest_at" its crank angle, rad; and the peak's value."""
    low, high = values.min(axis=1), values.max(axis=1)
    middle, rise = 0.5 * (high + low), 0.5 * (high - low)
    line = middle[:, None] + rise[:, None] * rule(pieces.count).points
    values = np.where(pieces.can_split[:, None], values, line)  # too narrow: contains a jump
    heights, angles = [], []
    for sign in signs(reduction):
        height, piece, place = pieces.peaks(sign * values)
        heights.append(np.sqrt(np.maximum(sign * height, 0.0)) if vector else sign * height)
        angles.append(np.where(np.isnan(height), np.nan, np.mod(pieces.angle_at(piece, place), pieces.period)))
    if reduction in OVER_THE_ANGLE:
        return angles[0], heights[0]
    found = combined_peaks(reduction, heights)
    return found, found


def _errors_of_peaks(pieces, values, errors, sides, vector):
    """Error estimate (pieces,) of the peak of each piece, in the quantity's unit; 0 if it cannot have the extreme.

    `sides` contains 1.0 for the largest value, -1.0 for the smallest. Values of a `vector` are squared magnitudes.
    """
    series, found = pieces.series(values[:, 1:-1]), np.zeros(errors.shape)
    room = np.abs(series[1:]).sum(axis=0) + errors
    for sign in sides:
        top, own = (sign * values).max(axis=1), errors
        rival = sign * series[0] + room >= pieces.largest_of(top - errors)[pieces.owner]
        if vector:
            own = errors / np.sqrt(np.maximum(np.maximum(sign * top, errors), np.finfo(float).tiny))
        found = np.maximum(found, np.where(rival, own, 0.0))
    return found


def estimated(pieces, output, values, vector=False):
    """Numbers (designs,) of an `Output`, and a mask of those that are uncertain.

    `values` (pieces, points + 2) are at `Pieces.check_angles`: of a `vector` magnitudes, or their squares for a peak.
    """
    errors = np.where(pieces.can_split, ERROR_FACTOR * pieces.errors(values), 0.0)
    inner = values[:, 1:-1]
    if output.reduction in PEAKS:
        found, height = _peaks(pieces, output.reduction, inner, vector)
        error = pieces.largest_of(_errors_of_peaks(pieces, values, errors, signs(output.reduction), vector))
        sizes = np.sqrt(values) if vector else values
        size = pieces.largest_of(sizes.max(axis=1)) + pieces.largest_of(-sizes.min(axis=1))
        output = replace(output, reduction=output.reduction.removesuffix("_at"))
        return found, is_rough(output, height, error, lambda rough: size[rough])
    factor, size = 2.0 if output.order else 1.0, pieces.largest_of(np.abs(inner).max(axis=1))
    if output.reduction == "swing":
        energy, factor = gained(pieces, inner), 2.0 * pieces.period
        found = size = pieces.peaks(energy)[0] + pieces.peaks(-energy)[0]
    else:
        found, _ = averaged(pieces, output, inner, vector)
    error = factor * pieces.sums(2.0 * pieces.half[:, 0] * errors) / pieces.period
    return found, is_rough(output, found, error, lambda rough: size[rough])


def values_key(output, vectors):
    """Quantity of an output, and whether it is reduced by its square: a magnitude has a kink at 0, its square none."""
    return output.quantity, bool(vectors[output.quantity]) and output.reduction in PEAKS


def resolved(pieces, outputs, vectors, evaluate, goal=MAX_OUTPUT_ERROR):
    """Halve pieces until outputs reach the goal, within the limits of `Pieces.resolved`; values by `values_key`.

    Parameters
    ----------
    pieces : Pieces
    outputs : sequence of Output
    vectors : mapping of quantity to bool
        Whether the quantity is a vector.
    evaluate : function
        From crank angles (P, N), rad, and designs (P,) of pieces to values (P, N) by quantity, for a vector magnitudes.
    goal : float
        Largest error of an output relative to the largest value of its quantity.
    """
    sides: dict = {values_key(output, vectors): set() for output in outputs}
    integrals = {values_key(output, vectors) for output in outputs if output.reduction not in PEAKS}
    for output in outputs:
        sides[values_key(output, vectors)].update(signs(output.reduction) if output.reduction in PEAKS else ())

    def rows(angle, designs):
        found = evaluate(angle, designs)
        return np.array([found[name] ** 2 if squared else found[name] for name, squared in sides])

    def rough(pieces, errors, values):
        marked, share = np.zeros(len(pieces.half), dtype=bool), 2.0 * pieces.half[:, 0] / pieces.period
        for (row, asked), own, error in zip(sides.items(), values, ERROR_FACTOR * errors, strict=True):
            size = pieces.largest_of(np.abs(own).max(axis=1))[pieces.owner]
            if asked:
                found = _errors_of_peaks(pieces, own, error, asked, row[1])
                marked |= found > goal * (np.sqrt(size) if row[1] else size)
            if row in integrals:
                marked |= error * share > goal / TYPICAL_UNCERTAIN_PIECES * size
        return marked

    pieces, values, _ = pieces.resolved(rows(pieces.check_angles, pieces.owner), rows, rough)
    return pieces, dict(zip(sides, values, strict=True))

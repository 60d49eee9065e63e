"""Reductions of curves, with exact derivatives by the numbers of the design: formulas of `cycle.reductions`.

`Curve` has values evenly over the period, `PiecewiseCurve` on its pieces between kinks. A peak at a kink moves with the
design: f and its derivatives exist on both sides, and f' dphi + df is the same there, which gives the shift. The place
of a jump counts as fixed.
"""

from typing import Any, NamedTuple

import numpy as np

from ..cycle.peaks import REACH, THROUGH
from ..cycle.piecewise import highest, rule
from ..cycle.piecewise_reductions import averaged
from ..cycle.piecewise_reductions import gained as gained_on
from ..cycle.reductions import Output, gained

SECTORS = 72
"""Number of parts of the period with separate limits of their largest values, so that each competing peak counts."""
WIDER = 12
"""The same if each largest value is combined with each smallest one."""
SIDES = {"largest": (1.0,), "smallest": (-1.0,), "largest_absolute": (1.0, -1.0), "swing": (1.0, -1.0)}
"""Sides of a quantity or its integral whose peaks count, by reduction."""
_AROUND = np.arange(-REACH, REACH + 1)
_ORDERS = np.arange(2 * REACH + 1)
JUMP_TOLERANCE = 1e-6
"""Difference of the values on both sides of an edge, relative to the largest value, above which it is a jump."""
KINK_TOLERANCE = 1e-4
"""Largest change of slope between pieces, relative to the largest value over the period, that is no kink."""
ZERO_SQUARE = 1e-13
"""Square of a magnitude, relative to the largest, that is zero to rounding."""


def reduced(reduction, curve):
    """Value of a reduction, and its derivatives (n,), of a `Curve` or `PiecewiseCurve`."""
    if reduction not in SIDES and reduction != "range":
        return curve.averaged(reduction)
    sides = (1.0, -1.0) if reduction == "range" else SIDES[reduction]
    peaks = [(values[0], slopes[:, 0]) for values, slopes in (curve.tops(s, 1, reduction == "swing") for s in sides)]
    if reduction in ("swing", "range"):
        (high, above), (low, below) = peaks
        return high + low, above + below
    value, slopes = max(peaks, key=lambda pair: pair[0])
    return (-value, -slopes) if reduction == "smallest" else (value, slopes)


def bounded(reduction, curve):
    """Values (parts,) whose maximum is a reduction in `SIDES` ("smallest": its negative), and derivatives (n, parts).

    Each competing peak counts.
    """
    if reduction != "swing":
        parts = [curve.tops(side, SECTORS) for side in SIDES[reduction]]
        return np.concatenate([values for values, _ in parts]), np.concatenate([slopes for _, slopes in parts], axis=1)
    (high, above), (low, below) = (curve.tops(side, WIDER, energy=True) for side in SIDES[reduction])
    pairs = above[:, :, None] + below[:, None, :]
    return np.add.outer(high, low).ravel(), pairs.reshape(len(pairs), -1)


class Curve(NamedTuple):
    """Values (N,) of a quantity evenly over the period of some turns, and their derivatives (n, N)."""

    values: np.ndarray
    slopes: np.ndarray
    turns: int = 1

    def tops(self, side, sectors, energy=False):
        """Largest value, times a side, in each of some equal parts of the period (parts,), with derivatives (n, parts).

        The curve or its integral is meant. A peak between samples is the peak of the polynomial through its neighbours,
        if they fit a polynomial.
        """
        if energy:
            return Curve(self.turns * gained(self.values), self.turns * gained(self.slopes)).tops(side, sectors)
        values = side * self.values
        count = values.size
        length = next(length for length in range(-(-count // sectors), count + 1) if count % length == 0)
        highest = np.arange(0, count, length) + values.reshape(-1, length).argmax(axis=1)
        near = (highest[:, None] + _AROUND) % count
        samples = values[near]
        weights = _through_peaks(samples)
        return np.einsum("sw,sw->s", weights, samples), side * np.einsum("sw,ksw->ks", weights, self.slopes[:, near])

    def averaged(self, reduction):
        """Value of a mean or harmonic, and its derivatives (n,)."""
        values, count = self.values, self.values.size
        if reduction == "mean":
            return values.mean(), self.slopes @ np.full(count, 1.0 / count)
        if reduction == "mean_absolute":
            value, weights = _mean_absolute(values)
            return value, self.slopes @ weights
        if reduction == "rms":
            found = np.sqrt(np.mean(values * values))
            return found, self.slopes @ (values / (count * found) if found else np.zeros(count))
        order = self.turns * int(reduction.removeprefix("harmonic_"))
        wave = np.exp(2j * np.pi * order * np.arange(count) / count) * ((1.0 if order == 0 else 2.0) / count)
        amplitude = values @ wave
        value = abs(amplitude)
        return value, np.real(np.conj(amplitude) / (value or 1.0) * (self.slopes @ wave))


def size(values, slopes):
    """Magnitude of a vector, and its derivatives (n, ...), from those of its components (2, ...)."""
    found = np.hypot(*values)
    towards = values / np.maximum(found, np.finfo(float).tiny)
    return found, np.einsum("c...,kc...->k...", towards, slopes)


def _through_peaks(samples):
    """Weights (peaks, samples) of the samples around peaks in the heights; at need only of the middle one.

    That is the case if it is no peak, or the samples do not fit a polynomial, as at a jump.
    """
    bends = np.diff(samples, 2)[:, REACH - 2 : REACH + 1]
    peaks = np.flatnonzero((bends < 0).all(axis=1) & (samples[:, REACH - 1 : REACH + 2].argmax(axis=1) == 1))
    weights = np.tile((_AROUND == 0).astype(float), (len(samples), 1))
    series = samples[peaks] @ THROUGH.T
    first = series[:, 1:] * _ORDERS[1:]
    second = first[:, 1:] * _ORDERS[1:-1]
    place = parabola = 0.5 * (samples[peaks, REACH - 1] - samples[peaks, REACH + 1]) / bends[peaks, 1]
    with np.errstate(all="ignore"):
        for _ in range(3):
            powers = place[:, None] ** _ORDERS
            slope = np.einsum("pk,pk->p", first, powers[:, :-1])
            place = place - slope / np.einsum("pk,pk->p", second, powers[:, :-2])
        good = (abs(place) < 1.0) & (abs(place - parabola) <= 0.2)
    weights[peaks[good]] = place[good, None] ** _ORDERS @ THROUGH
    return weights


def _mean_absolute(values):
    """Mean magnitude: samples less the excess from kinks, for straight lines across the sign changes."""
    count = values.size
    sign, weights = np.where(values < 0.0, -1.0, 1.0), np.zeros(count)
    here = np.flatnonzero(sign != np.roll(sign, -1))
    there = (here + 1) % count
    before, after = abs(values[here]), abs(values[there])
    both = before + after
    excess = np.sum(before * after / both - both / 6.0)
    weights += sign
    np.add.at(weights, here, -sign[here] * ((after / both) ** 2 - 1.0 / 6.0))
    np.add.at(weights, there, -sign[there] * ((before / both) ** 2 - 1.0 / 6.0))
    return (abs(values).sum() - excess) / count, weights / count


class PiecewiseCurve(NamedTuple):
    """Values (P, points) of a quantity on the pieces of one design's period, and their derivatives (n, P, points).

    Values of a `vector` are magnitudes, whose squares are smooth.
    """

    values: np.ndarray
    slopes: np.ndarray
    pieces: Any
    vector: bool = False

    def averaged(self, reduction):
        """Value of a mean or harmonic, and its derivatives (n,)."""
        (found,), weights = averaged(self.pieces, Output("", reduction), self.values, self.vector)
        return found, np.tensordot(self.slopes, weights, 2)

    def tops(self, side, sectors, energy=False):
        """As `Curve.tops`; the energy is the integral of the curve less its mean."""
        pieces, square = self.pieces, self.vector and not energy
        values = self.values**2 if square else self.values
        slopes = 2.0 * self.values * self.slopes if square else self.slopes
        piece, place = self._summits(side * (gained_on(pieces, values) if energy else values), sectors)
        if energy:
            weights = self._weights_of_energy(piece, place)
            return side * np.tensordot(weights, values, 2), side * np.tensordot(slopes, weights, ([1, 2], [1, 2]))
        weights = pieces.weights_at(place)
        found = side * np.sum(weights * values[piece], axis=1)
        changes = side * np.einsum("npk,pk->np", slopes[:, piece], weights)
        for part in np.flatnonzero(np.abs(place) == 1.0):
            changes[:, part] += side * self._moved(values, slopes, piece[part], place[part])
        if square:
            height = np.sqrt(np.maximum(side * found, np.finfo(float).tiny))
            rises = np.where(height**2 > ZERO_SQUARE * values.max(), changes / (2.0 * height), 0.0)
            return side * height, rises  # a magnitude of 0 stays 0, to first order
        return found, changes

    def _summits(self, values, sectors):
        """Piece and place (sectors,) of the highest value in each sector of the period."""
        pieces = self.pieces
        height, piece, place = pieces.summits(values, np.flatnonzero(pieces.can_split))
        sector = pieces.angle_at(piece, place - np.copysign(1e-9, place)) * (sectors / pieces.period)
        border = np.linspace(0.0, pieces.period, sectors + 1)[1:-1]
        beside = np.searchsorted(pieces.edges, border, side="right") - 1
        there = (border - pieces.middle[beside]) / pieces.half[beside, 0]
        height = np.append(height, np.repeat(np.sum(pieces.weights_at(there) * values[beside], axis=1), 2))
        piece, place = np.append(piece, np.repeat(beside, 2)), np.append(place, np.repeat(there, 2))
        best = highest(height, np.append(sector.astype(int), np.arange(1, 2 * sectors - 1) // 2))
        return piece[best], place[best]

    def _weights_of_energy(self, piece, place):
        """Weights (K, P, points) of the values in that integral, at places of pieces."""
        pieces = self.pieces
        whole = pieces.half * rule(pieces.count).weights
        passed = np.arange(len(whole)) < piece[:, None]
        found = (passed - pieces.angle_at(piece, place)[:, None] / pieces.period)[..., None] * whole
        found[np.arange(piece.size), piece] += pieces.half[piece] * pieces.weights_up_to(place)
        return found

    def _moved(self, values, slopes, piece, end):
        """Derivatives of the value at a kink, at an end of a piece, from the shift of the kink, (n,)."""
        pieces = self.pieces
        later = piece if end < 0.0 else (piece + 1) % len(values)
        pair, ends = [later - 1, later], np.array([1.0, -1.0])
        weights, size = pieces.weights_at(ends), np.abs(values).max()
        heights = np.sum(weights * values[pair], axis=1)
        steepness = np.sum(rule(pieces.count).check[[-1, -2]] * values[pair], axis=1) / pieces.half[pair, 0]
        if (
            abs(np.diff(heights)[0]) > JUMP_TOLERANCE * size
            or abs(np.diff(steepness)[0]) < KINK_TOLERANCE * size / pieces.period
        ):
            return np.zeros(len(slopes))
        one, other = np.einsum("npk,pk->pn", slopes[:, pair], weights)
        return steepness[int(end < 0.0)] * (one - other) / np.diff(steepness)

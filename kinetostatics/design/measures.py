"""Reductions of curves with exact derivatives by the numbers of the design: formulas of `cycle.reductions`.

`Curve` has values evenly over the period, `PartedCurve` on its pieces between bends. There every reduction is, near a
design, a sum of the values at the nodes with weights: those of the polynomial at the peak, or of the integral. Where a
peak lies at a kink, which moves with the design, both sides of it tell how: f and its derivatives hold on both, so
f' dphi + df is the same. Where a curve jumps, the place of the jump is taken as it is.
"""

from typing import Any, NamedTuple

import numpy as np

from ..cycle.peaks import REACH, THROUGH
from ..cycle.pieces import NEWTON_STEPS, NODES, PLACES, SERIES, WEIGHTS
from ..cycle.reductions import gained

SECTORS = 72
"""Parts of the period whose largest values are limited one by one: where peaks compete, each counts."""
WIDER = 12
"""The same where each largest value is taken with each smallest."""
SIDES = {"largest": (1.0,), "smallest": (-1.0,), "largest_absolute": (1.0, -1.0), "swing": (1.0, -1.0)}
"""By reduction that is a largest value: which sides of a quantity, or its integral, its extreme is on."""
_AROUND = np.arange(-REACH, REACH + 1)
_ORDERS = np.arange(2 * REACH + 1)
POWERS = np.arange(NODES.size)
AT = PLACES[:, None] ** POWERS @ SERIES
"""Weights (places, nodes) of the values at the nodes in those at places on a piece."""
SLOPE = POWERS[1:] * np.array([[-1.0], [1.0]]) ** (POWERS[1:] - 1) @ SERIES[1:]
"""The same in the slopes at both ends of a piece, by the place from -1 to 1."""
GROWN = (PLACES[:, None] ** (POWERS + 1) - (-1.0) ** (POWERS + 1)) / (POWERS + 1) @ SERIES
"""The same in the integral from the beginning of a piece."""
LEVEL = 1e-4
"""Change of the slope from one piece to the next, by the largest value over the period, that is no kink."""


def reduced(reduction, curve):
    """Value of a reduction, and its derivatives (n,), of a `Curve` or `PartedCurve`."""
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
    """Values (parts,) whose largest is a reduction of `SIDES`, of "smallest" its negative, with derivatives (n, parts).

    Where peaks compete, each counts.
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

        Of the curve, or of its integral. A peak between samples is that of the polynomial through the samples around
        it, where they go together.
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


def size(values, slopes, turns=1) -> Curve:
    """Magnitude of a vector, from its components (2, N) and their derivatives (n, 2, N)."""
    found = np.hypot(*values)
    towards = values / np.maximum(found, np.finfo(float).tiny)
    return Curve(found, np.einsum("cn,kcn->kn", towards, slopes), turns)


def _through_peaks(samples):
    """Weights of the samples around peaks (peaks, samples) in their heights; of the middle one alone where need be.

    That is, where it is no peak, or the samples do not go together, as at a jump.
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
    """Mean magnitude: samples less what their kinks add, where the sign changes on a straight line between two."""
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


class PartedCurve(NamedTuple):
    """Values (P, 8) of a quantity at the nodes of pieces of the period, and their derivatives (n, P, 8).

    `pieces` are those of one design; `vector` tells a magnitude, whose square is smooth.
    """

    values: np.ndarray
    slopes: np.ndarray
    pieces: Any
    vector: bool = False

    def averaged(self, reduction):
        """Value of a mean or harmonic, and its derivatives (n,)."""
        width = self.pieces.width[0, :, None] / self.pieces.period
        if reduction == "rms":
            found = np.sqrt(np.sum(width * WEIGHTS * self.values**2))
            weights = width * WEIGHTS * self.values / (found or 1.0)
        elif reduction in ("mean", "mean_absolute"):
            weights = width * (WEIGHTS if reduction == "mean" or self.vector else _signed(self.values))
            found = np.sum(weights * self.values)
        else:
            order = int(reduction.removeprefix("harmonic_"))
            angle = self.pieces.start[0, :, None] + self.pieces.width[0, :, None] * NODES
            wave = np.exp(1j * order * angle) * width * WEIGHTS * (1.0 if order == 0 else 2.0)
            amplitude = np.sum(wave * self.values)
            found = abs(amplitude)
            weights = np.real(np.conj(amplitude) / (found or 1.0) * wave)
        return found, np.tensordot(self.slopes, weights, 2)

    def tops(self, side, sectors, energy=False):
        """As `Curve.tops`; the energy is the integral of what the curve is above its mean."""
        square = self.vector and not energy
        values = self.values**2 if square else self.values
        slopes = 2.0 * self.values * self.slopes if square else self.slopes
        width = self.pieces.width[0, :, None]
        angle = self.pieces.start[0, :, None] + width * (0.5 + 0.5 * PLACES)
        if energy:
            parts = np.sum(width * WEIGHTS * self.values, axis=1, keepdims=True)
            inner = 0.5 * width * (self.values @ GROWN.T)
            heights = side * (np.cumsum(parts, axis=0) - parts + inner - angle / self.pieces.period * parts.sum())
        else:
            heights = side * (values @ AT.T)
        heights[self.pieces.width[0] == 0.0] = -np.inf
        sector = np.minimum((angle.ravel() / self.pieces.period * sectors).astype(int), sectors - 1)
        order, best = np.argsort(heights, axis=None, kind="stable"), np.zeros(sectors, dtype=int)
        best[sector[order]] = order
        piece, at = self._peaks_at(heights, side, energy, *np.divmod(best, PLACES.size))
        if energy:
            weights = np.stack([self._gain(*pair) for pair in zip(piece, at, strict=True)])
            return side * np.tensordot(weights, values, 2), side * np.tensordot(slopes, weights, ([1, 2], [1, 2]))
        weights = at[:, None] ** POWERS @ SERIES
        found = side * np.sum(weights * values[piece], axis=1)
        changes = side * np.einsum("npk,pk->np", slopes[:, piece], weights)
        for part in np.flatnonzero(np.abs(at) == 1.0):
            changes[:, part] += side * self._moved(values, slopes, piece[part], at[part])
        if square:
            height = np.sqrt(np.maximum(side * found, np.finfo(float).tiny))
            return side * height, changes / (2.0 * height)
        return found, changes

    def _peaks_at(self, heights, side, energy, piece, sample):
        """Piece and place (sectors,) of the peak at each sample; at the end of a piece the higher of both sides."""
        values = self.values**2 if self.vector and not energy else self.values
        mean = np.sum(self.pieces.width[0, :, None] * WEIGHTS * values) / self.pieces.period if energy else 0.0
        last, count = PLACES.size - 1, np.count_nonzero(self.pieces.width[0])
        step = np.where(sample == last, 1, np.where(sample == 0, -1, 0))
        beside, other = (piece + step) % count, np.where(step, last - sample, sample)

        def peak(piece, place, height):
            series = side * (SERIES @ values[piece].T)
            if energy:
                series[0] -= side * mean
                series = np.polynomial.polynomial.polyint(series) * (0.5 * self.pieces.width[0, piece])
            at = _peaks(series, place)
            return height + _at(series, at) - _at(series, place), at

        height, at = peak(piece, PLACES[sample], heights[piece, sample])
        higher, there = peak(beside, PLACES[other], heights[beside, other])
        return np.where(higher > height, beside, piece), np.where(higher > height, there, at)

    def _gain(self, piece, place):
        """Weights (P, nodes) of the values in that integral, at a place of a piece."""
        start, width = self.pieces.start[0], self.pieces.width[0]
        whole = width[:, None] * WEIGHTS
        found = -(start[piece] + width[piece] * (0.5 + 0.5 * place)) / self.pieces.period * whole
        found[:piece] += whole[:piece]
        found[piece] += 0.5 * width[piece] * ((place ** (POWERS + 1) - (-1.0) ** (POWERS + 1)) / (POWERS + 1) @ SERIES)
        return found

    def _moved(self, values, slopes, piece, end):
        """What the move of a kink at an end of a piece adds to the derivatives of the value there (n,)."""
        pieces = self.pieces
        count = int((pieces.width[0] > 0.0).sum())
        later = piece if end < 0.0 else (piece + 1) % count
        if not pieces.joined[0, later]:
            return np.zeros(len(slopes))
        earlier = (later - 1) % count
        sides = []
        for number, row in ((earlier, 1), (later, 0)):
            weights = AT[-1 if row else 0]
            rate = 2.0 / pieces.width[0, number] * (SLOPE[row] @ values[number])
            sides.append((rate, slopes[:, number] @ weights))
        (before, one), (after, other) = sides
        steep = np.abs(values).max() / pieces.period
        if abs(after - before) < LEVEL * steep:
            return np.zeros(len(slopes))
        return (after if end < 0.0 else before) * (one - other) / (after - before)


def _peaks(series, places):
    """Where polynomials (terms, parts) are highest around one of the places each."""
    step = PLACES[1] - PLACES[0]
    slope, bend = (np.polynomial.polynomial.polyder(series, order) for order in (1, 2))
    low, high, at = np.maximum(places - step, -1.0), np.minimum(places + step, 1.0), places
    for _ in range(NEWTON_STEPS):
        rise, curved = _at(slope, at), _at(bend, at)
        at = np.clip(at - np.divide(rise, curved, out=np.zeros_like(at), where=curved < 0.0), low, high)
    return np.where(_at(series, at) >= _at(series, places), at, places)


def _at(series, places):
    return np.polynomial.polynomial.polyval(places, series, tensor=False)


def _signed(values):
    """Weights (P, nodes) of values in the means of their magnitudes on pieces."""
    found = np.where(values < 0.0, -1.0, 1.0) * WEIGHTS
    for piece in np.flatnonzero((values.min(axis=1) < 0.0) & (values.max(axis=1) > 0.0)):
        roots = np.polynomial.polynomial.polyroots(SERIES @ values[piece])
        inner = np.sort(roots.real[(np.abs(roots.imag) < 1e-9) & (np.abs(roots.real) < 1.0)])
        edges = np.concatenate([[-1.0], inner, [1.0]])
        middle = 0.5 * (edges[1:] + edges[:-1])
        signs = np.sign((middle[:, None] ** POWERS @ SERIES) @ values[piece])
        grown = np.diff(edges[:, None] ** (POWERS + 1), axis=0) / (POWERS + 1)
        found[piece] = 0.5 * signs @ grown @ SERIES
    return found

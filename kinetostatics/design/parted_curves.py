"""Curves of a quantity on pieces of the period between bends, as sweeps have them, with derivatives by the design.

Every reduction is, near a design, a sum of the values at the nodes of the pieces with weights: those of the polynomial
at the peak, or of the integral. Where a peak lies at a kink, which moves with the design, both sides of it tell how:
f and its derivatives hold on both, so f' dphi + df is the same. Where a curve jumps, the place of the jump is taken as
it is.
"""

from typing import Any, NamedTuple

import numpy as np

from ..results.means import NODES, WEIGHTS
from ..results.pieces import NEWTON_STEPS, PLACES, SERIES
from .measures import SECTORS, SIDES, WIDER

POWERS = np.arange(NODES.size)
AT = PLACES[:, None] ** POWERS @ SERIES
"""Weights (places, nodes) of the values at the nodes in those at places on a piece."""
SLOPE = POWERS[1:] * np.array([[-1.0], [1.0]]) ** (POWERS[1:] - 1) @ SERIES[1:]
"""The same in the slopes at both ends of a piece, by the place from -1 to 1."""
GROWN = (PLACES[:, None] ** (POWERS + 1) - (-1.0) ** (POWERS + 1)) / (POWERS + 1) @ SERIES
"""The same in the integral from the beginning of a piece."""
LEVEL = 1e-4
"""Change of the slope from one piece to the next, by the largest value over the period, that is no kink."""


class PartedCurve(NamedTuple):
    """Values (P, 8) of a quantity at the nodes of pieces of the period, and their derivatives (n, P, 8).

    `pieces` are those of one design; `vector` tells a magnitude, whose square is smooth.
    """

    values: np.ndarray
    slopes: np.ndarray
    pieces: Any
    vector: bool = False

    def reduced(self, reduction, turns=1):
        """Value of a reduction, and its derivatives (n,)."""
        if reduction in ("swing", "range"):
            (high, above), (low, below) = (self._top(side, reduction == "swing") for side in (1.0, -1.0))
            return high + low, above + below
        if reduction == "largest_absolute":
            return max((self._top(side) for side in (1.0, -1.0)), key=lambda pair: pair[0])
        if reduction in SIDES:
            side = SIDES[reduction][0]
            value, slopes = self._top(side)
            return side * value, side * slopes
        width = self.pieces.width[0, :, None] / self.pieces.period
        if reduction == "rms":
            found = np.sqrt(np.sum(width * WEIGHTS * self.values**2))
            return found, self._summed(width * WEIGHTS * self.values / (found or 1.0))
        if reduction in ("mean", "mean_absolute"):
            weights = width * (WEIGHTS if reduction == "mean" or self.vector else _signed(self.values))
            return np.sum(weights * self.values), self._summed(weights)
        order = int(reduction.removeprefix("harmonic_"))
        wave = np.exp(1j * order * self._angle) * width * WEIGHTS * (1.0 if order == 0 else 2.0)
        amplitude = np.sum(wave * self.values)
        return abs(amplitude), self._summed(np.real(np.conj(amplitude) / (abs(amplitude) or 1.0) * wave))

    def bounded(self, reduction, turns=1):
        """Values (parts,) whose largest is a reduction of `SIDES`, of "smallest" its negative, with derivatives."""
        if reduction != "swing":
            parts = [self._tops(side, SECTORS) for side in SIDES[reduction]]
            return np.concatenate([values for values, _ in parts]), np.concatenate([rows for _, rows in parts], axis=1)
        (high, above), (low, below) = (self._tops(side, WIDER, True) for side in SIDES[reduction])
        pairs = above[:, :, None] + below[:, None, :]
        return np.add.outer(high, low).ravel(), pairs.reshape(len(pairs), -1)

    @property
    def _angle(self):
        return self.pieces.start[0, :, None] + self.pieces.width[0, :, None] * NODES

    def _summed(self, weights):
        return np.tensordot(self.slopes, weights, 2)

    def _top(self, side, energy=False):
        values, slopes = self._tops(side, 1, energy)
        return values[0], slopes[:, 0]

    def _tops(self, side, sectors, energy=False):
        """Largest value, times a side, in each of some equal parts of the period (parts,), with derivatives (n, parts).

        Of the curve, or of the integral of what it is above its mean.
        """
        square = self.vector and not energy
        values = self.values**2 if square else self.values
        slopes = 2.0 * self.values * self.slopes if square else self.slopes
        angle = self.pieces.start[0, :, None] + self.pieces.width[0, :, None] * (0.5 + 0.5 * PLACES)
        heights = side * (self._gained(angle) if energy else values @ AT.T)
        heights[self.pieces.width[0] == 0.0] = -np.inf
        sector = np.minimum((angle.ravel() / self.pieces.period * sectors).astype(int), sectors - 1)
        order, best = np.argsort(heights, axis=None, kind="stable"), np.zeros(sectors, dtype=int)
        best[sector[order]] = order
        piece, place = np.divmod(best, PLACES.size)
        series = side * (SERIES @ values[piece].T)
        if energy:
            series[0] -= side * np.sum(self.pieces.width[0, :, None] * WEIGHTS * values) / self.pieces.period
            at = _peaks(np.polynomial.polynomial.polyint(series), PLACES[place])
            weights = np.stack([self._gain(*pair) for pair in zip(piece, at, strict=True)])
            return side * np.tensordot(weights, values, 2), side * np.tensordot(slopes, weights, ([1, 2], [1, 2]))
        at = _peaks(series, PLACES[place])
        weights = at[:, None] ** POWERS @ SERIES
        found = side * np.sum(weights * values[piece], axis=1)
        changes = side * np.einsum("npk,pk->np", slopes[:, piece], weights)
        for part in np.flatnonzero(np.abs(at) == 1.0):
            changes[:, part] += side * self._moved(values, slopes, piece[part], at[part])
        if square:
            height = np.sqrt(np.maximum(side * found, np.finfo(float).tiny))
            return side * height, changes / (2.0 * height)
        return found, changes

    def _gained(self, angle):
        """Integral of what the curve is above its mean, at places of all pieces (P, places)."""
        width = self.pieces.width[0, :, None]
        parts = np.sum(width * WEIGHTS * self.values, axis=1, keepdims=True)
        inner = 0.5 * width * (self.values @ GROWN.T)
        return np.cumsum(parts, axis=0) - parts + inner - angle / self.pieces.period * parts.sum()

    def _gain(self, piece, place):
        """Weights (P, nodes) of the values in that integral, at a place of a piece."""
        start, width = self.pieces.start[0], self.pieces.width[0]
        whole = width[:, None] * WEIGHTS
        found = -(start[piece] + width[piece] * (0.5 + 0.5 * place)) / self.pieces.period * whole
        found[:piece] += whole[:piece]
        found[piece] += 0.5 * width[piece] * (_grown(place) @ SERIES)
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


def _grown(place):
    """Integrals of the powers from the beginning of a piece to a place, or places (..., 1)."""
    return (place ** (POWERS + 1) - (-1.0) ** (POWERS + 1)) / (POWERS + 1)


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

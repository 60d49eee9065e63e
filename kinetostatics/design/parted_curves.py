"""Curves of a quantity on pieces of the period between bends, as sweeps have them, with derivatives by the design.

Every reduction is, near a design, a sum of the values at the nodes of the pieces with weights: those of the polynomial
at the peak, or of the integral. Where a peak lies at a kink, which moves with the design, both sides of it tell how:
f and its derivatives hold on both, so f' dphi + df is the same. Where a curve jumps, the place of the jump is taken as
it is.
"""

from typing import Any, NamedTuple

import numpy as np

from ..results.means import NODES, WEIGHTS
from ..results.pieces import PLACES, SERIES
from .measures import SECTORS, SIDES, WIDER

POWERS = np.arange(NODES.size)
AT = PLACES[:, None] ** POWERS @ SERIES
"""Weights (places, nodes) of the values at the nodes in those at places on a piece."""
SLOPE = POWERS[1:] * np.array([[-1.0], [1.0]]) ** (POWERS[1:] - 1) @ SERIES[1:]
"""The same in the slopes at both ends of a piece, by the place from -1 to 1."""
GROWN = (PLACES[:, None] ** (POWERS + 1) - (-1.0) ** (POWERS + 1)) / (POWERS + 1) @ SERIES
"""The same in the integral from the beginning of a piece."""
LEVEL = 1e-6
"""Step at a bend, by the largest value, below which a curve goes on there."""


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
        values = self.values**2 if self.vector and not energy else self.values
        slopes = 2.0 * self.values * self.slopes if self.vector and not energy else self.slopes
        real = self.pieces.width[0] > 0.0
        rows = self._rows(energy)
        heights = side * (rows @ values.ravel() if energy else (values @ AT.T).ravel())
        start, width = self.pieces.start[0, :, None], self.pieces.width[0, :, None]
        angle = (start + width * (0.5 + 0.5 * PLACES)).ravel()
        heights[~np.repeat(real, PLACES.size)] = -np.inf
        sector = np.minimum((angle / self.pieces.period * sectors).astype(int), sectors - 1)
        order, best = np.argsort(heights, kind="stable"), np.zeros(sectors, dtype=int)
        best[sector[order]] = order
        found, changes = heights[best], np.zeros((len(self.slopes), sectors))
        for part, (piece, place) in enumerate(zip(*np.divmod(best, PLACES.size), strict=True)):
            if energy:
                changes[:, part] = side * np.tensordot(slopes, rows[best[part]].reshape(values.shape), 2)
                continue
            weights, exact = _at_peak(side * values[piece], place)
            found[part] = side * weights @ values[piece]
            changes[:, part] = side * (slopes[:, piece] @ weights)
            if exact in (-1.0, 1.0):
                changes[:, part] += side * self._moved(values, slopes, piece, exact)
        if self.vector and not energy:
            height = np.sqrt(np.maximum(side * found, np.finfo(float).tiny))
            return side * height, changes / (2.0 * height)
        return found, changes

    def _rows(self, energy):
        """Weights (places, nodes) of all values in the integral of what is above the mean, at places of all pieces."""
        if not energy:
            return None
        width = self.pieces.width[0]
        whole = width[:, None] * WEIGHTS
        count = width.size
        before = np.tril(np.ones((count, count)), -1)[:, None, :, None] * whole
        own = np.eye(count)[:, None, :, None] * (0.5 * width[:, None, None, None] * GROWN[None, :, None, :])
        passed = self.pieces.start[0, :, None] + width[:, None] * (0.5 + 0.5 * PLACES)
        mean = passed[..., None, None] / self.pieces.period * whole
        return (before + own - mean).reshape(count * PLACES.size, -1)

    def _moved(self, values, slopes, piece, end):
        """What the move of a kink at an end of a piece adds to the derivatives of the value there (n,)."""
        pieces = self.pieces
        count = int((pieces.width[0] > 0.0).sum())
        later = piece if end < 0.0 else (piece + 1) % count
        if pieces.joined[0, later]:
            return np.zeros(len(slopes))
        earlier = (later - 1) % count
        sides = []
        for number, row in ((earlier, 1), (later, 0)):
            weights = AT[-1 if row else 0]
            rate = 2.0 / pieces.width[0, number] * (SLOPE[row] @ values[number])
            sides.append((weights @ values[number], rate, slopes[:, number] @ weights))
        (low, before, one), (high, after, other) = sides
        steep = np.abs(values).max() / pieces.period
        if abs(high - low) > LEVEL * np.abs(values).max() or abs(after - before) < LEVEL * steep:
            return np.zeros(len(slopes))
        return (after if end < 0.0 else before) * (one - other) / (after - before)


def _at_peak(values, place):
    """Weights of values at the nodes in the highest value around one of the places, and where that is."""
    series = SERIES @ values
    first, second = np.polynomial.polynomial.polyder(series), np.polynomial.polynomial.polyder(series, 2)
    at = start = PLACES[place]
    low, high = max(at - (PLACES[1] - PLACES[0]), -1.0), min(at + (PLACES[1] - PLACES[0]), 1.0)
    for _ in range(6):
        bend = np.polynomial.polynomial.polyval(at, second)
        if bend >= 0.0:
            break
        at = min(max(at - np.polynomial.polynomial.polyval(at, first) / bend, low), high)
    weights = at**POWERS @ SERIES
    return (weights, at) if weights @ values >= AT[place] @ values else (AT[place], start)


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

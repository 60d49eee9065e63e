"""Functions of the crank angle as Chebyshev series on pieces between their kinks.

The points are Chebyshev points of the first kind: none is at an end of a piece, so jumps there do no harm
(Trefethen, *Approximation Theory and Approximation Practice*, chapters 2, 8 and 19).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..numbers.lazy import cached_property

TAIL = 2e-14
"""Size of the last coefficients of a series, relative to its largest value, that is rounding."""
MAX_HALVINGS = 60
MAX_PIECES = 20_000
DENSE = 8
"""Places for each point of a series at which extremes are sought."""
MIN_WIDTH = 1e-13
"""Width of a piece, relative to the period, below which it is not split: it contains a jump."""


class Rule(NamedTuple):
    """Matrices from values at the points in [-1, 1] to series, integrals from -1, slopes, and values at dense places.

    `vander` goes from series to values.
    """

    points: np.ndarray
    vander: np.ndarray
    series: np.ndarray
    integral: np.ndarray
    weights: np.ndarray
    slope: np.ndarray
    dense: np.ndarray
    places: np.ndarray


@lru_cache
def rule(count) -> Rule:
    points = chebyshev.chebpts1(count)
    vander = chebyshev.chebvander(points, count - 1)
    series = vander.T * (np.where(np.arange(count) == 0, 1.0, 2.0) / count)[:, None]
    whole = chebyshev.chebint(series, lbnd=-1)
    places = np.cos(np.linspace(np.pi, 0.0, DENSE * count))
    return Rule(
        points,
        vander,
        series,
        chebyshev.chebvander(points, count) @ whole,
        whole.sum(axis=0),
        chebyshev.chebvander(points, count - 2) @ chebyshev.chebder(series),
        chebyshev.chebvander(places, count - 1) @ series,
        places,
    )


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of a turn between edges, each with `count` points; values are (pieces, points)."""

    edges: np.ndarray
    count: int

    @cached_property
    def half(self):
        return 0.5 * np.diff(self.edges)[:, None]

    @cached_property
    def angle(self):
        """Crank angles of all points."""
        return 0.5 * (self.edges[:-1] + self.edges[1:])[:, None] + self.half * rule(self.count).points

    def integral(self, values):
        """Integral from the start of its piece to each point."""
        return self.half * (values @ rule(self.count).integral.T)

    def whole(self, values):
        """Integral over each piece."""
        return self.half[:, 0] * (values @ rule(self.count).weights)

    def integrated(self, values):
        """Integral from the first edge to each point."""
        before = np.concatenate([[0.0], np.cumsum(self.whole(values))[:-1]])
        return self.integral(values) + before[:, None]

    def total(self, values):
        """Integral over all pieces."""
        return float(self.whole(values).sum())

    def series(self, values):
        """Chebyshev coefficients (points, pieces)."""
        return rule(self.count).series @ values.T

    def smoothed(self, values):
        """Values of the lower half of each series; the upper half of difference quotients is noise."""
        count = self.count // 2
        return (rule(self.count).vander[:, :count] @ self.series(values)[:count]).T

    def with_ends(self, values):
        """Values at the start, the points and the end of each piece, (pieces, points + 2)."""
        series = self.series(values)
        starts = ((-1.0) ** np.arange(self.count)) @ series
        return np.column_stack([starts, values, series.sum(axis=0)])

    def tail(self, values):
        """Size of the last coefficients of each piece, relative to the largest value of all."""
        size = np.abs(values).max()
        return np.abs(self.series(values)[-3:]).max(axis=0) / size if size else np.zeros(len(values))

    def evaluate(self, series, angle):
        """Values of a series at crank angles between the first and the last edge."""
        shape, angle = angle.shape, angle.ravel()
        piece = np.clip(np.searchsorted(self.edges, angle, side="right") - 1, 0, len(self.half) - 1)
        place = (angle - 0.5 * (self.edges[piece] + self.edges[piece + 1])) / self.half[piece, 0]
        return chebyshev.chebval(place, series[:, piece], tensor=False).reshape(shape)

    def largest(self, values):
        """Largest value of a function given at the points, and its crank angle."""
        dense = values @ rule(self.count).dense.T
        piece, at = np.unravel_index(np.argmax(dense), dense.shape)
        place = rule(self.count).places[at]
        series = rule(self.count).series @ values[piece]
        slope, bend = chebyshev.chebder(series), chebyshev.chebder(series, 2)
        for _ in range(4):
            curved = chebyshev.chebval(place, bend)
            if curved < 0.0:
                place = np.clip(place - chebyshev.chebval(place, slope) / curved, -1.0, 1.0)
        angle = 0.5 * (self.edges[piece] + self.edges[piece + 1]) + self.half[piece, 0] * place
        return float(chebyshev.chebval(place, series)), float(angle)

    def peak(self, values):
        """Value of largest size of a function given at the points, with its sign."""
        return max(self.largest(values)[0], -self.largest(-values)[0], key=abs)

    def split(self, marked):
        """Pieces, those in the mask `marked` halved."""
        middle = 0.5 * (self.edges[:-1] + self.edges[1:])[marked]
        return Pieces(np.sort(np.concatenate([self.edges, middle])), self.count)

    @property
    def can_split(self):
        """Mask of the pieces that are wide enough to be halved."""
        return 2.0 * self.half[:, 0] > MIN_WIDTH * (self.edges[-1] - self.edges[0])

"""Functions of the crank angle as Chebyshev series on pieces between their kinks.

The points are Chebyshev points of the first kind: none is at an end of a piece, so jumps there do no harm
(Trefethen, *Approximation Theory and Approximation Practice*, chapters 2, 8 and 19). `resolved` halves pieces until the
last coefficients are rounding, as chebfun does (Aurentz and Trefethen, *ACM Trans. Math. Softw.* 43, 2017).
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..machine.loads import TURN
from ..numbers.lazy import cached_property

POINTS = 24
"""Points of a piece."""
POINTS_BY_EDGES = ((400, 8), (60, 12), (20, 16))
"""The same where there are more edges than a number."""
TAIL = 2e-14
"""Size of the last coefficients of a series, relative to its largest value, that is rounding."""
MAX_HALVINGS = 60
MAX_PIECES = 20_000
MAX_UNRESOLVED = 100
"""Unresolved pieces of a turn, besides those at first, above which a function is rough and they are not halved."""
DENSE = 8
"""Places for each point of a series at which extremes are sought."""
MIN_WIDTH = 1e-13
"""Width of a piece, relative to the period, below which it is not split: it contains a jump."""
JUMP_OFFSET = 2.0**-44
"""Distance of the crank angles on both sides of a jump from it, rad."""
NEWTON_STEPS = 5
CHOPPED = 2e-3
"""Size of coefficients at the end of a series, relative to the rounding of values, that are set to 0 for its slope."""


class Rule(NamedTuple):
    """Matrices from values at the points in [-1, 1] to series, integrals from -1, and more.

    `vander` and `many` go from series to values at the points and the dense places, `derived` to the series of slopes;
    `dense` and `ends` from values at the points to those at the dense places and both ends, `end_slopes` to slopes.
    """

    points: np.ndarray
    vander: np.ndarray
    series: np.ndarray
    integral: np.ndarray
    weights: np.ndarray
    places: np.ndarray
    derived: np.ndarray
    many: np.ndarray
    dense: np.ndarray
    ends: np.ndarray
    end_slopes: np.ndarray


@lru_cache
def rule(count) -> Rule:
    points = chebyshev.chebpts1(count)
    vander = chebyshev.chebvander(points, count - 1)
    series = vander.T * (np.where(np.arange(count) == 0, 1.0, 2.0) / count)[:, None]
    whole = chebyshev.chebint(series, lbnd=-1)
    places = np.cos(np.linspace(np.pi, 0.0, DENSE * count))
    many = chebyshev.chebvander(places, count - 1)
    derived = np.vstack([chebyshev.chebder(np.eye(count)), np.zeros(count)])
    return Rule(
        points,
        vander,
        series,
        chebyshev.chebvander(points, count) @ whole,
        _weights(count),
        places,
        derived,
        many,
        many @ series,
        many[[0, -1]] @ series,
        many[[0, -1]] @ derived @ series,
    )


def _weights(count):
    """Weights of the points in the integral over [-1, 1] (Fejer's first rule), right to the last digit."""
    angle = (np.arange(count, dtype=np.longdouble) + 0.5) * (4 * np.arctan(np.longdouble(1)) / count)
    order = np.arange(1, count // 2 + 1, dtype=np.longdouble)[:, None]
    return ((2 - 4 * np.sum(np.cos(2 * order * angle) / (4 * order**2 - 1), axis=0)) / count).astype(float)


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of a turn between edges, each with `count` points; values are (pieces, points)."""

    edges: np.ndarray
    count: int

    @property
    def period(self):
        return self.edges[-1] - self.edges[0]

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

    def tails(self, values):
        """Size of the last coefficients of each piece, (..., pieces)."""
        return np.abs(values @ rule(self.count).series[-3:].T).max(axis=-1)

    def tail(self, values):
        """The same relative to the largest value of all."""
        size = np.abs(values).max()
        return self.tails(values) / size if size else np.zeros(len(values))

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
        return 2.0 * self.half[:, 0] > MIN_WIDTH * self.period

    @property
    def checked(self):
        """Crank angles (pieces, points + 2) of all points, and beside both ends, where series are checked."""
        ends = self.edges[:-1] + JUMP_OFFSET, self.edges[1:] - JUMP_OFFSET
        return np.column_stack([ends[0], self.angle, ends[1]])

    def resolved(self, values, evaluate, rough):
        """Pieces halved until the series of several functions are exact to rounding; these, values, and rough pieces.

        Parameters
        ----------
        values : array (functions, pieces, points + 2)
            At the angles `checked`.
        evaluate : function
            From crank angles (pieces, points + 2) to values.
        rough : function
            From pieces, errors of their series (functions, pieces) and values to a mask of those to halve.
        """
        pieces, most = self, len(self.half) + MAX_UNRESOLVED * self.period / TURN
        for _ in range(MAX_HALVINGS):
            marked = rough(pieces, pieces.errors(values), values) & pieces.can_split
            if not marked.any() or marked.sum() > most:
                break
            pieces, values = pieces.replaced(pieces.split(marked), values, evaluate)
        return pieces, values, marked

    def errors(self, values):
        """Estimate of the error of each series: last coefficients, and misfit at both ends, (..., pieces)."""
        own, inner = rule(self.count), values[..., 1:-1]
        shift = JUMP_OFFSET / self.half * [1.0, -1.0]
        ends = inner @ own.ends.T + shift * (inner @ own.end_slopes.T)
        return np.fmax(self.tails(inner), np.abs(ends - values[..., [0, -1]]).max(axis=-1))

    def replaced(self, others, values, evaluate):
        """Other pieces with values; only those that differ are evaluated."""
        place = np.searchsorted(self.edges, others.edges[:-1])
        same = np.isin(others.edges, self.edges)
        same = same[:-1] & same[1:]
        same[same] = self.edges[place[same] + 1] == others.edges[1:][same]
        found = np.empty((len(values), len(same), self.count + 2))
        found[:, same] = values[:, place[same]]
        if not same.all():
            found[:, ~same] = evaluate(others.checked[~same])
        return others, found

    def turning(self, values, level):
        """Crank angles inside pieces at which a function turns, and whether it turns at the start of each piece.

        Parameters
        ----------
        values : array (1 or 2, pieces, points)
            A function, or the components of a vector, whose magnitude turns.
        level : array (pieces,)
            Range of values that is rounding.

        Returns
        -------
        angle, piece : array (K,)
        starts : array (pieces,) of bool
            Also where it is level before or after; the last piece is before the first.
        """
        series = rule(self.count).series @ np.swapaxes(values, 1, 2)
        large = np.maximum.accumulate(np.abs(series[:, ::-1]), axis=1)[:, ::-1] > CHOPPED * level
        series = self._derived(np.where(large, series, 0.0), 2)
        slopes = _slope_of_size if len(values) == 2 else _slope
        slope, bend = slopes(*(rule(self.count).many @ rows for rows in series))
        moves = (np.ptp(values, axis=2) > level).any(axis=0)
        inner = self._roots(slope, bend, moves, slopes, series)
        rises = np.where(moves, np.sign(slope[[0, -1]]), 0.0)
        return *inner, np.roll(rises[1], 1) * rises[0] <= 0.0

    def zeros(self, values):
        """Crank angles at which a function (pieces, points) changes its sign inside pieces."""
        series = self._derived(self.series(values)[None], 1)
        value, slope = (rule(self.count).many @ rows[0] for rows in series)
        return self._roots(value, slope, np.ones(len(values), bool), lambda *parts: [part[0] for part in parts], series)

    def _derived(self, series, order):
        """Series and those of their derivatives up to an order; places from -1 to 1."""
        found = [series]
        for _ in range(order):
            found.append(rule(self.count).derived @ found[-1])
        return found

    def _roots(self, dense, slope, asked, function, series):
        """Crank angles and pieces of the roots of functions given at the dense places (places, pieces), by Newton.

        `function` returns value and slope from the values of all series; two roots between dense places are found too.
        """
        places, order = rule(self.count).places, np.arange(self.count)[:, None]

        def evaluate(piece, place):
            waves = np.cos(order * np.arccos(place))
            return function(*(np.einsum("ckn,kn->cn", rows[:, :, piece], waves) for rows in series))

        changes = np.signbit(dense[:-1]) != np.signbit(dense[1:])
        at, piece = np.nonzero(changes & asked)
        low, high = places[at], places[at + 1]
        at, other = np.nonzero((np.signbit(slope[:-1]) != np.signbit(slope[1:])) & ~changes & asked)
        if at.size:
            share = slope[at, other] / (slope[at, other] - slope[at + 1, other])
            vertex = places[at] + share * (places[at + 1] - places[at])
            twice = np.signbit(evaluate(other, vertex)[0]) != np.signbit(dense[at, other])
            piece = np.concatenate([piece, other[twice], other[twice]])
            low = np.concatenate([low, places[at][twice], vertex[twice]])
            high = np.concatenate([high, vertex[twice], places[at + 1][twice]])
        if not piece.size:
            return low, piece
        one, two = evaluate(piece, low)[0], evaluate(piece, high)[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            place = np.clip(np.nan_to_num(low + (high - low) * one / (one - two)), low, high)
            for _ in range(NEWTON_STEPS):
                value, rate = evaluate(piece, place)
                step = place - value / rate
                place = np.clip(np.where(np.isfinite(step), step, place), low, high)
        return 0.5 * (self.edges[piece] + self.edges[piece + 1]) + self.half[piece, 0] * place, piece


def point_count(edges):
    """Points of the pieces between edges: fewer where there are many."""
    return next((points for most, points in POINTS_BY_EDGES if len(edges) > most), POINTS)


def _slope(value, first, second):
    return first[0], second[0]


def _slope_of_size(value, first, second):
    """Slope of half the square of a vector, and its slope."""
    return np.sum(value * first, axis=0), np.sum(first * first + value * second, axis=0)


def edges_between(breaks, width):
    """Edges at breaks, and evenly between those more than `width` apart."""
    gaps = np.diff(breaks)
    parts = np.maximum(np.ceil(gaps / width - 1e-9), 1.0).astype(int)
    place = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.append(np.repeat(breaks[:-1], parts) + np.repeat(gaps / parts, parts) * place, breaks[-1])

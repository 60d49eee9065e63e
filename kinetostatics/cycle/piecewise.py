"""Functions of the crank angle as Chebyshev series on pieces between their kinks.

The points are Chebyshev points of the first kind. None is at an end of a piece, so jumps there do no harm (Trefethen,
*Approximation Theory and Approximation Practice*, chapters 2, 8 and 19). `resolved` halves pieces until the last
coefficients are rounding, as chebfun does (Aurentz and Trefethen, *ACM Trans. Math. Softw.* 43, 2017).
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
"""Pairs (limit, points): with more edges than the limit, each piece has this number of points."""
TAIL_TERMS = 3
"""Number of last coefficients of a series that estimate its error."""
TAIL = 2e-14
"""Size of the last coefficients of a series, relative to its largest value, that counts as rounding."""
MAX_HALVINGS = 60
MAX_PIECES = 20_000
MAX_UNRESOLVED = 100
"""Largest number of unresolved pieces of a turn besides the first ones; of a function with more, none is halved."""
DENSE = 8
"""Number of places per point of a series in the search for extremes."""
MIN_WIDTH = 1e-13
"""Smallest width of a piece that is halved, relative to the period; a narrower rough piece contains a jump."""
JUMP_OFFSET = 2.0**-44
"""Distance from a jump of the crank angles on its two sides, rad."""
NEWTON_STEPS, NEWTON_TOLERANCE = 5, 1e-9
"""Largest number of Newton steps, and change of a place in [-1, 1] below which a further step changes only rounding."""
CHOPPED = 2e-3
"""Last coefficients below this share of the rounding of the values are set to 0 before a series is differentiated."""
EQUAL_PEAKS = 1e-12
"""Relative difference of two peaks that counts as rounding."""


def signed_peak(low, high):
    """The smallest or the largest value, whichever has the larger size; the largest if both are equal to rounding."""
    return low if -low > (1.0 + EQUAL_PEAKS) * abs(high) else high


class Rule(NamedTuple):
    """Chebyshev points in [-1, 1], weights of the integral over it, dense places, and matrices.

    `series` turns values at the points into Chebyshev coefficients, and `integral` into integrals from -1 to each
    point. `check` turns them into the last coefficients, and values and slopes at both ends. Coefficients become values
    at the points by `vander`, at the places by `many`; `derived` differentiates, `risen` integrates from -1.
    """

    points: np.ndarray
    vander: np.ndarray
    series: np.ndarray
    integral: np.ndarray
    weights: np.ndarray
    places: np.ndarray
    derived: np.ndarray
    risen: np.ndarray
    many: np.ndarray
    check: np.ndarray


@lru_cache
def rule(count) -> Rule:
    """The `Rule` of a number of points, computed once."""
    points = chebyshev.chebpts1(count)
    vander = chebyshev.chebvander(points, count - 1)
    series = vander.T * (np.where(np.arange(count) == 0, 1.0, 2.0) / count)[:, None]
    risen = chebyshev.chebint(np.eye(count), lbnd=-1)
    derived = np.vstack([chebyshev.chebder(np.eye(count)), np.zeros(count)])
    places = np.cos(np.linspace(np.pi, 0.0, DENSE * count))
    many = chebyshev.chebvander(places, count - 1)
    check = np.vstack([series[-TAIL_TERMS:], many[[0, -1]] @ series, many[[0, -1]] @ derived @ series])
    whole = chebyshev.chebvander(points, count) @ risen @ series
    return Rule(points, vander, series, whole, _weights(count), places, derived, risen, many, check)


def _weights(count):
    """Weights of the points in the integral over [-1, 1] (Fejer's first rule), right to the last digit."""
    angle = (np.arange(count, dtype=np.longdouble) + 0.5) * (4 * np.arctan(np.longdouble(1)) / count)
    order = np.arange(1, count // 2 + 1, dtype=np.longdouble)[:, None]
    return ((2 - 4 * np.sum(np.cos(2 * order * angle) / (4 * order**2 - 1), axis=0)) / count).astype(float)


@dataclass(frozen=True, eq=False)
class Pieces:
    """Pieces of a period between edges, each with `count` points, of one design or of several.

    Values are (..., pieces, points). Edges rise over the period; for the next design they begin at its start again.
    """

    edges: np.ndarray
    count: int

    @classmethod
    def between(cls, breaks, period, width, count=None):
        """Pieces of designs between their breaks (designs, K), padded with NaN; no piece is wider than `width`."""
        ends = np.broadcast_to([0.0, period], (len(breaks), 2))
        breaks = np.sort(np.column_stack([ends[:, 0], breaks]))
        kept = (np.diff(breaks, prepend=-1.0) > 4.0 * JUMP_OFFSET) & (breaks < period - 4.0 * JUMP_OFFSET)
        breaks, kept = np.column_stack([breaks, ends[:, 1]]), np.column_stack([kept, ends[:, 1] > 0.0])
        edges = edges_between(breaks[kept], width)
        return cls(edges, count or point_count(edges[: -(-edges.size // len(breaks))]))

    @cached_property
    def _inside(self):
        """Whether a piece, not the end of a design, follows each edge except the last."""
        return np.diff(self.edges) >= 0.0

    @cached_property
    def low(self):
        """Start of each piece."""
        return self.edges[:-1][self._inside]

    @cached_property
    def high(self):
        """End of each piece."""
        return self.edges[1:][self._inside]

    @cached_property
    def owner(self):
        """Design of each piece."""
        return np.cumsum(~self._inside)[self._inside]

    @cached_property
    def firsts(self):
        """First piece of each design."""
        return np.flatnonzero(np.diff(self.owner, prepend=-1))

    @property
    def period(self):
        return self.edges[-1] - self.edges[0]

    @cached_property
    def half(self):
        return 0.5 * (self.high - self.low)[:, None]

    @cached_property
    def middle(self):
        return 0.5 * (self.low + self.high)

    @cached_property
    def angle(self):
        """Crank angles of all points."""
        return self.middle[:, None] + self.half * rule(self.count).points

    def angle_at(self, piece, place):
        """Crank angles at places from -1 to 1 of pieces."""
        return self.middle[piece] + self.half[piece, 0] * place

    def of_designs(self, designs):
        """Pieces of the designs in a mask, and the mask of these among all pieces."""
        own = np.append(np.cumsum(~self._inside, dtype=int) - ~self._inside, self.owner[-1])  # design of each edge
        return Pieces(self.edges[designs[own]], self.count), designs[self.owner]

    def sums(self, parts):
        """Sum over the pieces of each design, (..., designs)."""
        return np.add.reduceat(parts, self.firsts, axis=-1)

    def largest_of(self, parts):
        """Largest of the pieces of each design, (..., designs)."""
        return np.maximum.reduceat(parts, self.firsts, axis=-1)

    def integral_in_piece(self, values):
        """Integral from the start of its piece to each point."""
        return self.half * matrix_product(values, rule(self.count).integral)

    def piece_integrals(self, values):
        """Integral over each piece."""
        return self.half[:, 0] * matrix_product(values, rule(self.count).weights[None])[..., 0]

    def before(self, parts):
        """For each piece: the sum of `parts` over the earlier pieces of its design."""
        number = np.arange(len(parts)) - self.firsts[self.owner]
        rows = np.zeros((self.firsts.size, number.max() + 2))
        rows[self.owner, number + 1] = parts
        return rows.cumsum(axis=1)[self.owner, number]

    def integral_from_start(self, values):
        """Integral from the start of the period to each point."""
        return self.integral_in_piece(values) + self.before(self.piece_integrals(values))[:, None]

    def whole_integral(self, values):
        """Integral over all pieces."""
        return float(self.piece_integrals(values).sum())

    def series(self, values):
        """Chebyshev coefficients (points, pieces)."""
        return matrix_product(values, rule(self.count).series).T

    def smoothed(self, values):
        """Values without the upper half of the coefficients, which is noise where values are difference quotients."""
        count = self.count // 2
        return (rule(self.count).vander[:, :count] @ self.series(values)[:count]).T

    def with_ends(self, values):
        """Values at the start, the points and the end of each piece, (pieces, points + 2)."""
        series = self.series(values)
        starts = ((-1.0) ** np.arange(self.count)) @ series
        return np.column_stack([starts, values, series.sum(axis=0)])

    def tails(self, values):
        """Size of the last coefficients of each piece, (..., pieces)."""
        return np.abs(matrix_product(values, rule(self.count).series[-TAIL_TERMS:])).max(axis=-1)

    def tail(self, values):
        """Size of the last coefficients of each piece, relative to the largest value of all pieces."""
        size = np.abs(values).max()
        return self.tails(values) / size if size else np.zeros(len(values))

    def evaluate(self, series, angle):
        """Values of a series at crank angles between the first and the last edge."""
        shape, angle = angle.shape, angle.ravel()
        piece = np.clip(np.searchsorted(self.edges, angle, side="right") - 1, 0, len(self.half) - 1)
        place = (angle - self.middle[piece]) / self.half[piece, 0]
        return chebyshev.chebval(place, series[:, piece], tensor=False).reshape(shape)

    def weights_at(self, place):
        """Weights (K, points) of the values at the points of a piece, for interpolation at places from -1 to 1."""
        return chebyshev_values(self.count, place).T @ rule(self.count).series

    def weights_up_to(self, place):
        """Weights for the integrals from -1 to places."""
        own = rule(self.count)
        return matrix_product(chebyshev.chebvander(place, self.count), (own.risen @ own.series).T)

    def summits(self, values, pieces):
        """Heights, pieces and places of the turning points and both ends of some pieces."""
        series = self.series(values[pieces])
        place, own = self._zeros(matrix_product(series.T, rule(self.count).derived).T)
        place, own = (
            np.append(np.repeat([-1.0, 1.0], len(pieces)), place),
            np.append(np.tile(np.arange(len(pieces)), 2), own),
        )
        return np.einsum("np,np->p", series[:, own], chebyshev_values(self.count, place)), pieces[own], place

    def peaks(self, values):
        """Highest value of each design, its piece, and its place there, each (designs,); NaN if a value is NaN.

        A series cannot exceed the sum of the sizes of its terms; only pieces that may exceed all points are examined.
        """
        series, known = self.series(values), self.largest_of(values.max(axis=1))
        most = series[0] + np.abs(series[1:]).sum(axis=0)
        height, piece, place = self.summits(values, np.flatnonzero(most >= known[self.owner]))
        best = highest(height, self.owner[piece])
        design = self.owner[piece[best]]
        found, pieces = np.full((2, known.size), np.nan), np.zeros(known.size, dtype=int)
        found[:, design], pieces[design] = (height[best], place[best]), piece[best]
        return found[0], pieces, found[1]

    def largest(self, values):
        """Largest value of a function of one design given at the points, and its crank angle."""
        height, piece, place = self.peaks(values)
        return float(height[0]), float(self.angle_at(piece, place)[0])

    def peak(self, values):
        """Value of largest size of a function given at the points, with its sign."""
        return signed_peak(-self.largest(-values)[0], self.largest(values)[0])

    def split(self, marked):
        """Pieces, with those in the mask `marked` halved."""
        place = np.flatnonzero(self._inside)[marked] + 1
        return Pieces(np.insert(self.edges, place, self.middle[marked]), self.count)

    @property
    def can_split(self):
        """Mask of the pieces that are wide enough to be halved."""
        return 2.0 * self.half[:, 0] > MIN_WIDTH * self.period

    @property
    def check_angles(self):
        """Crank angles (pieces, points + 2) at which series are checked: just inside both ends, and at all points."""
        return np.column_stack([self.low + JUMP_OFFSET, self.angle, self.high - JUMP_OFFSET])

    def resolved(self, values, evaluate, rough):
        """Halve pieces until series are accurate; return pieces, their values, and a mask of those still to be halved.

        Parameters
        ----------
        values : array (functions, pieces, points + 2)
            At the angles `check_angles`.
        evaluate : function
            From crank angles (P, points + 2) and the designs (P,) of these pieces to values.
        rough : function
            From pieces, errors of their series (functions, pieces) and values to a mask of the pieces to halve.
        """
        pieces, errors = self, self.errors(values)
        most = self.sums(np.ones(len(self.half), int)) + MAX_UNRESOLVED * self.period / TURN
        for halvings in range(MAX_HALVINGS + 1):
            unresolved = rough(pieces, errors, values) & pieces.can_split
            marked = unresolved & (pieces.sums(unresolved.astype(int)) <= most)[pieces.owner]
            if halvings == MAX_HALVINGS or not marked.any():
                break
            parts = 1 + marked
            new, pieces = np.repeat(marked, parts), pieces.split(marked)
            values, errors = np.repeat(values, parts, axis=1), np.repeat(errors, parts, axis=1)
            values[:, new] = evaluate(pieces.check_angles[new], pieces.owner[new])
            errors[:, new] = _errors(values[:, new], pieces.half[new], self.count)
        return pieces, values, unresolved

    def errors(self, values):
        """Estimate of the error of each series: last coefficients, and misfit at both ends, (..., pieces)."""
        return _errors(values, self.half, self.count)

    def turning(self, values, rounding):
        """Crank angles inside pieces at which a function turns, and whether it turns at the start of each piece.

        Parameters
        ----------
        values : array (1 or 2, pieces, points)
            A function, or the components of a vector, whose magnitude turns.
        rounding : array (pieces,)
            Range of values that counts as rounding.

        Returns
        -------
        angle, piece : array (K,)
        starts : array (pieces,) of bool
            Whether it turns at a piece's start, or is constant in it or in the one before (for the first, the last).
        """
        series = rule(self.count).series @ np.swapaxes(values, 1, 2)
        large = np.maximum.accumulate(np.abs(series[:, ::-1]), axis=1)[:, ::-1] > CHOPPED * rounding
        series = [np.where(large, series, 0.0)]
        series += [rule(self.count).derived @ series[0]]
        series += [rule(self.count).derived @ series[1]]
        slopes = _slope_of_size if len(values) == 2 else _slope
        slope, bend = slopes(*(rule(self.count).many @ rows for rows in series))
        moves = (np.ptp(values, axis=2) > rounding).any(axis=0)
        place, piece = self._roots(slope, bend, moves, slopes, series)
        rises = np.where(moves, np.sign(slope[[0, -1]]), 0.0)
        return self.angle_at(piece, place), piece, rolled(rises[1], 1) * rises[0] <= 0.0

    def zeros(self, values):
        """Places from -1 to 1, and their pieces, at which a function (pieces, points) changes its sign."""
        return self._zeros(self.series(values))

    def _zeros(self, series):
        series = [series[None], matrix_product(series.T, rule(self.count).derived).T[None]]
        value, slope = (matrix_product(rows[0].T, rule(self.count).many).T for rows in series)
        everywhere = np.ones(value.shape[1], bool)
        return self._roots(value, slope, everywhere, lambda *parts: [part[0] for part in parts], series)

    def _roots(self, dense, slope, asked, function, series):
        """Places and pieces of the roots of functions given at the dense places (places, pieces), by Newton.

        `function` turns the values of all series into value and slope. Where the slope changes its sign, two roots
        between neighbouring dense places are found too.
        """
        places = rule(self.count).places

        def evaluate(piece, place):
            own = chebyshev_values(self.count, place)
            return function(*(np.einsum("ckn,kn->cn", rows[:, :, piece], own) for rows in series))

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
            moving = np.ones(place.size, dtype=bool)  # a root must not depend on other roots
            for _ in range(NEWTON_STEPS):
                (value, rate), last = evaluate(piece, place), place
                step = place - value / rate
                place = np.where(moving & np.isfinite(step), np.clip(step, low, high), place)
                moving &= np.abs(place - last) >= NEWTON_TOLERANCE
                if not moving.any():
                    break
        return place, piece


def matrix_product(values, matrix):
    """Values (..., N) times a matrix (M, N); by BLAS the rounding of a row would depend on other rows."""
    return np.einsum("...n,mn->...m", values, matrix)


def rolled(values, step):
    """Values rotated along the last axis; `np.roll` takes five times as long on a few."""
    return np.concatenate([values[..., -step:], values[..., :-step]], axis=-1)


def highest(height, group):
    """Index of the highest value in each group of values."""
    order = np.lexsort((height, group))
    return order[np.flatnonzero(np.diff(group[order], append=np.max(group, initial=0) + 1))]


def chebyshev_values(count, place):
    """Values (count, K) of the Chebyshev polynomials at places in [-1, 1]; those outside by rounding are clipped."""
    return np.cos(np.arange(count)[:, None] * np.arccos(np.clip(place, -1.0, 1.0)))


def _errors(values, half, count):
    found = matrix_product(values[..., 1:-1], rule(count).check)
    shift = JUMP_OFFSET / half * [1.0, -1.0]
    misfit = found[..., TAIL_TERMS:-2] + shift * found[..., -2:] - values[..., [0, -1]]
    return np.fmax(np.abs(found[..., :TAIL_TERMS]).max(axis=-1), np.abs(misfit).max(axis=-1))


def point_count(edges):
    """Points of the pieces between edges: fewer if there are many."""
    return next((points for most, points in POINTS_BY_EDGES if len(edges) > most), POINTS)


def _slope(value, first, second):
    return first[0], second[0]


def _slope_of_size(value, first, second):
    """Slope of half the square of a vector, and its slope."""
    return np.sum(value * first, axis=0), np.sum(first * first + value * second, axis=0)


def edges_between(breaks, width):
    """Breaks, with equally spaced edges between them where they are farther apart than `width`."""
    gaps = np.diff(breaks)
    parts = np.maximum(np.ceil(gaps / width - 1e-9), 1.0).astype(int)
    place = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.append(np.repeat(breaks[:-1], parts) + np.repeat(gaps / parts, parts) * place, breaks[-1])

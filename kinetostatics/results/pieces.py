"""Reductions over a turn on which loads bend or jump, of many designs: by polynomials between the bends.

The turn is parted where anything bends, for each design where it does, and evenly besides. On every piece a quantity is
smooth, so few values tell all of it: its peaks, also those at bends, and its integrals. No value is taken at a bend, so
it does not matter on which side of it rounding would put that. What a piece does not tell is told of it by its series,
and by what its neighbours have where they join; `refining` halves such pieces.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..machine.loads import TURN
from .means import NODES, WEIGHTS
from .reductions import OVER_THE_ANGLE, PEAKS, is_rough

STEP = 0.25
PLACES = np.arange(-1.0, 1.0 + STEP / 2, STEP)
"""Places on a piece, from -1 to 1, between which peaks are sought."""
SERIES = np.linalg.inv(np.polynomial.polynomial.polyvander(2.0 * NODES - 1.0, NODES.size - 1))
"""Coefficients of the polynomial over these places from values at the nodes."""
_LEGENDRE = np.polynomial.legendre.legvander(2.0 * NODES - 1.0, NODES.size - 1)
LAST = (((2.0 * np.arange(NODES.size) + 1.0) * WEIGHTS[:, None] * _LEGENDRE)[:, -4:]).T
"""The last four coefficients of the same polynomial by Legendre's, from values at the nodes."""
SLOWEST = 0.1
"""Least share of the last terms that those left out are taken to be: what is smooth may hide what is not."""
AHEAD = 4.0
"""How many times as much as the first of them all of them may be, at a kink, where they hardly decrease."""
APPROACHES = 6
"""Steps of Newton's method to a peak or zero that is known to a quarter of half a piece."""
NARROW = 1e-12
"""Piece, rad, that is none: its ends are one place, found twice, and what jumps there may do so between them."""
NARROWEST = 1e-9
"""Piece, rad, on which what changes jumps: its values are those at the nodes."""


class Pieces(NamedTuple):
    """The period of designs in pieces.

    Attributes
    ----------
    start, width : array (designs, P)
        Where each piece begins, and how wide it is, rad; empty ones come last.
    joined : array (designs, P) of bool
        Whether nothing jumps where a piece begins, so that values go on there from the piece before, or the last.
    period : float
    """

    start: Any
    width: Any
    joined: Any
    period: float

    @classmethod
    def of(cls, bends, period, angles, order=0, jumps=True):
        """Pieces of designs, parted at bends and evenly.

        Parameters
        ----------
        bends : array (designs, K)
            Crank angles, NaN where a design has fewer.
        period : float
        angles : int
            Crank angles over the period that are to do where nothing bends.
        order : int
            Highest order of a harmonic of the crank angle that is asked for.
        jumps : bool or array (1 or designs, K) of bool
            Whether quantities may jump at these bends, or go on with a kink.
        """
        count = max(round(period / TURN) * 2 * order, -(-angles // NODES.size))
        even = np.broadcast_to(np.linspace(0.0, period, count + 1), (len(bends), count + 1))
        edges = np.column_stack([even, np.where(np.isnan(bends), 0.0, bends)])
        bent = np.column_stack([np.zeros(even.shape, dtype=int), ~np.isnan(bends) & jumps])
        rising = edges.argsort(axis=1, kind="stable")
        edges, bent = (np.take_along_axis(part, rising, axis=1) for part in (edges, bent))
        width = np.diff(edges)
        widest = width.argmax(axis=1)[:, None]
        inside = np.take_along_axis(edges[:, :-1] + 0.5 * width, widest, axis=1)
        real = width >= NARROW
        last = np.cumsum(bent, axis=1)
        before = np.maximum.accumulate(np.where(real, np.arange(1, width.shape[1] + 1), 0), axis=1)  # ends of pieces
        before = np.column_stack([np.zeros(len(bends), dtype=int), before])
        passed = np.take_along_axis(last - bent, before, axis=1)  # bends before the end of the piece before
        wrapped = last[:, -1:] - passed[:, -1:]
        joined = last[:, :-1] == np.where(before[:, :-1] > 0, passed[:, :-1], -wrapped)
        first = (~real).argsort(axis=1, kind="stable")
        parts = np.where(real, edges[:, :-1], inside), np.where(real, width, 0.0), joined
        start, width, joined = (np.take_along_axis(part, first, axis=1) for part in parts)
        return cls(start, width, joined, period)

    def some(self, designs):
        """Those of some designs."""
        return Pieces(self.start[designs], self.width[designs], self.joined[designs], self.period)

    @property
    def angle(self):
        """Crank angles (designs, N) to take values at."""
        return (self.start[..., None] + self.width[..., None] * NODES).reshape(len(self.start), -1)

    def estimated(self, output, values, vector=False):
        """Numbers (designs,) of an `Output` from values (designs, N), and whether these do not tell them."""
        values = self._by_node(values)
        if output.reduction in PEAKS:
            found, height = self._peaks(output.reduction, values, vector)
            error, size = (
                self._of_peaks(values, signs(output.reduction), vector).max(axis=1),
                np.ptp(values, axis=(0, 2)),
            )
            told = replace(output, reduction=output.reduction.removesuffix("_at"))
            return found, is_rough(told, height, error, lambda rough: size[rough])
        swing = output.reduction == "swing"
        found = self._swing(values) if swing else self._mean(output, values, vector)
        size = found if swing else np.abs(values).max(axis=(0, 2))
        error = self._of_integrals(values).sum(axis=1) * (2.0 * self.period if swing else 2.0 if output.order else 1.0)
        return found, is_rough(output, found, error, lambda rough: size[rough])

    def of_peaks(self, values, signs, vector):
        """About how wrong each piece (designs, P) may make the highest values, and the lowest, if -1.0 is a sign.

        Zero where neither may lie. What is the magnitude of a vector has corners where the vector is zero, but its
        square has none.
        """
        return self._of_peaks(self._by_node(values), signs, vector)

    def of_integrals(self, values):
        """About how wrong each piece (designs, P) may make the mean."""
        return self._of_integrals(self._by_node(values))

    def _of_peaks(self, values, signs, vector):
        values = values * values if vector else values
        series, doubt = self._series(values), self._doubts(values)
        samples = np.stack([_at(series, place) for place in PLACES])
        room = doubt + STEP**2 / 8.0 * sum(power * (power - 1) * np.abs(row) for power, row in enumerate(series))
        found = np.zeros(doubt.shape)
        for sign in signs:
            top = (sign * samples).max(axis=0)
            rival = top + room >= (top - doubt).max(axis=1, keepdims=True)
            found = np.maximum(found, np.where(rival, _rooted(sign * top, doubt) if vector else doubt, 0.0))
        return found

    def _of_integrals(self, values):
        return self._doubts(values) * self.width / self.period

    def _by_node(self, values):
        return np.moveaxis(values.reshape(*self.start.shape, NODES.size), -1, 0)

    def _series(self, values):
        """Coefficients of the polynomial of each piece over places from -1 to 1, from values at the nodes."""
        series = _series(values)
        narrow = (self.width > 0.0) & (self.width < NARROWEST)
        if narrow.any():
            low, high = values.min(axis=0)[narrow], values.max(axis=0)[narrow]
            series[:, narrow] = 0.0
            series[0, narrow], series[1, narrow] = 0.5 * (low + high), 0.5 * (high - low)
        return series

    def _doubts(self, values):
        """About how much the polynomial of each piece may be off (designs, P): by its series, and by its neighbours."""
        series = _series(values)
        even, odd = sum(series[2::2], series[0]), sum(series[3::2], series[1])
        first, last = even - odd, even + odd
        count = np.maximum((self.width > 0.0).sum(axis=1), 1)[:, None] - 1
        before = np.column_stack([np.take_along_axis(last, count, axis=1), last[:, :-1]])
        gap = np.where(self.joined & (self.width > 0.0), np.abs(first - before), 0.0)
        after = np.column_stack([gap[:, 1:], np.zeros(len(gap))])
        np.put_along_axis(after, count, gap[:, :1], axis=1)
        return np.where(self.width < NARROWEST, 0.0, np.maximum(_rest(values), np.maximum(gap, after)))

    def _peaks(self, reduction, values, vector):
        """Number of each design, and the height of the peak that it is of."""
        series = self._series(values * values if vector else values)
        heights, places = zip(*(self._end(series, sign, vector) for sign in signs(reduction)), strict=True)
        if reduction in OVER_THE_ANGLE:
            return places[0], heights[0]
        if reduction == "range":
            found = heights[0] - heights[1]
        else:
            found = np.maximum(heights[0], -heights[-1]) if reduction == "largest_absolute" else heights[0]
        return found, found

    def _end(self, series, sign, vector):
        """Largest or smallest value of each design, and where it is."""
        height, piece, place = _highest(sign * series)
        design = np.arange(len(piece))
        height, angle = sign * height, self.start[design, piece] + self.width[design, piece] * (0.5 + 0.5 * place)
        if vector:
            height = np.sqrt(np.maximum(height, 0.0))
        return height, np.where(np.isnan(height), np.nan, np.mod(angle, self.period))

    def _mean(self, output, values, vector):
        kind, order = output.reduction, output.order
        if order is not None:
            angle = order * (self.start + self.width * NODES[:, None, None])
            parts = (self._sum(values * wave(angle)) for wave in (np.cos, np.sin))
            return np.hypot(*parts) * (1.0 if order == 0 else 2.0)
        if kind == "rms":
            return np.sqrt(self._sum(values * values))
        return self._sum(values if kind == "mean" or vector else _sizes(values))

    def _sum(self, values):
        """Mean over the period of values at the nodes, or of one value for each piece; the same with empty pieces."""
        parts = _means(values) if len(values) == NODES.size else values[0]
        return np.cumsum(self.width * parts, axis=1)[:, -1] / self.period

    def _swing(self, values):
        """Range of the integral of values less their mean, J of a torque."""
        series = _series(values)
        series[0] -= self._sum(values)[:, None]
        inner = _integral(series) * (0.5 * self.width)
        gained = np.cumsum(_at(inner, 1.0) - _at(inner, -1.0), axis=1)
        inner[0] += np.column_stack([np.zeros(len(gained)), gained[:, :-1]]) - _at(inner, -1.0)
        return _highest(inner)[0] + _highest(-inner)[0]


def signs(reduction):
    """Signs with which a peak is the highest value."""
    return {"largest": (1.0,), "smallest": (-1.0,)}.get(reduction.removesuffix("_at"), (1.0, -1.0))


def _rooted(square, doubt):
    """By how much roots of squares may be wrong, which may be wrong by so much."""
    root = np.sqrt(np.maximum(np.maximum(square, doubt), np.finfo(float).tiny))
    return doubt / root


def _series(values):
    """Coefficients of the polynomial of each piece over places from -1 to 1, from values at the nodes (nodes, ...)."""
    return np.stack([sum(weight * row for weight, row in zip(weights, values, strict=True)) for weights in SERIES])


def _rest(values):
    """About how much polynomials may be off: the terms left out, as those that are there decrease.

    Two terms go together, one even and one odd: where what is not smooth lies so that one vanishes, the other does not.
    """
    first, second, third, fourth = (sum(w * row for w, row in zip(weights, values, strict=True)) for weights in LAST)
    before, last = np.hypot(first, second), np.hypot(third, fourth)
    with np.errstate(divide="ignore", invalid="ignore"):
        return AHEAD * last * np.clip(np.nan_to_num(last / before, nan=1.0), SLOWEST, 1.0)


def _integral(series):
    """Coefficients of the integral from the middle of the piece."""
    return np.stack([0.0 * series[0], *(row / power for power, row in enumerate(series, 1))])


def _slope(series):
    return [power * row for power, row in enumerate(series)][1:]


def _at(series, place):
    """Values of polynomials at a place of each."""
    value = series[-1]
    for row in series[-2::-1]:
        value = row + value * place
    return value


def _approached(function, slope, place, low, high):
    """Zero of a polynomial near a place, between two others."""
    for _ in range(APPROACHES):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = place - _at(function, place) / _at(slope, place)
        place = np.where(np.isnan(step), place, np.clip(step, low, high))
    return place


def _highest(series):
    """Largest value of the polynomials (terms, designs, pieces) of each design, on which piece, and where.

    Those pieces are looked at on which a value may be above those at the places.
    """
    samples = np.stack([_at(series, place) for place in PLACES])
    top = samples.max(axis=0)
    bend = sum(power * (power - 1) * np.abs(row) for power, row in enumerate(series))
    design, piece = np.nonzero(top + STEP**2 / 8.0 * bend >= top.max(axis=1, keepdims=True))
    own, first = series[:, design, piece], PLACES[samples[:, design, piece].argmax(axis=0)]
    slope = _slope(own)
    place = _approached(slope, _slope(slope), first, np.maximum(first - STEP, -1.0), np.minimum(first + STEP, 1.0))
    height = _at(own, place)
    place = np.where(height >= top[design, piece], place, first)
    height = np.maximum(height, top[design, piece])
    highest = np.full(len(top), -np.inf)
    np.maximum.at(highest, design, height)
    known, of = np.unique(np.where(height == highest[design], design, len(top)), return_index=True)
    known, of = known[known < len(top)], of[known < len(top)]
    found = np.full((2, len(top)), np.nan)
    found[:, known] = height[of], place[of]
    pieces = np.zeros(len(top), dtype=int)
    pieces[known] = piece[of]
    return found[0], pieces, found[1]


def _means(values):
    return sum(weight * row for weight, row in zip(WEIGHTS, values, strict=True))


def _sizes(values):
    """Mean magnitude of each piece (1, designs, pieces), also where the sign changes on it."""
    found, series = np.abs(_means(values)), _series(values)
    samples = np.stack([_at(series, place) for place in PLACES])
    design, piece = np.nonzero(np.signbit(samples).any(axis=0) & ~np.signbit(samples).all(axis=0))
    own = series[:, design, piece]
    slope, integral = _slope(own), _integral(own)
    total = np.zeros(design.size)
    for low in PLACES[:-1]:
        high = low + STEP
        one, other = _at(own, low), _at(own, high)
        changes = np.signbit(one) != np.signbit(other)
        with np.errstate(divide="ignore", invalid="ignore"):
            line = np.where(changes, low + STEP * one / (one - other), low)
        zero = np.where(changes, _approached(own, slope, line, low, high), low)
        total += np.abs(_at(integral, zero) - _at(integral, low)) + np.abs(_at(integral, high) - _at(integral, zero))
    found[design, piece] = 0.5 * total
    return found[None]

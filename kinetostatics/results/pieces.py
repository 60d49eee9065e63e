"""Reductions over a turn on which loads bend or jump, of many designs: by polynomials between the bends.

The turn is parted where anything bends, for each design where it does, and evenly besides. On every piece a quantity is
smooth, so few values tell all of it: its peaks, also those at bends, and its integrals. No value is taken at a bend, so
it does not matter on which side of it rounding would put that.
"""

from typing import Any, NamedTuple

import numpy as np

from ..machine.loads import TURN
from .means import NODES, WEIGHTS
from .reductions import OVER_THE_ANGLE, PEAK, PEAKS, is_rough

STEP = 0.25
PLACES = np.arange(-1.0, 1.0 + STEP / 2, STEP)
"""Places on a piece, from -1 to 1, between which peaks are sought."""
SERIES = np.linalg.inv(np.polynomial.polynomial.polyvander(2.0 * NODES - 1.0, NODES.size - 1))
"""Coefficients of the polynomial over these places from values at the nodes."""
LAST = 0.5 ** (NODES.size - 2)
"""Largest part of the last term that no polynomial of fewer terms can take; of one before the last twice as much."""
SHARP = 1e-9
"""Share of the largest magnitude on a piece that the last term has where the magnitude is not smooth."""
APPROACHES = 6
"""Steps of Newton's method to a peak or zero that is known to a quarter of half a piece."""
NARROW = 1e-12
"""Piece, rad, that is none: its ends are one place, found twice, and what jumps there may do so between them."""


class Pieces(NamedTuple):
    """The period of designs in pieces.

    Attributes
    ----------
    start, width : array (designs, P)
        Where each piece begins, and how wide it is, rad; empty ones stand inside of the widest.
    period : float
    """

    start: Any
    width: Any
    period: float

    @classmethod
    def of(cls, bends, period, angles, order=0):
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
        """
        count = max(round(period / TURN) * 2 * order, -(-angles // NODES.size))
        even = np.broadcast_to(np.linspace(0.0, period, count + 1), (len(bends), count + 1))
        edges = np.sort(np.column_stack([even, np.where(np.isnan(bends), 0.0, bends)]), axis=1)
        start, width = edges[:, :-1], np.diff(edges)
        widest = width.argmax(axis=1)[:, None]
        inside = np.take_along_axis(start + 0.5 * width, widest, axis=1)
        return cls(np.where(width < NARROW, inside, start), np.where(width < NARROW, 0.0, width), period)

    def some(self, designs):
        """Those of some designs."""
        return Pieces(self.start[designs], self.width[designs], self.period)

    @property
    def angle(self):
        """Crank angles (designs, N) to take values at."""
        return (self.start[..., None] + self.width[..., None] * NODES).reshape(len(self.start), -1)

    def estimated(self, output, values, vector=False):
        """Numbers (designs,) of an `Output` from values (designs, N), and whether these do not tell them.

        What is the magnitude of a vector has corners where the vector is zero, but its square has none.
        """
        values = np.moveaxis(values.reshape(*self.start.shape, NODES.size), -1, 0)
        if output.reduction in PEAKS:
            found, error, size = self._peaks(output.reduction, values, vector)
        elif output.reduction == "swing":
            found, error, size = self._swing(values)
        else:
            found, error, size = self._mean(output, values, vector)
        return found, is_rough(output, found, error, lambda rough: size[rough])

    def _peaks(self, reduction, values, vector):
        series = _series(values * values if vector else values)
        signs = {"largest": (1.0,), "smallest": (-1.0,)}.get(reduction.removesuffix("_at"), (1.0, -1.0))
        heights, places, errors = zip(*(self._end(series, sign, vector) for sign in signs), strict=True)
        error, size = np.maximum.reduce(errors), np.ptp(values, axis=(0, 2))
        if reduction in OVER_THE_ANGLE:
            return places[0], np.where(error > PEAK * np.abs(heights[0]), np.inf, 0.0), size
        if reduction == "range":
            return heights[0] - heights[1], error, size
        return np.maximum(heights[0], -heights[-1]) if reduction == "largest_absolute" else heights[0], error, size

    def _end(self, series, sign, vector):
        """Largest or smallest value of each design, where it is, and about how much it may be wrong."""
        height, piece, place, error = _highest(sign * series)
        design = np.arange(len(piece))
        height, angle = sign * height, self.start[design, piece] + self.width[design, piece] * (0.5 + 0.5 * place)
        if vector:
            height = np.sqrt(np.maximum(height, 0.0))
            error = error / np.maximum(np.maximum(height, np.sqrt(error)), np.finfo(float).tiny)
        return height, np.where(np.isnan(height), np.nan, np.mod(angle, self.period)), error

    def _mean(self, output, values, vector):
        kind, order = output.reduction, output.order
        error, size = self._sum(_rest(_series(values))[None]), np.abs(values).max(axis=(0, 2))
        if order is not None:
            angle = order * (self.start + self.width * NODES[:, None, None])
            parts = (self._sum(values * wave(angle)) for wave in (np.cos, np.sin))
            return np.hypot(*parts) * (1.0 if order == 0 else 2.0), 2.0 * error, size
        if kind == "rms":
            return np.sqrt(self._sum(values * values)), error, size
        if vector:
            return self._sum(_magnitudes(values)), error, size
        return self._sum(values if kind == "mean" else _sizes(values)), error, size

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
        found = _highest(inner)[0] + _highest(-inner)[0]
        error = 2.0 * self.period * self._sum(_rest(series)[None])
        return found, error, found


def _series(values):
    """Coefficients of the polynomial of each piece over places from -1 to 1, from values at the nodes (nodes, ...)."""
    return np.stack([sum(weight * row for weight, row in zip(weights, values, strict=True)) for weights in SERIES])


def _rest(series):
    """About how much polynomials may be off: their last term, and the one that would follow, as even ones decrease.

    What lies alike on both sides of the middle has no odd terms.
    """
    last, before = LAST * np.abs(series[-1]), 2.0 * LAST * np.abs(series[-2])
    with np.errstate(divide="ignore", invalid="ignore"):
        falls = np.fmin(before / (8.0 * LAST * np.abs(series[-4])), 1.0)
    return last + before * falls


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
    """Largest value of the polynomials (terms, designs, pieces) of each design, on which piece, where, and its error.

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
    found = np.full((3, len(top)), np.nan)
    found[:, known] = height[of], place[of], _rest(own[:, of])
    pieces = np.zeros(len(top), dtype=int)
    pieces[known] = piece[of]
    return found[0], pieces, found[1], found[2]


def _means(values):
    return sum(weight * row for weight, row in zip(WEIGHTS, values, strict=True))


def _magnitudes(values):
    """Mean magnitude of a vector on each piece (1, designs, pieces), also where it comes near zero and turns about.

    There the square, which is smooth, is integrated on both sides of where it is least, at places that gather there.
    """
    found, series = _means(values), _series(values)
    design, piece = np.nonzero(_rest(series) > SHARP * np.abs(values).max(axis=0))
    own = _series(values[:, design, piece] ** 2)
    slope = _slope(own)
    first = PLACES[np.stack([_at(own, place) for place in PLACES]).argmin(axis=0)]
    least = _approached(slope, _slope(slope), first, np.maximum(first - STEP, -1.0), np.minimum(first + STEP, 1.0))
    total = np.zeros(design.size)
    for end in (-1.0, 1.0):
        for node, weight in zip(NODES, WEIGHTS, strict=True):
            square = _at(own, least + (end - least) * node**3)
            total += 3.0 * node**2 * weight * np.abs(end - least) * np.sqrt(np.maximum(square, 0.0))
    found[design, piece] = 0.5 * total
    return found[None]


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

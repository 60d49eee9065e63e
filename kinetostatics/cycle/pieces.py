"""Reductions over a turn with kinks and jumps, of many designs, by polynomials on the pieces between them.

Each design's turn is split at its kinks and into even parts. A quantity is smooth on a piece, so a few values give its
peaks, also those at kinks, and its integrals. No value is computed at a kink, so rounding of its crank angle does not
matter. The error estimate of a piece is the larger of two: the missing terms of its series, and the gaps between its
ends and the neighbouring pieces. `refined` halves pieces until their errors are small. It also resolves undeclared
kinks, such as the rounded one of pin friction where the reaction passes near zero: short pieces are smooth there.
"""

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..machine.loads import TURN
from .reductions import OVER_THE_ANGLE, PEAKS, combined_peaks, is_rough, signs

_HALF = np.array([0.1834346424956498, 0.525532409916329, 0.7966664774136267, 0.9602898564975363]) / 2
NODES = 0.5 + np.concatenate([-_HALF[::-1], _HALF])
"""Gauss points, relative to a piece (Abramowitz and Stegun, table 25.4)."""
_HALF = np.array([0.362683783378362, 0.31370664587788727, 0.22238103445337448, 0.10122853629037626]) / 2
WEIGHTS = np.concatenate([_HALF[::-1], _HALF])
"""Their weights, right to the last digit: those of `numpy.polynomial` are off by up to 72 `UNIT_ROUNDOFF`."""
STEP = 0.25
PLACES = np.arange(-1.0, 1.0 + STEP / 2, STEP)
"""Sample points on a piece, in its coordinate from -1 to 1; Newton's iteration for a peak starts at the highest one."""
_VANDER = np.polynomial.polynomial.polyvander(2.0 * NODES - 1.0, NODES.size - 1).astype(np.longdouble)
SERIES = np.linalg.inv(_VANDER.astype(float))
SERIES = (SERIES @ (2.0 * np.eye(NODES.size) - _VANDER @ SERIES)).astype(float)
"""Matrix (powers, nodes) from values at the nodes to the power coefficients of a piece, in its coordinate -1 to 1."""
_LEGENDRE = np.polynomial.legendre.legvander(2.0 * NODES - 1.0, NODES.size - 1)
LAST_LEGENDRE = (((2.0 * np.arange(NODES.size) + 1.0) * WEIGHTS[:, None] * _LEGENDRE)[:, -4:]).T
"""Matrix (4, nodes) from values at the nodes to the last four Legendre coefficients of a piece."""
MIN_DECAY_RATIO = 0.1
"""Least ratio of the first missing terms to the last known ones in the error estimate; a kink may hide in less."""
TAIL_FACTOR = 4.0
"""Sum of all missing terms relative to the first of them, in the error estimate; at a kink they decrease slowly."""
NEWTON_STEPS = 6
"""Newton steps to a peak or zero at most `STEP` away from the start."""
MIN_WIDTH = 1e-12
"""Width, rad, below which a piece is dropped: both ends are the same kink."""
JUMP_WIDTH = 1e-9
"""Width, rad, below which a piece is not halved: its values at the nodes count as a jump, without error."""
MAX_OUTPUT_ERROR = 1e-8
"""Largest error of an output relative to the largest value of its quantity."""
TYPICAL_UNCERTAIN_PIECES = 8
"""Typical number of uncertain pieces that share the error of an integral."""
MAX_ADDED_PIECES = 720
"""Most pieces per turn that halving adds to a design."""


class Pieces(NamedTuple):
    """The period of many designs, each split into pieces.

    Attributes
    ----------
    start, width : array (designs, P)
        Start and width of each piece, rad; empty ones come last.
    joined : array (designs, P) of bool
        True where values are continuous from the piece before; for the first piece, from the last one.
    period : float
    """

    start: Any
    width: Any
    joined: Any
    period: float

    @classmethod
    def of(cls, kinks, period, angles, order=0, jumps=True):
        """Pieces of designs, split at kinks and evenly.

        Parameters
        ----------
        kinks : array (designs, K)
            Crank angles, NaN where a design has fewer.
        period : float
        angles : int
            Crank angles over the period that suffice without kinks.
        order : int
            Highest harmonic of the crank angle among the outputs.
        jumps : bool or array (1 or designs, K) of bool
            Whether quantities may jump at these kinks.
        """
        count = max(round(period / TURN) * 2 * order, -(-angles // NODES.size))
        even = np.broadcast_to(np.linspace(0.0, period, count + 1), (len(kinks), count + 1))
        edges = np.column_stack([even, np.where(np.isnan(kinks), 0.0, kinks)])
        jumping = np.column_stack([np.zeros(even.shape, dtype=int), ~np.isnan(kinks) & jumps])
        rising = edges.argsort(axis=1, kind="stable")
        edges, jumping = (np.take_along_axis(part, rising, axis=1) for part in (edges, jumping))
        width = np.diff(edges)
        widest = width.argmax(axis=1)[:, None]
        inside = np.take_along_axis(edges[:, :-1] + 0.5 * width, widest, axis=1)
        real = width >= MIN_WIDTH
        last = np.cumsum(jumping, axis=1)
        before = np.maximum.accumulate(np.where(real, np.arange(1, width.shape[1] + 1), 0), axis=1)
        before = np.column_stack([np.zeros(len(kinks), dtype=int), before])  # edge at the end of the last real piece
        passed = np.take_along_axis(last - jumping, before, axis=1)  # jumps before that edge
        wrapped = last[:, -1:] - passed[:, -1:]
        joined = last[:, :-1] == np.where(before[:, :-1] > 0, passed[:, :-1], -wrapped)
        first = (~real).argsort(axis=1, kind="stable")
        parts = np.where(real, edges[:, :-1], inside), np.where(real, width, 0.0), joined
        start, width, joined = (np.take_along_axis(part, first, axis=1) for part in parts)
        return cls(start, width, joined, period)

    def some(self, designs):
        """Pieces of some designs."""
        return Pieces(self.start[designs], self.width[designs], self.joined[designs], self.period)

    @property
    def angle(self):
        """Crank angles (designs, N) of the values."""
        return (self.start[..., None] + self.width[..., None] * NODES).reshape(len(self.start), -1)

    def estimated(self, output, values, vector=False):
        """Numbers (designs,) of an `Output` from values (designs, N), and whether they are uncertain."""
        by_node = self._by_node(values)
        if output.reduction in PEAKS:
            found, height = self._peaks(output.reduction, by_node, vector)
            error = self.of_peaks(values, signs(output.reduction), vector).max(axis=1)
            size = np.ptp(by_node, axis=(0, 2))
            output = replace(output, reduction=output.reduction.removesuffix("_at"))
            return found, is_rough(output, height, error, lambda rough: size[rough])
        swing = output.reduction == "swing"
        found = self._swing(by_node) if swing else self._mean(output, by_node, vector)
        size = found if swing else np.abs(by_node).max(axis=(0, 2))
        error = self.of_integrals(values).sum(axis=1) * (2.0 * self.period if swing else 2.0 if output.order else 1.0)
        return found, is_rough(output, found, error, lambda rough: size[rough])

    def of_peaks(self, values, signs, vector):
        """Error estimate (designs, P) of each piece's peak, in the quantity's unit; 0 where it cannot be the extreme.

        `signs` lists 1.0 for the largest value, -1.0 for the smallest. The values of a `vector` are magnitudes; their
        squares give the series, since a magnitude has a corner at zero.
        """
        values = self._by_node(values)
        values = values * values if vector else values
        series, error = self._series_with_jumps(values), self._errors(values)
        samples = np.stack([_evaluate(series, place) for place in PLACES])
        room = error + STEP**2 / 8.0 * sum(power * (power - 1) * np.abs(row) for power, row in enumerate(series))
        found = np.zeros(error.shape)
        for sign in signs:
            top = (sign * samples).max(axis=0)
            rival, own = top + room >= (top - error).max(axis=1, keepdims=True), error
            if vector:
                own = error / np.sqrt(np.maximum(np.maximum(sign * top, error), np.finfo(float).tiny))
            found = np.maximum(found, np.where(rival, own, 0.0))
        return found

    def of_integrals(self, values):
        """Error estimate (designs, P) of the mean over the period from each piece, in the unit of the quantity."""
        return self._errors(self._by_node(values)) * self.width / self.period

    def _by_node(self, values):
        """Values (designs, N) as array (nodes, designs, P)."""
        return np.moveaxis(values.reshape(*self.start.shape, NODES.size), -1, 0)

    def _series_with_jumps(self, values):
        """Coefficients (powers, designs, P); a piece narrower than `JUMP_WIDTH` gets a line between its extremes."""
        series = _coefficients(values)
        narrow = (self.width > 0.0) & (self.width < JUMP_WIDTH)
        if narrow.any():
            low, high = values.min(axis=0)[narrow], values.max(axis=0)[narrow]
            series[:, narrow] = 0.0
            series[0, narrow], series[1, narrow] = 0.5 * (low + high), 0.5 * (high - low)
        return series

    def _errors(self, values):
        """Error estimate (designs, P) of the polynomial of each piece: the missing terms or the gaps to its neighbours.

        The missing terms are assumed to decrease as the last four coefficients do. Coefficients are combined in pairs,
        one even and one odd, since a kink can make one of them vanish, but not both.
        """
        series = _coefficients(values)
        even, odd = sum(series[2::2], series[0]), sum(series[3::2], series[1])
        first, last = even - odd, even + odd
        count = np.maximum((self.width > 0.0).sum(axis=1), 1)[:, None] - 1
        before = np.column_stack([np.take_along_axis(last, count, axis=1), last[:, :-1]])
        gap = np.where(self.joined & (self.width > 0.0), np.abs(first - before), 0.0)
        after = np.column_stack([gap[:, 1:], np.zeros(len(gap))])
        np.put_along_axis(after, count, gap[:, :1], axis=1)
        terms = [_weighted_sum(weights, values) for weights in LAST_LEGENDRE]
        former, latter = np.hypot(*terms[:2]), np.hypot(*terms[2:])
        with np.errstate(divide="ignore", invalid="ignore"):
            rest = TAIL_FACTOR * latter * np.clip(np.nan_to_num(latter / former, nan=1.0), MIN_DECAY_RATIO, 1.0)
        return np.where(self.width < JUMP_WIDTH, 0.0, np.maximum(rest, np.maximum(gap, after)))

    def _peaks(self, reduction, values, vector):
        """Reduction (designs,) of peaks, crank angles in rad for `OVER_THE_ANGLE`, and the height of the peak."""
        series = self._series_with_jumps(values * values if vector else values)
        heights, angles = [], []
        for sign in signs(reduction):
            height, piece, place = _global_maximum(sign * series)
            design = np.arange(len(piece))
            angle = self.start[design, piece] + self.width[design, piece] * (0.5 + 0.5 * place)
            height = sign * height
            heights.append(np.sqrt(np.maximum(height, 0.0)) if vector else height)
            angles.append(np.where(np.isnan(heights[-1]), np.nan, np.mod(angle, self.period)))
        if reduction in OVER_THE_ANGLE:
            return angles[0], heights[0]
        found = combined_peaks(reduction, heights)
        return found, found

    def _mean(self, output, values, vector):
        """Mean, rms or amplitude of a harmonic over the period, (designs,)."""
        kind, order = output.reduction, output.order
        if order is not None:
            angle = order * (self.start + self.width * NODES[:, None, None])
            parts = (self._period_mean(values * wave(angle)) for wave in (np.cos, np.sin))
            return np.hypot(*parts) * (1.0 if order == 0 else 2.0)
        if kind == "rms":
            return np.sqrt(self._period_mean(values * values))
        return self._period_mean(values if kind == "mean" or vector else _mean_magnitudes(values))

    def _period_mean(self, values):
        """Mean over the period, (designs,), of values (nodes, designs, P) or of piece means (1, designs, P)."""
        parts = _weighted_sum(WEIGHTS, values) if len(values) == NODES.size else values[0]
        return np.cumsum(self.width * parts, axis=1)[:, -1] / self.period

    def _swing(self, values):
        """Range (designs,) of the integral of values less their mean over the crank angle; J for a torque."""
        series = _coefficients(values)
        series[0] -= self._period_mean(values)[:, None]
        inner = _integral(series) * (0.5 * self.width)
        gained = np.cumsum(_evaluate(inner, 1.0) - _evaluate(inner, -1.0), axis=1)
        inner[0] += np.column_stack([np.zeros(len(gained)), gained[:, :-1]]) - _evaluate(inner, -1.0)
        return _global_maximum(inner)[0] + _global_maximum(-inner)[0]


def _weighted_sum(weights, values):
    """Sum over the nodes of values (nodes, ...) times weights (nodes,)."""
    return sum(weight * row for weight, row in zip(weights, values, strict=True))


def _coefficients(values):
    """Power coefficients (powers, ...) of each piece in its coordinate -1 to 1, from values (nodes, ...)."""
    return np.stack([_weighted_sum(weights, values) for weights in SERIES])


def _integral(series):
    """Coefficients of the integral from the middle of the piece."""
    return np.stack([0.0 * series[0], *(row / power for power, row in enumerate(series, 1))])


def _derivative(series):
    """Coefficients of the derivative by the coordinate of the piece."""
    return [power * row for power, row in enumerate(series)][1:]


def _evaluate(series, place):
    """Values of polynomials at a coordinate of their piece, one for all or one each."""
    value = series[-1]
    for row in series[-2::-1]:
        value = row + value * place
    return value


def _find_zero(function, slope, place, low, high):
    """Zero of a polynomial with derivative `slope` near a coordinate, within [low, high]."""
    for _ in range(NEWTON_STEPS):
        with np.errstate(divide="ignore", invalid="ignore"):
            step = place - _evaluate(function, place) / _evaluate(slope, place)
        place = np.where(np.isnan(step), place, np.clip(step, low, high))
    return place


def _global_maximum(series):
    """Largest value over the pieces of each design, its piece, and its coordinate there, each (designs,).

    `series` has shape (powers, designs, pieces). Newton's iteration runs only on pieces whose peak may exceed all
    samples at `PLACES`.
    """
    samples = np.stack([_evaluate(series, place) for place in PLACES])
    top = samples.max(axis=0)
    bend = sum(power * (power - 1) * np.abs(row) for power, row in enumerate(series))
    design, piece = np.nonzero(top + STEP**2 / 8.0 * bend >= top.max(axis=1, keepdims=True))
    own, first = series[:, design, piece], PLACES[samples[:, design, piece].argmax(axis=0)]
    slope = _derivative(own)
    place = _find_zero(slope, _derivative(slope), first, np.maximum(first - STEP, -1.0), np.minimum(first + STEP, 1.0))
    height = _evaluate(own, place)
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


def _mean_magnitudes(values):
    """Mean magnitude on each piece (1, designs, pieces), also where the sign changes on it."""
    found, series = np.abs(_weighted_sum(WEIGHTS, values)), _coefficients(values)
    samples = np.stack([_evaluate(series, place) for place in PLACES])
    design, piece = np.nonzero(np.signbit(samples).any(axis=0) & ~np.signbit(samples).all(axis=0))
    own = series[:, design, piece]
    slope, integral = _derivative(own), _integral(own)
    total = np.zeros(design.size)
    for low in PLACES[:-1]:
        high = low + STEP
        one, other = _evaluate(own, low), _evaluate(own, high)
        changes = np.signbit(one) != np.signbit(other)
        with np.errstate(divide="ignore", invalid="ignore"):
            line = np.where(changes, low + STEP * one / (one - other), low)
        zero = np.where(changes, _find_zero(own, slope, line, low, high), low)
        at_low, at_zero, at_high = (_evaluate(integral, place) for place in (low, zero, high))
        total += np.abs(at_zero - at_low) + np.abs(at_high - at_zero)
    found[design, piece] = 0.5 * total
    return found[None]


def refined(pieces, values, outputs, evaluate, goal=MAX_OUTPUT_ERROR):
    """Halve pieces until the outputs are certain; yield designs as they finish.

    Each yield has the indices of some designs, their `Pieces`, and a dict of quantity to values (designs, P, nodes). A
    design that needs more than `MAX_ADDED_PIECES` per turn is yielded with the pieces it has.

    Parameters
    ----------
    pieces : Pieces
    values : dict of str to array (designs, N)
    outputs : sequence of (Output, bool)
        Each with whether its quantity is a vector.
    evaluate : function
        From indices of designs (D,) and crank angles (D, N) to values (D, N) by quantity.
    goal : float
        Largest error of an output relative to the largest value of its quantity.
    """
    designs, first = np.arange(len(pieces.start)), (pieces.width > 0.0).sum(axis=1)
    most = first + MAX_ADDED_PIECES * round(pieces.period / TURN)
    values = {name: rows.reshape(*pieces.start.shape, NODES.size) for name, rows in values.items()}
    vectors = {output.quantity: vector for output, vector in outputs}
    peaks: dict[str, set[float]] = {name: set() for name in vectors}
    for output, _ in outputs:
        peaks[output.quantity].update(signs(output.reduction) if output.reduction in PEAKS else ())
    integrals = {output.quantity for output, _ in outputs if output.reduction not in PEAKS}
    while designs.size:
        halved = np.zeros(pieces.start.shape, dtype=bool)
        for name, vector in vectors.items():
            size = np.abs(values[name]).max(axis=(1, 2))[:, None]
            with np.errstate(invalid="ignore"):
                if peaks[name]:
                    halved |= pieces.of_peaks(values[name], peaks[name], vector) > goal * size
                if name in integrals:
                    halved |= pieces.of_integrals(values[name]) > goal / TYPICAL_UNCERTAIN_PIECES * size
        halved &= pieces.width >= JUMP_WIDTH
        count = (pieces.width > 0.0).sum(axis=1) + halved.sum(axis=1)
        going = halved.any(axis=1) & (count <= most[designs])
        if not going.all():
            yield designs[~going], pieces.some(~going), {name: rows[~going] for name, rows in values.items()}
        designs, pieces, halved = designs[going], pieces.some(going), halved[going]
        values = {name: rows[going] for name, rows in values.items()}
        if designs.size:
            pieces, values = _halve(pieces, values, halved, lambda angle, own=designs: evaluate(own, angle))


def _halve(pieces, values, halved, evaluate):
    """Pieces after halving those marked in `halved`, at least one per design, and values; only halves are evaluated."""
    design, piece = np.nonzero(pieces.width > 0.0)
    parts = 1 + halved[design, piece]
    second = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts) == 1
    design, piece, parts = (np.repeat(part, parts) for part in (design, piece, parts))
    width = pieces.width[design, piece] / parts
    start = pieces.start[design, piece] + second * width
    joined = second | pieces.joined[design, piece]
    count = np.bincount(design, minlength=len(halved))
    column = np.arange(design.size) - (np.cumsum(count) - count)[design]
    shape = len(halved), count.max()
    found = type(pieces)(
        np.broadcast_to(pieces.start[:, :1], shape).copy(), np.zeros(shape), np.ones(shape, dtype=bool), pieces.period
    )
    for whole, part in zip(found, (start, width, joined), strict=False):
        whole[design, column] = part
    new = parts == 2
    many = 2 * halved.sum(axis=1)
    place = np.arange(new.sum()) - (np.cumsum(many) - many)[design[new]]
    angle = np.repeat(pieces.angle[:, None, : NODES.size], many.max(), axis=1)
    angle[design[new], place] = start[new, None] + width[new, None] * NODES
    evaluated = evaluate(angle.reshape(len(angle), -1))
    filled = {}
    for name, old in values.items():
        filled[name] = np.broadcast_to(old[:, :1], (*shape, NODES.size)).copy()
        filled[name][design[~new], column[~new]] = old[design[~new], piece[~new]]
        filled[name][design[new], column[new]] = evaluated[name].reshape(angle.shape)[design[new], place]
    return found, filled

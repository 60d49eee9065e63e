"""Extrema of a sampled quantity: bracketed by samples, differences by rounding left out, refined by evaluation."""

from typing import NamedTuple

import numpy as np

from ..numbers.brackets import find_minima
from .kinks import ANGLE_TOLERANCE
from .turn import JUMP_OFFSETS, runs

LIMIT_TOLERANCE = 1e-4
"""Difference of the limits from both sides of a limit position, relative to the size of the quantity, that is none."""
JUMP_TOLERANCE = 1e-9
"""Difference of the values on both sides of a jump, relative to the size of the quantity, that is none."""
MIN_LEVEL_WIDTH = 0.05
"""Crank angle, rad, over which values that differ by rounding alone are a level stretch, as in a dwell."""
HALVINGS = 48
"""Bisections that find an end of a level stretch."""


class Path(NamedTuple):
    """Samples of a quantity and their rounding, periodic; with a period of 0 open, from one limit to the next."""

    angle: np.ndarray
    value: np.ndarray
    floor: np.ndarray
    period: float


class Jumps(NamedTuple):
    """Jumps of a quantity: the crank angles of the last sample before each and of the first one after it, rad."""

    before: np.ndarray
    after: np.ndarray

    def cut(self, brackets, period):
        """Brackets that end at each jump; a middle between the two samples moves to the one before."""
        start, middle, end = brackets
        shifts = period * np.array([-1.0, 0.0, 1.0])[:, None]
        for before, after in zip(*((side + shifts).ravel() for side in self), strict=True):
            middle = np.where((before < middle) & (middle < after), before, middle)
            start = np.where((start < after) & (after <= middle), after, start)
            end = np.where((middle <= before) & (before < end), before, end)
        return np.array([start, middle, end])


def replace_jumps(turn, samples, size):
    """Samples with the value just before each jump at the jump itself, and the jumps, as `Jumps`.

    The value at the crank angle of a jump is arbitrary: of two parts that jump there, rounding may put one before its
    jump and the other behind.
    """
    distance = np.mod(turn.angle[:, None] - turn.jumps + turn.period / 2, turn.period) - turn.period / 2
    on = np.zeros(samples.shape, dtype=bool)
    if turn.jumps.size:
        on = np.any(np.abs(distance) < JUMP_OFFSETS[1] / 2, axis=1)
    before, after = [], []
    samples = samples.copy()
    for run in runs(on):
        low, high = run[0] - 1, (run[-1] + 1) % samples.size
        if abs(samples[high] - samples[low]) > JUMP_TOLERANCE * size:
            samples[run] = samples[low]
            before.append(turn.angle[low])
            after.append(turn.angle[high] + (turn.period if turn.angle[high] < turn.angle[low] else 0.0))
    return samples, Jumps(np.array(before), np.array(after))


def open_paths(turn, function, samples, good, floor, size):
    """Yield a `Path` for each run of good samples, ended by the limits of the quantity at limit positions."""
    limits = np.concatenate([turn.limits + shift for shift in (-turn.period, 0.0, turn.period)])
    found = runs(good)
    for run, earlier, later in zip(found, found[-1:] + found[:-1], found[1:] + found[:1], strict=True):
        angle = turn.angle[run]
        angle = np.where(angle < angle[0], angle + turn.period, angle)
        before = angle[0] - (angle[0] - turn.angle[earlier[-1]]) % turn.period
        after = angle[-1] + (turn.angle[later[0]] - angle[-1]) % turn.period
        left = limits[(limits >= before - ANGLE_TOLERANCE) & (limits <= angle[0] + ANGLE_TOLERANCE)][-1:]
        right = limits[(limits <= after + ANGLE_TOLERANCE) & (limits >= angle[-1] - ANGLE_TOLERANCE)][:1]
        inside = angle > np.append(left, -np.inf)[0] + ANGLE_TOLERANCE
        inside &= angle < np.append(right, np.inf)[0] - ANGLE_TOLERANCE
        parts = [(angle[inside], samples[run][inside], floor[run][inside])]
        for place, side, row in ((left, 1, 0), (right, -1, -1)):
            ends = [turn.limit(function, end, side, size) for end in place]
            parts.insert(row % 2 * len(parts), (place, ends, floor[run][[row] * place.size]))
        angle, value, rounding = (np.concatenate(part) for part in zip(*parts, strict=True))
        known = ~np.isnan(value)
        yield Path(angle[known], value[known], rounding[known], 0.0)


def turning_points(path):
    """Crank angles around each extremum (3, K), its value, rounding, and whether it is a maximum (K,).

    A level stretch counts once, at its middle. The ends of an open path are extrema too, with equal angles. Rises and
    falls within the rounding are taken out, the least first.
    """
    angle, value, floor, period = path
    count = value.size
    direction = np.sign(np.roll(value, -1) - value)
    direction[-1:] = direction[-1:] if period else 0.0
    moving = np.flatnonzero(direction)
    following = np.append(moving[1:], moving[:1] + count)
    turning = direction[moving] * direction[following % count] == -1
    turning[-1:] &= period > 0
    before, after = moving[turning], following[turning]
    places, maximum = np.array([before, (before + after + 1) // 2, after + 1]), direction[before] > 0
    if not period:
        places = np.column_stack([[0] * 3, places, [count - 1] * 3])
        maximum = np.concatenate([direction[moving[:1]] < 0, maximum, direction[moving[-1:]] > 0])
        maximum = maximum if moving.size else np.array([True, False])
    while maximum.size > 2 - bool(period) and (not period or np.all(maximum != np.roll(maximum, 1))):
        middle = places[1] % count
        height, rounding = value[middle], floor[middle]
        change = np.abs(np.roll(height, -1) - height) / np.maximum(rounding, np.roll(rounding, -1))
        least = int(np.argmin(change[: None if period else -1]))
        if change[least] > 1:
            break
        pair = [least, (least + 1) % maximum.size]
        if not period and (least == 0 or least == maximum.size - 2):  # the end stays, as the other kind
            end = pair.pop(-1 if least else 0)
            maximum[end] = ~maximum[end]
        kept = np.delete(np.arange(maximum.size), pair)
        places, maximum = places[:, kept], maximum[kept]
    places = _bracket_level_stretches(path, places)
    middle = places[1] % count
    return angle[places % count] + period * (places // count), value[middle], floor[middle], maximum


def _bracket_level_stretches(path, places):
    """Brackets of extrema; in a level stretch from the sample before the stretch to the one after it."""
    angle, value, floor, period = path
    count = value.size

    def end(middle, step):
        """Place of the first sample in a direction that is not level with the middle one."""
        place, last = middle, middle + step * (count - 1)
        while place != last and abs(value[place % count] - value[middle % count]) <= floor[middle % count]:
            place += step
            if not (period or 0 <= place < count):
                return middle
        return place

    found = places.copy()
    for number, (start, middle, stop) in enumerate(places.T):
        low, high = (end(middle, step) for step in (-1, 1)) if start < stop else (middle, middle)
        if low < middle < high < low + count:
            outer = [angle[place % count] + period * (place // count) for place in (low, high)]
            if outer[1] - outer[0] > MIN_LEVEL_WIDTH:
                found[:, number] = low, middle, high
    return found


def refine_turning_points(turn, function, size, jumps, brackets, value, floor, maximum):
    """Angle, value and kind of turning points in order of angle; those between two samples are refined by evaluation.

    Parameters
    ----------
    turn : Turn
    function : function
        From a solution to the values of the quantity over its crank angles.
    size : float
        Of the quantity.
    jumps : Jumps
    brackets, value, floor, maximum : arrays (3, K) and (K,)
        As `turning_points` returns them.
    """
    end = brackets[0] == brackets[2]
    brackets = jumps.cut(brackets, turn.period)
    angle, sign = brackets[1], np.where(maximum, -1.0, 1.0)
    inner = (brackets[0] < angle) & (angle < brackets[2])
    level = inner & (brackets[2] - brackets[0] > MIN_LEVEL_WIDTH)

    def evaluate(angle):
        return turn.evaluate(function, angle)

    if inner.any():
        own, inside = sign[inner], brackets[:, inner]
        least = find_minima(lambda angle, place: own[place] * evaluate(angle), inside, relative=0.0, tiny=0.0)
        better = own * evaluate(least) <= own * evaluate(inside[1])  # False where no bracket is left, as at a jump
        angle[inner] = _polish(evaluate, np.where(better, least, inside[1]), own, floor[inner])
        if level.any():
            angle[level] = _middle_of_level(evaluate, brackets[:, level], floor[level])
        wrapped = np.mod(angle[inner], turn.period)
        start = np.maximum(np.mod(angle[inner] + ANGLE_TOLERANCE, turn.period) - ANGLE_TOLERANCE, 0.0)
        at_end = start < wrapped - ANGLE_TOLERANCE  # just before the period ends: 0, unless the value jumps there
        if at_end.any():
            start = np.where(at_end & (own * (evaluate(start) - evaluate(wrapped)) > floor[inner]), wrapped, start)
        angle[inner] = start
        value[inner] = evaluate(angle[inner])
    angle = np.where(inner, angle, np.mod(angle, turn.period))
    order = np.argsort(angle, kind="stable")
    angle, value, maximum, end = angle[order], value[order], maximum[order], end[order]
    # two ends of paths at one angle with one value: a level pair counts once, a smooth passage not at all
    same = (np.abs(angle - np.roll(angle, -1)) <= ANGLE_TOLERANCE) & end & np.roll(end, -1)
    alike = (value == np.roll(value, -1)) | (np.abs(value - np.roll(value, -1)) <= LIMIT_TOLERANCE * size)
    pair = same & alike & (np.arange(angle.size) < angle.size - 1)
    kept = ~(np.roll(pair, 1) | (pair & (maximum != np.roll(maximum, -1))))
    return angle[kept], value[kept], maximum[kept]


def _middle_of_level(evaluate, brackets, floor):
    """Middle of each level stretch, whose ends lie between the middle and the outer angles of its bracket."""
    start, middle, end = brackets
    value, ends = evaluate(middle), []
    for outside in (start, end):
        inside = middle
        for _ in range(HALVINGS):
            half = 0.5 * (inside + outside)
            is_level = np.abs(evaluate(half) - value) <= floor
            inside, outside = np.where(is_level, half, inside), np.where(is_level, outside, half)
        ends.append(inside)
    return 0.5 * (ends[0] + ends[1])


def _polish(evaluate, angle, sign, floor, half_width=0.01, degree=8):
    """Zero of the slope of a local Chebyshev fit, where its value is as good as the one it replaces."""
    from numpy.polynomial import chebyshev

    nodes = chebyshev.chebpts1(degree + 1)
    samples = evaluate((angle[:, None] + half_width * nodes).ravel()).reshape(angle.size, -1)
    series = chebyshev.chebfit(nodes, np.nan_to_num(samples).T, degree)
    slope, bend = chebyshev.chebder(series), chebyshev.chebder(series, 2)
    place = np.zeros_like(angle)
    for _ in range(3):
        place -= chebyshev.chebval(place, slope, tensor=False) / chebyshev.chebval(place, bend, tensor=False)
    refined = np.where(np.abs(place) < 1e-3, angle + half_width * place, angle)
    smooth = np.max(np.abs(series[-2:]), axis=0) <= floor
    allowed = np.where(smooth, 1.0, 0.1) * floor
    return np.where(sign * evaluate(refined) <= sign * evaluate(angle) + allowed, refined, angle)

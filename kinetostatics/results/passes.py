"""Reductions of many designs in one pass each, as machine code by numba: the same numbers as `reductions` to rounding.

A loop over designs leaves its values in the cache; here they are reduced before they leave it. What depends on a
design is written for it alone, so that it does not matter which designs come together.
"""

import numpy as np

from ..engines import compiled
from ..numbers.elementary import ROUNDING
from .peaks import INNER, REACH, THROUGH, TINY
from .reductions import MEAN, PEAK
from .turn import NEAR

KINDS = (
    "largest",
    "largest_at",
    "smallest",
    "smallest_at",
    "largest_absolute",
    "range",
    "mean",
    "mean_absolute",
    "rms",
)
"""Reductions that are there, by their number; harmonics and the swing are not."""


def _summing(name, term):
    """Function that sums a term of every other value, and of those between.

    Eight sums go side by side, in vectors, in an order that is written out: a compiler that may choose the order does
    not choose the same each time.
    """
    lanes = range(8)
    start = "\n    ".join(f"sum{k} = 0.0" for k in lanes)
    add = "\n        ".join(f"value = rows[i, {k}]\n        sum{k} += {term}" for k in lanes)
    even, odd = (" + ".join(f"sum{k}" for k in lanes[first::2]) for first in (0, 1))
    return f"""
@njit(**options)
def {name}(values):
    whole = values.size // 8
    rows = values[: 8 * whole].reshape((whole, 8))
    {start}
    for i in range(whole):
        {add}
    even, odd = {even}, {odd}
    for i in range(8 * whole, values.size):
        value = values[i]
        if i % 2 == 0:
            even += {term}
        else:
            odd += {term}
    return even, odd

"""


SOURCE = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import inf, nan, pi, sqrt

import numpy as np
from numba import njit

options = dict(error_model="numpy", nogil=True)
THROUGH = np.array({THROUGH.T.tolist()!r})
INNER = np.array({INNER.coef.tolist()!r})


@njit(**options)
def polyval(place, series):
    value = series[series.size - 1]
    for k in range(series.size - 2, -1, -1):
        value = series[k] + value * place
    return value


@njit(**options)
def between(values, at, side, work):
    """Height of a peak, how far from its highest sample, and about how much the height may be wrong."""
    curve, series, slope, change = work[0], work[1], work[2, : {2 * REACH}], work[3, : {2 * REACH - 1}]
    count = values.size
    above, below = True, True
    for k in range({2 * REACH + 1}):
        j = at + k - {REACH}
        j = j + count if j < 0 else j - count if j >= count else j
        value = side * values[j]
        curve[k] = value
        above &= value >= 0.0
        below &= value <= 0.0
    sign = 1.0 if above else -1.0 if below else 0.0
    if sign != 0.0:
        for k in range({2 * REACH + 1}):
            curve[k] *= abs(curve[k])
    before, here, after = curve[{REACH - 1}], curve[{REACH}], curve[{REACH + 1}]
    bend = (after - here) - (here - before)
    first = (here - before) - (before - curve[{REACH - 2}])
    last = (curve[{REACH + 2}] - after) - (after - here)
    shift, found, other = 0.0, here, here + abs(bend)
    if first < 0.0 and bend < 0.0 and last < 0.0:
        shift = 0.5 * (before - after) / bend
        found = here - 0.25 * (before - after) * shift
        series[:] = 0.0
        for j in range({2 * REACH + 1}):
            for k in range({2 * REACH + 1}):
                series[k] += THROUGH[j, k] * curve[j]
        for k in range({2 * REACH}):
            slope[k] = series[k + 1] * (k + 1.0)
        for k in range({2 * REACH - 1}):
            change[k] = slope[k + 1] * (k + 1.0)
        place = shift
        place = place - polyval(place, slope) / polyval(place, change)
        place = place - polyval(place, slope) / polyval(place, change)
        top = polyval(place, series)
        other = top
        if abs(top - found) < 0.05 * abs(bend) and abs(place) < 1.0:
            found, shift = top, place
            other = top - polyval(place, INNER) * (series[{2 * REACH - 1}] + series[{2 * REACH}] * place)
    error = abs(found - other)
    if sign == 0.0:
        return found, shift, error
    height = sign * sqrt(max(sign * found, 0.0))
    return height, shift, error / max(max(abs(height), sqrt(error)), {TINY!r})


@njit(**options)
def marked(values, marks):
    """Mark the samples where values turn, or are none."""
    count = values.size
    for i in range(1, count - 1):
        before, here, after = values[i - 1], values[i], values[i + 1]
        turning = ((here > before) != (after > here)) | ((here < before) != (after < here)) | (here != here)
        marks[i] = turning
    for i in (0, count - 1):
        marks[i] = True


@njit(**options)
def turned(values, marks, words, places):
    """Places of tops, from the first on, and of bottoms, from the last back; how many each, and where one is no number.

    There is at least one of each: of what is constant the first sample.
    """
    count, tops, bottoms = values.size, 0, 0
    for word in range(words.size):
        if words[word] == 0:
            continue
        for i in range(8 * word, min(8 * word + 8, count)):
            if marks[i]:
                before, after = values[i - 1 if i else count - 1], values[i + 1 if i + 1 < count else 0]
                here = values[i]
                if here != here:
                    return 0, 0, False
                if here > before and not after > here:
                    places[tops] = i
                    tops += 1
                if here < before and not after < here:
                    bottoms += 1
                    places[places.size - bottoms] = i
    if tops == 0:
        places[0] = 0
        places[places.size - 1] = 0
        return 1, 1, True
    return tops, bottoms, True


@njit(**options)
def peak(values, side, places, work):
    """Highest peak of values times a sign among places, where, in samples, and about how much it may be wrong."""
    count, bound, best = values.size, -inf, -inf
    for i in places:
        before, after = side * values[i - 1 if i else count - 1], side * values[i + 1 if i + 1 < count else 0]
        here = side * values[i]
        bound = max(bound, here - abs(before - 2.0 * here + after))
        best = max(best, here)
    wrapped = side * values[0] == best and side * values[count - 1] == best
    if wrapped:  # a plateau goes on across the end of the turn, and its first sample counts too
        bound = max(bound, best - abs(side * values[1] - best))
    highest, where, worst = -inf, nan, 0.0
    for k in range(places.size + wrapped):
        i = places[k] if k < places.size else 0
        before, after = side * values[i - 1 if i else count - 1], side * values[i + 1 if i + 1 < count else 0]
        here = side * values[i]
        if here + abs(before - 2.0 * here + after) < bound:
            continue
        height, shift, error = between(values, i, side, work)
        worst = max(worst, error)
        if height > highest or (height == highest and i + shift < where) or where != where:
            highest, where = height, i + shift
    where += count if where < 0.0 else -count if where >= count else 0
    return highest, where, worst


{_summing("plain", "value")}
{_summing("sizes", "abs(value)")}
{_summing("squares", "value * value")}
@njit(**options)
def kinks(values, step):
    """What the mean of sizes of every so many values is too large by, where the sign changes (`reductions._kinks`)."""
    count, total = values.size // step, 0.0
    before = values[(count - 1) * step]
    for i in range(count):
        after = values[i * step]
        if (before < 0.0) != (after < 0.0):
            here, there = abs(before), abs(after)
            total += here * there / (here + there) - (here + there) / 6.0
        before = after
    return total / count


@njit(**options)
def averaged(values, power):
    """Mean, of sizes or squares too, and how far that of every other value is from it."""
    even, odd = plain(values) if power == 0 else sizes(values) if power == 1 else squares(values)
    whole, half = (even + odd) / values.size, even / (values.size // 2)
    if power == 1:
        whole, half = whole - kinks(values, 1), half - kinks(values, 2)
    if power == 2:
        whole, half = sqrt(whole), sqrt(half)
    return whole, abs(half - whole) if values.size % 2 == 0 else 0.0 * whole


@njit(**options)
def estimated(values, kind, turns, marks, words, places, work):
    """Number, and whether so many samples do not tell it."""
    if kind >= 6:
        found, error = averaged(values, kind - 6)
        if not error > {MEAN!r} * abs(found):
            return found, False
        size = 0.0
        for value in values:
            size = max(size, abs(value))
        return found, error > {MEAN / 10!r} * size
    marked(values, marks)
    tops, bottoms, whole = turned(values, marks, words, places)
    if not whole:
        return nan, False
    high, low, above, below, at, under = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if kind <= 1 or kind >= 4:
        high, at, above = peak(values, 1.0, places[:tops], work)
    if kind >= 2:
        low, under, below = peak(values, -1.0, places[places.size - bottoms :], work)
        low = -low
    error = max(above, below)
    if kind == 1 or kind == 3:
        found, size = (at, high) if kind == 1 else (under, low)
        found *= 2.0 * pi / values.size
        return found * turns, error > {PEAK!r} * abs(size)
    found = high if kind == 0 else low if kind == 2 else max(high, -low) if kind == 4 else high - low
    if not error > {PEAK!r} * abs(found):
        return found, False
    least, most = values[0], values[0]
    for value in values:
        least, most = min(least, value), max(most, value)
    return found, error > {PEAK / 100!r} * (most - least)


@njit(**options)
def reduced(results, rows, kinds, turns, numbers, rough, start):
    designs, count = results.shape[0], results.shape[2]
    words = np.zeros((count + 7) // 8, np.uint64)
    marks, places, work = words.view(np.uint8), np.empty(2 * count, np.int64), np.empty((4, {2 * REACH + 1}))
    for design in range(designs):
        for k in range(rows.size):
            if kinds[k] >= 0:
                values = results[design, rows[k]]
                numbers[k, start + design], rough[k, start + design] = estimated(
                    values, kinds[k], turns, marks, words, places, work
                )


@njit(**options)
def closed(results, first, angle, gaps, nearest, start):
    designs, count = results.shape[0], results.shape[2]
    for design in range(designs):
        close = 0
        for row in range(first, results.shape[1]):
            for value in results[design, row]:
                close += not value >= {NEAR!r}
        if close == 0:
            continue
        gaping, least = 0, inf
        for i in range(count):
            closes = True
            for row in range(first, results.shape[1]):
                value = results[design, row, i]
                closes &= value >= {-ROUNDING!r}
                if value < least:
                    least = value
                    nearest[start + design] = angle[i]
            gaping += not closes
        gaps[start + design] = gaping
        if gaping:
            nearest[start + design] = nan


@njit("void(Array(float64, 3, 'C'), int64[::1], int64[::1], int64, float64[::1], int64, float64[:, ::1],"
      "boolean[:, ::1], int64[::1], float64[::1], int64)", cache=KEEP, **options)
def passes(results, rows, kinds, first, angle, turns, numbers, rough, gaps, nearest, start):
    reduced(results, rows, kinds, turns, numbers, rough, start)
    closed(results, first, angle, gaps, nearest, start)
'''


class Passes:
    """Outputs reduced from blocks of values.

    Parameters
    ----------
    outputs : sequence of Output
    rows : sequence of int
        Row of the quantity of each.
    first : int
        Row where closure begins, which goes on to the last.
    angle : array (N,)
    turns : int
    """

    def __init__(self, outputs, rows, first, angle, turns):
        kinds = [KINDS.index(item.reduction) if item.reduction in KINDS else -1 for item in outputs]
        self._passes, self._turns = compiled._loaded(SOURCE).passes, turns
        self._given = (
            np.array(rows, dtype=np.int64),
            np.array(kinds, dtype=np.int64),
            int(first),
            np.array(angle),
            turns,
        )
        self._others = [(k, item, rows[k]) for k, item in enumerate(outputs) if kinds[k] < 0]

    def __call__(self, results, start, numbers, rough, gaps, nearest):
        """Fill in, from a design on, what results (designs, rows, N) tell.

        That is numbers (outputs, designs), whether so many angles do not tell them, at how many angles a design does
        not close, and the angle at which it is nearest to a limit position, left as it is where it is not near.
        """
        self._passes(results, *self._given, numbers, rough, gaps, nearest, start)
        for k, item, row in self._others:
            part = slice(start, start + len(results))
            numbers[k, part], rough[k, part] = item.estimated(results[:, row], self._turns)

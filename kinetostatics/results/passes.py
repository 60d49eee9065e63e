"""Reductions of many designs in one pass each, as machine code by numba: the same numbers as `reductions` to rounding.

A loop over designs leaves its values in the cache; here they are reduced before they leave it. What depends on a
design is written for it alone, so that it does not matter which designs come together.
"""

from functools import cache

import numpy as np

from ..engines import compiled, scanning
from ..engines.vectors import edition
from ..numbers.elementary import ROUNDING
from .peaks import INNER, REACH, THROUGH, TINY
from .reductions import MEAN, PEAK
from .turn import NEAR

EXTREMES = ("largest", "largest_at", "smallest", "smallest_at", "largest_absolute", "range")
KINDS = (*EXTREMES, "mean", "mean_absolute", "rms")
"""Reductions that are there, by their number; harmonics and the swing are not."""


CURVE, SERIES, SLOPE, CHANGE = (
    [f"{name}{k}" for k in range(2 * REACH + 1 - less)]
    for name, less in (("curve", 0), ("series", 0), ("slope", 1), ("change", 2))
)
"""Names of samples about a peak, of coefficients of the polynomial through them, of its slope, of its slope's slope."""


def _lines(lines, indent=4):
    return f"\n{' ' * indent}".join(lines)


def _polynomial(series):
    """Expression of a polynomial at `place`, from names or numbers of its coefficients.

    Even and odd powers apart, which wait for each other half as long.
    """
    even, odd = (_nested(series[first::2]) for first in (0, 1))
    return f"({even} + {odd} * place)"


def _nested(series):
    *others, value = series
    for number in reversed(others):
        value = f"({number} + {value} * square)"
    return value


def _through_samples():
    """Lines that find the place of the top of the polynomial through samples, by two of Newton's steps.

    Even powers come from sums of samples as far on either side, odd ones from differences.
    """
    for k in range(1, REACH + 1):
        before, after = CURVE[REACH - k], CURVE[REACH + k]
        yield f"sum{k}, less{k} = {after} + {before}, {after} - {before}"
    for power, (name, row) in enumerate(zip(SERIES, THROUGH[:, REACH:].tolist(), strict=True)):
        own = [CURVE[REACH], *(f"{'less' if power % 2 else 'sum'}{k}" for k in range(1, REACH + 1))]
        yield f"{name} = {' + '.join(f'{part!r} * {sample}' for part, sample in zip(row, own, strict=True) if part)}"
    for above, below in ((SERIES, SLOPE), (SLOPE, CHANGE)):
        yield from (f"{name} = {above[k]} * {k}.0" for k, name in enumerate(below, 1))
    yield from [SQUARE, f"place -= {_polynomial(SLOPE)} / {_polynomial(CHANGE)}"] * 2


SQUARE = "square = place * place"
SOURCE = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import inf, nan, pi, sqrt

import numpy as np
from kinetostatics.engines import scanning
from numba import njit

options = dict(error_model="numpy", nogil=True)
rising = scanning.bits_where(scanning.rising, 3)
falling = scanning.bits_where(scanning.falling, 3)
changing = scanning.bits_where(scanning.changing, 2)
lowest = scanning.lowest_bit()
plain = scanning.summing(lambda value: value)
sizes = scanning.summing(abs)
squares = scanning.summing(lambda value: value * value)
ONE = np.uint64(1)


@njit(**options)
def wrapped(values, i):
    return values[i + values.size if i < 0 else i - values.size if i >= values.size else i]


@njit(**options)
def through({", ".join(CURVE)}, place):
    """Top of the polynomial through samples, where it is, and how much lower it is with two samples fewer."""
    {_lines(_through_samples())}
    {SQUARE}
    top = {_polynomial(SERIES)}
    return place, top, {_polynomial(INNER.coef.tolist())} * ({SERIES[-2]} + {SERIES[-1]} * place)


@njit(**options)
def between(values, at, side):
    """Height of a peak, how far from its highest sample, and about how much the height may be wrong."""
    {_lines(f"{name} = side * wrapped(values, at + {k - REACH})" for k, name in enumerate(CURVE))}
    above = {" & ".join(f"({name} >= 0.0)" for name in CURVE)}
    below = {" & ".join(f"({name} <= 0.0)" for name in CURVE)}
    sign = 1.0 if above else -1.0 if below else 0.0
    if sign != 0.0:
        {_lines((f"{name} *= abs({name})" for name in CURVE), 8)}
    before, here, after = {CURVE[REACH - 1]}, {CURVE[REACH]}, {CURVE[REACH + 1]}
    bend = (after - here) - (here - before)
    first = (here - before) - (before - {CURVE[REACH - 2]})
    last = ({CURVE[REACH + 2]} - after) - (after - here)
    shift, found, other = 0.0, here, here + abs(bend)
    if first < 0.0 and bend < 0.0 and last < 0.0:
        shift = 0.5 * (before - after) / bend
        found = here - 0.25 * (before - after) * shift
        place, top, less = through({", ".join(CURVE)}, shift)
        other = top
        if abs(top - found) < 0.05 * abs(bend) and abs(place) < 1.0:
            found, shift, other = top, place, top - less
    error = abs(found - other)
    if sign == 0.0:
        return found, shift, error
    height = sign * sqrt(max(sign * found, 0.0))
    return height, shift, error / max(max(abs(height), sqrt(error)), {TINY!r})


@njit(**options)
def peaks(values, side, words, places):
    """How many peaks values times a sign have, whose places it fills in, and whether all values are numbers.

    There is at least one, of what is constant the first sample.
    """
    if side > 0.0:
        rising(values, words)
    else:
        falling(values, words)
    count, found = values.size, 0
    first, second, last = side * values[0], side * values[1], side * values[count - 1]
    whole = first == first and last == last
    if first > last and not second > first:
        places[0] = 0
        found = 1
    for k in range((count + 61) // 64):
        word = words[k]
        while word:
            places[found] = 64 * k + lowest(word) + 1
            whole &= values[places[found]] == values[places[found]]
            found += 1
            word &= word - ONE
    if last > side * values[count - 2] and not first > last:
        places[found] = count - 1
        found += 1
    if found == 0:
        places[0] = 0
        found = 1
    return found, whole


@njit(**options)
def peak(values, side, words, places):
    """Highest peak of values times a sign, where, in samples, and about how far off; none if a value is no number."""
    found, whole = peaks(values, side, words, places)
    if not whole:
        return nan, nan, 0.0
    count, bound, best = values.size, -inf, -inf
    for k in range(found):
        i = places[k]
        before, after = side * values[i - 1 if i else count - 1], side * values[i + 1 if i + 1 < count else 0]
        here = side * values[i]
        bound = max(bound, here - abs(before - 2.0 * here + after))
        best = max(best, here)
    around = side * values[0] == best and side * values[count - 1] == best
    if around:  # a plateau goes on across the end of the turn, and its first sample counts too
        bound = max(bound, best - abs(side * values[1] - best))
    highest, where, worst = -inf, nan, 0.0
    for k in range(found + around):
        i = places[k] if k < found else 0
        before, after = side * values[i - 1 if i else count - 1], side * values[i + 1 if i + 1 < count else 0]
        here = side * values[i]
        if here + abs(before - 2.0 * here + after) < bound:
            continue
        height, shift, error = between(values, i, side)
        worst = max(worst, error)
        if height > highest or (height == highest and i + shift < where) or where != where:
            highest, where = height, i + shift
    where += count if where < 0.0 else -count if where >= count else 0
    return highest, where, worst


@njit(**options)
def kink(values, i, j):
    """What the sum of sizes is too large by if the sign changes from one sample to another (`reductions._kinks`)."""
    one, other = wrapped(values, i), wrapped(values, j)
    if (one < 0.0) == (other < 0.0):
        return 0.0
    here, there = abs(one), abs(other)
    return here * there / (here + there) - (here + there) / 6.0


@njit(**options)
def kinks(values, words):
    """The same of all samples, and of every other."""
    changing(values, words)
    count, whole, half = values.size, 0.0, 0.0
    if (values[0] < 0.0) != (values[count - 1] < 0.0):
        whole, half = kink(values, -1, 0), kink(values, -2, 0)
    for k in range((count + 62) // 64):
        word = words[k]
        while word:
            i = 64 * k + lowest(word) + 1
            word &= word - ONE
            whole += kink(values, i - 1, i)
            half += kink(values, i - 1, i + 1) if i % 2 else kink(values, i - 2, i)
    return whole, half


@njit(**options)
def averaged(values, power, words):
    """Mean, of sizes or squares too, and how far that of every other value is from it."""
    even, odd = plain(values) if power == 0 else sizes(values) if power == 1 else squares(values)
    whole, half = even + odd, even
    if power == 1:
        more, some = kinks(values, words)
        whole, half = whole - more, half - some
    whole, half = whole / values.size, half / (values.size // 2)
    if power == 2:
        whole, half = sqrt(whole), sqrt(half)
    return whole, abs(half - whole) if values.size % 2 == 0 else 0.0 * whole


@njit(**options)
def estimated(values, kind, turns, words, places):
    """Number, and whether so many samples do not tell it."""
    if kind >= 6:
        found, error = averaged(values, kind - 6, words)
        if not error > {MEAN!r} * abs(found):
            return found, False
        size = 0.0
        for value in values:
            size = max(size, abs(value))
        return found, error > {MEAN / 10!r} * size
    high, low, above, below, at, under = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if kind <= 1 or kind >= 4:
        high, at, above = peak(values, 1.0, words, places)
    if kind >= 2:
        low, under, below = peak(values, -1.0, words, places)
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
    words, places = np.empty(count // 64 + 1, np.uint64), np.empty(count, np.int64)
    for design in range(designs):
        for k in range(rows.size):
            if kinds[k] >= 0:
                values = results[design, rows[k]]
                numbers[k, start + design], rough[k, start + design] = estimated(
                    values, kinds[k], turns, words, places
                )


@njit(**options)
def closed(results, first, angle, gaps, nearest, start):
    designs, count = results.shape[0], results.shape[2]
    for design in range(designs):
        close = False
        for row in range(first, results.shape[1]):
            for i in range(count):
                close |= not results[design, row, i] >= {NEAR!r}
        if not close:
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


@cache
def _source():
    """The source with the edition of what writes it, so that machine code of another is not taken for its own."""
    return SOURCE.replace("kinetostatics;", f"kinetostatics, edition {edition(scanning)};", 1)


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
        self._passes, self._turns = compiled.loaded(_source()).passes, turns
        places, numbers = np.array(rows, dtype=np.int64), np.array(kinds, dtype=np.int64)
        self._given = places, numbers, int(first), np.array(angle), turns
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

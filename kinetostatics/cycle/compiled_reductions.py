"""Reductions of many designs as machine code by numba: the numbers of `reductions` to rounding.

A program's compiled loop leaves the values of a block of designs in the cache, and this code reduces them there.
The designs of a block do not influence each other.
"""

import numpy as np

from ..engines import numba_backend
from ..engines.codegen import ARGUMENTS, FILLED, GIVEN
from ..engines.simd_reductions import COLUMNS, edition
from ..numbers.arithmetic import SQUARE_TOLERANCE
from . import peaks
from .limit_positions import NEAR
from .peaks import REACH
from .reductions import MEAN_TOLERANCE, PEAK_TOLERANCE

EXTREMES = ("largest", "largest_at", "smallest", "smallest_at", "largest_absolute", "range")
KINDS = (*EXTREMES, "mean", "mean_absolute", "rms")
"""Compiled reductions, by number; harmonics and the swing are none."""
AROUND = 2 * REACH + 1
"""Samples that interpolate a peak."""
LOOP = f"FunctionType({ARGUMENTS})"
"""Type of a program's loop, an argument."""
SOURCE = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import inf, nan, pi, sqrt

import numpy as np
from kinetostatics.engines import simd_reductions
from kinetostatics.cycle.peaks import between
from numba import njit

options = dict(error_model="numpy", nogil=True)
inner = dict(options, _nrt=False)  # no memory is allocated, so no reference is counted
steps = simd_reductions.bits_of_steps(simd_reductions.rising, simd_reductions.falling)
signs = simd_reductions.bits_of_steps(simd_reductions.negative)
lowest = simd_reductions.lowest_bit()
heights = simd_reductions.over_columns(between, {AROUND})
plain = simd_reductions.summing(lambda value: value)
sizes = simd_reductions.summing(abs)
squares = simd_reductions.summing(lambda value: value * value)
ONE, SIXTY_THREE = np.uint64(1), np.uint64(63)


@njit(**inner)
def value(results, design, row, i):
    """Value at an index that may lie a little beyond either end of the turn."""
    count = results.shape[2]
    return results[design, row, i + count if i < 0 else i - count if i >= count else i]


@njit(**inner)
def bend(results, design, row, i):
    before, after = value(results, design, row, i - 1), value(results, design, row, i + 1)
    return abs(before - 2.0 * results[design, row, i] + after)


@njit(**inner)
def after(words, k, count):
    """Bits of word k, each replaced by the next bit; the first bit of all follows the last."""
    last = (count - 1) // 64
    following = words[k + 1] << SIXTY_THREE if k < last else (words[0] & ONE) << np.uint64((count - 1) % 64)
    return words[k] >> ONE | following


@njit(**inner)
def tops(words, count, places, found):
    """Write into `places`, from index `found` on, where a rise (or fall) ends; returns the new number of places."""
    for k in range((count + 63) // 64):
        word = words[k] & ~after(words, k, count)
        while word:
            place = 64 * k + lowest(word) + 1
            places[found] = place if place < count else 0
            found += 1
            word &= word - ONE
    return found


@njit(**inner)
def rivals(results, design, row, side, words, places, found):
    """Write into `places`, from index `found` on, the peaks that may be the highest; returns the new number of places.

    Side 1 is for the values with the opposite sign.
    """
    sign, last, first = 1.0 - 2.0 * side, results.shape[2] - 1, found
    found = tops(words[side], last + 1, places, found)
    if found == first:  # constant values: the first
        places[found] = 0
        found += 1
    best, bound = -inf, -inf
    for k in range(first, found):
        here = sign * results[design, row, places[k]]
        best, bound = max(best, here), max(bound, here - bend(results, design, row, places[k]))
    if sign * results[design, row, 0] == best and sign * results[design, row, last] == best:
        places[found] = 0  # a plateau continues across the end of the turn: its first sample is a peak too
        found += 1
        bound = max(bound, best - bend(results, design, row, 0))
    kept = first
    for k in range(first, found):
        if not sign * results[design, row, places[k]] + bend(results, design, row, places[k]) < bound:
            places[kept] = places[k]
            kept += 1
    return kept


@njit(**inner)
def peaks(results, row, sides, memory):
    """Highest peaks (2, designs) of values and of the negative values, their places in samples, and error estimates.

    Written into `memory`; NaN where a value is NaN. `sides` is the range of sides. All candidates of all designs are
    collected first, then interpolated together.
    """
    near, owners, places, words, high, where, error = memory
    designs, count, found = results.shape[0], results.shape[2], 0
    error[:] = 0.0
    for design in range(designs):
        steps(results, design, row, words)
        whole = True
        for k in range((count + 63) // 64):
            whole &= words[0, k] & words[1, k] == 0
        for side in range(sides[0], sides[1]):
            high[side, design], where[side, design] = -inf if whole else nan, nan
            if whole:
                first = found
                found = rivals(results, design, row, side, words, places, found)
                for k in range(first, found):
                    owners[k] = 2 * design + side
    for k in range(found):
        design, sign = owners[k] // 2, 1.0 - 2.0 * (owners[k] % 2)
        for i in range({AROUND}):
            near[i, k] = sign * value(results, design, row, places[k] + i - {REACH})
    heights(near, found)
    for k in range(found):
        design, side = owners[k] // 2, owners[k] % 2
        height, place = near[0, k], places[k] + near[1, k]
        error[side, design] = max(error[side, design], near[2, k])
        best, at = high[side, design], where[side, design]
        if height > best or (height == best and place < at) or at != at:
            high[side, design], where[side, design] = height, place
    for side in range(sides[0], sides[1]):
        for design in range(designs):
            at = where[side, design]
            where[side, design] = at + count if at < 0.0 else at - count if at >= count else at


@njit(**inner)
def kink(results, design, row, i, j):
    """Excess of the sum of magnitudes if the sign changes between two samples (`reductions._kink_excess`)."""
    one, other = value(results, design, row, i), value(results, design, row, j)
    if (one < 0.0) == (other < 0.0):
        return 0.0
    here, there = abs(one), abs(other)
    return here * there / (here + there) - (here + there) / 6.0


@njit(**inner)
def kinks(results, design, row, words):
    """Sum of `kink` over all samples, and over every other."""
    signs(results, design, row, words)
    count, whole, half = results.shape[2], 0.0, 0.0
    for k in range((count + 63) // 64):
        word = words[0, k] ^ after(words[0], k, count)
        while word:
            i = 64 * k + lowest(word) + 1
            word &= word - ONE
            whole += kink(results, design, row, i - 1, i)
            half += kink(results, design, row, i - 1 - (i + 1) % 2, i + i % 2)
    return whole, half


@njit(**inner)
def averaged(results, design, row, power, words):
    """Mean of values, magnitudes or squares, and its difference from that of every other value."""
    count = results.shape[2]
    if power == 0:
        even, odd = plain(results, design, row)
    elif power == 1:
        even, odd = sizes(results, design, row)
    else:
        even, odd = squares(results, design, row)
    whole, half = even + odd, even
    if power == 1:
        more, some = kinks(results, design, row, words)
        whole, half = whole - more, half - some
    whole, half = whole / count, half / (count // 2)
    if power == 2:
        whole, half = sqrt(whole), sqrt(half)
    return whole, abs(half - whole) if count % 2 == 0 else 0.0 * whole


@njit(**inner)
def means(results, row, power, memory, numbers, rough):
    words = memory[3]
    for design in range(results.shape[0]):
        found, error = averaged(results, design, row, power, words)
        doubtful = error > {MEAN_TOLERANCE!r} * abs(found)
        if doubtful:
            size = 0.0
            for i in range(results.shape[2]):
                size = max(size, abs(results[design, row, i]))
            doubtful = error > {MEAN_TOLERANCE / 10!r} * size
        numbers[design], rough[design] = found, doubtful


@njit(**inner)
def extremes(results, row, kind, turns, memory, numbers, rough):
    sides = 0 if kind <= 1 or kind >= 4 else 1, 1 if kind <= 1 else 2
    peaks(results, row, sides, memory)
    high, where, error = memory[4:]
    for design in range(results.shape[0]):
        above, below = high[0, design], -high[1, design]
        off = max(error[0, design], error[1, design])
        if kind == 1 or kind == 3:
            size = above if kind == 1 else below
            found = where[kind // 2, design] * (2.0 * pi / results.shape[2]) * turns
            doubtful = off > {PEAK_TOLERANCE!r} * abs(size)
        else:
            found = above if kind == 0 else below if kind == 2 else max(above, -below) if kind == 4 else above - below
            doubtful = off > {PEAK_TOLERANCE!r} * abs(found)
            if doubtful:
                least, most = inf, -inf
                for i in range(results.shape[2]):
                    least, most = min(least, results[design, row, i]), max(most, results[design, row, i])
                doubtful = off > {PEAK_TOLERANCE / 100!r} * (most - least)
        numbers[design], rough[design] = found, doubtful


@njit(**inner)
def reduced(results, rows, kinds, turns, memory, numbers, rough, start):
    stop = start + results.shape[0]
    for k in range(rows.size):
        if kinds[k] >= {len(EXTREMES)}:
            power = kinds[k] - {len(EXTREMES)}
            means(results, rows[k], power, memory, numbers[k, start:stop], rough[k, start:stop])
        elif kinds[k] >= 0:
            extremes(results, rows[k], kinds[k], turns, memory, numbers[k, start:stop], rough[k, start:stop])


@njit(**inner)
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
                closes &= value >= {-SQUARE_TOLERANCE!r}
                if value < least:
                    least = value
                    nearest[start + design] = angle[i]
            gaping += not closes
        gaps[start + design] = gaping
        if gaping:
            nearest[start + design] = nan


@njit("void({LOOP}, {", ".join([GIVEN] * 5).format(2, 2, 2, 2, 3)}, {FILLED.format(3)}, int64[::1], int64[::1], int64,"
      "int64, float64[:, ::1], boolean[:, ::1], int64[::1], float64[::1], int64, int64)", cache=KEEP, **options)
def passes(
    loop, angle, sine, cosine, parameters, tables, held, rows, kinds, first, turns, numbers, rough, gaps, nearest,
    start, stop,
):
    step, count = held.shape[0], angle.shape[1]
    many = {COLUMNS} * (2 * step * (count // 2 + 2) // {COLUMNS} + 1)
    near, owners, places = np.empty(({AROUND}, many)), np.empty(many, np.int64), np.empty(many, np.int64)
    words = np.empty((2, count // 64 + 1), np.uint64)
    memory = near, owners, places, words, np.empty((2, step)), np.empty((2, step)), np.empty((2, step))
    while start < stop:
        end = min(start + step, stop)
        results = held[: end - start]
        if tables.shape[1] > 1:
            loop(angle, sine, cosine, parameters[start:end], tables[:, start:end].copy(), results.ravel())
        else:
            loop(angle, sine, cosine, parameters[start:end], tables, results.ravel())
        reduced(results, rows, kinds, turns, memory, numbers, rough, start)
        closed(results, first, angle[0], gaps, nearest, start)
        start = end
'''


class CompiledReductions:
    """Outputs of many designs by one compiled loop, which computes and reduces block by block.

    Parameters
    ----------
    outputs : sequence of Output
    rows : sequence of int
        Row of the quantity of each.
    first : int
        First row of the closure, which extends to the last row.
    turns : int
        Turns of the crank angles.
    """

    def __init__(self, outputs, rows, first, turns):
        kinds = [KINDS.index(item.reduction) if item.reduction in KINDS else -1 for item in outputs]
        source = SOURCE.replace("kinetostatics;", f"kinetostatics, edition {edition(peaks)};", 1)
        self._run, self._turns = numba_backend.load_compiled(source).passes, turns
        self._given = np.array(rows, dtype=np.int64), np.array(kinds, dtype=np.int64), int(first), turns
        self._others = [(k, item, rows[k]) for k, item in enumerate(outputs) if kinds[k] < 0]

    def __call__(self, loop, given, memory, found, start, stop):
        """Write the results of some designs.

        Parameters
        ----------
        loop, given
            A program's loop (`numba_backend`) and its arguments for all designs: crank angles with their sines and
            cosines, parameters, tables.
        memory : array (designs, rows, N)
            Buffer for the values of a block.
        found : tuple
            Written: numbers (outputs, designs); whether the samples are too few for them; the number of angles at which
            a design does not close; the angle nearest to a limit position, if one is near.
        start, stop : int
        """
        step = len(memory) if self._others else max(1, stop - start)
        for first in range(start, stop, step):
            last = min(first + step, stop)
            self._run(loop, *given, memory, *self._given, *found, first, last)
            for k, item, row in self._others:
                numbers, rough = (part[k, first:last] for part in found[:2])
                numbers[...], rough[...] = item.estimated(memory[: last - first, row], self._turns)

"""Peaks of evenly spaced values of many designs, interpolated between the samples; scratch memory for reductions."""

import math
import operator
import threading
from functools import reduce

import numpy as np
from numpy.polynomial import polynomial

REACH = 4
"""Samples on either side of a peak that interpolate its height."""
SCRATCH = 2**18
"""Bytes of the scratch buffer of a thread."""
TINY = np.finfo(float).tiny
_own = threading.local()
_AROUND = np.arange(-REACH, REACH + 1)
INNER = polynomial.polyfromroots(_AROUND[1:-1]).tolist()
"""Coefficients of the polynomial that vanishes at all samples around a peak except the outermost two."""
COMPARED = {"<": operator.lt, "<=": operator.le, "==": operator.eq, ">=": operator.ge}
_WHOLE = math.factorial(2 * REACH)
THROUGH = np.round(np.linalg.inv(np.vander(_AROUND.astype(float), increasing=True)) * _WHOLE) / _WHOLE
"""Coefficients of the polynomial through samples; whole numbers over a factorial, so rounded once."""


def peak(values, sign=1.0):
    """Largest interpolated value, times a sign, of each design, its place in periods, and an estimate of its error."""
    count = values.shape[-1]
    tops = [first * count + _tops(some, sign) for first, some in blocks(values, 2)]
    design, place = np.divmod(np.concatenate(tops), count)
    if count < _AROUND.size:
        height, shift = sign * values[design, place], 0.0 * place
        error = height
    else:
        # a peak is above its sample by less than the sample is above its neighbours
        before, here, after = sign * _around(values, design, place, 1)
        bend = abs(before - 2.0 * here + after)
        rivals = ~(here + bend < _highest(here - bend, design, len(values))[design])
        design, place = design[rivals], place[rivals]
        height, shift, error = _interpolate(sign * _around(values, design, place, REACH))
    highest = _highest(height, design, len(values))
    _, first = np.unique(np.where(height < highest[design], -1, design), return_index=True)
    first = first[-len(values) :]
    where = ((place + shift)[first] % count) / count
    return highest, np.where(np.isnan(highest), np.nan, where), _highest(error, design, len(values))


def _tops(values, sign):
    """Flat indices of samples higher than the one before and not lower than the next, and of each first highest one."""
    higher, highest = (np.greater, np.argmax) if sign > 0 else (np.less, np.argmin)
    rising, tops = scratch(bool, 2, *values.shape)
    higher(values[:, 1:], values[:, :-1], out=rising[:, 1:])
    higher(values[:, 0], values[:, -1], out=rising[:, 0])
    np.greater(rising[:, :-1], rising[:, 1:], out=tops[:, :-1])
    np.greater(rising[:, -1], rising[:, 0], out=tops[:, -1])
    tops[np.arange(len(values)), highest(values, axis=-1)] = True
    return np.flatnonzero(tops)


def _around(values, design, place, reach):
    return values[design, (place + np.arange(-reach, reach + 1)[:, None]) % values.shape[-1]]


def _highest(height, design, count):
    """Highest of the peaks of each design; `design` rises."""
    return np.maximum.reduceat(height, np.searchsorted(design, np.arange(count)))


def _interpolate(near):
    """`between` for samples as arrays (places, peaks)."""

    def chosen(sign, one, other, here, there):
        return np.where(COMPARED[sign](one, other), here, there)

    with np.errstate(all="ignore"):
        return between(list(near), chosen, np.sqrt)


def between(near, chosen, sqrt):
    """Height of each peak, its distance from the highest sample, and an estimate of the error of the height.

    The height follows from the polynomial through all samples; from the parabola through three where the others do not
    fit, as beyond a jump; or from the sample itself. Values of one sign may be a magnitude with a corner at zero; their
    squares are interpolated. The error is the difference from a polynomial with two samples less.

    Parameters
    ----------
    near : sequence of operand
        Samples in order: arrays, or vectors that record their operations (`engines.simd_reductions`).
    chosen : function
        ``chosen(sign, one, other, here, there)``: `here` where ``one sign other`` holds, else `there`.
    sqrt : function
    """

    def larger(one, other):
        return chosen("<", one, other, other, one)

    least, most = reduce(lambda one, other: chosen("<", other, one, other, one), near), reduce(larger, near)
    sign = chosen(">=", least, 0.0, 1.0, chosen("<=", most, 0.0, -1.0, 0.0))
    curve = [chosen("==", sign, 0.0, sample, sample * abs(sample)) for sample in near]
    before, here, after = curve[REACH - 1 : REACH + 2]
    bend = (after - here) - (here - before)
    first = (here - before) - (before - curve[REACH - 2])
    last = (curve[REACH + 2] - after) - (after - here)
    shift = 0.5 * (before - after) / bend
    height = here - 0.25 * (before - after) * shift
    series = list(_series(curve))
    slope = [power * number for power, number in enumerate(series)][1:]
    change = [power * number for power, number in enumerate(slope)][1:]
    place = shift
    for _ in range(2):
        place = place - _polynomial(slope, place) / _polynomial(change, place)
    top = _polynomial(series, place)
    fewer = top - _polynomial(INNER, place) * (series[-2] + series[-1] * place)

    bent = chosen("<", first, 0.0, chosen("<", last, 0.0, bend, 0.0), 0.0)  # false if a neighbour is infinite

    def if_smooth(one, other):
        return chosen("<", bent, 0.0, one, other)

    def if_it_fits(one, other):
        return chosen("<", abs(top - height), 0.05 * abs(bend), chosen("<", abs(place), 1.0, one, other), other)

    found = if_smooth(if_it_fits(top, height), here)
    error = abs(found - if_smooth(if_it_fits(fewer, top), here + abs(bend)))
    size = sqrt(larger(sign * found, 0.0))
    relative = error / larger(larger(size, sqrt(error)), TINY)
    return (
        chosen("==", sign, 0.0, found, sign * size),
        if_smooth(if_it_fits(place, shift), 0.0),
        chosen("==", sign, 0.0, error, relative),
    )


def _series(curve):
    """Yield coefficients of the polynomial through samples, from sums and differences about the middle one."""
    after, before = curve[REACH + 1 :], curve[REACH - 1 :: -1]
    even = [curve[REACH], *(one + other for one, other in zip(after, before, strict=True))]
    odd = [one - other for one, other in zip(after, before, strict=True)]
    for power, (middle, *weights) in enumerate(THROUGH[:, REACH:].tolist()):
        terms = zip(weights, odd, strict=True) if power % 2 else zip([middle, *weights], even, strict=True)
        yield reduce(operator.add, (weight * part for weight, part in terms if weight))


def _polynomial(series, place):
    """Polynomial; even and odd powers run in parallel."""
    square = place * place
    even, odd = (reduce(lambda value, number: number + value * square, reversed(series[k::2])) for k in (0, 1))
    return even + odd * place


def lowest(values, step):
    """Smallest interpolated value of each row (designs, N), its distance from the middle, and the second derivative."""
    row, reach = np.arange(len(values)), values.shape[-1] // 2
    place = np.clip(values.argmin(axis=-1), REACH, values.shape[-1] - 1 - REACH)
    near = values[row, place + _AROUND[:, None]]
    bend = (near[REACH - 1] - 2.0 * near[REACH] + near[REACH + 1]) / (step * step)
    height, shift, _ = _interpolate(1.0 - near)  # margins are at most 1, so these do not change their sign
    return np.minimum(1.0 - height, near.min(axis=0)), (place + shift - reach) * step, bend


def blocks(values, size):
    """Blocks of designs, as (first design, values), that fit the scratch buffer with `size` bytes a value."""
    step = max(1, SCRATCH // (size * values.shape[-1]))
    return [(first, values[first : first + step]) for first in range(0, len(values), step)]


def scratch(kind, *shape):
    """Scratch buffer, reused per thread: allocating costs more than the computation."""
    size = math.prod(shape) * np.dtype(kind).itemsize
    if size > SCRATCH:
        return np.empty(shape, kind)
    if not hasattr(_own, "scratch"):
        _own.scratch = np.empty(SCRATCH, np.uint8)
    return _own.scratch[:size].view(kind).reshape(shape)

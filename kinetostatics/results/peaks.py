"""Peaks of evenly spaced values of many designs, between the samples, and memory for what is soon forgotten."""

import math
import operator
import threading
from functools import reduce

import numpy as np
from numpy.polynomial import polynomial

REACH = 4
"""Samples on either side of a peak that tell how high it is between them."""
SCRATCH = 2**18
"""Bytes of memory for short use that each thread keeps."""
TINY = np.finfo(float).tiny
_own = threading.local()
_AROUND = np.arange(-REACH, REACH + 1)
INNER = polynomial.polyfromroots(_AROUND[1:-1]).tolist()
"""Coefficients of the polynomial that vanishes at all samples around a peak but the outermost two."""
COMPARED = {"<": operator.lt, "<=": operator.le, "==": operator.eq, ">=": operator.ge}
_WHOLE = math.factorial(2 * REACH)
THROUGH = np.round(np.linalg.inv(np.vander(_AROUND.astype(float), increasing=True)) * _WHOLE) / _WHOLE
"""Coefficients of the polynomial through samples, from them; whole numbers over a factorial, so the nearest to them."""


def peak(values, sign=1.0):
    """Largest value, times a sign, of each design: of all peaks of the samples the highest between them.

    Also where it is, in periods, and about how much it may be wrong.
    """
    count = values.shape[-1]
    tops = [first * count + _tops(some, sign) for first, some in pieces(values, 2)]
    design, place = np.divmod(np.concatenate(tops), count)
    if count < _AROUND.size:
        height, shift = sign * values[design, place], 0.0 * place
        error = height
    else:
        rivals = _rivals(sign * _around(values, design, place, 1), design, len(values))
        design, place = design[rivals], place[rivals]
        height, shift, error = _between(sign * _around(values, design, place, REACH))
    highest = _highest(height, design, len(values))
    _, first = np.unique(np.where(height < highest[design], -1, design), return_index=True)
    first = first[-len(values) :]
    where = ((place + shift)[first] % count) / count
    return highest, np.where(np.isnan(highest), np.nan, where), _highest(error, design, len(values))


def _tops(values, sign):
    """Places of samples higher than the one before and not lower than the one behind, or the first highest of all."""
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


def _rivals(near, design, count):
    """Which peaks may be the highest of a design; one rises above its sample by less than that above its neighbours."""
    before, here, after = near
    bend = abs(before - 2.0 * here + after)
    return ~(here + bend < _highest(here - bend, design, count)[design])


def _highest(height, design, count):
    """Highest of the peaks of each design, which stand one design after the other."""
    return np.maximum.reduceat(height, np.searchsorted(design, np.arange(count)))


def _between(near):
    """The same as `between`, of samples as arrays (places, peaks)."""
    with np.errstate(all="ignore"):
        return between(list(near), _chosen, np.sqrt)


def _chosen(sign, one, other, here, there):
    return np.where(COMPARED[sign](one, other), here, there)


def between(near, chosen, sqrt):
    """Height of each peak, how far from its highest sample, and about how much the height may be wrong.

    From the samples around it, one after the other, by the polynomial through all of them, by the parabola through
    three if others spoil it, as beyond a jump, and that of the sample if not even three go together. What does not
    change its sign may be a magnitude, which has a corner at zero, but its square has none. About how much the height
    may be wrong is what two samples less make of it.

    Parameters
    ----------
    near : sequence of operand
        Arrays, or vectors that write down what is done to them (`engines.simd_reductions`).
    chosen : function
        ``chosen(sign, one, other, here, there)``: `here` where two operands compare so, else `there`.
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

    bent = chosen("<", first, 0.0, chosen("<", last, 0.0, bend, 0.0), 0.0)  # beside what is infinite one is none

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
    """Coefficients of the polynomial through samples, from their sums and differences on either side of the middle."""
    after, before = curve[REACH + 1 :], curve[REACH - 1 :: -1]
    even = [curve[REACH], *(one + other for one, other in zip(after, before, strict=True))]
    odd = [one - other for one, other in zip(after, before, strict=True)]
    for power, (middle, *weights) in enumerate(THROUGH[:, REACH:].tolist()):
        terms = zip(weights, odd, strict=True) if power % 2 else zip([middle, *weights], even, strict=True)
        yield reduce(operator.add, (weight * part for weight, part in terms if weight))


def _polynomial(series, place):
    """Polynomial from its coefficients: even and odd powers apart, which wait for each other half as long."""
    square = place * place
    even, odd = (reduce(lambda value, number: number + value * square, reversed(series[k::2])) for k in (0, 1))
    return even + odd * place


def lowest(values, step):
    """Smallest of values (designs, N) a step apart, between them; how far it is from the middle one; the bend there.

    The bend is the second derivative.
    """
    row, reach = np.arange(len(values)), values.shape[-1] // 2
    place = np.clip(values.argmin(axis=-1), REACH, values.shape[-1] - 1 - REACH)
    near = values[row, place + _AROUND[:, None]]
    bend = (near[REACH - 1] - 2.0 * near[REACH] + near[REACH + 1]) / (step * step)
    height, shift, _ = _between(1.0 - near)  # no margin exceeds 1, so that none of these changes its sign
    return np.minimum(1.0 - height, near.min(axis=0)), (place + shift - reach) * step, bend


def pieces(values, size):
    """Number of the first design, and values, of some designs at a time that take one scratch at that size a value."""
    step = max(1, SCRATCH // (size * values.shape[-1]))
    return [(first, values[first : first + step]) for first in range(0, len(values), step)]


def scratch(kind, *shape):
    """Memory for what is soon forgotten, the same each time: to get new one may take longer than to use it."""
    size = math.prod(shape) * np.dtype(kind).itemsize
    if size > SCRATCH:
        return np.empty(shape, kind)
    if not hasattr(_own, "scratch"):
        _own.scratch = np.empty(SCRATCH, np.uint8)
    return _own.scratch[:size].view(kind).reshape(shape)

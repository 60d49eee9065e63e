"""Peaks of evenly spaced values of many designs, between the samples, and memory for what is soon forgotten."""

import math
import threading

import numpy as np
from numpy.polynomial import polynomial

REACH = 4
"""Samples on either side of a peak that tell how high it is between them."""
SCRATCH = 2**18
"""Bytes of memory for short use that each thread keeps."""
TINY = np.finfo(float).tiny
_own = threading.local()
_AROUND = np.arange(-REACH, REACH + 1)
_POWERS = np.arange(_AROUND.size)[:, None]
INNER = polynomial.Polynomial.fromroots(_AROUND[1:-1])
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
    """Height of each peak, and how far from its highest sample, from the samples around it (places, peaks).

    By the polynomial through all of them, by the parabola through three if others spoil it, as beyond a jump, and that
    of the sample if not even three go together. What does not change its sign may be a magnitude, which has a corner at
    zero, but its square has none. About how much the height may be wrong is what two samples less make of it.
    """
    sign = np.where((near >= 0).all(axis=0), 1.0, np.where((near <= 0).all(axis=0), -1.0, 0.0))
    curve = np.where(sign == 0, near, near * abs(near))
    _, bend, _ = bends = np.diff(curve[REACH - 2 : REACH + 3], 2, axis=0)
    before, here, after = curve[REACH - 1 : REACH + 2]
    with np.errstate(all="ignore"):
        shift = 0.5 * (before - after) / bend
        height = here - 0.25 * (before - after) * shift
        series = sum(weights[:, None] * sample for weights, sample in zip(THROUGH.T, curve, strict=True))
        slope = series[1:] * _POWERS[1:]
        change = slope[1:] * _POWERS[1:-1]
        place = shift
        for _ in range(2):
            place = place - polynomial.polyval(place, slope, tensor=False) / polynomial.polyval(place, change, False)
        top = polynomial.polyval(place, series, tensor=False)
        fits = (abs(top - height) < 0.05 * abs(bend)) & (abs(place) < 1)
        fewer = top - INNER(place) * (series[-2] + series[-1] * place)
    smooth = (bends < 0).all(axis=0)
    other = np.where(smooth, np.where(fits, fewer, top), here + abs(bend))
    found = np.where(smooth, np.where(fits, top, height), here)
    height = np.where(sign == 0, found, sign * np.sqrt(np.maximum(sign * found, 0.0)))
    error = abs(found - other)
    error = np.where(sign == 0, error, error / np.maximum(np.maximum(abs(height), np.sqrt(error)), TINY))
    return height, np.where(smooth, np.where(fits, place, shift), 0.0), error


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

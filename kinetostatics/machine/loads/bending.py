"""Rows at which a table bends, or jumps, and does not just run as a smooth curve does that fine rows are read off."""

from bisect import bisect_left
from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from .period import TURN

STRAIGHT = 1e-5
"""Share of the largest value by which a table may be off a polynomial and bend nothing that one would see."""
DEGREE = 5
"""Of these polynomials: less than those have that reductions take."""
AROUND = 32
"""Stretches in half a turn, or in a table over travel, on which a smooth curve is such a polynomial."""
PLACES = chebyshev.chebpts1(32)
"""Places on a stretch, from -1 to 1, of which the polynomial is made: so that it swings nowhere, however rows lie."""
SERIES = np.linalg.pinv(chebyshev.chebvander(PLACES, DEGREE))
"""Coefficients of the polynomial from values at these."""


@lru_cache(maxsize=256)
def bending(table):
    """Rows at which a table bends; over the travel inner ones."""
    found = _around(table.x, table.y, table.period) if table.over == "angle" else _along(table.x, table.strokes)
    found.setflags(write=False)
    return found


def is_bent(table):
    """Whether a table bends, or may jump where a slider turns back."""
    return table.back is not None or bending(table).size > 0


def _along(x, strokes):
    joints = _joints(x, strokes, 0, x.size - 1)
    return _sharp(x, strokes, joints, (x[-1] - x[0]) / AROUND)


def _around(angle, value, period):
    """Of all rows, as they repeat after a period."""
    count = angle.size
    order = (np.arange(count) + int(np.argmax(np.abs(value)))) % count
    around = angle[order] + period * (order < order[0])
    thrice, values = np.concatenate([around - period, around, around + period]), [np.tile(value[order], 3)]
    joints = [count, *_joints(thrice, values, count, 2 * count)]
    return order[_sharp(thrice, values, joints, 0.5 * TURN / AROUND) - count]


def _joints(x, strokes, first, last):
    """Rows between two others at which one longest stretch on which the table is smooth ends, and the next begins."""
    joints, row = [], first
    while (row := _reached(x, strokes, row, last)) < last:
        joints.append(row)
    return joints


def _reached(x, strokes, row, last):
    """Up to which row the table is smooth from one on."""

    def breaks(end):
        return not _is_smooth(x, strokes, x[row], x[end])

    count = 2
    while row + count <= last and not breaks(row + count):
        count *= 2
    ends = range(row + count // 2 + 1, min(row + count, last + 1))
    return ends.start - 1 + bisect_left(ends, True, key=breaks)


def _sharp(x, strokes, joints, reach):
    """Those rows around which no stretch is smooth that reaches so far."""
    sharp = [
        row for row in joints if not _is_smooth(x, strokes, max(x[0], x[row] - reach), min(x[row] + reach, x[-1]))
    ]
    return np.array(sharp, dtype=int)


def _is_smooth(x, strokes, low, high):
    """Whether a polynomial is as near as `STRAIGHT` to all strokes between two places, at rows and besides."""
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    some = slice(np.searchsorted(x, low), np.searchsorted(x, high, side="right"))
    besides = middle + half * PLACES
    places = np.concatenate([PLACES, (x[some] - middle) / half])
    room = STRAIGHT * max(np.abs(y).max() for y in strokes)
    for y in strokes:
        values = np.interp(besides, x, y)
        found = chebyshev.chebval(places, SERIES @ values)
        if np.abs(found - np.concatenate([values, y[some]])).max() > room:
            return False
    return True

"""Rows at which a table bends, or jumps, and does not just run as a smooth curve does that fine rows are read off."""

from bisect import bisect_left
from functools import lru_cache
from typing import Any, NamedTuple

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


@lru_cache(maxsize=32)
def bending(table, straight=STRAIGHT):
    """Rows at which a table bends by more than a share of its largest value; over the travel inner ones."""
    room = straight * abs(table.largest)
    if table.over == "angle":
        return _around(table.x, table.y, table.period, room)
    curve = Curve(table.x, table.strokes, room)
    return curve.sharp(curve.joints(0, table.x.size - 1), (table.x[-1] - table.x[0]) / AROUND)


def left_out(table, straight=STRAIGHT):
    """Share of its largest value by which a table bends at the rows that count as straight, one by one."""
    x, strokes = table.x, table.strokes
    if table.over == "angle":
        x, strokes = (
            np.concatenate([x[-1:] - table.period, x, x[:1] + table.period]),
            [np.concatenate([y[-1:], y, y[:1]]) for y in strokes],
        )
    share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    off = np.abs([y[1:-1] - y[:-2] - share * (y[2:] - y[:-2]) for y in strokes]).max(axis=0)
    inner = off if table.over == "angle" else np.pad(off, 1)
    return float(np.delete(inner, bending(table, straight)).max(initial=0.0) / (abs(table.largest) or 1.0))


def _around(angle, value, period, room):
    """Of all rows, as they repeat after a period."""
    count = angle.size
    order = (np.arange(count) + int(np.argmax(np.abs(value)))) % count
    around = angle[order] + period * (order < order[0])
    curve = Curve(np.concatenate([around - period, around, around + period]), [np.tile(value[order], 3)], room)
    joints = [count, *curve.joints(count, 2 * count)]
    return order[curve.sharp(joints, 0.5 * TURN / AROUND) - count]


class Curve(NamedTuple):
    """Rows of one or two strokes, and how far they may be off what is smooth."""

    x: Any
    strokes: Any
    room: float

    def joints(self, first, last):
        """Rows between two others at which one longest smooth stretch ends, and the next begins."""
        found, row = [], first
        while (row := self._reached(row, last)) < last:
            found.append(row)
        return found

    def _reached(self, row, last):
        """Up to which row the curve is smooth from one on."""

        def breaks(end):
            return not self._is_smooth(self.x[row], self.x[end])

        count = 2
        while row + count <= last and not breaks(row + count):
            count *= 2
        ends = range(row + count // 2 + 1, min(row + count, last + 1))
        return ends.start - 1 + bisect_left(ends, True, key=breaks)

    def sharp(self, rows, reach):
        """Those rows around which no stretch is smooth that reaches so far."""
        x = self.x
        found = [row for row in rows if not self._is_smooth(max(x[0], x[row] - reach), min(x[row] + reach, x[-1]))]
        return np.array(found, dtype=int)

    def _is_smooth(self, low, high):
        """Whether a polynomial is near all strokes between two places, at rows and besides."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        some = slice(np.searchsorted(self.x, low), np.searchsorted(self.x, high, side="right"))
        places = np.concatenate([PLACES, (self.x[some] - middle) / half])
        for y in self.strokes:
            values = np.interp(middle + half * PLACES, self.x, y)
            found = chebyshev.chebval(places, SERIES @ values)
            if np.abs(found - np.concatenate([values, y[some]])).max() > self.room:
                return False
        return True

"""What bounds need to know of a table: its own rounding, and its kinks and jumps."""

import numpy as np

from ...numbers.elementary import UNIT
from . import rows

MORE = 1.0 + 1e-9
"""What a bound is enlarged by for products of roundings."""
TINY = 2.0**-1000
"""More than what a product or quotient too small for a double loses."""


def rounding(table, motion):
    """Bound on the error of values read by crank angle, N or N m.

    A slope has three roundings, the rise along it two more, the sum with the row's value one; a level piece has none.
    Each piece is taken as if all of it were risen. The end of the last one is rounded as well, and a turn more or less
    moves every row, so that another piece may be read where one is near.
    """
    angle, first = np.asarray(motion.crank_angle), table.x[0]
    x, y = np.concatenate([table.x, [first + table.period]]), np.concatenate([table.y, table.y[:1]])
    rise = np.abs(np.diff(y))
    own = np.where(rise == 0.0, 0.0, 5.0 * rise + np.maximum(np.abs(y[1:]), np.abs(y[:-1])))
    if first != 0.0:
        own[-1] += 2.0 * abs(x[-1]) * rise[-1] / (x[-1] - x[-2])
    turned = np.floor((angle - first) / table.period) * table.period
    place = angle - turned
    bound = (MORE * UNIT * own + TINY)[rows.piece(np, x, place)]
    if not np.any(turned):
        return bound
    on = turned != 0.0
    moved = np.zeros_like(bound)
    moved[on] = MORE * UNIT * _moved(x, y, angle[on], turned[on], place[on])
    return bound + moved


def _moved(x, y, angle, turned, place):
    """What a turn more or less adds, in `UNIT`."""
    reach = np.abs(angle) + abs(x[0]) + x[-1] - x[0] + np.abs(turned)
    slope = np.abs(np.diff(y) / np.diff(x))
    near = _distance(x, place) <= 4.0 * UNIT * reach
    return slope[rows.piece(np, x, place)] * 3.0 * reach + np.where(near, np.max(slope) * 8.0 * reach, 0.0)


def _steepest(x, y):
    return float(np.max(np.abs(np.diff(y) / np.diff(x))))


def _distance(x, place):
    """Of each place from the row that is nearest."""
    row = np.clip(np.searchsorted(x, place), 1, x.size - 1)
    return np.minimum(np.abs(place - x[row - 1]), np.abs(place - x[row]))


def kinks_within(table, motion):
    """Over travel, what bounds need to know of its kinks and jumps (see `engines.record`).

    By how much the slope may change at the row beside each place, N/m or N m/m, how far the value may jump there, how
    near, m or m a radian, a row or the end of a stroke must be for it not to be zero, and how far, m, the row is.
    """
    near = 1e-6 * float(table.x[-1] - table.x[0])
    place = np.asarray(table.place(motion), dtype=float)
    sides = [table.y] if table.back is None else [table.y, table.back]
    change, distance = 2.0 * max(_steepest(table.x, side) for side in sides), _distance(table.x, place)
    jump = 0.0 if table.back is None else _largest_within(table.x, table.y - table.back, place, near)
    standing = np.abs(table.rate(motion)) <= near
    return np.where(distance <= near, change, 0.0), np.where(standing, jump, 0.0), near, distance


def _largest_within(x, y, place, near):
    """Bound on the magnitude of a polygon so near to each place."""
    largest = np.max(np.abs(y))
    if np.min(np.diff(x)) < 2.0 * near:  # more than one row may be so near
        return largest
    row = np.clip(np.searchsorted(x, place - near), 0, x.size - 1)
    beside = np.where(np.abs(x[row] - place) <= 2.0 * near, np.abs(y[row]), 0.0)
    ends = [np.abs(np.interp(end, x, y)) for end in (place - near, place + near)]
    return np.maximum(beside, np.maximum(*ends)) + 8 * UNIT * largest

"""What bounds need to know of a table: its own rounding, and its kinks and jumps."""

from functools import lru_cache

import numpy as np

from ...numbers.arithmetic import UNIT
from .rows import piece

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
    x, slope, own = _pieces(table)
    angle = np.asarray(motion.crank_angle)
    turned = np.floor((angle - x[0]) / table.period) * table.period
    place = angle - turned
    row = piece(np, x, place)
    bound = own[row]
    on = turned != 0.0
    if not on.any():
        return bound
    reach = np.abs(angle[on]) + np.abs(turned[on]) + abs(x[0]) + table.period
    near = _distance(x, place[on]) <= 4.0 * UNIT * reach
    moved = np.zeros_like(bound)
    moved[on] = (MORE * UNIT) * (3.0 * slope[row[on]] + np.where(near, 8.0 * slope.max(), 0.0)) * reach
    return bound + moved


@lru_cache(maxsize=64)
def _pieces(table):
    """Ends of the pieces of a table by angle; of each its slope and the error of values in the first turn."""
    x, y = np.append(table.x, table.x[0] + table.period), np.append(table.y, table.y[0])
    rise = np.abs(np.diff(y))
    slope = rise / np.diff(x)
    own = np.where(rise == 0.0, 0.0, 5.0 * rise + np.maximum(np.abs(y[1:]), np.abs(y[:-1])))
    if x[0] != 0.0:
        own[-1] += 2.0 * abs(x[-1]) * slope[-1]
    return x, slope, MORE * UNIT * own + TINY


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
    place, rate = np.asarray(table.place(motion), dtype=float), table.rate(motion)
    sides = [table.y] if table.back is None else [table.y, table.back]
    change, distance = 2.0 * max(_steepest(table.x, side) for side in sides), _distance(table.x, place)
    jump = 0.0 if table.back is None else _largest_within(table.x, table.y - table.back, place, near)
    standing = np.abs(rate) <= near
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

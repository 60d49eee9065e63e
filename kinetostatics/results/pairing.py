"""Which extrema of two mechanisms belong together: one to one, of one kind, near in crank angle."""

from dataclasses import replace

import numpy as np

from ..machine.loads import TURN
from .turn import SAME

APART = TURN / 3
"""Crank angle from which on extrema are strangers, rad; those of a reversed torque are a quarter of a turn apart."""


def partners(reference, balanced):
    """Place of the balanced extremum that belongs to each of the reference (K,), -1 where there is none.

    Of one kind each (maximum or minimum), one to one, so that they lie as near in crank angle as they can.
    """
    period, own = reference.solution.period, balanced.solution.period
    times = max(1, round(period / own))
    angle = np.ravel(balanced.angle + own * np.arange(times)[:, None])
    maximum, side = (np.tile(part, times) for part in (balanced.maximum, _side(balanced)))
    apart = np.abs((reference.angle[:, None] - angle + period / 2) % period - period / 2)
    apart = apart + SAME * (_side(reference)[:, None] != side)
    apart = np.where(reference.maximum[:, None] == maximum, np.minimum(apart, APART), APART)
    rows, columns = _assigned(apart)
    found = np.full(len(reference), -1)
    found[rows] = columns % max(len(balanced), 1)
    return found


def _assigned(apart):
    """Rows and columns of the pairs, one to one, whose distances have the least sum; those of strangers left out."""
    rows = np.flatnonzero((apart < APART).any(axis=1))
    columns = apart[rows].argmin(axis=1) if rows.size else rows
    if np.unique(columns).size < columns.size:  # the nearest of two are the same
        from scipy.optimize import linear_sum_assignment

        rows, columns = linear_sum_assignment(apart)
        near = apart[rows, columns] < APART
        rows, columns = rows[near], columns[near]
    return rows, columns


def of_partners(places, values):
    """Values at the places of partners, NaN where there is none."""
    return np.append(values, np.nan)[places]


def counted(found):
    """Which extrema are not the two sides of a jump between the extrema before and behind it, (K,) of bool."""
    keep = np.ones(len(found), dtype=bool)
    for second in np.flatnonzero(_side(found)) if len(found) > 2 else ():
        sides = slice(second - 1, second + 1)
        low, high = sorted((found.value[second - 2], found.value[(second + 1) % len(found)]))
        if ((low < found.value[sides]) & (found.value[sides] < high)).all():
            keep[sides] = False
    return keep


def chosen(found, kept):
    """Some of the extrema."""
    return replace(found, angle=found.angle[kept], value=found.value[kept], maximum=found.maximum[kept])


def _side(found):
    """Whether each extremum stands behind another at its crank angle: what a limit position is left with."""
    return np.diff(found.angle, prepend=-1.0) <= SAME

"""Crank angles at which friction of a running machine has a kink, as a force that presses changes its sign there.

They hang on speed and acceleration, so they are found on running that is nearly known, pieces are parted there, and
running is found anew until they stay. The error of an edge that is off by d is of the order of d squared.
"""

import numpy as np

from .pieces import Pieces

FOUND = 1e-9
"""Shift of an edge, relative to the period, that does no harm."""
BESIDE = 1e-6
"""Edges this near to one, relative to the period, go when it comes."""
NONE = np.empty(0)


def parted(driven, pieces, rows, before=NONE):
    """Pieces parted where rows change their signs, and these crank angles; None where pieces are parted there already.

    `rows` are functions given at the points; `before` the angles found before, whose edges go.
    """
    if not rows:
        return None
    period = pieces.edges[-1] - pieces.edges[0]
    angle = np.column_stack([pieces.edges[:-1], pieces.angle, pieces.edges[1:]])
    found = [_zeros(pieces.with_ends(row), angle) for row in rows]
    held = np.concatenate([pieces.edges[:1], driven.kinks, pieces.edges[-1:]])
    bends = np.mod(np.concatenate(found), period)
    bends = bends[_distance(bends, held) > FOUND * period]
    if np.all(_distance(bends, pieces.edges) <= FOUND * period):
        return None
    other = np.setdiff1d(pieces.edges, before)
    other = other[_distance(other, bends) > BESIDE * period]
    return Pieces(np.unique(np.concatenate([held, other, bends])), pieces.count), bends


def _zeros(value, angle):
    """Crank angles inside pieces at which a function is zero; where it jumps from one to the next it is not."""
    at = (np.signbit(value[:, :-1]) != np.signbit(value[:, 1:])) & (value[:, :-1] != value[:, 1:])
    (low, high), (before, after) = ((rows[:, :-1][at], rows[:, 1:][at]) for rows in (angle, value))
    return low + (high - low) * before / (before - after)


def _distance(angles, others):
    """Distance of each angle to the nearest of others; infinite where there are none."""
    return np.abs(angles[:, None] - others).min(axis=1, initial=np.inf)

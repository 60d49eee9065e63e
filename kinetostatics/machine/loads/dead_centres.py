"""Dead centres of a slider: the crank angles and coordinates at which it turns back."""

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from ...errors import NotGivenError, ParameterError
from ...numbers.arithmetic import TURN, is_foreign_array
from .table_pieces import turning_points

CENTRED = 1e-9
"""Distance of mid-stroke from the foot of O on the guide, relative to the stroke, below which it is in the middle."""
FIRST_ANGLE = np.radians(-15.0)
"""Least crank angle of a dead centre, rad: those near 0 stay there, whatever the sign of an offset or a rounding."""
_DEAD_CENTRES: WeakKeyDictionary[Any, dict] = WeakKeyDictionary()
"""By mechanism and slider: its dead centres."""


def dead_centres(motion, slider):
    """Crank angles, rad, and coordinates, m, of the far and the near dead centre of a slider: two pairs.

    Numbers, or arrays (designs, 1), from `FIRST_ANGLE` on; NaN where the mechanism does not close all round.
    """
    known = _DEAD_CENTRES.setdefault(motion.mechanism, {})
    if slider not in known:
        known[slider] = _dead_centres(motion.mechanism, slider)
    return known[slider]


def _dead_centres(mechanism, slider):
    def travel(angle):
        return mechanism.place(angle).travels[slider]

    with np.errstate(invalid="ignore", divide="ignore"):
        first = travel(np.zeros(1)).position
        if is_foreign_array(first) or first.dtype == object:
            raise NotGivenError(f"the stroke of {slider!r} needs plain lengths, on which its dead centres are computed")
        _, stops, _, (rate,) = turning_points(lambda angle: travel(angle).first, mechanism.turns)
        closes, changes = ~np.isnan(rate).any(axis=-1), np.sum(~np.isnan(stops), axis=-1)
        wrong = closes & (changes != 2)
        if wrong.any():
            raise ParameterError(
                f"a stroke needs a slider that goes to and fro once in a turn, but {slider!r} of {mechanism.name} "
                f"changes its direction {np.max(np.where(wrong, changes, 0))} times",
                wrong if first.ndim > 1 else None,
            )
        still = ((rate[:, :-1] == 0.0) & (rate[:, 1:] == 0.0)).any(axis=-1)
        if still.any():
            raise ParameterError(
                f"a stroke needs a slider that goes to and fro, but {slider!r} of {mechanism.name} stands still on a "
                "part of the turn. There a force against its motion has no sense, and its dead centre no crank angle",
                still if first.ndim > 1 else None,
            )
        angle = np.full((*closes.shape, 2), np.nan)
        if closes.any():
            angle[closes] = stops[closes, :2]
            period = TURN * mechanism.turns
            angle = np.where(angle >= FIRST_ANGLE + period, angle - period, angle)
        place = np.broadcast_to(travel(angle).position, angle.shape)
    is_far = place.sum(axis=-1, keepdims=True) >= -CENTRED * np.ptp(place, axis=-1, keepdims=True)  # the one ahead
    order = np.argsort(np.where(is_far, -place, place), axis=-1)
    pairs = (np.split(np.take_along_axis(part, order, axis=-1), 2, axis=-1) for part in (angle, place))
    return tuple(tuple(part if first.ndim > 1 else part.item() for part in pair) for pair in pairs)

"""The sense of rotation: which way a crank turns, or at rest is about to turn, +1 counter-clockwise and -1 clockwise.

Friction, tables with values for the stroke back and functions of the motion depend on it. A scene at rest gives it as
`sense`, or by the sign of its crank acceleration.
"""

import numpy as np

from ..errors import ParameterError
from ..numbers.arithmetic import sign, where_zero
from ..numbers.planar import number
from .links import present

FASTER = 2.0**600
"""Factor by which a crank speed counts before the crank acceleration."""
WANTED = (
    "but crank_speed and crank_acceleration are both 0: give sense=+1 or sense=-1, the way the crank is about to turn, "
    "or a crank_acceleration"
)
"""How to mend a scene at rest."""


def sense_of(speed, acceleration):
    """Which way a crank turns: the sign of its speed, at rest of its acceleration; +1 where both are 0."""
    speed, acceleration = present(speed), present(acceleration)
    if speed is None or acceleration is None:
        return sign(number(acceleration if speed is None else speed) + 0.0)
    return sign(speed * FASTER + acceleration + 0.0)


def stands(scene):
    """Where a crank stands and is about to turn neither way, as far as is known: an array of bool."""
    if scene.sense is not None:
        return np.False_
    return np.logical_and(where_zero(scene.crank_speed), where_zero(scene.crank_acceleration))


def require_sense(reason, motion):
    """Raise `ParameterError` where a crank stands and is about to turn neither way; the reason says what needs it."""
    still = stands(motion)
    if still.any():
        raise ParameterError(f"{reason}, {WANTED}", still.any(axis=-1) if still.ndim > 1 else None)

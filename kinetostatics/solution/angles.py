"""Crank angles as solutions keep them."""

import math
import warnings

import numpy as np

from ..errors import HintWarning
from ..machine import plausibility
from ..numbers import checks
from ..numbers.arithmetic import read_only

ANGLE_RULE = checks.Number("rad", "crank_angle", table=True)
PLAIN_TYPES = int, float, list, tuple
FLOAT_TYPES = (np.dtype(np.float64), np.dtype(np.float32))
BYTES_PER_VALUE = 8
"""Of a crank angle, and of one value there."""
MAX_ANGLES = checks.MAX_TABLE_MEMORY // BYTES_PER_VALUE
"""Crank angles, from which on not even these have room in memory."""


def crank_angles(given, owner="solve"):
    """Crank angles of any kind: a locked copy of plain ones, those of another array library as they are."""
    if type(given) is np.ndarray and given.dtype in FLOAT_TYPES and given.size <= MAX_ANGLES:
        return read_only(given.copy())
    if ANGLE_RULE.quick(given) is not checks.UNDECIDED:
        return read_only(np.array(float(given)))
    if isinstance(given, list | tuple) and not given:
        checks.require(owner, "there are no crank angles")
    if isinstance(given, np.ndarray) and given.size:
        checks.require(owner, checks.count("the number of crank angles", given.size, size=BYTES_PER_VALUE))
    angle, problem = ANGLE_RULE.check(given)
    checks.require(owner, problem)
    return angle if hasattr(angle, "shape") else read_only(np.array(angle))


def hint_at_angles(owner, given):
    """Warn whoever called the caller of valid crank angles that look like degrees, or like a count of them."""
    if type(given) is float and abs(given) < plausibility.TWO_TURNS:
        return
    if type(given) is np.ndarray:
        texts = plausibility.angle_hints(given)
    else:
        texts = plausibility.given_angle_hints(given, np.asarray(given) if isinstance(given, PLAIN_TYPES) else given)
    for text in texts:
        warnings.warn(HintWarning(owner, text), stacklevel=3)


def angle_problem(angle):
    """What is wrong with crank angles, as far as they can be looked at."""
    if not (angle.size if isinstance(angle, np.ndarray) else math.prod(angle.shape)):
        return "there are no crank angles"
    if not isinstance(angle, np.ndarray) or angle.dtype == object:
        return None
    finite = (angle.ndim < 2 and math.isfinite(angle.dot(angle))) or np.isfinite(angle).all()  # dot costs a quarter
    return None if finite else "crank angles must be finite; found NaN or infinity"

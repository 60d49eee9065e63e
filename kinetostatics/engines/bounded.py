"""Bounds as users have them, from those that programs compute."""

import numpy as np

from ..numbers.elementary import UNIT
from .bounds import SAFE


def of_magnitude(vector, bounds):
    """Bound on the error of a vector's magnitude, from the vector's values and those of its components."""
    return np.hypot(*bounds) * SAFE + 4 * UNIT * np.hypot(*vector)


def where_known(values, bounds):
    """Bounds as users have them: infinite where none is proven, NaN where there is no value."""
    return np.where(np.isnan(values), np.nan, np.where((bounds >= 0.0) & ~np.isinf(values), bounds, np.inf))


def with_bounds(program, state, leaves, compiled=False, tight=False):
    """Values (outputs, *shape) of a program and bounds on their errors; where tight ones are infinite, the others."""
    count = len(program.outputs)
    rows = program.bounded(tight).run(state, leaves, compiled)
    values, bounds = rows[:count], rows[count:]
    if tight and not np.isfinite(bounds).all():
        bounds = np.fmin(bounds, with_bounds(program, state, leaves, compiled)[1])
    return values, bounds

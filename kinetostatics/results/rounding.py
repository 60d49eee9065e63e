"""What of a table is rounding: values small beside the largest term they are the sum of, and angles beside a turn."""

import numpy as np

from ..mechanics.quantities import of_scene, scale
from .extremes import FLOOR

PLACED = 1e-7
"""Crank angle, rad, below which the place of an extremum is 0: values about it agree to all digits."""


def without_rounding(solution, name, values):
    """Values of a quantity, 0 where they are rounding of what it is a sum of."""
    terms = [scale(solution, name), *np.abs(values)]
    # a pressure is a root of a force
    floor = np.sqrt(FLOOR) if of_scene(solution)[name].kind == "contact" else FLOOR
    return zeroed(values, floor * max((float(term) for term in terms if np.isfinite(term)), default=0.0))


def zeroed(values, floor):
    """Values, 0 where they are smaller than a floor."""
    return np.where(np.abs(values) < floor, 0.0, values)

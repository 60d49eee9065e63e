"""Search for the flywheel with which a machine runs as evenly as is asked."""

import math
from typing import Any

from ..errors import DriveError
from ..numbers import checks

LARGEST = 60
"""How often a flywheel is doubled, or halved, in search of one that is large, or small, enough."""
PRECISION = 1e-13
LIGHTEST = 1e-3
"""Flywheel, relative to the machine's own inertia, below which no lighter one is looked for."""


def fluctuation_wanted(owner, fluctuation):
    """A coefficient of fluctuation as a float, between 0 and 2."""
    wanted, wrong = checks.single("fluctuation", fluctuation, "1", low=0.0, strict=True)
    if not wrong and not wanted < 2.0:
        wrong = f"fluctuation must be less than 2, got {wanted:g}"
    checks.require(owner, wrong)
    return wanted


def flywheel_for(wanted, running_with, unit):
    """Flywheel, kg m2, with which running has a coefficient of fluctuation, or 0 where none is needed; and the running.

    Parameters
    ----------
    wanted : float
    running_with : function
        Running with a flywheel, kg m2; raises `DriveError` where there is none.
    unit : float
        The machine's own inertia, kg m2.
    """
    from scipy.optimize import brentq

    runs: dict[float, Any] = {}

    def excess(inertia):
        """Logarithm of the fluctuation over the one wanted; large where the machine does not run."""
        try:
            runs[inertia] = running_with(inertia)
        except DriveError:
            runs[inertia] = None
            return math.inf
        return math.log(max(runs[inertia].fluctuation, 1e-300) / wanted)

    if excess(0.0) <= 0.0:
        return 0.0, runs[0.0]
    size, low, high = unit, 0.0, None
    for _ in range(LARGEST):
        if excess(size) <= 0.0:
            high = size
            break
        low, size = size, 2.0 * size
    if high is None:
        running_with(size)  # says why the machine does not run
        raise DriveError(f"flywheel: even {size:.3g} kg m2 do not bring the fluctuation to {wanted:g}")
    while not math.isfinite(excess(low)):  # too light to run at all
        if high < LIGHTEST * unit or high - low <= PRECISION * high:
            return high, runs[high]
        middle = 0.5 * (low + high)
        low, high = (low, middle) if excess(middle) <= 0.0 else (middle, high)
    inertia = float(brentq(excess, low, high, xtol=PRECISION * high, rtol=PRECISION))
    return inertia, runs.get(inertia) or running_with(inertia)

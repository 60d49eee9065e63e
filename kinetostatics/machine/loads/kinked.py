"""What loads declare of their kinks and jumps.

A load, or what gives its value (a `Table`, a function of the motion), declares them by

    kinks(motion)               crank angles (K,) of kinks, and (J,) of jumps, rad, in one period of its own (`period`,
                                one turn unless it has that), whatever crank angles the motion has

and may by ``bends(motion, straight)`` and ``is_bent(straight)`` leave out those that bend by less than a share of its
largest value, as `Table` does, for each of many designs its own. What declares none is sampled, and what it does within
two degrees may pass unseen.
"""

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from .load import value_of
from .period import TURN


def kinked(loads):
    """Parts of loads that declare kinks: loads themselves, or their values."""
    parts = (part for item in loads for part in (item, value_of(item)))
    return [part for part in parts if hasattr(part, "kinks")]


def kinks_of(part, motion):
    """Crank angles (K,) of kinks and (J,) of jumps that a part declares, brought into its period.

    Raises
    ------
    ParameterError
        It declares something else than two rows of finite crank angles.
    """
    found = part.kinks(motion)
    try:
        kinks, jumps = (np.ravel(np.asarray(angles, dtype=float)) for angles in found)
    except (TypeError, ValueError):
        kinks = jumps = np.full(1, np.nan)
    if not (np.isfinite(kinks).all() and np.isfinite(jumps).all()):
        name = getattr(part, "__name__", type(part).__name__)
        raise ParameterError(
            f"{name}.kinks must return two arrays of finite crank angles, those of kinks and those of jumps, got "
            f"{checks.shown(found)}"
        )
    period = period_on(part, motion.mechanism)
    return np.mod(kinks, period), np.mod(jumps, period)


def is_bent(part, straight):
    """Whether what declares kinks has some that bend by so much."""
    return not hasattr(part, "is_bent") or part.is_bent(straight)


def bends_of(part, motion, straight):
    """Crank angles (1 or designs, K), NaN where a design has fewer, which (K,) jump, by what share it bends besides."""
    if hasattr(part, "bends"):
        return part.bends(motion, straight)
    kinks, jumps = kinks_of(part, motion)
    return np.concatenate([kinks, jumps])[None], np.arange(kinks.size + jumps.size) >= kinks.size, 0.0


def period_on(part, mechanism):
    """Crank angle after which what declares kinks repeats on a mechanism, rad."""
    return part.period_on(mechanism) if hasattr(part, "period_on") else getattr(part, "period", TURN)

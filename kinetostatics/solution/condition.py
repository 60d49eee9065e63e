"""How many digits of one quantity of a solution are left."""

from dataclasses import replace

import numpy as np

from ..mechanics.quantities import scale, values


def condition_of(solution, quantity):
    """How many times relative errors are magnified in one quantity; see `Solution.condition_of`."""
    largest = np.asarray(solution.dynamics.largest(values(replace(solution, silent=True), quantity)))
    terms = np.broadcast_to(scale(solution, quantity), largest.shape)
    cancelled = np.divide(terms, largest, out=np.ones(largest.shape), where=largest > 0)
    condition = solution.condition
    if not callable(quantity) and solution.mechanism.grows(quantity):
        from ..mechanics import sensitivity

        condition = sensitivity.condition(solution.dynamics, reactions=True).reshape(solution.shape)
    return condition * np.fmax(cancelled, 1.0).reshape(*largest.shape, *[1] * (condition.ndim > 0))

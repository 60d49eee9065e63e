"""Newton iteration on the constraint equations of the whole mechanism, and all its forces from one linear system."""

import numpy as np

from .constraints import Model
from .global_system.configurations import Configuration, components
from .method import Method, NotGivenError, require_moving, require_one_design

STEP = np.radians(15.0)
"""Step, at most, of the table of positions from which iterations start: 24 over a turn."""
STRIDES = 4
"""Steps of continuation from one position of the table to the next."""
CLOSED = 1e-9
"""Residual, relative to the largest coordinate, of a position that is found."""


def modelled(solution, quantity):
    """Model of a solution's mechanism, which gives the quantity."""
    require_one_design(solution)
    require_moving(solution)
    model = Model(solution.mechanism)
    if quantity not in model.readings:
        raise NotGivenError(f"the constraint equations give no {quantity}, but {', '.join(model.readings)}")
    return model


def table(model, angle):
    """Crank angles that span those given, positions q there by continuation, and velocities dq / dphi."""
    first, last = np.min(angle), np.max(angle)
    phi, step = np.linspace(first, last, 1 + STRIDES * int(np.ceil((last - first) / STEP)), retstep=True)
    q, rows = model.start(first), []
    for turned in phi:
        at = Configuration(model, q, turned)
        for _ in range(4):
            at = Configuration(model, at.corrected(), turned)
        if not np.abs(at.residual).max() < CLOSED * max(1.0, np.abs(at.q).max()):
            raise NotGivenError(f"continuation finds no position of {model.mechanism.name} at {turned:.6g} rad")
        rows.append((at.q, at.rates(1.0)))
        q = at.q + step * rows[-1][1]
    return phi[::STRIDES], *map(np.array, zip(*rows[::STRIDES], strict=True))


def _prepare(solution, quantity, iterations):
    model, angle = modelled(solution, quantity), solution.crank_angle
    phi, position, slope = table(model, angle)
    between = 0.5 * (phi[1:] + phi[:-1])

    def run():
        nearest = np.searchsorted(between, angle)
        q = position[nearest] + slope[nearest] * (angle - phi[nearest])[:, None]
        for _ in range(iterations):
            q = Configuration(model, q, angle).corrected()
        return components(model, solution, quantity, q)

    return run


METHODS = (Method("Newton iteration, global system", _prepare, "iterations", (1, 2, 3, 4, 5, 6)),)

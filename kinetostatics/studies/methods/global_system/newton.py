"""Newton iteration on the constraint equations, and constrained multibody integration over the turn.

Integration takes the crank angle as time, at constant crank speed (index 1; Hairer and Wanner, *Solving Ordinary
Differential Equations II*), by DOP853:

    [M J^T; J 0] [qddot; lambda] = [Q; gamma]

The drive leaves no freedom, so J is square: the lower rows give qddot, the upper rows lambda. Positions drift from C =
0; two remedies are compared:

Baumgarte   gamma becomes gamma - 2 a Cdot - a^2 C, so drift decays like exp(-a phi) (Baumgarte 1972)
projection  one Newton iteration corrects q at each output angle, and J gives qdot
"""

from functools import partial

import numpy as np

from ....errors import NotGivenError
from ..method import Method, require_moving, require_one_design
from .constraints import Configuration, Model, components, integrate

TABLE_STEP = np.radians(15.0)
"""Largest step, rad, of the table of starting positions: 24 in a turn."""
CONTINUATION_STEPS = 4
"""Steps of continuation from one position of the table to the next."""
CLOSURE_TOLERANCE = 1e-9
"""Largest residual of a position, relative to the largest coordinate."""


def model_of(solution, quantity):
    """Model of a solution's mechanism; an error if the quantity is missing."""
    require_one_design(solution)
    require_moving(solution)
    model = Model(solution.mechanism)
    if quantity not in model.readings:
        raise NotGivenError(f"the constraint equations give no {quantity}, but {', '.join(model.readings)}")
    return model


def position_table(model, angle):
    """Crank angles that span the given ones, positions q by continuation, and derivatives dq / dphi."""
    first, last = np.min(angle), np.max(angle)
    phi, step = np.linspace(
        first, last, 1 + CONTINUATION_STEPS * int(np.ceil((last - first) / TABLE_STEP)), retstep=True
    )
    q, rows = model.start(first), []
    for turned in phi:
        at = Configuration(model, q, turned)
        for _ in range(4):
            at = Configuration(model, at.newton_step(), turned)
        if not np.abs(at.residual).max() < CLOSURE_TOLERANCE * max(1.0, np.abs(at.q).max()):
            raise NotGivenError(f"continuation finds no position of {model.mechanism.name} at {turned:.6g} rad")
        rows.append((at.q, at.rates(1.0)))
        q = at.q + step * rows[-1][1]
    return phi[::CONTINUATION_STEPS], *map(np.array, zip(*rows[::CONTINUATION_STEPS], strict=True))


def iteration(model, angle, iterations):
    """Function that computes positions q at crank angles by Newton iteration from those of a table."""
    phi, position, slope = position_table(model, angle)
    between = 0.5 * (phi[1:] + phi[:-1])

    def run():
        nearest = np.searchsorted(between, angle)
        q = position[nearest] + slope[nearest] * (angle - phi[nearest])[:, None]
        for _ in range(iterations):
            q = Configuration(model, q, angle).newton_step()
        return q

    return run


def _prepare(solution, quantity, iterations):
    model = model_of(solution, quantity)
    positions = iteration(model, solution.crank_angle, iterations)
    return lambda: components(model, solution, quantity, positions())


NEWTON_METHODS = (Method("Newton iteration, global system", _prepare, "iterations", (1, 2, 3, 4, 5, 6)),)


DAMPING = 1.0
"""Baumgarte's a = alpha = beta, per rad of crank angle. Over one turn 0.5 to 2 are as good; 10 needs 4 to 10 times the
work.
"""
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


def _integration(damping, projected, solution, quantity, tolerance):
    model, angle = model_of(solution, quantity), solution.crank_angle
    if np.ndim(solution.crank_speed) or np.any(solution.crank_acceleration):
        raise NotGivenError("integration runs at a constant crank speed, without crank acceleration")
    if len(angle) < 2 or not (np.diff(angle) > 0).all() or angle[-1] - angle[0] > 2 * np.pi:
        raise NotGivenError("integration runs over one turn: two crank angles or more, rising within 2 pi, are needed")
    _, position, slope = position_table(model, angle)
    start = np.concatenate([position[0], slope[0]])
    size = np.abs(position[0][: 2 * model.size]).max()
    scale = np.tile(np.repeat([size, 1.0], [2 * model.size, model.size]), 2)

    def derivative(phi, state):
        q, rates = np.split(state, 2)
        at = Configuration(model, q, phi)
        return np.concatenate([rates, at.solve(at.damped_gamma(rates, 1.0, damping))])

    def run():
        states = integrate(derivative, angle[[0, -1]], start, "DOP853", angle, tolerance, tolerance * scale)
        q, rates = np.split(states.T, 2, axis=1)
        if projected:
            return components(model, solution, quantity, Configuration(model, q, angle).newton_step())
        return components(model, solution, quantity, q, rates * solution.crank_speed)

    return run


INTEGRATION_METHODS = (
    Method("multibody integration, Baumgarte", partial(_integration, DAMPING, False), "tolerance", TOLERANCES),
    Method("multibody integration, projection", partial(_integration, 0.0, True), "tolerance", TOLERANCES),
)

"""Constrained multibody integration over the turn at constant crank speed, drift held by Baumgarte terms or projection.

The crank angle itself is the time, and the drive a constraint that depends on it. The equations of `constraints`,
differentiated twice, make ordinary differential equations (index 1; Hairer and Wanner, *Solving Ordinary Differential
Equations II*), which DOP853 integrates:

    [M J^T; J 0] [qddot; lambda] = [Q; gamma]

The drive leaves no freedom, so J is square: the lower rows alone give qddot, the upper ones lambda where it is asked
for. Integrated positions drift from C = 0:

Baumgarte   gamma becomes gamma - 2 a Cdot - a^2 C, so drift dies like exp(-a phi) (Baumgarte 1972)
projection  where results are asked for, one Newton iteration puts q back and J gives qdot; with no freedom left, the
            integration is then but a starting value
"""

import numpy as np
from scipy.integrate import solve_ivp

from .global_system.configurations import Configuration, components
from .method import Method, NotGivenError
from .newton import modelled, table

DAMPING = 1.0
"""Baumgarte's a = alpha = beta, per rad; in time, the crank speed. Over one turn drift stays near the tolerance even
without; half or twice as much does as well, 10 takes four to ten times the work.
"""
TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


def _integrating(damping, projected):
    def prepare(solution, quantity, tolerance):
        model, angle = modelled(solution, quantity), solution.crank_angle
        _require_constant_speed(solution)
        _, position, slope = table(model, angle)
        start = np.concatenate([position[0], slope[0]])
        size = np.abs(position[0][: 2 * model.size]).max()
        scale = np.tile(np.repeat([size, 1.0], [2 * model.size, model.size]), 2)

        def derivative(phi, state):
            q, rates = np.split(state, 2)
            at = Configuration(model, q, phi)
            right = at.gamma(rates)
            if damping:
                right -= 2 * damping * (at.jacobian @ rates - model.drive) + damping * damping * at.residual
            return np.concatenate([rates, at.solve(right)])

        def run():
            span, tolerances = angle[[0, -1]], {"rtol": tolerance, "atol": tolerance * scale}
            found = solve_ivp(derivative, span, start, "DOP853", t_eval=angle, **tolerances)
            if not found.success:
                raise NotGivenError(f"integration stops: {found.message}")
            q, rates = np.split(found.y.T, 2, axis=1)
            if projected:
                return components(model, solution, quantity, Configuration(model, q, angle).corrected())
            return components(model, solution, quantity, q, rates * solution.crank_speed)

        return run

    return prepare


def _require_constant_speed(solution):
    angle = solution.crank_angle
    if np.ndim(solution.crank_speed) or np.any(solution.crank_acceleration):
        raise NotGivenError("integration runs at a constant crank speed, without crank acceleration")
    if len(angle) < 2 or not (np.diff(angle) > 0).all() or angle[-1] - angle[0] > 2 * np.pi:
        raise NotGivenError("integration runs over one turn: two crank angles or more, rising within 2 pi, are needed")


METHODS = (
    Method("multibody integration, Baumgarte", _integrating(DAMPING, False), "tolerance", TOLERANCES),
    Method("multibody integration, projection", _integrating(0.0, True), "tolerance", TOLERANCES),
)

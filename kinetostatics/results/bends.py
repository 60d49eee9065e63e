"""Where loads, friction and laws of cams bend or jump: crank angles over the period, for each design its own."""

from typing import Any, NamedTuple

import numpy as np

from ..machine.loads import KINK_TOLERANCE, TURN, has_significant_kinks, kink_sources, significant_kinks
from ..mechanics.quantities import quantity
from .changes import sign_changes
from .turn import beginnings, of_laws

SMOOTH = ("slider", "motion", "rate")
"""Kinds of quantities that no load moves."""
SAMPLES = 720
"""Crank angles a turn between which what turns friction about changes its sign once at most."""


class Bends(NamedTuple):
    """Where designs bend.

    Attributes
    ----------
    angle : array (1 or designs, K)
        Crank angles over the period; NaN where a design has fewer.
    jumps : array (1 or designs, K) of bool
        Where quantities may jump; elsewhere they go on with a kink.
    rest : float
        Share of its largest value by which a load may bend besides.
    """

    angle: Any
    jumps: Any
    rest: float


def bent(solution, name, straight=KINK_TOLERANCE):
    """Whether friction, the law of a cam, or a load that bends by so much, may bend a quantity of a solution."""
    if of_laws(solution).size:
        return True
    loads = any(has_significant_kinks(part, straight) for part in kink_sources(solution.loads))
    return bool(solution.friction.acting or loads) and quantity(solution, name).kind not in SMOOTH


def bends(solution, straight=KINK_TOLERANCE):
    """The `Bends` of a solution, of loads those that bend by so much."""
    law = of_laws(solution)[None]
    found, rest = [(law, np.isin(law, of_laws(solution, jumps=True)))], 0.0
    if solution.friction.acting:
        found.append(_of_friction(solution))
    for part in kink_sources(solution.loads):
        own, jumps, left = significant_kinks(part, solution, straight)
        again = beginnings(part, solution)
        found.append(((own[..., None] + again).reshape(len(own), -1), np.repeat(jumps, again.size)[None]))
        rest = max(rest, left)
    most = max(len(angle) for angle, _ in found)
    rows = ([np.broadcast_to(part, (most, part.shape[1])) for part in row] for row in zip(*found, strict=True))
    angle, jumps = map(np.column_stack, rows)
    return Bends(angle, jumps, rest)


def _of_friction(solution):
    """Where rates that turn friction about, and forces that bend it, change their signs; and whether it is rates."""
    rates = len(solution.dynamics.friction_solver.rates) if solution.dynamics.friction_signs else 0
    samples = SAMPLES * round(solution.period / TURN)
    row, angle = sign_changes(lambda angle: solution.at(angle).dynamics.friction_signs, solution.period, samples)
    return angle, row < rates

"""Where loads and friction of designs bend or jump: crank angles over the period, for each design its own."""

import numpy as np

from ..machine.loads import STRAIGHT, TURN, Table, in_rows, is_bent, value_of
from ..mechanics.quantities import quantity
from .turn import ASIDE, beginnings

SMOOTH = ("slider", "motion", "rate")
"""Kinds of quantities that no load moves."""
SAMPLES = 720
"""Crank angles a turn between which what turns friction about changes its sign once at most."""


def bent(solution, name, straight=STRAIGHT):
    """Whether friction, or a table among the loads that bends by so much, may bend a quantity of a solution."""
    return bool(solution.friction.acting or _tables(solution, straight)) and quantity(solution, name).kind not in SMOOTH


def bends(solution, straight=STRAIGHT):
    """Crank angles (1 or designs, K) at which tables or friction bend or may jump; NaN where a design has fewer."""
    found = [_of_friction(solution)] if solution.friction.acting else []
    for table in _tables(solution, straight):
        own = table.bends(solution, straight)
        found.append((own[..., None] + beginnings(table, solution)).reshape(len(own), -1))
    most = max(map(len, found))
    return np.column_stack([np.broadcast_to(part, (most, part.shape[1])) for part in found])


def _tables(solution, straight):
    """Tables among the loads that bend by so much."""
    return [item for item in map(value_of, solution.loads) if isinstance(item, Table) and is_bent(item, straight)]


def _of_friction(solution):
    """Where rates that turn friction about, and forces that bend it, change their signs."""
    from scipy.optimize import elementwise

    def signs(angle):
        with np.errstate(all="ignore"):
            found = solution.at(angle).dynamics.friction_signs
        return [np.broadcast_arrays(np.atleast_2d(row), angle)[0] for row in found]

    grid = (ASIDE + np.linspace(0.0, solution.period, SAMPLES * round(solution.period / TURN) + 1))[None]
    values = np.stack(np.broadcast_arrays(*signs(grid)), axis=1)  # (designs, functions, N)
    changed = (np.signbit(values[..., :-1]) != np.signbit(values[..., 1:])) & ~np.isnan(np.diff(values))
    design, row, place = np.nonzero(changed)
    low, high, row = in_rows(design, len(values), grid[0, place], grid[0, place + 1], row)
    if not low.size:
        return low
    asked = np.arange(low.size).reshape(low.shape)
    known = np.nan_to_num(row).astype(int)

    def own(angle, asked):
        everywhere = low.copy()
        everywhere.flat[asked] = angle
        return np.take_along_axis(np.stack(signs(everywhere)), known[None], axis=0)[0].flat[asked]

    found = elementwise.find_root(own, (low, high), args=(asked,)).x
    return np.mod(np.where(np.isnan(found), high, found), solution.period)

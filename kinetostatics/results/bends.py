"""Where loads of designs bend or jump: crank angles over the period, for each design its own."""

import numpy as np

from ..machine.loads import Table, value_of
from ..mechanics.quantities import quantity

SMOOTH = ("slider", "motion", "rate")
"""Kinds of quantities that no load moves."""


def bent(solution, name):
    """Whether tables among the loads may bend a quantity of a solution."""
    tables = any(isinstance(value_of(item), Table) for item in solution.loads)
    return tables and quantity(solution, name).kind not in SMOOTH


def bends(solution):
    """Crank angles (1 or designs, K) at which tables among the loads bend or may jump; NaN where a design has fewer."""
    found = []
    for table in map(value_of, solution.loads):
        if isinstance(table, Table):
            again = np.arange(0.0, solution.period, table.period_on(solution.mechanism))
            own = table.bends(solution)
            found.append((own[..., None] + again).reshape(len(own), -1))
    most = max(map(len, found))
    return np.column_stack([np.broadcast_to(part, (most, part.shape[1])) for part in found])

"""A solution as a table: a row for each crank angle."""

import warnings

import numpy as np

from ..cycle.turn import NEAR
from ..errors import ConditionWarning
from ..mechanics.assembly import NO_DIGITS_CONDITION
from ..mechanics.quantities import of_scene

COLUMN_ORDER = ("rate", "reaction", "force", "friction", "contact", "whole", "slider", "motion")
"""Order of kinds of quantities in the table, after the positions of joints; energies are left out."""


def solution_frame(solution):
    """One row for each crank angle (and design), units in the column names, as a pandas DataFrame.

    Warns
    -----
    ConditionWarning
        Rates and forces have no correct digit at some of the crank angles.
    """
    import pandas as pd

    _warn_of_rows_without_digits(solution)
    columns = {"crank_angle [deg]": np.degrees(solution.crank_angle)}
    for joint in solution.placement.joints:
        columns |= _components(joint, "m", solution.position(joint))
    quantities = ((name, item) for name, item in of_scene(solution).items() if item.kind in COLUMN_ORDER)
    for name, quantity in sorted(quantities, key=lambda pair: COLUMN_ORDER.index(pair[1].kind)):
        if quantity.kind == "rate" and solution.placement.links[quantity.owner].ratio is None:
            continue
        values = quantity.read(solution)
        if quantity.vector:
            columns |= _components(f"reaction_{name}" if quantity.kind == "reaction" else name, quantity.unit, values)
        else:
            columns[f"{name} [{quantity.unit}]"] = values
    shape = np.broadcast_shapes(*(np.shape(values) for values in columns.values()))
    table = pd.DataFrame({name: np.broadcast_to(values, shape).ravel() for name, values in columns.items()})
    if len(shape) > 1:
        designs = np.prod(shape[:-1], dtype=int)
        table.insert(0, "design", np.repeat(np.arange(designs), shape[-1]))
    return table


def _warn_of_rows_without_digits(solution):
    with np.errstate(invalid="ignore"):
        if not any(np.any(margin < NEAR) for margin in solution.closure):
            return
        lost = solution.condition >= NO_DIGITS_CONDITION
    if lost.any():
        angle = np.unique(np.broadcast_to(solution.crank_angle, solution.shape)[lost])
        places = ", ".join(f"{place:.6g}" for place in np.degrees(angle[:3])) + (" ..." if angle.size > 3 else "")
        warnings.warn(
            f"{solution.mechanism.name}: rates and forces have no correct digit in {int(lost.sum())} of {lost.size} "
            f"rows, at crank angles {places} deg (solution.condition)",
            ConditionWarning,
            stacklevel=4,
        )


def _components(name, measure, vector):
    return {f"{name}_x [{measure}]": vector[0], f"{name}_y [{measure}]": vector[1]}

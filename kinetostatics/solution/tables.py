"""Tables of a solution: all results by crank angle, and largest values with their uncertainty."""

import warnings
from dataclasses import replace
from functools import cache

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.limit_positions import NEAR
from ..cycle.load_functions import with_resolution
from ..cycle.rounding import AT_JUMP, BoundedExtremes
from ..errors import ConditionWarning, ParameterError
from ..mechanics.assembly import NO_DIGITS_CONDITION
from ..mechanics.quantities import LOAD_FREE_KINDS, of_scene
from ..numbers import paths
from ..numbers.formatting import number, round_uncertainty_up
from ..numbers.output_units import output_units
from .certainty import Doubt, doubt_text
from .columns import columns_of
from .parameters import Parameters


def solution_frame(solution, units=None):
    """One row for each crank angle (and design), units in the column names, as a pandas DataFrame; see `in_units`.

    Warns where rates and forces have no correct digit at some of the crank angles.
    """
    import pandas as pd

    _warn_of_rows_without_digits(solution)
    columns: dict[str, np.ndarray] = {}
    for item in columns_of(solution):
        columns |= zip(item.headings, item.values(solution), strict=True)
    shape = np.broadcast_shapes(*(np.shape(values) for values in columns.values()))
    table = pd.DataFrame({name: np.broadcast_to(values, shape).ravel() for name, values in columns.items()})
    if len(shape) > 1:
        designs = np.prod(shape[:-1], dtype=int)
        table.insert(0, "design", np.repeat(np.arange(designs), shape[-1]))
    return output_units(units, "frame").table(table)


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


COLUMNS = ("quantity", "unit", "largest", "at [deg]", "tolerance", "rounding", "most from", "share [%]")
TABLE_KINDS = ("force", "whole", "slider", "motion", "contact", "reaction")
"""Kinds of quantities in the table."""
SMOOTH_KINDS = (*LOAD_FREE_KINDS, "whole")
"""Kinds without kinks from loads or friction: motion, and the inertia forces of the whole machine."""
SECOND_TORQUE = "balancing_torque_by_power"
"""Equal to the torque, so left out."""


def largest_with_uncertainty(solution, inputs):
    """Largest value of each quantity over the period, and its uncertainty there, a pandas DataFrame.

    To first order an extremum changes with the inputs as the value at its crank angle does. At a kink or jump it also
    moves along a steep curve: there the largest values with each input smaller and larger by its uncertainty are
    compared. Quantities that do not vary over the period are left out.

    A row has the unit, the value of largest magnitude and its crank angle, and the standard uncertainty from all
    inputs. It also has the proven bound on rounding (NaN without one) and the input with the largest share of the
    variance. Inputs, errors and the warning, which is one for all quantities, are those of `Solution.uncertainty`; the
    solution is of one design, and its own crank angles do not matter.
    """
    import pandas as pd

    quantities = {
        name: item for name, item in of_scene(solution).items() if item.kind in TABLE_KINDS and name != SECOND_TORQUE
    }
    known = BoundedExtremes(solution, {name: found for name in quantities if len(found := extrema(solution, name))})
    rows, doubts = [], []

    @cache
    def moved(path):
        """Solutions with an input smaller and larger by its uncertainty."""
        place = solution.places[path]
        given, by = place.value(solution), inputs[path]
        return [paths.with_values(solution, {place.steps: given + side * by}, _changed) for side in (-1.0, 1.0)]

    for name in known.found:
        row, doubt = _row(known, name, quantities[name], inputs, moved)
        rows.append(row)
        doubts += [] if doubt is None else [doubt]
    if doubts:
        warnings.warn(f"{solution.mechanism.name}: {doubt_text(doubts)}", ConditionWarning, stacklevel=2)
    return with_resolution(pd.DataFrame(rows, columns=COLUMNS).set_index("quantity"), solution)


def _changed(item, **fields):
    """Copy of a solution with other parts, or of one of its parts with other numbers, which are checked."""
    return (replace if isinstance(item, Parameters) else paths.replace_checked)(item, **fields)


def _row(known, name, quantity, inputs, moved):
    """A row of the table, and the doubt that its uncertainty is too small, or None."""
    value, angle, rounding = known.end(name, lambda values: np.argmax(np.abs(values)))
    at_kink = np.any(np.abs(angle - known.solution.sampled.kinks) < AT_JUMP)
    if at_kink and quantity.kind not in SMOOTH_KINDS:
        parts, doubt = _parts_at_kink(name, rounding, inputs, moved)
    else:
        sure, doubt = known.solution.at(angle).with_doubt(f"|{name}|" if quantity.vector else name, inputs)
        parts = {path: float(part) for path, part in sure.inputs.items()}
    tolerance = float(np.sqrt(sum(part**2 for part in parts.values())))
    most = max(parts, key=parts.__getitem__) if tolerance > 0.0 else ""
    share = 100.0 * (parts[most] / tolerance) ** 2 if most else np.nan
    return (quantity.label, quantity.unit, value, np.degrees(angle), tolerance, rounding, most, share), doubt


def _parts_at_kink(name, rounding, inputs, moved):
    """Half the difference of the largest magnitude by path, 0 within rounding; and the doubt or None."""
    found, doubt = {}, None
    for path in inputs:
        try:
            low, high = (_largest(side, name) for side in moved(path))
            half = 0.5 * abs(high - low)
            found[path] = 0.0 if half <= rounding else half
        except ParameterError as why:  # a slider beyond its table, for one
            doubt = Doubt(name, "and may be more", f"with {path} moved, {why}")
    return found, doubt


def _largest(solution, name):
    found = extrema(solution, name)
    return float(np.max(np.abs(found.value))) if len(found) else abs(float(found.constant))


def format_with_uncertainty(value, uncertainty):
    """A number to the second digit of its uncertainty, and the uncertainty: "40578.9 +- 3.1"."""
    return f"{number(value, bound=0.1 * uncertainty)} +- {round_uncertainty_up(uncertainty)}"

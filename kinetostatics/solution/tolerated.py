"""How sure the largest values of a machine are: what tolerances of its numbers make, and what rounding does."""

import warnings

import numpy as np

from ..errors import ConditionWarning
from ..mechanics.quantities import of_scene
from ..numbers.shown import at_most, number
from ..results.extremes import extrema
from ..results.rounding import Known
from .second_order import told

COLUMNS = ("quantity", "unit", "largest", "at [deg]", "tolerance", "rounding", "most from", "share [%]")
KINDS = ("force", "whole", "slider", "motion", "contact", "reaction")
"""Of quantities that the table tells."""
AGAIN = "balancing_torque_by_power"
"""Says what the torque says."""


def largest_with_uncertainty(solution, inputs):
    """Largest value of each quantity over the period, and its uncertainty there, a pandas DataFrame.

    To first order an extremum moves with the inputs as the value at its crank angle does. Quantities that do not vary
    over the period are left out.

    Parameters
    ----------
    solution : Solution
        Of one design; its own crank angles do not matter.
    inputs : mapping of path to float
        Standard uncertainties, as for `Solution.uncertainty`.

    Returns
    -------
    pandas.DataFrame
        By quantity its unit, its value of largest magnitude and the crank angle, the standard uncertainty from all
        inputs, the proven bound on rounding (NaN where there is none), the input that makes most of the uncertainty,
        and its share of the variance.

    Raises
    ------
    NotGivenError, ParameterError
        As for `Solution.uncertainty`.

    Warns
    -----
    ConditionWarning
        As for `Solution.uncertainty`, once for all quantities.
    """
    import pandas as pd

    quantities = {name: item for name, item in of_scene(solution).items() if item.kind in KINDS and name != AGAIN}
    known = Known(solution, {name: found for name in quantities if len(found := extrema(solution, name))})
    rows, doubts = [], []
    for name in known.found:
        row, doubt = _row(known, name, quantities[name], inputs)
        rows.append(row)
        doubts += [] if doubt is None else [doubt]
    if doubts:
        warnings.warn(f"{solution.mechanism.name}: {told(doubts)}", ConditionWarning, stacklevel=2)
    return pd.DataFrame(rows, columns=COLUMNS).set_index("quantity")


def _row(known, name, quantity, inputs):
    """A row of the table, and the doubt that it says too little, or None."""
    value, angle, rounding = known.end(name, lambda values: np.argmax(np.abs(values)))
    sure, doubt = known.solution.at(angle).with_doubt(f"|{name}|" if quantity.vector else name, inputs)
    tolerance = float(sure.tolerance)
    most = max(sure.inputs, key=sure.inputs.__getitem__) if tolerance > 0.0 else ""
    share = 100.0 * float(sure.inputs[most] / tolerance) ** 2 if most else np.nan
    return (quantity.label, quantity.unit, value, np.degrees(angle), tolerance, rounding, most, share), doubt


def with_uncertainty(value, uncertainty):
    """A number to the second digit of its uncertainty, and that: "40578.9 +- 3.1"."""
    return f"{number(value, bound=0.1 * uncertainty)} +- {at_most(uncertainty)}"

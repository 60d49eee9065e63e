"""Tables: true extremes of every quantity of a solution as a pandas DataFrame."""

import warnings

import numpy as np

from ..errors import ConditionWarning
from ..mechanics.quantities import of_scene, still
from .extremes import extrema, warning
from .rounding import PLACED, without_rounding, zeroed

SHOWN = ("smallest", "smallest at [deg]", "largest", "largest at [deg]")


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle.

    What is rounding stands as 0: values small beside the largest term of their kind, and angles beside a turn.

    Warns
    -----
    ConditionWarning
        Values around some crank angles have no correct digit, or quantities grow without bound there; once for all.
    """
    import pandas as pd

    found = extremes_by_name(solution)
    rows = [(quantity.label, quantity.unit, *ends) for quantity, ends in found.values()]
    return pd.DataFrame(rows, columns=["quantity", "unit", *SHOWN]).set_index("quantity")


def extremes_by_name(solution):
    """By the name of every quantity: what it is, and its extremes as `SHOWN` names them; as for `extremes_frame`."""
    rows, several = {}, []
    for name, quantity in of_scene(solution).items():
        if quantity.kind in ("check", "energy"):
            continue
        if quantity.kind == "rate" and still(solution.placement.links[quantity.owner].ratio_slope):
            continue
        found = extrema(solution, name)
        several.append(found)
        places = [found.angle[find(found.value)] if len(found) else np.nan for find in (np.argmin, np.argmax)]
        ends = zip(without_rounding(solution, name, found.range), np.degrees(zeroed(places, PLACED)), strict=True)
        rows[name] = quantity, tuple(float(item) for end in ends for item in end)
    text = warning(solution, several)
    if text:
        warnings.warn(text, ConditionWarning, stacklevel=3)
    return rows

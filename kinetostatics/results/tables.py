"""Tables: true extremes of every quantity of a solution as a pandas DataFrame."""

import warnings

import numpy as np

from ..errors import ConditionWarning
from ..mechanics.quantities import of_mechanism, still
from .extremes import extrema, warning


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle.

    Warns
    -----
    ConditionWarning
        Values around some crank angles have no correct digit, or quantities grow without bound there; once for all.
    """
    import pandas as pd

    rows, several = [], []
    for name, quantity in of_mechanism(solution.mechanism).items():
        if quantity.kind == "energy":
            continue
        if quantity.kind == "rate" and still(solution.placement.links[quantity.owner].ratio_slope):
            continue
        found = extrema(solution, name)
        several.append(found)
        places = [found.angle[find(found.value)] if len(found) else np.nan for find in (np.argmin, np.argmax)]
        ends = zip(found.range, np.degrees(places), strict=True)
        rows.append((quantity.label, quantity.unit, *(item for end in ends for item in end)))
    text = warning(solution, several)
    if text:
        warnings.warn(text, ConditionWarning, stacklevel=2)
    columns = ["quantity", "unit", "smallest", "smallest at [deg]", "largest", "largest at [deg]"]
    return pd.DataFrame(rows, columns=columns).set_index("quantity")

"""Tables: true extremes of every quantity of a solution as a pandas DataFrame."""

import warnings

import numpy as np

from ..errors import ConditionWarning
from ..mechanics.quantities import of_scene, scale, still
from .extremes import FLOOR, extrema, warning

PLACED = 1e-7
"""Crank angle, rad, below which the place of an extremum is 0: values about it agree to all digits."""


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle.

    What is rounding stands as 0: values small beside the largest term of their kind, and angles beside a turn.

    Warns
    -----
    ConditionWarning
        Values around some crank angles have no correct digit, or quantities grow without bound there; once for all.
    """
    import pandas as pd

    rows, several = [], []
    for name, quantity in of_scene(solution).items():
        if quantity.kind in ("check", "energy"):
            continue
        if quantity.kind == "rate" and still(solution.placement.links[quantity.owner].ratio_slope):
            continue
        found = extrema(solution, name)
        several.append(found)
        places = [found.angle[find(found.value)] if len(found) else np.nan for find in (np.argmin, np.argmax)]
        ends = zip(_rounded(solution, name, found.range), np.degrees(_zeroed(places, PLACED)), strict=True)
        rows.append((quantity.label, quantity.unit, *(item for end in ends for item in end)))
    text = warning(solution, several)
    if text:
        warnings.warn(text, ConditionWarning, stacklevel=2)
    columns = ["quantity", "unit", "smallest", "smallest at [deg]", "largest", "largest at [deg]"]
    return pd.DataFrame(rows, columns=columns).set_index("quantity")


def _rounded(solution, name, ends):
    """Smallest and largest value of a quantity, 0 where they are rounding of what it is a sum of."""
    terms = [scale(solution, name), *np.abs(ends)]
    rounding = (
        np.sqrt(FLOOR) if of_scene(solution)[name].kind == "contact" else FLOOR
    )  # a pressure is a root of a force
    return _zeroed(ends, rounding * max((float(term) for term in terms if np.isfinite(term)), default=0.0))


def _zeroed(values, floor):
    return np.where(np.abs(values) < floor, 0.0, values)

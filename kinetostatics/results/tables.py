"""Tables: true extremes of every quantity of a solution as a pandas DataFrame."""

import warnings
from typing import NamedTuple

import numpy as np

from ..errors import ConditionWarning
from ..mechanics.quantities import Quantity, of_scene
from .extremes import extrema, warning
from .rounding import PLACED, Known, without_rounding, zeroed

SHOWN = ("smallest", "smallest at [deg]", "largest", "largest at [deg]")


class Row(NamedTuple):
    """Extremes of a quantity as a table tells them.

    Attributes
    ----------
    quantity : Quantity
    ends : tuple of float
        As `SHOWN` names them.
    errors : tuple of float
        By how much each may be wrong; NaN where nothing is proven, and of crank angles.
    """

    quantity: Quantity
    ends: tuple[float, ...]
    errors: tuple[float, ...]


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle.

    What is rounding stands as 0: values within their proven bounds or small beside the largest term of their kind, and
    angles beside a turn.

    Warns
    -----
    ConditionWarning
        Values around some crank angles have no correct digit, or quantities grow without bound there; once for all.
    """
    return frames(extremes_by_name(solution))[0]


def frames(found):
    """Two tables of what `extremes_by_name` found: of the values, and of bounds on their errors."""
    import pandas as pd

    tables = zip(*((row.ends, row.errors) for row in found.values()), strict=True)
    heads = [(row.quantity.label, row.quantity.unit) for row in found.values()]
    rows = ([(*head, *numbers) for head, numbers in zip(heads, table, strict=True)] for table in tables)
    return tuple(pd.DataFrame(table, columns=["quantity", "unit", *SHOWN]).set_index("quantity") for table in rows)


def extremes_by_name(solution):
    """By the name of every quantity its `Row`; as for `extremes_frame`."""
    found = {
        name: extrema(solution, name)
        for name, quantity in of_scene(solution).items()
        if quantity.kind not in ("check", "energy")
        and not (quantity.kind == "rate" and solution.placement.links[quantity.owner].ratio_slope is None)
    }
    text = warning(solution, found.values())
    if text:
        warnings.warn(text, ConditionWarning, stacklevel=3)
    known = Known(solution, found)
    return {name: _row(known, name) for name in found}


def _row(known, name):
    values, angles, errors = zip(*(known.end(name, find) for find in (np.argmin, np.argmax)), strict=True)
    values = without_rounding(known.solution, name, values, errors)
    ends = zip(values, np.degrees(zeroed(angles, PLACED)), strict=True)
    numbers = tuple(float(item) for end in ends for item in end)
    return Row(of_scene(known.solution)[name], numbers, (errors[0], np.nan, errors[1], np.nan))

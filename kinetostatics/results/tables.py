"""Tables: a solution, its extremes, and counterweights as pandas DataFrames."""

import warnings

import numpy as np

from ..errors import ConditionWarning, QuantityError
from ..mechanics.quantities import RATES, UNITS, VECTORS, label, unit
from .extremes import extrema, extremes, warning
from .turn import NEAR

NO_DIGIT = 1e16
"""Condition from which rates and forces have no correct digit."""


def solution_frame(solution):
    """One row for each crank angle (and design), units in the column names.

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
    for link, motion in solution.placement.links.items():
        if motion.ratio is not None:
            columns[f"{link}_rate [rad/s]"] = solution.rate(link)
            columns[f"{link}_angular_acceleration [rad/s2]"] = solution.angular_acceleration(link)
    for joint in solution.reactions:
        columns |= _components(f"reaction_{joint}", "N", solution.reaction(joint))
    for name in available(solution):
        if name in VECTORS:
            columns |= _components(name, unit(name), getattr(solution, name))
        elif name in UNITS:
            columns[f"{name} [{unit(name)}]"] = getattr(solution, name)
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
        lost = solution.condition >= NO_DIGIT
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


def available(solution):
    """Names of the quantities this solution has: scalars and vectors first, then its joints."""
    names = []
    for name in UNITS:
        try:
            getattr(solution, name)
        except QuantityError:
            continue
        names.append(name)
    return (*names, *solution.reactions)


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle.

    Warns
    -----
    ConditionWarning
        Values around some crank angles have no correct digit, or quantities grow without bound there; once for all.
    """
    import pandas as pd

    rows, several = [], []
    links = (link for link, motion in solution.placement.links.items() if motion.ratio_slope is not None)
    rates = [f"{link}{ending}" for link in links for ending in RATES]
    for name in (*available(solution), *rates):
        found = extrema(solution, name)
        several.append(found)
        places = [found.angle[find(found.value)] if len(found) else np.nan for find in (np.argmin, np.argmax)]
        ends = zip(found.range, np.degrees(places), strict=True)
        rows.append((label(name), unit(name), *(item for end in ends for item in end)))
    text = warning(solution, several)
    if text:
        warnings.warn(text, ConditionWarning, stacklevel=2)
    columns = ["quantity", "unit", "smallest", "smallest at [deg]", "largest", "largest at [deg]"]
    return pd.DataFrame(rows, columns=columns).set_index("quantity")


def balancing_table(reference, variants, sampling=None):
    """Counterweights of balanced variants and what they do to the shaking force, a column for each link balanced.

    Parameters
    ----------
    reference : Solution
        Unbalanced mechanism.
    variants : dict of name to (Balanced, Solution)
    sampling : float, optional
        Crank-angle step (rad) of a published study, to show beside the true extremes what its grid gives.

    Returns
    -------
    pandas.DataFrame
        In mm, kg, N; forces stand in the first column of each variant.
    """
    import pandas as pd

    true_before = extremes(reference, "shaking_force").range[1]
    columns = {}
    for name, (balanced, solution) in variants.items():
        forces = _sampled_forces(reference, solution, sampling) if sampling else {}
        found = extremes(solution, "shaking_force")
        forces["largest |F| [N]"] = found.range[1]
        forces["at crank angle [deg]"] = np.degrees(found.angle[np.argmax(found.value)]) if len(found) else np.nan
        forces["reduction of |F| [%]"] = 100 * (1 - found.range[1] / true_before)
        for link, row in balanced.report().iterrows():
            columns[f"{name} {link}"] = {
                "modulus h [mm]": 1e3 * row["modulus h [m]"],
                "link centre with counterweight [mm]": 1e3 * row["link centre after [m]"],
                "link mass with counterweight [kg]": row["link mass after [kg]"],
                "link unbalance with counterweight [kg mm]": 1e3 * row["link unbalance after [kg m]"],
                "link unbalance before [kg mm]": 1e3 * row["link unbalance before [kg m]"],
                "counterweight unbalance [kg mm]": 1e3 * row["counterweight unbalance [kg m]"],
                "counterweight mass [kg]": row["counterweight mass [kg]"],
                "counterweight arm [mm]": 1e3 * row["counterweight arm [m]"],
                "counterweight phase [deg]": row["counterweight phase [deg]"],
                **forces,
            }
            forces = {}
    return pd.DataFrame(columns).rename_axis("quantity").round(9) + 0.0


def _farthest(values):
    """Value of largest magnitude with its sign; of several alike but for rounding the first."""
    size = np.abs(values)
    return values[np.flatnonzero(size >= (1 - 1e-12) * size.max())[0]]


def _sampled_forces(reference, solution, sampling):
    grid = np.arange(0.0, 2 * np.pi - 1e-9, sampling)
    before, (x, y) = (item.at(grid).shaking_force for item in (reference, solution))
    largest, largest_before = np.max(np.hypot(x, y)), np.max(np.hypot(*before))
    return {
        "largest F_x on the study's grid [N]": _farthest(x),
        "largest F_y on the study's grid [N]": _farthest(y),
        "largest |F| on the study's grid [N]": largest,
        "reduction of |F| on the study's grid [%]": 100 * (1 - largest / largest_before),
    }

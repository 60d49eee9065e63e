"""Counterweights of balanced variants and what they do, as a table."""

import numpy as np

from ..results.extremes import extremes


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

"""Tolerances: what the spread of parameters does to outputs, and whose spread matters most."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from . import designs
from .errors import ParameterError
from .reductions import parsed
from .sweeps import FAILED, sweep

LEVELS = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)


@dataclass(frozen=True, eq=False)
class Tolerances:
    """Outputs of a spread of designs; made by `tolerances`.

    Attributes
    ----------
    table : pandas.DataFrame
        The designs with their outputs, as of `sweep`.
    outputs : tuple of str
        Columns of the outputs.
    sensitivity : pandas.DataFrame
        By output and parameter: first-order and total Sobol index, the shares of the output's variance that the
        parameter's spread causes by itself, and together with others (Saltelli 2010).
    """

    table: pd.DataFrame
    outputs: tuple[str, ...]
    sensitivity: pd.DataFrame
    spreads: dict[str, str] = field(repr=False)

    def quantiles(self, levels=LEVELS):
        """Quantiles of every output over the designs that have it, a pandas DataFrame."""
        return self.table[list(self.outputs)].quantile(list(levels)).rename_axis("quantile")

    def share(self, output, *, above=-np.inf, below=np.inf):
        """Share of all designs whose output lies between; a design without it does not."""
        values = self.table[parsed(output).column]
        return float(((values > above) & (values < below)).mean())


def tolerances(case, outputs, spreads=None, *, count=4096, seed=0, **options) -> Tolerances:
    """Monte Carlo study of the spread of parameters, on the path of `sweep`.

    Parameters
    ----------
    case : Case or function
    outputs : sequence of str
        As for `sweep`: "ratio mean_absolute balancing_torque" ...
    spreads : dict of parameter to text, optional
        "normal 712 kN/m +- 5 kN/m", "695..705 kN/m" (uniform), "triangular 690..710..740 kN/m"; the case file's
        [tolerances] unless given.
    count : int
        Designs, a power of two; the Sobol indices take as many again for every parameter, and twice more.
    seed : int
        Of the scrambled Sobol sequence.
    options
        As for `sweep`: variant, reference, engine, executor ...

    Returns
    -------
    Tolerances

    Raises
    ------
    ParameterError
        No spreads, a text that cannot be read, a count that is no power of two, or designs within the spread that
        cannot be computed, which makes the indices meaningless.
    """
    from scipy.stats import sobol_indices

    spreads = dict(spreads or getattr(case, "tolerances", {}))
    if not spreads:
        raise ParameterError('tolerances: no spreads are given, nor does the case file have a table "tolerances"')
    if count < 2 or count & (count - 1):
        raise ParameterError(f"tolerances: count must be a power of two, got {count}")
    found = designs.distributions(spreads)
    names = tuple(parsed(item).column for item in ([outputs] if isinstance(outputs, str) else outputs))
    columns = [f"{name} [{unit}]" for name, (_, unit) in found.items()]

    def run(values):
        table = sweep(case, pd.DataFrame(values.T, columns=columns), outputs, **options)
        failing = table[table[FAILED] != ""]
        if len(failing):
            raise ParameterError(
                f"tolerances: {len(failing)} of {len(table)} designs within the spread cannot be computed, for example: "
                f"{failing[FAILED].iloc[0]}; narrow the spreads, or use sweep, which keeps them"
            )
        return np.array(table[list(names)]).T

    table = sweep(case, designs.sobol(spreads, count, seed), outputs, **options)
    indices: Any = sobol_indices(
        func=run, n=count, dists=[distribution for distribution, _ in found.values()], rng=np.random.default_rng(seed)
    )
    rows = [
        {
            "output": name,
            "parameter": parameter,
            "first order": np.atleast_2d(indices.first_order)[row, column],
            "total": np.atleast_2d(indices.total_order)[row, column],
        }
        for row, name in enumerate(names)
        for column, parameter in enumerate(found)
    ]
    return Tolerances(table, names, pd.DataFrame(rows).set_index(["output", "parameter"]), spreads)

"""Tolerances: the effect of the spread of parameters on outputs, with Sobol indices of the parameters."""

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..cycle.reductions import parsed
from ..errors import ParameterError
from ..numbers import checks
from ..numbers.files import folder_problem
from ..numbers.formatting import parse_heading
from . import designs
from .sweeps import FAILED, can_vary, is_case, output_list, sweep, variant_and_reference

QUANTILE_LEVELS = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)


@dataclass(frozen=True, eq=False)
class Tolerances:
    """Outputs of a spread of designs; `tolerances` returns it.

    Attributes
    ----------
    table : pandas.DataFrame
        The designs with their outputs, as from `sweep`.
    outputs : tuple of str
        Columns of the outputs.
    sensitivity : pandas.DataFrame
        By output and parameter: first-order and total Sobol index, the shares of the output's variance that the
        parameter's spread causes by itself, and together with others (Saltelli 2010).

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
    >>> spreads = {"slider.mass": "normal 600 kg +- 10 kg"}
    >>> found = ks.tolerances(saw, ["largest O"], spreads, count=64, progress=False)
    >>> found.quantiles([0.05, 0.95]).round(-3).values.ravel()
    array([226000., 238000.])
    >>> round(found.share("largest O", above=240e3), 1)
    0.0
    """

    table: pd.DataFrame
    outputs: tuple[str, ...]
    sensitivity: pd.DataFrame
    spreads: dict[str, Any] = field(repr=False)

    def quantiles(self, levels=QUANTILE_LEVELS):
        """Quantiles of every output over the designs, a pandas DataFrame."""
        return self.table[list(self.outputs)].quantile(list(levels)).rename_axis("quantile")

    def share(self, output, *, above=-np.inf, below=np.inf):
        """Fraction of designs whose output is above and below the limits."""
        named = {parse_heading(column)[0]: column for column in self.outputs}
        name = str(output) if str(output) in named else str(parsed(output))
        checks.require("tolerances", checks.choice("output", name, tuple(named)))
        values, unit = self.table[named[name]], parse_heading(named[name])[1]
        above, below = (
            checks.to_plain_named("tolerances", word, bound, unit)
            for word, bound in (("above", above), ("below", below))
        )
        return float(((values > above) & (values < below)).mean())


def tolerances(case, outputs, spreads=None, *, count=4096, seed=0, folder=None, **options) -> Tolerances:
    """Monte Carlo study of the spread of parameters, by `sweep`.

    Parameters
    ----------
    case : Case, Scene or function
        As for `sweep`.
    outputs : sequence of str
        As for `sweep`: "ratio mean_absolute balancing_torque" ...
    spreads : dict of parameter to text or quantities, optional
        "normal 712 kN/m +- 5 kN/m", "695..705 kN/m" (uniform), "triangular 690..710..740 kN/m", or pint quantities as
        for `designs.sample`. By default those in [tolerances] of the case file that apply to the variant.
    count : int
        Number of designs n, a power of two; the Sobol indices need n (parameters + 2) designs.
    seed : int
        Seed of the scrambled Sobol sequences.
    folder : path
        Folder for a Parquet dataset of each sweep of the study; a stopped study continues from it.
    options
        As for `sweep`: variant, reference, angles, engine, executor, workers, chunk, progress.

    Returns
    -------
    Tolerances

    Raises
    ------
    ParameterError
        Spreads are missing or unreadable, or the count is not a power of two. Designs within the spread cannot be
        computed or have an infinite output, which makes quantiles and indices meaningless.

    Examples
    --------
    Which of two spreads matters for the support?

    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
    >>> spreads = {"slider.mass": "normal 600 kg +- 10 kg", "coupler_length": "1.999..2.001 m"}
    >>> found = ks.tolerances(saw, ["largest O"], spreads, count=64, progress=False)
    >>> found.sensitivity["total"].round(2).to_dict()
    {('largest O [N]', 'slider.mass'): 1.0, ('largest O [N]', 'coupler_length'): 0.0}
    """
    if not (is_case(case) or can_vary(case) or callable(case)):
        raise ParameterError(
            f"tolerances: case must be a Case, a Scene or a function that returns a Scene, got {checks.shown(case)}"
        )
    if spreads is None and is_case(case):
        known = variant_and_reference(case, options.get("variant"), options.get("reference"))[0].units
        spreads = {name: text for name, text in case.tolerances.items() if name in known}
    power = isinstance(count, int) and count > 1 and not count & (count - 1)
    checks.require(
        "tolerances",
        None
        if spreads or not isinstance(spreads, Mapping | None)
        else 'give spreads: "tolerances" of the case file has none for this variant'
        if is_case(case)
        else 'give spreads, such as {"slider.mass": "normal 25 kg +- 1 kg"}',
        None
        if isinstance(spreads, Mapping | None)
        else f"spreads must be a dict of parameter to text or quantities, got {checks.shown(spreads)}",
        None if power else f"count must be a power of two, got {count!r}",
        None if folder is None else folder_problem(folder),
    )
    found, parts = designs.distributions(spreads), getattr(case, "sizing", None)
    wanted = tuple(dict.fromkeys(parsed(text, parts) for text in output_list(outputs)))
    sweeps = itertools.count()

    def run(designed):
        """Table of designs with their outputs, all of which must be finite."""
        place = None if folder is None else Path(folder) / f"sweep-{next(sweeps)}"
        table = sweep(case, designed, wanted, folder=place, **options)
        infinite = np.isinf(table.iloc[:, len(found) : -1]).any(axis=1)
        reasons = table[FAILED].where(~infinite, "an output is infinite")
        wrong = reasons[reasons != ""]
        if len(wrong):
            raise ParameterError(
                f"tolerances: {len(wrong)} of {len(table)} designs within the spread cannot be computed, for example: "
                f"{wrong.iloc[0]}; use narrower spreads, or sweep, which accepts failures"
            )
        return table

    def values(numbers):
        table = run(pd.DataFrame(numbers.T, columns=designs.headings(found)))
        return table.iloc[:, len(found) : -1].to_numpy(copy=True).T

    table = run(designs.sobol(spreads, count, seed))
    names = tuple(table.columns[len(found) : -1])
    return Tolerances(table, names, _sensitivity(values, found, names, count, seed), dict(spreads))


def _sensitivity(values, found, names, count, seed):
    """First-order and total Sobol index by output and parameter."""
    from scipy.stats import sobol_indices

    shape = len(names), len(found)
    first = total = np.ones(shape)  # a single parameter causes all variance
    if len(found) > 1:
        distributions = [distribution for distribution, _ in found.values()]
        indices: Any = sobol_indices(func=values, n=count, dists=distributions, rng=np.random.default_rng(seed))
        first, total = (np.reshape(part, shape) for part in (indices.first_order, indices.total_order))
    index = pd.MultiIndex.from_product([names, found], names=["output", "parameter"])
    return pd.DataFrame({"first order": first.ravel(), "total": total.ravel()}, index=index)

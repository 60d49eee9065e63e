"""Tables of designs to sweep: grids and samples of parameters from texts.

A spread is a text. "600..900 kN/m" is uniform; ":40" at the end gives the number of values of a grid. Samples also
accept "normal 712 kN/m +- 5 kN/m" (mean and standard deviation) and "triangular 690..710..740 kN/m" (low, likeliest,
high). The unit of a plain number is 1. Pint quantities are accepted too: the values of a grid, and for samples
``(low, high)``, ``("normal", mean, deviation)`` and ``("triangular", low, likeliest, high)``.
"""

import math
import re
from functools import cache

import numpy as np
import pandas as pd

from ..errors import ParameterError
from ..machine.builders import crank_slider, four_bar, slotted_lever
from ..machine.loads import Gravity, Spring, TorsionDamper, TorsionSpring
from ..numbers import checks
from ..numbers.formatting import heading
from ..numbers.spreads import MAX_TABLE_VALUES, distributions, parse_grid, read_spreads, require_mapping
from ..numbers.units import factor
from ..solution.scene import Scene

__all__ = [
    "distributions",
    "grid",
    "latin_hypercube",
    "random",
    "sample",
    "sobol",
]


def grid(spreads) -> pd.DataFrame:
    """Every combination of evenly spaced values, the last parameter varies fastest.

    Parameters
    ----------
    spreads : dict of parameter to text or quantities
        For example ``{"spring.stiffness": "600..900 kN/m:40", "cam.centre.x": "-30..-10 mm:20"}``; pint quantities list
        all values.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter, with its unit.

    Raises
    ------
    ParameterError
        A spread has another form, or its unit is unknown or of the wrong dimension for a known parameter.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> ks.designs.grid({"slider.mass": "500..700 kg:3", "crank_length": "0.2..0.4 m:2"}).shape
    (6, 2)
    """
    axes = read_spreads(spreads, parse_grid)
    _require_table_size(math.prod(axis.size for axis, _ in axes.values()), len(axes))
    values = np.stack(np.meshgrid(*(axis for axis, _ in axes.values()), indexing="ij"), axis=-1)
    return _design_table(values.reshape(-1, len(axes)), axes)


def latin_hypercube(spreads, count, seed=0) -> pd.DataFrame:
    """Designs spread evenly over each single parameter (Latin hypercube).

    Parameters
    ----------
    spreads : dict of parameter to text or quantities
        As for `sample`.
    count : int
        Number of designs; each equal part of the range of a parameter contains one.
    seed : int
        Seed of the random numbers.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter, with its unit.

    Raises
    ------
    ParameterError
        A spread has another form, its unit is unknown or of the wrong dimension for a known parameter, or
        there are more designs than a table allows.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> table = ks.designs.latin_hypercube({"slider.mass": "500..700 kg"}, 4)
    >>> sorted(int(mass // 50 * 50) for mass in table["slider.mass [kg]"])  # one in each quarter
    [500, 550, 600, 650]
    """
    from scipy.stats import qmc

    return _seeded_sample(spreads, count, seed, lambda size: qmc.LatinHypercube(size, rng=seed).random(count))


def sobol(spreads, count, seed=0) -> pd.DataFrame:
    """Designs of a scrambled Sobol sequence, evenly spread over all parameters together.

    Arguments `spreads`, `count`, `seed` and errors as for `latin_hypercube`; `count` is best a power of two.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> table = ks.designs.sobol({"slider.mass": "500..700 kg"}, 8)
    >>> sorted(int(mass // 25 * 25) for mass in table["slider.mass [kg]"])  # one in each eighth
    [500, 525, 550, 575, 600, 625, 650, 675]
    """
    from scipy.stats import qmc

    return _seeded_sample(spreads, count, seed, lambda size: qmc.Sobol(size, rng=seed).random(count))


def random(spreads, count, seed=0) -> pd.DataFrame:
    """Independent random designs.

    Arguments `spreads`, `count`, `seed` and errors as for `latin_hypercube`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> table = ks.designs.random({"slider.mass": "500..700 kg"}, 100)
    >>> bool(table["slider.mass [kg]"].between(500.0, 700.0).all())
    True
    """
    return _seeded_sample(spreads, count, seed, lambda size: np.random.default_rng(seed).random((count, size)))


def _seeded_sample(spreads, count, seed, uniform):
    require_mapping(spreads)
    _require_table_size(count, len(spreads), checks.seed("seed", seed))
    return sample(spreads, uniform)


def sample(spreads, uniform) -> pd.DataFrame:
    """Designs from numbers between 0 and 1, through the parameters' distributions.

    Parameters
    ----------
    spreads : dict of parameter to text or quantities
        "600..900 kN/m", "normal 712 kN/m +- 5 kN/m", "triangular 690..710..740 kN/m"; or as pint quantities
        ``(low, high)``, ``("normal", mean, deviation)``, ``("triangular", low, likeliest, high)``.
    uniform : array (designs, parameters) or function
        The numbers, a column for each parameter; a function returns them for a number of parameters.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter, with its unit.

    Raises
    ------
    ParameterError
        A spread has another form, or its unit is unknown or of the wrong dimension for a known parameter. Or a number
        is not from 0 to 1, or is 0 or 1 for an unbounded (normal) distribution.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spreads = {"slider.mass": "500..700 kg", "spring.stiffness": "normal 712 kN/m +- 5 kN/m"}
    >>> table = ks.designs.sample(spreads, [[0.25, 0.5], [0.75, 0.5]])  # by the shares below them
    >>> table.round(6).values.tolist()
    [[550.0, 712.0], [650.0, 712.0]]
    """
    found = distributions(spreads)
    given = uniform(len(found)) if callable(uniform) else uniform
    if isinstance(given, np.ndarray) and given.size:
        _require_table_size(given.size, 1)
    try:
        numbers = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(
            f"designs: uniform must be numbers from 0 to 1, an array (designs, {len(found)}), got {checks.shown(given)}"
        ) from None
    fits = numbers.ndim == 2 and numbers.shape[1] == len(found)
    checks.require("designs", None if fits else f"{len(found)} parameters need one column each, got {numbers.shape}")
    wrong = numbers[~((numbers >= 0.0) & (numbers <= 1.0))]
    checks.require(
        "designs",
        f"the numbers must be from 0 to 1 (cumulative probability), but {wrong.size} of "
        f"{numbers.size} are not, {wrong[0]:g} for instance; give them as (values - low) / (high - low)"
        if wrong.size
        else None,
    )
    values = [distribution.ppf(column) for (distribution, _), column in zip(found.values(), numbers.T, strict=True)]
    unbounded = [name for name, column in zip(found, values, strict=True) if not np.isfinite(column).all()]
    checks.require(
        "designs", *(f"{name} is infinite where its number is 0 or 1; keep the numbers between" for name in unbounded)
    )
    return _design_table(np.transpose(values), found)


def _require_table_size(count, parameters, *problems):
    """Raise an error with all problems if a table is too large."""
    whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
    checks.require(
        "designs",
        None if whole and count > 0 else f"count must be a whole number of at least 1, got {count!r}",
        f"{count} designs of {parameters} parameters are too many for one table of at most {MAX_TABLE_VALUES} "
        "values; sweep them in parts"
        if whole and count * parameters > MAX_TABLE_VALUES
        else None,
        *problems,
    )


def _design_table(values, found):
    """Table of designs; an error if the unit of a known parameter has the wrong dimension."""
    checks.require(
        "designs",
        *(f"a parameter must be a name, got {checks.shown(name)}" for name in found if not isinstance(name, str)),
    )
    problems = []
    for name, (_, unit) in found.items():
        usual = _known_units().get(re.sub(r"[0-9]+(?=\.|$)", "", name))
        try:
            factor(unit, usual or unit)
        except ValueError as error:
            problems.append(f"parameter {heading(name, unit)!r}: {error}")
    checks.require("designs", *problems)
    return pd.DataFrame(values, columns=headings(found))


@cache
def _known_units():
    """SI units of the parameters of common machines, by path without the label of the group."""
    loads = Gravity(), Spring(1.0, 0.0), TorsionSpring(1.0, 0.0, on="crank"), TorsionDamper(1.0, on="crank")
    machines = (
        crank_slider(1.0, 3.0),
        four_bar(1.0, 3.0, 2.5, rocker_pivot=(3.0, 0.0)),
        slotted_lever(1.0, pivot=(0.0, -3.0)),
    )
    scenes = Scene(machines[0], 1.0, loads=loads), *(Scene(machine, 1.0) for machine in machines[1:])
    return {path: unit for scene in scenes for path, unit in scene.units.items()}


def headings(found):
    """Column headings with units, from pairs (distribution, unit) by parameter."""
    return [heading(name, unit) for name, (_, unit) in found.items()]


def __dir__():
    return __all__

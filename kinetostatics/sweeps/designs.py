"""Tables of designs to sweep: grids and samples of parameters, spread as texts say.

A spread is a text: "600..900 kN/m" (evenly between, with ":40" behind it how many values of a grid), or for samples
also "normal 712 kN/m +- 5 kN/m" (mean and standard deviation) and "triangular 690..710..740 kN/m" (low, likeliest,
high). The unit of a plain number is 1.
"""

import math

import numpy as np
import pandas as pd

from ..numbers import checks
from ..numbers.headings import heading
from ..numbers.spreads import LARGEST, axis, distributions, read

__all__ = [
    "distributions",
    "grid",
    "latin_hypercube",
    "random",
    "sample",
    "sobol",
]


def grid(spreads) -> pd.DataFrame:
    """Every combination of evenly spaced values, the last parameter running fastest.

    Parameters
    ----------
    spreads : dict of parameter to text
        Such as ``{"spring.stiffness": "600..900 kN/m:40", "cam.centre.x": "-30..-10 mm:20"}``.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter, with its unit.

    Raises
    ------
    ParameterError
        A text is of another form, or its unit not known; all of them at once.
    """
    axes = read(spreads, axis)
    _require_room(math.prod(axis.size for axis, _ in axes.values()), len(axes))
    values = np.stack(np.meshgrid(*(axis for axis, _ in axes.values()), indexing="ij"), axis=-1)
    return pd.DataFrame(values.reshape(-1, len(axes)), columns=columns(axes))


def latin_hypercube(spreads, count, seed=0) -> pd.DataFrame:
    """Designs spread evenly over every parameter by itself; see `sample`."""
    from scipy.stats import qmc

    _require_room(count, len(spreads))
    return sample(spreads, lambda size: qmc.LatinHypercube(size, rng=seed).random(count))


def sobol(spreads, count, seed=0) -> pd.DataFrame:
    """Designs of a scrambled Sobol sequence, `count` best a power of two; see `sample`."""
    from scipy.stats import qmc

    _require_room(count, len(spreads))
    return sample(spreads, lambda size: qmc.Sobol(size, rng=seed).random(count))


def random(spreads, count, seed=0) -> pd.DataFrame:
    """Independent random designs; see `sample`."""
    _require_room(count, len(spreads))
    return sample(spreads, lambda size: np.random.default_rng(seed).random((count, size)))


def sample(spreads, uniform) -> pd.DataFrame:
    """Designs from numbers between 0 and 1, through the parameters' distributions.

    Parameters
    ----------
    spreads : dict of parameter to text
        "600..900 kN/m", "normal 712 kN/m +- 5 kN/m", "triangular 690..710..740 kN/m".
    uniform : array (designs, parameters) or function
        The numbers, a column for each parameter; a function gives them for a number of parameters.

    Returns
    -------
    pandas.DataFrame
        A column for each parameter, with its unit.

    Raises
    ------
    ParameterError
        A text is of another form, or its unit not known; all of them at once.
    """
    found = distributions(spreads)
    numbers = np.asarray(uniform(len(found)) if callable(uniform) else uniform)
    fits = numbers.ndim == 2 and numbers.shape[1] == len(found)
    checks.require("designs", None if fits else f"{len(found)} parameters need as many columns, got {numbers.shape}")
    values = [distribution.ppf(column) for (distribution, _), column in zip(found.values(), numbers.T, strict=True)]
    return pd.DataFrame(np.transpose(values), columns=columns(found))


def _require_room(count, parameters):
    """Raise an error unless a table of so many designs can be held."""
    whole = isinstance(count, int | np.integer) and not isinstance(count, bool)
    checks.require(
        "designs",
        None if whole and count > 0 else f"how many must be a whole number of at least 1, got {count!r}",
        f"{count} designs of {parameters} parameters are too many for one table, which holds {LARGEST} values; sweep "
        "them in parts"
        if whole and count * parameters > LARGEST
        else None,
    )


def columns(found):
    """Headings of parameters with units, from pairs that end with the unit, by parameter."""
    return [heading(name, unit) for name, (_, unit) in found.items()]


def __dir__():
    return __all__

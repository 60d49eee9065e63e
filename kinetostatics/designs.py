"""Tables of designs to sweep: grids and samples of parameters, spread as texts say.

A spread is a text: "600..900 kN/m" (evenly between, with ":40" behind it how many values of a grid), or for samples
also "normal 712 kN/m +- 5 kN/m" (mean and standard deviation) and "triangular 690..710..740 kN/m" (low, likeliest,
high).
"""

import re

import numpy as np
import pandas as pd

from . import checks

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_FORMS = {
    "grid": re.compile(rf"({_NUMBER})\s*\.\.\s*({_NUMBER})\s+([^:]*?)\s*:\s*(\d+)"),
    "uniform": re.compile(rf"(?:uniform\s+)?({_NUMBER})\s*\.\.\s*({_NUMBER})\s+([^:+]+?)"),
    "triangular": re.compile(rf"triangular\s+({_NUMBER})\s*\.\.\s*({_NUMBER})\s*\.\.\s*({_NUMBER})\s+([^:+]+?)"),
    "normal": re.compile(rf"normal\s+({_NUMBER})\s+([^:+]+?)\s*(?:\+-|±)\s*({_NUMBER})\s+([^:+]+?)"),
}
_HELP = (
    '"600..900 kN/m:40" for a grid; "600..900 kN/m", "normal 712 kN/m +- 5 kN/m" or "triangular 690..710..740 kN/m" '
    "for samples"
)


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
        A text is of another form; all of them at once.
    """
    axes, columns, problems = [], [], []
    for name, text in spreads.items():
        found = _FORMS["grid"].fullmatch(str(text).strip())
        if found is None:
            problems.append(f"cannot read {text!r} for {name}; write {_HELP}")
            continue
        low, high, unit, count = found.groups()
        axes.append(np.linspace(float(low), float(high), int(count)))
        columns.append(f"{name} [{unit}]")
    checks.require("grid", *problems)
    values = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    return pd.DataFrame(values, columns=columns)


def latin_hypercube(spreads, count, seed=0) -> pd.DataFrame:
    """Designs spread evenly over every parameter by itself; see `sample`."""
    from scipy.stats import qmc

    return sample(spreads, qmc.LatinHypercube(len(spreads), rng=seed).random(count))


def sobol(spreads, count, seed=0) -> pd.DataFrame:
    """Designs of a scrambled Sobol sequence, `count` best a power of two; see `sample`."""
    from scipy.stats import qmc

    return sample(spreads, qmc.Sobol(len(spreads), rng=seed).random(count))


def random(spreads, count, seed=0) -> pd.DataFrame:
    """Independent random designs; see `sample`."""
    return sample(spreads, np.random.default_rng(seed).random((count, len(spreads))))


def sample(spreads, uniform) -> pd.DataFrame:
    """Designs from numbers between 0 and 1, one column for each parameter, through the parameters' distributions.

    Parameters
    ----------
    spreads : dict of parameter to text
        "600..900 kN/m", "normal 712 kN/m +- 5 kN/m", "triangular 690..710..740 kN/m".
    uniform : array (designs, parameters)

    Raises
    ------
    ParameterError
        A text is of another form; all of them at once.
    """
    found = distributions(spreads)
    return pd.DataFrame(
        {
            f"{name} [{unit}]": distribution.ppf(uniform[:, column])
            for column, (name, (distribution, unit)) in enumerate(found.items())
        }
    )


def distributions(spreads):
    """Distribution (scipy.stats) and unit by parameter."""
    found, problems = {}, []
    for name, text in spreads.items():
        try:
            found[name] = _distribution(str(text).strip())
        except ValueError as error:
            problems.append(f"cannot read {text!r} for {name}: {error}")
    checks.require("designs", *problems)
    return found


def _distribution(text):
    from scipy import stats

    if match := _FORMS["uniform"].fullmatch(text):
        low, high = _rising(match[1], match[2])
        return stats.uniform(low, high - low), match[3]
    if match := _FORMS["triangular"].fullmatch(text):
        low, likeliest, high = _rising(match[1], match[2], match[3])
        return stats.triang((likeliest - low) / (high - low), low, high - low), match[4]
    if match := _FORMS["normal"].fullmatch(text):
        from .units import factor

        deviation = float(match[3]) * factor(match[4], match[2]) / factor(match[2], match[2])
        if deviation <= 0:
            raise ValueError("the standard deviation must be greater than 0")
        return stats.norm(float(match[1]), deviation), match[2]
    raise ValueError(f"write {_HELP}")


def _rising(*texts):
    values = [float(text) for text in texts]
    if values[0] >= values[-1] or sorted(values) != values:
        raise ValueError("the values must rise")
    return values

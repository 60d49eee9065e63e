"""Tables of designs to sweep: grids and samples of parameters, spread as texts say.

A spread is a text: "600..900 kN/m" (evenly between, with ":40" behind it how many values of a grid), or for samples
also "normal 712 kN/m +- 5 kN/m" (mean and standard deviation) and "triangular 690..710..740 kN/m" (low, likeliest,
high). The unit of a plain number is 1.
"""

import math
import re

import numpy as np
import pandas as pd

from ..numbers import checks
from ..numbers.headings import heading
from ..numbers.units import LONGEST, NUMBER, base_factor, factor, respelled, shown

LARGEST = 50_000_000
"""Values that a table of designs may hold."""
_NUMBER = f"({NUMBER})"
_TO = r"\s*\.\.\s*"
_UNIT = r"\s+((?:(?!\d)|1\s*(?:/|per\b))[^:+±]+?|1)"
_FORMS = {
    "grid": re.compile(rf"{_NUMBER}{_TO}{_NUMBER}{_UNIT}\s*:\s*([0-9]+)"),
    "uniform": re.compile(rf"(?:uniform\s+)?{_NUMBER}{_TO}{_NUMBER}{_UNIT}"),
    "triangular": re.compile(rf"triangular\s+{_NUMBER}{_TO}{_NUMBER}{_TO}{_NUMBER}{_UNIT}"),
    "normal": re.compile(rf"normal\s+{_NUMBER}{_UNIT}\s*(?:\+-|±)\s*{_NUMBER}{_UNIT}"),
}
_OTHER = "it has another form"
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
        A text is of another form, or its unit not known; all of them at once.
    """
    axes = _read(spreads, _axis)
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


def distributions(spreads):
    """Distribution (scipy.stats) and unit by parameter; raises one `ParameterError` for all texts that are wrong."""
    return _read(spreads, _distribution)


def _read(spreads, reader):
    """What the reader, which raises `ValueError`, makes of the text of each parameter."""
    found, problems = {}, [] if spreads else ["there are no parameters"]
    for name, text in spreads.items():
        try:
            found[name] = reader(_text(text))
        except ValueError as error:
            problems.append(f"cannot read {shown(text)} for {name}: {error}")
    if any(_OTHER in problem for problem in problems):
        problems.append(f"write {_HELP}")
    checks.require("designs", *problems)
    return found


def _text(text):
    if not isinstance(text, str) or len(text) > LONGEST:
        raise ValueError("it must be text of numbers with a unit")
    if "..." in text:  # 0...1 may mean 0 to 1 or 0 to 0.1
        raise ValueError(f"{_OTHER}; write two dots between numbers, and a 0 before a decimal point")
    return text.strip()


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


def _axis(text):
    """Evenly spaced values, and their unit."""
    match = _FORMS["grid"].fullmatch(text)
    if not match or not int(match[4]):
        raise ValueError(_other(text))
    low, high = _numbers(match[1], match[2])
    if int(match[4]) > LARGEST:
        raise ValueError(f"{match[4]} values are too many, at most {LARGEST}")
    return np.linspace(low, high, int(match[4])), _known(match[3])


def _distribution(text):
    """Distribution of the values, and their unit."""
    forms = ((name, _FORMS[name].fullmatch(text)) for name in ("uniform", "triangular", "normal"))
    name, match = next(((name, match) for name, match in forms if match), ("", None))
    if match is None:
        raise ValueError(_other(text))
    from scipy import stats

    if name == "uniform":
        low, high = _rising(match[1], match[2])
        return stats.uniform(low, high - low), _known(match[3])
    if name == "triangular":
        low, likeliest, high = _rising(match[1], match[2], match[3])
        return stats.triang((likeliest - low) / (high - low), low, high - low), _known(match[4])
    mean, deviation = _numbers(match[1], match[3])
    deviation *= factor(match[4], _known(match[2])) / base_factor(match[2])
    if deviation <= 0:
        raise ValueError("the standard deviation must be greater than 0")
    return stats.norm(mean, deviation), match[2]


def _other(text):
    return _OTHER + respelled(text, lambda reading: any(form.fullmatch(reading) for form in _FORMS.values()))


def _known(unit):
    """The unit, if it is one."""
    try:
        base_factor(unit)
    except ValueError:
        raise ValueError(f'unit "{unit}" is not known') from None
    return unit


def _rising(*texts):
    values = _numbers(*texts)
    if values[0] >= values[-1] or sorted(values) != values:
        raise ValueError("the values must rise")
    return values


def _numbers(*texts):
    values = [float(text) for text in texts]
    if not np.all(np.isfinite(values)):
        raise ValueError("the values must be finite")
    return values

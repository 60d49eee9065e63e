"""Spreads as texts say them: "600..900 kN/m", "normal 712 kN/m +- 5 kN/m", "triangular 690..710..740 kN/m"."""

import re

import numpy as np

from . import checks
from .units import LONGEST, NUMBER, base_factor, factor, respelled, shown

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


def distributions(spreads):
    """Distribution and unit of each parameter of a table of designs.

    Parameters
    ----------
    spreads : dict of parameter to text
        As for `designs.sample`.

    Returns
    -------
    dict of parameter to (distribution, unit)
        Distributions as of scipy.stats, frozen, and the unit that their values are in.

    Raises
    ------
    ParameterError
        A text is of another form, or its unit not known; all of them at once.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found, unit = ks.designs.distributions({"spring.stiffness": "normal 712 kN/m +- 5 kN/m"})["spring.stiffness"]
    >>> float(found.mean()), float(found.std()), unit
    (712.0, 5.0, 'kN/m')
    """
    return read(spreads, _distribution)


def read(spreads, reader):
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


def axis(text):
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

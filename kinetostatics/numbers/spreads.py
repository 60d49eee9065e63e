"""Spreads of numbers: "600..900 kN/m", "normal 712 kN/m +- 5 kN/m", "triangular 690..710..740 kN/m".

Or as quantities of pint: the values of a grid; ``(low, high)``, ``("normal", mean, deviation)`` and ``("triangular",
low, likeliest, high)``.
"""

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from . import checks
from .units import MAX_TEXT_LENGTH, NUMBER, base_factor, factor, quoted, respelling_advice, unit_of_quantity

MAX_TABLE_VALUES = 50_000_000
"""Largest number of values in a table of designs."""
_NUMBER = f"({NUMBER})"
_TO = r"\s*\.\.\s*"
_UNIT = r"\s+((?:(?!\d)|1\s*(?:/|per\b))[^:+±]+?|1)"
_FORMS = {
    "grid": re.compile(rf"{_NUMBER}{_TO}{_NUMBER}{_UNIT}\s*:\s*([0-9]+)"),
    "uniform": re.compile(rf"(?:uniform\s+)?{_NUMBER}{_TO}{_NUMBER}{_UNIT}"),
    "triangular": re.compile(rf"triangular\s+{_NUMBER}{_TO}{_NUMBER}{_TO}{_NUMBER}{_UNIT}"),
    "normal": re.compile(rf"normal\s+{_NUMBER}{_UNIT}\s*(?:\+-|±)\s*{_NUMBER}{_UNIT}"),
}
_COUNTS = {"uniform": 2, "triangular": 3, "normal": 2}
"""Number of parameters of each distribution."""
_NO_UNIT = re.compile(rf"(?:[a-z]+\s+)?{_NUMBER}(?:{_TO}{_NUMBER})*(?:\s*(?:\+-|±)\s*{_NUMBER})?\s*(?::\s*[0-9]+)?")
_OTHER = "it has another form"
_UNITLESS = 'it has no unit ("1" where there is none)'
_BARE = "it must be text of numbers with a unit, or quantities of pint, each with its unit"
_HELP = (
    '"600..900 kN/m:40" for a grid; "600..900 kN/m", "normal 712 kN/m +- 5 kN/m" or "triangular 690..710..740 kN/m" '
    "for samples"
)


def distributions(spreads):
    """Distribution and unit of each parameter of a table of designs.

    Parameters
    ----------
    spreads : dict of parameter to text or quantities
        As for `designs.sample`.

    Returns
    -------
    dict of parameter to (distribution, unit)
        Frozen distributions of scipy.stats, and the unit of their values.

    Raises
    ------
    ParameterError
        A spread has another form, or its unit is unknown; the message lists all faults.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found, unit = ks.designs.distributions({"spring.stiffness": "normal 712 kN/m +- 5 kN/m"})["spring.stiffness"]
    >>> float(found.mean()), float(found.std()), unit
    (712.0, 5.0, 'kN/m')
    """
    return {name: (found.distribution, found.unit) for name, found in read_spreads(spreads, parse_spread).items()}


def read_spreads(spreads, reader):
    """Result of ``reader(spread)`` by parameter; one `ParameterError` lists all its `ValueError`."""
    require_mapping(spreads)
    found, problems = {}, [] if spreads else ["there are no parameters"]
    for name, given in spreads.items():
        try:
            found[name] = reader(given)
        except ValueError as error:
            problems.append(f"cannot read {quoted(given)} for {name}: {error}")
    if any(fault in problem for problem in problems for fault in (_OTHER, _UNITLESS, _BARE)):
        problems.append(f"write {_HELP}")
    checks.require("designs", *problems)
    return found


def require_mapping(spreads):
    """Raise `ParameterError` unless spreads are a mapping."""
    form = '{"slider.mass": "500..700 kg"}'
    told = isinstance(spreads, Mapping)
    checks.require("designs", None if told else f"spreads must be a dict, as {form}, got {checks.shown(spreads)}")


def _text(text):
    if len(text) > MAX_TEXT_LENGTH:
        raise ValueError(f"it is longer than {MAX_TEXT_LENGTH} letters")
    if "..." in text:  # 0...1 may mean 0 to 1 or 0 to 0.1
        raise ValueError(f"{_OTHER}; write two dots between numbers, and a 0 before a decimal point")
    return text.strip()


def _quantity_numbers(given):
    """Numbers of one or several pint quantities, and the unit of the first."""
    parts = given if isinstance(given, list | tuple) else [given]
    if not parts or not all(map(checks.is_quantity, parts)):
        raise ValueError(_BARE)
    unit = unit_of_quantity(parts[0])
    try:
        numbers = np.asarray(checks.to_plain(given, unit))
    except checks.DimensionError as fault:
        raise ValueError(f"it {fault}") from None
    if numbers.dtype.kind not in "iuf":
        raise ValueError("the values must be real numbers")
    if numbers.ndim > 1 or not numbers.size:
        raise ValueError(f"values must stand in a row, got an array of shape {numbers.shape}")
    return _finite(np.ravel(numbers).astype(float).tolist()), unit


def parse_grid(given):
    """Values of a grid, from a text or quantities, and their unit."""
    if not isinstance(given, str):
        values, unit = _quantity_numbers(given)
        return np.array(values), unit
    text = _text(given)
    match = _FORMS["grid"].fullmatch(text)
    if not match or not int(match[4]):
        raise ValueError(_form_problem(text))
    low, high = _numbers(match[1], match[2])
    if int(match[4]) > MAX_TABLE_VALUES:
        raise ValueError(f"{match[4]} values are too many, at most {MAX_TABLE_VALUES}")
    return np.linspace(low, high, int(match[4])), _checked_unit(match[3])


class Spread(NamedTuple):
    """Distribution of a number: its kind ("uniform", "triangular" or "normal"), numbers and their unit.

    The numbers are low, likeliest and high value of "triangular", low and high of "uniform", mean and standard
    deviation of "normal".
    """

    kind: str
    numbers: list
    unit: str

    @property
    def distribution(self):
        """Frozen distribution of scipy.stats."""
        from scipy import stats  # needs 0.9 s

        low, *middle, high = self.numbers
        if self.kind == "normal":
            return stats.norm(low, high)
        if self.kind == "uniform":
            return stats.uniform(low, high - low)
        return stats.triang((middle[0] - low) / (high - low), low, high - low)

    @property
    def median(self):
        """Median of the values."""
        low, *middle, high = self.numbers
        if self.kind == "normal":
            return low
        if self.kind == "uniform" or 2.0 * middle[0] == low + high:
            return 0.5 * (low + high)
        end, other = (low, high) if 2.0 * middle[0] > low + high else (high, low)  # the end far from the likeliest
        return end + math.copysign(math.sqrt(0.5 * (other - end) * (middle[0] - end)), other - end)

    @property
    def deviation(self):
        """Standard deviation of the values."""
        low, *middle, high = self.numbers
        if self.kind == "normal":
            return high
        if self.kind == "uniform":
            return math.sqrt((high - low) ** 2 / 12.0)
        return math.sqrt(((high - low) ** 2 - (middle[0] - low) * (high - middle[0])) / 18.0)


def parse_spread(given):
    """`Spread` of a text or quantities; `ValueError` for any other value."""
    spread = Spread(*_parts(given))
    if spread.kind != "normal":
        if spread.numbers[0] >= spread.numbers[-1] or sorted(spread.numbers) != spread.numbers:
            raise ValueError("the values must rise")
    elif spread.numbers[1] <= 0:
        raise ValueError("the standard deviation must be greater than 0")
    return spread


def _parts(given):
    """Kind, numbers and unit of a spread."""
    if not isinstance(given, str):
        named = isinstance(given, list | tuple) and len(given) > 1 and isinstance(given[0], str)
        name, quantities = (given[0], given[1:]) if named else ("uniform", given)
        if name not in _COUNTS:
            raise ValueError(checks.choice("its kind", name, tuple(_COUNTS)))
        numbers, unit = _quantity_numbers(quantities)
        if len(numbers) != _COUNTS[name]:
            raise ValueError(f"{name} takes {_COUNTS[name]} quantities, got {len(numbers)}")
        return name, numbers, unit
    text = _text(given)
    forms = ((name, _FORMS[name].fullmatch(text)) for name in _COUNTS)
    name, match = next(((name, match) for name, match in forms if match), ("", None))
    if match is None:
        raise ValueError(_form_problem(text))
    if name != "normal":
        *texts, unit = match.groups()
        return name, _numbers(*texts), _checked_unit(unit)
    mean, deviation = _numbers(match[1], match[3])
    return name, [mean, deviation * factor(match[4], _checked_unit(match[2])) / base_factor(match[2])], match[2]


def _form_problem(text):
    if _NO_UNIT.fullmatch(text):
        return _UNITLESS
    return _OTHER + respelling_advice(text, lambda reading: any(form.fullmatch(reading) for form in _FORMS.values()))


def _checked_unit(unit):
    """The unit, if it is one."""
    base_factor(unit)
    return unit


def _numbers(*texts):
    return _finite([float(text) for text in texts])


def _finite(values):
    if not np.all(np.isfinite(values)):
        raise ValueError("the values must be finite")
    return values

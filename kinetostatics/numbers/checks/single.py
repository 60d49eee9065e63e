"""Single numbers: what takes one number by name, and no arrays of designs."""

import warnings

import numpy as np

from ...errors import HintWarning
from .problems import require, shown
from .rules import Number
from .usual import unusual
from .values import known


def single(name, value, unit, *, high=None, unequal=None, **rule):
    """One number in a unit as a float, and what is wrong with it, as a sentence, or None; `rule` as for `Number`."""
    found, problem = Number(unit, name, **rule).taken(value)
    if isinstance(value, list | tuple) or (problem is None and (not known(found) or np.ndim(found))):
        problem = f"{name} must be one number, got {shown(value)}"
    if problem is None and high is not None and not found < high:
        problem = f"{name} must be less than {high:.9g}, got {found:.9g}"
    if problem is None and found == unequal:
        problem = f"{name} must not be {unequal:g}"
    return found, problem


def singles(owner, *problems, **given):
    """Single numbers by name, each given as (value, unit, rule); one `ParameterError` for all that is wrong.

    A rule may have another name for messages. About numbers beyond what their rules call usual one warning asks.
    """
    found = {
        field: single(value=value, unit=unit, **{"name": field} | rule) for field, (value, unit, rule) in given.items()
    }
    require(owner, *(problem for _, problem in found.values()), *problems)
    values = {field: value for field, (value, _) in found.items()}
    odd = (
        unusual(rule.get("name", field), values[field], rule["usual"]._replace(unit=unit))
        for field, (_, unit, rule) in given.items()
        if "usual" in rule
    )
    if text := "; ".join(filter(None, odd)):
        warnings.warn(HintWarning(owner, text), stacklevel=3)
    return values

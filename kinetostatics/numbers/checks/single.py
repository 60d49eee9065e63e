"""Single numbers: what takes one number by name, and no arrays of designs."""

import numpy as np

from .problems import require, shown
from .rules import Number
from .values import known


def single(name, value, unit, *, high=None, **rule):
    """One number in a unit as a float, and what is wrong with it, as a sentence, or None; `rule` as for `Number`."""
    found, problem = Number(unit, name, **rule).taken(value)
    if problem is None and (not known(found) or np.ndim(found)):
        problem = f"{name} must be one number, got {shown(value)}"
    if problem is None and high is not None and not found < high:
        problem = f"{name} must be less than {high:.9g}, got {found:.9g}"
    return found, problem


def singles(owner, *problems, **given):
    """Single numbers by name, each given as (value, unit, rule); one `ParameterError` for all that is wrong."""
    found = {name: single(name, value, unit, **rule) for name, (value, unit, rule) in given.items()}
    require(owner, *(problem for _, problem in found.values()), *problems)
    return {name: value for name, (value, _) in found.items()}

"""Functions of loads must be pure: the same force whenever they are asked at the same crank angles.

Engines call them as often as they need: once for all crank angles, once while a program is recorded, or again between
the angles. What a counter, a random number or a clock adds would differ from engine to engine, in silence.
"""

from contextlib import suppress
from dataclasses import replace
from typing import Any
from weakref import WeakSet

import numpy as np

from ..errors import ParameterError
from ..machine.loads import Load, Table, is_given
from .pushes import moving, title_of

FEW = 2
"""Crank angles at which a function is called twice."""
_known_pure: Any = WeakSet()


def require_pure(motion):
    """Raise `ParameterError` if a function of the user's gives two forces at the same crank angles.

    Each function is called twice at a few angles, the first time that a motion with it is looked at; one that cannot
    be called there is left to whoever needs its values, who says why.
    """
    for item in motion.loads:
        function = _function_of(item)
        if function is None or _is_known(function):
            continue
        _require_same_twice(item, function, motion)
        with suppress(TypeError):  # from an object that takes no weak references, or has no hash
            _known_pure.add(getattr(function, "__func__", function))


def _is_known(function):
    """Whether a function, or the one behind a method, was called twice before."""
    try:
        return getattr(function, "__func__", function) in _known_pure
    except TypeError:
        return False


def _function_of(item):
    """Code of the user's that gives the force of a load, or None."""
    if is_given(item):
        return None
    if not isinstance(item, Load):
        return item.push
    return None if type(item.value_now) is Table else item.value_now


def _require_same_twice(item, function, motion):
    angle = motion.crank_angle
    if not isinstance(angle, np.ndarray) or angle.dtype != float:
        return
    try:
        varies = any(
            np.ndim(part) and np.shape(part)[-1] > 1 for part in (motion.crank_speed, motion.crank_acceleration)
        )
        few = motion if angle.ndim == 0 or varies else replace(motion, crank_angle=angle[..., :FEW])
        first, second = (np.asarray(getattr(found, "magnitude", found), dtype=float) for found in _twice(function, few))
        differ = np.ravel(first != second) & ~np.ravel(np.isnan(first) & np.isnan(second))
    except Exception:
        return
    if differ.any():
        here, there = (np.ravel(values)[differ][0] for values in (first, second))
        unit = getattr(item, "UNIT", "N")
        raise ParameterError(
            f"{title_of(item)}: its function gives {here:.9g} {unit} and then {there:.9g} {unit} at the same crank "
            "angle; it must be pure, a function of the motion alone, since engines call it as often as they need: keep "
            "no counter, random number or clock in it"
        )


def _twice(function, motion):
    with np.errstate(all="ignore"):
        return [function(moving(motion)) for _ in range(2)]

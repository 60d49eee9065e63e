"""Values of loads at the crank angles of a motion, and checks of the user's functions.

A function of a load must be pure, with equal values at equal crank angles. Engines call it any number of times: for all
crank angles, while a program is recorded, or between the angles. Its motion has no forces, because forces follow from
its values.
"""

from contextlib import suppress
from dataclasses import replace
from typing import Any
from weakref import WeakSet

import numpy as np

from ..errors import ParameterError
from ..machine.kinematic_state import require_sense
from ..machine.links import present
from ..machine.loads import Load, Table, has_no_user_code
from ..numbers import checks
from ..numbers.arithmetic import is_foreign_array
from ..numbers.parameter_tree import replace_unchecked
from .motion import Motion

VALUE_NAMES = {"N m": "torque", "Pa": "resistance"}
"""Kind of the result of a load's function by its unit, if it is not a force."""
SPEED_AT_REST = 1e-150
"""Crank speed, rad/s, for functions at rest, times the sense of rotation or the crank acceleration.

It gives velocities the sense of the motion about to begin, and is negligible relative to any other speed."""
MOTION_MEMBERS = (
    "crank_angle",
    "crank_speed",
    "crank_acceleration",
    "crank_sense",
    *(f"{name}(point)" for name in ("position", "velocity", "acceleration")),
    *(f"{name}(link)" for name in ("rate", "angular_acceleration")),
    *(f"{name}(slider)" for name in ("travel", "travel_velocity", "travel_acceleration")),
    *("slider_position", "slider_velocity", "slider_acceleration", "elongation(free_position, slider)"),
    "measure(name)",
    "mechanism",
)
"""Members of a motion that its functions may read."""


class ForceFreeMotion(Motion):
    """Motion as a load's function sees it: without forces, which follow from the function's values."""

    @property
    def crank_sense(self):
        """Sense of rotation; raises an error where the crank rests without acceleration."""
        require_sense("a function of the motion uses crank_sense", self)
        return super().crank_sense

    def __getattr__(self, name):
        if name.startswith("_"):
            raise AttributeError(name)
        raise UnknownForceError(
            f"a function of the motion uses {name!r}, which is missing, as forces follow from the function; it "
            f"may use {', '.join(MOTION_MEMBERS)}"
        )


class UnknownForceError(ParameterError, AttributeError):
    """A load's function reads a quantity that is computed from the load."""


class WatchedMotion(ForceFreeMotion):
    """Motion that records in `asked` the use of crank speed, acceleration and sense, directly or by velocities."""

    def __getattribute__(self, name):
        if name in ("crank_speed", "crank_acceleration", "sense"):
            vars(self).setdefault("asked", set()).add(name)
        return super().__getattribute__(name)


def drive_dependence(item, motion):
    """Subset of crank_speed, crank_acceleration and sense that a load's function reads."""
    watched = without_forces(motion, WatchedMotion)
    vars(watched)["asked"] = set()
    (item.value_now if isinstance(item, Load) else item.push)(watched)
    return vars(watched)["asked"]


def without_forces(motion, kind=ForceFreeMotion):
    """The motion without forces, for functions of loads."""
    begins = present(motion.crank_acceleration if motion.sense is None else motion.sense)
    speed = motion.crank_speed if begins is None else motion.crank_speed + SPEED_AT_REST * begins
    made = kind(motion.mechanism, motion.crank_angle, speed, motion.crank_acceleration, sense=motion.sense)
    vars(made).update(shape=motion.shape, placement=motion.placement)
    return made


def evaluate_load(item, motion):
    """The load with values at the crank angles of a motion instead of its table or function."""
    return item if has_no_user_code(item) else replace_unchecked(item, **{item.VALUE: user_value(item, motion)})


def user_value(item, motion):
    """Checked values of a load's table or function, a force or moment, or of its push, (..., N) or a number."""
    if not getattr(item, "VALUE", ""):
        return slider_push(item, motion)
    return _checked(item, item.value_now(without_forces(motion)), motion)


def slider_push(item, motion):
    """Force of a load on its slider, N; the result of a user's code is checked, or `ParameterError`."""
    if isinstance(item, Load):
        return evaluate_load(item, motion).push(motion)
    return _checked(item, item.push(without_forces(motion)), motion)


def title_of(item):
    """Name of a load in messages."""
    return item.title if isinstance(item, Load) else f"{type(item).__name__} on {item.on!r}"


def numbered_titles(loads):
    """Title of each load; equal titles are numbered from the second: "Torque on 'crank' #2"."""
    titles = [title_of(item) for item in loads]
    numbers = [titles[: place + 1].count(title) for place, title in enumerate(titles)]
    return [f"{title} #{number}" if number > 1 else title for title, number in zip(titles, numbers, strict=True)]


def _checked(item, found, motion):
    if isinstance(found, np.ndarray) and found.dtype == object:
        return found
    unit, title = getattr(item, "UNIT", "N"), title_of(item)
    found = checks.to_plain_named(title, "what its function returns", found, unit.replace(" ", "*"))
    owner, what = f"{title}: its function", VALUE_NAMES.get(unit, "force")
    wanted = f"must return its {what} in {unit}, a number or an array of shape {motion.shape}, one for each crank angle"
    words = None if hasattr(found, "to_numpy") else checks.not_a_number(found)
    if words:
        raise ParameterError(f"{owner} {wanted}, got {checks.shown(found)}, {words.format(unit=unit)}")
    if is_foreign_array(found):
        return found
    array = np.asarray(found)
    if array.dtype == object and array.ndim == 0 and hasattr(found, "__mul__"):  # a recorded number, an enclosure
        return found
    if array.dtype.kind not in "fiu":
        raise ParameterError(f"{owner} {wanted}, got {str(found)[:60]}")
    try:
        fits = np.broadcast_shapes(array.shape, motion.shape) == motion.shape
    except ValueError:
        fits = False
    if not fits:
        raise ParameterError(f"{owner} {wanted}, got shape {array.shape}")
    if not np.isfinite(array).all():
        wrong = np.broadcast_to(~np.isfinite(array) & motion.closed, motion.shape)
        if wrong.any():
            angle = np.broadcast_to(motion.crank_angle, motion.shape)[wrong]
            places = ", ".join(f"{place:.6g}" for place in np.degrees(angle[:3]))
            raise ParameterError(
                f"{owner} must return finite {what}s, got {np.broadcast_to(array, motion.shape)[wrong][0]} at "
                f"{angle.size} crank angles, the first {places} deg",
                wrong.any(axis=-1) if wrong.ndim > 1 else None,
            )
    return array if array.dtype.kind == "f" else array.astype(float)


PURITY_ANGLES = 2
"""Number of crank angles at which a function is called twice."""
_pure_functions: Any = WeakSet()


def require_pure(motion):
    """Raise `ParameterError` if a user's function, on first use, returns two forces at the same crank angles."""
    for item in motion.loads:
        if has_no_user_code(item):
            continue
        function: Any = item.value_now if isinstance(item, Load) else item.push
        tested = getattr(function, "__func__", function)
        with suppress(TypeError):  # from an object without weak references or hash
            if tested in _pure_functions:
                continue
        if type(function) is not Table:
            _require_same_twice(item, function, motion)
            with suppress(TypeError):
                _pure_functions.add(tested)


def _require_same_twice(item, function, motion):
    angle = motion.crank_angle
    if not isinstance(angle, np.ndarray) or angle.dtype != float:
        return
    try:
        varies = any(
            np.ndim(part) and np.shape(part)[-1] > 1 for part in (motion.crank_speed, motion.crank_acceleration)
        )
        few = motion if angle.ndim == 0 or varies else replace(motion, crank_angle=angle[..., :PURITY_ANGLES])
        with np.errstate(all="ignore"):
            twice = [function(without_forces(few)) for _ in range(2)]
        first, second = (np.asarray(getattr(found, "magnitude", found), dtype=float) for found in twice)
        differ = np.ravel(first != second) & ~np.ravel(np.isnan(first) & np.isnan(second))
    except Exception:
        return
    if differ.any():
        here, there = (np.ravel(values)[differ][0] for values in (first, second))
        unit = getattr(item, "UNIT", "N")
        raise ParameterError(
            f"{title_of(item)}: its function gives {here:.9g} {unit} and then {there:.9g} {unit} at the same crank "
            "angle. It must be pure, a function of the motion alone, because engines call it any number of times; "
            "use no counter, random number or clock in it"
        )

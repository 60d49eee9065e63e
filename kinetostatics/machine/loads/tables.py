"""Tables of values: by crank angle."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...numbers import checks
from .load import TURN, WholeTurns


@dataclass(frozen=True, eq=False, init=False)
class Tabulated:
    """Function of the motion that interpolates a table of force by crank angle.

    Linear between the rows, and from the last to the first of the next period. It passes through every row, adds no
    extrema between them, and has a kink at each.

    Parameters
    ----------
    angle : array (N,)
        Crank angles, rad, rising or falling, over one period; its end may be given too, with the force of the start.
    force : array (N,)
        N.
    period : float
        Crank angle after which the force repeats, rad: 2 pi or a whole multiple of it.

    Raises
    ------
    ParameterError
        Fewer than three rows, angles that do not rise, rows over more or less than a period, unequal ends.
    """

    angle: Any = field(repr=False)
    force: Any = field(repr=False)
    period: float = field(default=TURN, metadata={"structural": True})

    TABULATED = True

    def __init__(self, angle, force, period=TURN):
        checks.require(
            "table of force",
            checks.table("angle", angle),
            checks.table("force", force),
            WholeTurns().taken(period, "period")[1],
        )
        angle, force = (np.array(values, dtype=float) for values in (angle, force))
        fits = angle.ndim == 1 and angle.shape == force.shape
        checks.require("table of force", None if fits else "angle and force must be 1-D, of one length")
        if angle.size > 1 and angle[0] > angle[-1]:
            angle, force = angle[::-1], force[::-1]
        checks.require("table of force", _rows_problem(angle, force, period))
        if _closes(angle, period):
            angle, force = angle[:-1], force[:-1]
        for name, values in (("angle", angle), ("force", force)):
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        object.__setattr__(self, "period", WholeTurns().taken(period)[0])

    @property
    def kinks(self):
        """Crank angles at which it has kinks, rad."""
        return self.angle

    def __call__(self, motion):
        return np.interp(motion.crank_angle, self.angle, self.force, period=self.period)

    @property
    def _content(self):
        return self.angle.tobytes(), self.force.tobytes(), self.period

    def __eq__(self, other):
        return self._content == other._content if isinstance(other, Tabulated) else NotImplemented

    def __hash__(self):
        return hash(self._content)


def _closes(angle, period):
    """Whether the last row stands at the angle of the first, a period later, but for rounding."""
    return abs(angle[-1] - angle[0] - period) < min(0.1 * np.median(np.diff(angle)), 0.005)


def _rows_problem(angle, force, period):
    """What is wrong with rows of a table in order, or None."""
    if angle.size < 3:
        return f"at least 3 rows are needed, got {angle.size}; a force that does not change is no table"
    step, span = np.diff(angle), angle[-1] - angle[0]
    if np.any(step <= 0):
        row = int(np.argmax(step <= 0)) + 1
        return (
            f"angles must rise, but {_degrees(angle[row])} follows {_degrees(angle[row - 1])}; for a jump give two "
            "angles close together"
        )
    if _closes(angle, period):
        unequal = abs(force[-1] - force[0]) > 1e-9 * np.max(np.abs(force))
        return (
            f"the force must end as it began, a period of {_degrees(period)} before, but is {force[0]:.9g} N at "
            f"{_degrees(angle[0])} and {force[-1]:.9g} N at {_degrees(angle[-1])}; leave one of these rows out"
            if unequal
            else None
        )
    if span > period:
        turns = math.ceil(span / TURN - 1e-9)
        remedy = f'if it repeats after {turns} turns, give period = "{360 * turns} deg" ({2 * turns} pi in Python)'
        if turns > 8:
            remedy = "are they degrees under a heading of rad?"
        return f"the angles span {_degrees(span)}, more than the period of {_degrees(period)}; {remedy}"
    return _missing(angle, force, period, step)


def _missing(angle, force, period, step):
    """What is wrong with the distances between rows, or None."""
    rest = period - (angle[-1] - angle[0])
    if rest > 1.5 * step.max():
        return (
            f"rows are missing: they end at {_degrees(angle[-1])}, {_degrees(rest)} before the next begins at "
            f"{_degrees(angle[0] + period)} (period {_degrees(period)}); if the force runs straight between them "
            f"repeat the first row at {_degrees(angle[0] + period)}; are the angles in the unit of their heading?"
        )
    wide = (step > max(5 * float(np.median(step)), math.radians(20.0))) & (np.diff(force) != 0)
    if np.any(wide):
        row = int(np.argmax(wide))
        return (
            f"rows are missing between {_degrees(angle[row])} and {_degrees(angle[row + 1])}; if the force runs "
            "straight between them add a row halfway"
        )
    return None


def _degrees(angle):
    return f"{math.degrees(angle):.9g} deg"

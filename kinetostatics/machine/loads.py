"""Loads on the links besides inertia: weight, spring, process force."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from ..numbers import checks
from ..numbers.batched import Batched
from .crank import ray

TURN = 2 * math.pi
MOST_TURNS = 100
"""Turns after which loads must repeat, all together."""


class WholeTurns:
    """Rule of a period: 2 pi or a whole multiple of it, but for rounding, which is taken away."""

    def quick(self, value):
        return value if value is TURN else checks.UNSURE

    def taken(self, value, field=""):
        number = isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
        turns = value / TURN if number else 0.0
        if round(turns) >= 1 and abs(turns - round(turns)) < 1e-9 * turns:
            many = f"{field} must be at most {MOST_TURNS} turns, got {round(turns):.6g}"
            return round(turns) * TURN, many if round(turns) > MOST_TURNS else None
        return value, f"{field} must be 2 pi or a whole multiple of it, got {checks.shown(value)}"


@dataclass(frozen=True, eq=False)
class Gravity(checks.Checked, Batched):
    """Weight of every link.

    Parameters
    ----------
    acceleration : float
        m/s2.
    direction : float
        Angle of the direction it pulls in, from +x, rad; straight down (-pi/2) unless told.
    """

    acceleration: Any = 9.81
    direction: Any = -math.pi / 2

    PATH = "gravity"
    RULES = checks.Rules("gravity", acceleration=checks.Number("m/s**2", low=0.0), direction=checks.Number("rad"))

    @cached_property
    def vector(self):
        """Components (x, y), m/s2."""
        x, y = ray(self.direction)
        return self.acceleration * x, self.acceleration * y


@dataclass(frozen=True, eq=False)
class Spring(checks.Checked, Batched):
    """Linear spring along the guide, acting at the slider pin.

    Parameters
    ----------
    stiffness : float or array
        N/m, all springs together.
    free_position : float or array
        Coordinate of B along the guide (B . guide direction) at which the spring is free, m.
    on : str
        The slider it acts on.
    """

    stiffness: Any
    free_position: Any
    on: str = "slider"

    PATH, ELEMENTWISE = "spring", True
    RULES = checks.Rules(
        "spring", stiffness=checks.Number("N/m", low=0.0), free_position=checks.Number("m"), on=checks.Name()
    )

    @classmethod
    def balancing(cls, mass, crank_speed, free_position, on="slider"):
        """Spring that balances a slider of `mass` (kg) moving by a cosine law at `crank_speed` (rad/s).

        Its stiffness, mass times crank speed squared, makes spring and inertia force equal and opposite all the way.
        """
        given = {"mass": mass, "crank_speed": crank_speed}
        rules = {"mass": checks.Number("kg", low=0.0), "crank_speed": checks.Number("rad/s")}
        mass, crank_speed = checks.examined("balancing spring", rules, given).values()
        return cls(mass * crank_speed * crank_speed, free_position, on)

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return -self.stiffness * motion.elongation(self.free_position, self.on)


@dataclass(frozen=True, eq=False)
class ProcessForce(checks.Checked, Batched):
    """Cutting, gas or other force on the slider along the guide, positive in the guide direction.

    Parameters
    ----------
    force : float, array or function
        N; an array has one value for each crank angle; a function takes the `Motion` and returns such values, so the
        force may depend on crank angle, position or velocity, at each crank angle by itself. The compiled engine takes
        its constants into the program, so a function with other constants is compiled anew.
    on : str
        The slider it acts on.
    period : float
        Crank angle after which the force repeats, rad: 2 pi unless told, 4 pi for a four-stroke engine.
    """

    force: Any
    on: str = "slider"
    period: float = field(default=TURN, kw_only=True, metadata={"structural": True})

    PATH, OVER_ANGLES = "process_force", ("force",)

    def _periods(self):
        """Say where the force has a period of its own."""
        known = getattr(self.force, "period", self.period)
        if known != self.period:
            yield f"the period is {self.period!r}, but that of its force {known!r}"

    RULES = checks.Rules(
        "process force",
        _periods,
        force=checks.OrFunction(checks.Number("N", table=True)),
        on=checks.Name(),
        period=WholeTurns(),
    )

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return self.force(motion) if callable(self.force) else self.force


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
    period: float = TURN

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


def period_of(loads, turns=1):
    """Crank angle after which all loads repeat, rad: the turns that their periods have in common, or so many."""
    return TURN * math.lcm(turns, *(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))


def is_given(item):
    """Whether a load is numbers, checked when it was made, and no code of the user's."""
    return isinstance(item, Gravity | Spring) or (isinstance(item, ProcessForce) and not callable(item.force))

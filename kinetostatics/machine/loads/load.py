"""What a load is: the protocol by which everything else asks it.

A load is a frozen dataclass derived from `Load`. It acts in one of two ways:

    wrenches(motion)    pairs of a link's name and the `Wrench` on it about its reference joint; on the frame they end
    push(motion)        force on the slider `on` along its guide, kept apart as it may nearly cancel with inertia

from what a `Motion` knows: places and rates, by arithmetic alone. ``VALUE`` names the field that may hold an array over
the crank angles, a `Table` or a function of the motion instead of a number, ``UNIT`` its unit; whoever asks puts what
such a function gives in its place before (`settled` in mechanics/pushes.py). ``LENGTHS`` names the fields that hold
lengths and angles of the geometry. ``potential(motion)``, of loads that have one, is their potential energy, J.
``problems(mechanism)`` says what is wrong with a load on that mechanism, ``refusals(motion)`` where it has no value.
"""

import math
from typing import Any, ClassVar

from ...numbers import checks
from ...numbers.batched import Batched

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


class Load(checks.Checked, Batched):
    """What all loads have in common; see the module."""

    PATH: ClassVar[str] = ""
    VALUE: ClassVar[str] = ""
    UNIT: ClassVar[str] = "N"
    LENGTHS: ClassVar[tuple[str, ...]] = ()

    @property
    def value_now(self) -> Any:
        """What stands for its force or moment: a number, an array, a table or a function; None if that is fixed."""
        return getattr(self, self.VALUE) if self.VALUE else None

    @property
    def is_given(self):
        """Whether it is numbers, checked when it was made, and no code of the user's."""
        return not callable(self.value_now)

    @property
    def period(self) -> float:
        """Crank angle after which it repeats, rad."""
        return getattr(self.value_now, "period", TURN)

    @property
    def title(self):
        """What messages call it."""
        return type(self).__name__

    def problems(self, mechanism):
        """What is wrong with it on a mechanism, as sentences."""
        return ()

    def refusals(self, motion):
        """Where it has no value, as sentences."""
        return ()


def period_of(loads):
    """Crank angle after which all loads repeat, rad: the turns that their periods have in common, one at least."""
    return TURN * math.lcm(*(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))


def is_given(item):
    """Whether a load is numbers, checked when it was made, and no code of the user's."""
    return isinstance(item, Load) and item.is_given


def value_of(item):
    """What stands for the force or moment of a load, also of one of the user's own; None if that is fixed."""
    return item.value_now if isinstance(item, Load) else getattr(item, "force", None)


def refusals(motion):
    """Where loads have no value at the crank angles of a motion, as sentences."""
    return [text for item in motion.loads if isinstance(item, Load) for text in item.refusals(motion)]


def valued(unit):
    """Rule of what is a number, an array over the crank angles, a table, or a function of the motion."""
    return checks.OrFunction(checks.Number(unit, table=True))

"""What a law of motion is: a position as function of the crank angle with three exact derivatives."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from .rises import Motion

TURN = 2 * np.pi


class Law:
    """A position over the whole turn, m, with three derivatives by the crank angle: ``law(phi)``.

    A law of one's own needs no more than to be called so; `knots` says at which angles its jerk or its acceleration
    jumps, if it does.
    """

    @property
    def knots(self) -> tuple[float, ...]:
        """Crank angles at which the jerk may jump, rad."""
        return ()

    def __call__(self, phi) -> Motion:
        raise TypeError(f"{type(self).__name__} must define __call__(phi) -> position, velocity, acceleration, jerk")

    def shifted(self, phase):
        """The same law, later by a phase, rad."""
        return Shifted(self, **checks.singles("law", phase=(phase, {"unit": "rad"})))


@dataclass(frozen=True, eq=False)
class Shifted(Law):
    """A law that comes later by a phase, rad."""

    law: Any
    phase: float

    @property
    def knots(self):
        return tuple(knot + self.phase for knot in knots_of(self.law))

    @property
    def force_error(self):
        return getattr(self.law, "force_error", None)

    def __call__(self, phi):
        return self.law(angles(phi) - self.phase)


def knots_of(law):
    """Angles at which the jerk of a law jumps, or may; none where it does not say."""
    return tuple(getattr(law, "knots", ()))


def angles(phi):
    """Crank angles as an array, one for a single number."""
    try:
        return np.asarray(phi, dtype=float)
    except (TypeError, ValueError):
        raise ParameterError(f"law: crank angles must be numbers, rad, got {checks.shown(phi)}") from None

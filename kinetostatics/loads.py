"""Loads on the links besides inertia: weight, spring, process force."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from . import checks
from .batch import Batched
from .crank import ray


@dataclass(frozen=True, eq=False)
class Gravity(Batched):
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

    def __post_init__(self):
        checks.require(
            "gravity",
            checks.not_negative("acceleration", self.acceleration),
            checks.finite("direction", self.direction),
        )

    @cached_property
    def vector(self):
        """Components (x, y), m/s2."""
        x, y = ray(self.direction)
        return self.acceleration * x, self.acceleration * y


@dataclass(frozen=True, eq=False)
class Spring(Batched):
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

    def __post_init__(self):
        checks.require(
            "spring",
            checks.not_negative("stiffness", self.stiffness),
            checks.finite("free_position", self.free_position),
        )

    @classmethod
    def balancing(cls, mass, crank_speed, free_position, on="slider"):
        """Spring that balances a slider of `mass` (kg) moving by a cosine law at `crank_speed` (rad/s).

        Its stiffness, mass times crank speed squared, makes spring and inertia force equal and opposite all the way.
        """
        return cls(mass * crank_speed * crank_speed, free_position, on)

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return -self.stiffness * motion.elongation(self.free_position, self.on)


@dataclass(frozen=True, eq=False)
class ProcessForce(Batched):
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
        Crank angle after which a function repeats, rad: 4 pi for a four-stroke load.
    """

    force: Any
    on: str = "slider"
    period: float = field(default=2 * math.pi, kw_only=True)

    def __post_init__(self):
        if not callable(self.force):
            checks.require("process force", checks.table("force", self.force))

    def push(self, motion):
        """Force on the slider along the guide, N."""
        return self.force(motion) if callable(self.force) else self.force

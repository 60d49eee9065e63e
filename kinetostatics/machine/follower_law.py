"""What a cam on the crank tells its follower: the coordinate of the follower as function of the crank angle."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..numbers import checks
from ..numbers.lazy import cached_property
from .crank import ray as ray_at
from .law import bends_of, law_problem


@dataclass(frozen=True, eq=False)
class FollowerLaw:
    """The law of a follower, as engines ask cams: ``polar(angle, ray)`` gives its coordinate and two derivatives."""

    law: Any

    TABULATED = True
    RULES = checks.Rules("law of a follower")  # no number of it is a parameter by itself

    def __repr__(self):
        return f"<FollowerLaw by {type(self.law).__name__}>"

    @cached_property
    def knots(self):
        """Where the law bends or jumps, each a `Knot`."""
        return bends_of(self.law)

    @property
    def lengths(self):
        """Farthest from 0 that the follower gets, of some places on the turn."""
        return (float(np.max(np.abs(self.law(np.linspace(0.0, 2 * np.pi, 24))[0]))),)

    def polar(self, angle, ray):
        shape = np.shape(angle)
        angle = np.asarray(angle, dtype=float)
        return tuple(np.broadcast_to(np.asarray(part, dtype=float), shape) for part in self.law(angle)[:3])

    def radius(self, phi):
        """The same at crank angles, rad."""
        return self.polar(phi, ray_at(np.asarray(phi, dtype=float)))


class Lawful:
    """Rule of the field that holds it: a law of the whole turn, or what was made of one."""

    def quick(self, value):
        return value if type(value) is FollowerLaw else checks.UNSURE

    def taken(self, value, field=""):
        if type(value) is FollowerLaw:
            return value, None
        problem = law_problem(value)
        return (value, f"{field}: {problem}") if problem else (FollowerLaw(value), None)

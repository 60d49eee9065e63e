"""The solution of a machine in periodic running: at its true speed and acceleration, whatever the crank angles."""

from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import numpy as np

from ..numbers.parameter_tree import with_fields
from ..solution.angles import crank_angles, hint_at
from ..solution.solution import Solution
from .saving import DrivenComparison


@dataclass(frozen=True, eq=False)
class RunningSolution(Solution):
    """A `Solution` whose crank speed and acceleration are those of periodic running.

    `running` gives them at any crank angles, so that extremes, means and tables look between the angles given.
    """

    running: Any = None

    COMPARISON: ClassVar = DrivenComparison

    @classmethod
    def of(cls, running):
        """Solution of a `Running` at its crank angles."""
        scene = with_fields(running.scene, crank_speed=running.speed, crank_acceleration=running.acceleration)
        plain = scene.solve(running.crank_angle)
        return cls(**{field.name: getattr(plain, field.name) for field in fields(Solution)}, running=running)

    def __repr__(self):
        return super().__repr__().replace("<Solution", "<RunningSolution").split(", crank_speed=")[0] + (
            f", mean speed {self.running.mean_speed:.9g} rad/s>"
        )

    def at(self, crank_angle):
        """The same machine in the same running at other crank angles."""
        angle = crank_angles(crank_angle)
        hint_at(self.mechanism.name, crank_angle)
        motion = self.running.motion(angle)
        speed, acceleration = (float(part[0]) if part.shape == (1,) else np.asarray(part) for part in motion)
        return replace(self, crank_angle=angle, crank_speed=speed, crank_acceleration=acceleration)

    @property
    def period(self):
        """Crank angle after which running repeats, rad."""
        return self.running.period

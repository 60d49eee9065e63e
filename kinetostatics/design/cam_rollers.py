"""The roller itself: spin and sliding, load and life of its pin.

A roller that does not slide turns by v / R as its centre goes along the pitch curve at v, one way on a disk and the
other in a ring: where it changes sides it must reverse. The contact must drive it, J dv/dt / R^2 along the cam, and
against the friction of its pin.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from ..machine.loads import Gravity
from ..numbers import checks


class Reversal(NamedTuple):
    """The roller changing sides: crank angle, rad; change of its spin, rad/s; energy lost in sliding, J.

    `rise` is how fast the cam force grows there with the crank angle, N/rad.
    """

    angle: float
    spin: float
    energy: float
    rise: float

    def sliding_angle(self, roller, crank_speed, friction_coefficient):
        """Crank angle through which the roller slides until it rolls again, rad, as the force grows in proportion."""
        given = checks.singles(
            "sliding_angle",
            crank_speed=(crank_speed, "rad/s", {}),
            friction_coefficient=(friction_coefficient, "1", {"low": 0.0, "strict": True}),
        )
        grip = given["friction_coefficient"] * roller.radius * abs(self.rise)
        return float(np.sqrt(2.0 * abs(given["crank_speed"]) * roller.inertia * abs(self.spin) / grip))


@dataclass(frozen=True, eq=False)
class Roller:
    """What turns on the pin at A: radius m, mass kg, inertia about the pin kg m2, load rating of its bearing N."""

    cam: Any
    radius: float
    mass: float
    inertia: float
    load_rating: float | None
    life_exponent: float

    def speed(self, solution):
        """Of the roller's centre along the pitch curve, m/s, with its derivative by time, m/s2."""
        r, slope, second = self.cam.radius(solution.crank_angle)
        length = np.hypot(r, slope)
        rate = solution.crank_speed
        return length * rate, slope * (r + second) / length * rate * rate + length * solution.crank_acceleration

    def spin(self, solution):
        """Angular velocity of a roller that rolls without sliding, counter-clockwise positive, rad/s."""
        return np.where(solution.cam_force > 0.0, -1.0, 1.0) * self.speed(solution)[0] / self.radius

    def spin_acceleration(self, solution):
        """Its angular acceleration between changes of sides, rad/s2."""
        return np.where(solution.cam_force > 0.0, -1.0, 1.0) * self.speed(solution)[1] / self.radius

    def driving_force(self, solution):
        """What the contact must give along the cam for the roller to roll, against its motion, N."""
        _, growth = self.speed(solution)
        rubbing = np.abs(solution.friction_at("cam")) * solution.crank_sense
        return self.inertia * growth / self.radius**2 + rubbing

    def friction_coefficient(self, solution):
        """Least friction coefficient of the contact with which the roller does not slide."""
        with np.errstate(divide="ignore", invalid="ignore"):
            needed = np.abs(self.driving_force(solution)) / np.abs(solution.cam_force)
        return np.where(np.isnan(needed), 0.0, needed)

    def pin_load(self, solution):
        """Size of the force between roller and pin, N: the cam force less the roller's own inertia and weight."""
        r, slope, _ = self.cam.radius(solution.crank_angle)
        x, y = np.cos(solution.crank_angle), np.sin(solution.crank_angle)
        inward = -np.stack([r * x + slope * y, r * y - slope * x]) / np.hypot(r, slope)
        along = np.stack([-inward[1], inward[0]])
        force = inward * solution.cam_force + along * self.driving_force(solution)
        if self.mass:
            force = force - self.mass * solution.acceleration("A")
            for load in solution.loads:
                if isinstance(load, Gravity):
                    force = force + self.mass * np.array(load.vector, dtype=float)[:, None]
        return np.hypot(*force)

    def equivalent_load(self, solution):
        """Constant load of the same life, from a solution at even crank angles over the period, N.

        P^p = sum of F^p dn over sum of dn, n the turns of the roller about its pin (ISO 281; Harris and Kotzalas,
        *Rolling Bearing Analysis*, 2006).
        """
        load, turns = self.pin_load(solution), self._turns(solution)
        largest = float(np.max(load))
        if not largest:
            return 0.0
        share = np.sum((load / largest) ** self.life_exponent * turns) / np.sum(turns)
        return float(largest * share ** (1.0 / self.life_exponent))

    def life(self, solution):
        """Basic rating life L10, h, from the same."""
        if self.load_rating is None:
            raise ParameterError("contact: the life of the roller's bearing takes its load_rating, C in N")
        load = self.equivalent_load(solution)
        if not load:
            return np.inf
        rate = solution.crank_speed * np.ones(solution.crank_angle.shape)
        if not np.all(rate):
            raise ParameterError("contact: a machine that stands wears no bearing; solve it at its crank speed")
        turns = self._turns(solution)
        hours = np.sum(1.0 / np.abs(rate)) / 3600.0
        return float((self.load_rating / load) ** self.life_exponent * 1e6 * hours / np.sum(turns))

    def _turns(self, solution):
        """Turns of the roller about its pin in each of even steps of the crank angle, in units of the step / 1 rad."""
        rate = solution.crank_speed * np.ones(solution.crank_angle.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            turned = np.abs(self.spin(solution) - rate) / np.abs(rate)
        return np.where(np.isnan(turned), 1.0, turned) / (2.0 * np.pi)

    def reversal(self, solution, angle, step=1e-4):
        """What happens where the roller changes sides."""
        at = solution.at(angle + np.array([-step, 0.0, step]))
        rise = float(at.cam_force[2] - at.cam_force[0]) / (2.0 * step)
        spin = 2.0 * float(np.broadcast_to(self.speed(at)[0], (3,))[1]) / self.radius
        spin = -spin if rise > 0.0 else spin
        return Reversal(float(angle), spin, 0.5 * self.inertia * spin * spin, rise)

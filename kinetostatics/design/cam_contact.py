"""Contact of the roller with its cam over the turn: side, curvature, Hertz pressure, and what exceeds limits."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..machine.cams import roller
from ..machine.cams.profile import SAMPLES, Peak, curvature, highest, surface_curvature
from ..machine.cams.profile import profile as working_curve
from ..numbers.lazy import cached_property
from .cam_rollers import Roller
from .follower_speed import lift_off_speed, starting_torque
from .hardness import hardness_from_pressure

LIMITS = {
    "pressure": ("largest_pressure", "Pa", "Hertz pressure"),
    "pin_load": ("largest_pin_load", "N", "load of the roller's pin"),
    "friction_coefficient": ("largest_friction_coefficient", "1", "friction coefficient that keeps the roller rolling"),
    "starting_torque": ("starting_torque", "N m", "torque to start"),
}
"""Largest values that limits are set to: where each is found, unit, what it is."""
LEAST = {"life": ("h", "life of the roller's bearing"), "lift_off_speed": ("rad/s", "speed of lift-off")}
"""Smallest values that limits are set to: unit, what it is."""
OF_CURVE = {"pressure_angle": "rad", "curvature_radius": "m"}
UNITS = {name: of[-2] for name, of in (*LIMITS.items(), *LEAST.items())} | OF_CURVE
"""Unit of each limit."""


@dataclass(frozen=True, eq=False)
class Contact:
    """The roller on its cam over the turn; made by `contact`.

    Attributes
    ----------
    solution : Solution
    cam : Cam
    roller_radius, width : float
        m.
    modulus : float
        E* of both materials together, Pa.
    roller : Roller
        What turns: its spin, its pin, its life.
    limits : dict of str to float

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    >>> saw = ks.cam_crank_slider(cam, 2.02, slider=ks.Link(600.0))
    >>> found = ks.design.contact(ks.Scene(saw, 10.0).solve(4), 0.05, 0.04, 210e9, 0.3)
    >>> found.sides, (found.pressure / 1e6).round(1)  # MPa
    (('disk', 'ring'), array([532.4,  25.1, 523.9,  25.1]))
    """

    solution: Any = field(repr=False)
    cam: Any
    roller_radius: float
    width: float
    modulus: float
    roller: Roller = field(repr=False)
    limits: dict[str, float] = field(repr=False, default_factory=dict)

    def __repr__(self):
        peak = self.largest_pressure
        lines = [
            f"<Contact: {self.solution.mechanism.name}, roller radius {self.roller_radius:.6g} m",
            f"  side             {' and '.join(self.sides)}, {len(self.changes)} changes a period",
            f"  largest pressure {peak.value / 1e6:.6g} MPa at {np.degrees(peak.angle):.6g} deg",
            *(f"  exceeded         {text}" for text in self.exceeded),
            *(
                []
                if self.force_error is None
                else [f"  uncertain        forces by {self.force_error:.2g} of the largest"]
            ),
        ]
        return "\n".join(lines) + ">"

    @property
    def force_error(self):
        """Expected largest error of forces, relative to the largest, of a cam from a table; None of others."""
        return getattr(self.cam, "force_error", None)

    # over the crank angle

    @property
    def crank_angle(self):
        """The solution's, rad."""
        return self.solution.crank_angle

    @property
    def cam_force(self):
        """Of the cam on the roller along the normal, N, positive toward the inside of the pitch curve."""
        return self.solution.cam_force

    @property
    def side(self):
        """Which side of the cam carries the roller, at each crank angle: "ring" outside it or "disk" inside."""
        return np.where(self.cam_force > 0.0, "ring", "disk")

    @property
    def curvature_radius(self):
        """Radius of the working curve that carries the roller, m: positive where convex, negative where hollow."""
        bend = surface_curvature(self._bend, self.roller_radius, _side_of(self.cam_force))
        with np.errstate(divide="ignore"):
            return 1.0 / bend

    @property
    def relative_radius(self):
        """Radius of the cylinder that presses a plane as the roller does the cam, m."""
        return roller.relative_radius(self._bend, self.roller_radius, _side_of(self.cam_force))

    @property
    def pressure(self):
        """Largest Hertz pressure in the contact, Pa."""
        return self._pressure(self.cam_force, self._bend)

    @property
    def half_width(self):
        """Half the width of the contact, m."""
        return roller.half_width(self.cam_force, self.width, self.modulus, self.relative_radius)

    @property
    def _bend(self):
        return curvature(self.cam, self.crank_angle)

    def _pressure(self, force, bend):
        radius = roller.relative_radius(bend, self.roller_radius, _side_of(force))
        return roller.pressure(force, self.width, self.modulus, radius)

    # over the period

    @cached_property
    def largest_pressure(self):
        """Largest Hertz pressure over the period, Pa, and where, between the crank angles given too."""
        return self._highest(lambda at: self._pressure(at.cam_force, curvature(self.cam, at.crank_angle)))

    @cached_property
    def largest_pin_load(self):
        """Largest load of the roller's pin, N, and where."""
        return self._highest(self.roller.pin_load)

    @cached_property
    def largest_pressure_angle(self):
        """Largest size of the pressure angle, rad, and where."""
        return highest(lambda angle: np.abs(self.cam.pressure_angle(angle)))

    @cached_property
    def largest_friction_coefficient(self):
        """Largest friction coefficient that rolling without sliding takes, and where; without bound at a change."""
        if self.changes:
            return Peak(np.inf, self.changes[0])
        return self._highest(self.roller.friction_coefficient)

    @cached_property
    def changes(self):
        """Crank angles at which the roller changes sides, rad."""
        from scipy.optimize import brentq

        force = self._samples.cam_force
        angle = np.append(self._samples.crank_angle, self.solution.period)
        force = np.append(force, force[0])
        places = np.flatnonzero((force[:-1] > 0.0) != (force[1:] > 0.0))

        def at(angle):
            return float(self.solution.at(np.array([angle])).cam_force[0])

        return tuple(
            float(brentq(at, angle[place], angle[place + 1], xtol=1e-13))
            if at(angle[place]) * at(angle[place + 1]) < 0
            else float(angle[place])
            for place in places
        )

    @property
    def sides(self):
        """Sides that carry the roller somewhere in the period."""
        positive = self._samples.cam_force > 0.0
        return tuple(name for name, there in (("disk", not positive.all()), ("ring", positive.any())) if there)

    @cached_property
    def life(self):
        """Basic rating life of the roller's bearing, h (ISO 281)."""
        return self.roller.life(self._samples)

    @cached_property
    def equivalent_load(self):
        """Constant load of the roller's bearing of the same life, N."""
        return self.roller.equivalent_load(self._samples)

    @cached_property
    def reversals(self):
        """What happens to the roller at each change of sides, as `Reversal`."""
        return tuple(self.roller.reversal(self.solution, angle) for angle in self.changes)

    @cached_property
    def lift_off_speed(self):
        """Crank speed from which the roller leaves the side it rests on, rad/s; 0 where both carry it at rest."""
        return lift_off_speed(self.solution)

    @cached_property
    def starting_torque(self):
        """Largest torque on the crank that turns the machine at rest, N m, and where."""
        return starting_torque(self.solution)

    @property
    def hardness(self):
        """Brinell hardness of through-hardened steel that bears the largest pressure 1e7 times (AGMA 2001-D04)."""
        return hardness_from_pressure(self.largest_pressure.value)

    @cached_property
    def _samples(self):
        period = self.solution.period
        return self.solution.at(np.linspace(0.0, period, round(SAMPLES * period / (2 * np.pi)), endpoint=False))

    def _highest(self, function):
        return highest(lambda angle: function(self.solution.at(np.asarray(angle))), 0.0, self.solution.period)

    # limits

    @cached_property
    def exceeded(self):
        """What exceeds the limits, as sentences with both numbers and the crank angle."""
        found = []
        for name, (peak, unit, words) in LIMITS.items():
            if name in self.limits and (found_peak := getattr(self, peak)).value > self.limits[name]:
                found.append(
                    f"{words}: {found_peak.value:.6g} {unit} at {np.degrees(found_peak.angle):.6g} deg, more than "
                    f"{self.limits[name]:.6g}"
                )
        for side in self.sides:
            made = working_curve(self.cam, self.roller_radius, 8, side)
            given = {name: self.limits.get(name) for name in OF_CURVE}
            found += [f"{side}: {text}" for text in made.exceeded(**given)]
        for name, (unit, words) in LEAST.items():
            if name in self.limits and (value := getattr(self, name)) < self.limits[name]:
                found.append(f"{words}: {value:.6g} {unit}, less than {self.limits[name]:.6g}")
        return tuple(found)

    def frame(self):
        """Table with a row for each crank angle, a pandas DataFrame."""
        import pandas as pd

        return pd.DataFrame(
            {
                "crank_angle [deg]": np.degrees(self.crank_angle),
                "cam_force [N]": self.cam_force,
                "side": self.side,
                "curvature_radius [m]": self.curvature_radius,
                "pressure [Pa]": self.pressure,
                "half_width [m]": self.half_width,
                "pin_load [N]": self.roller.pin_load(self.solution),
                "roller_spin [rad/s]": self.roller.spin(self.solution),
                "friction_coefficient [1]": self.roller.friction_coefficient(self.solution),
            }
        )


def _side_of(force):
    """Side of the pitch curve on which a cam is that presses so: +1 around it, -1 inside."""
    return np.where(force > 0.0, 1.0, -1.0)

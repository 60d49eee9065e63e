"""What a torque-balancing cam gives and costs: the machine with it, what is left of the unevenness, contact, angles."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..machine.cams.profile import Peak, highest, lowest
from ..machine.loads import Spring
from ..numbers.lazy import cached_property
from ..solution.scene import Scene
from .follower_speed import lifted
from .result import shaft_hint

COUNT = 4096
ANGLES = (np.arange(COUNT) + 0.382) * 2 * np.pi / COUNT
"""Crank angles at which torques are compared; at none of them anything is likely to jump."""
ZERO = 1e-10
"""Mean of a torque, relative to its unevenness, that counts as none."""


@dataclass(frozen=True, eq=False, repr=False)
class TorqueBalancing:
    """A machine with a torque-balancing cam on its crank; made by `torque_balancing_cam`.

    Attributes
    ----------
    scene : Scene
        With the follower and its spring.
    reference : Scene
        As it was.
    follower : RollerFollower
    spring : Spring
    mean_torque : float
        What the motor gives all the way, N m.
    energy : float
        What the spring takes up and gives back, J.
    stretch : (float, float)
        Of the spring, least and largest, m; weight of the follower counted in.
    reserve : float
        Times the force with which the spring must pull for contact, 2 omega sqrt(m E''), at least; above 1.
    shaft_radius, roller_radius : float or None
        m, as given.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> drive = ks.load_case("chain_unit").variants["rho-0.1"].scene
    >>> found = ks.design.torque_balancing_cam(drive, mass=0.3, travel=0.01)
    >>> found.preload > 0, found.lifts_off
    (True, ())
    """

    scene: Scene
    reference: Scene
    follower: Any
    spring: Spring
    mean_torque: float
    energy: float
    stretch: tuple[float, float]
    reserve: float
    shaft_radius: float | None = None
    roller_radius: float | None = None

    @property
    def travel(self):
        """Of the follower, m."""
        return self.stretch[1] - self.stretch[0]

    @property
    def preload(self):
        """Force of the spring where it is stretched least, N."""
        return float(self.spring.stiffness * self.stretch[0])

    @cached_property
    def uneven(self):
        """Mean of ``abs(T - mean(T))`` before and after, N m, each from a solution of its scene."""
        torques = (scene.solve(ANGLES).balancing_torque for scene in (self.reference, self.scene))
        return tuple(float(np.mean(np.abs(torque - np.mean(torque)))) for torque in torques)

    @property
    def remaining(self):
        """What is left of the unevenness."""
        return self.uneven[1] / self.uneven[0]

    @cached_property
    def _solution(self):
        return self.scene.solve(ANGLES)

    def _contact_force(self, angle):
        return self._solution.at(angle).scalar("contact_force" + self.follower.label)

    @cached_property
    def least_contact_force(self) -> Peak:
        """N, and the crank angle."""
        return lowest(self._contact_force)

    @cached_property
    def largest_contact_force(self) -> Peak:
        """N, and the crank angle."""
        return highest(self._contact_force)

    @property
    def lifts_off(self):
        """Crank angles (start, stop) between which the roller would leave the cam, rad; none as designed."""
        return lifted(self._solution, "contact_force" + self.follower.label)

    @cached_property
    def pressure_angle(self) -> Peak:
        """Largest size, rad."""
        name = "pressure_angle" + self.follower.label
        return highest(lambda angle: np.abs(self._solution.at(angle).measure(name)))

    @cached_property
    def curvature_radius(self) -> Peak:
        """Smallest radius of the pitch curve where it is convex, m, by polar angle of the cam."""
        sharpest = highest(lambda angle: 1.0 / self.follower.disk.curvature_radius(angle))
        return Peak(1.0 / sharpest.value, sharpest.angle)

    @cached_property
    def cam_radius(self) -> Peak:
        """Smallest distance of the roller centre from O, m, and the crank angle."""
        name = "cam_radius" + self.follower.label
        return lowest(lambda angle: self._solution.at(angle).measure(name))

    def table(self):
        """Torque and bearing force before and after, as a DataFrame."""
        import pandas as pd

        rows = {}
        for name, scene in (("before", self.reference), ("after", self.scene)):
            s = scene.solve(ANGLES)
            torque = s.balancing_torque
            rows[name] = {
                "mean torque [N m]": np.mean(torque),
                "mean |T - mean| [N m]": np.mean(np.abs(torque - np.mean(torque))),
                "largest |T| [N m]": np.max(np.abs(torque)),
                "largest reaction at O [N]": np.max(np.hypot(*s.reaction("O"))),
            }
        return pd.DataFrame(rows)

    def report(self):
        """What it is and what it costs, as text; with a warning where the cam cuts into the shaft."""
        nearest, roller, shaft = self.cam_radius, self.follower.rollers[self.follower.pin], self.shaft_radius
        hint = None if shaft is None else shaft_hint(nearest.value, self.roller_radius or roller, shaft)
        low, high = self.stretch
        before, after = self.uneven
        mean = self.mean_torque if abs(self.mean_torque) > ZERO * before else 0.0
        forces = self.least_contact_force, self.largest_contact_force
        lost = ", ".join(f"{np.degrees(a):.4g} to {np.degrees(b):.4g} deg" for a, b in self.lifts_off)
        return "\n".join(
            [
                f"Torque-balancing cam on the crank of {self.reference.mechanism.name}",
                f"  torque              {mean:.6g} N m mean; uneven by {before:.4g} N m before, "
                f"{after:.3g} after ({self.remaining:.2g})",
                f"  spring              {self.spring.stiffness:.6g} N/m, free at {self.spring.free_position:.6g} m, "
                f"stretched {low * 1e3:.4g} to {high * 1e3:.4g} mm, preload {self.preload:.4g} N",
                f"  energy              {self.energy:.4g} J to and fro",
                f"  follower            {self.follower.follower.mass:.4g} kg, travel {self.travel * 1e3:.4g} mm",
                f"  contact             the spring pulls at least {self.reserve:.3g} times as much as it must",
                f"  contact force       {forces[0].value:.4g} N at {np.degrees(forces[0].angle):.4g} deg, to "
                f"{forces[1].value:.4g} N at {np.degrees(forces[1].angle):.4g}; "
                + (f"lifts off from {lost}" if lost else "positive all the way"),
                f"  pressure angle      {np.degrees(self.pressure_angle.value):.4g} deg at most",
                f"  pitch curve         smallest radius of curvature {self.curvature_radius.value * 1e3:.4g} mm; "
                f"smallest distance from O {nearest.value * 1e3:.4g} mm at {np.degrees(nearest.angle):.4g} deg",
                *([f"  warning             {hint}"] if hint else []),
            ]
        )

    def __repr__(self):
        return f"<TorqueBalancing: {self.reference.mechanism.name}, {self.remaining:.2g} of the unevenness left>"

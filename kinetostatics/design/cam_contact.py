"""Contact of a roller with its cam over the turn: side, curvature, Hertz pressure, spin, life, and exceeded limits.

A rolling roller turns at v / R, v the speed of its centre along the pitch curve. It turns one way on a disk, the other
way in a ring, so it reverses where it changes sides. The contact must drive it, J dv/dt / R^2 along the cam, against
the friction of its pin. Forces in N, pressures in Pa (Hertz, line contact); hardness of steel by AGMA 2001-D04.
"""

from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ..cycle.load_functions import resolution_note
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..errors import ParameterError
from ..machine.cams import roller
from ..machine.cams.profile import POSITIVE, Peak, curvature, highest, surface_curvature
from ..machine.cams.profile import profile as working_curve
from ..machine.loads import Gravity
from ..numbers import checks
from ..numbers.formatting import with_units
from ..numbers.lazy import cached_property
from .follower_speed import force_changes, lift_off_speed, peak_of, starting_torque


@with_units(angle="rad", spin="rad/s", energy="J", rise="N/rad")
class Reversal(NamedTuple):
    """The roller changes sides: crank angle, rad; change of its spin, rad/s; energy lost in sliding, J.

    `rise` is the derivative of the cam force by the crank angle, N/rad.
    """

    angle: float
    spin: float
    energy: float
    rise: float

    def sliding_angle(self, roller, crank_speed, friction_coefficient):
        """Crank angle through which the roller slides until it rolls again, rad, as the force grows in proportion."""
        given = checks.single_numbers(
            "sliding_angle",
            crank_speed=(crank_speed, "rad/s", {}),
            friction_coefficient=(friction_coefficient, "1", {"low": 0.0, "strict": True}),
        )
        grip = given["friction_coefficient"] * roller.radius * abs(self.rise)
        return float(np.sqrt(2.0 * abs(given["crank_speed"]) * roller.inertia * abs(self.spin) / grip))


@dataclass(frozen=True, eq=False)
class Roller:
    """Roller on the pin at A: radius m, mass kg, inertia about the pin kg m2, load rating of its bearing N."""

    cam: Any
    radius: float
    mass: float
    inertia: float
    load_rating: float | None
    life_exponent: float

    def speed(self, solution):
        """Speed of the roller's centre along the pitch curve, m/s, and its time derivative, m/s2."""
        r, slope, second = self.cam.radius(solution.crank_angle)
        length = np.hypot(r, slope)
        rate = solution.crank_speed
        return length * rate, slope * (r + second) / length * rate * rate + length * solution.crank_acceleration

    def spin(self, solution):
        """Angular velocity of a roller that rolls without sliding, counter-clockwise positive, rad/s."""
        return np.where(solution.cam_force > 0.0, -1.0, 1.0) * self.speed(solution)[0] / self.radius

    def spin_acceleration(self, solution):
        """Angular acceleration of the roller between changes of sides, rad/s2."""
        return np.where(solution.cam_force > 0.0, -1.0, 1.0) * self.speed(solution)[1] / self.radius

    def driving_force(self, solution):
        """Force along the cam that keeps the roller rolling, against its motion, N."""
        _, growth = self.speed(solution)
        friction = np.abs(solution.friction_at("cam")) * solution.crank_sense
        return self.inertia * growth / self.radius**2 + friction

    def friction_coefficient(self, solution):
        """Least friction coefficient of the contact that prevents sliding."""
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
        """Constant load of the same life, N.

        P^p = integral of F^p dn over that of dn, n the turns of the roller about its pin (ISO 281; Harris and Kotzalas,
        *Rolling Bearing Analysis*, 2006).
        """
        largest = peak_of(solution, self.pin_load).value
        if not largest:
            return 0.0

        def loaded(at):
            turns = self._turns(at)
            return np.stack([(self.pin_load(at) / largest) ** self.life_exponent * turns, turns])

        powers, turns = _means(solution, loaded)
        return float(largest * (powers / turns) ** (1.0 / self.life_exponent))

    def life(self, solution):
        """Basic rating life L10, h."""
        if self.load_rating is None:
            raise ParameterError("contact: the life of the roller's bearing takes its load_rating, C in N")
        load = self.equivalent_load(solution)
        if not load:
            return np.inf
        if not np.all(solution.crank_speed):
            raise ParameterError("contact: a machine that stands wears no bearing; solve it at its crank speed")

        def timed(at):
            turns = self._turns(at)
            return np.stack([turns, np.abs(1.0 / at.crank_speed) + 0.0 * turns])

        turns, seconds = _means(solution, timed)
        return float((self.load_rating / load) ** self.life_exponent * 1e6 * seconds / 3600.0 / turns)

    def _turns(self, solution):
        """Turns of the roller about its pin in a radian of the crank angle."""
        rate = solution.crank_speed * np.ones(solution.crank_angle.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            turned = np.abs(self.spin(solution) - rate) / np.abs(rate)
        return np.where(np.isnan(turned), 1.0, turned) / (2.0 * np.pi)

    def reversal(self, solution, angle, step=1e-4):
        """The `Reversal` at a crank angle where the roller changes sides."""
        at = solution.at(angle + np.array([-step, 0.0, step]))
        rise = float(at.cam_force[2] - at.cam_force[0]) / (2.0 * step)
        spin = 2.0 * float(np.broadcast_to(self.speed(at)[0], (3,))[1]) / self.radius
        spin = -spin if rise > 0.0 else spin
        return Reversal(float(angle), spin, 0.5 * self.inertia * spin * spin, rise)


def _means(solution, function):
    """Means over the period of functions of a solution, (functions,)."""
    turn = closed_turn(solution, "contact")
    floor = TERM_ROUNDING * np.abs(function(turn.at)).max(axis=1)
    return means(lambda angle: function(turn.at.moved_to(angle)), turn, floor)[0]


def pressure_from_hardness(brinell):
    """Hertz pressure that through-hardened steel of a Brinell hardness withstands 1e7 times, Pa.

    2.22 HB + 200 MPa (AGMA 2001-D04, figure 2, grade 1), for 180 to 400 HB.

    Parameters
    ----------
    brinell : float
        HB, 180 to 400.

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        The hardness is outside the standard.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> round(ks.design.pressure_from_hardness(300.0) / 1e6, 3)
    866.0
    """
    value = checks.single_numbers("pressure_from_hardness", brinell=(brinell, "1", POSITIVE))["brinell"]
    if not 180.0 <= value <= 400.0:
        raise ParameterError(
            f"pressure_from_hardness: the standard covers 180 to 400 HB, got {value:.6g}; give the pressure itself, "
            "for case-hardened steel about 1.5e9 Pa"
        )
    return (2.22 * value + 200.0) * 1e6


def hardness_from_pressure(pressure):
    """Brinell hardness of steel that withstands a Hertz pressure in Pa, the inverse of `pressure_from_hardness`.

    At least 180 HB, the lowest of the standard; extrapolated beyond 400 HB.

    Parameters
    ----------
    pressure : float
        Pa.

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        The pressure is negative or no number.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> round(ks.design.hardness_from_pressure(866e6), 6)
    300.0
    """
    value = checks.single_numbers("hardness_from_pressure", pressure=(pressure, "Pa", {"low": 0.0}))["pressure"]
    return max(180.0, (value / 1e6 - 200.0) / 2.22)


UPPER_LIMITS = {
    "pressure": ("largest_pressure", "Pa", "Hertz pressure"),
    "pin_load": ("largest_pin_load", "N", "load of the roller's pin"),
    "friction_coefficient": ("largest_friction_coefficient", "1", "friction coefficient that keeps the roller rolling"),
    "starting_torque": ("starting_torque", "N m", "torque to start"),
}
"""Upper limits: attribute of `Contact`, unit, words."""
LOWER_LIMITS = {"life": ("h", "life of the roller's bearing"), "lift_off_speed": ("rad/s", "speed of lift-off")}
"""Lower limits: unit, words."""
CURVE_LIMIT_UNITS = {"pressure_angle": "rad", "curvature_radius": "m"}
LIMIT_UNITS = {name: of[-2] for name, of in (*UPPER_LIMITS.items(), *LOWER_LIMITS.items())} | CURVE_LIMIT_UNITS
"""Unit of each limit."""


@dataclass(frozen=True, eq=False)
class CamContact:
    """Line contact of a cam over the turn: base of `Contact` and `FollowerContact`.

    A subclass gives `cam_force`, `curvature` of the pitch curve, `force_name` and `largest_pressure_angle`.
    """

    solution: Any = field(repr=False)
    cam: Any
    roller_radius: float
    width: float
    modulus: float
    limits: dict[str, float] = field(repr=False, default_factory=dict, kw_only=True)

    def __repr__(self):
        peak = self.largest_pressure
        lines = [
            f"<{type(self).__name__}: {self.solution.mechanism.name}, {self._body}",
            f"  side             {' and '.join(self.sides)}, {len(self.changes)} changes a period",
            f"  largest pressure {peak.value / 1e6:.6g} MPa at {np.degrees(peak.angle):.6g} deg",
            *(f"  exceeded         {text}" for text in self.exceeded),
        ]
        if self.force_error is not None:
            lines.append(f"  uncertain        forces by {self.force_error:.2g} of the largest")
        return "\n  ".join(filter(None, ["\n".join(lines), resolution_note(self.solution)])) + ">"

    @property
    def _body(self):
        """Words for what the cam presses on."""
        return f"roller radius {self.roller_radius:.6g} m"

    @property
    def force_error(self):
        """Expected largest error of forces, relative to the largest, of a cam from a table; None of others."""
        return getattr(self.cam, "force_error", None)

    cam_force: ClassVar[Any]
    curvature: ClassVar[Any]
    force_name: ClassVar[Any]
    largest_pressure_angle: ClassVar[Any]

    # over the crank angle

    @property
    def crank_angle(self):
        """Crank angles of the solution, rad."""
        return self.solution.crank_angle

    @property
    def side(self):
        """Which side of the cam carries the roller, at each crank angle: "ring" outside it or "disk" inside."""
        return np.where(self._side > 0.0, "ring", "disk")

    @property
    def _side(self):
        """Side of the pitch curve on which the cam lies: +1 around it (ring), -1 inside (disk)."""
        return np.where(self.cam_force > 0.0, 1.0, -1.0)

    @property
    def curvature_radius(self):
        """Radius of the working curve that carries the roller, m: positive where convex, negative where hollow."""
        with np.errstate(divide="ignore"):
            return 1.0 / surface_curvature(self.curvature, self.roller_radius, self._side)

    @property
    def relative_radius(self):
        """Radius of the equivalent cylinder on a plane, m."""
        return roller.relative_radius(self.curvature, self.roller_radius, self._side)

    @property
    def pressure(self):
        """Largest Hertz pressure in the contact, Pa."""
        return roller.pressure(self.cam_force, self.width, self.modulus, self.relative_radius)

    @property
    def half_width(self):
        """Half the width of the contact, m."""
        return roller.half_width(self.cam_force, self.width, self.modulus, self.relative_radius)

    # over the period

    @cached_property
    def largest_pressure(self):
        """Largest Hertz pressure over the period, Pa, and where, between the crank angles given too."""
        return self._highest(lambda at: at.pressure)

    @cached_property
    def changes(self):
        """Crank angles at which the force of the cam changes its sign, so that a roller changes sides, rad."""
        return tuple(force_changes(self.solution, self.force_name).tolist())

    @property
    def sides(self):
        """Sides that carry the roller somewhere in the period."""
        return ("disk", "ring") if self.changes else (str(replace(self, solution=self.solution.at([0.0])).side[0]),)

    @cached_property
    def lift_off_speed(self):
        """Crank speed at which contact with the side that carries at rest is lost, rad/s; 0 if both carry at rest."""
        return lift_off_speed(self.solution, self.force_name)

    @cached_property
    def starting_torque(self):
        """Largest torque that turns the crank from rest, N m, and where."""
        return starting_torque(self.solution)

    @property
    def hardness(self):
        """Brinell hardness of through-hardened steel that withstands the largest pressure 1e7 times (AGMA 2001-D04)."""
        return hardness_from_pressure(self.largest_pressure.value)

    def _highest(self, function):
        """Largest value over the period of a function of the contact, a `Peak`."""
        return peak_of(self.solution, lambda at: function(replace(self, solution=at)))

    # limits

    @cached_property
    def exceeded(self):
        """Sentences about exceeded limits, with both numbers and the crank angle."""
        found = []
        for name, (peak, unit, words) in UPPER_LIMITS.items():
            if name in self.limits and (found_peak := getattr(self, peak)).value > self.limits[name]:
                found.append(
                    f"{words}: {found_peak.value:.6g} {unit} at {np.degrees(found_peak.angle):.6g} deg, more than "
                    f"{self.limits[name]:.6g}"
                )
        found += self._curve_limits_exceeded()
        for name, (unit, words) in LOWER_LIMITS.items():
            if name in self.limits and (value := getattr(self, name)) < self.limits[name]:
                found.append(f"{words}: {value:.6g} {unit}, less than {self.limits[name]:.6g}")
        return tuple(found)

    def _curve_limits_exceeded(self):
        """Sentences about exceeded limits of pressure angle and curvature."""
        made = {side: working_curve(self.cam, self.roller_radius, 8, side) for side in self.sides}
        given = {name: self.limits.get(name) for name in CURVE_LIMIT_UNITS}
        return [f"{side}: {text}" for side, curve in made.items() for text in curve.exceeded(**given)]

    def frame(self):
        """Table with a row for each crank angle, a pandas DataFrame."""
        import pandas as pd

        return pd.DataFrame(
            {
                "crank_angle [deg]": np.degrees(self.crank_angle),
                f"{self.force_name} [N]": self.solution.scalar(self.force_name),
                "side": self.side,
                "curvature_radius [m]": self.curvature_radius,
                "pressure [Pa]": self.pressure,
                "half_width [m]": self.half_width,
            }
        )


@dataclass(frozen=True, eq=False, repr=False)
class Contact(CamContact):
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
        Its spin, pin load and life.
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

    roller: Roller = field(kw_only=True)

    force_name = "cam_force"

    @property
    def cam_force(self):
        """Force of the cam on the roller along the normal, N, positive toward the inside of the pitch curve."""
        return self.solution.cam_force

    @property
    def curvature(self):
        """Curvature of the pitch curve, 1/m, positive where it is convex seen from outside."""
        return curvature(self.cam, self.crank_angle)

    @cached_property
    def largest_pin_load(self):
        """Largest load of the roller's pin, N, and where."""
        return peak_of(self.solution, self.roller.pin_load)

    @cached_property
    def largest_pressure_angle(self):
        """Largest size of the pressure angle, rad, and where."""
        return highest(lambda angle: np.abs(self.cam.pressure_angle(angle)), self.cam)

    @cached_property
    def largest_friction_coefficient(self):
        """Largest friction coefficient that rolling needs, and where; infinite at a change of sides."""
        if self.changes:
            return Peak(np.inf, self.changes[0])
        return peak_of(self.solution, self.roller.friction_coefficient)

    @cached_property
    def life(self):
        """Basic rating life of the roller's bearing, h (ISO 281)."""
        return self.roller.life(self.solution)

    @cached_property
    def equivalent_load(self):
        """Constant load of the roller's bearing of the same life, N."""
        return self.roller.equivalent_load(self.solution)

    @cached_property
    def reversals(self):
        """A `Reversal` for each change of sides."""
        return tuple(self.roller.reversal(self.solution, angle) for angle in self.changes)

    def frame(self):
        """Table with a row for each crank angle, a pandas DataFrame."""
        return (
            super()
            .frame()
            .assign(
                **{
                    "pin_load [N]": self.roller.pin_load(self.solution),
                    "roller_spin [rad/s]": self.roller.spin(self.solution),
                    "friction_coefficient [1]": self.roller.friction_coefficient(self.solution),
                }
            )
        )

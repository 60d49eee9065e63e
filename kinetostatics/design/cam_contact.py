"""Contact of a roller with its cam over the turn: side, curvature, Hertz pressure, spin, life, and exceeded limits.

A rolling roller turns at v / R, v the speed of its centre along the pitch curve. It turns one way on a disk, the other
way in a ring, so it reverses where it changes sides. The contact must drive it, J dv/dt / R^2 along the cam, against
the friction of its pin. Forces in N, pressures in Pa (Hertz, line contact); hardness of steel by AGMA 2001-D04.
"""

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from ..cycle.limit_positions import require_single
from ..cycle.load_functions import resolution_note
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..errors import ParameterError
from ..machine.cams import roller
from ..machine.cams.profile import POSITIVE, Peak, curvature, highest, surface_curvature
from ..machine.cams.profile import profile as working_curve
from ..machine.cams.roller import MODULUS_RULE
from ..machine.loads import Gravity
from ..numbers import checks
from ..numbers.formatting import repr_with_units
from ..numbers.lazy import cached_property
from .follower_speed import force_changes, lift_off_speed, peak_of, starting_torque


class Reversal(NamedTuple):
    """The roller changes sides: crank angle, rad; change of its spin, rad/s; energy lost in sliding, J.

    `rise` is the derivative of the cam force by the crank angle, N/rad.
    """

    angle: float
    spin: float
    energy: float
    rise: float

    __repr__ = repr_with_units(angle="rad", spin="rad/s", energy="J", rise="N/rad")

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
    """Hertz pressure that through-hardened steel of a Brinell hardness bears 1e7 times, Pa.

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
            f"pressure_from_hardness: the standard tells of 180 to 400 HB, got {value:.6g}; give the pressure itself, "
            "for case-hardened steel about 1.5e9 Pa"
        )
    return (2.22 * value + 200.0) * 1e6


def hardness_from_pressure(pressure):
    """Brinell hardness of steel that bears a Hertz pressure in Pa, the inverse of `pressure_from_hardness`.

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
        ]
        if self.force_error is not None:
            lines.append(f"  uncertain        forces by {self.force_error:.2g} of the largest")
        return "\n  ".join(filter(None, ["\n".join(lines), resolution_note(self.solution)])) + ">"

    @property
    def force_error(self):
        """Expected largest error of forces, relative to the largest, of a cam from a table; None of others."""
        return getattr(self.cam, "force_error", None)

    # over the crank angle

    @property
    def crank_angle(self):
        """Crank angles of the solution, rad."""
        return self.solution.crank_angle

    @property
    def cam_force(self):
        """Force of the cam on the roller along the normal, N, positive toward the inside of the pitch curve."""
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
        """Radius of the equivalent cylinder on a plane, m."""
        return roller.relative_radius(self._bend, self.roller_radius, _side_of(self.cam_force))

    @property
    def pressure(self):
        """Largest Hertz pressure in the contact, Pa."""
        return roller.pressure(self.cam_force, self.width, self.modulus, self.relative_radius)

    @property
    def half_width(self):
        """Half the width of the contact, m."""
        return roller.half_width(self.cam_force, self.width, self.modulus, self.relative_radius)

    @property
    def _bend(self):
        return curvature(self.cam, self.crank_angle)

    # over the period

    @cached_property
    def largest_pressure(self):
        """Largest Hertz pressure over the period, Pa, and where, between the crank angles given too."""
        return self._highest(lambda at: replace(self, solution=at).pressure)

    @cached_property
    def largest_pin_load(self):
        """Largest load of the roller's pin, N, and where."""
        return self._highest(self.roller.pin_load)

    @cached_property
    def largest_pressure_angle(self):
        """Largest size of the pressure angle, rad, and where."""
        return highest(lambda angle: np.abs(self.cam.pressure_angle(angle)), self.cam)

    @cached_property
    def largest_friction_coefficient(self):
        """Largest friction coefficient that rolling needs, and where; infinite at a change of sides."""
        if self.changes:
            return Peak(np.inf, self.changes[0])
        return self._highest(self.roller.friction_coefficient)

    @cached_property
    def changes(self):
        """Crank angles at which the roller changes sides, rad."""
        return tuple(force_changes(self.solution, "cam_force").tolist())

    @property
    def sides(self):
        """Sides that carry the roller somewhere in the period."""
        return ("disk", "ring") if self.changes else (str(replace(self, solution=self.solution.at([0.0])).side[0]),)

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

    @cached_property
    def lift_off_speed(self):
        """Crank speed at which the roller leaves its side at rest, rad/s; 0 if both sides carry it at rest."""
        return lift_off_speed(self.solution)

    @cached_property
    def starting_torque(self):
        """Largest torque that turns the crank from rest, N m, and where."""
        return starting_torque(self.solution)

    @property
    def hardness(self):
        """Brinell hardness of through-hardened steel that bears the largest pressure 1e7 times (AGMA 2001-D04)."""
        return hardness_from_pressure(self.largest_pressure.value)

    def _highest(self, function):
        return peak_of(self.solution, function)

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
        for side in self.sides:
            made = working_curve(self.cam, self.roller_radius, 8, side)
            given = {name: self.limits.get(name) for name in CURVE_LIMIT_UNITS}
            found += [f"{side}: {text}" for text in made.exceeded(**given)]
        for name, (unit, words) in LOWER_LIMITS.items():
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
    """Side of the pitch curve of a cam with this force: +1 around it (ring), -1 inside (disk)."""
    return np.where(force > 0.0, 1.0, -1.0)


PARTS = ("roller", "cam")
ROLLER_RULES: dict[str, tuple[str, dict[str, Any]]] = {
    "roller_mass": ("kg", {"low": 0.0}),
    "life_exponent": ("1", POSITIVE),
    "roller_inertia": ("kg*m**2", {"low": 0.0}),
    "load_rating": ("N", POSITIVE),
}
MATERIAL_RULES: dict[str, tuple[str, dict[str, Any]]] = {
    "youngs_modulus": ("Pa", {**POSITIVE, "usual": MODULUS_RULE.usual}),
    "poissons_ratio": ("1", {"low": 0.0, "high": 0.5 + 1e-12}),
}
"""Unit and bounds of each material property."""


def contact(
    solution,
    roller_radius=None,
    width=None,
    youngs_modulus=None,
    poissons_ratio=None,
    *,
    roller_mass=0.0,
    roller_inertia=None,
    load_rating=None,
    life_exponent=10 / 3,
    limits=None,
):
    """Contact of the roller with its cam over the turn, and exceeded limits.

    Parameters
    ----------
    solution : Solution
        Of one design, of a mechanism with a `CamRoller`.
    roller_radius, width : float
        m; of these four, missing ones come from the scene's own `Roller`.
    youngs_modulus : float or (roller, cam)
        Pa.
    poissons_ratio : float or (roller, cam)
    roller_mass : float
        Mass of the roller, a part of the block's mass, kg.
    roller_inertia : float, optional
        About its pin, kg m2; default m R^2 / 2.
    load_rating : float, optional
        Basic dynamic load rating C of its bearing (ISO 281), N.
    life_exponent : float
        10/3 for roller bearings, 3 for ball bearings.
    limits : dict of str to float, optional
        Largest "pressure" (Pa), "pin_load" (N), "friction_coefficient", "pressure_angle" (rad) and "starting_torque"
        (N m); smallest convex "curvature_radius" (m), "life" (h) and "lift_off_speed" (rad/s); see `Contact.exceeded`.

    Returns
    -------
    Contact

    Raises
    ------
    ParameterError
        A value no machine can have, no cam in the mechanism, a batch of designs, or a roller that undercuts the side of
        the cam that it runs on.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.CosineLaw(0.3, 2.0)
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600.0))
    >>> solution = ks.solve(saw, 0.5, crank_speed=10.0, loads=ks.Spring.balancing(600.0, 11.0, 2.0))
    >>> found = ks.design.contact(solution, 0.05, 0.04, 210e9, 0.3, limits={"pressure": 1e9})
    >>> print(f"{found.largest_pressure.value / 1e6:.1f} MPa on the {found.sides[0]}")
    289.1 MPa on the disk
    """
    checks.require("contact", checks.solution("solution", solution))
    require_single(solution, "contact", "cam_force")
    groups = solution.mechanism.led_by_ground
    given = {"roller_radius": roller_radius, "width": width, "youngs_modulus": youngs_modulus}
    given |= {"poissons_ratio": poissons_ratio}
    limits = {} if limits is None else limits
    known = limits if isinstance(limits, dict) else {}
    own = {"roller_mass": roller_mass, "life_exponent": life_exponent}
    optional = {"roller_inertia": roller_inertia, "load_rating": load_rating}
    own |= {name: value for name, value in optional.items() if value is not None}
    no_roller = f"solution must be of a mechanism with a CamRoller, a {solution.mechanism.name} has none"
    if any(group.led for group in solution.mechanism.groups):
        no_roller += "; give its follower a Roller or Face, then contact_pressure is an output"
    values = checks.single_numbers(
        "contact",
        None if groups else no_roller,
        *_limit_problems(limits, load_rating),
        **_contact_rules(given, groups),
        **{name: (value, *ROLLER_RULES[name]) for name, value in own.items()},
        **{f"limit {name!r}": (known[name], unit, POSITIVE) for name, unit in LIMIT_UNITS.items() if name in known},
    )
    cam, radius, mass = groups[0].cam, values["roller_radius"], values["roller_mass"]
    inertia = values.get("roller_inertia", 0.5 * mass * radius * radius)
    wheel = Roller(cam, radius, mass, inertia, values.get("load_rating"), values["life_exponent"])
    materials = [[values[f"{name} of the {part}"] for name in MATERIAL_RULES] for part in PARTS]
    kept = {name: values[f"limit {name!r}"] for name in LIMIT_UNITS if name in limits}
    found = Contact(solution, cam, radius, values["width"], roller.contact_modulus(*materials), wheel, kept)
    for side in found.sides:
        working_curve(cam, radius, 8, side)
    return found


def _contact_rules(given, groups):
    """Values and rules of a contact, missing values from the scene's roller; the material of roller and cam each."""
    lacking = [name for name, value in given.items() if value is None] if groups else []
    found, scene_roller = dict(given), groups[0].roller if groups else None
    if lacking and scene_roller is None:
        raise ParameterError(f"contact: give {', '.join(lacking)}, as the scene's CamRoller has no Roller")
    for name in lacking:
        field_name = name.removeprefix("roller_")
        own, other = getattr(scene_roller, field_name), getattr(scene_roller, f"cam_{field_name}", None)
        found[name] = own if other is None else (own, other)
    rules: dict[str, tuple[Any, str, dict[str, Any]]] = {
        name: (found[name], "m", POSITIVE) for name in ("roller_radius", "width")
    }
    for place, part in enumerate(PARTS):
        for name, rule in MATERIAL_RULES.items():
            value = found[name]
            paired = isinstance(value, list | tuple) and len(value) == 2
            rules[f"{name} of the {part}"] = (value[place] if paired else value, *rule)
    return rules


def _limit_problems(limits, load_rating):
    """Sentences about wrong names of limits."""
    if not isinstance(limits, dict):
        return [f"limits must be a dict of name to number, got {checks.shown(limits)}"]
    rating = "a limit of the life takes the load_rating of the roller's bearing"
    unrated = "life" in limits and load_rating is None
    return [*(checks.choice("limit", name, tuple(LIMIT_UNITS)) for name in limits), rating if unrated else None]

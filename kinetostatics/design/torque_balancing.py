"""A spring-loaded follower on a cam on the crank that evens out the torque of any machine at its design speed.

The torque T drives the crank. Where it is above its mean, E = integral of T - mean(T) rises, and the spring gives this
energy; it stores energy where E falls. So the motor gives only the mean torque. The equation of `spring_follower`
includes the follower's own inertia, so no iteration is needed.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.limit_positions import Turn, require_single
from ..cycle.means import TERM_ROUNDING, closed_turn, means
from ..errors import ParameterError
from ..machine.builders import with_roller_follower
from ..machine.cams.profile import POSITIVE, Peak, highest
from ..machine.guide import Guide
from ..machine.laws.law import PanelLaw, turn_angles
from ..machine.links import Link
from ..machine.loads import Gravity, Spring
from ..numbers import checks
from ..numbers.arithmetic import TURN
from ..numbers.lazy import cached_property
from ..numbers.panels import Panels
from ..numbers.planar import dot
from ..solution.scene import Scene
from . import spring_follower
from .follower_speed import lifted
from .result import shaft_hint

ANGLE_COUNT = 4096
MEAN_TOLERANCE = 1e-10
"""Negligible mean of a torque, relative to its unevenness."""


@dataclass(frozen=True, eq=False, repr=False)
class TorqueBalancing:
    """A machine with a torque-balancing cam on its crank; `torque_balancing_cam` returns it.

    Attributes
    ----------
    scene : Scene
        Scene with the follower and its spring.
    reference : Scene
        The scene without the cam.
    follower : RollerFollower
    spring : Spring
    mean_torque : float
        Constant torque of the motor, N m.
    energy : float
        Energy that the spring stores and returns, J.
    stretch : (float, float)
        Least and largest stretch of the spring, m; includes the effect of the follower's weight.
    reserve : float
        Least ratio of spring force to force for contact, 2 omega sqrt(m E''), over the minima of the energy E; above 1.
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
        """Travel of the follower, m."""
        return self.stretch[1] - self.stretch[0]

    @property
    def preload(self):
        """Force of the spring at its least stretch, N."""
        return float(self.spring.stiffness * self.stretch[0])

    @cached_property
    def _means(self):
        return tuple(map(_torque_means, self._solutions))

    @property
    def uneven(self):
        """Mean of ``abs(T - mean(T))`` before and after, N m, each from a solution of its scene."""
        return tuple(uneven for _, uneven in self._means)

    @property
    def remaining(self):
        """Unevenness after, relative to before."""
        return self.uneven[1] / self.uneven[0]

    @cached_property
    def _solutions(self):
        return self.reference.solve(1), self.scene.solve(1)

    def _ends(self, quantity):
        """Smallest and largest value of a follower quantity, each a `Peak`."""
        found = extrema(self._solutions[1], quantity + self.follower.label)
        ends = (int(np.argmin(found.value)), int(np.argmax(found.value)))
        return tuple(Peak(float(found.value[place]), float(found.angle[place])) for place in ends)

    @cached_property
    def _contact_forces(self):
        return self._ends("contact_force")

    @property
    def least_contact_force(self) -> Peak:
        """Least contact force, N, and its crank angle."""
        return self._contact_forces[0]

    @property
    def largest_contact_force(self) -> Peak:
        """Largest contact force, N, and its crank angle."""
        return self._contact_forces[1]

    @property
    def lifts_off(self):
        """Crank-angle intervals (start, stop) of lift-off, rad; empty by design."""
        return lifted(self._solutions[1], "contact_force" + self.follower.label)

    @cached_property
    def pressure_angle(self) -> Peak:
        """Largest pressure angle, without sign, rad."""
        peak = max(self._ends("pressure_angle"), key=lambda peak: abs(peak.value))
        return peak._replace(value=abs(peak.value))

    @cached_property
    def curvature_radius(self) -> Peak:
        """Smallest radius of curvature of the convex parts of the pitch curve, m, and its polar angle on the cam."""
        disk = self.follower.disk
        sharpest = highest(lambda angle: 1.0 / disk.curvature_radius(angle), disk)
        return Peak(1.0 / sharpest.value, sharpest.angle)

    @cached_property
    def cam_radius(self) -> Peak:
        """Smallest distance of the roller centre from O, m, and the crank angle."""
        return self._ends("cam_radius")[0]

    def table(self):
        """Torque and bearing force before and after, as a DataFrame."""
        import pandas as pd

        columns = {}
        for name, solution, (mean, uneven) in zip(("before", "after"), self._solutions, self._means, strict=True):
            columns[name] = {
                "mean torque [N m]": mean,
                "mean |T - mean| [N m]": uneven,
                "largest |T| [N m]": abs(extrema(solution, "balancing_torque").largest),
                "largest reaction at O [N]": extrema(solution, "O").largest,
            }
        return pd.DataFrame(columns)

    def report(self):
        """Report as text, with a warning if the cam cuts into the shaft."""
        nearest, roller = self.cam_radius, self.roller_radius or self.follower.rollers[self.follower.pin]
        hint = self.shaft_radius is not None and shaft_hint(nearest.value, roller, self.shaft_radius)
        (low, high), (before, after), forces = self.stretch, self.uneven, self._contact_forces
        mean = self.mean_torque if abs(self.mean_torque) > MEAN_TOLERANCE * before else 0.0
        lost = ", ".join(f"{np.degrees(a):.4g} to {np.degrees(b):.4g} deg" for a, b in self.lifts_off)
        return "\n".join(
            [
                f"Torque-balancing cam on the crank of {self.reference.mechanism.name}",
                f"  torque              {mean:.6g} N m mean; uneven by {before:.4g} N m before, "
                f"{after:.3g} after ({self.remaining:.2g})",
                f"  spring              {self.spring.stiffness:.6g} N/m, free at {self.spring.free_position:.6g} m, "
                f"stretched {low * 1e3:.4g} to {high * 1e3:.4g} mm, preload {self.preload:.4g} N",
                f"  energy              {self.energy:.4g} J stored and returned",
                f"  follower            {self.follower.follower.mass:.4g} kg, travel {self.travel * 1e3:.4g} mm",
                f"  contact             the spring force is at least {self.reserve:.3g} times the force for contact",
                f"  contact force       {forces[0].value:.4g} N at {np.degrees(forces[0].angle):.4g} deg, to "
                f"{forces[1].value:.4g} N at {np.degrees(forces[1].angle):.4g}; "
                + (f"lifts off from {lost}" if lost else "positive at all angles"),
                f"  pressure angle      {np.degrees(self.pressure_angle.value):.4g} deg at most",
                f"  pitch curve         smallest radius of curvature {self.curvature_radius.value * 1e3:.4g} mm; "
                f"smallest distance from O {nearest.value * 1e3:.4g} mm at {np.degrees(nearest.angle):.4g} deg",
                *([f"  warning             {hint}"] if hint else []),
            ]
        )

    def __repr__(self):
        return f"<TorqueBalancing: {self.reference.mechanism.name}, {self.remaining:.2g} of the unevenness remains>"


def _torque_means(solution):
    """Mean of the balancing torque, and mean deviation from it, N m."""
    turn = closed_turn(solution, OWNER)
    floor = TERM_ROUNDING * turn.at.largest_torque_term

    def torque(angle):
        return solution.at(angle).balancing_torque[None]

    (mean,), *_ = means(torque, turn, floor)
    (uneven,), *_ = means(lambda angle: np.abs(torque(angle) - mean), turn, floor)
    return float(mean), float(uneven)


OWNER = "torque_balancing_cam"
UNEVENNESS_TOLERANCE = 1e-10
"""Negligible unevenness, relative to the largest term of the torque."""
JUMP_TOLERANCE = 1e-6
"""Largest change of the torque across its mean that is not a jump, relative to the largest torque."""
ANGLE_BESIDE = 1e-9
"""Distance from a crossing of the mean, rad, for the test of a jump."""
SWITCH_RULES = {"switches": checks.Number("rad", table=True)}
OPTIONAL = ("stiffness", "base_radius", "roller_radius", "shaft_radius")
DEFAULT_PRESSURE_ANGLE, MAX_PRESSURE_ANGLE = np.radians(30.0), np.radians(85.0)
RULES = {
    **dict.fromkeys(("base_radius", "roller_radius", "shaft_radius", "travel"), ("m", POSITIVE)),
    "stiffness": ("N/m", POSITIVE),
    "mass": ("kg", POSITIVE),
    "pressure_angle": ("rad", POSITIVE | {"high": MAX_PRESSURE_ANGLE}),
    "guide_angle": ("rad", {}),
    "guide_offset": ("m", {}),
}


def torque_balancing_cam(
    scene,
    *,
    mass,
    travel,
    stiffness=None,
    guide_angle=0.0,
    guide_offset=0.0,
    base_radius=None,
    pressure_angle=DEFAULT_PRESSURE_ANGLE,
    roller_radius=None,
    shaft_radius=None,
    pin="R",
    label="_cam",
    switches=(),
):
    """Cam on the crank with a spring-loaded roller follower that makes the drive torque constant at its mean.

    Parameters
    ----------
    scene : Scene
        Any machine, of one design at constant crank speed; its loads may switch, unless the torque jumps
        across the mean.
    mass : float
        Mass of the follower with roller, plus a third of the spring, kg.
    travel : float
        Travel of the follower, m. A longer travel needs a softer spring and less force.
    stiffness : float, optional
        N/m; by default the spring's largest stretch is twice its least stretch.
    guide_angle, guide_offset : float
        Direction of the follower's guide, from O outward, rad, and its offset, m.
    base_radius : float, optional
        Least coordinate of the roller centre along the guide, m; by default the smallest that keeps `pressure_angle`.
    pressure_angle : float
        Largest allowed pressure angle, rad; a `base_radius` for which it is larger is an error.
    roller_radius : float, optional
        Radius of the roller, m; a roller that would undercut the cam is an error.
    shaft_radius : float, optional
        m. The default base radius also keeps the cam off the shaft; with a smaller one the report warns.
    pin, label : str
        Names of the `RollerFollower`.
    switches : sequence of float
        Crank angles at which a load switches, rad; a search finds further ones.

    Returns
    -------
    TorqueBalancing

    Raises
    ------
    ParameterError
        The torque is already even or jumps across its mean. The scene has several designs or no constant speed. The
        spring is too soft for contact or too stiff for the travel; the message gives the bounds. The pressure angle or
        the roller does not fit. There is friction at O, which the contact force would increase.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> drive = ks.load_case("chain_unit").variants["rho-0.1"].scene
    >>> found = ks.design.torque_balancing_cam(drive, mass=0.3, travel=0.01)
    >>> found.remaining < 1e-9, found.lifts_off
    (True, ())
    """
    given = {"mass": mass, "travel": travel, "pressure_angle": pressure_angle, "guide_angle": guide_angle}
    given |= {"guide_offset": guide_offset, "stiffness": stiffness, "base_radius": base_radius}
    values = _parse_values(scene, **given, roller_radius=roller_radius, shaft_radius=shaft_radius)
    if np.size(switches):
        switches = np.atleast_1d(checks.check_values(OWNER, SWITCH_RULES, {"switches": switches})["switches"])
    torque, energy = _energy(scene, switches)
    moving = values["mass"] * float(scene.crank_speed) ** 2
    stored, peak, lows = _energy_range(torque, energy)
    travel = values["travel"]
    stiffness = values.get("stiffness", 2.0 * stored / (3.0 * travel * travel))
    least = stored / (stiffness * travel) - travel / 2.0
    if least <= 0.0:
        raise ParameterError(
            f"{OWNER}: a spring of {stiffness:.6g} N/m stores more than the {stored:.6g} J of the machine on a travel "
            f"of {travel:.6g} m without preload. Choose less than {2.0 * stored / travel**2:.6g} N/m, or a travel "
            f"below {np.sqrt(2.0 * stored / stiffness):.6g} m"
        )
    level = peak + 0.5 * stiffness * least * least
    reserve, low = min((spring_follower.reserve(energy, low, level, moving, stiffness), low) for low in lows)
    if reserve <= 1.0:  # (k x)^2 must exceed 4 m omega^2 E'' at minima of E
        raise ParameterError(
            f"{OWNER}: the follower would lift off at {np.degrees(low) % 360:.6g} deg, where the spring pulls with "
            f"{reserve:.4g} times the force 2 omega sqrt(m E'') that contact needs. Make the travel shorter than "
            f"{travel * reserve:.6g} m, or the follower lighter than {values['mass'] * reserve**2:.6g} kg"
        )
    stretch = spring_follower.spring_stretch(energy, level, moving, stiffness)
    shift = _base_radius(stretch, least, values) - least
    guide = Guide.at(values["guide_angle"], values["guide_offset"])
    law, link = PanelLaw(stretch.plus(shift)), Link(values["mass"])
    name = f"{scene.mechanism.name} with torque-balancing cam"
    mechanism = with_roller_follower(scene.mechanism, name, law, guide, link, pin, label)
    follower = mechanism.groups[-1]
    if "roller_radius" in values:
        follower.disk.profile(values["roller_radius"], 360)
    weight = sum(float(dot(guide.direction, item.vector)) for item in scene.loads if isinstance(item, Gravity))
    spring = Spring(stiffness, shift - values["mass"] * weight / stiffness, on="follower" + label)
    loaded = replace(scene, mechanism=mechanism, loads=(*scene.loads, spring))
    radii = {name: values.get(name) for name in ("shaft_radius", "roller_radius")}
    ends = least, least + travel
    return TorqueBalancing(loaded, scene, follower, spring, torque.mean, stored, ends, reserve, **radii)


def _parse_values(scene, **given):
    """Checked values by name; an error for a scene that this cam cannot balance."""
    problem = None
    if not isinstance(scene, Scene):
        problem = f"takes a Scene, as of a case's variant, got {checks.shown(scene)}"
    elif np.ndim(scene.crank_speed) or np.ndim(scene.crank_acceleration) or scene.crank_acceleration:
        problem = "the crank must turn at one constant speed, its design speed"
    elif not scene.crank_speed:
        problem = "the crank stands; give it its design speed"
    elif abs(scene.period - TURN) > 1e-9:
        turns = scene.period / TURN
        problem = f"motion and loads must repeat after a turn like the cam, but repeat after {turns:.6g}"
    elif "O" in scene.friction.acting:
        problem = "friction at O grows with the force of the cam; leave it out, and add it to the resulting scene"
    known = {name: value for name, value in given.items() if value is not None or name not in OPTIONAL}
    return checks.single_numbers(OWNER, problem, **{name: (value, *RULES[name]) for name, value in known.items()})


def _energy(scene, switches):
    """Torque as panels, and the integral of torque less mean, J."""
    solution = scene.solve(720)
    require_single(solution, OWNER, "balancing_torque")
    size = solution.dynamics.largest_torque_term
    if not np.ptp(solution.balancing_torque) > UNEVENNESS_TOLERANCE * size:
        mean = np.mean(solution.balancing_torque)
        raise ParameterError(f"{OWNER}: the torque is already even, {mean:.6g} N m at all angles")
    kinks = Turn.of(solution).kinks
    try:
        torque = Panels.of(lambda angle: solution.at(angle).balancing_torque, TURN, [*kinks, *switches])
    except ParameterError as error:
        raise ParameterError(f"{OWNER}: of the torque: {error}") from None
    return torque, torque.plus(-torque.mean).integral


def _energy_range(torque, energy):
    """Range and peak of the machine's energy, J, and the crank angles of its minima."""
    mean = torque.mean
    size = float(np.max(np.abs(torque(turn_angles(torque.edges, ANGLE_COUNT)))))
    turns = torque.plus(-mean).roots
    values = energy(turns)
    for angle in turns:
        beside = np.abs(torque(angle + np.array([-ANGLE_BESIDE, ANGLE_BESIDE])) - mean)
        if np.max(beside) > JUMP_TOLERANCE * size:
            raise ParameterError(
                f"{OWNER}: the torque jumps across its mean of {mean:.6g} N m at {np.degrees(angle):.6g} deg, where "
                "the follower would have to reverse at once. Spread the switching of the load over some degrees"
            )
    return float(np.ptp(values)), float(np.max(values)), turns[values < np.roll(values, 1)].tolist()


def _base_radius(stretch, least, values):
    """Least coordinate of the roller centre; by default the smallest for pressure angle and shaft."""
    x, rate = stretch.at(turn_angles(stretch.edges, ANGLE_COUNT), 1)
    steep = np.tan(values["pressure_angle"])
    needed = float(np.max(np.abs(rate + values["guide_offset"]) / steep - (x - least)))
    clear = values["shaft_radius"] + values.get("roller_radius", 0.0) if "shaft_radius" in values else 0.0
    off_shaft = float(np.sqrt(max(clear * clear - values["guide_offset"] ** 2, 0.0)))
    base = values.get("base_radius", max(needed, off_shaft))
    if base < needed * (1.0 - 1e-9):
        raise ParameterError(
            f"{OWNER}: with a base radius of {base:.6g} m the pressure angle exceeds "
            f"{np.degrees(values['pressure_angle']):.6g} deg; choose at least {needed:.6g} m"
        )
    return base

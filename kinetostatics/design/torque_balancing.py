"""A spring-loaded follower on a cam on the crank that evens out the torque of any machine at its design speed.

What the machine stores and gives back over a turn, E = integral of T - mean(T), a spring can store instead: the cam
lets it out as E rises, so that the motor sees the mean alone. `spring_follower` has the equation, which counts the
follower's own inertia in and so needs no iteration.
"""

from dataclasses import replace

import numpy as np

from ..errors import ParameterError
from ..machine.builders import with_roller_follower
from ..machine.cams.profile import POSITIVE
from ..machine.guide import Guide
from ..machine.laws.law import PanelLaw
from ..machine.links import Link
from ..machine.loads import Gravity, Spring
from ..numbers import checks
from ..numbers.panels import Panels
from ..numbers.planar import dot
from ..results.turn import Turn, require_single
from ..solution.scene import Scene
from . import spring_follower
from .torque_balanced import COUNT, TorqueBalancing

OWNER, TURN = "torque_balancing_cam", 2 * np.pi
EVEN = 1e-10
"""Unevenness of the torque, relative to the largest part of it, that counts as none."""
CORNER = 1e-6
"""Jump of the torque across its mean, relative to the largest, that counts as one."""
BESIDE = 1e-9
SWITCHES = {"switches": checks.Number("rad", table=True)}
OPTIONAL = ("stiffness", "base_radius", "roller_radius", "shaft_radius")
STEEP, STEEPEST = np.radians(30.0), np.radians(85.0)


def torque_balancing_cam(
    scene,
    *,
    mass,
    travel,
    stiffness=None,
    guide_angle=0.0,
    guide_offset=0.0,
    base_radius=None,
    pressure_angle=STEEP,
    roller_radius=None,
    shaft_radius=None,
    pin="R",
    label="_cam",
    switches=(),
):
    """Cam on the crank with a spring-loaded roller follower that leaves the mean of the torque alone.

    Parameters
    ----------
    scene : Scene
        Any machine, of one design at constant crank speed; its loads may switch, at any power that does not jump
        across the mean.
    mass : float
        Of the follower with roller, and a third of the spring, kg.
    travel : float
        Of the follower, m. A longer one needs a softer spring and less force.
    stiffness : float, optional
        N/m; unless told that with which the spring is stretched twice as far at most as at least.
    guide_angle, guide_offset : float
        Of the follower's guide, from O outward; rad and m.
    base_radius : float, optional
        Least coordinate of the roller centre along the guide, m; unless told the least that keeps to `pressure_angle`.
    pressure_angle : float
        Largest, rad; a limit where `base_radius` is given too.
    roller_radius : float, optional
        m; refused where it would undercut the cam.
    shaft_radius : float, optional
        m. The least base radius keeps the cam off the shaft too; with a smaller one given the report warns.
    pin, label : str
        Of the `RollerFollower`.
    switches : sequence of float
        Crank angles at which a load switches, rad; those not told are found.

    Returns
    -------
    TorqueBalancing

    Raises
    ------
    ParameterError
        The torque is even as it is, jumps across its mean, or the scene has several designs or no constant speed; the
        spring is too soft for contact or too stiff for the travel, with the bounds; the pressure angle or the roller
        does not fit; friction at O, which the contact force would add to.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> drive = ks.load_case("chain_unit").variants["rho-0.1"].scene
    >>> found = ks.design.torque_balancing_cam(drive, mass=0.3, travel=0.01)
    >>> found.remaining < 1e-9, found.lifts_off
    (True, ())
    """
    given = {"stiffness": stiffness, "base_radius": base_radius, "roller_radius": roller_radius, "mass": mass}
    given |= {"shaft_radius": shaft_radius, "travel": travel, "pressure_angle": pressure_angle}
    values = _checked(scene, given | {"guide_angle": guide_angle, "guide_offset": guide_offset})
    if np.size(switches):
        switches = np.atleast_1d(checks.examined(OWNER, SWITCHES, {"switches": switches})["switches"])
    torque, energy = _energy(scene, switches)
    moving = values["mass"] * float(scene.crank_speed) ** 2
    swing, peak, lows = _swing(torque, energy)
    stiffness, least = _spring(values, swing)
    level = peak + 0.5 * stiffness * least * least
    reserve = _reserve(values, energy, lows, level, moving, stiffness)
    stretch = spring_follower.stretched(energy, level, moving, stiffness)
    shift = _base(stretch, least, values) - least
    guide = Guide.at(values["guide_angle"], values["guide_offset"])
    law, link = PanelLaw(stretch.plus(shift)), Link(values["mass"])
    name = f"{scene.mechanism.name} with torque-balancing cam"
    mechanism = with_roller_follower(scene.mechanism, name, law, guide, link, pin, label)
    follower = mechanism.groups[-1]
    if roller_radius is not None:
        follower.disk.profile(values["roller_radius"], 360)
    weight = sum(float(dot(guide.direction, item.vector)) for item in scene.loads if isinstance(item, Gravity))
    spring = Spring(stiffness, shift - values["mass"] * weight / stiffness, on="follower" + label)
    loaded = replace(scene, mechanism=mechanism, loads=(*scene.loads, spring))
    ends = least, least + values["travel"]
    radii = values.get("shaft_radius"), values.get("roller_radius")
    return TorqueBalancing(loaded, scene, follower, spring, torque.mean, swing, ends, reserve, *radii)


def _checked(scene, given):
    """Values of what is given, by name."""
    rules = dict.fromkeys(("base_radius", "roller_radius", "shaft_radius", "travel"), ("m", POSITIVE))
    rules |= {"stiffness": ("N/m", POSITIVE), "mass": ("kg", POSITIVE)}
    rules |= {"pressure_angle": ("rad", POSITIVE | {"high": STEEPEST}), "guide_angle": ("rad", {})}
    rules |= {"guide_offset": ("m", {})}
    told = {name: value for name, value in given.items() if value is not None or name not in OPTIONAL}
    return checks.singles(OWNER, _scene_problem(scene), **{name: (value, *rules[name]) for name, value in told.items()})


def _reserve(values, energy, lows, level, moving, stiffness):
    """Times the force that contact needs with which the spring pulls, the least; refused where that does not do."""
    reserves = {low: spring_follower.reserve(energy, low, level, moving, stiffness) for low in lows}
    reserve = min(reserves.values())
    if reserve <= 1.0:
        raise ParameterError(_no_contact(values, min(reserves, key=reserves.__getitem__), reserve))
    return reserve


def _scene_problem(scene):
    """What is wrong with a scene, as a sentence, or None."""
    if not isinstance(scene, Scene):
        return f"takes a Scene, as of a case's variant, got {checks.shown(scene)}"
    if np.ndim(scene.crank_speed) or np.ndim(scene.crank_acceleration) or scene.crank_acceleration:
        return "the crank must turn at one constant speed, its design speed"
    if not scene.crank_speed:
        return "the crank stands; give it its design speed"
    if abs(scene.period - TURN) > 1e-9:
        return f"motion and loads must repeat after a turn, but do after {scene.period / TURN:.6g}: a cam cannot"
    if "O" in scene.friction.acting:
        return "friction at O grows with the force of the cam; leave it out, and look at it in the scene that is made"
    return None


def _energy(scene, switches):
    """Torque as panels, and the integral of what it is above its mean."""
    solution = scene.solve(720)
    require_single(solution, OWNER, "balancing_torque")
    _require_uneven(solution.balancing_torque, solution.dynamics.largest_torque_term)
    kinks = Turn.of(solution).kinks
    try:
        torque = Panels.of(lambda angle: solution.at(angle).balancing_torque, TURN, [*kinks, *switches])
    except ParameterError as error:
        raise ParameterError(f"{OWNER}: of the torque: {error}") from None
    return torque, torque.plus(-torque.mean).integral


def _require_uneven(torque, size):
    """Raise if the torque is its mean but for rounding of the torques that it is a sum of."""
    if not np.ptp(torque) > EVEN * size:
        raise ParameterError(f"{OWNER}: the torque is even as it is, {np.mean(torque):.6g} N m all the way")


def _swing(torque, energy):
    """Range of the machine's energy, its peak, and the crank angles where it is least."""
    mean = torque.mean
    size = float(np.max(np.abs(torque(np.linspace(0.0, TURN, COUNT)))))
    turns = torque.plus(-mean).roots
    values = energy(turns)
    for angle in turns:
        beside = np.abs(torque(angle + np.array([-BESIDE, BESIDE])) - mean)
        if np.max(beside) > CORNER * size:
            raise ParameterError(
                f"{OWNER}: the torque jumps across its mean of {mean:.6g} N m at {np.degrees(angle):.6g} deg, where "
                "the follower would have to turn back at once; let the load that switches there take some degrees"
            )
    return (
        float(np.ptp(values)),
        float(np.max(values)),
        [angle for place, angle in enumerate(turns) if values[place] < values[place - 1]],
    )


def _spring(values, swing):
    """Stiffness, and least stretch, by the energy between both ends of the travel."""
    travel = values["travel"]
    stiffness = values.get("stiffness", 2.0 * swing / (3.0 * travel * travel))
    least = swing / (stiffness * travel) - travel / 2.0
    if least <= 0.0:
        raise ParameterError(
            f"{OWNER}: a spring of {stiffness:.6g} N/m takes up more than the {swing:.6g} J of the machine on a travel "
            f"of {travel:.6g} m without any preload; take less than {2.0 * swing / travel**2:.6g} N/m, or a travel "
            f"below {np.sqrt(2.0 * swing / stiffness):.6g} m"
        )
    return stiffness, least


def _no_contact(values, low, reserve):
    """Why the follower does not stay on the cam: (k x)^2 must exceed 4 m omega^2 E'' where E is least."""
    mass = values["mass"]
    return (
        f"{OWNER}: the follower would lift off at {np.degrees(low) % 360:.6g} deg, where the spring pulls with "
        f"{reserve:.4g} times the force 2 omega sqrt(m E'') that contact needs; make the travel shorter than "
        f"{values['travel'] * reserve:.6g} m, or the follower lighter than {mass * reserve**2:.6g} kg"
    )


def _base(stretch, least, values):
    """Least coordinate of the roller centre; unless given that which keeps to the pressure angle and off the shaft."""
    angle = np.linspace(0.0, TURN, COUNT)
    x, rate = stretch.at(angle, 1)
    steep = np.tan(values["pressure_angle"])
    needed = float(np.max(np.abs(rate + values["guide_offset"]) / steep - (x - least)))
    clear = values.get("shaft_radius", 0.0) + (values.get("roller_radius", 0.0) if "shaft_radius" in values else 0.0)
    off_shaft = float(np.sqrt(max(clear * clear - values["guide_offset"] ** 2, 0.0)))
    base = values.get("base_radius", max(needed, off_shaft))
    if base < needed * (1.0 - 1e-9):
        raise ParameterError(
            f"{OWNER}: with a base radius of {base:.6g} m the pressure angle exceeds "
            f"{np.degrees(values['pressure_angle']):.6g} deg; take at least {needed:.6g} m"
        )
    return base

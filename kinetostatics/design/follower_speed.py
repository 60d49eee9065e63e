"""Speed limits of machines with a cam and springs: lift-off, surge of the springs, torque to start."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..cycle.extremes import extrema, largest_of
from ..cycle.limit_positions import require_single
from ..cycle.piecewise import Pieces, edges_between, rule
from ..errors import ParameterError
from ..machine.cams.profile import PEAK_SAMPLES, POSITIVE, Peak
from ..machine.loads import TURN, Spring, surge
from ..numbers import checks
from ..numbers.formatting import with_units
from ..numbers.sign_changes import sign_changes
from ..solution.scene import Scene

REST_SPEED_RATIO = 1e-6
"""Crank speed used for rest, relative to the crank speed; it keeps the sign of forces that vanish at rest."""
QUADRATIC_TOLERANCE = 1e-9
"""Negligible deviation of forces from growth with the squared speed, relative to the largest force."""
MAX_SPEED_RATIO = 1e3
"""Largest speed of the search for lift-off over the crank speed."""
SPEED_TOLERANCE = 1e-12
"""Relative error of the speed of lift-off."""
HARMONICS, SURGE_POINTS = 360, 16
"""Harmonics of the spring's end, and crank angles in two periods of the highest one."""


@with_units(natural_frequency="rad/s", amplitudes="m")
class Surge(NamedTuple):
    """First natural oscillation of a spring between its ends, and the harmonics of its end.

    Attributes
    ----------
    natural_frequency : float
        rad/s.
    order : float
        Oscillations per turn of the crank at the solution's mean speed.
    amplitudes : array
        Amplitudes of the spring's end by order (harmonic of a turn), m; the first is the mean.

    Examples
    --------
    As `ks.design.spring_surge` returns it.

    >>> import kinetostatics as ks
    >>> at_work = ks.solve(ks.crank_slider(0.1, 0.3), 0.5, crank_speed=10.0, loads=ks.Spring(2e3, 0.3))
    >>> found = ks.design.spring_surge(at_work, 0.5)
    >>> print(f"{found.natural_frequency:.1f} rad/s, {found.order:.2f} swings a turn")
    198.7 rad/s, 19.87 swings a turn
    """

    natural_frequency: float
    order: float
    amplitudes: np.ndarray

    @property
    def excitation(self):
        """Amplitude of the end's motion at the order nearest to the natural frequency, m."""
        known = 0.5 < self.order < len(self.amplitudes) - 0.5
        return float(self.amplitudes[round(self.order)]) if known else 0.0

    def speeds(self, orders=range(1, 13)):
        """Crank speeds at which a harmonic of each order meets the natural frequency, rad/s."""
        orders = tuple(orders) if np.iterable(orders) else (orders,)
        checks.require("speeds", *(checks.count("an order", order) for order in orders))
        return {order: self.natural_frequency / order for order in orders}


def lift_off_speed(solution, force="cam_force"):
    """Crank speed at which the roller leaves the side of the cam that carries it at rest, rad/s.

    Parameters
    ----------
    solution : Solution
        One design of a mechanism with a `CamRoller` or a follower; its speed gives the sense of rotation.
    force : str
        Name of the contact force: "contact_force", with the label of its follower, for a cam that turns.

    Returns
    -------
    float
        0 if both sides carry it at rest, or loads pull a flat face off at rest; inf without lift-off up to 1000 times
        the crank speed.

    Raises
    ------
    ParameterError
        The solution has no cam roller, or is of a batch of designs.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> roller = ks.CamRoller(ks.cams.Circle(0.1, (0.02, 0.0)), block=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (roller,))
    >>> spring = ks.PointSpring(5e3, 0.03, between=("A", (0.0, 0.0)))
    >>> round(ks.design.lift_off_speed(ks.solve(machine, 0.5, crank_speed=10.0, loads=spring)), 6)
    39.528471
    """
    _require(solution, "lift_off_speed", force)
    fast = _mean_speed(solution)
    angle, ends = _angles(solution), extrema(_solution_at(solution, REST_SPEED_RATIO * fast, 0.0), force).range
    one_sided = any(led.flat for group in solution.mechanism.groups for led in group.led if led.force == force)
    if not ends[0] * ends[1] > 0.0 or (one_sided and ends[0] < 0.0):
        return 0.0
    rest, moving, faster = (
        _force(solution, force, speed, angle) for speed in (REST_SPEED_RATIO * fast, fast, 2.0 * fast)
    )
    if np.max(np.abs(faster - rest - 4.0 * (moving - rest))) <= QUADRATIC_TOLERANCE * np.max(np.abs(faster)):

        def ratio(angle):
            rest = _force(solution, force, REST_SPEED_RATIO * fast, angle)
            return (rest - _force(solution, force, fast, angle)) / (fast * fast * rest)

        peak = peak_of(solution, lambda at: ratio(at.crank_angle)).value
        found = np.inf if peak <= 0.0 else float(1.0 / np.sqrt(peak))
        return found if found <= MAX_SPEED_RATIO * abs(fast) else np.inf
    return _lift_off_by_search(solution, force, fast, np.sign(ends[0]), angle)


def _lift_off_by_search(solution, force, fast, side, angle):
    """Least speed, rad/s, at which the force vanishes at a crank angle, by search."""
    from scipy.optimize import brentq

    def least(speed, angle):
        return float(np.min(side * _force(solution, force, np.copysign(speed, fast), angle)))

    rest = REST_SPEED_RATIO * abs(fast)
    speeds = abs(fast) * np.geomspace(0.01, MAX_SPEED_RATIO, 61)
    above = next((speed for speed in speeds if least(speed, angle) < 0.0), None)
    speed = np.inf if above is None else float(brentq(least, rest, above, (angle,), rtol=SPEED_TOLERANCE))
    while np.isfinite(speed):  # the force is smallest between those angles
        found = extrema(_solution_at(solution, np.copysign(speed, fast), 0.0), force)
        lowest = found.angle[[np.argmin(side * found.value)]]
        if least(speed, lowest) >= 0.0:
            break
        before, speed = speed, float(brentq(least, rest, speed, (lowest,), rtol=SPEED_TOLERANCE))
        if speed >= before * (1.0 - SPEED_TOLERANCE):
            break
    return speed


def lifted(solution, force="cam_force"):
    """Crank-angle intervals in which a contact force pulls, so the contact would lift off.

    Parameters
    ----------
    solution : Solution
        Of one design.
    force : str
        Name of a force that is positive where it presses: "contact_force", with the label of the follower.

    Returns
    -------
    tuple of (float, float)
        Start and stop of each interval, rad; a stop beyond the period is in the next period.

    Raises
    ------
    ParameterError
        The force is unknown, or the solution is a batch of designs.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> follower = ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0))
    >>> machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    >>> spring = ks.Spring(5e3, 0.04, on="follower")
    >>> ks.design.lifted(ks.solve(machine, 0.0, crank_speed=40.0, loads=spring), "contact_force")
    ()
    >>> ((start, stop),) = ks.design.lifted(ks.solve(machine, 0.0, crank_speed=90.0, loads=spring), "contact_force")
    >>> round(float(start), 6), round(float(stop), 6)
    (-1.108026, 1.108026)
    """
    _require(solution, "lifted", force)
    ends, period = force_changes(solution, force), solution.period
    edges = np.append(ends[-1] - period, ends) if ends.size else np.array([0.0, period])
    pulling = solution.at(np.mod(0.5 * (edges[1:] + edges[:-1]), period)).scalar(force) < 0.0
    return tuple(zip(edges[:-1][pulling].tolist(), edges[1:][pulling].tolist(), strict=True))


def force_changes(solution, force):
    """Crank angles at which a contact force changes its sign, rising, rad."""

    def values(angle):
        return [solution.at(angle).scalar(force) + 0.0]  # -0.0 has a sign

    return np.sort(sign_changes(values, solution.period, _angles(solution)).angle[0])


def starting_torque(solution):
    """Largest torque that turns the crank from rest, without sign, N m, and its crank angle.

    The torque overcomes springs, weights and friction, but not inertia.

    Parameters
    ----------
    solution : Solution
        One design; its crank angles have no effect, and its speed gives only the sense of rotation, at rest that of
        `sense` or the acceleration.

    Returns
    -------
    Peak
        ``.value``, N m, at ``.angle``, rad.

    Raises
    ------
    ParameterError
        The solution is of a batch of designs.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.1, 0.3, slider=ks.Link(10.0))
    >>> at_work = ks.solve(pump, 0.5, crank_speed=10.0, loads=ks.Spring(2e3, 0.3))
    >>> round(ks.design.starting_torque(at_work).value, 3)
    11.312
    """
    _require(solution, "starting_torque", "balancing_torque")
    return peak_of(_solution_at(solution, 0.0, 0.0), lambda at: np.abs(at.balancing_torque))


def spring_surge(solution, spring_mass=None):
    """Natural frequency of the springs on a slider, and the harmonics with which the machine moves their ends.

    With both ends fixed, omega = pi sqrt(k / m) (derived in `machine.loads.surge`). If omega is a low multiple of the
    crank speed and that harmonic is not small, the coils clash (Wahl, *Mechanical Springs*, 1963, chapter 13). The rate
    k of a progressive spring is its mean over the period.

    Parameters
    ----------
    solution : Solution
        Of one design, with a `Spring` among its loads.
    spring_mass : float, optional
        Mass of all springs together, kg; by default the `mass` of the `Spring`.

    Returns
    -------
    Surge

    Raises
    ------
    ParameterError
        The loads do not contain exactly one spring, or its mass is unknown.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.crank_slider(0.1, 0.3)
    >>> at_work = ks.solve(pump, 0.5, crank_speed=10.0, loads=ks.Spring(2e3, 0.3))
    >>> found = ks.design.spring_surge(at_work, 0.5)
    >>> print(f"order {found.order:.2f}, second harmonic {found.amplitudes[2] * 1e3:.2f} mm")
    order 19.87, second harmonic 8.58 mm
    """
    checks.require("spring_surge", checks.solution("solution", solution))
    require_single(solution, "spring_surge", "slider_position")
    springs = [load for load in solution.loads if isinstance(load, Spring)]
    if spring_mass is None and not any(np.any(spring.mass) for spring in springs):
        raise ParameterError("spring_surge: spring_mass must be given, kg, since no Spring of the solution has a mass")
    given = springs[0].mass if spring_mass is None else spring_mass
    mass = checks.single_numbers("spring_surge", spring_mass=(given, "kg", POSITIVE))["spring_mass"]
    if len(springs) != 1:
        raise ParameterError(f"spring_surge: needs a solution with one Spring among its loads, got {len(springs)}")
    (spring,) = springs
    pieces = Pieces(edges_between(solution.sampled.pieces.edges, 2.0 * TURN / HARMONICS), SURGE_POINTS)
    angle, weights = pieces.angle.ravel(), np.ravel(pieces.half * rule(SURGE_POINTS).weights) / solution.period
    end = solution.at(angle).placement.travels[spring.on].position
    rate = float(spring.mean_rate(end, weights))
    if not rate > 0.0:
        raise ParameterError(f"spring_surge: the Spring must have a stiffness, but its mean rate is {rate:.6g} N/m")
    waves = np.exp(1j * np.outer(np.arange(HARMONICS), angle))
    series = np.abs(waves @ (weights * end))
    series[1:] *= 2.0
    natural = float(surge.surge_frequency(rate, mass))
    speed = abs(float(np.mean(solution.crank_speed)))
    return Surge(natural, natural / speed if speed else np.inf, series)


def _angles(solution):
    """Crank angles over the period, rising from 0, including both sides of every kink and narrow pulse."""
    even = np.linspace(0.0, solution.period, PEAK_SAMPLES, endpoint=False)
    return np.union1d(even, solution.sampled.angle)


def peak_of(solution, function):
    """Largest value of a function of a solution over the period, a `Peak`; at angle 0 for a constant."""
    value, angle = largest_of(extrema(solution, function))
    return Peak(value, float(np.nan_to_num(angle)))


def _require(solution, owner, name):
    checks.require(owner, checks.solution("solution", solution))
    require_single(solution, owner, name)
    if name == "cam_force" and name not in solution.scalars:
        raise ParameterError(f"{owner}: needs a mechanism with a CamRoller, but a {solution.mechanism.name} has none")
    checks.require(owner, checks.choice("force", name, tuple(solution.scalars)) if name else None)


def _mean_speed(solution):
    """Mean crank speed over the crank angles, signed, rad/s; 1 rad/s in its sense for a machine at rest."""
    return float(np.mean(solution.crank_speed)) or float(np.ravel(solution.crank_sense)[0])


def _solution_at(solution, speed, angle):
    """Solution at another speed of the same sense of rotation, or at rest in that sense."""
    drive = {"crank_speed": speed, "crank_acceleration": 0.0, "sense": np.copysign(1.0, _mean_speed(solution))}
    return replace(Scene.of(solution), **drive).solve(angle)


def _force(solution, name, speed, angle):
    return _solution_at(solution, speed, angle).scalar(name)

"""Periodic running of a machine under its motor, or under a constant torque, exact to rounding.

`energy_equation` solves for the energy over the crank angle. The initial guess is the operating speed, at which the
mean torques of motor and loads are equal. If Newton's method does not converge from there, a motion from a high speed
gives the guess.
"""

import math
from functools import partial

import numpy as np

from ..cycle.piecewise import MAX_PIECES, TAIL, Pieces
from ..errors import DriveError
from ..machine.loads import TURN
from ..numbers import checks
from ..numbers.parameter_tree import replace_unchecked
from ..solution.parameters import crank_angles
from ..solution.scene import scene_problem
from .energy_equation import MAX_GROWTH_EXPONENT, linearise, refine, resolve_energy, solve_energy
from .one_dof import DrivenMachine
from .resolution import require_inertia, resolve_and_hint
from .running import Running
from .stick_slip import March

MAX_STIFF_HALVINGS = 3
"""Halvings of all pieces where the iteration does not converge, as with stiff motors."""


def solve_near(driven, pieces, guess):
    """Pieces and `solve_energy` of periodic running near `guess(pieces)`, on finer pieces if needed; else None."""
    for halving in range(MAX_STIFF_HALVINGS + 1):
        if halving:
            pieces = pieces.split(pieces.can_split)
        growth = np.abs(pieces.piece_integrals(linearise(driven, pieces, guess(pieces)).growth))
        parts = np.ceil(np.fmin(growth / MAX_GROWTH_EXPONENT, MAX_PIECES + 1.0)).astype(int)
        if parts.max() > 1 and parts.sum() <= MAX_PIECES:
            spans = zip(pieces.edges[:-1], pieces.edges[1:], parts, strict=True)
            edges = [np.linspace(low, high, max(count, 1), endpoint=False) for low, high, count in spans]
            pieces = Pieces(np.concatenate([*edges, pieces.edges[-1:]]), pieces.count)
        found = solve_energy(driven, pieces, guess(pieces))
        if found is not None:
            return pieces, found
    return None


MIN_GROWTH, MAX_GROWTH = 1e-10, 1e6
"""Integrals of abs(a) over the period between which a motion reaches periodic running."""
MAX_TURNS = 100
"""Periods of that motion."""


def settle_from_above(driven, pieces, start):
    """Pieces and `solve_energy` of periodic running, from a motion at high speed, where Newton's method fails.

    Motions of one degree of freedom do not cross. So a motion from above reaches the fastest periodic running, or no
    periodic running exists.
    """
    direction, turns, inertia = driven.direction, 0, driven.inertia(pieces.angle)
    growth = linearise(driven, pieces, 0.5 * inertia * start * start).growth
    share = float(np.abs(pieces.piece_integrals(growth)).sum())
    march = March(driven, 0.0, 2.0 * direction * abs(start))
    while turns < MAX_TURNS and share <= MAX_GROWTH:
        last, turns = march.energy, turns + 1
        if not march.turn(direction):
            missing = abs(driven.torque_at_rest(march.inside)[0])
            raise DriveError(
                f"{driven.scene.mechanism.name}: the motor is too weak, so there is no periodic running. From "
                f"{2.0 * abs(start):.6g} rad/s, the machine comes to a standstill at crank angle "
                f"{math.degrees(march.inside):.6g} deg in turn {turns}, where {missing:.6g} N m are missing at the "
                "crank. Give a larger flywheel or a stronger motor",
                missing,
                march.inside,
            )
        if abs(march.energy - last) < 0.05 * last:
            running = solve_near(driven, pieces, march.energy_at)
            if running is not None:
                return running
            if abs(march.energy - last) < 1e-4 * last:
                break
    raise DriveError(
        f"{driven.scene.mechanism.name}: no periodic running was found in {turns} turns from "
        f"{2.0 * abs(start):.6g} rad/s; {_remedy(share, inertia.max())}"
    )


def _remedy(share, inertia):
    """Remedy for runs without convergence, according to the dependence of the torque on the speed."""
    if share < MIN_GROWTH:
        return (
            f"motor and loads stabilise the speed by only {share:.1e} of the kinetic energy per turn, for an inertia "
            f"of {inertia:.6g} kg m2 at the crank. Give a stronger motor, or less inertia"
        )
    if share > MAX_GROWTH:
        return (
            f"the motor is so rigid that its torque changes by {share:.1e} times the kinetic energy per turn with "
            "the speed; give it its true slip, or a larger flywheel"
        )
    return "give a larger flywheel"


MEAN_LOAD_ANGLES = 96
"""Crank angles of a mean load torque."""
SPEED_COUNT = 512
"""Speeds of the search for the operating speed."""
FRICTION_SPEED_COUNT = 16
"""Speeds with computed mean friction torque; the search first interpolates between them."""


def operating_speed(driven):
    """Highest crank speed with equal mean torques of motor and loads, stable against more load, rad/s."""
    motor, name = driven.motor, driven.scene.mechanism.name
    if math.isfinite(motor.top):
        speed = motor.top * np.linspace(0.0, 1.0, SPEED_COUNT)
    elif driven.by_speed:
        speed = np.concatenate([[0.0], np.geomspace(1e-4, 1e6, SPEED_COUNT)]) * abs(motor.transmission)
    else:
        mean = float(_mean_load(driven, np.ones(1))[0])
        raise DriveError(
            f"{name}: nothing stabilises the speed, as neither the motor's torque nor the loads depend on it; a turn "
            f"leaves {TURN * (motor.torque_at_crank(0.0) - mean):.6g} J over; give a motor whose torque falls with "
            "speed"
        )
    load, spare, ends = _spare_torque(driven, speed, interpolate=driven.smooth_by_speed)
    if driven.smooth_by_speed:  # the interpolated load may place the interval wrongly
        above, below = (1.0, 1.0) if ends is None else _spare_torque(driven, np.array(ends))[1]
        if not above > 0.0 >= below:
            load, spare, ends = _spare_torque(driven, speed)
    if ends is not None:
        from scipy.optimize import brentq

        def spare_at(own):
            if not driven.by_speed:
                return motor.torque(own) - load[0]
            return float(_spare_torque(driven, np.array([own]))[1][0])

        return float(brentq(spare_at, *ends, xtol=1e-9 * ends[1], rtol=1e-9)) / motor.transmission
    if spare[-1] > 0.0:
        raise DriveError(
            f"{name}: the machine runs away: at {speed[-1]:.6g} rad/s, the highest motor speed of the search, "
            f"{spare[-1]:.6g} N m are left over at its shaft. Give more load, a motor that brakes beyond its speed"
            f"{', more rows to its table' * math.isfinite(motor.limits[1])}, or another transmission"
        )
    best = int(np.argmax(spare))
    missing = float(-spare[best] * abs(motor.transmission))
    torque, remedy = motor.torque(speed), "that drives "
    drives = torque > 0.0
    if drives.any():
        remedy = f"{math.ceil(1e3 * np.min(load[drives] / torque[drives])) / 1e3:.6g} times as strong "
    raise DriveError(
        f"{name}: the motor is too weak, so there is no periodic running. The loads take {load[best]:.6g} N m at its "
        f"shaft in the mean, where it gives {motor.torque(speed[best]):.6g} N m at most (at {speed[best]:.6g} rad/s). "
        f"{-spare[best]:.6g} N m are missing, {missing:.6g} N m at the crank. Give a motor "
        f"{remedy}or another transmission",
        missing,
    )


def _spare_torque(driven, speed, interpolate=False):
    """Mean load torque at motor speeds, spare motor torque, and the highest interval in which that becomes negative.

    `interpolate`: the load is computed at a few speeds and interpolated linearly over the squared speed.
    """
    motor = driven.motor
    crank_speed = speed / motor.transmission
    if interpolate:
        few = np.linspace(0, crank_speed.size - 1, FRICTION_SPEED_COUNT).astype(int)
        load = np.interp(crank_speed**2, crank_speed[few] ** 2, _mean_load(driven, crank_speed[few]))
    else:
        load = _mean_load(driven, crank_speed)
    load = load / motor.transmission
    spare = motor.torque(speed) - load
    crossing = np.flatnonzero((spare[:-1] > 0.0) & (spare[1:] <= 0.0))
    return load, spare, (speed[crossing[-1]], speed[crossing[-1] + 1]) if crossing.size else None


def require_within_motor_table(driven, speed):
    """Refuse crank speeds outside the motor's table."""
    own = driven.motor.transmission * speed
    low, high = driven.motor.limits
    if own.min() < low or own.max() > high:
        raise DriveError(
            f"{driven.scene.mechanism.name}: the motor runs at {own.min():.6g} to {own.max():.6g} rad/s, but its table "
            f"covers only {low:.6g} to {high:.6g} rad/s; give more rows"
        )


def _mean_load(driven, speed):
    """Mean load torque over the period at constant crank speeds, N m."""
    angle = (np.arange(MEAN_LOAD_ANGLES) + 0.5) * driven.period / MEAN_LOAD_ANGLES
    if not driven.by_speed:
        return driven.at(angle).torque.mean() + 0.0 * speed
    grid = np.broadcast_arrays(angle[None, :], speed[:, None])
    return driven.at_acceleration(*grid, 0.0).torque.mean(axis=1)


MAX_FRICTION_UPDATES = 60
"""Updates of friction under a constant torque."""
SPEED_TOLERANCE = 2e-15
"""Relative change of speed below which these updates end."""


def steady(scene, motor, flywheel=0.0, *, angles=720, engine=None) -> Running:
    """Periodic running of a machine under its motor, exact to rounding.

    If several exist, it is the stable one at the highest speed; running below the motor's breakdown torque does not
    count. The result covers one period: one turn, or the number of turns after which motion and loads repeat.

    Parameters
    ----------
    scene : Scene
        Mechanism and loads; its crank speed matters only with `motor` None.
    motor : Motor or None
        None: a motor whose constant torque keeps the scene's mean speed, as in textbooks. The loads must then not
        depend on the speed.
    flywheel : float
        Moment of inertia on the crank besides its own link, kg m2.
    angles : int or array
        Crank angles of the tables: their number over the period, end excluded, or the angles, rad.
    engine : "numpy" or "compiled"
        As for `solve`; "compiled" saves time if the same kind of machine runs often.

    Returns
    -------
    Running

    Raises
    ------
    DriveError
        There is no periodic running: the motor is too weak (the message gives the missing torque); nothing stabilises
        the speed; the inertia vanishes somewhere.
    ParameterError
        A value is out of range, or a load has values only at some crank angles.
    AssemblyError
        The mechanism does not make full turns.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> run = ks.drive.steady(pump, motor, flywheel=0.05)
    >>> print(f"{run.mean_speed:.4f} rad/s, fluctuation {run.fluctuation:.5f}")
    104.6753 rad/s, fluctuation 0.05021
    """
    direction = None
    if motor is None:
        checks.require("steady", scene_problem(scene))
        speed, wrong = checks.single_number("crank_speed of the scene", scene.crank_speed, "rad/s", unequal=0.0)
        checks.require("steady", wrong)
        direction = math.copysign(1.0, speed)
    driven = DrivenMachine("steady", scene, motor, flywheel, engine, direction)
    driven.require_fixed_kinks()
    is_count = isinstance(angles, int | np.integer) and not isinstance(angles, bool)
    checks.require("steady", checks.count("angles", angles, size=checks.BYTES_PER_ANGLE) if is_count else None)
    scene = replace_unchecked(scene, sense=None)  # the sense is the sign of the speed, which never vanishes in running
    pieces, energy = (_run_at_mean_speed if motor is None else _run_under_motor)(driven, scene)
    angle = np.linspace(0.0, driven.period, angles, endpoint=False) if is_count else crank_angles(angles)
    again = partial(steady, scene, motor, angles=angles, engine=engine)
    return Running(scene, motor, driven.flywheel, angle, driven, pieces, energy, again)


def _run_under_motor(driven, scene):
    """Pieces, and energy U at their points, of stable periodic running under a motor."""
    start = operating_speed(driven)
    pieces, kinks = resolve_and_hint(driven, start)
    require_inertia(driven, pieces)

    def near(pieces, guess, *_):
        return solve_near(driven, pieces, guess) or settle_from_above(driven, pieces, start)

    pieces, found = near(pieces, lambda pieces: 0.5 * driven.inertia(pieces.angle) * start * start)
    pieces, (energy, _, linear), _ = resolve_energy(driven, pieces, found, kinks, near)
    require_within_motor_table(driven, linear.speed)
    return pieces, energy


def _run_at_mean_speed(driven, scene):
    """Pieces, and energy U at their points, under the constant torque that keeps the scene's mean speed."""
    if driven.loads_by_speed:
        raise DriveError(
            f"{scene.mechanism.name}: loads depend on the speed, so the constant torque is unknown; give a motor"
        )
    speed = abs(scene.crank_speed)
    pieces, kinks = resolve_and_hint(driven, driven.direction * speed)
    require_inertia(driven, pieces)

    def rows(pieces, found):
        _, slow, acceleration = found
        return driven.kink_rows(pieces.angle, driven.direction / slow, acceleration)

    def unresolved(pieces, found):
        return np.any([pieces.tail(part) > TAIL for part in found[:2]], axis=0) & pieces.can_split

    def solve(pieces, *_):
        return pieces, _under_constant_torque(driven, pieces, speed)

    found = _under_constant_torque(driven, pieces, speed)
    pieces, (energy, *_), _ = refine(driven, pieces, found, kinks, rows, unresolved, solve)
    return pieces, energy


def _under_constant_torque(driven, pieces, speed):
    """Energy U at a mean speed, inverse of the speed, and acceleration; sets `driven.constant_torque`.

    Friction depends on speed and acceleration: solve, update friction, repeat until the speed stops changing.
    """
    from scipy.optimize import brentq

    slow, acceleration = np.full(pieces.angle.shape, 1.0 / speed), np.zeros(pieces.angle.shape)
    for _ in range(MAX_FRICTION_UPDATES):
        state = driven.at_acceleration(pieces.angle, driven.direction / slow, acceleration)
        inertia, before = driven.flywheel + state.inertia, slow
        driven.constant_torque = pieces.whole_integral(state.torque) / driven.period
        gained = pieces.integral_from_start(driven.constant_torque - state.torque)
        gained = gained + pieces.largest(-gained)[0]
        scale = 0.5 * speed * speed * pieces.whole_integral(inertia) / driven.period

        def excess_speed(size, inertia=inertia, gained=gained, scale=scale):
            slowness = np.sqrt(0.5 * inertia / (gained + scale * math.exp(size)))
            return driven.period / pieces.whole_integral(slowness) - speed

        low = next((size for size in (-5.0, -12.0, -25.0) if excess_speed(size) < 0.0), None)
        if low is None:
            raise DriveError(
                f"{driven.scene.mechanism.name}: no constant torque keeps a mean speed as low as {speed:.6g} rad/s: "
                "the energy gained within the turn already exceeds it; give a larger flywheel or a higher speed"
            )
        energy = gained + scale * math.exp(brentq(excess_speed, low, 5.0, xtol=1e-15, rtol=1e-15))
        slow = np.sqrt(0.5 * inertia / energy)
        acceleration = (driven.constant_torque - state.torque - 0.5 * state.slope / slow**2) / inertia
        if not driven.by_speed or np.abs(slow - before).max() <= SPEED_TOLERANCE * slow.max():
            break
    return energy, slow, acceleration

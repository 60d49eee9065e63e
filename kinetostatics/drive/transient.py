"""Machines over time: starting from rest, and coasting from a speed, through standstill and reversal.

`stick_slip` integrates the energy over the crank angle between the kinks of loads and friction, and time from it.
"""

import math
import warnings

import numpy as np

from ..errors import DriveError, HintWarning
from ..machine import plausibility
from ..machine.loads import TURN
from ..numbers import checks
from ..numbers.arithmetic import read_only
from .motor import Motor
from .one_dof import DrivenMachine
from .steady_running import require_within_motor_table, steady
from .stick_slip import March, integrate_motion
from .trajectory import Event, Trajectory, accelerations

STARTED_SPEED_RATIO = 0.99
"""Speed over the mean speed of steady running at which a start ends."""
MAX_TURNS = 1e5
"""Largest number of turns of a motion."""
MAX_ANGLE = 1e6
"""Largest initial crank angle, rad; a larger one costs too many digits."""
MIN_TORQUE_RATIO = 1e-9
"""Smallest net torque of a start, relative to the largest torque."""
SLOWING_TOLERANCE = 1e-8
"""Relative loss of kinetic energy in a period below which a machine does not slow down."""
ENERGY_TOLERANCE = 1e-9
"""Negligible energy, relative to the energy exchanged in a turn."""


def coast(scene, flywheel=0.0, from_angle=0.0, from_speed=0.0, until=None, motor=None, *, engine=None) -> Trajectory:
    """Motion of a machine, without motor or with one, from a crank angle and speed.

    Parameters
    ----------
    scene : Scene
        Mechanism and loads; its crank speed has no effect.
    flywheel : float
        Moment of inertia on the crank besides its own link, kg m2.
    from_angle, from_speed : float
        rad, rad/s.
    until : float or "standstill"
        Time, s, or the first standstill.
    motor : Motor, optional
    engine : "numpy" or "compiled"
        As for `solve`.

    Returns
    -------
    Trajectory

    Raises
    ------
    DriveError
        The motion cannot continue: the mechanism does not close, or all inertia vanishes.
    ParameterError
        A value is out of range.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pendulum = ks.Scene(ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15)), 1.0, loads=ks.Gravity())
    >>> motion = ks.drive.coast(pendulum, 0.06, from_angle=-1.0, until=2.0)
    >>> [event.name for event in motion.events]
    ['start', 'reversal', 'reversal', 'reversal', 'end']
    >>> motion.energy_drift < 1e-12
    True
    """
    driven, flywheel, angle, speed = _initial_state("coast", scene, motor, flywheel, from_angle, from_speed, engine)
    if not (isinstance(until, str) and until == "standstill"):
        checks.require("coast", 'give until, a time in s, or "standstill"' if until is None else None)
        until, wrong = checks.single_number("until", until, "s", low=0.0, strict=True)
        checks.require("coast", wrong and f'until must be a time in s, or "standstill": {wrong}')
    elif speed == 0.0:
        checks.require("coast", 'until "standstill" needs a from_speed that is not 0')
    else:
        _require_standstill(driven, angle, speed)
    return _trajectory(driven, scene, angle, speed, until)


def start(scene, motor, flywheel=0.0, from_angle=0.0, until=None, *, engine=None) -> Trajectory:
    """Start of a machine from rest at a crank angle.

    Parameters
    ----------
    scene, motor, flywheel, from_angle, engine
        As for `coast`; the motor is needed.
    until : float, optional
        Time, s; by default until the crank has 99 per cent of the mean speed of steady running.

    Returns
    -------
    Trajectory

    Raises
    ------
    DriveError
        The machine does not start: at this or a later crank angle the loads need more torque at rest than the motor
        gives. The message gives the missing torque and remedies. Or there is no steady running to start to.
    ParameterError
        A value is out of range.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=ks.Gravity())
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> motion = ks.drive.start(pump, motor, 0.05, from_angle=0.3)
    >>> print(f"{motion.time[-1]:.4f} s")
    0.4189 s
    """
    return start_to(None, scene, motor, flywheel, from_angle, until, engine=engine)


def start_to(running, scene, motor, flywheel, from_angle, until=None, *, engine=None):
    """`start` to a periodic running, by default the one it finds."""
    if not isinstance(motor, Motor):
        checks.require("start", f"motor must be a Motor, got {checks.shown(motor)}")
    driven, flywheel, angle, _ = _initial_state("start", scene, motor, flywheel, from_angle, 0.0, engine)
    target = None
    if until is None:
        target = STARTED_SPEED_RATIO * (running or steady(scene, motor, flywheel, engine=engine)).mean_speed
    else:
        until, wrong = checks.single_number("until", until, "s", low=0.0, strict=True)
        checks.require("start", wrong)
    pushing, _ = driven.torque_at_rest(angle)
    places = np.linspace(0.0, driven.period, 96, endpoint=False)
    loads = float(np.abs(driven.at_acceleration(places, 0.0 * places, 0.0).torque).max())
    if not pushing * driven.direction > MIN_TORQUE_RATIO * max(loads, abs(float(driven.motor_torque(0.0)))):
        raise _start_error(driven, angle, "it does not start")
    found = _trajectory(driven, scene, angle, 0.0, until, target, one_way=True)
    if found.events[-1].name == "reversal":
        raise _start_error(driven, found.events[-1].crank_angle, f"it starts and stops after {found.time[-1]:.6g} s")
    return found


def _initial_state(owner, scene, motor, flywheel, from_angle, from_speed, engine):
    """Driven machine, flywheel, crank angle and speed at the start, all checked."""
    angle, wrong = checks.single_number("from_angle", from_angle, "rad")
    if not wrong and abs(angle) > MAX_ANGLE:
        wrong = f"from_angle must be at most {MAX_ANGLE:g} rad in size, got {angle:g}; take whole turns off"
    speed, wrong_speed = checks.single_number("from_speed", from_speed, "rad/s")
    inertia, wrong_inertia = checks.single_number("flywheel", flywheel, "kg*m**2", low=0.0)
    checks.require(owner, wrong, wrong_speed, wrong_inertia)
    for hint in plausibility.single_angle_hints(angle):
        warnings.warn(HintWarning(owner, hint), stacklevel=3)
    driven = DrivenMachine(owner, scene, motor, inertia, engine)
    driven.require_fixed_kinks()
    here = driven.inertia(np.linspace(0.0, driven.period, 32, endpoint=False) + angle)
    if not here[0] > 1e-12 * here.max():
        raise DriveError(
            f"{scene.mechanism.name}: no inertia at crank angle {math.degrees(angle):.6g} deg ({here[0]:.3g} kg m2), "
            "so there is no acceleration there; give a flywheel, or the crank its inertia",
            crank_angle=angle,
        )
    for hint in driven.scene.check_resolution().hints:
        warnings.warn(HintWarning(owner, hint), stacklevel=3)
    return driven, inertia, angle, speed


def _require_standstill(driven, angle, speed):
    """Refuse a machine that never stops: its motor or loads return in a turn all the energy that they take.

    Motions of one degree of freedom do not cross: none falls below periodic running under the motor, and a machine
    that is not slower after a period never becomes slower.
    """
    way, name = math.copysign(1.0, speed), driven.scene.mechanism.name
    machine = driven.along(way)
    if driven.motor is not None or driven.by_speed:  # friction and dampers take energy
        steady_speed = math.inf
        if driven.motor is not None and way == driven.direction:
            try:
                running = steady(driven.scene, driven.motor, driven.flywheel - driven.motor.inertia_at_crank)
                steady_speed = abs(float(running.motion(np.array([angle]))[0][0]))
            except DriveError:  # no running prevents its stop
                pass
        if abs(speed) >= steady_speed:
            raise DriveError(f"{name}: never comes to a standstill: its motor keeps it running; give a time as until")
        march = March(driven, angle, speed)
        before = march.energy
        left = march.energy / before if march.turn(way) else 0.0
        if left >= 1.0 - SLOWING_TOLERANCE:
            raise DriveError(
                f"{name}: never comes to a standstill: after a period it has {left:.6g} times the kinetic energy of "
                "before; give a time as until"
            )
        return
    places = angle + way * np.linspace(0.0, driven.period, 721)
    state = machine.without_friction(np.mod(places, driven.period))
    between = 0.5 * (state.torque[1:] + state.torque[:-1]) * np.diff(places)
    taken = np.cumsum(between)
    motion = 0.5 * (driven.flywheel + float(state.inertia[0])) * speed * speed
    if taken[-1] <= ENERGY_TOLERANCE * np.abs(between).sum() and taken.max() < (1.0 - ENERGY_TOLERANCE) * motion:
        raise DriveError(
            f"{name}: never comes to a standstill: of {motion:.6g} J kinetic energy the loads take "
            f"{max(taken.max(), 0.0):.6g} J at most, and return all of it in a turn. Give a time as until, "
            "or a load that resists"
        )


def _start_error(driven, angle, what):
    """Error of a machine that does not start, with remedies."""
    rest = float(driven.motor_torque(0.0)) * driven.direction
    places = np.linspace(0.0, driven.period, 720, endpoint=False)
    asked = driven.at_acceleration(places, 0.0 * places, 0.0).torque * driven.direction
    spare, friction = driven.torque_at_rest(angle)
    here, friction = rest - spare * driven.direction, friction * driven.direction
    rubbing = f", {friction:.6g} N m of them to overcome friction" if friction else ""
    missing, most = here - rest, int(np.argmax(asked))
    remedies = [f"a motor with {asked[most] / rest:.3g} times the torque at rest" if rest > 0.0 else "another motor"]
    step = int(driven.direction)
    energy = np.cumsum((asked - rest)[::step])  # missing energy, in the order of motion
    if energy[-1] < 0.0:  # after its peak the motor always gives more than the loads take
        easy = float(places[::step][(int(np.argmax(energy)) + 1) % places.size])
        remedies.append(f"another crank angle, {math.degrees(easy):.6g} deg, from which that torque completes the turn")
    remedies.append("a clutch that lets the motor and its flywheel run up before")
    return DriveError(
        f"{driven.scene.mechanism.name}: {what}: at crank angle {math.degrees(angle):.6g} deg the loads take "
        f"{here:.6g} N m at rest{rubbing}, the motor gives {rest:.6g} N m, {missing:.6g} N m are missing. Over the "
        f"turn the loads take up to {asked[most]:.6g} N m (at {math.degrees(places[most]):.6g} deg). What helps: "
        f"{', '.join(remedies)}",
        missing,
        angle,
    )


def _trajectory(driven, scene, angle, speed, until, target=None, one_way=False):
    """`Trajectory` from an angle and speed until a time, a standstill, or a target speed."""
    fastest = max(abs(speed if target is None else target), 1e-3)
    end = until if isinstance(until, float) else MAX_TURNS * TURN / fastest
    sense = driven.direction if one_way else None
    found = integrate_motion(driven, angle, speed, end, target, until == "standstill" or one_way, sense)
    time, rows = found.time, found.rows
    if found.end == "lost":
        angle, speed = rows[:2, -1]
        driven.scene.solve(np.array([angle + speed * 1e-6]))
        raise DriveError(
            f"{scene.mechanism.name}: the motion cannot be computed beyond {time[-1]:.6g} s, at crank angle "
            f"{math.degrees(angle):.6g} deg and {speed:.6g} rad/s: the mechanism may be in a limit position "
            "there, or have no inertia",
            crank_angle=float(angle),
        )
    if found.end == "end" and not isinstance(until, float):
        what = "standstill" if target is None else f"{target:.6g} rad/s"
        raise DriveError(f"{scene.mechanism.name}: does not come to {what} within {end:.6g} s; give a time as until")
    if driven.motor is not None:
        require_within_motor_table(driven, rows[1])
    stopped = "reversal" if one_way else "standstill"
    last = stopped if found.end in ("standstill", "stuck") else "end"
    turns = (Event("reversal", *turn) for turn in found.reversals)
    events = Event("start", 0.0, angle), *turns, Event(last, float(time[-1]), float(rows[0, -1]))
    times, angles, speeds, rates = map(read_only, (time, *rows[:2], accelerations(driven, *rows[[0, 1, 3]])))
    return Trajectory(
        scene, driven.motor, driven.flywheel, times, angles, speeds, rates, events, driven, found.path, times
    )

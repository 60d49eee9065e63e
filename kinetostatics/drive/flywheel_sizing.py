"""Flywheels for a coefficient of fluctuation: by the textbook rule without motor, exact with one."""

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..cycle.load_functions import resolution_note
from ..numbers import checks
from ..numbers.formatting import with_units
from .one_dof import DrivenMachine
from .resolution import resolve_and_hint
from .running import Running, find_flywheel, parse_fluctuation
from .steady_running import steady


@with_units(inertia="kg m2", energy="J")
@dataclass(frozen=True, eq=False)
class Flywheel:
    """Size of a flywheel on the crank; `flywheel` returns it.

    Attributes
    ----------
    inertia : float
        Moment of inertia on the crank besides links and motor, kg m2; 0 if it needs no flywheel.
    energy : float
        Fluctuation of energy over the turn, J. Without motor: between the extremes of the turning-moment diagram. With
        a motor: of the flywheel itself.
    fluctuation : float
        Resulting coefficient of fluctuation.
    running : Running or None
        Periodic running with the flywheel; None without motor.
    note : str
        Resolution of load functions without `kinks`; empty if there are none.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> found = ks.drive.flywheel(pump, 0.01)
    >>> print(f"{found.inertia:.4f} kg m2 for {found.energy:.2f} J")
    0.2599 kg m2 for 25.99 J
    """

    inertia: float
    energy: float
    fluctuation: float
    running: Running | None = field(default=None, repr=False)
    note: str = field(default="", repr=False)


def flywheel(scene, fluctuation, motor=None, *, engine=None) -> Flywheel:
    """Flywheel for a coefficient of fluctuation of the crank speed.

    Without motor it follows the textbooks (Khurmi and Gupta, *Theory of Machines*, chapter 16; Uicker, Pennock and
    Shigley, *Theory of Machines and Mechanisms*, on flywheels). The torque is that at constant speed, and the motor
    gives its mean. The energy E between the extremes of the excess energy gives J = E / (fluctuation * speed^2), with
    the fluctuation over the mean of largest and smallest speed. With a motor the result is exact: periodic running
    (`steady`) has the wanted `fluctuation`, over the mean speed in time.

    Parameters
    ----------
    scene : Scene
        Mechanism and loads; without motor also the crank speed.
    fluctuation : float
        (largest - smallest) / mean speed, between 0 and 2.
    motor : Motor, optional
    engine : "numpy" or "compiled"
        As for `solve`.

    Returns
    -------
    Flywheel

    Raises
    ------
    DriveError
        The machine does not run under its motor with any flywheel.
    ParameterError
        A value is out of range.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> print(f"{ks.drive.flywheel(pump, 0.01).inertia:.6f} kg m2")
    0.259863 kg m2
    """
    wanted = parse_fluctuation("flywheel", fluctuation)
    if motor is not None:
        driven = DrivenMachine("flywheel", scene, motor, 0.0, engine)
        unit = float(driven.inertia(np.linspace(0.0, driven.period, 64)).max()) or 1.0
        inertia, running = find_flywheel(wanted, partial(steady, scene, motor, engine=engine), unit)
        low, high = running.speed_range
        return Flywheel(
            inertia, 0.5 * inertia * (high - low) * (high + low), running.fluctuation, running, resolution_note(scene)
        )
    speed = getattr(scene, "crank_speed", 1.0)
    speed, wrong = checks.single_number("crank_speed of the scene", speed, "rad/s", unequal=0.0)
    checks.require("flywheel", wrong)
    driven = DrivenMachine("flywheel", scene, None, 0.0, engine, math.copysign(1.0, speed))
    pieces, _ = resolve_and_hint(driven, speed)
    speeds = np.full(pieces.angle.shape, speed)
    state = driven.at_acceleration(pieces.angle, speeds if driven.by_speed else None, 0.0)
    spare = pieces.whole_integral(state.torque) / driven.period - state.torque
    gained = pieces.integral_from_start(spare) - 0.5 * speed * speed * state.inertia
    energy = pieces.largest(gained)[0] + pieces.largest(-gained)[0]
    return Flywheel(energy / (wanted * speed * speed), energy, wanted, note=resolution_note(scene))

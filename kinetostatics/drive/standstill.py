"""Whether a machine that coasts comes to a standstill at all."""

import math

import numpy as np

from ..errors import DriveError
from .periodic import steady

ROUGH = 1e-8
"""Relative difference of energies after a turn by which it is judged whether a machine slows down at all."""
SMALL = 1e-9
"""Share of the energy that goes to and fro in a turn that counts as nothing."""


def require_a_standstill(driven, angle, speed):
    """Refuse to wait for the standstill of a machine whose motor, or loads, give back in a turn all that they take."""
    way = math.copysign(1.0, speed)
    if driven.motor is not None or driven.by_speed:  # friction and dampers take energy
        _require_slowing(driven, angle, speed, way)
        return
    places = angle + way * np.linspace(0.0, driven.period, 721)
    state = driven.unrubbed(np.mod(places, driven.period), sense=way)
    between = 0.5 * (state.torque[1:] + state.torque[:-1]) * np.diff(places)
    taken = np.cumsum(between)
    motion = 0.5 * (driven.flywheel + float(state.inertia[0])) * speed * speed
    if taken[-1] <= SMALL * np.abs(between).sum() and taken.max() < (1.0 - SMALL) * motion:
        raise DriveError(
            f"{driven.scene.mechanism.name}: never comes to a standstill: of {motion:.6g} J of motion the loads take "
            f"{max(taken.max(), 0.0):.6g} J at most, and give back all that they take in a turn; give a time as until, "
            "or a load that resists"
        )


def _require_slowing(driven, angle, speed, way):
    """The same where all that acts is not known beforehand.

    Motions of one degree of freedom do not cross: none falls below periodic running under the motor, and what is not
    slower after a period never is.
    """
    why, forward = None, driven.motor is not None and way == driven.direction
    if forward and abs(speed) >= _kept_speed(driven, angle):
        why = "its motor keeps it running"
    elif (left := _energy_after_a_period(driven, angle, speed, way)) >= 1.0 - ROUGH:
        why = f"after a period it has {left:.6g} times the kinetic energy of before"
    if why is not None:
        raise DriveError(f"{driven.scene.mechanism.name}: never comes to a standstill: {why}; give a time as until")


def _kept_speed(driven, angle):
    """Speed at a crank angle in periodic running under the motor, rad/s, without sign; infinite where there is none."""
    try:
        running = steady(driven.scene, driven.motor, driven.flywheel - driven.motor.inertia_at_crank)
    except DriveError:
        return math.inf
    return abs(float(running.motion(np.array([angle]))[0][0]))


def _energy_after_a_period(driven, angle, speed, way):
    """Kinetic energy a period on, over that at the start; 0 where the machine does not come so far."""
    from scipy.integrate import solve_ivp

    start = 0.5 * driven.inertia_here(angle) * speed * speed

    def net(place, energy):
        place = float(place)
        size = math.sqrt(2.0 * max(float(energy[0]), 0.0) * start / driven.inertia_here(place))
        return driven.here(place, way * size, way)[2] / start

    def still(place, energy):
        return energy[0] - ROUGH

    vars(still)["terminal"] = True
    ends = angle, angle + way * driven.period
    found = solve_ivp(net, ends, [1.0], "LSODA", rtol=0.1 * ROUGH, atol=0.1 * ROUGH, events=still)
    return float(found.y[0, -1]) if found.status == 0 else 0.0

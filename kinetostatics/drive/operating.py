"""The operating speed: where the mean torques of motor and loads agree, before running is known."""

import math

import numpy as np

from ..errors import DriveError
from ..machine.loads import TURN

SAMPLED = 96
"""Crank angles by which mean load torques are judged."""
SEEN = 512
"""Speeds at which the mean torques of motor and loads are compared."""
FEW = 16
"""Speeds at which mean torques of friction are computed at first, those between guessed from these."""


def operating_speed(driven):
    """Crank speed at which the mean torques of motor and loads agree and the motor yields to more load, rad/s."""
    motor, name = driven.motor, driven.scene.mechanism.name
    if math.isfinite(motor.top):
        speed = motor.top * np.linspace(0.0, 1.0, SEEN)
    elif driven.by_speed:
        speed = np.concatenate([[0.0], np.geomspace(1e-4, 1e6, SEEN)]) * abs(motor.transmission)
    else:
        mean = float(_mean_load(driven, np.ones(1))[0])
        raise DriveError(
            f"{name}: nothing holds the speed, as neither the motor's torque nor the loads depend on it; a turn leaves "
            f"{TURN * (motor.torque_at_crank(0.0) - mean):.6g} J over; give a motor whose torque falls with speed"
        )
    load = _guessed_load if driven.smooth_by_speed else _mean_load
    load, spare, ends = _left_over(driven, speed, load)
    if driven.smooth_by_speed and (ends is None or not _parts(_left_over(driven, np.array(ends))[1])):
        load, spare, ends = _left_over(driven, speed)
    if ends is not None:
        from scipy.optimize import brentq

        def spare_at(own):
            if not driven.by_speed:
                return motor.torque(own) - load[0]
            return float(_left_over(driven, np.array([own]))[1][0])

        return float(brentq(spare_at, *ends, xtol=1e-9 * ends[1], rtol=1e-9)) / motor.transmission
    if spare[-1] > 0.0:
        raise DriveError(
            f"{name}: the machine runs away: at {speed[-1]:.6g} rad/s, the highest speed of the motor that is looked "
            f"at, {spare[-1]:.6g} N m are left over at its shaft; give more load, a motor that brakes beyond its speed"
            f"{', more rows to its table' * math.isfinite(motor.limits[1])}, or another transmission"
        )
    best = int(np.argmax(spare))
    missing = float(-spare[best] * abs(motor.transmission))
    raise DriveError(
        f"{name}: the motor is too weak, so there is no periodic running: the loads take {load[best]:.6g} N m at its "
        f"shaft in the mean, where it gives {motor.torque(speed[best]):.6g} N m at most (at {speed[best]:.6g} rad/s); "
        f"{-spare[best]:.6g} N m are missing, {missing:.6g} N m at the crank; give a motor "
        f"{_times(load, motor.torque(speed))}or another transmission",
        missing,
    )


def _left_over(driven, speed, load_at=None):
    """Mean load torque at speeds of the motor's shaft, the motor's less it, and the highest two that part the signs."""
    motor = driven.motor
    load = (load_at or _mean_load)(driven, speed / motor.transmission) / motor.transmission
    spare = motor.torque(speed) - load
    crossing = np.flatnonzero((spare[:-1] > 0.0) & (spare[1:] <= 0.0))
    return load, spare, (speed[crossing[-1]], speed[crossing[-1] + 1]) if crossing.size else None


def _parts(spare):
    return spare[0] > 0.0 >= spare[1]


def _times(load, torque):
    """How many times as strong a motor must be to carry the loads at some speed, as words."""
    drives = torque > 0.0
    if not drives.any():
        return "that drives "
    return f"{math.ceil(1e3 * np.min(load[drives] / torque[drives])) / 1e3:.6g} times as strong "


def require_known(driven, speed):
    """Refuse crank speeds at which a table of the motor tells nothing."""
    own = driven.motor.transmission * speed
    low, high = driven.motor.limits
    if own.min() < low or own.max() > high:
        raise DriveError(
            f"{driven.scene.mechanism.name}: the motor runs at {own.min():.6g} to {own.max():.6g} rad/s, but its table "
            f"knows {low:.6g} to {high:.6g} rad/s only; give more rows"
        )


def _mean_load(driven, speed):
    """Mean load torque over the period at constant crank speeds, N m."""
    angle = (np.arange(SAMPLED) + 0.5) * driven.period / SAMPLED
    if not driven.by_speed:
        return driven.at(angle).torque.mean() + 0.0 * speed
    grid = np.broadcast_arrays(angle[None, :], speed[:, None])
    return driven.at_constant_speed(*grid).torque.mean(axis=1)


def _guessed_load(driven, speed):
    """The same where friction makes it smooth: from a few of the speeds, as nearly a line over their squares."""
    few = np.linspace(0, speed.size - 1, FEW).astype(int)
    return np.interp(speed**2, speed[few] ** 2, _mean_load(driven, speed[few]))

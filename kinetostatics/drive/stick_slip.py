"""Motion over time with friction, stretch by stretch: within each, crank and joints keep their senses of motion.

A stretch ends where a joint with friction reverses, where a contact force of such a joint changes its sign, or where
the crank stops. After a stop the machine continues, turns back, or sticks: it stays at rest if the net torque moves it
in neither sense. `require_standstill` refuses machines that never stop.
"""

import itertools
import math
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from ..errors import DriveError
from .steady_running import integrate_energy, steady

RELATIVE_TOLERANCE = 3e-14
"""Relative tolerance of a step, the smallest that DOP853 accepts."""
ABSOLUTE_TOLERANCE = 1e-15
ANGLE_AHEAD = 1e-6
"""Crank angle, rad, after the start of a stretch that gives the sign of a force that is 0 at the start."""
MAX_STRETCHES = 20_000
"""Stretches after which a motion ends."""
MAX_EVALUATIONS = 1_000_000
"""Evaluations of the acceleration before a motion is refused: some thousand turns."""


class Stretch(NamedTuple):
    """A part of a motion: start and end time, offset of its crank angles, direction, dense output."""

    start: float
    end: float
    shift: float
    direction: float
    dense: Any


class MotionPath:
    """Motion over all stretches: rows of crank angle, speed, work of all torques, friction work, and sense.

    At standstill the sense is that of the motion before it.
    """

    def __init__(self, stretches):
        self._stretches = stretches
        self._starts = np.array([stretch.start for stretch in stretches])

    def __call__(self, time):
        time = np.asarray(time, dtype=float)
        before, place = (
            np.clip(np.searchsorted(self._starts, time.ravel(), side=side) - 1, 0, None) for side in ("left", "right")
        )
        found = np.empty((5, place.size))
        found[4] = np.array([stretch.direction for stretch in self._stretches])[before]
        for number in np.unique(place):
            stretch, own = self._stretches[number], place == number
            rows = stretch.dense(np.clip(time.ravel()[own], stretch.start, stretch.end) - stretch.start)
            rows[0] += stretch.shift
            rows[1] = np.copysign(np.maximum(stretch.direction * rows[1], 0.0), stretch.direction)
            found[:4, own] = rows
        return found.reshape(5, *time.shape)


class Motion(NamedTuple):
    """A motion: times, rows of `MotionPath` at these, the path, reversals (time, angle), its end, stretch starts.

    `end` is "end", "ready" (target speed), "standstill", "stuck", or "lost" where the integration failed.
    """

    time: np.ndarray
    rows: np.ndarray
    path: Any
    reversals: list
    end: str
    starts: list


def sense_from_rest(driven, angle):
    """Sense in which a machine starts from rest, +1 or -1; 0 if it stays at rest."""
    forward, backward = driven.torque_at_rest(angle, 1.0)[0], driven.torque_at_rest(angle, -1.0)[0]
    if forward > 0.0 > backward:
        raise DriveError(
            f"{driven.scene.mechanism.name}: at rest at crank angle {math.degrees(angle):.6g} deg it may start either "
            f"way: {forward:.6g} N m drive it on once it turns counter-clockwise, {backward:.6g} N m once it turns "
            "clockwise; give from_speed, as small as you like, the sense that is meant",
            crank_angle=angle,
        )
    return 1.0 if forward > 0.0 else -1.0 if backward < 0.0 else 0.0


def integrate_motion(driven, angle, speed, end, target=None, to_standstill=False, sense=None, dense=True) -> Motion:
    """Motion from a crank angle and speed until a time, a target speed, a standstill, or until it sticks.

    `sense` is the sense of a start from rest; without it the net torque decides. `path` needs a dense motion.
    """
    state, time, shift = np.array([angle, speed, 0.0, 0.0]), 0.0, 0.0
    direction = math.copysign(1.0, speed) if speed else sense or sense_from_rest(driven, angle)
    times, rows, reversals = [0.0], [np.append(state, direction or driven.direction)], []
    stretches: list[Stretch] = []
    what, crossed, evaluations = "stuck", None, itertools.count()

    def count(since, inside):
        if next(evaluations) > MAX_EVALUATIONS:
            raise DriveError(
                f"{driven.scene.mechanism.name}: the motion is too long to follow: {time + since:.6g} s, to crank "
                f"angle {math.degrees(inside + shift):.6g} deg, took {MAX_EVALUATIONS} evaluations; give an earlier "
                "time as until",
                crank_angle=inside + shift,
            )

    while direction and len(stretches) < MAX_STRETCHES:
        whole = math.floor(state[0] / driven.period) * driven.period
        shift, state[0] = shift + whole, state[0] - whole
        found, what, crossed = _integrate_stretch(driven, state, direction, end - time, target, crossed, count, dense)
        if what == "lost":
            break
        stretches.append(Stretch(time, time + found.t[-1], shift, direction, found.sol))
        inner = slice(1, -1 if what in ("edge", "kink") else None)
        times += (time + found.t[inner]).tolist()
        rows += [np.array([row[0] + shift, *row[1:], direction]) for row in found.y.T[inner]]
        time, state = time + found.t[-1], found.y[:, -1].copy()
        if what == "still":
            rows[-1][1] = state[1] = 0.0
            turned = sense_from_rest(driven, float(state[0]))
            what = "standstill" if to_standstill else "still" if turned else "stuck"
            direction = turned
            if what == "still":
                reversals.append((float(time), float(state[0] + shift)))
        if what in ("end", "ready", "standstill", "stuck"):
            break
    path = MotionPath(stretches) if stretches else lambda time: np.multiply.outer(rows[0], np.ones(np.shape(time)))
    ended = "lost" if what in ("edge", "kink", "still") else what
    starts = [stretch.start for stretch in stretches]
    return Motion(np.array(times), np.array(rows).T, path, reversals, ended, starts)


def _integrate_stretch(driven, state, direction, time, target, crossed, count, dense):
    """Motion of one stretch, what ended it, and the sign after its end of a force that crossed zero, by row."""
    from scipy.integrate import solve_ivp

    senses, edge = driven.senses_ahead(float(state[0]), direction)

    def change(time, state):
        angle, speed = float(state[0]), float(state[1])
        count(time, angle)
        inertia, slope, spare, friction = driven.balance_along(angle, speed, senses)
        return speed, (spare - 0.5 * speed * speed * slope) / inertia, spare * speed, friction * speed

    @lru_cache(maxsize=1)
    def pressed(angle, speed):
        driven.balance_along(angle, speed, senses)
        return driven.last_forces

    def contact_force(row, side):  # the sign after the start, so that no zero counts twice
        return lambda time, state: pressed(float(state[0]), float(state[1]))[row] if time > 0.0 else side

    events = [
        _event(lambda time, state: direction * state[1], -1),
        _event(lambda time, state: direction * (state[0] - edge), 1),
        _event(lambda time, state: 1.0 if target is None else direction * (state[1] - target), 0),
    ]
    names = ["still", "edge", "ready"]
    here, ahead = (pressed(float(state[0]) + way, float(state[1])) for way in (0.0, ANGLE_AHEAD * direction))
    for row, pair in enumerate(zip(here, ahead, strict=True)):
        side = (crossed or {}).get(row) or next((math.copysign(1.0, one) for one in pair if one), 1.0)
        events.append(_event(contact_force(row, side), 0))
        names.append("kink")
    options = {"rtol": RELATIVE_TOLERANCE, "atol": ABSOLUTE_TOLERANCE, "method": "DOP853"}
    found = solve_ivp(change, (0.0, time), state, dense_output=dense, events=events, **options)
    if found.status < 0 or not np.isfinite(found.y).all():
        return found, "lost", None
    if found.status == 0:
        return found, "end", None
    which = next(number for number, times in enumerate(found.t_events) if times.size)
    if found.t.size > 1:  # integrate the last step to the event; dense output is less accurate
        again = solve_ivp(change, (found.t[-2], found.t[-1]), found.y[:, -2], **options)
        found.y[:, -1] = again.y[:, -1]
    if names[which] == "edge":
        found.y[0, -1] = edge
    if names[which] != "kink":
        return found, names[which], None
    before = events[which](found.t[-2], found.y[:, -2])
    return found, "kink", {which - 3: math.copysign(1.0, -before)}


def _event(function, direction):
    """Terminal event of `solve_ivp`."""
    vars(function).update(terminal=True, direction=direction)
    return function


SLOWING_TOLERANCE = 1e-8
"""Relative loss of kinetic energy in a period below which a machine does not slow down."""
ENERGY_TOLERANCE = 1e-9
"""Energy relative to the energy exchanged in a turn that counts as 0."""


def require_standstill(driven, angle, speed):
    """Refuse a machine that never stops: its motor or loads return in a turn all the energy that they take.

    Motions of one degree of freedom do not cross: none falls below periodic running under the motor, and a machine
    that is not slower after a period never becomes slower.
    """
    way, name = math.copysign(1.0, speed), driven.scene.mechanism.name
    if driven.motor is not None or driven.by_speed:  # friction and dampers take energy
        steady_speed = math.inf
        if driven.motor is not None and way == driven.direction:
            try:
                running = steady(driven.scene, driven.motor, driven.flywheel - driven.motor.inertia_at_crank)
                steady_speed = abs(float(running.motion(np.array([angle]))[0][0]))
            except DriveError:  # no running that keeps it from stopping
                pass
        if abs(speed) >= steady_speed:
            raise DriveError(f"{name}: never comes to a standstill: its motor keeps it running; give a time as until")
        start = 0.5 * driven.inertia_at(angle) * speed * speed
        found = integrate_energy(driven, angle, way, start, start, 0.1 * SLOWING_TOLERANCE)
        left = found.y[0, -1] / start if found.status == 0 else 0.0
        if left >= 1.0 - SLOWING_TOLERANCE:
            raise DriveError(
                f"{name}: never comes to a standstill: after a period it has {left:.6g} times the kinetic energy of "
                "before; give a time as until"
            )
        return
    places = angle + way * np.linspace(0.0, driven.period, 721)
    state = driven.without_friction(np.mod(places, driven.period), sense=way)
    between = 0.5 * (state.torque[1:] + state.torque[:-1]) * np.diff(places)
    taken = np.cumsum(between)
    motion = 0.5 * (driven.flywheel + float(state.inertia[0])) * speed * speed
    if taken[-1] <= ENERGY_TOLERANCE * np.abs(between).sum() and taken.max() < (1.0 - ENERGY_TOLERANCE) * motion:
        raise DriveError(
            f"{name}: never comes to a standstill: of {motion:.6g} J of motion the loads take "
            f"{max(taken.max(), 0.0):.6g} J at most, and give back all that they take in a turn; give a time as until, "
            "or a load that resists"
        )

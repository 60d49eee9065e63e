"""Motion of a machine over time, the result of `start` and `coast`."""

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..cycle.load_functions import resolution_note
from ..machine.loads import TURN
from ..mechanics.jamming import checks_of, solve_friction
from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.brackets import find_roots
from ..numbers.formatting import with_units
from ..numbers.lazy import cached_property, pyplot
from ..numbers.output_units import output_units
from ..numbers.parameter_tree import replace_unchecked
from ..solution.scene import Scene
from .motor import Motor
from .one_dof import DrivenMachine, load_kinks

TIME_RULE = checks.Number("s", table=True)
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
"""Gauss points and weights of the work in a step of the integration."""
KINK_TOLERANCE = 1e-9
"""Largest distance, rad, of a kink at the end of a step."""


@with_units(time="s", crank_angle="rad")
class Event(NamedTuple):
    """Event at a time and crank angle of a motion over time.

    A `Trajectory` lists them in ``.events``.

    Attributes
    ----------
    name : str
        "start", "reversal", "standstill" or "end".
    time : float
        s.
    crank_angle : float
        rad.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pendulum = ks.Scene(ks.crank_slider(0.3, 1.0, crank=ks.Link(2.0, 0.15)), 1.0, loads=ks.Gravity())
    >>> start, swung, *_ = ks.drive.coast(pendulum, 0.06, from_angle=-1.0, until=2.0).events
    >>> swung.name, round(swung.time, 4)
    ('reversal', 0.6057)
    """

    name: str
    time: float
    crank_angle: float


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Motion of a machine over time; `start` and `coast` return it.

    Attributes
    ----------
    scene : Scene
    motor : Motor or None
    flywheel : float
        Inertia on the crank without the links, kg m2.
    time, crank_angle, speed, acceleration : array (N,)
        s, rad (not taken modulo a turn), rad/s, rad/s2: the steps of the integration, or the times given to `at`.
    events : tuple of Event
        In order of time.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> motion = ks.drive.start(pump, motor, 0.05, from_angle=0.3)
    >>> [event.name for event in motion.events], motion.crank_angle.shape == motion.time.shape
    (['start', 'end'], True)
    >>> print(f"{motion.at([0.1]).speed[0]:.2f} rad/s after 0.1 s")
    34.35 rad/s after 0.1 s
    """

    scene: Scene
    motor: Motor | None
    flywheel: float
    time: np.ndarray
    crank_angle: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    events: tuple[Event, ...]
    _driven: DrivenMachine = field(repr=False)
    _dense: Any = field(repr=False)
    _ends: np.ndarray = field(repr=False)

    def __repr__(self):
        last, note = self.events[-1], resolution_note(self.scene)
        turns = (self.crank_angle[-1] - self.crank_angle[0]) / TURN
        return (
            f"<Trajectory: {self.scene.mechanism.name}, {self.time[-1]:.9g} s, {turns:.6g} turns, {last.name} at "
            f"{math.degrees(last.crank_angle):.6g} deg with {self.speed[-1]:.9g} rad/s, "
            f"energy drift {self.energy_drift:.2g} J{note and '; '}{note}>"
        )

    def at(self, time):
        """The same motion at other times, s: an array, or a number of even times."""
        if isinstance(time, int | np.integer) and not isinstance(time, bool):
            checks.require("at", checks.count("time", time, size=checks.BYTES_PER_ANGLE))
            time = np.linspace(self.time[0], self.time[-1], time)
        time = checks.check_values("at", {"time": TIME_RULE}, {"time": time})["time"]
        time = np.atleast_1d(np.array(time, dtype=float))
        low, high = self.time[0], self.time[-1]
        if time.min() < low or time.max() > high:
            checks.require(
                "at", f"time must lie between {low:.9g} and {high:.9g} s, got {time.min():.9g} to {time.max():.9g}"
            )
        angle, speed, _, sense = self._dense(time)
        found = map(read_only, (time, angle, speed, accelerations(self._driven, angle, speed, sense)))
        return replace_unchecked(
            self, **dict(zip(("time", "crank_angle", "speed", "acceleration"), found, strict=True))
        )

    @cached_property
    def solution(self):
        """`Solution` along the motion: reactions and torques at its times; at standstill, those just before."""
        return self._moving.solve(self.crank_angle)

    @property
    def _moving(self):
        """The scene at the speeds, accelerations and senses of the motion."""
        sense = np.where(self.speed == 0.0, self._dense(self.time)[3], np.sign(self.speed))
        return replace_unchecked(self.scene, crank_speed=self.speed, crank_acceleration=self.acceleration, sense=sense)

    @property
    def _unchecked(self):
        """Solution without the check of its condition, which takes longer than all its torques."""
        found = self._moving.unsolved(self.crank_angle)
        return solve_friction(found, checks_of) if self.scene.friction.acting else found

    @cached_property
    def energy_drift(self):
        """Largest difference of kinetic energy and work done since the start, J: the error of the integration.

        The work is the integral of the torques of `solve` along the motion, by Gauss' rule in each step; steps end at
        the kinks of the loads.
        """
        ends = self._ends
        if ends.size < 2:
            return 0.0
        ends = np.union1d(ends, self._kink_times)
        half, at_ends = 0.5 * np.diff(ends), self.at(ends)
        energy = at_ends._unchecked.kinetic_energy + 0.5 * self.flywheel * at_ends.speed**2
        inside = self.at(np.ravel(0.5 * (ends[:-1] + ends[1:])[:, None] + half[:, None] * NODES))
        drive, asked = 0.0 if self.motor is None else self.motor.torque_at_crank(inside.speed), inside._unchecked
        power = (drive - asked.load_torque - asked.friction_torque) * inside.speed
        work = np.cumsum(half * (power.reshape(half.size, NODES.size) @ WEIGHTS))
        return float(np.abs(energy[1:] - energy[0] - work).max())

    @property
    def _kink_times(self):
        """Times inside steps at which loads have kinks; empty if the motion was integrated between them."""
        (kinks, _), angle, period = load_kinks(self.scene), self._dense(self._ends)[0], self.scene.period
        low, high = np.minimum(angle[:-1], angle[1:]), np.maximum(angle[:-1], angle[1:])
        turns = np.arange(np.floor(low.min() / period), np.floor(high.max() / period) + 1.0)
        kinks = (kinks + period * turns[:, None]).ravel()
        first, last = np.searchsorted(kinks, low + KINK_TOLERANCE), np.searchsorted(kinks, high - KINK_TOLERANCE)
        step = np.repeat(np.arange(low.size), np.maximum(last - first, 0))
        passed = kinks[first[step] + np.arange(step.size) - np.searchsorted(step, step)]
        return find_roots(
            lambda time, some: self._dense(time)[0] - passed[some], self._ends[step], self._ends[step + 1]
        )

    @property
    def friction_energy(self):
        """Energy lost by friction since the start, J."""
        return read_only(self._dense(self.time)[2])

    @property
    def motor_torque(self):
        """Torque of the motor at its shaft, N m; zeros without one."""
        return 0.0 * self.speed if self.motor is None else self.motor.torque(self.motor.transmission * self.speed)

    @property
    def kinetic_energy(self):
        """Kinetic energy of links and flywheel, J."""
        return self.solution.kinetic_energy + 0.5 * self.flywheel * self.speed**2

    def frame(self, units=None):
        """Table with a row for each time, a pandas DataFrame: motion, energies, torques of motor and loads.

        `units` is a dict of dimension to unit as of `in_units`.
        """
        import pandas as pd

        table = pd.DataFrame(
            {
                "time [s]": self.time,
                "crank_angle [deg]": np.degrees(self.crank_angle),
                "crank_speed [rad/s]": self.speed,
                "crank_acceleration [rad/s2]": self.acceleration,
                "motor_torque [N m]": self.motor_torque,
                "balancing_torque [N m]": self.solution.balancing_torque,
                "load_torque [N m]": self.solution.load_torque,
                **({"friction_loss [W]": self.solution.friction_loss} if self.scene.friction.acting else {}),
                "kinetic_energy [J]": self.kinetic_energy,
                "potential_energy [J]": self.solution.potential_energy,
            }
        )
        return output_units(units, "frame").table(table)

    def plot(self, ax=None):
        """Crank speed over time, reversals and standstill marked; returns the axes."""
        ax = ax if ax is not None else pyplot().subplots()[1]
        smooth = self.at(max(400, self.time.size)) if self.time.size > 1 else self
        ax.plot(smooth.time, smooth.speed)
        stops = [event.time for event in self.events if event.name in ("reversal", "standstill")]
        ax.plot(stops, np.zeros(len(stops)), "o", ms=4)
        ax.set(xlabel="time [s]", ylabel="crank speed [rad/s]", title=self.scene.mechanism.name)
        ax.grid(alpha=0.3)
        return ax


def accelerations(driven, angle, speed, sense):
    """Crank accelerations at angles, speeds and senses of a motion that may reverse, rad/s2."""
    found = np.empty(angle.shape)
    for way in np.unique(sense):
        own = sense == way
        found[own] = driven.along(way).acceleration(angle[own], speed[own])
    return found

"""A machine in periodic running: speed, powers, energies, and its solution at the true speed and acceleration.

With the energy U = (Jf + J) omega^2 / 2 at Chebyshev points of the period, the speed is omega = sqrt(2 U / (Jf + J)).
Means over time are integrals over the crank angle with the weight 1 / omega. Angles and torques are positive
counter-clockwise; energies and powers of motor and friction are positive where the machine receives or loses them.

`find_flywheel` varies the flywheel until the running has a given coefficient of fluctuation.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar

import numpy as np

from ..cycle.load_functions import resolution_note
from ..cycle.piecewise import Pieces
from ..errors import DriveError, QuantityError
from ..machine.loads import TURN
from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.lazy import cached_property, pyplot
from ..numbers.output_units import output_units
from ..numbers.parameter_tree import replace_unchecked
from ..solution.parameters import crank_angles
from ..solution.scene import Scene
from ..solution.solution import Solution
from .energy_flow import energy_flow, zero_if_rounding
from .motor import Motor
from .one_dof import DrivenMachine
from .savings import DrivenComparison


@dataclass(frozen=True, eq=False)
class RunningSolution(Solution):
    """A `Solution` at the crank speed and acceleration of periodic running.

    `running` returns both at any crank angle, so extremes, means and tables are exact between the given angles.
    """

    running: Any = None

    COMPARISON: ClassVar = DrivenComparison

    def __repr__(self):
        return super().__repr__().replace("<Solution", "<RunningSolution").split(", crank_speed=")[0] + (
            f", mean speed {self.running.mean_speed:.9g} rad/s>"
        )

    def unsolved_at(self, crank_angle):
        """The same machine in the same running, with the passes over friction that it has."""
        return self.moved_to(crank_angles(crank_angle))

    def moved_to(self, angle):
        """As `unsolved_at` for an array of crank angles."""
        motion = self.running.motion(angle)
        speed, acceleration = (float(part[0]) if part.shape == (1,) else np.asarray(part) for part in motion)
        return replace(self, crank_angle=angle, crank_speed=speed, crank_acceleration=acceleration)

    @property
    def period(self):
        """Crank angle after which running repeats, rad."""
        return self.running.period


MAX_DOUBLINGS = 60
"""Doublings of the flywheel before the search ends."""
INERTIA_TOLERANCE = 1e-13
"""Relative error of the flywheel."""
OWN_QUANTITIES = {
    "time": "time",
    "crank_speed": "speed",
    "crank_acceleration": "acceleration",
    "motor_torque": "motor_torque",
    "motor_speed": "motor_speed",
    "motor_power": "motor_power",
    "kinetic_energy": "kinetic_energy",
}
"""Attributes of a `Running` over the crank angle, by the name for ``run[name]``; the energy with the flywheel's."""
MIN_FLYWHEEL_RATIO = 1e-3
"""Smallest flywheel of the search relative to the machine's own inertia, where lighter ones do not run."""


def parse_fluctuation(owner, fluctuation):
    """Coefficient of fluctuation as a float; refused outside 0 to 2."""
    wanted, wrong = checks.single_number("fluctuation", fluctuation, "1", low=0.0, strict=True)
    if not wrong and not wanted < 2.0:
        wrong = f"fluctuation must be less than 2, got {wanted:g}"
    checks.require(owner, wrong)
    return wanted


def find_flywheel(wanted, running_with, unit):
    """Flywheel in kg m2 for a coefficient of fluctuation (0 if unnecessary), and the running with it.

    `running_with` returns the `Running` with a flywheel in kg m2, or raises `DriveError` where there is none; `unit` is
    the machine's own inertia, kg m2.
    """
    from scipy.optimize import brentq

    runs: dict[float, Any] = {}

    def excess(inertia):
        """Logarithm of fluctuation / wanted; infinite where the machine does not run."""
        try:
            runs[inertia] = running_with(inertia)
        except DriveError:
            runs[inertia] = None
            return math.inf
        return math.log(max(runs[inertia].fluctuation, 1e-300) / wanted)

    if excess(0.0) <= 0.0:
        return 0.0, runs[0.0]
    size, low, high = unit, 0.0, None
    for _ in range(MAX_DOUBLINGS):
        if excess(size) <= 0.0:
            high = size
            break
        low, size = size, 2.0 * size
    if high is None:
        running_with(size)  # raises an error with the reason
        raise DriveError(f"flywheel: even {size:.3g} kg m2 do not bring the fluctuation to {wanted:g}")
    while not math.isfinite(excess(low)):  # too light to run at all
        if high < MIN_FLYWHEEL_RATIO * unit or high - low <= INERTIA_TOLERANCE * high:
            return high, runs[high]
        middle = 0.5 * (low + high)
        low, high = (low, middle) if excess(middle) <= 0.0 else (middle, high)
    inertia = float(brentq(excess, low, high, xtol=INERTIA_TOLERANCE * high, rtol=INERTIA_TOLERANCE))
    return inertia, runs.get(inertia) or running_with(inertia)


@dataclass(frozen=True, eq=False)
class Running:
    """A machine in periodic running; made by `steady`. ``run[name]`` gives any of its `quantities`.

    Attributes
    ----------
    scene : Scene
    motor : Motor or None
    flywheel : float
        All inertia on the crank besides the links, that of the motor's rotor with it, kg m2.
    crank_angle : array (..., N)
        rad.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> run = ks.drive.steady(pump, motor, flywheel=0.05)
    >>> print(f"{run.mean_power:.1f} W mean, {run.peak_power:.1f} W peak; {run.energy_per_turn:.4f} J a turn")
    325.8 W mean, 563.8 W peak; 20.0000 J a turn
    """

    scene: Scene
    motor: Motor | None
    flywheel: float
    crank_angle: np.ndarray
    _driven: DrivenMachine = field(repr=False)
    _pieces: Pieces = field(repr=False)
    _energy: np.ndarray = field(repr=False)
    _again: Callable[[float], "Running"] = field(repr=False)

    __iter__ = None  # not by number

    def __repr__(self):
        lines = [
            f"<Running: {self.scene.mechanism.name}, period {self.turns} turn{'s' * (self.turns > 1)}",
            f"mean speed      {self.mean_speed:.9g} rad/s",
            f"fluctuation     {self.fluctuation:.9g} ({self.speed_range[0]:.9g} to {self.speed_range[1]:.9g} rad/s)",
            f"energy a turn   {self.energy_per_turn:.9g} J",
            f"motor power     {self.mean_power:.9g} W mean, {self.rms_power:.9g} W rms, {self.peak_power:.9g} W peak",
            *filter(None, [resolution_note(self.scene)]),
        ]
        return "\n  ".join(lines) + ">"

    # the period

    @property
    def period(self):
        """Crank angle after which running repeats, rad."""
        return self._driven.period

    @property
    def turns(self):
        """Turns of the crank after which running repeats."""
        return round(self.period / TURN)

    @cached_property
    def duration(self):
        """Time of the period, s."""
        return abs(self._pieces.whole_integral(1.0 / self._speed))

    @cached_property
    def mean_speed(self):
        """Mean over time of the crank speed, rad/s: 2 pi turns by the time of the period."""
        return math.copysign(self.period / self.duration, self._driven.direction)

    @property
    def speed_range(self):
        """Smallest and largest speed of the crank, without sign, rad/s."""
        (low, _), (high, _) = self._slowest_and_fastest
        return -low, high

    @property
    def speed_range_angles(self):
        """Crank angles of the smallest and largest speed, rad."""
        return tuple(angle % self.period for _, angle in self._slowest_and_fastest)

    @property
    def fluctuation(self):
        """Coefficient of fluctuation: largest less smallest speed over the mean speed over time."""
        return float(np.subtract(*self.speed_range[::-1])) / abs(self.mean_speed)

    @property
    def fluctuation_arithmetic(self):
        """Coefficient of fluctuation of textbooks: over the mean of largest and smallest speed."""
        low, high = self.speed_range
        return 2.0 * (high - low) / (high + low)

    # over the crank angle

    @cached_property
    def speed(self):
        """Crank speed at the crank angles, (..., N), rad/s."""
        return read_only(self.motion(self.crank_angle)[0])

    @cached_property
    def acceleration(self):
        """Crank acceleration at the crank angles, (..., N), rad/s2."""
        return read_only(self.motion(self.crank_angle)[1])

    @cached_property
    def time(self):
        """Time since the crank passed angle 0, up to the duration of the period, (..., N), s.

        It falls along rising crank angles where the crank turns clockwise.
        """
        turned = np.mod(self.direction * self.crank_angle, self.period)
        series = self._pieces.series(self._pieces.integral_from_start(1.0 / np.abs(self._speed)))
        if self.direction > 0:
            return read_only(self._pieces.evaluate(series, turned))
        after = self.duration - self._pieces.evaluate(series, self.period - turned)
        return read_only(np.where(turned == 0.0, 0.0, after))

    @cached_property
    def motor_torque(self):
        """Torque of the motor at its shaft, without the inertia torque of its rotor, (..., N), N m."""
        return read_only(self._motor_torque(self.speed))

    @property
    def motor_speed(self):
        """Speed of the motor's shaft, (..., N), rad/s; of the crank without motor."""
        return self._transmission * self.speed

    @property
    def motor_power(self):
        """Power of the motor at its shaft, (..., N), W."""
        return self.motor_torque * self.motor_speed

    @property
    def crank_torque(self):
        """Balancing torque of the machine at the crank, (..., N), N m."""
        return self.solution.balancing_torque

    def motion(self, angle):
        """Speed and acceleration of the crank at any crank angles, rad/s and rad/s2."""
        driven, angle = self._driven, np.mod(angle, self.period)
        energy, inertia = self._pieces.evaluate(self._energy_series, angle), driven.inertia(angle)
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
        state = driven.at(angle, speed)
        turning = self._transmission * self._motor_torque(speed) - state.torque - 0.5 * speed * speed * state.slope
        return speed, turning / inertia

    @cached_property
    def solution(self):
        """`Solution` at the crank angles with the true speed and acceleration."""
        scene = replace_unchecked(self.scene, crank_speed=self.speed, crank_acceleration=self.acceleration)
        plain = scene.solve(self.crank_angle)
        return RunningSolution(**{field.name: getattr(plain, field.name) for field in fields(Solution)}, running=self)

    @property
    def crank_flywheel(self):
        """Flywheel on the crank without the motor's rotor, kg m2."""
        return self.flywheel - (0.0 if self.motor is None else self.motor.inertia_at_crank)

    def with_flywheel(self, inertia):
        """Running of the same machine under the same motor with another flywheel on the crank, kg m2.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
        >>> run = ks.drive.steady(pump, ks.drive.Motor.linear(20.0, 105.0), flywheel=0.05)
        >>> run.with_flywheel(0.5).fluctuation < run.fluctuation
        True
        """
        return self._again(inertia)

    def flywheel_for(self, fluctuation):
        """Flywheel on the crank with which the same machine has a coefficient of fluctuation, kg m2, or 0.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
        >>> run = ks.drive.steady(pump, ks.drive.Motor.linear(20.0, 105.0), flywheel=0.05)
        >>> print(f"{run.flywheel_for(0.02):.3f} kg m2")
        0.108 kg m2
        """
        wanted = parse_fluctuation("flywheel_for", fluctuation)
        unit = self.flywheel + self._state.inertia.max()
        return find_flywheel(wanted, self.with_flywheel, unit)[0]

    def plot(self, ax=None):
        """Crank speed over the crank angle, and on a second axis the torques of motor and machine at the crank.

        Returns both axes.
        """
        ax = ax if ax is not None else pyplot().subplots()[1]
        angle = np.linspace(0.0, self.period, 721)
        speed, acceleration = self.motion(angle)
        drive = self._transmission * self._motor_torque(speed)
        ax.plot(np.degrees(angle), speed, color="C0", label="crank speed")
        ax.axhline(self.mean_speed, color="C0", lw=0.8, ls=":", label="its mean")
        ax.set(xlabel="crank angle from +x, counter-clockwise [deg]", ylabel="crank speed [rad/s]")
        ax.set_title(self.scene.mechanism.name)
        torques = ax.twinx()
        torques.plot(np.degrees(angle), drive, color="C1", label="motor")
        torques.plot(np.degrees(angle), drive - self.flywheel * acceleration, color="C2", label="machine")
        torques.set_ylabel("torque at the crank [N m]")
        lines = [*ax.get_lines(), *torques.get_lines()]
        torques.legend(lines, [str(line.get_label()) for line in lines], frameon=False, fontsize="small")
        return ax, torques

    def frame(self, units=None):
        """Table with a row for each crank angle, a pandas DataFrame: time, motion, torques and power of the drive.

        `units` is a dict of dimension to unit as of `in_units`.
        """
        import pandas as pd

        columns = {
            "crank_angle [deg]": np.degrees(self.crank_angle),
            "time [s]": self.time,
            "crank_speed [rad/s]": self.speed,
            "crank_acceleration [rad/s2]": self.acceleration,
            "motor_torque [N m]": self.motor_torque,
            "motor_power [W]": self.motor_power,
            "balancing_torque [N m]": self.solution.balancing_torque,
            "load_torque [N m]": self.solution.load_torque,
            **({"friction_loss [W]": self.solution.friction_loss} if self.scene.friction.acting else {}),
            "kinetic_energy [J]": self.kinetic_energy,
        }
        table = pd.DataFrame({name: np.ravel(values) for name, values in columns.items()})
        return output_units(units, "frame").table(table)

    @property
    def quantities(self):
        """All names that ``run[name]`` takes, a tuple: those of the drive, then those of `solution`."""
        return tuple(dict.fromkeys((*OWN_QUANTITIES, *self.solution.quantities)))

    def __getitem__(self, name):
        """A quantity of the drive or of `solution` by name, over the crank angles, as ``s[name]`` of a `Solution`.

        Raises
        ------
        QuantityError
            The quantity is unknown; the message lists all and suggests the nearest.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
        >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
        >>> run = ks.drive.steady(pump, ks.drive.Motor.linear(20.0, 105.0), flywheel=0.05)
        >>> run["motor_torque"].shape == run["guide_force"].shape
        True
        """
        if isinstance(name, str) and name in OWN_QUANTITIES:
            return getattr(self, OWN_QUANTITIES[name])
        try:
            return self.solution[name]
        except QuantityError:
            allowed = self.quantities
        raise QuantityError(checks.choice(f"{self.scene.mechanism.name}: quantity", name, allowed))

    @property
    def kinetic_energy(self):
        """Kinetic energy of links and flywheel, (..., N), J."""
        return self.solution.kinetic_energy + 0.5 * self.flywheel * self.speed**2

    # energy and power

    @cached_property
    def energy_per_turn(self):
        """Energy of the motor at its shaft in a turn, J."""
        torque = self._transmission * self._motor_torque(self._speed)
        energy = self._pieces.whole_integral(self._driven.direction * torque)
        flowing = self._pieces.whole_integral(np.abs(torque) + np.abs(self._state.torque))
        return zero_if_rounding(energy, flowing) / self.turns

    @cached_property
    def energy_flow(self):
        """Where the energy of a turn goes: an `EnergyFlow`, with a table by `.frame()`."""
        return energy_flow(self)

    @cached_property
    def air_gap_energy_per_turn(self):
        """Energy through the air gap of an induction motor in a turn, J: torque times speed of the field."""
        if not self.has_air_gap:
            raise DriveError(
                "air_gap_energy_per_turn: only an induction motor, Motor.kloss, has an air gap that it knows"
            )
        power = self._motor_torque(self._speed) * (self.motor.field_speed if self.motor else 0.0)
        return self._pieces.whole_integral(power / np.abs(self._speed)) / self.turns

    @property
    def has_air_gap(self):
        """Whether the motor is an induction motor with known slip losses."""
        return self.motor is not None and self.motor.field_speed is not None

    @property
    def rotor_loss_per_turn(self):
        """Slip loss in the rotor of an induction motor in a turn, J."""
        return self.air_gap_energy_per_turn - self.energy_per_turn

    @property
    def mean_torque(self):
        """Mean over the crank angle of the motor's torque on the crank, N m; `energy_per_turn` by the angle of a turn.

        Positive counter-clockwise; equal to that of the balancing torque, for the flywheel returns what it takes.
        """
        return self.energy_per_turn * self.direction / TURN

    @property
    def mean_power(self):
        """Mean over time of the motor's power at its shaft, W."""
        return self.energy_per_turn * self.turns / self.duration

    @cached_property
    def rms_motor_torque(self):
        """Root mean square over time of the motor's torque at its shaft, N m; it determines the heating."""
        square = self._motor_torque(self._speed) ** 2
        return math.sqrt(self._pieces.whole_integral(square / np.abs(self._speed)) / self.duration)

    @cached_property
    def rms_power(self):
        """Root mean square over time of the motor's power, W."""
        return math.sqrt(self._pieces.whole_integral(self._powers**2 / np.abs(self._speed)) / self.duration)

    @cached_property
    def peak_power(self):
        """Largest power of the motor, with its sign, W."""
        return self._pieces.peak(self._powers)

    @cached_property
    def peak_motor_torque(self):
        """Largest torque of the motor at its shaft, with its sign, N m."""
        return self._pieces.peak(self._motor_torque(self._speed))

    @cached_property
    def load_energy_per_turn(self):
        """Energy that weight and loads take from the crank in a turn, without friction, J."""
        torque = self._driven.without_friction(self._pieces.angle, self._speed).torque
        return self._pieces.whole_integral(torque) * self._forward

    @property
    def friction_energy_per_turn(self):
        """Energy lost by friction at all joints in a turn, J."""
        return sum(self.friction_energy_per_turn_at(joint) for joint in self.scene.friction)

    def friction_energy_per_turn_at(self, joint):
        """Energy lost by friction in a turn at a joint, named as in `friction`, J; 0 without friction."""
        lost = self._at_points.friction_loss_at(joint).reshape(self._speed.shape)
        return self._pieces.whole_integral(lost / self._speed) * self._forward

    @property
    def mean_friction_loss(self):
        """Mean over time of the power lost by friction at all joints, W."""
        return self.friction_energy_per_turn * self.turns / self.duration

    def mean_friction_loss_at(self, joint):
        """Mean over time of the power lost by friction at a joint, W."""
        return self.friction_energy_per_turn_at(joint) * self.turns / self.duration

    # on the points of the pieces

    @property
    def on_pieces(self):
        """Pieces of the period; crank speed, acceleration and the links' inertia at their points."""
        return self._pieces, self._speed, self.motion(self._pieces.angle)[1], self._state.inertia

    @property
    def direction(self):
        """+1 if the crank turns counter-clockwise, else -1."""
        return self._driven.direction

    @property
    def _forward(self):
        """Direction of the crank over the turns of the period: turns an integral over a period into one of a turn."""
        return self._driven.direction / self.turns

    @cached_property
    def _at_points(self):
        speed, acceleration = (part.ravel() for part in self.motion(self._pieces.angle))
        moving = replace_unchecked(self.scene, crank_speed=speed, crank_acceleration=acceleration)
        return moving.solve(self._pieces.angle.ravel())

    @cached_property
    def _slowest_and_fastest(self):
        size = np.abs(self._speed)
        return self._pieces.largest(-size), self._pieces.largest(size)

    @cached_property
    def _state(self):
        return self._driven.at(self._pieces.angle, self._speed)

    @cached_property
    def _speed(self):
        return self.direction * np.sqrt(2.0 * self._energy / self._driven.inertia(self._pieces.angle))

    @cached_property
    def _energy_series(self):
        return self._pieces.series(self._energy)

    @property
    def _transmission(self):
        return 1.0 if self.motor is None else self.motor.transmission

    def _motor_torque(self, speed):
        if self.motor is None:
            return 0.0 * speed + self._pieces.whole_integral(self._state.torque) / self.period
        return self.motor.torque(self.motor.transmission * speed)

    @property
    def _powers(self):
        return self._transmission * self._motor_torque(self._speed) * self._speed

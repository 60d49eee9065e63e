"""Motors: torque over speed at the motor's shaft, and reduced to the crank."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import read_only
from ..numbers.formatting import with_units
from ..numbers.lazy import cached_property

MAX_SPEED_RATIO = 2.0
"""Largest speed of the search for steady running over the motor's idle or synchronous speed."""


@dataclass(frozen=True, eq=False)
class Motor:
    """A motor that turns the crank through a transmission; from `kloss`, `linear`, `constant` or `table`.

    Attributes
    ----------
    transmission : float
        Motor speed over crank speed; negative where they turn against each other. Counter-clockwise is positive for
        the crank; the motor drives toward its own positive speeds.
    inertia : float
        Moment of inertia of the rotor and all parts that turn with it, kg m2.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> motor = ks.drive.Motor.kloss(55e3, 154.5, synchronous_speed=157.08, overload=2.5, transmission=4.61)
    >>> print(f"{motor.torque_at_crank(33.5):.0f} N m at the crank, at 33.5 rad/s of it")
    1679 N m at the crank, at 33.5 rad/s of it
    """

    transmission: float = field(default=1.0, kw_only=True)
    inertia: float = field(default=0.0, kw_only=True)

    @staticmethod
    def kloss(power, speed, *, synchronous_speed, overload, transmission=1.0, inertia=0.0) -> "Motor":
        """Induction motor by Kloss's formula.

        T = 2 Tk s sk / (s^2 + sk^2) with the slip s = 1 - speed / synchronous speed: smooth through s = 0; beyond s = 0
        the motor regenerates. Tk = overload * power / speed, sk = sn (overload + sqrt(overload^2 - 1)); stator
        resistance is left out (M. Kloss, *Drehmoment und Schlüpfung des Drehstrommotors*, 1916).

        Parameters
        ----------
        power : float
            Rated power at the shaft, W.
        speed : float
            Rated speed of the motor's shaft, rad/s.
        synchronous_speed : float
            rad/s.
        overload : float
            Breakdown torque over rated torque, more than 1.
        transmission : float
            Motor speed over crank speed, not 0; negative where they turn against each other.
        inertia : float
            Moment of inertia of the rotor, at its own shaft, kg m2.

        Raises
        ------
        ParameterError
            A value is impossible; the message lists all impossible values.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> motor = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.08, overload=2.5)
        >>> round(float(motor.torque(153.9) * 153.9), 6)
        55000.0
        """
        found = checks.single_numbers(
            "Motor.kloss",
            power=(power, "W", POSITIVE),
            speed=(speed, "rad/s", POSITIVE),
            synchronous_speed=(synchronous_speed, "rad/s", SYNCHRONOUS_SPEED),
            overload=(overload, "1", {"low": 1.0, "strict": True}),
            **_transmission_rules(transmission, inertia),
        )
        rated, synchronous = found["speed"], found["synchronous_speed"]
        if not rated < synchronous:
            problem = (
                f"synchronous_speed must be greater than the rated speed of {rated:.9g} rad/s, got {synchronous:.9g}"
            )
            checks.require("Motor.kloss", problem)
        return Kloss(**found)

    @staticmethod
    def linear(torque, speed, *, transmission=1.0, inertia=0.0) -> "Motor":
        """Motor whose torque falls on a straight line, from its torque at standstill to 0 at its idle speed.

        Parameters
        ----------
        torque : float
            Torque of the motor's shaft at standstill, N m.
        speed : float
            Idle speed, rad/s, at which the torque is 0; beyond it the motor brakes.
        transmission, inertia
            As for `kloss`.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> float(ks.drive.Motor.linear(10.0, 100.0).torque(50.0))
        5.0
        """
        found = checks.single_numbers(
            "Motor.linear",
            standstill_torque=(torque, "N*m", {**POSITIVE, "name": "torque"}),
            idle_speed=(speed, "rad/s", {**POSITIVE, "name": "speed"}),
            **_transmission_rules(transmission, inertia),
        )
        return Linear(**found)

    @staticmethod
    def constant(torque, *, transmission=1.0, inertia=0.0) -> "Motor":
        """Motor of constant `torque`, N m, not 0 (negative: brake); `transmission` and `inertia` as for `kloss`.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> float(ks.drive.Motor.constant(10.0).torque(50.0))
        10.0
        """
        found = checks.single_numbers(
            "Motor.constant",
            standstill_torque=(torque, "N*m", {"name": "torque", "unequal": 0.0}),
            **_transmission_rules(transmission, inertia),
        )
        return Linear(idle_speed=math.inf, **found)

    @staticmethod
    def table(speed, torque, *, transmission=1.0, inertia=0.0) -> "Motor":
        """Motor by a table of torque over speed, with a monotone cubic between the rows (PCHIP: no new extremes).

        Parameters
        ----------
        speed : array (N,)
            Speeds of the motor's shaft, rad/s, rising; at least two rows. Running outside these speeds raises an error.
        torque : array (N,)
            Torque of the motor's shaft, N m.
        transmission, inertia
            As for `kloss`.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> motor = ks.drive.Motor.table([0.0, 100.0, 150.0, 160.0], [300.0, 500.0, 200.0, 0.0])
        >>> float(motor.torque(150.0))
        200.0
        """
        found = checks.single_numbers("Motor.table", **_transmission_rules(transmission, inertia))
        rows = checks.check_values("Motor.table", TABLE_COLUMNS, {"speed": speed, "torque": torque})
        checks.require("Motor.table", *_row_problems(*rows.values()))
        return TableMotor(*(read_only(np.array(row)) for row in rows.values()), **found)

    def torque(self, speed) -> Any:
        """Torque at speeds of the motor's shaft, N m."""
        raise NotImplementedError

    def slope(self, speed) -> Any:
        """Derivative of the torque by the speed, N m s."""
        raise NotImplementedError

    @property
    def field_speed(self) -> float | None:
        """Speed of the field, rad/s; None for a motor without slip."""
        return None

    @property
    def top(self) -> float:
        """Largest motor speed of the search for steady running, rad/s."""
        raise NotImplementedError

    @property
    def limits(self):
        """Speeds of the motor's shaft between which its torque is known, rad/s."""
        return -math.inf, math.inf

    @property
    def knots(self):
        """Speeds of the motor's shaft at which its torque has kinks, rad/s."""
        return ()

    @property
    def direction(self):
        """+1 if its positive speed turns the crank counter-clockwise, else -1."""
        return math.copysign(1.0, self.transmission)

    @property
    def inertia_at_crank(self):
        """Inertia of the rotor reduced to the crank, kg m2."""
        return self.inertia * self.transmission**2

    def torque_at_crank(self, crank_speed):
        """Torque on the crank at a crank speed, N m."""
        return self.transmission * self.torque(self.transmission * crank_speed)

    def slope_at_crank(self, crank_speed):
        """Derivative of the torque on the crank by the crank speed, N m s."""
        return self.transmission**2 * self.slope(self.transmission * crank_speed)


@with_units(power="W", speed="rad/s", synchronous_speed="rad/s", transmission="1", inertia="kg m2")
@dataclass(frozen=True, eq=False)
class Kloss(Motor):
    """Induction motor; see `Motor.kloss`."""

    power: float
    speed: float
    synchronous_speed: float
    overload: float

    @cached_property
    def breakdown_torque(self):
        return self.overload * self.power / self.speed

    @cached_property
    def breakdown_slip(self):
        return self._slip(self.speed) * (self.overload + math.sqrt((self.overload - 1.0) * (self.overload + 1.0)))

    def _slip(self, speed):
        return (self.synchronous_speed - speed) / self.synchronous_speed

    def torque(self, speed):
        slip, most = self._slip(speed), self.breakdown_slip
        return 2.0 * self.breakdown_torque * most * slip / (slip * slip + most * most)

    def slope(self, speed):
        slip, most = self._slip(speed), self.breakdown_slip
        square = slip * slip + most * most
        by_slip = 2.0 * self.breakdown_torque * most * (most - slip) * (most + slip) / (square * square)
        return -by_slip / self.synchronous_speed

    @property
    def field_speed(self):
        return self.synchronous_speed

    @property
    def top(self):
        return MAX_SPEED_RATIO * self.synchronous_speed


@with_units(standstill_torque="N m", idle_speed="rad/s", inertia="kg m2")
@dataclass(frozen=True, eq=False)
class Linear(Motor):
    """Motor with a straight line of torque, level where the idle speed is infinite; see `Motor.linear`, `constant`."""

    standstill_torque: float
    idle_speed: float

    def torque(self, speed):
        return self.standstill_torque * (1.0 - speed / self.idle_speed)

    def slope(self, speed):
        return 0.0 * speed - self.standstill_torque / self.idle_speed

    @property
    def top(self):
        return MAX_SPEED_RATIO * self.idle_speed


@with_units(speeds="rad/s", torques="N m", inertia="kg m2")
@dataclass(frozen=True, eq=False)
class TableMotor(Motor):
    """Motor by a table; see `Motor.table`. Straight lines extend the curve for iterations outside the table."""

    speeds: np.ndarray
    torques: np.ndarray

    def torque(self, speed):
        inside = np.clip(speed, *self.limits)
        return self._curve(inside) + self._curve(inside, 1) * (speed - inside)

    def slope(self, speed):
        return self._curve(np.clip(speed, *self.limits), 1)

    @cached_property
    def _curve(self):
        from scipy.interpolate import PchipInterpolator

        return PchipInterpolator(self.speeds, self.torques)

    @property
    def limits(self):
        return float(self.speeds[0]), float(self.speeds[-1])

    @property
    def knots(self):
        return self.speeds

    @property
    def top(self):
        return self.limits[1]


POSITIVE = {"low": 0.0, "strict": True}
SYNCHRONOUS_SPEED = {**POSITIVE, "usual": checks.PlausibleRange(700.0, "is it in rpm?", math.pi / 30.0)}
TABLE_COLUMNS = {"speed": checks.Number("rad/s", table=True), "torque": checks.Number("N*m", table=True)}


def _transmission_rules(transmission, inertia):
    return {"transmission": (transmission, "1", {"unequal": 0.0}), "inertia": (inertia, "kg*m**2", {"low": 0.0})}


def _row_problems(speed, torque):
    """Sentences about faulty rows of torque over speed."""
    wrong = [name for name, row in (("speed", speed), ("torque", torque)) if np.ndim(row) != 1]
    if wrong:
        return [f"{name} must be a row of numbers" for name in wrong]
    if speed.size != torque.size or speed.size < 2:
        return [f"speed and torque must have the same length, at least 2, got {speed.size} and {torque.size}"]
    if np.any(np.diff(speed) <= 0):
        row = int(np.argmax(np.diff(speed) <= 0)) + 1
        return [f"speeds must rise, but {speed[row]:.9g} follows {speed[row - 1]:.9g} rad/s"]
    return []

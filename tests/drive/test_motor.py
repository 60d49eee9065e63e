"""Motors: their curves, and what they refuse."""

import math

import numpy as np
import pytest

import kinetostatics as ks

Motor = ks.drive.Motor
MOTORS = {
    "kloss": Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.0, inertia=0.3),
    "linear": Motor.linear(30.0, 100.0),
    "constant": Motor.constant(30.0, transmission=-2.0),
    "table": Motor.table([0.0, 60.0, 100.0, 130.0], [50.0, 80.0, 40.0, -20.0]),
}


@pytest.mark.parametrize("motor", MOTORS.values(), ids=MOTORS)
def test_slope_is_the_derivative_of_the_torque(motor):
    speed, step = np.linspace(3.0, 127.0, 11), 1e-5
    found = (motor.torque(speed + step) - motor.torque(speed - step)) / (2 * step)
    assert motor.slope(speed) == pytest.approx(found, rel=1e-7, abs=1e-7)


def test_kloss_meets_rated_and_breakdown_torque():
    motor = MOTORS["kloss"]
    rated = 55e3 / 153.9
    assert motor.torque(153.9) == pytest.approx(rated, rel=1e-14)
    at = 157.0 * (1.0 - motor.breakdown_slip)
    assert motor.torque(at) == pytest.approx(2.5 * rated, rel=1e-14)
    assert motor.slope(at) == pytest.approx(0.0, abs=1e-10)
    assert motor.torque(157.0) == 0.0
    assert motor.torque(157.0 + 3.1) == pytest.approx(-rated, rel=1e-12)
    assert motor.torque_at_crank(153.9 / 4.0) == pytest.approx(4.0 * rated, rel=1e-14)
    assert motor.inertia_at_crank == pytest.approx(4.8)


def test_motor_table_passes_rows_without_overshoot():
    motor = MOTORS["table"]
    assert np.array_equal(motor.torque(motor.speeds), motor.torques)
    assert motor.torque(np.linspace(0.0, 130.0, 999)).max() <= 80.0


GOOD = {"power": 55e3, "speed": 153.9, "synchronous_speed": 157.0, "overload": 2.5}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"power": -1.0}, "power must be greater than 0, got -1"),
        ({"power": "55 kW"}, "power must be a number"),
        ({"speed": math.nan}, "speed must be finite"),
        ({"overload": 1.0}, "overload must be greater than 1, got 1"),
        ({"synchronous_speed": 150.0}, "greater than the rated speed of 153.9 rad/s, got 150"),
        ({"transmission": 0.0}, "transmission must not be 0"),
        ({"inertia": -0.1}, "inertia must be at least 0"),
        ({"power": np.array([[1.0], [2.0]])}, "power must be one number"),
        ({"transmission": [1.0, 2.0]}, "transmission must be"),
    ],
)
def test_what_no_motor_can_have_is_refused(changes, words):
    given = {**GOOD, **changes}
    with pytest.raises(ks.ParameterError, match=r"Motor\.kloss: ") as caught:
        Motor.kloss(given.pop("power"), given.pop("speed"), **given)
    assert words in str(caught.value)


@pytest.mark.parametrize(
    ("speed", "torque", "words"),
    [
        ([0.0, 2.0, 1.0], [1.0, 1.0, 1.0], "speeds must rise, but 1 follows 2"),
        ([0.0, 1.0], [1.0], "one length"),
        ([0.0], [1.0], "one length, 2 at least"),
        ([0.0, math.nan], [1.0, 2.0], "speed must be finite"),
        ("abc", [1.0, 2.0], "speed must be"),
        (3.0, [1.0, 2.0], "speed must be a row"),
    ],
)
def test_rows_that_are_no_table_are_refused(speed, torque, words):
    with pytest.raises(ks.ParameterError, match=r"Motor\.table: ") as caught:
        Motor.table(speed, torque)
    assert words in str(caught.value)

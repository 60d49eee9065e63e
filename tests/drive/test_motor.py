"""Motors and operating points."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.resolution import require_inertia, resolved
from kinetostatics.drive.steady_running import operating_speed, settle_from_above
from support.drives import DISC, DISC_MOTOR, driven
from support.every import every

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


@every(
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
        ([0.0, 1.0], [1.0], "the same length"),
        ([0.0], [1.0], "the same length, at least 2"),
        ([0.0, math.nan], [1.0, 2.0], "speed must be finite"),
        ("abc", [1.0, 2.0], "speed must be"),
        (3.0, [1.0, 2.0], "speed must be a row"),
    ],
)
def test_rows_that_are_no_table_are_refused(speed, torque, words):
    with pytest.raises(ks.ParameterError, match=r"Motor\.table: ") as caught:
        Motor.table(speed, torque)
    assert words in str(caught.value)


# The operating speed


def test_weak_motor_and_runaway_are_reported():
    with pytest.raises(ks.errors.DriveError, match="too weak"):
        operating_speed(driven(DISC, ks.Torque(-1e4, on="crank")))
    with pytest.raises(ks.errors.DriveError, match="nothing stabilises the speed"):
        operating_speed(driven(motor=ks.drive.Motor.constant(5.0)))


@pytest.mark.parametrize("torque", [1e-3, 2.0, 5e4])
def test_constant_torque_runs_to_the_friction_limit(torque):
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(5.0, 0.02, 3.0)), ())
    scene = ks.Scene(disc, 1.0, friction={"O": ks.PinFriction(0.1, 0.03)})
    run = ks.drive.steady(scene, ks.drive.Motor.constant(torque), angles=5)
    assert run.mean_speed == pytest.approx(math.sqrt(torque / (0.1 * 0.03 * 5.0 * 0.02)), rel=1e-12)


def test_stronger_motor_carries_the_load_as_advised():
    disc = ks.Mechanism("disc", ks.Crank(0.1, ks.Link(10.0, 0.1, 3.0)), ())
    scene = ks.Scene(disc, 1.0, loads=ks.Torque(-20.0, on="crank"), friction={"O": ks.PinFriction(0.5, 0.1)})

    def steady(times):
        motor = ks.drive.Motor.table([0.0, 20.0, 40.0, 60.0], [times * 12.0, times * 10.0, times * 30.0, 0.0])
        return ks.drive.steady(scene, motor, 1.0)

    with pytest.raises(ks.errors.DriveError, match="too weak") as caught:
        steady(1.0)  # the load is least at rest, 20 N m, where the motor does not give its most
    times = float(str(caught.value).partition("Give a motor ")[2].partition(" times")[0])
    assert 1.6 < times <= 1.667
    assert steady(1.001 * times).mean_speed < 2.0


# A scene as one degree of freedom


class Speedy:
    """A torque on the crank by its speed, which declares where it jumps."""

    def __call__(self, motion):
        """Torque, N m."""
        return np.where(np.mod(motion.crank_angle, 2 * np.pi) < 2.0, -0.1, -0.05) * motion.crank_speed

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return [], [0.0, 2.0]


def test_declared_kinks_may_depend_on_speed():
    found = driven(DISC, ks.Torque(Speedy(), on="crank"))
    assert found.kinks.tolist() == [2.0]
    assert found.loads_by_speed
    left = [found.balance(0.3, speed)[2] - float(DISC_MOTOR.torque_at_crank(speed)) for speed in (5.0, 10.0)]
    assert left == pytest.approx([-0.5, -1.0], rel=1e-12)
    assert not driven(DISC, ks.Torque(ks.Table([0.0, 2.0, 4.0], [-1.0, -2.0, -1.5]), on="crank")).loads_by_speed


# Running met by following a machine from above


def test_standstill_names_angle_and_missing_torque():
    machine = driven(DISC, ks.Torque(-1e3, on="crank"))
    with pytest.raises(ks.errors.DriveError, match="comes to a standstill at crank angle") as caught:
        settle_from_above(machine, resolved(machine, 10.0)[0], 10.0)
    assert caught.value.missing == pytest.approx(1e3 - float(machine.motor_torque(0.0)), rel=1e-6)


# Pieces of a turn in which a machine is resolved


def test_vanishing_inertia_is_refused_with_its_angle():
    motor = ks.drive.Motor.linear(100.0, 50.0)
    machine = driven(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), motor=motor, flywheel=0.0)
    with pytest.raises(ks.errors.DriveError, match="all inertia vanishes at crank angle"):
        require_inertia(machine, resolved(machine, 3.0)[0])
    require_inertia(driven(), resolved(driven(), 3.0)[0])

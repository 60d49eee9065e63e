"""The operating speed: where motor and loads agree in the mean, and where they never do."""

import pytest

import kinetostatics as ks
from kinetostatics.drive.operating import operating_speed
from support.driven_machines import DISC, MOTOR, driven


def test_the_operating_speed_of_a_constant_torque_is_that_of_the_motor_s_line():
    speed = operating_speed(driven(DISC, ks.Torque(-12.0, on="crank")))
    assert MOTOR.torque_at_crank(speed) == pytest.approx(12.0, rel=1e-9)


def test_a_motor_too_weak_and_a_machine_that_nothing_holds_are_told():
    with pytest.raises(ks.errors.DriveError, match="too weak"):
        operating_speed(driven(DISC, ks.Torque(-1e4, on="crank")))
    with pytest.raises(ks.errors.DriveError, match="nothing holds the speed"):
        operating_speed(driven(motor=ks.drive.Motor.constant(5.0)))

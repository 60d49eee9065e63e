"""The solution of a machine in periodic running: at its true speed at any crank angle, over its own period."""

import numpy as np
import pytest

import kinetostatics as ks
from support.drives import MOTOR, SAW

RUN = ks.drive.steady(ks.Scene(SAW, 1.0, loads=ks.Gravity()), MOTOR, 30.0)
FEW = np.array([0.1, 2.0, 9.0])


def test_at_other_crank_angles_it_has_the_speed_that_running_has_there():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    assert np.array_equal(there.crank_speed, speed)
    assert np.array_equal(there.crank_acceleration, acceleration)
    plain = ks.Scene(SAW, speed, acceleration, ks.Gravity()).solve(FEW)
    assert np.array_equal(there.balancing_torque, plain.balancing_torque)
    one = RUN.solution.at(2.0)
    assert one.balancing_torque == pytest.approx(there.balancing_torque[1], rel=1e-13)


def test_motor_and_flywheel_give_the_torque_between_the_angles_too():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    given = MOTOR.torque_at_crank(speed) - 30.0 * acceleration
    assert there.balancing_torque == pytest.approx(given, rel=1e-12, abs=1e-12 * np.abs(given).max())


def test_it_repeats_with_running_and_says_its_mean_speed():
    assert RUN.solution.period == RUN.period
    assert repr(RUN.solution).startswith("<RunningSolution")
    assert repr(RUN.solution).endswith(f"mean speed {RUN.mean_speed:.9g} rad/s>")

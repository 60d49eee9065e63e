"""A machine in periodic running as any solution."""

import numpy as np
import pytest
from scipy.integrate import quad

import kinetostatics as ks
from support.drives import CUT, FAN, MOTOR, saw


def test_speed_is_the_integral_of_acceleration_and_time_that_of_slowness():
    run = ks.drive.steady(saw(FAN), MOTOR, 100.0, angles=[0.4, 2.9])
    change = quad(lambda angle: float(np.divide(*run.motion(np.array(angle))[::-1])), 0.4, 2.9, epsrel=1e-13)[0]
    assert change == pytest.approx(run.speed[1] - run.speed[0], rel=1e-11)
    time = quad(lambda angle: 1.0 / float(run.motion(np.array(angle))[0]), 0.4, 2.9, epsrel=1e-13)[0]
    assert time == pytest.approx(run.time[1] - run.time[0], rel=1e-12)


def test_extremes_frames_and_comparison_take_running_as_any_solution():
    run = ks.drive.steady(saw(CUT), MOTOR, 1000.0)
    other = ks.drive.steady(saw(CUT), MOTOR, 50.0)
    found = ks.extremes(run.solution, "balancing_torque")
    assert found.range[1] >= run.solution.balancing_torque.max() - 1e-9
    assert ks.compare(run.solution, other.solution).mean_torque_ratio > 1.0
    assert len(run.frame()) == 720
    assert len(run.solution.frame()) == 720

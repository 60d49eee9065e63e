"""What a user's function of the motion gives: seen without forces, checked, and named when it is wrong."""

import numpy as np
import pytest

import kinetostatics as ks

PUMP = ks.crank_slider(0.1, 0.4)
TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)


def guide_force(function):
    return ks.solve(PUMP, TURN, crank_speed=2.0, loads=ks.ProcessForce(function)).balancing_torque


def test_a_function_may_follow_the_motion_and_give_one_number_or_one_for_each_angle():
    found = guide_force(lambda motion: -50.0 * motion.travel_velocity("slider"))
    speeds = ks.solve(PUMP, TURN, crank_speed=2.0).slider_velocity
    assert found == pytest.approx(50.0 * speeds**2 / 2.0, abs=1e-12)
    assert np.array_equal(guide_force(lambda motion: 3), guide_force(lambda motion: np.full(12, 3.0)))

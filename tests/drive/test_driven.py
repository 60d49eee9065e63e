"""A scene as one degree of freedom: its inertia and load torque, and the acceleration that follows."""

import numpy as np
import pytest

import kinetostatics as ks
from support.driven_machines import DISC, MOTOR, PUMP, driven

ANGLE = np.linspace(0.1, 6.0, 8)


def test_a_disc_has_its_inertia_and_the_torque_of_its_load():
    found = driven(DISC, ks.Torque(-12.0, on="crank"))
    inertia, slope, left = found.here(0.3, 5.0)
    assert (inertia, slope) == (3.5, 0.0)
    assert left == pytest.approx(float(MOTOR.torque_at_crank(5.0)) - 12.0, rel=1e-14)
    state = found.at(ANGLE)
    assert found.acceleration(state, 5.0) == pytest.approx(np.full(8, left / 3.5), rel=1e-14)


def test_the_acceleration_is_that_at_which_the_motor_balances_the_machine():
    found = driven(PUMP, ks.Gravity())
    acceleration = found.acceleration(found.at(ANGLE), 6.0)
    s = ks.solve(PUMP, ANGLE, crank_speed=6.0, crank_acceleration=acceleration, loads=ks.Gravity())
    assert s.balancing_torque + 0.5 * acceleration == pytest.approx(float(MOTOR.torque_at_crank(6.0)), rel=1e-12)

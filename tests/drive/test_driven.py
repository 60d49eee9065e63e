"""A scene as one degree of freedom: its inertia and load torque, and the acceleration that follows."""

import numpy as np
import pytest

import kinetostatics as ks
from support.drives import DISC, DISC_MOTOR, PUMP, driven

ANGLE = np.linspace(0.1, 6.0, 8)


def test_a_disc_has_its_inertia_and_the_torque_of_its_load():
    found = driven(DISC, ks.Torque(-12.0, on="crank"))
    inertia, slope, left = found.here(0.3, 5.0)
    assert (inertia, slope) == (3.5, 0.0)
    assert left == pytest.approx(float(DISC_MOTOR.torque_at_crank(5.0)) - 12.0, rel=1e-14)
    state = found.at(ANGLE)
    assert found.acceleration(state, 5.0) == pytest.approx(np.full(8, left / 3.5), rel=1e-14)


def test_the_acceleration_is_that_at_which_the_motor_balances_the_machine():
    found = driven(PUMP, ks.Gravity())
    acceleration = found.acceleration(found.at(ANGLE), 6.0)
    s = ks.solve(PUMP, ANGLE, crank_speed=6.0, crank_acceleration=acceleration, loads=ks.Gravity())
    assert s.balancing_torque + 0.5 * acceleration == pytest.approx(float(DISC_MOTOR.torque_at_crank(6.0)), rel=1e-12)


class Speedy:
    """A torque on the crank by its speed, which declares where it jumps."""

    def __call__(self, motion):
        """Torque, N m."""
        return np.where(np.mod(motion.crank_angle, 2 * np.pi) < 2.0, -0.1, -0.05) * motion.crank_speed

    def kinks(self, motion):
        """No kinks, and two jumps."""
        return [], [0.0, 2.0]


def test_a_function_that_declares_kinks_may_still_depend_on_the_speed():
    found = driven(DISC, ks.Torque(Speedy(), on="crank"))
    assert found.kinks.tolist() == [2.0]
    assert found.loads_by_speed
    left = [found.here(0.3, speed)[2] - float(DISC_MOTOR.torque_at_crank(speed)) for speed in (5.0, 10.0)]
    assert left == pytest.approx([-0.5, -1.0], rel=1e-12)
    assert not driven(DISC, ks.Torque(ks.Table([0.0, 2.0, 4.0], [-1.0, -2.0, -1.5]), on="crank")).loads_by_speed

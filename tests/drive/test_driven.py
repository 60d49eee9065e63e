"""A scene as one degree of freedom: its inertia and load torque, and the acceleration that follows."""

import numpy as np
import pytest

import kinetostatics as ks
from support.drives import DISC, DISC_MOTOR, driven


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

"""A scene as one degree of freedom: its inertia and load torque, and the acceleration that follows."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.driven import Driven
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


class _Brake:
    """A force against the motion on half a turn, plain numbers only, which tells where it bends."""

    def __call__(self, motion):
        """Force, N."""
        way, speed = (np.asarray(part, dtype=float) for part in (motion.crank_angle, motion.slider_velocity))
        return np.asarray(np.where(np.sin(way) > 0.0, -speed, 0.0))

    def kinks(self, motion):
        """Two kinks, no jump."""
        return np.array([0.0, np.pi]), np.empty(0)


def test_a_function_that_tells_its_kinks_may_hang_on_the_speed():
    made = ks.crank_slider(0.05, 0.19, slider=ks.Link(2.0))
    table = ks.Table([0.0, 1.0, 6.0], [0.0, 1.0, 0.0])
    loads = (ks.ProcessForce(one) for one in (_Brake(), table))
    found = [Driven("a drive", ks.Scene(made, 30.0, loads=one), None, 0.0) for one in loads]
    assert [one.loads_by_speed for one in found] == [True, False]

"""Weight: on every link, in any direction, with a potential."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
ARM = ks.Mechanism("arm", ks.Crank(0.5, ks.Link(3.0, (0.2, 0.1), 0.0)), ())


@pytest.mark.parametrize("direction", [-np.pi / 2, 0.0, 2.0])
def test_the_torque_at_rest_holds_the_weight_at_its_arm(direction):
    s = ks.solve(ARM, TURN, crank_speed=0.0, loads=ks.Gravity(9.81, direction))
    x, y = s.position("crank")
    expected = -3.0 * 9.81 * (x * np.sin(direction) - y * np.cos(direction))
    assert s.balancing_torque == pytest.approx(expected, abs=1e-13)


def test_the_torque_is_the_slope_of_the_potential():
    def energy(angle):
        s = ks.solve(ARM, angle, crank_speed=0.0, loads=ks.Gravity())
        return ks.Gravity().potential(s.dynamics)

    slope = (energy(TURN + 1e-6) - energy(TURN - 1e-6)) / 2e-6
    found = ks.solve(ARM, TURN, crank_speed=0.0, loads=ks.Gravity()).balancing_torque
    assert found == pytest.approx(slope, abs=1e-7)

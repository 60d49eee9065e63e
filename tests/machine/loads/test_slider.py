"""Loads on a slider along its guide."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_a_process_force_may_follow_the_motion():
    def cut(motion):
        return np.where(motion.slider_velocity < 0, 1000.0, 0.0)

    with_cut = solved(loads=[ks.Gravity(), ks.ProcessForce(cut)])
    difference = with_cut.balancing_torque - solved().balancing_torque
    expected = np.where(with_cut.slider_velocity < 0, -1000.0 * with_cut.slider_velocity / 33.5, 0.0)
    np.testing.assert_allclose(difference, expected, atol=1e-9)


def test_spring_acts_on_the_slider_it_names():
    spring = ks.Spring.balancing(10.0, 3.0, 0.5, on="slider2")
    assert (spring.stiffness, spring.free_position, spring.on) == (90.0, 0.5, "slider2")


# Weight


TWELVE = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
ARM = ks.Mechanism("arm", ks.Crank(0.5, ks.Link(3.0, (0.2, 0.1), 0.0)), ())


@pytest.mark.parametrize("direction", [-np.pi / 2, 0.0, 2.0])
def test_torque_at_rest_holds_the_weight(direction):
    s = ks.solve(ARM, TWELVE, crank_speed=0.0, loads=ks.Gravity(9.81, direction))
    x, y = s.position("crank")
    expected = -3.0 * 9.81 * (x * np.sin(direction) - y * np.cos(direction))
    assert s.balancing_torque == pytest.approx(expected, abs=1e-13)


def test_the_torque_is_the_slope_of_the_potential():
    def energy(angle):
        s = ks.solve(ARM, angle, crank_speed=0.0, loads=ks.Gravity())
        return ks.Gravity().potential(s.dynamics)

    slope = (energy(TWELVE + 1e-6) - energy(TWELVE - 1e-6)) / 2e-6
    found = ks.solve(ARM, TWELVE, crank_speed=0.0, loads=ks.Gravity()).balancing_torque
    assert found == pytest.approx(slope, abs=1e-7)

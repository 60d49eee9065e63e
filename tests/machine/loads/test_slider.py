"""Loads on a slider along its guide."""

import numpy as np

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

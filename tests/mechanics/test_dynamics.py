"""Forces of a scene, from the laws that all of them keep."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(
    0.3, 1.1, guide_offset=0.05, crank=ks.Link(5, 0.1, 0.2), coupler=ks.Link(9, (0.5, 0.1), 1.5), slider=ks.Link(20)
)


def solved(**options):
    return ks.solve(SAW, TURN, **{"crank_speed": 6.0, "crank_acceleration": -2.0, "loads": ks.Gravity()} | options)


def test_ground_reactions_weights_and_inertia_are_in_balance():
    s = solved()
    momentum = sum(link.mass * s.acceleration(name) for name, link in SAW.links.items())
    weight = np.array([[0.0], [-9.81 * 34.0]])
    assert s.reaction("O") + s.reaction("guide") + weight == pytest.approx(momentum, abs=1e-11)


def test_the_torque_of_all_forces_is_that_of_the_powers():
    s = solved()
    assert s.balancing_torque == pytest.approx(
        s.balancing_torque_by_power, abs=1e-12 * np.abs(s.balancing_torque).max()
    )
    assert s.power_residual < 1e-14


def test_without_friction_nothing_rubs():
    s = solved()
    assert s.dynamics.friction_margin == pytest.approx(1.0)
    assert np.all(s.dynamics.friction_loss == 0.0)
    assert s.dynamics.friction_by_joint == {}

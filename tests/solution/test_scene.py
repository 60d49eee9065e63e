"""A scene: its numbers by path, others in their place, and the same solution as `solve`."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
SCENE = ks.Scene(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), 10.0, 2.0, (ks.Gravity(), ks.Spring(500.0, 0.4)))


def test_a_scene_is_solved_as_its_parts_are():
    whole, parts = (
        SCENE.solve(TURN),
        ks.solve(SCENE.mechanism, TURN, crank_speed=10.0, crank_acceleration=2.0, loads=SCENE.loads),
    )
    assert np.array_equal(whole.balancing_torque, parts.balancing_torque)
    assert SCENE.solve(12).crank_angle == pytest.approx(TURN)


def test_the_period_is_that_of_loads_and_mechanism():
    table = ks.Table(np.pi * np.arange(4), [1.0, 2.0, 1.0, 0.0], period=4 * np.pi)
    assert SCENE.period == 2 * np.pi
    assert ks.Scene(SCENE.mechanism, 1.0, loads=(ks.ProcessForce(table, period=4 * np.pi),)).period == 4 * np.pi

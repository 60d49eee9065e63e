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


def test_every_number_has_a_path_and_a_unit():
    known = {"crank_length": 0.1, "slider.mass": 3.0, "spring.stiffness": 500.0, "crank_speed": 10.0}
    assert {path: SCENE.parameters[path] for path in known} == known
    assert [SCENE.units[path] for path in known] == ["m", "kg", "N/m", "rad/s"]
    assert SCENE.units.keys() == SCENE.parameters.keys()


def test_other_numbers_change_what_they_name_and_leave_the_scene():
    made = SCENE.varied({"slider.mass": 7.0, "spring.stiffness": np.array([[1.0], [2.0]])})
    assert made.parameters["slider.mass"] == 7.0
    assert made.solve(TURN).shape == (2, 12)
    assert SCENE.parameters["slider.mass"] == 3.0
    with pytest.raises(ks.ParameterError, match=r"did you mean 'slider\.mass'"):
        SCENE.varied({"slider.mas": 1.0})


def test_the_period_is_that_of_loads_and_mechanism():
    table = ks.Table(np.pi * np.arange(4), [1.0, 2.0, 1.0, 0.0], period=4 * np.pi)
    assert SCENE.period == 2 * np.pi
    assert ks.Scene(SCENE.mechanism, 1.0, loads=(ks.ProcessForce(table, period=4 * np.pi),)).period == 4 * np.pi

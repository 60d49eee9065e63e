"""Means over the turn of any functions of the crank angle: smooth, with corners, with jumps, several at once."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.means import energy_per_turn, mean_absolute_torque, mean_absolute_torque_errors, means

TURN = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0)), 0.0, crank_speed=3.0).sampled
WHOLE = 2 * np.pi

FUNCTIONS = {
    "power": (lambda x: x**3, WHOLE**3 / 4),
    "sine": (np.sin, 0.0),
    "corner": (lambda x: np.abs(np.sin(x - 0.123)), 2 / np.pi),
    "root": (lambda x: np.sqrt(np.abs(x - 1.0)), (2 / 3 * (1 + (WHOLE - 1) ** 1.5)) / WHOLE),
    "jump": (lambda x: np.where(x > 1.2345, 2.0, -1.0), 2.0 - 3.0 * 1.2345 / WHOLE),
    "peak": (lambda x: 1e-4 / ((x - 2.0) ** 2 + 1e-8), (np.arctan(2e4) + np.arctan((WHOLE - 2) * 1e4)) / WHOLE),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_mean_is_that_of_calculus(name):
    function, expected = FUNCTIONS[name]
    found, error = means(lambda x: function(x)[None], TURN, 1e-14)
    assert found[0] == pytest.approx(expected, rel=1e-11, abs=1e-14)
    assert error[0] < 1e-10


def test_several_functions_together_are_as_right_as_each_alone():
    functions, expected = zip(*FUNCTIONS.values(), strict=True)
    found, _ = means(lambda x: np.array([function(x) for function in functions]), TURN, 1e-14)
    assert found == pytest.approx(expected, rel=1e-11, abs=1e-14)


def test_a_known_jump_given_as_an_edge_costs_no_more_panels():
    asked = []

    def jumping(x):
        asked.append(x.size)
        return np.where(x > 1.2345, 2.0, -1.0)[None]

    found, _ = means(jumping, TURN, 1e-14, edges=[1.2345])
    knowing = sum(asked)
    asked.clear()
    means(jumping, TURN, 1e-14)
    assert found[0] == pytest.approx(FUNCTIONS["jump"][1], rel=1e-14)
    assert knowing < sum(asked)


@pytest.mark.parametrize("of", [mean_absolute_torque, energy_per_turn])
def test_where_friction_jams_in_the_turn_there_is_no_mean(of):
    solution = ks.solve(
        ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0)), 0.3, crank_speed=3.0, friction={"guide": ks.GuideFriction(0.9)}
    )
    with pytest.raises(ks.JammingError, match="friction jams at") as caught:
        of(solution)
    assert caught.value.angles
    assert "on_gap" not in str(caught.value)


def test_errors_of_a_mean_are_rounding_and_quadrature():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    s = ks.solve(saw, 8, crank_speed=33.5, loads=[ks.Gravity()])
    rounding, quadrature = mean_absolute_torque_errors(s)
    mean = mean_absolute_torque(s)
    assert 0 < rounding < 1e-13 * mean
    assert 0 <= quadrature < 1e-12 * mean
    assert ks.compare(s, s).mean_torque_errors[0] == (rounding, quadrature)

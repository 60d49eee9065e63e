"""Crank angles as solutions keep them."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_a_single_crank_angle_gives_single_values():
    solution = solved(0.5)
    assert solution.balancing_torque.shape == ()
    assert solution.reaction("O").shape == (2,)
    assert solution.power_residual < 1e-14


def test_results_cannot_be_written_to_and_follow_no_later_change_of_the_angles():
    turn = TURN.copy()
    solution = solved(turn)
    before = solution.guide_force.copy()
    turn[:] = 0.0
    np.testing.assert_array_equal(solution.at(TURN).guide_force, before)
    with pytest.raises(ValueError, match="read-only"):
        solution.guide_force[0] = 0.0


def test_whole_numbers_as_crank_angles_do_not_cut_results_off():
    np.testing.assert_array_equal(solved(np.arange(4)).rate("crank"), np.full(4, 33.5))

"""A solution as its user meets it: results on demand, tables, other angles."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanism import Mechanism

TURN = np.linspace(0, 2 * np.pi, 24, endpoint=False)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def solved(angle=TURN, **change):
    return ks.solve(SAW, angle, **{"crank_speed": 33.5, "loads": [ks.Gravity()], **change})


def test_torque_by_power_computes_no_reaction(monkeypatch):
    expected = solved().balancing_torque

    def refuse(*_):
        raise AssertionError("forces were resolved")

    monkeypatch.setattr(Mechanism, "resolve", refuse)
    np.testing.assert_allclose(solved().balancing_torque_by_power, expected, atol=1e-9)


def test_motion_and_shaking_force_compute_no_reaction(monkeypatch):
    monkeypatch.setattr(Mechanism, "resolve", None)
    solution = solved()
    assert solution.position("B").shape == solution.shaking_force.shape == (2, TURN.size)


def test_results_are_kept():
    solution = solved()
    assert solution.balancing_torque is solution.balancing_torque
    assert solution.placement is solution.placement


def test_frame_has_a_row_for_each_angle_and_a_unit_in_every_column():
    table = solved().frame()
    assert len(table) == TURN.size
    assert all(name.endswith("]") for name in table.columns)
    np.testing.assert_allclose(table["crank_angle [deg]"], np.arange(0, 360, 15))
    np.testing.assert_array_equal(table["balancing_torque [N m]"], solved().balancing_torque)
    np.testing.assert_array_equal(table["reaction_O_x [N]"], solved().reaction("O")[0])


def test_frame_of_a_batch_numbers_its_designs():
    batch = ks.solve(ks.crank_slider(np.array([[0.2], [0.3]]), 2.0, slider=ks.Link(600)), TURN, crank_speed=33.5)
    table = batch.frame()
    assert len(table) == 2 * TURN.size
    np.testing.assert_array_equal(table["design"], np.repeat([0, 1], TURN.size))
    np.testing.assert_array_equal(table["A_x [m]"], batch.position("A")[0].ravel())


def test_other_angles_give_the_same_as_a_new_solution():
    elsewhere = np.array([0.1, 0.2])
    np.testing.assert_array_equal(solved().at(elsewhere).balancing_torque, solved(elsewhere).balancing_torque)


def test_a_table_over_the_angles_cannot_be_moved_to_others():
    solution = solved(loads=[ks.ProcessForce(np.linspace(0, 1, TURN.size))])
    with pytest.raises(ks.ParameterError, match="ProcessForce is a table"):
        solution.at([0.0])


def test_a_process_force_may_follow_the_motion():
    def cut(motion):
        return np.where(motion.slider_velocity < 0, 1000.0, 0.0)

    with_cut = solved(loads=[ks.Gravity(), ks.ProcessForce(cut)])
    difference = with_cut.balancing_torque - solved().balancing_torque
    expected = np.where(with_cut.slider_velocity < 0, -1000.0 * with_cut.slider_velocity / 33.5, 0.0)
    np.testing.assert_allclose(difference, expected, atol=1e-9)


def test_a_single_crank_angle_gives_single_values():
    solution = solved(0.5)
    assert solution.balancing_torque.shape == ()
    assert solution.reaction("O").shape == (2,)
    assert solution.power_residual < 1e-14


def test_a_standing_mechanism_is_held_by_the_statics_of_its_loads():
    standing = solved(crank_speed=0.0)
    work = 150 * 9.81 * standing.at(TURN).position("coupler")[1]
    slope = np.fft.irfft(1j * np.arange(TURN.size // 2 + 1) * np.fft.rfft(work), TURN.size)
    np.testing.assert_allclose(standing.balancing_torque, slope, atol=1e-6)
    assert standing.power_residual < 1e-14

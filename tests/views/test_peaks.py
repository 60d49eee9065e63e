"""Curves hold the extremes that tables print, kinks and both sides of jumps, and stay as solved where none is known."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.load_values import user_value
from kinetostatics.mechanics.quantities import values
from kinetostatics.views.canvas import with_peaks
from support.every import every

PRESS = ks.crank_slider(0.1, 0.4, coupler=ks.Link(2.0, 0.2, 0.03), slider=ks.Link(3.0))
TURN = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)
TABLES = {
    "narrow peak": ks.Table([0.3, 0.41, 0.42, 0.421, 0.5], [0.0, 0.0, 5e4, 0.0, 0.0], over="travel"),
    "jump": ks.Table([0.3, 0.5], [-4e3, -4e3], over="travel", back=[0.0, 0.0]),
    "kinks": ks.Table([0.0, 1.03, 2.07, 4.0, 2 * np.pi], [0.0, 3e3, 0.0, 0.0, 0.0]),
    "nothing": 200.0,
}


def solved(force=0.0, angles=TURN):
    return ks.solve(PRESS, angles, crank_speed=5.0, loads=[ks.Gravity(), ks.ProcessForce(force)])


@every("name", TABLES)
@pytest.mark.parametrize("quantity", ["balancing_torque", "O", "slider_acceleration"])
def test_a_curve_reaches_as_far_as_the_table_says(name, quantity):
    s = solved(TABLES[name])
    found, curve = ks.extremes(s, quantity), values(with_peaks({"": s}, quantity)[""], quantity)
    assert [curve.min(), curve.max()] == pytest.approx([found.value.min(), found.value.max()], rel=1e-12)


def test_curve_points_are_its_table():
    s = with_peaks({"": solved(TABLES["narrow peak"])}, "balancing_torque")[""]
    load, dense = s.loads[1], np.linspace(0.0, 2 * np.pi, 20001)
    drawn = np.interp(dense, s.crank_angle, user_value(load, s), period=2 * np.pi)
    assert np.abs(drawn - user_value(load, s.at(dense))).max() < 1e-2 * 5e4


def test_both_sides_of_a_jump_are_drawn():
    s = with_peaks({"": solved(TABLES["jump"])}, "balancing_torque")[""]
    near = np.abs(s.crank_angle - np.pi) < 1e-12
    assert {-4e3, 0.0} <= set(user_value(s.loads[1], s)[near])


def test_curves_drawn_together_share_their_angles():
    first, second = with_peaks({"a": solved(), "b": solved(TABLES["kinks"])}, "balancing_torque").values()
    np.testing.assert_array_equal(first.crank_angle, second.crank_angle)
    assert first.crank_angle.size > TURN.size
    assert np.isin(TURN, first.crank_angle).all()


@every(("angles", "count"), [
    (np.linspace(2.0, 4.0, 11), 1), (np.linspace(-np.pi, np.pi, 37), 4), (np.linspace(0.0, 4 * np.pi, 73), 8),
    (TURN + 6.0, 4), (TURN + 2 * np.pi, 4),
])  # fmt: skip
def test_extremes_stand_wherever_the_curve_comes_by(angles, count):
    s = with_peaks({"": solved(angles=angles)}, "balancing_torque")[""]
    more = s.crank_angle[~np.isin(s.crank_angle, angles)]
    assert more.size == count
    assert angles[0] < more.min()
    assert more.max() < max(angles[-1], angles[0] + 2 * np.pi)
    places = ks.extremes(s, "balancing_torque").angle
    assert np.abs(np.mod(more, 2 * np.pi)[:, None] - places).min(axis=1).max() < 1e-9


def test_unknown_between_angles_is_kept():
    falling, one = solved(angles=TURN[::-1]), solved(angles=0.5)
    given = solved(1e3 * np.sin(TURN))
    odd = solved(lambda motion: 10.0 * motion.crank_angle)  # does not repeat after a turn
    for s in (falling, one, given, odd):
        assert with_peaks({"": s}, "O")[""] is s

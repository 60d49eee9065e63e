"""Where loads and friction of designs bend: all places, for each design its own."""

import numpy as np

import kinetostatics as ks
from kinetostatics.results.bends import bends, bent


def solved(loads=(), friction=None, crank=0.05, offset=0.01):
    pump = ks.crank_slider(crank, 0.19, guide_offset=offset, slider=ks.Link(1.0))
    return ks.solve(pump, np.zeros(1), crank_speed=30.0, loads=loads, friction=friction)


def test_rows_of_a_smooth_curve_bend_nothing_until_they_are_looked_at_more_closely():
    x = np.linspace(0.1, 0.3, 1100)
    one, other = (ks.ProcessForce(ks.Table(x, np.sin(20.0 * x), over="travel", back=back)) for back in (None, -x))
    assert not bent(solved([one]), "O")
    assert bent(solved([one]), "O", 1e-9)
    assert bends(solved([one]), 1e-9).angle.shape[1] > 500
    assert bends(solved([one, other])).angle.shape[1] == 2  # where strokes that differ may jump


def test_a_table_over_the_angle_bends_in_every_turn_of_the_period():
    x = np.arange(0.0, 6.1, 0.5)
    twice = ks.Torque(ks.Table(x, np.interp(x, [0.0, 1.0, 2.0, 6.0], [0.0, 1.0, 0.0, 0.0])), on="crank")
    four = ks.ProcessForce(ks.Table(np.linspace(0, 4 * np.pi, 9), np.zeros(9), period=4 * np.pi), period=4 * np.pi)
    at = np.unique(bends(solved([twice, four])).angle)
    assert {0.0, 1.0, 2.0, 2 * np.pi, 1.0 + 2 * np.pi, 2.0 + 2 * np.pi} <= set(at)


def test_no_bend_is_beyond_a_period_that_is_thirteen_turns_but_for_rounding():
    once = ks.Torque(ks.Table([0.0, 1.0, 2.0, 6.0], [0.0, 1.0, 0.0, 0.0]), on="crank")
    long = ks.ProcessForce(ks.Table(np.linspace(0, 26 * np.pi, 9), np.zeros(9), period=26 * np.pi), period=26 * np.pi)
    s = solved([once, long])
    at = bends(s).angle
    assert np.nanmax(at) < s.period
    assert np.sum(np.isclose(at % (2 * np.pi), 1.0)) == 13


def test_friction_of_designs_bends_for_each_where_it_does_alone():
    friction, crank = {"guide": ks.GuideFriction(0.1), "B": ks.PinFriction(0.1, 0.02)}, np.array([[0.03], [0.05]])
    both = np.sort(bends(solved((), friction, crank)).angle, axis=1)
    for row, length in zip(both, crank[:, 0], strict=True):
        alone = np.sort(bends(solved((), friction, float(length))).angle[0])
        np.testing.assert_allclose(row[: alone.size], alone, rtol=0, atol=1e-12)

"""Dynamic coefficients: ratios whose closed form is known."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.comparison import left_out


def yoke(mass, speed=10.0):
    return ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(mass)), np.zeros(1), crank_speed=speed)


def test_twice_the_mass_is_twice_every_force():
    found = ks.compare(yoke(6.0), yoke(3.0))
    assert found.mean_torque_ratio == pytest.approx(2.0, rel=1e-12)
    assert found.torque_extremum_ratios == pytest.approx(np.full(4, 2.0), rel=1e-9)
    assert found.peak_reaction_ratio("O") == pytest.approx(2.0, rel=1e-9)


def test_the_mean_torque_is_that_of_a_sine():
    """Of m r^2 omega^2 sin 2 phi / 2 the mean of the absolute value is 2 / pi times the largest."""
    reference, balanced = ks.compare(yoke(6.0), yoke(3.0, 5.0)).mean_torques
    assert reference == pytest.approx(6.0 * 0.01 * 100.0 / np.pi, rel=1e-9)
    assert balanced == pytest.approx(3.0 * 0.01 * 25.0 / np.pi, rel=1e-9)


@pytest.mark.slow
def test_extremum_of_rounding_is_shown_as_zero():
    """A press at its lower dead centre: there the torque has a kink, and is 0."""
    press = ks.crank_slider(0.1, 0.45, guide_angle=-np.pi / 2, coupler=ks.Link(38, 0.16, 0.9), slider=ks.Link(120))
    work = ks.ProcessForce(ks.Table([0.35, 0.53, 0.55], [0, 0, -200e3], over="travel", back=[0, 0, 0]))
    working, idle = (
        ks.Scene(press, 2 * np.pi, loads=loads).solve(24) for loads in ((ks.Gravity(), work), ks.Gravity())
    )
    found = ks.compare(working, idle)
    (row,) = np.flatnonzero(np.abs(found.torque_extremes[0].value) < 1e-6)
    table, other = found.frame(), ks.compare(working, working).frame()
    assert 0 < np.abs(found.torque_extremes[0].value[row]) < 1e-9  # rounding of 2e4 N m
    assert table.loc[f"torque extremum {row + 1}", "reference"] == 0.0
    assert np.isnan(other.loc[f"torque extremum {row + 1}", "ratio"])
    others = [f"torque extremum {k + 1}" for k in range(len(found.torque_extremum_ratios)) if k != row]
    assert np.array_equal(table.loc[others, "ratio"], np.delete(found.torque_extremum_ratios, row), equal_nan=True)


def test_table_has_a_row_a_coefficient_with_unit():
    table = ks.compare(yoke(6.0), yoke(3.0)).frame()
    row = table.loc["mean |balancing torque|"]
    assert (row["unit"], row["ratio"]) == ("N m", pytest.approx(2.0))
    assert table.loc["power residual", ["reference", "balanced"]].max() < 1e-12


@pytest.mark.slow
def test_unmatched_peak_has_a_row():
    """A press strikes where it idles without an extremum; the ratio of its peaks would be in no row."""
    press = ks.crank_slider(0.08, 0.4, slider=ks.Link(90.0))
    work = ks.ProcessForce(ks.Table([0.32, 0.47, 0.4701, 0.48], [0, 0, -30e3, -30e3], over="travel", back=[0] * 4))
    idle, working = (ks.solve(press, 0.0, crank_speed=6.0, loads=loads) for loads in ((), (work,)))
    row = ks.compare(idle, working).frame().loc["largest |balancing torque|"]
    assert row["balanced"] == pytest.approx(abs(ks.extremes(working, "balancing_torque").largest), rel=1e-12)
    assert row["ratio"] == pytest.approx(row["reference"] / row["balanced"], rel=1e-12)
    assert "largest |balancing torque|" not in ks.compare(idle, idle).frame().index


def test_two_sides_of_a_jump_match_no_extremum():
    """Friction makes the torque jump at dead centres, where it falls or rises on."""
    case = ks.load_case("sawframe_2r63_friction")
    plain, cam = (case.variants[name].solve(360) for name in ("plain", "cam-cosine"))
    assert len(ks.extremes(plain, "balancing_torque")) == 6
    found = ks.compare(plain, cam)
    reference, matched = found.torque_extremes
    np.testing.assert_allclose(np.degrees(reference.angle), [39.025, 125.585, 233.765, 320.438], atol=1e-3)
    assert (reference.value * matched > 0).all()
    assert (found.torque_extremum_ratios > 6.0).all()


@pytest.mark.slow
def test_extremum_of_the_reference_alone_is_unmatched():
    """The toggle press turns 1640 N m into force where it idles with no extremum; both its minima are none of one."""
    case = ks.load_case("toggle_press")
    found = case.compare("coining", "idle")
    reference, matched = found.torque_extremes
    assert np.isnan(matched).tolist() == [True, False, False, True]
    np.testing.assert_allclose(matched[1:3], reference.value[1:3], rtol=1e-9)
    table = found.frame()
    assert table.loc["torque extremum 1"].isna().tolist() == [False, False, True, True]
    assert table.loc["largest |balancing torque|", "idle"] == pytest.approx(192.07, abs=0.01)


def test_no_extremum_is_compared_with_two():
    case = ks.load_case("toggle_press")
    for names in (("coining", "idle"), ("idle", "coining")):
        _, matched = case.compare(*names).torque_extremes
        known = matched[np.isfinite(matched)]
        assert known.size == np.unique(known).size == 2


def test_extrema_half_a_turn_apart_are_not_matched():
    """A torque of sin phi, and the same reversed: its maximum stands where the other has its minimum."""
    level = ks.scotch_yoke(0.1, slider=ks.Link(1.0))
    pushed, pulled = (ks.solve(level, 0.0, crank_speed=1e-3, loads=ks.ProcessForce(f)) for f in (100.0, -100.0))
    assert np.isnan(ks.compare(pushed, pulled).torque_extremum_ratios).all()
    assert ks.compare(pushed, pushed).torque_extremum_ratios.tolist() == [1.0, 1.0]


def test_a_load_of_two_turns_is_compared_turn_by_turn():
    """Twice in its period the machine of one turn has the extrema that the other is compared with."""
    mass = ks.crank_slider(0.08, 0.4, slider=ks.Link(90.0))
    fires = ks.ProcessForce(lambda at: 40.0 * np.cos(at.crank_angle / 2), period=4 * np.pi)
    firing, plain = (ks.solve(mass, 0.0, crank_speed=6.0, loads=loads) for loads in (fires, ()))
    found = ks.compare(firing, plain)
    reference, matched = found.torque_extremes
    assert reference.angle.max() > 2 * np.pi
    assert np.isfinite(matched).all()
    assert (found.torque_extremum_ratios > 0.5).all()
    assert np.isfinite(ks.compare(plain, firing).torque_extremum_ratios).all()


@pytest.mark.slow
def test_bounds_stand_in_the_same_rows_and_columns():
    case = ks.load_case("toggle_press")
    found = case.compare("coining", "idle")
    values, bounds = found.frame(), found.error_bounds()
    assert (values.index.equals(bounds.index), list(values)) == (True, list(bounds))
    for row, name in (("largest reaction O", "O"), ("largest shaking moment", "shaking_moment")):
        for column, solution in (("coining", found.reference), ("idle", found.balanced)):
            extremes = ks.extremes(solution, name)
            wanted = extremes.error_bound[abs(extremes.value).argmax()]
            assert bounds.loc[row, column] == pytest.approx(wanted, rel=1e-12)
    row, errors = values.loc["largest reaction O"], bounds.loc["largest reaction O"]
    relative = sum(errors[name] / row[name] for name in ("coining", "idle"))
    assert errors["ratio"] == pytest.approx(relative * row["ratio"], rel=1e-12)
    assert bounds.loc["torque extremum 1", "coining"] < 1e-9  # of its own side of the jump
    assert np.isnan(bounds.loc["torque extremum 1", "idle"])
    assert np.isnan(bounds.loc["mean |balancing torque|", "coining"])


def test_table_of_many_extrema_keeps_the_ends():
    columns = np.array([np.sin(np.arange(40.0)), np.cos(np.arange(40.0)), np.full(40, np.nan)])
    rows = {f"torque extremum {number}": row for number, row in enumerate(columns.T, 1)}
    more = left_out(rows | {"largest O": [1e9, 1e9, np.nan]})
    kept = np.array([row for label, row in rows.items() if label not in more])
    assert "largest O" not in more
    assert len(more) + len(kept) == 40
    assert len(kept) <= 4
    for column, row in zip(columns[:2], kept.T, strict=False):
        assert {column.min(), column.max()} <= set(row)
    assert left_out(dict(list(rows.items())[20:])) == []

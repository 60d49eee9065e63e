"""Dynamic coefficients: ratios whose closed form is known."""

import numpy as np
import pytest

import kinetostatics as ks


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


def test_the_table_has_a_row_for_each_coefficient_with_its_unit():
    table = ks.compare(yoke(6.0), yoke(3.0)).frame()
    row = table.loc["mean |balancing torque|"]
    assert (row["unit"], row["ratio"]) == ("N m", pytest.approx(2.0))
    assert table.loc["power residual", ["reference", "balanced"]].max() < 1e-12


@pytest.mark.slow
def test_a_peak_that_no_extremum_of_the_reference_matches_has_a_row():
    """A press strikes where it idles without an extremum; the ratio of its peaks would be in no row."""
    press = ks.crank_slider(0.08, 0.4, slider=ks.Link(90.0))
    work = ks.ProcessForce(ks.Table([0.32, 0.47, 0.4701, 0.48], [0, 0, -30e3, -30e3], over="travel", back=[0] * 4))
    idle, working = (ks.solve(press, 0.0, crank_speed=6.0, loads=loads) for loads in ((), (work,)))
    row = ks.compare(idle, working).frame().loc["largest |balancing torque|"]
    assert row["balanced"] == pytest.approx(abs(ks.extremes(working, "balancing_torque").largest), rel=1e-12)
    assert row["ratio"] == pytest.approx(row["reference"] / row["balanced"], rel=1e-12)
    assert "largest |balancing torque|" not in ks.compare(idle, idle).frame().index


def test_the_two_sides_of_a_jump_on_a_flank_are_no_extremum_to_match():
    """Friction makes the torque jump at dead centres, where it falls or rises on."""
    case = ks.load_case("sawframe_2r63_friction")
    plain, cam = (case.variants[name].solve(360) for name in ("plain", "cam-cosine"))
    assert len(ks.extremes(plain, "balancing_torque")) == 6
    found = ks.compare(plain, cam)
    reference, matched = found.torque_extremes
    np.testing.assert_allclose(np.degrees(reference.angle), [39.025, 125.585, 233.765, 320.438], atol=1e-3)
    assert (reference.value * matched > 0).all()
    assert (found.torque_extremum_ratios > 6.0).all()

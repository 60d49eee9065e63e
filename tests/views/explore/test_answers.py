"""Numbers behind the curves: those of the library's own extremes, comparison, uncertainty and differences."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.constraints import parse_output
from kinetostatics.design.problem import true_value
from kinetostatics.views.explore import answers

PUMP = ks.crank_slider(0.05, 0.2, coupler=ks.Link(0.4, 0.1, 0.001), slider=ks.Link(1.0))
RUBBED = ks.Scene(PUMP, 100.0, loads=[ks.Gravity(), ks.ProcessForce(300.0)], friction={"O": ks.PinFriction(0.1, 0.01)})
HEAVIER = RUBBED.varied({"slider.mass": 2.0})
SAW = ks.load_case("sawframe_2r63").variants["cam-circle"].scene
DRAGGED = ks.Scene(PUMP, 100.0, loads=ks.Torque(5.0, on="coupler", opposing=True))
STILL = ks.Scene(ks.crank_slider(0.05, 0.2), 100.0)


@pytest.mark.parametrize("name", ["balancing_torque", "O", "slider_velocity"])
def test_extremes_are_those_of_the_library(name):
    solution, reference = RUBBED.solve(360), HEAVIER.solve(90)
    (row,) = answers.quantity_rows(solution, [name], answers.Reference(reference))
    low, low_at, high, high_at = row.extremes.ends
    found, other = ks.extremes(solution, name), ks.extremes(reference, name)
    assert (low, high) == pytest.approx(found.range, rel=1e-12)
    degrees = np.degrees(found.angle)
    assert min(abs(degrees - low_at)) < 1e-9
    assert min(abs(degrees - high_at)) < 1e-9
    assert row.range == high - low
    assert row.reference == pytest.approx(abs(other.largest), rel=1e-12)
    assert row.ratio == pytest.approx(abs(other.largest / found.largest), rel=1e-12)


@pytest.mark.slow
def test_figures_are_those_of_compare_and_means():
    solution, reference = RUBBED.solve(360), HEAVIER.solve(360)
    rows = {row.label: row for row in answers.figure_rows(solution, answers.Reference(reference))}
    table = ks.compare(reference, solution).frame()
    shared = [label for label in rows if label in table.index]
    assert {"mean |balancing torque|", "mean drive power", "torque extremum 1"} <= set(shared)
    for label in shared:
        row = rows[label]
        np.testing.assert_allclose([row.reference, row.value, row.ratio], list(table.loc[label].iloc[1:]), rtol=1e-12)
    assert rows["energy per turn"].value == solution.energy_per_turn


@pytest.mark.filterwarnings("ignore:.*no surface has this much friction")
def test_what_jams_has_no_mean_and_says_why():
    jammed = ks.Scene(PUMP, 100.0, loads=ks.ProcessForce(3e3), friction={"guide": ks.GuideFriction(4.5)})
    rows = list(answers.figure_rows(jammed.solve(360, on_gap="nan")))
    assert all("jams" in row.problem and np.isnan(row.value) for row in rows)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("scene", "text"),
    [
        (RUBBED, "largest_absolute balancing_torque"),
        (RUBBED, "mean balancing_torque"),
        (RUBBED, "largest O"),
        (SAW, "mean_absolute balancing_torque"),
        (DRAGGED, "largest_absolute balancing_torque"),
    ],
)
def test_sensitivities_agree_with_differences(scene, text):
    found = answers.sensitivities(scene, text)
    own = scene.parameters
    assert {row.path for row in found.rows} == set(own)
    for path in ("slider.mass", "coupler.mass", "coupler_length", "crank_speed", "guide_offset"):
        step = 1e-5 * (own[path] or 1.0)

        def value(moved, path=path):
            return true_value(parse_output(text, scene), scene.varied({path: moved}))

        slope = (value(own[path] + step) - value(own[path] - step)) / (2 * step)
        (row,) = [row for row in found.rows if row.path == path]
        assert row.slope == pytest.approx(slope, rel=1e-4, abs=1e-6 * abs(found.value))
        if own[path]:
            assert row.share == pytest.approx(row.slope * own[path] / found.value)
        else:
            assert np.isnan(row.share)


@pytest.mark.slow
def test_sensitivities_are_sorted_with_zeros_apart():
    shares = [row.share for row in answers.sensitivities(SAW, "largest O").rows]
    known = [abs(share) for share in shares if not np.isnan(share)]
    assert known == sorted(known, reverse=True)
    assert len(known) < len(shares)
    assert np.isnan(shares[len(known) :]).all()


@pytest.mark.slow
def test_an_output_that_is_zero_has_slopes_but_no_shares():
    found = answers.sensitivities(STILL, "largest O")
    assert found.value == 0.0
    assert np.isnan([row.share for row in found.rows]).all()


@pytest.mark.parametrize(
    ("values", "text", "words"),
    [
        ({}, "largest Q", "allowed"),
        ({}, "largest_at O", "jumps"),
        ({"coupler_length": 0.03}, "largest O", "cannot be assembled|does not close"),
    ],
)
def test_sensitivities_that_do_not_exist_are_refused(values, text, words):
    with pytest.raises(ks.KinetostaticsError, match=words):
        answers.sensitivities(RUBBED.varied(values), text)


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_sensitivities_where_digits_are_lost_are_refused():
    """With equal bars the slider passes O: its length decides how the machine goes on there."""
    equal = ks.Scene(ks.crank_slider(0.1, 0.1, slider=ks.Link(1.0)), 10.0)
    with pytest.raises(ks.DesignError, match=r"no derivatives.*90, 270 deg"):
        answers.sensitivities(equal, "mean_absolute balancing_torque")


def test_bands_are_two_standard_uncertainties_wide():
    solution, inputs = RUBBED.solve(24), {"slider.mass": 0.01, "crank_length": 1e-5}
    torque, force = answers.bands(solution, ["balancing_torque", "O"], inputs)
    reach = solution.uncertainty("balancing_torque", inputs).tolerance
    np.testing.assert_allclose(torque.high - torque.low, 4.0 * reach, rtol=1e-9)
    np.testing.assert_allclose((torque.high + torque.low) / 2, solution.balancing_torque, rtol=1e-12)
    reach = solution.uncertainty("|O|", inputs).tolerance
    np.testing.assert_allclose(force.high - np.hypot(*solution.reaction("O")), 2.0 * reach, rtol=1e-6)
    assert (force.low >= 0.0).all()


def test_a_band_says_where_first_order_is_too_low():
    (band,) = answers.bands(RUBBED.solve(24), ["slider_velocity"], {"coupler_length": 0.1})
    assert "first order" in band.note


def test_uncertainties_of_a_case_are_standard_deviations_in_si():
    spreads = {"slider.mass": "normal 600 kg +- 5 kg", "crank_length": "290..310 mm", "cam.radius": "1..2 mm"}
    scene = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5)
    found = answers.standard_uncertainties(spreads, scene)
    assert found == pytest.approx({"slider.mass": 5.0, "crank_length": 0.02 / np.sqrt(12)})

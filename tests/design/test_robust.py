"""Quantiles over spreads: what designs are worth as they are made and run."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design.constraints import parse_output
from kinetostatics.design.problem import Problem
from kinetostatics.design.robust import SampledOutput, harrell_davis_weights
from support.case_files import shipped

pytestmark = pytest.mark.slow

SAW = shipped("sawframe_2r63")
RATIO = "ratio mean_absolute balancing_torque"
SPREADS = {
    "spring.stiffness": "normal 0 % +- 0.5 %",
    "crank_speed": "normal 0 % +- 1 %",
    "slider.mass": "normal 0 % +- 1 %",
    "spring.free_position": "normal 0 mm +- 0.5 mm",
}
CIRCLE = SPREADS | {"cam.radius": "normal 0 mm +- 0.05 mm"}
HARMONIC = SPREADS | {"cam.cosine.0": "normal 0 mm +- 0.05 mm"}


def ks_quantile(found, trim=0.0):
    spread = ks.design.Spread(0.05, HARMONIC, trim=trim)
    return np.quantile(ks.design.over_spread(found.scene, RATIO, spread, reference=found.reference, samples=512), 0.05)


def test_spread_outputs_equal_single_machines():
    spread = ks.design.Spread(0.05, {"spring.stiffness": "-5..5 %", "slider.mass": "-10..10 kg"}, seed=4)
    found = ks.design.over_spread(SAW, RATIO, spread, variant="cam-circle", samples=16)
    from scipy.stats import qmc

    uniform = qmc.Sobol(2, rng=4).random(16)
    circle, plain = SAW.variant("cam-circle").scene, SAW.variant("plain").scene
    for value, (one, other) in zip(found, uniform, strict=True):
        mass = 600.0 + 20.0 * (other - 0.5)
        design = circle.varied(
            {"spring.stiffness": circle.parameters["spring.stiffness"] * (1 + 0.1 * (one - 0.5)), "slider.mass": mass}
        )
        means = [
            np.mean(np.abs(scene.solve(2880).balancing_torque))
            for scene in (plain.varied({"slider.mass": mass}), design)
        ]
        assert_allclose(value, means[0] / means[1], rtol=2e-4)


def test_blocks_of_samples_with_kinks_do_not_matter(monkeypatch):
    spread = ks.design.Spread(0.9, {"slider.mass": "normal 0 % +- 2 %"})
    found = []
    for values in (100_000, 2_000):
        monkeypatch.setattr("kinetostatics.solution.piecewise_turns.BLOCK_VALUES", values)
        case = shipped("sawframe_2r63_friction")
        found.append(ks.design.over_spread(case, "largest O", spread, variant="cam-circle", samples=16))
    assert np.array_equal(*found)


def test_studys_design_has_the_quantile_of_the_study():
    spread = ks.design.Spread(0.05, CIRCLE)
    found = ks.design.over_spread(SAW, RATIO, spread, variant="cam-circle", samples=1024)
    assert_allclose(np.quantile(found, 0.05), 5.2, atol=0.15)


def test_quantile_derivatives_equal_small_changes():
    vary = {"spring.stiffness": (6e5, 9e5), "cam.centre.x": (-0.03, -0.01)}
    circle = SAW.variant("cam-circle")
    problem = Problem(circle, vary, ["balancing_torque"], SAW.variant("plain"))
    for trim in (0.0, 0.02):
        goal = SampledOutput(problem, parse_output(RATIO, circle.scene), ks.design.Spread(0.1, CIRCLE, 32, trim), -1.0)
        point = np.array([7.9e5, -0.021])
        _, slopes = goal(point)
        for place, step in enumerate((30.0, 2e-6)):
            move = step * np.eye(2)[place]
            high, low = (goal(point + side * move)[0] for side in (1, -1))
            assert_allclose(slopes[place], (high - low) / (2 * step), rtol=5e-3)


def test_trim_takes_the_best_speed_of_each_machine():
    spread = ks.design.Spread(0.05, {"slider.mass": "normal 0 % +- 1 %"}, trim=0.03, seed=2)
    found = ks.design.over_spread(SAW, RATIO, spread, variant="cam-circle", samples=4)
    from scipy.stats import norm, qmc

    circle, plain = SAW.variant("cam-circle").scene, SAW.variant("plain").scene
    for value, uniform in zip(found, qmc.Sobol(1, rng=2).random(4).ravel(), strict=True):
        mass = {"slider.mass": 600.0 * (1 + 0.01 * norm.ppf(uniform))}
        ratios = []
        for speed in circle.crank_speed * np.linspace(0.97, 1.03, 61):
            means = [
                np.mean(np.abs(scene.varied(mass | {"crank_speed": speed}).solve(360).balancing_torque))
                for scene in (plain, circle)
            ]
            ratios.append(means[0] / means[1])
        assert_allclose(value, max(ratios), rtol=1e-3)


def test_robust_design_keeps_more_than_nominal():
    """Cubic spring, cam force at most 20 kN: 5 % of machines fall below 33, of every good linear design below 24."""
    common = {"variant": "cam-cosine"}
    linear = ks.design.torque_free_cam(SAW, 4, 4, **common)
    robust = ks.design.torque_free_cam(
        SAW, 4, 4, maximise=RATIO, limits="largest_absolute cam_force <= 20 kN", cubic=(0, 2e7),
        robust=ks.design.Spread(0.05, HARMONIC, samples=32), **common,
    )  # fmt: skip
    assert 22 < ks_quantile(linear) < 24
    assert ks_quantile(robust) >= 32.5
    row = robust.report().loc[f"0.05 quantile of {RATIO} [1]"]
    assert_allclose(row["after"], max(robust.starts), rtol=1e-9)
    assert np.isnan(row["before"])  # the plain saw has no cam to spread
    assert f"0.05 quantile of {RATIO} [1]" not in linear.report().index
    assert max(map(abs, ks.extremes(robust.scene.solve(90), "cam_force").range)) <= 20e3 * (1 + 1e-9)
    assert ks_quantile(linear, trim=0.03) >= 125


def test_a_report_tells_the_quantile_before_and_after():
    spread = ks.design.Spread(0.05, CIRCLE, samples=32)
    circle = {"variant": "cam-circle"}
    found = ks.design.optimise(SAW, {"spring.stiffness": (6e5, 9e5)}, maximise=RATIO, robust=spread, **circle)
    row = found.report().iloc[0]
    assert row.name == f"0.05 quantile of {RATIO} [1]"
    assert_allclose(row["after"], found.starts[0], rtol=1e-9)
    samples = ks.design.over_spread(SAW, RATIO, spread, samples=32, **circle)
    assert np.sort(samples)[0] < row["before"] < np.sort(samples)[3]
    assert row["before"] < row["after"]


def test_peaks_beside_kinks_are_seen_in_each_machine():
    """A force on less than a thousandth of the turn, which even samples miss in most machines."""
    table = ks.Table([0.1, 0.2, 0.20002, 0.20004, 0.3], [0.0, 0.0, 3e3, 0.0, 0.0], over="travel")
    made = ks.crank_slider(0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0))
    friction = {"O": ks.PinFriction(0.1, 0.02)}
    scene = ks.Scene(made, 30.0, loads=[ks.Gravity(), ks.ProcessForce(table)], friction=friction)
    spread = ks.design.Spread(0.9, {"slider.mass": "normal 0 % +- 5 %"}, samples=16)
    output = "largest balancing_torque"
    found = ks.design.over_spread(scene, output, spread, samples=16)
    sampled = SampledOutput(
        Problem(scene, {"crank_length": (0.04, 0.06)}, ["balancing_torque"]), parse_output(output, scene), spread, 1.0
    )
    mass = 2.0 * (1.0 + sampled._deviations["slider.mass"])
    for value, own in zip(found, mass, strict=True):
        truth = ks.extremes(scene.varied({"slider.mass": own}).solve(4), "balancing_torque").range[1]
        assert value == pytest.approx(truth, rel=1e-8)
    value, slopes = sampled(np.array([0.05]))
    above, below = (sampled(np.array([length]))[0] for length in (0.05 + 1e-6, 0.05 - 1e-6))
    assert value == pytest.approx(np.quantile(found, 0.9), rel=0.02)
    assert slopes[0] == pytest.approx((above - below) / 2e-6, rel=1e-3)


# How numbers spread


def test_quantile_weights_sum_to_one():
    weights = harrell_davis_weights(0.05, 4096)
    assert weights.sum() == pytest.approx(1.0, abs=1e-12)
    assert weights @ np.linspace(0, 1, 4096) == pytest.approx(0.05, abs=1e-3)


def test_trim_refuses_outputs_with_kinks():
    pulse = ks.Table(np.radians([0.0, 99.9, 100.0, 100.5, 100.6, 360.0]), [0.0, 0.0, -1e5, -1e5, 0.0, 0.0])
    scene = ks.Scene(ks.crank_slider(0.3, 1.1, slider=ks.Link(10.0)), 30.0, loads=ks.ProcessForce(pulse))
    spread = ks.design.Spread(0.5, {"slider.mass": "normal 0 % +- 1 %"}, trim=0.02)
    with pytest.raises(ks.ParameterError, match="trim needs outputs without kinks, but loads, friction or a cam"):
        ks.design.over_spread(scene, "largest_absolute balancing_torque", spread, samples=16)

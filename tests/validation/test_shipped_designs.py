"""Shipped machines that the library found: found again by the designs beside them, and as good as their files say."""

from dataclasses import replace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.constraints import parse_constraints
from kinetostatics.design.problem import true_value
from support.case_files import shipped

pytestmark = pytest.mark.slow

RATIO = "ratio mean_absolute balancing_torque"
CASES = "sawframe_2r63_optimal", "mower_drive_optimal"
SEARCHED = [
    ("sawframe_2r63", "upright-optimal"),
    ("sawframe_2r63_optimal", "cam-optimal"),
    ("mower_drive_optimal", "cam-optimal"),
    ("mower_drive_optimal", "cam-in-line"),
]


def quantile(case, name, samples=512):
    spread = case.designs["cam-robust"].spread
    return np.quantile(ks.design.over_spread(case, RATIO, spread, variant=name, samples=samples), 0.05)


def gain(case, name):
    torques = (np.abs(case.solve(item, 5760).balancing_torque).mean() for item in (case.reference, name))
    return next(torques) / next(torques)


@pytest.mark.parametrize(("name", "variant"), SEARCHED)
def test_its_search_finds_the_shipped_machine_again(name, variant):
    """Within 10 micrometres and 1e-5 of the spring's rate: processors round differently."""
    case = shipped(name)
    kept = case.variant(variant).scene
    found = case.designs[variant].find().scene.parameters
    for path, value in kept.parameters.items():
        tolerance = 1e-5 * max(abs(value), 1.0)
        assert found[path] == pytest.approx(value, abs=tolerance), path


@pytest.mark.parametrize("name", CASES)
def test_smaller_search_nearly_finds_the_robust_one(name):
    """With a quarter of the machines: spring within 2 %, lengths within 0.3 mm, the gain that 95 % keep within 1."""
    case = shipped(name)
    design = case.designs["cam-robust"]
    few = design.table.robust.model_copy(update={"samples": 16})
    design = replace(design, table=design.table.model_copy(update={"robust": few}))
    found, kept = design.find(), case.variant("cam-robust").scene.parameters
    assert found.values["spring.cubic"] == pytest.approx(kept["spring.cubic"], rel=0.02)
    for path in ("coupler_length", "spring.free_position", "cam.cosine.0"):
        assert found.values[path] == pytest.approx(kept[path], abs=3e-4), path
    again = ks.design.over_spread(found.scene, RATIO, design.spread, reference=found.reference, samples=512)
    assert np.quantile(again, 0.05) == pytest.approx(quantile(case, "cam-robust"), abs=1.0)


def test_saws_gain_what_their_file_says():
    case = shipped("sawframe_2r63_optimal")
    assert gain(case, "cam-optimal") == pytest.approx(411.4, abs=0.1)
    assert quantile(case, "cam-optimal") == pytest.approx(23, abs=0.5)
    assert quantile(case, "cam-robust") == pytest.approx(34, abs=1.0)


def test_mowers_gain_what_their_file_says():
    case = shipped("mower_drive_optimal")
    assert gain(case, "cam-in-line") > 1e5
    assert gain(case, "cam-optimal") > 400
    assert quantile(case, "cam-optimal") == pytest.approx(23, abs=0.5)
    assert quantile(case, "cam-robust") == pytest.approx(34, abs=1.0)


@pytest.mark.parametrize("name", [*CASES, "sawframe_2r63"])
def test_shipped_designs_keep_limits_and_stroke(name):
    case = shipped(name)
    for design in case.designs.values():
        scene, source = case.variant(design.name).scene, case.variant(design.source).scene
        before, after = (ks.extremes(item.solve(90), "slider_position").range for item in (source, scene))
        np.testing.assert_allclose(after, before, rtol=0, atol=1e-9)
        for limit in parse_constraints(design.table.limits, scene):
            excess = true_value(limit.output, scene) - limit.value
            excess = {"=": abs(excess), "<=": excess, ">=": -excess}[limit.relation]
            assert excess <= 1e-9 * abs(limit.value), limit


@pytest.mark.parametrize(
    ("name", "study", "variants"),
    [
        ("sawframe_2r63_optimal", "sawframe_2r63", ("plain", "cam-cosine")),
        ("mower_drive_optimal", "mower_drive", ("unbalanced",)),
    ],
)
def test_what_they_are_compared_with_is_the_study(name, study, variants):
    for variant in variants:
        one, other = (ks.load_case(item).solve(variant, 36).balancing_torque for item in (name, study))
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * np.abs(other).max())

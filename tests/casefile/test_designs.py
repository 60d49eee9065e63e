"""Designs of case files: found as by Python, written ready to run, and every problem told at once."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.designs import write_found
from support.case_files import DUTIES, FRONT, STIFFER, saw_with, shipped
from support.every import every


def test_a_design_of_a_file_finds_what_python_finds(tmp_path):
    case = ks.load_case(saw_with(STIFFER, tmp_path))
    found = case.designs["stiffer"].find()
    by_hand = ks.design.optimise(
        shipped("sawframe_2r63"),
        {"spring.stiffness": (6e5, 9e5)},
        maximise="ratio mean_absolute balancing_torque",
        variant="cam-circle",
        angles=72,
    )
    assert found.values == by_hand.values


@pytest.mark.slow
def test_a_torque_free_cam_of_a_file_is_that_of_python(tmp_path):
    text = (
        '[design.cam]\nkind = "torque-free-cam"\nvariant = "cam-cosine"\ncosine = 2\nminimise = "rms balancing_torque"'
    )
    found = ks.load_case(saw_with(text, tmp_path)).designs["cam"].find()
    saw = shipped("sawframe_2r63")
    by_hand = ks.design.torque_free_cam(saw, 2, variant="cam-cosine", minimise="rms balancing_torque")
    assert found.values == by_hand.values


@pytest.mark.slow
def test_found_designs_record_their_origin(tmp_path):
    case = ks.load_case(saw_with(STIFFER + FRONT, tmp_path))
    found = {name: item.find() for name, item in case.designs.items()}
    again = ks.load_case(write_found(tmp_path / "again.toml", case, found))
    assert list(again.variants) == ["plain", "cam-circle", "stiffer", "trade-1", "trade-2"]
    assert {str(item.motor) for item in again.variants.values()} == {str(case.variants["plain"].motor)}
    for name, scene in (("stiffer", found["stiffer"].scene), ("trade-2", found["trade"].designs[1].scene)):
        torque = again.solve(name, 24).balancing_torque
        np.testing.assert_array_equal(torque, scene.solve(24).balancing_torque)
    once_more = again.designs["stiffer"].find()
    assert once_more.values == pytest.approx(found["stiffer"].values, rel=1e-9)
    for name, item in case.designs.items():
        assert again.designs[name].raw == item.raw | {"variant": "cam-circle", "reference": "plain"}


@pytest.mark.slow
def test_duties_of_a_file_are_those_of_python(tmp_path):
    """Written with a variant for each duty, found again; the cutting force is an addition to the circular cam."""
    more = DUTIES.replace("shared", "front").replace("angles = 72", "angles = 72\npoints = 2")
    more = more.partition("[design")[2].replace('"optimum"', '"front"').replace("maximise", "minimise")
    goals = '["largest O", "-ratio mean_absolute balancing_torque"]'
    more = "[design" + more.replace('"ratio mean_absolute balancing_torque"', goals)
    case = ks.load_case(saw_with(DUTIES + more, tmp_path))
    design = case.designs["shared"]
    assert design.sources == {"cam-circle": "plain", "cutting": "plain"}
    found = design.find()
    by_hand = ks.design.optimise(
        {name: (case.variants[name], share) for name, share in (("cam-circle", 0.25), ("cutting", 0.75))},
        {"spring.stiffness": (6e5, 9e5)},
        maximise="ratio mean_absolute balancing_torque",
        limits=["cutting: largest O <= 40 kN"],
        reference=case.variants["plain"],
        angles=72,
    )
    assert found.values == by_hand.values
    front = case.designs["front"].find()
    again = ks.load_case(write_found(tmp_path / "again.toml", case, {"shared": found, "front": front}))
    ends = [f"{name}-{duty}" for name in ("shared", "front-1", "front-2") for duty in design.sources]
    assert list(again.variants) == ["plain", "cam-circle", "cutting", *ends]
    np.testing.assert_allclose(
        again.solve("shared-cutting", 24).balancing_torque, found.scene["cutting"].solve(24).balancing_torque, rtol=1e-9
    )
    assert again.designs["shared"].find().values == pytest.approx(found.values, rel=1e-6)
    assert again.designs["front"].raw == case.designs["front"].raw


@pytest.mark.slow
@every(
    ("change", "message"),
    [
        (("0.25", "0.35"), "design.shared.duties: the shares must sum to 1, got 1.1: cam-circle 0.35, cutting 0.75"),
        (("0.25", "-0.25"), "design.shared.duties: share of cam-circle must be greater than 0, got -0.25"),
        (("cam-circle = ", "cam-circel = "), "design.shared.duties is 'cam-circel', allowed: .* 'cam-circle'"),
        (("cam-circle = ", "upright-plain = "), "of cutting, a cam-.*, differ from those of upright-plain"),
        (("cutting: largest", "cuting: largest"), r"limits\[1\]: duty is 'cuting', allowed: .* did you mean 'cutting'"),
        (("cutting: largest O", "cutting: larges O"), r"shared.limits\[1\]: output 'larges O'"),
        (('"spring.stiffness"', '"process_force.force"'), "shared.vary: parameter is 'process_force.force'"),
        (("angles = 72", 'angles = 72\nvariant = "plain"'), "design.shared has variant and duties: give one"),
        (("cam-circle = 0.25", "shared = 0.25"), "design.shared.duties is the name of the result: give another"),
    ],
)
def test_faults_of_duties_are_told_with_their_key(tmp_path_factory, change, message):
    folder = tmp_path_factory.mktemp("duties")
    with pytest.raises(ks.CaseError, match=message):
        ks.load_case(saw_with(DUTIES.replace(*change), folder))


def test_first_other_variant_is_varied_by_default(tmp_path):
    text = '[design.cam-circle]\nkind = "torque-free-cam"\ncosine = 2'
    assert ks.load_case(saw_with(text, tmp_path)).designs["cam-circle"].source == "cam-cosine"


@pytest.mark.slow
def test_default_variation_is_written_out(tmp_path):
    text = '[design.one]\nkind = "torque-free-cam"\ncosine = 1\nminimise = "rms balancing_torque"\n'
    case = ks.load_case(saw_with(text + text.replace("one", "two"), tmp_path))
    found = {name: item.find() for name, item in case.designs.items()}
    again = ks.load_case(write_found(tmp_path / "again.toml", case, dict(reversed(found.items()))))
    assert {item.source for item in again.designs.values()} == {"cam-circle"}


def test_cases_without_designs_have_none():
    assert not shipped("pumpjack").designs


def test_impossible_stroke_is_refused_with_numbers(tmp_path):
    text = '[design.cam]\nkind = "torque-free-cam"\nends = ["0 m", "2 m"]\n'
    case = ks.load_case(saw_with(text, tmp_path))
    with pytest.raises(ks.DesignError, match="from 0 m to 2 m; lengthen the coupler or shorten the stroke"):
        case.designs["cam"].find()

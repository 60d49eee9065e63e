"""Designs as case files: read back they are the same to the last bit."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design import case_text
from support.case_files import shipped

CASES = ("sawframe_2r63", "mower_drive", "chain_unit", "in_line_twin")


@pytest.mark.parametrize("name", CASES)
def test_shipped_scenes_written_and_read_are_the_same(tmp_path, name):
    case = shipped(name)
    scenes = {variant: item.scene for variant, item in case.variants.items()}
    read = ks.load_case(case_text.write_case(tmp_path / "again.toml", case.title, scenes))
    assert read.title == case.title
    for variant, item in case.variants.items():
        np.testing.assert_array_equal(read.solve(variant, 24).balancing_torque, item.solve(24).balancing_torque)


@pytest.mark.slow
def test_groups_loads_and_friction_are_written(tmp_path):
    bar, link = ks.Link(2.0, (0.1, 0.02), 0.01), ks.Link(1.0)
    cam = ks.cams.Harmonic((0.1, 0.01), (0.002,), 0.3)
    groups = (
        ks.CamRoller(cam, link, ks.Roller(0.01, 0.02, 210e9, 0.3, cam_youngs_modulus=110e9)),
        ks.SliderGroup(0.4, ks.Guide.at(0.3, 0.01), coupler=bar, slider=link),
        ks.Pin("coupler", (0.2, 0.05), name="C"),
        ks.Dyad(0.3, 0.35, on=("C", "B"), pin="D", link1=bar)
        if "link1" in ks.Dyad.RULES.rules
        else ks.Dyad(0.3, 0.35, on=("C", "B"), pin="D"),
    )
    loads = (
        ks.Gravity(9.7, -1.5),
        ks.Spring(1e3, 0.4, cubic=2e4),
        ks.ProcessForce(-30.0),
        ks.Force(5.0, at=("coupler", 0.1, 0.0), direction=0.4),
        ks.PointSpring(200.0, 0.1, between=("C", (1.0, 0.5))),
        ks.PointDamper(3.0, between=("A", (1.0, 0.5))),
        ks.TorsionSpring(4.0, 0.2, on="coupler", against="slider", moment=1.0),
        ks.TorsionDamper(0.1, on="crank"),
        ks.Torque(2.0, on="coupler"),
    )
    friction = {"O": ks.PinFriction(0.1, 0.01), "guide": ks.GuideFriction(0.05, 0.1)}
    scene = ks.Scene(ks.Mechanism("odd one", ks.Crank(None, link), groups), 12.0, 3.0, loads, friction)
    read = ks.load_case(case_text.write_case(tmp_path / "odd.toml", "Odd", {"one": scene})).variant("one").scene
    assert read.mechanism.name == "odd one"
    for name in ("O", "guide", "D", "cam_force", "contact_pressure", "balancing_torque"):
        one, other = (ks.extremes(item.solve(12), name).range for item in (scene, read))
        np.testing.assert_allclose(one, other, rtol=1e-12)


@pytest.mark.slow
def test_a_design_is_written_with_its_reference(tmp_path):
    saw = ks.load_case("sawframe_2r63")
    found = ks.design.torque_free_cam(saw, 2, 2, minimise="rms balancing_torque")
    path = found.case(tmp_path / "better.toml", name="better")
    case = ks.load_case(path)
    assert list(case.variants) == ["reference", "before", "better"]
    ratio = case.compare("reference", "better").frame().iloc[0]["ratio"]
    after = found.report().loc["ratio mean_absolute balancing_torque [1]", "after"]
    assert ratio == pytest.approx(after, rel=1e-5)
    assert case.variant("better").parameters["cam.sine.1"] == found.values["cam.sine.1"]


@pytest.mark.parametrize(
    ("load", "message"),
    [
        (ks.ProcessForce(lambda motion: 0.0 * motion.crank_angle), "force must be one number"),
        (ks.Torque(lambda motion: 0.0 * motion.crank_angle, on="crank"), "value must be one number"),
    ],
)
def test_what_case_files_have_no_text_for_is_refused(tmp_path, load, message):
    scene = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 10.0, loads=load)
    with pytest.raises(ks.ParameterError, match=message):
        case_text.write_case(tmp_path / "no.toml", "No", {"one": scene})
    assert not (tmp_path / "no.toml").exists()


TWO_TURNS = ks.Table(np.arange(8) * np.pi / 2, np.cos(np.arange(8.0)), period=4 * np.pi)
DIAGRAM = ks.Table([0.1, 0.2, 0.3], [-900.0, -500.0, 1 / 3], over="travel", back=[0.0, 1.0, 0.0], slider="slider")


@pytest.mark.slow
def test_tables_are_written_to_files_beside_it(tmp_path):
    angle = np.linspace(0, 2 * np.pi, 90, endpoint=False)
    cam = ks.cams.Sampled(angle, 0.1 + 0.01 * np.cos(angle) + 1e-9 * np.cos(40 * angle), noise=1e-9)
    follower = ks.Mechanism("bare", ks.Crank(None), (ks.CamRoller(cam, ks.Link(2.0)),))
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))
    loads = [ks.Gravity(), ks.ProcessForce(TWO_TURNS, period=4 * np.pi), ks.Torque(TWO_TURNS, on="coupler")]
    after_tdc = ks.ProcessForce(ks.Table([0.0, 2.0, 4.0], [-3.0, -7.0, -1.0], zero="TDC", sense=-1))
    scenes = {
        "engine": ks.Scene(pump, -10.0, loads=after_tdc),
        "cam": ks.Scene(follower, 10.0),
        "two turns": ks.Scene(pump, 10.0, loads=loads),
        "diagram": ks.Scene(pump, 10.0, loads=ks.ProcessForce(DIAGRAM)),
    }
    read = ks.load_case(case_text.write_case(tmp_path / "made.toml", "Made", scenes))
    files = {"engine_load_1", "cam_cam", "two-turns_load_1", "two-turns_load_2", "diagram_load_1"}
    assert {path.stem.removeprefix("made_") for path in tmp_path.glob("*.csv")} == files
    for name, scene in scenes.items():
        one, other = scene.solve(360), read.variant(name).scene.solve(360)
        assert one.period == other.period
        np.testing.assert_allclose(other.balancing_torque, one.balancing_torque, rtol=1e-13, atol=1e-13)
    case_text.write_case(tmp_path / "made.toml", "Made again", scenes)
    with pytest.raises(ks.errors.FileError, match=r"made_engine_load_1\.csv: exists already"):
        case_text.write_case(tmp_path / "made.toml", "Made", {"engine": scenes["diagram"]})


@pytest.mark.parametrize("points", [((0.6, 0.35), (0.6, -0.25)), ((0.1, -0.02), (1.0, -0.02)), ((0, 0), (0, 1))])
def test_a_guide_along_an_axis_keeps_its_direction(tmp_path, points):
    guide = ks.Guide.through(*points)
    scene = ks.Scene(ks.crank_slider(0.05, 0.2, guide=ks.Guide(None, 0.0, guide.exact)), 10.0)
    offset = ks.Guide(None, guide.guide_offset, guide.exact)
    chain = ks.Mechanism("chain", ks.Crank(0.05), (ks.SliderGroup(2.0, offset),))
    scenes = {"slider": scene, "chain": ks.Scene(chain, 10.0)}
    read = ks.load_case(case_text.write_case(tmp_path / "made.toml", "Made", scenes))
    for name, scene in scenes.items():
        (one,), (other,) = scene.mechanism.guides.values(), read.variant(name).mechanism.guides.values()
        assert (other.exact, other.guide_offset) == (one.exact, one.guide_offset)


def test_a_cam_of_ones_own_is_refused(tmp_path):
    cam = ks.cams.from_law(ks.laws.cosine(0.3, 2.0))
    scene = ks.Scene(ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(1.0)), 10.0)
    with pytest.raises(ks.ParameterError, match="no text for a cam of the class LawCam"):
        case_text.write_case(tmp_path / "no.toml", "No", {"one": scene})

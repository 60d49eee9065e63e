"""Variants of a case: how they are built, named and varied."""

import copy
import pickle
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.build import build_guide, build_link
from kinetostatics.casefile.variant import NoSuchNameError
from support.case_chains import EXAMPLES, IN_PYTHON
from support.case_files import shipped
from support.every import every


def test_derived_numbers_follow_and_stated_ones_stay():
    saw = shipped("sawframe_2r63").variants["cam-circle"]
    heavier = saw.varied({"slider.mass": 660.0})
    (_, before), (_, after) = saw.loads, heavier.loads
    assert after.stiffness / before.stiffness == pytest.approx(1.1, rel=1e-14)
    assert heavier.mechanism.links["coupler"].mass == saw.mechanism.links["coupler"].mass


def test_numbers_are_told_with_their_units():
    saw = shipped("sawframe_2r63").variants["cam-circle"]
    assert (saw.parameters["slider.mass"], saw.units["slider.mass"]) == (600.0, "kg")
    assert saw.parameters["coupler.centre"] == "mid-length"


# A variant made a scene


HEAD = """
title = "t"
reference = "a"
[variants.a]
crank_speed = "60 rpm"
slider = { mass = "10 kg" }
"""
SAW = HEAD + 'mechanism = "crank-slider"\ncrank_length = "300 mm"\ncoupler_length = "2 m"\n'


def variant(folder, text):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return ks.load_case(path).variant("a")


def test_the_law_of_a_cam_gives_the_length_left_out(tmp_path):
    text = HEAD + 'mechanism = "cam-crank-slider"\ncam = { kind = "cosine-law", amplitude = "0.3 m", mean = "2 m" }\n'
    (group,) = variant(tmp_path, text).mechanism.groups[1:]
    assert group.coupler_length == ks.cams.CosineLaw(0.3, 2.0).coupler_length
    with pytest.raises(ks.CaseError, match="only a cosine-law cam determines it"):
        variant(tmp_path, HEAD + 'mechanism = "cam-crank-slider"\ncam = { kind = "circle", radius = "0.3 m" }\n')


def test_balancing_needs_a_counterweight_on_the_crank(tmp_path):
    text = SAW + '[variants.a.balancing]\nmethod = "full"\ncoupler = { arm = "-0.2 m" }\n'
    with pytest.raises(ks.CaseError, match=r"needs a counterweight on the crank|balancing"):
        variant(tmp_path, text)


# Names of variants and designs that a case has not


CASE = shipped("sawframe_2r63")


@every(
    "ask",
    [
        lambda case: case.variants["plane"],
        lambda case: case.variant("plane"),
        lambda case: pickle.loads(pickle.dumps(case)).variants["plane"],
        lambda case: copy.deepcopy(case).variants["plane"],
    ],
)
def test_unknown_variant_error_names_the_nearest(ask):
    with pytest.raises(
        ks.CaseError, match=r"sawframe_2r63.toml: 1 problem\n  variant is 'plane'.*mean 'plain'\?"
    ) as raised:
        ask(CASE)
    assert isinstance(raised.value, KeyError)
    again = pickle.loads(pickle.dumps(raised.value))
    assert (type(again), str(again)) == (NoSuchNameError, str(raised.value))


@pytest.mark.slow
def test_a_design_that_is_not_there_is_told_so_too():
    with pytest.raises(ks.CaseError, match=r"design is 'x', allowed: none"):
        shipped("mower_drive").designs["x"]


def test_membership_test_of_variants_works():
    assert CASE.variants.get("plane") is None
    assert "plane" not in CASE.variants
    assert list(CASE.variants)[:3] == ["plain", "cam-circle", "cam-cosine"]


@every("name", [None, 3, ("plain",)], ids=repr)
def test_what_is_no_name_is_refused_as_one(name):
    with pytest.raises(ks.CaseError, match="variant is"):
        CASE.variant(name)


# Pieces of mechanisms made of their tables, and many at once with all that is wrong


def guide(**values):
    return SimpleNamespace(**{"guide_through": None, "guide_angle": None, "guide_offset": None} | values)


def test_a_centre_at_mid_length_needs_a_length():
    table = SimpleNamespace(mass=2.0, centre="mid-length", inertia=0.1)
    assert build_link(table, 0.6).centre == (0.3, 0.0)
    with pytest.raises(ks.KinetostaticsError, match="needs a link between two joints"):
        build_link(table)


def test_guide_takes_points_or_numbers_not_both():
    assert build_guide(guide()).is_level
    assert build_guide(guide(guide_angle=0.3)).guide_angle == 0.3
    assert build_guide(guide(guide_through=((0.0, 1.0), (1.0, 1.0)))).guide_offset == 1.0
    with pytest.raises(ks.KinetostaticsError, match="either guide_through or"):
        build_guide(guide(guide_through=((0.0, 1.0), (1.0, 1.0)), guide_angle=0.3))


# What designs may vary in a case


@pytest.mark.parametrize("name", IN_PYTHON)
def test_chain_paths_equal_those_of_scenes(name):
    """But for what the file derives of others: centres at mid-length, a spring that balances, a law's guide."""
    case = ks.load_case(EXAMPLES / f"{name}.toml")
    variant = case.variant(case.reference)
    scene, derived = variant.scene, {path for path, value in variant.parameters.items() if not isinstance(value, float)}
    units = variant.units
    absent = {path for path in units if variant.parameters[path] is None} - scene.units.keys()
    assert absent <= {"crank_length"}
    assert {path for path in units if path.rpartition(".")[2] != "centre"} - absent <= scene.units.keys()
    for path in units.keys() - derived - {"crank_length"}:
        assert units[path] == scene.units[path].replace("**", "^").replace("*", " "), path
        assert variant.parameters[path] == scene.parameters[path], path
        follows = path.startswith(("coupler_length", "rocker_length", "dyad")) or path in ("crank_speed", "slider.mass")
        if not follows and not path.startswith("guide"):
            value = variant.parameters[path] * 1.001
            assert variant.varied({path: value}).scene.parameters == scene.varied({path: value}).parameters, path


def test_mid_length_centres_follow_varied_lengths():
    variant = ks.load_case(EXAMPLES / "dyad.toml").variant("watt")
    lengths = np.array([[0.35], [0.36]])
    varied = variant.varied({"dyad1_lengthW": lengths}).scene.parameters
    np.testing.assert_array_equal(varied["dyad1W.centre.along"], lengths / 2)
    assert varied["dyad2W.centre.along"] == 0.15


def test_a_varied_variant_keeps_its_tables():
    variant = ks.load_case(EXAMPLES / "slider.toml").variant("plain")
    assert [path.name for path in variant.files] == ["indicator.csv"]
    (before,) = (item for item in variant.loads if isinstance(item, ks.ProcessForce))
    (after,) = (item for item in variant.varied({"slider.mass": 1.0}).loads if isinstance(item, ks.ProcessForce))
    assert after.force is before.force

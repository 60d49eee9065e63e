"""Sliders and number fields of the explore page: labels, units, ends and steps."""

from functools import cache

import pytest

import kinetostatics as ks
from kinetostatics.views.explore.fields import fields

WORDS = {
    ("sawframe_2r63", "plain"): {
        "crank_length": ("crank", "length"),
        "slider.mass": ("slider", "mass"),
        "coupler.centre.across": ("coupler", "mass centre across"),
        "coupler.inertia": ("coupler", "moment of inertia"),
        "guide_offset": ("guide", "offset"),
        "crank_speed": ("drive", "crank speed"),
        "gravity.direction": ("gravity", "direction"),
    },
    ("sawframe_2r63", "cam-circle"): {"cam.centre.x": ("cam", "centre x"), "spring.stiffness": ("spring", "stiffness")},
    ("v_twin", "plain"): {"coupler_length2": ("coupler2", "length"), "guide_angle1": ("guide1", "angle")},
    ("pumpjack", "weights"): {"rocker_pivot.x": ("rocker", "pivot x"), "pin_H.along": ("pin H", "along")},
    ("shaper", "cutting"): {"slot_offset": ("lengths", "slot offset")},
    ("sawframe_2r63_friction", "plain"): {"friction.O.mu": ("friction", "O coefficient of friction")},
}
ENDS = {
    ("sawframe_2r63", "plain", "slider.mass"): (0.0, 1200.0),
    ("sawframe_2r63", "plain", "crank.mass"): (0.0, 600.0),
    ("sawframe_2r63", "plain", "crank.inertia"): (0.0, 20.5),
    ("sawframe_2r63", "plain", "guide_offset"): (-1.0, 1.0),
    ("sawframe_2r63", "plain", "guide_angle"): (-180.0, 180.0),
    ("sawframe_2r63", "plain", "coupler_length"): (0.4, 4.0),
    ("pumpjack", "weights", "crank.centre.along"): (-2.46, 2.46),
    ("pumpjack", "weights", "crank_speed"): (-20.0, 0.0),
    ("mower_drive", "unbalanced", "guide_offset"): (-0.04, 0.04),
}


@cache
def fields_of(case, variant):
    return {field["path"]: field for field in fields(ks.load_case(case).variants[variant].scene)}


@pytest.mark.parametrize(("case", "variant"), WORDS)
def test_number_has_the_words_of_its_link(case, variant):
    found = fields_of(case, variant)
    for path, words in WORDS[case, variant].items():
        assert (found[path]["group"], found[path]["label"]) == words
    assert len({(field["group"], field["label"]) for field in found.values()}) == len(found)


@pytest.mark.parametrize(("case", "variant", "path"), ENDS)
def test_slider_has_ends_that_make_sense(case, variant, path):
    field = fields_of(case, variant)[path]
    assert [field[end] * field["factor"] for end in ("low", "high")] == pytest.approx(ENDS[case, variant, path])


@pytest.mark.parametrize(("case", "variant"), [*WORDS, ("toggle_press", "idle"), ("mower_drive", "unbalanced")])
def test_slider_reaches_its_number_in_round_steps(case, variant):
    for path, field in fields_of(case, variant).items():
        assert field["low"] <= field["value"] <= field["high"], path
        step = field["step"] * field["factor"]
        assert f"{step:.6e}"[:8] in ("1.000000", "2.000000", "5.000000"), path
        for end in ("low", "high"):
            places = field[end] / field["step"]
            assert places == pytest.approx(round(places), abs=1e-6), path


@pytest.mark.slow
def test_direction_of_a_guide_through_points_has_no_sliders():
    scene = ks.load_case("mower_drive").variants["unbalanced"].scene
    assert set(scene.parameters) - set(fields_of("mower_drive", "unbalanced")) == {"exact.x", "exact.y"}

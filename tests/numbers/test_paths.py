"""Paths of numbers in a parameter tree: each reads its number and puts another in its place."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers.paths import changed, places, with_values

SAW = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.01)), 2.0, slider=ks.Link(600.0), guide_angle=0.2)


def test_numbers_are_found_by_the_names_of_case_files_with_their_units():
    found = places(SAW)
    known = {"cam.radius": 0.3, "cam.centre.x": -0.02, "coupler_length": 2.0, "slider.mass": 600.0, "guide_angle": 0.2}
    assert {path: found[path].value(SAW) for path in known} == known
    assert (found["slider.mass"].rule.unit, found["cam.centre.y"].rule.unit) == ("kg", "m")


def test_every_path_changes_its_number_and_no_other():
    found = places(SAW)
    before = {path: place.value(SAW) for path, place in found.items()}
    for path, place in found.items():
        value = before[path] + 0.001
        made = with_values(SAW, {place.steps: value})
        assert {name: other.value(made) for name, other in found.items()} == before | {path: value}


def test_what_is_put_in_is_checked_and_may_be_designs():
    place = places(SAW)["slider.mass"]
    with pytest.raises(ks.ParameterError, match="mass must be at least 0"):
        with_values(SAW, {place.steps: -1.0})
    assert with_values(SAW, {place.steps: np.array([[1.0], [2.0]])}).batch == (2, 1)


def test_a_copy_with_other_fields_is_checked_as_when_it_is_made():
    link = changed(ks.Link(1.0, (0.1, 0.0), 0.2), mass=3)
    assert (link.mass, link.centre, link.inertia) == (3.0, (0.1, 0.0), 0.2)
    with pytest.raises(ks.ParameterError, match="inertia"):
        changed(ks.Link(1.0), inertia=-1.0)

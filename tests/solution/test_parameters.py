"""What the numbers of a scene are to a program: zeros kept, rules for several at once, lengths that shape a passage."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers import paths
from kinetostatics.numbers.leaves import Kept
from kinetostatics.solution.parameters import is_judged_together, is_zero, keeping, shaping

SAW = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 30.0, loads=ks.Gravity())
DELTOID = ks.four_bar(0.3, 0.8, 0.8, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(20.0, 0.5, 2.0))


@pytest.mark.parametrize(
    ("value", "zero"), [(0.0, True), (-0.0, True), (0, True), (1e-300, False), (np.zeros((2, 1)), False), (None, False)]
)
def test_only_the_one_number_zero_is_absent(value, zero):
    assert is_zero(value) is zero


def test_a_wanted_zero_is_kept_at_its_place_and_nothing_else_changes():
    places = paths.places(SAW)
    kept = keeping(SAW, places, ("coupler.mass", "slider.mass"))
    assert isinstance(places["coupler.mass"].value(kept), Kept)
    others = places.keys() - {"coupler.mass"}
    assert all(places[path].value(kept) is places[path].value(SAW) for path in others)
    assert is_zero(places["coupler.mass"].value(SAW))


def test_a_wanted_number_of_an_axis_is_kept_and_has_a_derivative():
    """Along an axis a guide's direction belongs to the structure."""
    upright, inclined = (
        ks.Scene(ks.crank_slider(0.1, 3.0, guide=ks.Guide.through((0.0, 0.0), end), slider=ks.Link(1.0)), 3.0)
        for end in ((0.0, 2.0), (1e-9, 2.0))
    )
    for path in ("exact.x", "exact.y"):
        assert path in ks.compile(upright, ("O",), (path,), engine="numpy").parameters
        one, other = (
            scene.solve([0.3, 1.0]).uncertainty("balancing_torque", {path: 1e-6}) for scene in (upright, inclined)
        )
        assert np.all(one.inputs[path] > 0.0)
        np.testing.assert_allclose(one.inputs[path], other.inputs[path], rtol=1e-7)
    with pytest.raises(ks.ParameterError, match=r"exact.y is of an axis and so left out; keep it by compile"):
        ks.compile(upright, ("O",), engine="numpy")(0.3, {"exact.y": 0.9})


def test_what_decides_on_a_passage_are_lengths_and_lines_and_never_masses():
    places = paths.places(ks.Scene(DELTOID, 1.0))
    found = shaping(places, DELTOID, [group for group in DELTOID.groups if group.passes])
    assert {"crank_length", "coupler_length", "rocker_length"} <= found
    assert not any(path.startswith(("rocker.", "coupler.", "crank.")) for path in found)
    assert shaping(places, DELTOID, []) == set()


def test_a_line_s_angle_and_offset_are_judged_together_and_other_numbers_alone():
    told = {path: is_judged_together(SAW, place.steps) for path, place in paths.places(SAW).items()}
    assert {path for path, together in told.items() if together} == {"guide_angle", "guide_offset"}

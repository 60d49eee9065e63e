"""Variants of a case: their scenes at any crank angles, and with other numbers in their file."""

import numpy as np
import pytest

import kinetostatics as ks


def test_turn_starts_at_zero_and_leaves_its_end_out():
    angle = ks.load_case("sawframe_2r63").variants["plain"].solve(angles=4).crank_angle
    np.testing.assert_allclose(np.degrees(angle), [0, 90, 180, 270])


def test_what_the_file_derives_follows_other_numbers_and_what_it_states_stays():
    saw = ks.load_case("sawframe_2r63").variants["cam-circle"]
    heavier = saw.varied({"slider.mass": 660.0})
    (_, before), (_, after) = saw.loads, heavier.loads
    assert after.stiffness / before.stiffness == pytest.approx(1.1, rel=1e-14)
    assert heavier.mechanism.links["coupler"].mass == saw.mechanism.links["coupler"].mass


def test_numbers_are_told_with_their_units():
    saw = ks.load_case("sawframe_2r63").variants["cam-circle"]
    assert (saw.parameters["slider.mass"], saw.units["slider.mass"]) == (600.0, "kg")
    assert saw.parameters["coupler.centre"] == "mid-length"


def test_a_path_that_the_file_lacks_is_refused_with_the_nearest():
    with pytest.raises(ks.ParameterError, match=r"did you mean 'slider\.mass'"):
        ks.load_case("sawframe_2r63").variants["plain"].varied({"slider.mas": 1.0})

"""Variants of a case: their scenes at any crank angles, and with other numbers in their file."""

import pytest

import kinetostatics as ks


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

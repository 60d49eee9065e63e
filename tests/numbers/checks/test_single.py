"""Single numbers by name: one float, or why it is none."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers import checks


def test_whole_numbers_and_arrays_of_one_are_floats():
    assert checks.singles("f", a=(3, "m", {}), b=(np.array(2.0), "kg", {"low": 0.0})) == {"a": 3.0, "b": 2.0}


def test_designs_and_what_is_out_of_range_are_told_together():
    with pytest.raises(ks.ParameterError) as caught:
        checks.singles(
            "f", "more", a=(np.ones((2, 1)), "m", {}), b=(-1.0, "m", {"low": 0.0}), c=(5.0, "m", {"high": 4.0})
        )
    for words in ("f: ", "a must be one number", "b must be at least 0", "c must be less than 4, got 5", "more"):
        assert words in str(caught.value)


def test_what_is_beyond_the_usual_is_asked_about_once_and_taken():
    rule = {"name": "speed", "usual": checks.Usual(700.0, "is it in rpm?")}
    with pytest.warns(ks.HintWarning) as caught:
        found = checks.singles("f", a=(1500.0, "rad/s", rule), b=(-900.0, "rad/s", rule), c=(3.0, "rad/s", rule))
    assert found == {"a": 1500.0, "b": -900.0, "c": 3.0}
    (text,) = [str(item.message) for item in caught]
    assert text == "f: speed is 1500 rad/s; is it in rpm?; speed is -900 rad/s; is it in rpm?"


def test_a_number_that_must_not_be_another_is_refused():
    assert checks.single("torque", 0.0, "N*m", unequal=0.0)[1] == "torque must not be 0"
    assert checks.single("torque", 1.0, "N*m", unequal=0.0) == (1.0, None)

"""What is wrong as sentences, and one error that lists all of them."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers import checks


def test_all_problems_stand_in_one_error_and_none_make_none():
    checks.require("saw", None, None)
    with pytest.raises(ks.ParameterError) as caught:
        checks.require("saw", "too long", None, "too heavy")
    assert str(caught.value).startswith("saw: ")
    assert "too long" in str(caught.value)
    assert "too heavy" in str(caught.value)


def test_shapes_that_do_not_fit_are_told_by_name():
    assert checks.fitting(a=(3, 1), b=(1, 5), c=()) is None
    assert "a (3, 1)" in checks.fitting(a=(3, 1), b=(2, 1))


@pytest.mark.parametrize("value", [0, -1, 1.0, True, "3", None, np.nan])
def test_counts_are_whole_numbers_of_at_least_one(value):
    assert "must be a whole number of at least 1" in checks.count("angles", value)
    assert checks.count("angles", 3) is None


def test_a_choice_is_answered_with_those_there_are_and_the_nearest():
    assert checks.choice("engine", "numpy", ("numpy", "compiled")) is None
    told = checks.choice("engine", "nunpy", ("numpy", "compiled"))
    assert "'nunpy'" in told
    assert "did you mean 'numpy'?" in told

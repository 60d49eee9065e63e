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

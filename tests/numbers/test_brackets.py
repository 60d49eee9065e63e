"""Zeros and minima within brackets have the bits of SciPy's."""

import numpy as np
import pytest
from scipy.optimize import elementwise

from kinetostatics.numbers.brackets import find_minima, find_roots

FUNCTIONS = {
    "sine": lambda x, shift: np.sin(3.0 * x + shift) + 0.1,
    "steep": lambda x, shift: np.tanh(50.0 * (x - 0.1 * shift)),
    "level": lambda x, shift: (x - 0.1 * shift) ** 5,
    "kinked": lambda x, shift: np.abs(x - 0.1 * shift) - 0.05 + 1e-3 * x,
    "with gaps": lambda x, shift: np.where(x < 0.3, x - 0.1 * shift, np.nan),
    "constant": lambda x, shift: 0.0 * x + shift,
}


@pytest.fixture(params=FUNCTIONS)
def function(request):
    return FUNCTIONS[request.param]


def test_roots_have_the_bits_of_scipy(function):
    shift = np.linspace(-2.0, 2.0, 41)
    low, high = -1.0 + 0.01 * shift, 0.7 + 0.02 * shift
    with np.errstate(all="ignore"):
        theirs = elementwise.find_root(function, (low, high), args=(shift,)).x
        wide = elementwise.find_root(function, (low, high), args=(shift,), tolerances={"xatol": 1e-3}).x
    ours = find_roots(lambda x, place: function(x, shift[place]), low, high)
    assert np.array_equal(ours, theirs, equal_nan=True)
    assert np.array_equal(find_roots(lambda x, place: function(x, shift[place]), low, high, 1e-3), wide, equal_nan=True)


def test_roots_keep_the_shape_of_the_brackets():
    low = np.array([[0.0, np.nan], [1.0, -1.0]])
    found = find_roots(lambda x, place: x - np.array([0.5, 0.5, 1.25, 9.0])[place], low, low + 1.0)
    assert np.array_equal(found, [[0.5, np.nan], [1.25, np.nan]], equal_nan=True)


@pytest.mark.parametrize("exact", [False, True])
def test_minima_have_the_bits_of_scipy(function, exact):
    shift = np.linspace(-2.0, 2.0, 41)
    brackets = np.array([-0.9 + 0.01 * shift, 0.1 * shift, 0.8 + 0.02 * shift])
    none = dict.fromkeys(("xatol", "xrtol", "fatol", "frtol"), 0.0)
    with np.errstate(all="ignore"):
        theirs = elementwise.find_minimum(function, tuple(brackets), args=(shift,), tolerances=none if exact else None)
    own = {"relative": 0.0, "tiny": 0.0} if exact else {}
    ours = find_minima(lambda x, place: function(x, shift[place]), brackets, **own)
    assert np.array_equal(ours, theirs.x, equal_nan=True)


def test_no_brackets_give_no_values():
    def none(x, place):
        return x

    assert find_roots(none, np.empty(0), np.empty(0)).shape == (0,)
    assert find_minima(none, np.empty((3, 0))).shape == (0,)

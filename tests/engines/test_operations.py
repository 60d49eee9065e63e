"""Recorded operations give the same on plain numbers, on arrays, and into memory given."""

import math

import numpy as np
import pytest

from kinetostatics.engines.codegen import _OPERATIONS
from kinetostatics.engines.operations import ARRAYS, BY_DESIGN, PLAIN, SCALARS
from kinetostatics.numbers.elementary import ROUNDING
from support.every import every

VALUES = (-1.0, -ROUNDING / 2, 0.0, 1e-300, 0.3, 2.0)


@every("name", ["sin", "cos", "atan", "sqrt", "abs", "root", "divisor", "fma", "total"])
def test_plain_numbers_and_arrays_agree(name):
    count = {"root": 1, "divisor": 1, "fma": 2, "total": 3}.get(name, 0)
    with np.errstate(invalid="ignore"):
        arrays = BY_DESIGN[name](np.array(VALUES), *[1.0] * count)
    for value, found in zip(VALUES, arrays, strict=True):
        plain = PLAIN[name](value, *[1.0] * count)
        assert plain == pytest.approx(found, rel=1e-15, abs=0, nan_ok=True)


@every("name", ["sin", "cos", "sqrt", "abs", "root", "divisor", "fma", "total", "lost", "rest", "lost_by_squares"])
def test_numbers_of_numpy_agree_with_arrays_and_stay_so(name):
    count = {"root": 1, "divisor": 1, "fma": 2, "total": 3, "lost": 3, "rest": 2, "lost_by_squares": 2}.get(name, 0)
    given = np.array([0.3, 1e-300, 0.0, -1.0][: 1 if count == 2 else 4]), *[0.7] * count
    with np.errstate(invalid="ignore"):
        arrays = BY_DESIGN[name](*given)
        for value, found in zip(given[0], arrays, strict=True):
            scalar = SCALARS[name](value, *map(np.float64, given[1:]))
            assert type(scalar) is np.float64
            assert scalar == pytest.approx(found, rel=1e-15, abs=1e-33, nan_ok=True)


def test_numbers_of_numpy_tell_squares_that_are_too_small():
    tiny = np.float64(1e-170)
    with np.errstate(under="raise"):
        for name in ("rest", "lost_by_squares"):
            with pytest.raises(FloatingPointError):
                SCALARS[name](tiny, tiny, tiny)


@every("operation", [kind for kind in _OPERATIONS if kind[0] in BY_DESIGN])
def test_memory_given_receives_the_same(operation):
    kind, count = operation
    values, out = np.array(VALUES), np.empty(len(VALUES))
    with np.errstate(invalid="ignore"):
        ARRAYS[_OPERATIONS[operation]](values, *[1.0] * (count - 1), out)
        expected = BY_DESIGN[kind](values, *[1.0] * (count - 1))
    np.testing.assert_array_equal(out, expected)


def test_a_root_forgives_rounding_only():
    assert PLAIN["root"](-ROUNDING / 2, 1.0) == 0.0
    assert math.isnan(PLAIN["root"](-3 * ROUNDING, 1.0))


def test_a_total_of_plain_numbers_too_large_is_infinite_or_nothing():
    assert PLAIN["total"](1e308, 1e308, -1.0, 0.0) != PLAIN["total"](1.0, 2.0, 3.0, 4.0) == 10.0
    assert not math.isfinite(PLAIN["total"](math.inf, -math.inf, 0.0, 0.0))

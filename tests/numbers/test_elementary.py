"""Elementary functions of whatever number the caller brought."""

import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Graph
from kinetostatics.numbers.arithmetic import (
    RELATIVE_OFFSET,
    SQUARE_TOLERANCE,
    clamped_sqrt,
    compensated_sum,
    guarded_divisor,
    length_error,
    offset_from_zero,
    sign,
)
from support.every import every


def test_square_below_zero_by_rounding_has_root_zero():
    square = np.array([4.0, 0.0, -0.5 * SQUARE_TOLERANCE, -2.0 * SQUARE_TOLERANCE])
    found = clamped_sqrt(square, 1.0)
    assert found[:3].tolist() == [2.0, 0.0, 0.0]
    assert math.isnan(found[3])
    assert not np.isnan(clamped_sqrt(square, 3.0)).any()


def test_too_small_squares_have_no_root():
    lost = np.array([-1e-60, 1e-60]).astype(np.float32)
    assert np.isnan(clamped_sqrt(lost, np.float32(0.0))).all()
    assert clamped_sqrt(np.zeros(1), 1e-300).tolist() == [0.0]


def test_divisors_stay_off_zero():
    assert guarded_divisor(np.array([0.0, 2.0]), 1e-3).tolist() == [1e-3, 2.0]
    assert offset_from_zero(0.0, 2.0) == 2.0 * RELATIVE_OFFSET > 0.0
    assert offset_from_zero(1.0, 2.0) == 1.0


def test_signs_of_zeros_are_their_own():
    assert [sign(value) for value in (3.0, -3.0, 0.0, -0.0)] == [1.0, -1.0, 1.0, -1.0]
    assert sign(np.array([0.0, -0.0, -2.0])).tolist() == [1.0, -1.0, -1.0]


def cancelling(count):
    """Four numbers of any sizes each, whose sum is next to nothing."""
    random = np.random.default_rng(5)
    one, two, three = random.uniform(0.1, 1.0, (3, count)) * 2.0 ** random.integers(-8, 9, (3, count))
    return one, two, -three, -(one + two - three) * (1.0 + 2.0 ** -random.integers(20, 60, count))


def test_a_total_is_rounded_once_whatever_cancels():
    terms = cancelling(200)
    exact = [math.fsum(row) for row in zip(*terms, strict=True)]
    np.testing.assert_allclose(compensated_sum(*terms), exact, rtol=2.0**-52, atol=0.0)
    assert np.abs(sum(terms) - exact).max() > 1e-17
    assert compensated_sum(0.1, 0.2, -0.3) == math.fsum((0.1, 0.2, -0.3))
    assert compensated_sum(np.longdouble(2.0), 1.0) == 3.0


def test_a_length_with_its_rest_has_twice_the_digits():
    random = np.random.default_rng(3)
    parts = random.uniform(0.1, 1.0, (2, 50)) * 2.0 ** random.integers(-60, 60, (2, 50))
    length = np.hypot(*parts)
    found = length_error(length, *parts)
    with mp.workdps(60):
        exact = [mp.sqrt(mp.mpf(x) ** 2 + mp.mpf(y) ** 2) for x, y in parts.T]
        errors = [abs(mp.mpf(a) + mp.mpf(b) - c) / c for a, b, c in zip(length, found, exact, strict=True)]
        assert max(errors) < 9 * 2.0**-106
        assert length_error(float(length[0]), *map(float, parts[:, 0])) == found[0]
    assert 2.0**-60 < np.max(np.abs(found / length)) < 2.0**-52


def test_single_precision_rest_is_the_rounding(jax):
    x, y = np.random.default_rng(3).uniform(0.1, 1.0, (2, 50)).astype(np.float32)
    length = np.sqrt(x * x + y * y)
    lost = np.sqrt(x.astype(float) ** 2 + y.astype(float) ** 2) - length
    for parts in ((length, x, y), map(jax.numpy.asarray, (length, x, y))):
        found = length_error(*parts)
        assert found.dtype == np.float32
        np.testing.assert_allclose(found, lost, rtol=1e-6, atol=1e-14)


def test_enclosures_have_no_rest():
    assert length_error(*(np.array([part], dtype=object) for part in (5, 3, 4))) is None


NUMBERS = {
    "float": 0.1,
    "array": np.array([0.1, 0.2]),
    "recorded": Graph().parameter(0),
    "Fraction": Fraction(1, 10),
}


@every("name", NUMBERS)
def test_sum_takes_six_numbers_of_any_kind(name):
    number = NUMBERS[name]
    compensated_sum(*[number] * 6, None)
    assert type(compensated_sum(None, number)) is type(number)
    with pytest.raises(ks.ParameterError, match="takes 6 numbers at most, got 7; make two of it"):
        compensated_sum(*[number] * 7)


def test_exact_numbers_are_not_moved_off_zero():
    assert offset_from_zero(Fraction(0), 1.0) == 0
    assert offset_from_zero(0, 1.0) == offset_from_zero(0.0, 1.0) == RELATIVE_OFFSET

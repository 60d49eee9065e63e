"""Elementary functions of whatever number the caller brought."""

import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Graph
from kinetostatics.numbers.arithmetic import APART, ROUNDING, apart, divisor, rest, root, sign, total
from support.every import every


def test_square_below_zero_by_rounding_has_root_zero():
    square = np.array([4.0, 0.0, -0.5 * ROUNDING, -2.0 * ROUNDING])
    found = root(square, 1.0)
    assert found[:3].tolist() == [2.0, 0.0, 0.0]
    assert math.isnan(found[3])
    assert not np.isnan(root(square, 3.0)).any()


def test_too_small_squares_have_no_root():
    lost = np.array([-1e-60, 1e-60]).astype(np.float32)
    assert np.isnan(root(lost, np.float32(0.0))).all()
    assert root(np.zeros(1), 1e-300).tolist() == [0.0]


def test_divisors_stay_off_zero():
    assert divisor(np.array([0.0, 2.0]), 1e-3).tolist() == [1e-3, 2.0]
    assert apart(0.0, 2.0) == 2.0 * APART > 0.0
    assert apart(1.0, 2.0) == 1.0


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
    np.testing.assert_allclose(total(*terms), exact, rtol=2.0**-52, atol=0.0)
    assert np.abs(sum(terms) - exact).max() > 1e-17
    assert total(0.1, 0.2, -0.3) == math.fsum((0.1, 0.2, -0.3))
    assert total(np.longdouble(2.0), 1.0) == 3.0


def test_a_length_with_its_rest_has_twice_the_digits():
    random = np.random.default_rng(3)
    parts = random.uniform(0.1, 1.0, (2, 50)) * 2.0 ** random.integers(-60, 60, (2, 50))
    length = np.hypot(*parts)
    found = rest(length, *parts)
    with mp.workdps(60):
        exact = [mp.sqrt(mp.mpf(x) ** 2 + mp.mpf(y) ** 2) for x, y in parts.T]
        errors = [abs(mp.mpf(a) + mp.mpf(b) - c) / c for a, b, c in zip(length, found, exact, strict=True)]
        assert max(errors) < 9 * 2.0**-106
        assert rest(float(length[0]), *map(float, parts[:, 0])) == found[0]
    assert 2.0**-60 < np.max(np.abs(found / length)) < 2.0**-52


def test_single_precision_rest_is_the_rounding(jax):
    x, y = np.random.default_rng(3).uniform(0.1, 1.0, (2, 50)).astype(np.float32)
    length = np.sqrt(x * x + y * y)
    lost = np.sqrt(x.astype(float) ** 2 + y.astype(float) ** 2) - length
    for parts in ((length, x, y), map(jax.numpy.asarray, (length, x, y))):
        found = rest(*parts)
        assert found.dtype == np.float32
        np.testing.assert_allclose(found, lost, rtol=1e-6, atol=1e-14)


def test_enclosures_have_no_rest():
    assert rest(*(np.array([part], dtype=object) for part in (5, 3, 4))) is None


NUMBERS = {
    "float": 0.1,
    "array": np.array([0.1, 0.2]),
    "recorded": Graph().parameter(0),
    "Fraction": Fraction(1, 10),
}


@every("name", NUMBERS)
def test_sum_takes_six_numbers_of_any_kind(name):
    number = NUMBERS[name]
    total(*[number] * 6, None)
    assert type(total(None, number)) is type(number)
    with pytest.raises(ks.ParameterError, match="takes 6 numbers at most, got 7; make two of it"):
        total(*[number] * 7)


def test_exact_numbers_are_not_moved_off_zero():
    assert apart(Fraction(0), 1.0) == 0
    assert apart(0, 1.0) == apart(0.0, 1.0) == APART

"""Elementary functions of whatever number the caller brought."""

import math
from fractions import Fraction

import mpmath as mp
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Graph
from kinetostatics.numbers import elementary
from kinetostatics.numbers.duals import Dual
from kinetostatics.numbers.elementary import APART, ROUNDING, apart, divisor, read_only, rest, root, sign, stack, total
from support.every import every


@pytest.mark.parametrize("name", ["sin", "cos", "sqrt"])
@pytest.mark.parametrize("value", [0.5, np.float64(0.5), np.array([0.25, 0.5])])
def test_numbers_and_arrays_are_numpys(name, value):
    assert np.array_equal(getattr(elementary, name)(value), getattr(np, name)(value))


def test_arrays_of_another_library_stay_with_it():
    jnp = pytest.importorskip("jax.numpy")
    found = elementary.sin(jnp.array([0.5]))
    assert isinstance(found, jnp.ndarray)
    assert elementary.is_foreign_array(found)
    assert not any(map(elementary.is_foreign_array, (1.0, np.ones(2), [1.0], np.float64(1.0))))


def test_a_square_below_zero_by_rounding_only_has_the_root_zero():
    square = np.array([4.0, 0.0, -0.5 * ROUNDING, -2.0 * ROUNDING])
    found = root(square, 1.0)
    assert found[:3].tolist() == [2.0, 0.0, 0.0]
    assert math.isnan(found[3])
    assert not np.isnan(root(square, 3.0)).any()


def test_a_square_and_a_unit_too_small_for_the_precision_have_no_root():
    lost = np.array([-1e-60, 1e-60]).astype(np.float32)
    assert np.isnan(root(lost, np.float32(0.0))).all()
    assert root(np.zeros(1), 1e-300).tolist() == [0.0]


def test_divisors_stay_off_zero_and_distances_have_a_direction():
    assert divisor(np.array([0.0, 2.0]), 1e-3).tolist() == [1e-3, 2.0]
    assert apart(0.0, 2.0) == 2.0 * APART > 0.0
    assert apart(1.0, 2.0) == 1.0


def test_signs_of_zeros_are_their_own():
    assert [sign(value) for value in (3.0, -3.0, 0.0, -0.0)] == [1.0, -1.0, 1.0, -1.0]
    assert sign(np.array([0.0, -0.0, -2.0])).tolist() == [1.0, -1.0, -1.0]


def test_stacks_are_arrays_and_locked_arrays_cannot_be_written_to():
    assert stack([np.ones(2), np.zeros(2)]).tolist() == [[1.0, 1.0], [0.0, 0.0]]
    with pytest.raises(ValueError, match="read-only"):
        read_only(np.ones(2))[0] = 2.0


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


def test_a_rest_in_single_precision_is_all_that_rounding_took_from_numpy_and_from_jax(jax):
    x, y = np.random.default_rng(3).uniform(0.1, 1.0, (2, 50)).astype(np.float32)
    length = np.sqrt(x * x + y * y)
    lost = np.sqrt(x.astype(float) ** 2 + y.astype(float) ** 2) - length
    for parts in ((length, x, y), map(jax.numpy.asarray, (length, x, y))):
        found = rest(*parts)
        assert found.dtype == np.float32
        np.testing.assert_allclose(found, lost, rtol=1e-6, atol=1e-14)


def test_a_rest_of_numbers_with_slopes_has_none_and_enclosures_have_no_rest():
    seeded = [Dual(np.array(part), np.ones((1, 1))) for part in (0.5, 0.3, 0.4)]
    found = rest(*seeded)
    assert found.slopes is None
    assert found.value == rest(0.5, 0.3, 0.4) != 0.0
    assert rest(*(np.array([part], dtype=object) for part in (5, 3, 4))) is None


def test_absent_terms_of_a_total_are_none():
    assert total(0.1, None, 0.2, -0.3, None) == math.fsum((0.1, 0.2, -0.3))


NUMBERS = {
    "float": 0.1,
    "array": np.array([0.1, 0.2]),
    "dual": Dual(np.array(0.1)),
    "recorded": Graph().parameter(0),
    "Fraction": Fraction(1, 10),
}


@every("name", NUMBERS)
def test_a_total_takes_six_numbers_of_any_kind_and_absent_ones_do_not_count(name):
    number = NUMBERS[name]
    total(*[number] * 6, None)
    assert type(total(None, number)) is type(number)
    with pytest.raises(ks.ParameterError, match="takes 6 numbers at most, got 7; make two of it"):
        total(*[number] * 7)


def test_a_total_has_the_slopes_of_a_sum():
    found = total(Dual(np.array(0.1), np.array([[1.0], [0.0]])), 0.2, -Dual(np.array(0.3), np.array([[0.0], [2.0]])))
    assert found.value == math.fsum((0.1, 0.2, -0.3))
    np.testing.assert_array_equal(found.slopes, [[1.0], [-2.0]])


def test_numbers_of_any_precision_are_not_moved_off_zero():
    assert apart(Fraction(0), 1.0) == 0
    assert apart(0, 1.0) == apart(0.0, 1.0) == APART

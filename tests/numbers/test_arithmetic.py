"""Elementary functions, plane vectors, brackets of roots, and panels."""

import cmath
import math
from fractions import Fraction
from itertools import product

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import elementwise

import kinetostatics as ks
from kinetostatics.engines.graph import Graph
from kinetostatics.errors import ParameterError
from kinetostatics.numbers import planar
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
from kinetostatics.numbers.brackets import find_minima, find_roots
from kinetostatics.numbers.panels import Panels
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


@pytest.mark.slow
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
    with pytest.raises(ks.ParameterError, match="adds at most 6 numbers, got 7; use two sums"):
        compensated_sum(*[number] * 7)


def test_exact_numbers_are_not_moved_off_zero():
    assert offset_from_zero(Fraction(0), 1.0) == 0
    assert offset_from_zero(0, 1.0) == offset_from_zero(0.0, 1.0) == RELATIVE_OFFSET


# Planar vectors

A, B = (3.0, -1.5), (0.5, 2.0)


def z(vector):
    return complex(*planar.vector_or_zero(vector))


def test_products_and_turns_are_those_of_complex():
    ray = cmath.rect(1.0, 0.7)
    assert complex(planar.dot(A, B), planar.cross(A, B)) == z(A).conjugate() * z(B)
    assert planar.length(A) == pytest.approx(abs(z(A)), rel=1e-15)
    assert z(planar.left(A)) == 1j * z(A)
    assert z(planar.rotate(A, (ray.real, ray.imag))) == pytest.approx(z(A) * ray, rel=1e-15)
    assert z(planar.rotate_back(A, (ray.real, ray.imag))) == pytest.approx(z(A) / ray, rel=1e-15)
    assert planar.rotate(A, None) is A is planar.rotate_back(A, None)


def test_circle_has_the_curvature_of_its_radius():
    for angle, rate, growth in product((0.0, 1.0, 4.0), (2.0, -3.0), (0.0, 5.0)):
        turn = cmath.exp(1j * angle)
        first = 0.4j * rate * turn
        second = 0.4j * growth * turn - 0.4 * rate * rate * turn
        found = planar.curvature((first.real, first.imag), (second.real, second.imag))
        assert found == pytest.approx(2.5 if rate > 0 else -2.5, rel=1e-13)


# Zeros and minima within brackets have the bits of SciPy's

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


# Panels of Chebyshev polynomials

TURN = 2 * np.pi
ANGLES = np.linspace(-1.0, 7.0, 801)


def waves(x):
    return np.cos(x) + 0.3 * np.sin(5 * x) + 0.2


def kinked(x):
    """Kinks at 0.3 and half a turn on, a jump at 4.0 and one at 0."""
    return np.abs(np.sin(x - 0.3)) + 0.2 * (np.mod(x, TURN) > 4.0)


def test_kinks_and_jumps_become_edges_to_rounding():
    panels = Panels.of(kinked, TURN)
    assert len(panels.coefficients) < 40
    for kink in (0.3, 0.3 + np.pi, 4.0):
        assert np.min(np.abs(panels.edges - kink)) < 1e-12
    assert_allclose(panels(ANGLES), kinked(ANGLES), atol=1e-12)


def test_a_kink_that_is_told_is_not_looked_for():
    panels = Panels.of(lambda x: np.abs(np.sin(x - 0.3)), TURN, (0.3, 0.3 + np.pi))
    assert len(panels.coefficients) == 18


def test_mean_and_integral_are_exact():
    panels = Panels.of(waves, TURN)
    assert_allclose(panels.mean, 0.2, rtol=1e-13)
    found = panels.plus(-panels.mean).integral(ANGLES)
    expected = np.sin(ANGLES) - 0.06 * (np.cos(5 * ANGLES) - 1.0)
    assert_allclose(found, expected, atol=1e-13)


def test_roots_are_sign_changes_and_jumps():
    assert_allclose(Panels.of(np.cos, TURN).roots, [np.pi / 2, 3 * np.pi / 2], atol=1e-12)
    jumping = Panels.of(lambda x: np.where(np.mod(x - 1.0, TURN) < np.pi, 1.0, -1.0), TURN)
    assert_allclose(jumping.roots, [1.0, 1.0 + np.pi], atol=1e-12)
    touching = Panels.of(lambda x: 1.0 - np.cos(x), TURN)
    assert touching.roots.size == 0


def test_rough_functions_are_refused_with_the_place():
    rough = np.random.default_rng(0)
    with pytest.raises(ParameterError, match="not smooth between finitely many kinks: not near"):
        Panels.of(lambda x: rough.normal(size=np.shape(x)), TURN)

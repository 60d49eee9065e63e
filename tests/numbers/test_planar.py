"""Planar vectors: as complex numbers have them, and absent parts as zeros."""

import cmath
from itertools import product

import pytest

from kinetostatics.numbers import planar

A, B = (3.0, -1.5), (0.5, 2.0)


def z(vector):
    return complex(*planar.vector(vector))


def test_products_lengths_and_turns_are_those_of_complex_numbers():
    ray = cmath.rect(1.0, 0.7)
    assert complex(planar.dot(A, B), planar.cross(A, B)) == z(A).conjugate() * z(B)
    assert planar.length(A) == pytest.approx(abs(z(A)), rel=1e-15)
    assert z(planar.left(A)) == 1j * z(A)
    assert z(planar.turned(A, (ray.real, ray.imag))) == pytest.approx(z(A) * ray, rel=1e-15)
    assert z(planar.unturned(A, (ray.real, ray.imag))) == pytest.approx(z(A) / ray, rel=1e-15)
    assert planar.turned(A, None) is A is planar.unturned(A, None)


@pytest.mark.parametrize(("a", "b"), list(product((A, None), (B, None))))
def test_absent_vectors_count_as_zero_and_stay_absent(a, b):
    assert z(planar.added(a, b)) == z(a) + z(b)
    assert z(planar.subtracted(a, b) if a or b else None) == z(a) - z(b)
    for found, expected in ((planar.moment(a, b), planar.cross), (planar.work(a, b), planar.dot)):
        assert planar.number(found) == expected(planar.vector(a), planar.vector(b))
        assert (found is None) == (a is None or b is None)
    assert (planar.added(a, b) is None) == (a is None and b is None)


@pytest.mark.parametrize(("a", "b"), list(product((3.0, None), (4.0, None))))
def test_absent_numbers_count_as_zero_and_stay_absent(a, b):
    one, other = planar.number(a), planar.number(b)
    assert planar.number(planar.plus(a, b)) == one + other
    assert planar.number(planar.minus(a, b)) == one - other
    assert planar.number(planar.product(a, b)) == one * other
    assert z(planar.stretched(a, A if b else None)) == one * z(A if b else None)
    assert planar.quotient(a, 2.0) == (None if a is None else 1.5)


def test_a_circle_run_to_the_left_has_the_curvature_of_its_radius_at_whatever_speed():
    for angle, rate, growth in product((0.0, 1.0, 4.0), (2.0, -3.0), (0.0, 5.0)):
        turn = cmath.exp(1j * angle)
        first = 0.4j * rate * turn
        second = 0.4j * growth * turn - 0.4 * rate * rate * turn
        found = planar.curvature((first.real, first.imag), (second.real, second.imag))
        assert found == pytest.approx(2.5 if rate > 0 else -2.5, rel=1e-13)

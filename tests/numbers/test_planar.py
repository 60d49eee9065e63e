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

"""Planar vectors: as complex numbers have them, and absent parts as zeros."""

import cmath
from itertools import product

import pytest

from kinetostatics.numbers import planar

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

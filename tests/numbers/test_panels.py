"""Panels of Chebyshev polynomials: values, derivatives, integral, roots, and kinks that are found."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.errors import ParameterError
from kinetostatics.numbers.panels import Panels

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

"""A law in pieces: position to jerk of polynomials on panels."""

import numpy as np
from numpy.testing import assert_allclose

from kinetostatics.machine.panel_law import PanelLaw
from kinetostatics.numbers.panels import Panels


def test_its_derivatives_are_those_of_the_function_at_any_angle():
    law = PanelLaw(Panels.of(lambda phi: np.cos(phi) + 0.1 * np.sin(3 * phi), 2 * np.pi))
    phi = np.linspace(-7.0, 7.0, 301)
    wave = [0.1 * 3.0**n * part for n, part in enumerate((np.sin(3 * phi), np.cos(3 * phi)) * 2)]
    expected = np.cos(phi) + wave[0], -np.sin(phi) + wave[1], -np.cos(phi) - wave[2], np.sin(phi) - wave[3]
    for found, value, tolerance in zip(law(phi), expected, (1e-13, 1e-11, 1e-9, 1e-6), strict=True):
        assert_allclose(found, value, atol=tolerance)


def test_its_knots_are_the_edges_of_its_panels():
    law = PanelLaw(Panels(np.array([1.0, 4.0, 1.0 + 2 * np.pi]), np.array([[1.0, 0.0], [1.0, 0.0]])))
    assert law.knots == (1.0, 4.0)
    assert repr(law) == "<Law in 2 pieces>"
    assert law(np.array(2.0)).position == 1.0

"""Segments of a turn: each derivative that of the one before, at any stroke and angle; powers of one's own."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine import segments

SEGMENTS = {
    "harmonic": segments.harmonic,
    "cycloidal": segments.cycloidal,
    "modified sine": segments.modified_sine,
    "modified trapezoid": segments.modified_trapezoid,
    "3-4-5": segments.polynomial,
    "4-5-6-7": lambda *args: segments.polynomial(*args, powers="4-5-6-7"),
    "powers of one's own": lambda *args: segments.polynomial(*args, powers=[3, 5, 8]),
}


@pytest.mark.parametrize("name", SEGMENTS)
def test_every_derivative_is_that_of_the_one_before(name):
    """By the interpolating polynomial between the knots, whose derivative is exact to rounding."""
    segment = SEGMENTS[name](0.2, -0.3, 1.7)
    for low, high in pairwise(segment.knots):
        motion = np.polynomial.Chebyshev.interpolate(lambda x: segment(x).position, 24, [low, high])
        inner = np.linspace(low, high, 9)[1:-1]
        for order, part in enumerate(segment(inner)):
            assert_allclose(
                part, motion.deriv(order)(inner) if order else motion(inner), rtol=0, atol=10.0 ** (3 * order - 13)
            )


@pytest.mark.parametrize("name", SEGMENTS)
def test_peaks_scale_with_stroke_and_angle(name):
    """Velocity by stroke / angle, acceleration by stroke / angle^2, jerk by stroke / angle^3."""
    segment = SEGMENTS[name](2.0, 1.5, 0.8)
    found = [np.abs(part).max() for part in segment(np.linspace(0.0, 0.8, 40_001))[1:]]
    assert_allclose(found, np.array(segment.coefficients) * 0.5 / 0.8 ** np.arange(1, 4), rtol=1e-6)


def test_a_dwell_rests():
    assert_allclose(segments.dwell(0.1, 1.0)([0.0, 0.4, 1.0]), [[0.1] * 3, [0.0] * 3, [0.0] * 3, [0.0] * 3])


def test_an_angle_beyond_the_segment_is_refused_and_rounding_beyond_it_is_its_end():
    segment = segments.cycloidal(0.0, 1.0, 1.0)
    assert segment(1.0 + 1e-13).position == 1.0
    with pytest.raises(ks.ParameterError, match=r"segment: angles must lie from 0 to its 1 rad, got -0\.1 to 0\.5"):
        segment([-0.1, 0.5])

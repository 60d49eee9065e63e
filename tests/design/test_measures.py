"""Outputs with their derivatives: the same numbers as sweeps, derivatives by small changes."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.design import measures
from kinetostatics.results.reductions import REDUCTIONS, Output

COUNT = 180
ANGLE = 2 * np.pi * np.arange(COUNT) / COUNT
WAVES = np.array([np.ones(COUNT), np.cos(ANGLE), np.sin(2 * ANGLE), np.cos(3 * ANGLE + 0.4), np.sin(5 * ANGLE)])
POINT = np.array([0.3, 1.0, -0.7, 0.4, 0.2])
NAMES = [name for name in REDUCTIONS if not name.endswith("_at")]


def curve(point, shift=0.0):
    return measures.Curve(point @ WAVES + shift, WAVES)


@pytest.mark.parametrize("shift", [0.0, 3.0, -3.0])
@pytest.mark.parametrize("name", [*NAMES, "harmonic_0", "harmonic_3"])
def test_value_is_that_of_sweeps_and_slopes_are_its_own(name, shift):
    value, slopes = measures.reduced(name, curve(POINT, shift))
    assert_allclose(value, Output("q", name).reduced(curve(POINT, shift).values[None])[0], rtol=1e-9, atol=1e-12)
    step = 1e-6
    for place, found in enumerate(slopes):
        move = step * np.eye(POINT.size)[place]
        high, low = (measures.reduced(name, curve(POINT + side * move, shift))[0] for side in (1, -1))
        assert_allclose(found, (high - low) / (2 * step), rtol=0, atol=2e-7)


def test_peaks_between_samples_are_true_ones():
    """Against the peak of the sum on a grid two thousand times as fine."""
    fine = 2 * np.pi * np.arange(400_000) / 400_000
    exact = POINT @ [np.ones(fine.size), np.cos(fine), np.sin(2 * fine), np.cos(3 * fine + 0.4), np.sin(5 * fine)]
    values, _ = measures.tops(curve(POINT), 1.0, 12)
    assert_allclose(values.max(), exact.max(), rtol=0, atol=1e-9)
    assert values.size == 12
    assert_allclose(values[0], (POINT @ WAVES)[:15].max(), atol=2e-3)


def test_a_jump_counts_with_the_sample_beside_it():
    values = np.where(ANGLE < 1.0, 1.0, 0.0) + 0.1 * ANGLE
    assert measures.top(measures.Curve(values, WAVES), 1.0)[0] == values.max()


def test_magnitude_of_a_vector_has_the_slope_along_it():
    values, slopes = np.array([3 * np.cos(ANGLE), 4 * np.sin(ANGLE)]), np.array([[np.cos(ANGLE), 0 * ANGLE]])
    found = measures.size(values, slopes)
    assert_allclose(found.values, np.hypot(*values))
    assert_allclose(found.slopes[0], 3 * np.cos(ANGLE) ** 2 / found.values, atol=1e-15)


def test_the_largest_of_its_parts_is_the_swing_and_each_has_its_own_slopes():
    whole, rises = measures.reduced("swing", curve(POINT), turns=2)
    values, slopes = measures.bounded("swing", curve(POINT), turns=2)
    assert_allclose(values.max(), whole, rtol=1e-12)
    assert_allclose(slopes[:, values.argmax()], rises, rtol=1e-12)
    step = 1e-6
    for place in range(POINT.size):
        move = step * np.eye(POINT.size)[place]
        high, low = (measures.bounded("swing", curve(POINT + side * move), turns=2)[0] for side in (1, -1))
        assert_allclose(slopes[place], (high - low) / (2 * step), rtol=0, atol=2e-7)

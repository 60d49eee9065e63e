"""Peaks between samples, and the memory they take."""

import numpy as np
import pytest

from kinetostatics.results import peaks

COUNT = 180
ANGLE = 2 * np.pi * np.arange(COUNT) / COUNT


def test_of_several_peaks_the_highest_between_samples_and_its_place():
    """The wave cos 3x + 0.2 cos x has three tops, of which that at 0 is highest; moved by a third of a sample."""
    shift = ANGLE[1] / 3
    values = np.cos(3 * (ANGLE - shift)) + 0.2 * np.cos(ANGLE - shift)
    height, place, error = peaks.peak(np.array([values, -values]))
    assert height[0] == pytest.approx(1.2, abs=1e-9)
    assert place[0] * COUNT == pytest.approx(1 / 3, abs=1e-5)
    assert error[0] < 1e-6
    below, _, _ = peaks.peak(np.array([values]), -1.0)
    assert below[0] == pytest.approx(height[1], abs=1e-12)


def test_the_lowest_of_a_margin_is_found_with_its_place_and_bend():
    step = 0.01
    around = step * np.arange(-12, 13)
    found, place, bend = peaks.lowest(0.3 + 2.0 * (around[None] - 0.003) ** 2, step)
    assert found[0] == pytest.approx(0.3, abs=1e-12)
    assert place[0] == pytest.approx(0.003, abs=1e-9)
    assert bend[0] == pytest.approx(4.0, rel=1e-9)


def test_designs_are_taken_so_many_at_a_time_that_they_fit_and_scratch_is_the_same_memory_again():
    values = np.arange(40_000.0).reshape(400, 100)
    parts = list(peaks.pieces(values, 8))
    assert [first for first, _ in parts] == list(range(0, 400, peaks.SCRATCH // 800))
    assert np.array_equal(np.concatenate([some for _, some in parts]), values)
    first, second = (peaks.scratch(float, 3, 4) for _ in range(2))
    assert np.shares_memory(first, second)
    assert peaks.scratch(float, peaks.SCRATCH).shape == (peaks.SCRATCH,)


def test_beside_what_is_infinite_a_peak_is_the_highest_of_its_samples():
    """A difference of infinities is none, and makes nothing smooth."""
    values = np.cos(np.arange(12.0))
    for first in range(12):
        for count in range(1, 4):
            holed = values.copy()
            holed[(first + np.arange(count)) % 12] = -np.inf
            for sign in (1.0, -1.0):
                height, place, _ = peaks.peak(sign * holed[None], sign)
                assert holed.max() <= height[0] < 1.3, (first, count, sign)
                assert 0.0 <= place[0] < 1.0

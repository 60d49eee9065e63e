"""Changes of sign over a period: all of them, for each design its own."""

import numpy as np
import pytest

from kinetostatics.results.changes import sign_changes

TURN = 2 * np.pi


def test_each_function_of_each_design_has_its_own_changes():
    phase = np.array([[0.3], [1.3]])
    row, at = sign_changes(lambda angle: [np.sin(angle - phase), 0.0 * angle + 1.0, angle - 5.0], TURN, 720)
    for design, first in enumerate(phase[:, 0]):
        assert row[design].tolist() == [0.0, 0.0, 2.0]
        np.testing.assert_allclose(at[design], [first, first + np.pi, 5.0], rtol=0, atol=1e-14)


def test_designs_with_fewer_have_no_number_there():
    height = np.array([[0.5], [2.0]])
    row, at = sign_changes(lambda angle: [np.cos(angle) - height], TURN, 720)
    np.testing.assert_allclose(at[0], [np.pi / 3, 5 * np.pi / 3], rtol=0, atol=1e-14)
    assert np.isnan(at[1]).all()
    assert np.isnan(row[1]).all()


@pytest.mark.parametrize("depth", [1e-4, 1e-6, 1e-9])
def test_two_changes_between_two_samples_are_found(depth):
    """What only just passes zero, and turns about, within half a degree."""
    place = np.array([[2.0012], [3.0034]])
    _, at = sign_changes(lambda angle: [1.0 - depth - np.cos(angle - place)], TURN, 180)
    half = np.arccos(1.0 - depth)
    np.testing.assert_allclose(at, np.column_stack([place - half, place + half]), rtol=0, atol=1e-7)


def test_what_touches_zero_from_one_side_changes_nothing():
    _, at = sign_changes(lambda angle: [1.0 + 1e-6 - np.cos(angle - 2.0012)], TURN, 180)
    assert at.shape == (1, 0)


def test_no_function_has_no_changes():
    assert sign_changes(lambda angle: [], TURN, 720)[1].shape == (1, 0)


def test_where_it_is_no_number_nothing_changes():
    _, at = sign_changes(lambda angle: [np.where(angle > 3.0, np.nan, np.sin(angle - 1.0))], TURN, 720)
    np.testing.assert_allclose(at, [[1.0]], rtol=0, atol=1e-14)

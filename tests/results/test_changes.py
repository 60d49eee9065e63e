"""Changes of sign over a period: all of them, for each design its own."""

import numpy as np
import pytest

from kinetostatics.results.changes import sign_changes

TURN = 2 * np.pi


@pytest.mark.parametrize("depth", [1e-4, 1e-6, 1e-9])
def test_two_changes_between_two_samples_are_found(depth):
    """What only just passes zero, and turns about, within half a degree."""
    place = np.array([[2.0012], [3.0034]])
    _, at = sign_changes(lambda angle: [1.0 - depth - np.cos(angle - place)], TURN, 180)
    half = np.arccos(1.0 - depth)
    np.testing.assert_allclose(at, np.column_stack([place - half, place + half]), rtol=0, atol=1e-7)


def test_no_function_has_no_changes():
    assert sign_changes(lambda angle: [], TURN, 720)[1].shape == (1, 0)

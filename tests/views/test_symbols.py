"""Signs of drawings: placed, spanned and hatched where they belong."""

import numpy as np
import pytest

from kinetostatics.views import symbols


def test_a_sign_is_placed_by_origin_direction_and_size_and_mirrored_by_its_sense():
    origin, up = np.array([[1.0], [2.0]]), np.array([[0.0], [1.0]])
    points = symbols.placed([(0, 0), (1, 0), (0, 1)], origin, up, 2.0)
    assert points[..., 0].T.tolist() == [[1, 2], [1, 4], [-1, 2]]
    assert symbols.placed([(0, 1)], origin, up, 2.0, -1.0)[:, 0, 0].tolist() == [3, 2]


@pytest.mark.parametrize("shape", [symbols.SPRING, symbols.DAMPER, symbols.LINE])
def test_what_joins_two_points_begins_and_ends_at_them(shape):
    start, end = np.array([[1.0, 0.0], [1.0, 0.0]]), np.array([[4.0, 0.0], [5.0, 2.0]])
    points = symbols.spanned(shape, start, end, 0.1)
    assert np.allclose(points[:, 0], start)
    assert np.allclose(points[:, -1], end)


def test_points_that_coincide_are_joined_by_a_sign_without_length():
    here = np.ones((2, 1))
    assert np.allclose(symbols.spanned(symbols.LINE, here, here, 0.1), 1.0)


def test_ground_is_hatched_on_the_right_of_its_line():
    points = symbols.hatched(np.array([0.0, 0.0]), np.array([1.0, 0.0]), 0.1)
    assert points[:, :2].T.tolist() == [[0, 0], [1, 0]]
    assert np.nanmin(points[1]) == pytest.approx(-0.1)
    assert np.nanmax(points[1]) == 0.0

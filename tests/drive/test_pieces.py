"""Functions of the crank angle in pieces: integrals, values and extremes of a sine, to rounding."""

import numpy as np
import pytest

from kinetostatics.drive.pieces import Pieces

PIECES = Pieces(np.array([0.0, 1.0, 1.5, 4.0, 2 * np.pi]), 24)
SINE = np.sin(PIECES.angle)


def test_integrals_of_a_sine_are_those_of_the_cosine():
    assert PIECES.integrated(SINE) == pytest.approx(1.0 - np.cos(PIECES.angle), abs=1e-14)
    assert PIECES.whole(SINE) == pytest.approx(-np.diff(np.cos(PIECES.edges)), abs=1e-14)
    assert PIECES.total(SINE) == pytest.approx(0.0, abs=1e-14)


def test_a_series_has_the_values_in_between_and_nothing_in_its_tail():
    angle = np.linspace(0.0, 2 * np.pi, 50).reshape(5, 10)
    assert PIECES.evaluate(PIECES.series(SINE), angle) == pytest.approx(np.sin(angle), abs=1e-14)
    assert PIECES.tail(SINE).max() < 1e-14
    assert PIECES.tail(np.sign(SINE)).max() > 1e-3


def test_the_largest_value_is_found_between_the_points():
    assert PIECES.largest(SINE) == pytest.approx((1.0, np.pi / 2), rel=1e-12)


def test_marked_pieces_are_halved_until_they_are_a_jump():
    assert PIECES.split(np.array([True, False, False, False])).edges.tolist() == [0.0, 0.5, *PIECES.edges[1:]]
    assert Pieces(np.array([0.0, 1e-14, 1.0]), 12).can_split.tolist() == [False, True]

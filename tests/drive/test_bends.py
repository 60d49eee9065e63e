"""Kinks of friction while a machine runs: pieces are parted at zeros of forces, once, and never at jumps."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinetostatics.drive.bends import parted
from kinetostatics.drive.pieces import Pieces

TURN = 2 * np.pi
EVEN = Pieces(np.linspace(0.0, TURN, 9), 16)
DRIVEN = SimpleNamespace(kinks=np.array([0.5]))
"""What has a kink of its own, at 0.5 rad."""


def parted_at(pieces, place, before=None):
    """Parted where a force vanishes that is a sine from some place on."""
    known = {} if before is None else {"before": before}
    return parted(DRIVEN, pieces, [np.sin(pieces.angle - place)], **known)


def test_pieces_are_parted_where_a_force_changes_its_sign():
    pieces, bends = parted_at(EVEN, 1.3)
    assert bends == pytest.approx([1.3, 1.3 + np.pi], abs=1e-4)
    assert set(bends) < set(pieces.edges)
    assert set(DRIVEN.kinks) < set(pieces.edges)
    assert pieces.count == EVEN.count


def test_places_are_found_until_they_stay():
    pieces, bends = parted_at(EVEN, 1.3)
    for _ in range(4):
        again = parted_at(pieces, 1.3, bends)
        if again is None:
            break
        pieces, bends = again
    assert again is None
    assert np.abs(pieces.edges - 1.3).min() < 1e-9 * TURN


def test_edges_found_before_go_when_the_place_moves():
    pieces, bends = parted_at(EVEN, 1.3)
    moved, found = parted_at(pieces, 1.4, bends)
    assert np.abs(moved.edges - 1.3).min() > 0.05
    assert len(moved.edges) == len(pieces.edges)
    assert found == pytest.approx([1.4, 1.4 + np.pi], abs=1e-3)


def test_a_jump_from_one_piece_to_the_next_is_no_zero_and_no_force_no_bend():
    square = np.where(EVEN.angle < np.pi, 1.0, -1.0)
    assert parted(SimpleNamespace(kinks=np.array([np.pi])), EVEN, [square]) is None
    assert parted(DRIVEN, EVEN, []) is None

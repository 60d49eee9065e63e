"""Pieces of mechanisms made of their tables, and many at once with all that is wrong."""

from types import SimpleNamespace

import pytest

import kinetostatics as ks
from kinetostatics.casefile.pieces import guide_of, link_of


def guide(**values):
    return SimpleNamespace(**{"guide_through": None, "guide_angle": None, "guide_offset": None} | values)


def test_a_centre_at_mid_length_needs_a_length():
    table = SimpleNamespace(mass=2.0, centre="mid-length", inertia=0.1)
    assert link_of(table, 0.6).centre == (0.3, 0.0)
    with pytest.raises(ks.KinetostaticsError, match="is for links between two joints"):
        link_of(table)


def test_a_guide_is_told_by_points_or_by_numbers_not_by_both():
    assert guide_of(guide()).is_level
    assert guide_of(guide(guide_angle=0.3)).guide_angle == 0.3
    assert guide_of(guide(guide_through=((0.0, 1.0), (1.0, 1.0)))).guide_offset == 1.0
    with pytest.raises(ks.KinetostaticsError, match="either guide_through or"):
        guide_of(guide(guide_through=((0.0, 1.0), (1.0, 1.0)), guide_angle=0.3))

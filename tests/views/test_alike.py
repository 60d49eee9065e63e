"""Machines that look alike, and what of counterweights and loads each has of its own."""

import numpy as np

import kinetostatics as ks
from kinetostatics.views.alike import moves_alike, own_strokes

SLIDER = ks.Link(1.0)


def solved(machine, **options):
    return ks.Scene(machine, 10.0, **options).solve(12)


PLAIN = solved(ks.crank_slider(0.1, 0.4, slider=SLIDER))
WEIGHED = solved(ks.crank_slider(0.1, 0.4, crank=ks.Link(2.0, -0.06), slider=SLIDER), loads=ks.Spring(9.0, 0.4))


def test_machines_that_differ_in_masses_and_loads_move_alike():
    assert moves_alike(PLAIN, WEIGHED)


def test_machines_of_other_lengths_joints_or_assembly_do_not():
    others = [
        ks.crank_slider(0.1, 0.41, slider=SLIDER),
        ks.crank_slider(0.1, 0.4, guide_offset=0.01, slider=SLIDER),
        ks.scotch_yoke(0.1, slider=SLIDER),
        ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)),
    ]
    assert not any(moves_alike(PLAIN, solved(other)) for other in others)


def test_strokes_have_the_labels_of_all_that_bear_them():
    found = own_strokes({"plain": PLAIN, "one": WEIGHED, "other": WEIGHED}, np.array([40.0]))
    assert {stroke.kind for stroke, _ in found} == {"counterweight", "spring"}
    assert all(owners == ["one", "other"] for _, owners in found)

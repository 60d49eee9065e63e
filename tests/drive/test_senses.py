"""Which way joints that rub move: guides turn at dead centres, pins of a crank never, rollers are not asked."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.senses import Senses
from support.drives import RUBBING

ROLLING = ks.Scene(
    ks.cam_crank_slider(ks.cams.Circle(0.1, (0.02, 0.0)), 0.4, slider=ks.Link(10.0)),
    1.0,
    friction={"cam": ks.RollerFriction(0.003, 0.02, 0.04)},
)
SAW = Senses.of(RUBBING)


def test_the_guide_turns_at_dead_centres_and_the_coupler_s_end_where_it_stands_across():
    assert SAW.edges["guide"] == pytest.approx([0.0, np.pi], abs=1e-12)
    assert SAW.edges["B"] == pytest.approx([np.pi / 2, 3 * np.pi / 2], abs=1e-12)
    assert SAW.edges["O"].size == 0
    assert SAW.all_edges == pytest.approx(np.arange(4) * np.pi / 2, abs=1e-12)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_signs_are_those_of_the_motion_and_turn_with_the_crank(direction):
    angle = np.linspace(0.1, 12.0, 40)
    velocity = ks.solve(RUBBING.mechanism, angle, crank_speed=1.0).slider_velocity
    found = SAW.at(angle, direction)
    guide = found["friction.guide.sense"] * np.sign(velocity)
    assert np.ptp(guide) == 0.0
    assert abs(guide[0]) == 1.0
    assert guide[0] == direction * SAW.at(angle[:1], 1.0)["friction.guide.sense"][0] * np.sign(velocity[0])


def test_a_stretch_goes_to_the_next_edge_and_from_an_edge_to_the_one_behind_it():
    assert SAW.stretch(1.0, 1.0)[1] == pytest.approx(np.pi / 2)
    assert SAW.stretch(1.0, -1.0)[1] == pytest.approx(0.0, abs=1e-12)
    assert SAW.stretch(SAW.all_edges[1], 1.0)[1] == pytest.approx(np.pi)
    assert SAW.stretch(0.0, -1.0)[1] == pytest.approx(-np.pi / 2)
    ahead, _ = SAW.stretch(1.0, 1.0)
    assert ahead == {name: float(sign[0]) for name, sign in SAW.at(np.array([1.2]), 1.0).items()}


def test_rollers_have_no_sense_that_changes():
    senses = Senses.of(ROLLING)
    assert senses.all_edges.size == 0
    assert senses.stretch(0.5, -1.0) == ({"friction.cam.sense": -1.0, "sense": -1.0}, 0.5 - senses.period)


def test_signs_at_one_angle_that_is_an_edge_are_told():
    assert {abs(float(sign)) for sign in SAW.at(0.0, 1.0).values()} == {1.0}

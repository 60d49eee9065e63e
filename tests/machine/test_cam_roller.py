"""Cam roller: a block in the slotted crank, whose roller follows the cam and is pressed across it."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.0, 2 * np.pi, 25)
CAM = ks.cams.Circle(0.3, (-0.05, 0.02))
BLOCK = ks.Link(4.0)
ROLLER = ks.Mechanism("roller", ks.Crank(None), (ks.CamRoller(CAM, BLOCK),))


def test_the_roller_runs_on_the_circle():
    x, y = ks.solve(ROLLER, TURN, crank_speed=1.0).position("A")
    assert np.hypot(x + 0.05, y - 0.02) == pytest.approx(np.full(25, 0.3), rel=1e-15)


def test_cam_and_slot_force_bear_the_block_alone():
    s = ks.solve(ROLLER, TURN, crank_speed=6.0, crank_acceleration=-3.0, loads=ks.Gravity())
    x, y = s.position("A")
    inward = -np.array([x + 0.05, y - 0.02]) / 0.3
    across = np.array([-np.sin(TURN), np.cos(TURN)])
    needed = 4.0 * (s.acceleration("A") + np.array([[0.0], [9.81]]))
    assert s.cam_force * inward + s.slot_force * across == pytest.approx(needed, abs=1e-11)


def test_a_cam_about_o_leaves_the_block_to_its_slot():
    s = ks.solve(
        ks.Mechanism("round", ks.Crank(None), (ks.CamRoller(ks.cams.Circle(0.3), BLOCK),)), TURN, crank_speed=6.0
    )
    assert s.cam_force == pytest.approx(np.full(25, 4.0 * 36.0 * 0.3), rel=1e-13)
    assert np.abs(s.slot_force).max() < 1e-12


def test_a_cam_roller_alone_is_a_mechanism():
    """Without any bar: a block that the slotted crank drives around a circle takes its centrifugal force."""
    machine = ks.Mechanism("wheel", ks.Crank(None), (ks.CamRoller(ks.cams.Circle(0.2), ks.Link(3.0)),))
    np.testing.assert_allclose(ks.solve(machine, TURN, crank_speed=10.0).cam_force, 3.0 * 0.2 * 100.0, rtol=1e-13)


def test_a_block_placed_where_it_is_found_knows_how_its_path_is_curved():
    """Methods under study find joints in another way; on a circle the curvature is that of the circle."""
    placed, again = ROLLER.place(TURN), ROLLER.place(TURN)
    group = ks.CamRoller(CAM, BLOCK, ks.Roller(0.05, 0.06, 210e9, 0.3))
    group.follow(again, placed.joints)
    for side, room in ((-1.0, 0.25), (1.0, 0.35)):
        found = group.relative_radius("contact_pressure", again, side)
        assert found == pytest.approx(np.full(25, 0.05 * room / 0.3), rel=1e-13)

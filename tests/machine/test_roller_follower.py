"""Roller followers on a cam that turns: contact force and pressure angle beside textbook formulas, and refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.followers import ANGLES, KINDS, LAW, scene


def test_the_pressure_angle_is_the_textbooks():
    """Norton: tan = (v - offset) / (sqrt(base^2 - offset^2) + lift), offset to the side that the cam turns to."""
    follower = KINDS["roller, offset"]()
    s = scene(follower).solve(ANGLES)
    law = LAW(ANGLES)
    expected = np.arctan((law.velocity + 0.013) / law.position)
    assert_allclose(s.measure("pressure_angle_1"), expected, rtol=1e-14)


def test_the_contact_force_is_along_the_normal_of_the_pitch_curve():
    follower = KINDS["roller, offset"]()
    s = scene(follower).solve(ANGLES)
    centre, first, _ = follower.disk.curve(ANGLES)
    normal = 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    on_follower = s.scalar("contact_force_1") * normal
    torque = (np.conj(centre * np.exp(1j * ANGLES)) * on_follower).imag
    alone = scene(follower).mechanism.crank
    bare = ks.Scene(ks.Mechanism("bars", alone, s.mechanism.groups[:1]), 12.0, -30.0, s.loads[:2]).solve(ANGLES)
    assert_allclose(s.balancing_torque - bare.balancing_torque, torque, rtol=1e-11)


def test_the_side_of_the_offset_trades_pressure_angle_of_rise_and_return():
    peaks = []
    for offset in (-0.01, 0.01):
        follower = ks.RollerFollower(LAW, ks.Guide.at(0.0, offset))
        angle = ks.solve(
            ks.Mechanism("cam drive", ks.Crank(None), (follower,)), np.linspace(0, 6.28, 720), crank_speed=1.0
        )
        peaks.append((angle.measure("pressure_angle").max(), -angle.measure("pressure_angle").min()))
    assert peaks[0][0] < peaks[0][1]
    assert_allclose(peaks[0], peaks[1][::-1], rtol=1e-4)


def test_two_followers_stand_side_by_side():
    pair = (KINDS["roller"](), ks.RollerFollower(LAW, ks.Guide.at(2.0), pin="S", label="_2"))
    s = ks.solve(ks.Mechanism("cam drive", ks.Crank(None), pair), ANGLES, crank_speed=10.0)
    assert {"contact_force", "contact_force_2"} <= set(s.scalars)


def test_a_guide_may_rub():
    drive = scene(KINDS["roller"]())
    rubbing = ks.Scene(drive.mechanism, 12.0, 0.0, drive.loads, {"guide": ks.GuideFriction(0.1, 0.05)}).solve(ANGLES)
    assert np.all(rubbing.friction_loss > 0)
    size = np.max(rubbing.dynamics.largest_torque_term)
    assert_allclose(rubbing.balancing_torque, rubbing.balancing_torque_by_power, rtol=0, atol=1e-12 * size)


def test_a_roller_centre_behind_o_is_refused_with_its_coordinate():
    follower = ks.RollerFollower(ks.laws.cosine(0.02, 0.01))
    with pytest.raises(ks.AssemblyError, match=r"ahead of O along its guide, but its coordinate falls to -0\.0"):
        ks.solve(ks.Mechanism("cam drive", ks.Crank(None), (follower,)), np.linspace(0, 6, 60), crank_speed=1.0)


def test_its_numbers_are_parameters_with_derivatives():
    drive = scene(KINDS["roller, offset"]())
    program = ks.compile(drive, ("contact_force_1",), engine="numpy")
    slope = program.derivatives(0.7)["contact_force_1"]["guide_offset_1"]
    low, high = (drive.varied({"guide_offset_1": 0.013 + side}).solve(np.array([0.7])) for side in (-1e-5, 1e-5))
    assert_allclose(slope, (high.scalar("contact_force_1") - low.scalar("contact_force_1"))[0] / 2e-5, rtol=1e-7)

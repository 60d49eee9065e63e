"""Flat followers on a cam that turns: where they touch, what their guide bears, and cams that are not convex."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.followers import ANGLES, LAW


def solved(law=LAW, offset=0.0, angles=ANGLES):
    follower = ks.FlatFollower(law, ks.Guide.at(2.0, offset), ks.Link(2.0))
    machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
    return ks.solve(machine, angles, crank_speed=12.0, loads=ks.Spring(5e3, 0.0, on="follower"))


def test_the_contact_is_as_far_aside_as_the_velocity():
    s = solved()
    assert_allclose(s.measure("contact_place"), -LAW(ANGLES).velocity, rtol=1e-15)
    assert_allclose(s.measure("curvature_radius"), LAW(ANGLES).position + LAW(ANGLES).acceleration, rtol=1e-15)


def test_the_guide_bears_the_moment_of_the_contact_alone():
    for offset in (0.0, 0.01):
        s = solved(offset=offset)
        lever = s.measure("contact_place") - offset
        assert_allclose(s.scalar("guide_moment"), lever * s.scalar("contact_force"), rtol=1e-13)
        assert_allclose(s.scalar("guide_force"), 0.0, atol=1e-12)


def test_no_side_force_whatever_the_pressure():
    assert_allclose(
        solved().scalar("contact_force"), 2.0 * 144.0 * LAW(ANGLES).acceleration + 5e3 * LAW(ANGLES).position
    )


def three_lobes(phi):
    c, s = 0.01 * np.cos(3 * phi), 0.01 * np.sin(3 * phi)
    return 0.05 + c, -3 * s, -9 * c, 27 * s


def test_a_cam_that_would_be_hollow_is_refused_with_its_curvature():
    with pytest.raises(ks.AssemblyError, match=r"convex, but its radius of curvature s \+ s'' falls to -0\.03 m"):
        solved(three_lobes, angles=np.linspace(0, 6, 90))

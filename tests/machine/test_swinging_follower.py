"""Swinging followers on a cam that turns: angle, pressure angle, forces by hand, and refusals."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.followers import ANGLES, KINDS, SWING, scene

both_sides = pytest.mark.parametrize("kind", ["swinging", "swinging, other side"])


@both_sides
def test_the_arm_stands_at_the_angle_of_the_law_from_the_line_of_centres(kind):
    follower = KINDS[kind]()
    s = scene(follower).solve(ANGLES)
    pivot = complex(*follower.pivot)
    x, y = s.position(follower.pin)
    angle = np.angle((x + 1j * y - pivot) / -pivot)
    assert_allclose(-follower.assembly * angle, SWING(ANGLES).position, rtol=1e-13)


@both_sides
def test_the_pressure_angle_is_between_normal_and_way_of_the_roller(kind):
    follower = KINDS[kind]()
    s = scene(follower).solve(ANGLES)
    _, first, _ = follower.disk.curve(ANGLES)
    normal = 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    x, y = s.velocity(follower.pin)
    way = (x + 1j * y) / np.hypot(x, y)
    expected = np.arccos(np.abs((np.conj(way) * normal).real))
    assert_allclose(s.measure("pressure_angle" + follower.label), expected, rtol=1e-9)


@both_sides
def test_moments_about_the_pivot_balance(kind):
    """The contact force on the arm, through the roller centre, and a couple on it."""
    follower = KINDS[kind]()
    bare = type(follower)(follower.cam, 0.1, follower.pivot, follower.assembly)
    machine = ks.Mechanism("cam drive", ks.Crank(None), (bare,))
    s = ks.solve(machine, ANGLES, crank_speed=12.0, loads=ks.Torque(follower.assembly * 30.0, on="arm"))
    assert np.all(s.scalar("contact_force") > 0)
    _, first, _ = follower.disk.curve(ANGLES)
    force = s.scalar("contact_force") * 1j * first / np.abs(first) * np.exp(1j * ANGLES)
    x, y = s.position("R")
    arm = x + 1j * y - complex(*follower.pivot)
    assert_allclose((np.conj(arm) * force).imag, -follower.assembly * 30.0, rtol=1e-12)
    assert_allclose(s.reaction("Q"), [-force.real, -force.imag], rtol=1e-11)


def test_an_arm_that_crosses_the_line_of_centres_is_refused():
    follower = ks.SwingingFollower(ks.laws.cosine(0.3, 0.2), 0.1, (0.12, 0.03))
    with pytest.raises(ks.AssemblyError, match="must stay on its side of the line from O to Q"):
        ks.solve(ks.Mechanism("cam drive", ks.Crank(None), (follower,)), np.linspace(0, 6, 60), crank_speed=1.0)


WRONG = {
    "pivot at O": ({"pivot": (0.0, 0.0)}, "must not be at O"),
    "no length": ({"arm_length": 0.0}, "arm length must be greater than 0"),
    "side": ({"assembly": 2}, "assembly must be"),
    "law": ({"cam": 0.3}, "must be one of ks.laws"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_no_follower_can_have_is_refused(name):
    given, text = WRONG[name]
    with pytest.raises(ks.ParameterError, match=text):
        ks.SwingingFollower(**{"cam": SWING, "arm_length": 0.1, "pivot": (0.12, 0.0)} | given)

"""Cams fixed to the frame: the pitch curve, the roller on it, and accuracy at the singular angle."""

import mpmath as mp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.cams.cam import Cam
from support.every import every
from support.machines import ANGLES, assert_close, largest, planar
from support.multibody import (
    FINE_DIGITS,
    Body,
    CrankSlider,
    critical_cosine,
    critical_length,
    path,
    pin_by_cosine_law,
    pin_on_circle,
)

ROUNDING = 4e-15
"""A score of operations, none of which cancels, whatever the ratio of mean and amplitude."""
LAWS = [(0.3, 2.0), (0.3, 0.31), (0.3, 0.6), (0.01, 5.0)]
"""Amplitude and mean: the sawframe; a slider that nearly reaches O; between; a short stroke far away."""


NEXT = mp.mpf(2) ** -52, -(mp.mpf(2) ** -52)
"""Steps of the crank angle by its rounding, rad."""
OFFSETS = [0.0] + [sign * 10.0**-power for power in range(1, 17) for sign in (1, -1)]


def near_singular(amplitude, mean):
    """Crank angles at and around both singular angles; the exact singular angle lies between two floats."""
    with mp.workdps(30):
        singular = float(mp.acos(critical_cosine(amplitude, mean)))
    return np.concatenate([singular + np.array(OFFSETS), 2 * np.pi - singular + np.array(OFFSETS)])


def polar(pin, angles):
    """r, r', r'' of a path at each angle, from its derivatives as a curve, with its radius of curvature."""
    rows = []
    for angle in angles:
        place, slope, bend = (part * np.exp(-1j * angle) for part in path(pin, angle))
        rows.append((place.real, slope.real, bend.real + place.real, abs(slope) ** 3 / (np.conj(slope) * bend).imag))
    return np.array(rows).T


@pytest.mark.slow
@every("amplitude, mean", LAWS)
def test_cosine_law_derivatives_at_singular_angle(amplitude, mean):
    """Against the naive radicand with its signed root, with 80 digits; r' and r'' relative to r."""
    cam = ks.cams.CosineLaw(amplitude, mean)
    angles = np.concatenate([near_singular(amplitude, mean), ANGLES])
    *expected, curvature = polar(pin_by_cosine_law(amplitude, mean), angles)
    for found, value in zip(cam.radius(angles), expected, strict=True):
        assert largest(found - value) < ROUNDING * largest(expected[0])
    assert_allclose(cam.pressure_angle(angles), np.arctan2(expected[1], expected[0]), rtol=0, atol=ROUNDING)
    assert_close(1 / cam.curvature_radius(angles), 1 / curvature, 10 * ROUNDING)


@every("amplitude, mean", LAWS)
def test_cosine_law_coupler_length_and_singular_angle(amplitude, mean):
    cam = ks.cams.CosineLaw(amplitude, mean)
    with mp.workdps(FINE_DIGITS):
        length, cosine = critical_length(amplitude, mean), critical_cosine(amplitude, mean)
        assert abs(cam.coupler_length / length - 1) < 4e-16
        assert abs(cam.singular_angle - mp.acos(cosine)) < 4e-16
        for other in (cosine + mp.mpf("1e-20"), cosine - mp.mpf("1e-20")):
            assert (mean + amplitude * other) * mp.sqrt(1 - other**2) < length


@every("amplitude, mean", LAWS)
@every("guide_angle", [0.0, 0.8])
def test_slider_follows_the_cosine_law_exactly(amplitude, mean, guide_angle):
    """Position, velocity and acceleration, at the singular angles too."""
    cam = ks.cams.CosineLaw(amplitude, mean, guide_angle)
    angles = np.concatenate([near_singular(amplitude, mean), ANGLES])
    mechanism = ks.cam_crank_slider(cam, cam.coupler_length, guide_angle=guide_angle)
    s = ks.solve(mechanism, angles + guide_angle, crank_speed=2.0, crank_acceleration=3.0)
    assert_allclose(s.slider_position, mean + amplitude * np.cos(angles), rtol=0, atol=1e-15 * mean)
    assert_close(s.slider_velocity, -2.0 * amplitude * np.sin(angles), ROUNDING)
    acceleration = -amplitude * (4.0 * np.cos(angles) + 3.0 * np.sin(angles))
    assert_close(s.slider_acceleration, acceleration, ROUNDING)


@pytest.mark.slow
def test_sawframe_forces_at_the_singular_angle():
    """Against the Newton-Euler reference with 80 digits of motion."""
    amplitude, mean, speed = 0.3, 2.0, 33.5
    cam = ks.cams.CosineLaw(amplitude, mean)
    with mp.workdps(FINE_DIGITS):
        length = critical_length(amplitude, mean)
    stiffness = 600 * speed**2
    scene = CrankSlider(
        pin=pin_by_cosine_law(amplitude, mean),
        has_cam=True,
        coupler_length=length,
        bodies={"coupler": Body(150.0, (1.0, 0.0), 20.5), "slider": Body(600.0)},
        speed=speed,
        gravity=(9.81, -1.2),
        push=lambda coordinate: -stiffness * (coordinate - mean),
    )
    mechanism = ks.cam_crank_slider(cam, cam.coupler_length, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
    angles = near_singular(amplitude, mean)
    s = ks.solve(mechanism, angles, crank_speed=speed, loads=[ks.Gravity(9.81, -1.2), ks.Spring(stiffness, mean)])
    expected = [scene.solve(angle) for angle in angles]
    for name in ("balancing_torque", "cam_force", "slot_force"):
        assert_close(getattr(s, name), [found[name] for found in expected], tolerance=1e-12)
    assert_close(planar(s.reaction("O")), [found["O"] for found in expected], tolerance=1e-12)


@pytest.mark.slow
@every("nearness", [0.03, 1e-6, 1e-12])
@every("direction", [(-1.0, 0.0), (0.6, -0.8), (0.0, 1.0)])
def test_circle_close_to_o_is_off_by_rounding(direction, nearness):
    cam = ks.cams.Circle(0.3, tuple(0.3 * (1.0 - nearness) * part for part in direction))
    angles = np.linspace(0.0, 2 * np.pi, 37) + 0.01
    found = np.transpose(cam.radius(angles))
    assert cam.is_close
    with mp.workdps(60):
        x, y, radius = map(mp.mpf, (*cam.centre, cam.pitch_radius))

        def exact(angle):
            cosine, sine = mp.cos(angle), mp.sin(angle)
            along, across = x * cosine + y * sine, y * cosine - x * sine
            root = mp.sqrt(radius**2 - across**2)
            r, lean = along + root, across / root
            return r, lean * r, lean**2 * r - along * (1 + lean**2) * r / root

        for angle, values in zip(map(mp.mpf, angles), found, strict=True):
            moved = [[abs(a - b) for a, b in zip(exact(angle + way), exact(angle), strict=True)] for way in NEXT]
            for own, wanted, *steps in zip(values, exact(angle), *moved, strict=True):
                assert abs(own - wanted) <= 1e-15 * (abs(wanted) + radius) + max(steps), float(angle)


@every("centre", [(0.0, 0.0), (-0.0219, 0.0), (0.1, -0.2), (0.0, 0.29)])
def test_circle_derivatives_equal_the_sine_rule(centre):
    """The nearer O lies to the circle, the more digits of r are lost: by radius / (radius - distance) squared."""
    cam = ks.cams.Circle(0.3, centre)
    loss = (0.3 / (0.3 - np.hypot(*centre))) ** 2
    *expected, _ = polar(pin_on_circle(0.3, centre), ANGLES)
    for found, value in zip(cam.radius(ANGLES), expected, strict=True):
        assert largest(found - value) < 1e-15 * loss
    assert_allclose(cam.pressure_angle(ANGLES), np.arctan2(expected[1], expected[0]), rtol=0, atol=1e-15 * loss)
    assert_allclose(cam.curvature_radius(ANGLES), 0.3, rtol=1e-14 * loss)


@every("before, after", [(-0.0219, -0.295), (-0.295, -0.0219)])
def test_changed_circle_is_checked_again(before, after):
    made = [
        ks.Scene(ks.cam_crank_slider(ks.cams.Circle(0.3, (x, 0.0)), 2.0, slider=ks.Link(600.0)), 33.5)
        for x in (before, after)
    ]
    varied = made[0].varied({"cam.centre.x": after})
    cams = [scene.mechanism.groups[0].cam for scene in (varied, made[1])]
    assert cams[0].is_close is cams[1].is_close is (after < -0.29)
    np.testing.assert_array_equal(*(scene.solve(9).reaction("O") for scene in (varied, made[1])))


def test_close_circles_differ_by_rounding_only():
    """One design decides on the formulas of all."""
    circle = ks.cams.Circle(0.3, (np.array([[-0.0219], [0.299]]), 0.0))
    alone, close = (ks.cams.Circle(0.3, (float(x), 0.0)) for x in (-0.0219, 0.299))
    assert (circle.is_close, alone.is_close, close.is_close) == (True, False, True)
    angle = np.linspace(0.0, 6.0, 50)
    for both, one, other in zip(circle.radius(angle), alone.radius(angle), close.radius(angle), strict=True):
        np.testing.assert_allclose(both[0], one, rtol=0, atol=4 * np.spacing(0.3))
        assert np.array_equal(both[1], other)


# What every cam has from its radius


PHI = np.linspace(0.1, 6.0, 7)


class Spiral(Cam):
    """Radius e^(k phi): the same pressure angle everywhere."""

    def polar(self, angle, ray):
        """Radius, and its derivatives."""
        r = np.exp(0.3 * angle)
        return r, 0.3 * r, 0.09 * r


class Line(Cam):
    """The straight line x = 1."""

    def polar(self, angle, ray):
        """Radius, and its derivatives."""
        x, y = ray
        return 1.0 / x, y / x**2, (1.0 + y**2) / x**3


def test_spiral_has_its_known_angle_and_curvature():
    assert Spiral().pressure_angle(PHI) == pytest.approx(np.full(7, np.arctan(0.3)), rel=1e-14)
    assert Spiral().curvature_radius(PHI) == pytest.approx(np.exp(0.3 * PHI) * np.sqrt(1.09), rel=1e-14)


def test_circle_and_line_have_their_curvature():
    assert ks.cams.Circle(2.0).curvature_radius([0.0, 1.0]).tolist() == [2.0, 2.0]
    assert abs(1.0 / Line().curvature_radius(0.4)) < 1e-14


def test_a_cam_without_its_one_method_says_so():
    with pytest.raises(TypeError, match="Cam must define polar"):
        Cam().radius(0.0)


# Cam roller


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
    """A mechanism without any bar: the cam takes the centrifugal force of the block."""
    s = ks.solve(
        ks.Mechanism("round", ks.Crank(None), (ks.CamRoller(ks.cams.Circle(0.3), BLOCK),)), TURN, crank_speed=6.0
    )
    assert s.cam_force == pytest.approx(np.full(25, 4.0 * 36.0 * 0.3), rel=1e-13)
    assert np.abs(s.slot_force).max() < 1e-12


def test_given_block_place_keeps_path_curvature():
    """Methods under study find joints in another way; on a circle the curvature is that of the circle."""
    placed, again = ROLLER.place(TURN), ROLLER.place(TURN)
    group = ks.CamRoller(CAM, BLOCK, ks.Roller(0.05, 0.06, 210e9, 0.3))
    group.follow(again, placed.joints)
    for side, room in ((-1.0, 0.25), (1.0, 0.35)):
        found = group.relative_radius("contact_pressure", again, side)
        assert found == pytest.approx(np.full(25, 0.05 * room / 0.3), rel=1e-13)

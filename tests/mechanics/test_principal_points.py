"""Principal points: mass centre and shaking force from link masses, against sums over links and ground reactions."""

from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import kinetostatics as ks
from kinetostatics.mechanics.principal_points import principal_points
from kinetostatics.numbers.planar import moment
from support.chains import chain
from support.every import every
from support.machines import largest, planar
from support.strategies import either_sign, number, reproducible
from support.turning_machines import random_machine

pytestmark = pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
"""Bodies drawn at random have any inertia."""

CLOSE = 1e-13
"""Relative to the largest part of a sum."""
KINDS = ("crank slider", "circle cam", "cosine cam", "four-bar", "six-bar")
TURN = np.linspace(0.0, 2 * np.pi, 40, endpoint=False)
each_kind = every("kind", KINDS)


def loaded(kind):
    """A random machine with mass centres off its lines, a guide off O, crank acceleration and loads of each kind."""
    return random_machine(kind, loads=("gravity", "spring", "process")).solve(TURN[:7])


def mass_weighted(s, measure):
    """Mean of a vector of the links' mass centres."""
    links = s.mechanism.links
    return sum(link.mass * measure(name) for name, link in links.items()) / sum(link.mass for link in links.values())


def external(s):
    """Every force on the mechanism from outside, as complex numbers."""
    forces = [planar(s.reaction(name)) for name in s.reactions if name in ("O", "O2", "guide", "guide2")]
    if "cam_force" in s.scalars:
        tangent = planar(s.velocity("A")) / s.crank_speed
        forces.append(s.cam_force * 1j * tangent / np.abs(tangent))
    for load in s.loads:
        if isinstance(load, ks.Gravity):
            forces += [link.mass * complex(*load.vector) for link in s.mechanism.links.values()]
        else:
            (slider,) = (group for group in s.mechanism.groups if isinstance(group, ks.SliderGroup))
            forces.append(load.push(s) * complex(*slider.guide.direction))
    return forces


# Shaking force


@pytest.mark.slow
@each_kind
def test_shaking_force_is_minus_mass_acceleration(kind):
    """Pins O and O2, guide, cam along the inward normal of its pitch curve; spring, process force and weights."""
    s = loaded(kind)
    parts = [s.inertia_force(name) for name in s.mechanism.links]
    by_points = ks.principal_points(s.mechanism).shaking_force(s)
    assert largest(by_points - sum(parts)) < CLOSE * max(map(largest, parts))
    for name, link in s.mechanism.links.items():
        assert largest(s.inertia_force(name) + link.mass * s.acceleration(name)) < CLOSE * max(map(largest, parts))
    forces = external(s)
    count = {"crank slider": 4, "circle cam": 5, "cosine cam": 5, "four-bar": 2, "six-bar": 5}[kind]
    assert len(forces) == count + len(s.mechanism.links)
    assert largest(planar(by_points) + sum(forces)) < CLOSE * max(map(largest, forces))


# Mass centre


@each_kind
def test_mass_centre_moves_as_the_weighted_mean(kind):
    """Of the links, and as the sum of principal vectors, which turn with their links or carry a joint."""
    s = loaded(kind)
    points = ks.principal_points(s.mechanism)
    for found, measure in (
        (points.mass_centre(s), s.position),
        (points.mass_centre_velocity(s), s.velocity),
        (points.mass_centre_acceleration(s), s.acceleration),
    ):
        scale = max(largest(measure(name)) for name in s.mechanism.links)
        assert largest(found - mass_weighted(s, measure)) < CLOSE * scale
    corners, vectors = np.array(points.contour(s)), points.vectors(s)
    assert np.all(corners[0] == 0)
    assert len(corners) == len(vectors) + 1
    assert largest(np.diff(corners, axis=0) - list(vectors.values())) < CLOSE * largest(corners)
    for name in s.mechanism.links:
        expected = complex(points.moduli[name], points.offsets[name]) * planar(s.placement.links[name].direction)
        assert largest(planar(vectors[name]) - expected) < CLOSE * largest(expected)
    for name, carried in points.carried.items():
        assert largest(vectors[name] - carried / points.mass * s.position(name)) < CLOSE * largest(s.position(name))


# Moduli


class Masses(NamedTuple):
    """A crank-slider as the textbook formula takes it."""

    m: tuple
    L_OA: float
    L_AB: float
    L_OS1: float
    L_AS2: float
    L_BS3: float

    @property
    def mechanism(self):
        """Mass centres on the lines."""
        arms = zip(self.m, (self.L_OS1, self.L_AS2, self.L_BS3), strict=True)
        crank, coupler, slider = (ks.Link(mass, arm) for mass, arm in arms)
        return ks.crank_slider(self.L_OA, self.L_AB, guide_angle=0.4, crank=crank, coupler=coupler, slider=slider)


@pytest.mark.slow
@settings(reproducible, max_examples=5)
@given(
    masses=st.builds(
        Masses, st.tuples(*3 * [number(0.1, 10.0)]), number(0.05, 0.5), number(0.6, 3.0), *3 * [either_sign(0.01, 1.0)]
    )
)
def test_moduli_follow_the_textbook_formula(masses):
    """Kotov 2024, equation 15: h1, h2 and h3."""
    m1, m2, m3 = masses.m
    m = m1 + m2 + m3
    moduli = ks.principal_points(masses.mechanism).moduli
    assert moduli == pytest.approx(
        {
            "crank": (m1 * masses.L_OS1 + (m2 + m3) * masses.L_OA) / m,
            "coupler": (m2 * masses.L_AS2 + m3 * masses.L_AB) / m,
            "slider": m3 * masses.L_BS3 / m,
        },
        rel=0,
        abs=2e-15 * masses.L_AB,
    )


CRANK, COUPLER, SLIDER = ks.Link(3.0, (0.1, 0.04)), ks.Link(7.0, (0.4, -0.06)), ks.Link(11.0, (-0.05, 0.08))
LINKS = {"crank": CRANK, "coupler": COUPLER, "slider": SLIDER}


def test_transverse_mass_shows_in_offsets():
    points = ks.principal_points(ks.crank_slider(0.3, 0.8, **LINKS))
    assert points.mass == 21.0
    assert points.moduli == pytest.approx(
        {"crank": (0.3 + 18 * 0.3) / 21, "coupler": (2.8 + 11 * 0.8) / 21, "slider": -0.55 / 21}, rel=1e-15
    )
    assert points.offsets == pytest.approx({"crank": 0.12 / 21, "coupler": -0.42 / 21, "slider": 0.88 / 21}, rel=1e-15)
    assert points.carried == {}


def test_sliding_pin_carries_the_outer_masses():
    """Block, coupler and slider; of the slotted crank only its own static moment is left."""
    cam = ks.cams.Circle(0.3, (-0.05, 0.03))
    points = ks.principal_points(ks.cam_crank_slider(cam, 0.8, block=ks.Link(2.0, 0.01), **LINKS))
    assert points.carried == {"A": 20.0}
    assert points.static_moments["crank"] == pytest.approx((0.3, 0.12), rel=1e-15)
    assert points.static_moments["block"] == pytest.approx((0.02, 0.0), rel=1e-15)
    assert points.static_moments["coupler"] == pytest.approx((2.8 + 11 * 0.8, -0.42), rel=1e-15)


def test_rocker_of_a_four_bar_hangs_on_its_fixed_pivot():
    links = {"crank": CRANK, "coupler": COUPLER, "rocker": ks.Link(5.0, (0.2, 0.1))}
    points = ks.principal_points(ks.four_bar(0.3, 0.8, 0.6, rocker_pivot=(0.7, 0.0), **links))
    assert points.carried == {"O2": 5.0}
    assert points.static_moments["crank"] == pytest.approx((0.3 + 7 * 0.3, 0.12), rel=1e-15)
    assert points.static_moments["coupler"] == pytest.approx((2.8, -0.42), rel=1e-15)
    assert points.static_moments["rocker"] == pytest.approx((1.0, 0.5), rel=1e-15)


def test_round_cam_about_o_equals_a_plain_crank():
    """Though one counts mass carried by A and the other a modulus along the crank."""
    made = ks.crank_slider(0.3, 0.8, **LINKS), ks.cam_crank_slider(ks.cams.Circle(0.3), 0.8, **LINKS)
    plain, cam = (ks.solve(mechanism, TURN, crank_speed=9.0, crank_acceleration=-20.0) for mechanism in made)
    points = [ks.principal_points(s.mechanism) for s in (plain, cam)]
    assert (points[0].carried, points[1].carried) == ({}, {"A": 18.0})
    np.testing.assert_allclose(points[1].mass_centre(cam), points[0].mass_centre(plain), rtol=0, atol=1e-15)
    scale = largest(plain.shaking_force)
    np.testing.assert_allclose(cam.shaking_force, plain.shaking_force, rtol=0, atol=CLOSE * scale)


# Batches, absent masses


def test_no_mass_has_no_mass_centre():
    s = ks.solve(ks.crank_slider(0.3, 0.8), TURN, crank_speed=9.0)
    points = ks.principal_points(s.mechanism)
    for ask in (points.mass_centre, points.mass_centre_velocity, points.mass_centre_acceleration, points.contour):
        with pytest.raises(ks.ParameterError, match="has no mass and so no mass centre; give at least one link a mass"):
            ask(s)
    with pytest.raises(ks.ParameterError, match="no mass"):
        _ = points.moduli
    np.testing.assert_array_equal(points.shaking_force(s), np.zeros((2, TURN.size)))


def test_mass_centre_on_the_pivot_shakes_nothing():
    s = ks.solve(ks.crank_slider(0.3, 0.8, crank=ks.Link(5.0)), TURN, crank_speed=9.0, crank_acceleration=3.0)
    points = ks.principal_points(s.mechanism)
    for found in (points.mass_centre(s), points.mass_centre_velocity(s), points.shaking_force(s)):
        np.testing.assert_array_equal(found, np.zeros((2, TURN.size)))


@pytest.mark.parametrize("seed", [*range(3), *(pytest.param(n, marks=pytest.mark.slow) for n in range(3, 12))])
def test_momentum_of_random_chains_gives_shaking(seed):
    scene, angles = chain(seed)
    s = scene.solve(angles)
    links = s.mechanism.links
    forces = {name: -link.mass * s.acceleration(name) for name, link in links.items()}
    moments = {
        name: moment(s.position(name), force) - links[name].inertia * s.angular_acceleration(name)
        for name, force in forces.items()
    }
    points, mass = principal_points(s.mechanism), sum(link.mass for link in links.values())
    for found, parts in [
        (s.shaking_force, forces),
        (s.shaking_moment, moments),
        (mass * points.mass_centre(s), {name: link.mass * s.position(name) for name, link in links.items()}),
        (mass * points.mass_centre_velocity(s), {name: link.mass * s.velocity(name) for name, link in links.items()}),
    ]:
        largest = max(np.abs(part).max() for part in parts.values())
        assert np.abs(found - sum(parts.values())).max() < CLOSE * largest

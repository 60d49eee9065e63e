"""The roller itself: spin that is rolled off, reversal, friction that it takes to roll, load and life of its pin."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.cam_contacts import STEEL, contact, solved
from support.machines import ANGLES


def test_a_roller_that_changes_sides_reverses_its_spin_by_sliding():
    found = contact(solved(25.0), roller_mass=2.0)
    for angle, reversal in zip(found.changes, found.reversals, strict=True):
        force = solved(25.0, angles=angle + np.array([-1e-6, 1e-6])).cam_force
        assert reversal.rise == pytest.approx((force[1] - force[0]) / 2e-6, rel=1e-4)
        before, after = found.roller.spin(solved(25.0, angles=angle + np.array([-1e-9, 1e-9])))
        assert reversal.spin == pytest.approx(after - before, rel=1e-6)
        assert reversal.energy == pytest.approx(0.5 * (0.5 * 2.0 * 0.05**2) * (after - before) ** 2, rel=1e-6)
        slid = reversal.sliding_angle(found.roller, 25.0, 0.1)
        impulse = 0.1 * 0.05 * abs(reversal.rise) * slid**2 / 2 / 25.0  # of friction, as the force grows in proportion
        assert impulse == pytest.approx(0.5 * 2.0 * 0.05**2 * abs(reversal.spin), rel=1e-12)


def test_spin_and_its_rate_are_those_of_the_path_rolled_off():
    """On a circle about its centre the roller turns evenly; elsewhere its spin is the path's speed by radius."""
    found, step = contact(), 1e-5
    motion = [solved(angles=ANGLES + side * step) for side in (-1, 0, 1)]
    spins = [found.roller.spin(at) for at in motion]
    assert_allclose(np.abs(spins[1]), np.hypot(*motion[1].velocity("A")) / 0.05, rtol=1e-13)
    assert_allclose(found.roller.spin_acceleration(motion[1]), (spins[2] - spins[0]) / (2 * step) * 33.5, atol=1e-3)
    ring = ks.cam_crank_slider(ks.cams.Circle(0.2), 0.8, slider=ks.Link(10.0))
    even = contact(solved(machine=ring, loads=()), roller_mass=3.0)
    assert_allclose(even.roller.spin_acceleration(even.solution), 0.0, atol=1e-12)


def test_rolling_takes_the_inertia_of_the_roller_and_the_friction_of_its_pin():
    found = contact(roller_mass=4.0)
    needed = 0.5 * 4.0 * np.abs(found.roller.spin_acceleration(found.solution)) * 0.05 / np.abs(found.cam_force)
    assert_allclose(found.roller.friction_coefficient(found.solution), needed, rtol=1e-12)
    assert found.largest_friction_coefficient.value >= needed.max()
    rubbing = solved(friction={"cam": ks.RollerFriction(0.1, 0.02, 0.05)})
    alone = contact(rubbing).roller.friction_coefficient(rubbing)
    assert_allclose(alone, 0.1 * 0.02 / 0.05, rtol=2e-3)  # the moment of the whole pin load by the roller's radius


def test_the_pin_carries_the_cam_force_less_inertia_and_weight_of_the_roller():
    plain, heavy = contact(), contact(roller_mass=15.0, roller_inertia=0.0)
    assert_allclose(plain.roller.pin_load(plain.solution), np.abs(plain.cam_force), rtol=1e-14)
    velocity = plain.solution.velocity("A")
    inward = np.stack([-velocity[1], velocity[0]]) / np.hypot(*velocity)
    force = inward * plain.cam_force + 15.0 * (np.array([[0.0], [-9.81]]) - plain.solution.acceleration("A"))
    assert_allclose(heavy.roller.pin_load(heavy.solution), np.hypot(*force), rtol=1e-12)


def test_life_of_a_constant_load_is_the_catalogue_s():
    """A circle about O, turned evenly by a block of its own: a constant centrifugal force, constant spin."""
    machine = ks.Mechanism("wheel", ks.Crank(None), (ks.CamRoller(ks.cams.Circle(0.2), ks.Link(100.0)),))
    solution = ks.solve(machine, ANGLES, crank_speed=10.0)
    found = ks.design.contact(solution, 0.04, 0.02, *STEEL, load_rating=40e3)
    load, turns_a_second = 100.0 * 0.2 * 10.0**2, (10.0 * 0.2 / 0.04 + 10.0) / (2 * np.pi)
    assert found.equivalent_load == pytest.approx(load, rel=1e-13)
    assert found.sides == ("ring",)
    assert found.life == pytest.approx((40e3 / load) ** (10 / 3) * 1e6 / (3600 * turns_a_second), rel=1e-12)
    ball = ks.design.contact(solution, 0.04, 0.02, *STEEL, load_rating=40e3, life_exponent=3)
    assert ball.life == pytest.approx((40e3 / load) ** 3 * 1e6 / (3600 * turns_a_second), rel=1e-12)


def test_the_equivalent_load_lies_between_mean_and_largest():
    found = contact(load_rating=120e3)
    load = found.roller.pin_load(solved(angles=np.linspace(0, 2 * np.pi, 1440, endpoint=False)))
    assert load.mean() < found.equivalent_load < load.max()

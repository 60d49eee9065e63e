"""Cam contact, lift-off, and curves in parts."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.cycle.reductions import parsed
from kinetostatics.design.cam_contact import hardness_from_pressure, pressure_from_hardness
from kinetostatics.design.problem import Problem, true_value
from kinetostatics.machine.cams import roller
from support.cam_contacts import CAM, LOADS, STEEL, contact, rolled, solved
from support.machines import ANGLES


def test_hertz_pressure_by_radii_and_half_width():
    """By way of b = sqrt(8 F R1 R2 (1 - nu^2) / (pi w E (R1 + R2))) and p0 = 2 F / (pi b w), radius by radius."""
    for speed in (25.0, 33.5, 60.0):
        found = contact(solved(speed))
        force, roller, cam = found.cam_force, 0.05, found.curvature_radius
        width = np.sqrt(8 * np.abs(force) * roller * cam * (1 - 0.3**2) / (np.pi * 0.06 * 210e9 * (roller + cam)))
        assert_allclose(found.half_width, width, rtol=1e-10)
        assert_allclose(found.pressure, 2 * np.abs(force) / (np.pi * width * 0.06), rtol=1e-10)
        ring = force > 0
        assert np.all((found.side == "ring") == ring)
        assert np.all((cam < 0) == ring)
        pitch = CAM.curvature_radius(ANGLES)
        assert_allclose(np.abs(cam), np.where(ring, pitch + roller, pitch - roller), rtol=1e-12)


def test_two_materials_press_by_mean_compliance():
    one, other = (210e9, 0.3), (110e9, 0.25)
    mixed = ks.design.contact(solved(), 0.05, 0.06, (one[0], other[0]), (one[1], other[1]))
    assert mixed.modulus == pytest.approx(1.0 / (0.91 / 210e9 + 0.9375 / 110e9), rel=1e-15)


def test_steel_on_steel_has_the_handbook_factor():
    """p0 = 0.418 sqrt(F E / (w R)) for equal moduli and a ratio of 0.3 (Dubbel; Hertz's formula by Stribeck)."""
    modulus = roller.contact_modulus(STEEL, STEEL)
    assert roller.pressure(5e3, 0.02, modulus, 0.04) == pytest.approx(
        0.418 * np.sqrt(5e3 * 210e9 / (0.02 * 0.04)), rel=6e-4
    )


def test_largest_pressure_lies_between_angles():
    found = contact()
    fine = contact(solved(angles=np.linspace(0, 2 * np.pi, 20001)))
    assert found.largest_pressure.value == pytest.approx(fine.pressure.max(), rel=1e-8)
    assert found.largest_pressure.value >= found.pressure.max()


def test_roller_changes_sides_with_the_cam_force():
    found = contact(solved(25.0), roller_mass=2.0)
    assert len(found.changes) == 4
    assert found.sides == ("disk", "ring")
    for angle in found.changes:
        force = solved(25.0, angles=angle + np.array([-1e-6, 0.0, 1e-6])).cam_force
        assert force[0] * force[2] < 0
        assert abs(force[1]) < 1e-6
    assert found.largest_friction_coefficient.value == np.inf
    assert contact().changes == ()
    assert contact().sides == ("ring",)


def test_hardness_and_pressure_are_inverses():
    found = contact()
    assert pressure_from_hardness(found.hardness) == pytest.approx(found.largest_pressure.value, rel=1e-13)
    for brinell in (180.0, 250.0, 400.0):
        assert hardness_from_pressure(pressure_from_hardness(brinell)) == pytest.approx(brinell, rel=1e-14)


BROKEN = {
    "pressure": (5e8, r"Hertz pressure: 8\.1\S+ Pa at 180\.\d+ deg, more than 5e\+08"),
    "pin_load": (4e4, r"load of the roller's pin: \S+ N at 180\.\d+ deg, more than 40000"),
    "friction_coefficient": (1e-6, "friction coefficient that keeps the roller rolling: 0.0"),
    "pressure_angle": (0.05, r"ring: the pressure angle reaches 4\.23\d+ deg at crank angle"),
    "life": (1e6, r"life of the roller's bearing: \S+ h, less than 1e\+06"),
    "lift_off_speed": (1.0, "speed of lift-off: 0 rad/s, less than 1"),
    "starting_torque": (1e3, r"torque to start: 3\d{4}\S* N m at \S+ deg, more than 1000"),
}


def test_the_largest_pressure_angle_is_that_of_the_cam():
    angles = np.abs(CAM.pressure_angle(np.linspace(0.0, 2 * np.pi, 3601)))
    assert contact().largest_pressure_angle.value == pytest.approx(angles.max(), rel=1e-6)


@pytest.mark.parametrize("name", BROKEN)
def test_exceeded_limits_are_named_with_both_numbers(name):
    limit, message = BROKEN[name]
    found = contact(load_rating=120e3, roller_mass=2.0, limits={name: limit})
    (text,) = found.exceeded
    assert re.match(message, text), text
    assert text in repr(found)
    wide = 1e-9 if name in ("life", "lift_off_speed") else 1e12
    if name != "lift_off_speed":
        assert contact(load_rating=120e3, roller_mass=2.0, limits={name: wide}).exceeded == ()


def test_the_contact_table_has_a_row_an_angle():
    found = contact(roller_mass=2.0)
    table = found.frame()
    assert len(table) == len(ANGLES)
    assert_allclose(table["pressure [Pa]"], found.pressure)
    assert set(table["side"]) == {"ring"}


@pytest.mark.slow
def test_table_cam_states_its_force_error():
    angle = np.radians(np.arange(360))
    sampled = ks.cams.Sampled(angle, np.round(CAM.radius(angle)[0], 6), noise=0.29e-6)
    machine = ks.cam_crank_slider(sampled, CAM.coupler_length, slider=ks.Link(600.0))
    found = contact(solved(machine=machine))
    assert found.force_error == sampled.force_error
    assert "forces by 0.0004" in repr(found)
    assert contact().force_error is None


# The roller itself


def test_changing_sides_reverses_spin_by_sliding():
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


def test_spin_is_that_of_the_path_rolled_off():
    """On a circle about its centre the roller turns evenly; elsewhere its spin is the path's speed by radius."""
    found, step = contact(), 1e-5
    motion = [solved(angles=ANGLES + side * step) for side in (-1, 0, 1)]
    spins = [found.roller.spin(at) for at in motion]
    assert_allclose(np.abs(spins[1]), np.hypot(*motion[1].velocity("A")) / 0.05, rtol=1e-13)
    assert_allclose(found.roller.spin_acceleration(motion[1]), (spins[2] - spins[0]) / (2 * step) * 33.5, atol=1e-3)
    ring = ks.cam_crank_slider(ks.cams.Circle(0.2), 0.8, slider=ks.Link(10.0))
    even = contact(solved(machine=ring, loads=()), roller_mass=3.0)
    assert_allclose(even.roller.spin_acceleration(even.solution), 0.0, atol=1e-12)


def test_rolling_takes_inertia_and_pin_friction():
    found = contact(roller_mass=4.0)
    needed = 0.5 * 4.0 * np.abs(found.roller.spin_acceleration(found.solution)) * 0.05 / np.abs(found.cam_force)
    assert_allclose(found.roller.friction_coefficient(found.solution), needed, rtol=1e-12)
    assert found.largest_friction_coefficient.value >= needed.max()
    rubbing = solved(friction={"cam": ks.RollerFriction(0.1, 0.02, 0.05)})
    alone = contact(rubbing).roller.friction_coefficient(rubbing)
    assert_allclose(alone, 0.1 * 0.02 / 0.05, rtol=2e-3)  # the moment of the whole pin load by the roller's radius


def test_pin_carries_cam_force_less_roller_inertia():
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


def test_equivalent_load_is_between_mean_and_largest():
    found = contact(load_rating=120e3)
    load = found.roller.pin_load(solved(angles=np.linspace(0, 2 * np.pi, 1440, endpoint=False)))
    assert load.mean() < found.equivalent_load < load.max()


# What a contact is asked with


def test_contact_defaults_to_the_scenes_roller():
    own = solved(machine=rolled((0.05, 0.06, *STEEL, 110e9)))
    found = ks.design.contact(own)
    assert_allclose(found.pressure, own.contact_pressure, rtol=1e-13)
    assert found.modulus == pytest.approx(1.0 / (0.91 / 210e9 + 0.91 / 110e9), rel=1e-15)
    wide = ks.design.contact(own, width=0.24)
    assert_allclose(wide.pressure, own.contact_pressure / 2, rtol=1e-13)
    with pytest.raises(ks.ParameterError, match="width, poissons_ratio must be given, since the block has no Roller"):
        ks.design.contact(solved(), 0.05, youngs_modulus=210e9)


# What steel of a hardness bears


@pytest.mark.parametrize(("pressure", "brinell"), [(0.0, 180.0), (2e8, 180.0), (5.996e8, 180.0), (1.31e9, 500.0)])
def test_soft_steel_is_as_soft_as_the_standard_tells(pressure, brinell):
    assert hardness_from_pressure(pressure) == pytest.approx(brinell)


@pytest.mark.parametrize(
    ("function", "value", "words"),
    [
        *((pressure_from_hardness, value, "covers 180 to 400 HB, got ") for value in (179.0, 401.0, 500.0)),
        *((pressure_from_hardness, value, "pressure_from_hardness") for value in (0.0, "300")),
        *((hardness_from_pressure, value, "hardness_from_pressure") for value in (-1.0, float("nan"), "1 GPa", None)),
    ],
)
def test_what_is_no_hardness_or_pressure_is_refused(function, value, words):
    with pytest.raises(ks.ParameterError, match=words):
        function(value)


# What sets the speed of a cam with springs

FOLLOWER = ks.CamRoller(ks.cams.Circle(0.1, (0.02, 0.01)), block=ks.Link(2.0))
FOLLOWING = ks.Mechanism("cam drive", ks.Crank(None), (FOLLOWER,))
PULL = ks.PointSpring(5e3, 0.03, between=("A", (0.0, 0.0)))


def test_follower_lifts_off_at_its_springs_limit():
    """Along the ray m (r'' - r) omega^2 = -k (r - l0) where the cam gives nothing: the least omega over the turn."""
    found = ks.design.lift_off_speed(ks.solve(FOLLOWING, ANGLES, crank_speed=10.0, loads=PULL))
    r, _, second = FOLLOWER.cam.radius(np.linspace(0, 2 * np.pi, 100_001))
    assert found == pytest.approx(np.sqrt(np.min(5e3 * (r - 0.03) / (2.0 * (r - second)))), rel=1e-8)
    for factor, positive in ((0.999, False), (1.001, True)):
        force = ks.solve(FOLLOWING, ANGLES, crank_speed=factor * found, loads=PULL)
        assert bool(np.any(ks.extremes(force, "cam_force").value > 0)) is positive


def test_a_damper_shifts_the_speed_of_lift_off():
    """Its force grows with the speed itself, so squares do not tell; the force at the speed found just vanishes."""
    loads = [PULL, ks.PointDamper(40.0, between=("A", (0.0, 0.0)))]
    found = ks.design.lift_off_speed(ks.solve(FOLLOWING, ANGLES, crank_speed=10.0, loads=loads))
    force = ks.solve(
        FOLLOWING, np.linspace(0, 2 * np.pi, 1440, endpoint=False), crank_speed=found, loads=loads
    ).cam_force
    assert abs(force.max()) < 1e-6 * abs(force.min())


def test_machine_held_on_both_sides_lifts_off_at_once():
    assert ks.design.lift_off_speed(solved()) == 0.0


def test_without_inertia_nothing_lifts_off():
    light = ks.Mechanism("light", ks.Crank(None), (ks.CamRoller(FOLLOWER.cam),))
    assert ks.design.lift_off_speed(ks.solve(light, ANGLES, crank_speed=10.0, loads=PULL)) == np.inf


@pytest.mark.slow
def test_starting_torque_of_springs_weights_friction():
    rest = np.abs(solved(0.0, angles=np.linspace(0, 2 * np.pi, 7201)).balancing_torque)
    assert ks.design.starting_torque(solved()).value == pytest.approx(rest.max(), rel=1e-6)
    rubbing = solved(friction={"O": ks.PinFriction(0.1, 0.05)})
    assert ks.design.starting_torque(rubbing).value > 1.001 * rest.max()


def test_springs_surge_at_their_natural_frequency():
    found = ks.design.spring_surge(solved(), 30.0)
    stiffness = LOADS[1].stiffness
    assert found.natural_frequency == pytest.approx(np.pi * np.sqrt(stiffness / 30.0), rel=1e-14)
    assert found.order == pytest.approx(found.natural_frequency / 33.5)
    assert_allclose(found.amplitudes[:3], [2.0, 0.3, 0.0], atol=1e-12)
    assert found.speeds()[4] == pytest.approx(found.natural_frequency / 4)


TURNING = ks.Mechanism(
    "cam drive", ks.Crank(None), (ks.RollerFollower(ks.laws.cosine(0.01, 0.05), follower=ks.Link(2.0)),)
)


def turned(speed, free=0.04):
    return ks.solve(TURNING, ANGLES, crank_speed=speed, loads=ks.Spring(5e3, free, on="follower"))


@pytest.mark.slow
def test_follower_on_turning_cam_lifts_off():
    """M s'' omega^2 + k (s - s0) = 0 with s = 0.05 + 0.01 cos: at the top, 2 omega^2 = 5000 (0.02 / 0.01)."""
    found = ks.design.lift_off_speed(turned(10.0), "contact_force")
    assert found == pytest.approx(np.sqrt(5e3), rel=1e-9)
    assert ks.design.lifted(turned(0.999 * found), "contact_force") == ()
    ((start, stop),) = ks.design.lifted(turned(1.2 * found), "contact_force")
    cosine = 0.01 / (0.01 * (1.44 * 2.0 - 1.0))
    assert_allclose([start, stop], [-np.arccos(cosine), np.arccos(cosine)], atol=1e-9)


def test_a_wrong_sided_spring_never_presses():
    assert ks.design.lifted(turned(1.0, free=0.1), "contact_force") == ((0.0, 2 * np.pi),)


def test_an_unknown_force_lists_the_known_ones():
    for function in (ks.design.lifted, ks.design.lift_off_speed):
        with pytest.raises(ks.ParameterError, match="'contact_force'"):
            function(turned(10.0), "contact")


# Pulses of a table that are narrower than the steps of an even look at the turn

PULSE = np.radians(0.14)


def pulse(place, height):
    """Table of a pulse 0.14 deg wide, flat over half its width."""
    corners = place + PULSE * np.array([-0.5, -0.25, 0.25, 0.5])
    return ks.Table([0.0, *corners, 2 * np.pi], height * np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]), zero=0.0)


def around(place):
    """Crank angles over the turn, most of them in a pulse, its corners among them."""
    return np.unique([*np.linspace(0.0, 2 * np.pi, 40_001), *place + PULSE * np.linspace(-0.5, 0.5, 40_001)])


def pulled(speed, place, height, *others):
    """A spring holds the follower down, a table pulls it up."""
    loads = ks.Spring(2e4, 0.01, on="follower"), ks.ProcessForce(pulse(place, height), on="follower"), *others
    return ks.solve(TURNING, 0.0, crank_speed=speed, loads=loads)


@pytest.mark.slow
def test_a_pulse_lifts_off_a_machine_at_rest():
    """The spring presses with 600 to 1000 N; at the top 2 kg need 0.02 omega^2 of it."""
    assert ks.design.lift_off_speed(pulled(10.0, 2.0, 500.0), "contact_force") == pytest.approx(np.sqrt(5e4), rel=1e-9)
    for place in np.linspace(0.4, 5.9, 5):
        assert ks.design.lift_off_speed(pulled(10.0, place, 2500.0), "contact_force") == 0.0
        share = 0.5 * 2e4 * (0.04 + 0.01 * np.cos(place)) / 2500.0
        ((start, stop),) = ks.design.lifted(pulled(1e-3, place, 2500.0), "contact_force")
        expected = place + PULSE * (0.5 - 0.5 * share) * np.array([-1.0, 1.0])
        assert_allclose([start, stop], expected, rtol=0, atol=1e-4 * PULSE)


@pytest.mark.slow
@pytest.mark.parametrize("damping", [0.0, 50.0])
def test_a_pulse_lowers_the_speed_of_lift_off(damping):
    """The least root of 0.02 c w^2 + 0.01 b s w = 2e4 (0.04 + 0.01 c) - P(phi) over the turn, c and s cos and sin."""
    place, height = 0.6, 500.0
    angle, table = around(place), pulse(place, height)
    angle = angle[np.cos(angle) > 0.0]
    c, s = np.cos(angle), np.sin(angle)
    spare = 2e4 * (0.04 + 0.01 * c) - np.interp(angle, table.x, table.y, right=0.0)
    half = 0.5 * 0.01 * damping * s
    expected = np.min(spare / (half + np.sqrt(half**2 + 0.02 * c * spare)))
    dampers = [ks.PointDamper(damping, between=("R", (0.0, 0.0)))] if damping else []
    found = ks.design.lift_off_speed(pulled(10.0, place, height, *dampers), "contact_force")
    assert found == pytest.approx(expected, rel=1e-9)
    assert expected < 180.0


def test_a_pulse_is_what_must_be_overcome_to_start():
    """5 kN on a yoke, at the full crank of 0.3 m."""
    yoke = ks.scotch_yoke(0.3, slider=ks.Link(10.0))
    solution = ks.solve(yoke, 0.0, crank_speed=10.0, loads=ks.ProcessForce(pulse(np.pi / 2, 5e3)))
    found = ks.design.starting_torque(solution)
    assert found.value == pytest.approx(1500.0, rel=1e-12)
    assert found.angle == pytest.approx(np.pi / 2, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("place", "height", "sides"), [(2.35, -4e5, ("ring",)), (4.4, 4e5, ("disk", "ring"))])
def test_a_pulse_presses_the_roller_and_wears_its_bearing(place, height, sides):
    """By Hertz's formula for two radii at 80 000 crank angles."""
    loads = [*LOADS, ks.ProcessForce(pulse(place, height))]
    found = contact(solved(loads=loads), load_rating=120e3)
    dense = solved(loads=loads, angles=around(place))
    assert found.sides == sides == tuple(np.unique(np.where(dense.cam_force > 0.0, "ring", "disk")))
    force, pitch = dense.cam_force, CAM.curvature_radius(dense.crank_angle)
    cam = np.where(force > 0.0, -(pitch + 0.05), pitch - 0.05)
    pressure = np.sqrt(np.abs(force) * 210e9 * (1.0 / 0.05 + 1.0 / cam) / (2.0 * np.pi * 0.06 * (1.0 - 0.3**2)))
    assert found.largest_pressure.value == pytest.approx(pressure.max(), rel=1e-8)
    assert pressure.max() > 1.5 * contact().largest_pressure.value
    load, spin = found.roller.pin_load(dense), np.abs(found.roller.spin(dense) - 33.5)
    powers = [np.trapezoid(load**power * spin, dense.crank_angle) for power in (10 / 3, 0)]
    assert found.equivalent_load == pytest.approx((powers[0] / powers[1]) ** 0.3, rel=1e-6)
    assert found.life == pytest.approx(
        (120e3 / found.equivalent_load) ** (10 / 3) * 1e6 / 3600.0 * (2 * np.pi) ** 2 / powers[1], rel=1e-6
    )


def test_a_spring_is_excited_by_a_rise_of_a_tenth_of_a_degree():
    """Fourier sums of the law at Gauss points of each segment."""
    width = np.radians(0.1)
    rise, back = ks.laws.cycloidal(0.05, 0.055, width), ks.laws.cycloidal(0.055, 0.05, 3.0)
    law = ks.laws.joined(rise, ks.laws.dwell(0.055, 1.0), back, ks.laws.dwell(0.05, 2 * np.pi - 4.0 - width))
    machine = ks.Mechanism("cam drive", ks.Crank(None), (ks.RollerFollower(law, follower=ks.Link(2.0)),))
    solution = ks.solve(machine, 0.0, crank_speed=10.0, loads=ks.Spring(5e3, 0.04, on="follower"))
    found, order = ks.design.spring_surge(solution, 0.5).amplitudes, np.arange(40)
    point, weight = np.polynomial.legendre.leggauss(80)
    waves = 0.0
    for low, segment in zip(law.starts, law.segments, strict=False):
        angle = 0.5 * segment.angle * (point + 1.0)
        waves = waves + np.exp(1j * np.outer(order, low + angle)) @ (
            0.5 * segment.angle * weight * segment.at(angle)[0]
        )
    expected = np.abs(waves) / np.pi
    expected[0] /= 2.0
    assert_allclose(found[:40], expected, rtol=0, atol=1e-12)


def test_a_progressive_spring_surges_by_its_mean_rate():
    pump, angle = ks.crank_slider(0.1, 0.3), np.linspace(0, 2 * np.pi, 3600, endpoint=False)
    spring = ks.Spring(2e3, 0.25, cubic=4e5)
    solution = ks.solve(pump, angle, crank_speed=10.0, loads=spring)
    step = 1e-5
    rate = np.mean([spring_force(spring, solution.slider_position + side * step) for side in (1, -1)], axis=1)
    found = ks.design.spring_surge(solution, 0.5)
    assert found.natural_frequency == pytest.approx(np.pi * np.sqrt((rate[0] - rate[1]) / (2 * step) / 0.5), rel=1e-6)


def spring_force(spring, place):
    return spring.stiffness * (place - spring.free_position) + spring.cubic * (place - spring.free_position) ** 3


@pytest.mark.parametrize("loads", [[], [ks.Spring(2e3, 0.3), ks.Spring(2e3, 0.3)], ks.Spring(0.0, 0.3)])
def test_what_cannot_surge_is_refused(loads):
    solution = ks.solve(ks.crank_slider(0.1, 0.3), 0.5, crank_speed=10.0, loads=loads)
    with pytest.raises(ks.ParameterError, match="spring_surge: "):
        ks.design.spring_surge(solution, 0.5)


@pytest.mark.parametrize("orders", [0, [1, 0], [-1], [1.5], ["x"]])
def test_orders_are_whole_numbers_of_turns(orders):
    solution = ks.solve(ks.crank_slider(0.1, 0.3), 0.5, crank_speed=10.0, loads=ks.Spring(2e3, 0.3))
    with pytest.raises(ks.ParameterError, match="an order must be a whole number"):
        ks.design.spring_surge(solution, 0.5).speeds(orders)


# Curves on pieces between bends

KINDS = ("largest", "smallest", "range", "largest_absolute", "mean", "mean_absolute", "rms", "harmonic_2")
OUTPUTS = [f"{kind} {name}" for kind in KINDS for name in ("balancing_torque", "O")] + ["swing balancing_torque"]
VARY = {"crank_length": (0.03, 0.07), "slider.mass": (0.5, 4.0)}


def pump(friction=None, width=2e-4):
    """A pump whose force rises and falls within a degree, so that even samples miss the top."""
    rows = [0.1, 0.2, 0.2 + width, 0.2 + 2 * width, 0.3], [0.0, 0.0, 3e3, 0.0, 0.0]
    made = ks.crank_slider(
        0.05, 0.19, guide_offset=0.01, coupler=ks.Link(1.0, 0.1, 0.01), slider=ks.Link(2.0), crank=ks.Link(1.0, 0.01)
    )
    force = ks.ProcessForce(ks.Table(*rows, over="travel"))
    return ks.Scene(made, 30.0, loads=[ks.Gravity(), force], friction=friction or {})


SCENES = {
    "spike": pump(),
    "pins": pump({"O": ks.PinFriction(0.1, 0.02), "B": ks.PinFriction(0.1, 0.02)}),
}


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "text"), [(list(SCENES)[place % 2], text) for place, text in enumerate(OUTPUTS)])
def test_derivatives_are_those_of_the_number(kind, text):
    output, step = parsed(text), np.array([1e-6, 1e-4])
    problem = Problem(SCENES[kind], VARY, [output.quantity])
    start = problem.start
    found, slopes = problem.output(output, start)
    assert found == pytest.approx(true_value(output, SCENES[kind]), rel=1e-6)
    for place, size in enumerate(step):
        move = size * np.eye(2)[place]
        above, below = (true_value(output, problem.scene(start + side * move)) for side in (1.0, -1.0))
        difference = (above - below) / (2.0 * size)
        scale = max(abs(found), 1e-3 * true_value(parsed(f"rms {output.quantity}"), SCENES[kind])) / start[place]
        assert slopes[place] == pytest.approx(difference, rel=2e-3, abs=2e-3 * scale)

"""Contact of a roller on its cam: Hertz against other formulas, sides, limits that are exceeded."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine import hertz
from support.cam_contacts import CAM, STEEL, contact, solved
from support.machines import ANGLES


def test_pressure_of_hertz_by_radii_and_the_larger_half_width():
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


def test_two_materials_press_like_their_mean_compliance():
    one, other = (210e9, 0.3), (110e9, 0.25)
    mixed = ks.design.contact(solved(), 0.05, 0.06, (one[0], other[0]), (one[1], other[1]))
    assert mixed.modulus == pytest.approx(1.0 / (0.91 / 210e9 + 0.9375 / 110e9), rel=1e-15)


def test_steel_on_steel_has_the_factor_of_the_handbooks():
    """p0 = 0.418 sqrt(F E / (w R)) for equal moduli and a ratio of 0.3 (Dubbel; Hertz's formula by Stribeck)."""
    modulus = hertz.modulus(STEEL, STEEL)
    assert hertz.pressure(5e3, 0.02, modulus, 0.04) == pytest.approx(
        0.418 * np.sqrt(5e3 * 210e9 / (0.02 * 0.04)), rel=6e-4
    )


def test_the_largest_pressure_is_that_between_the_angles_given():
    found = contact()
    fine = contact(solved(angles=np.linspace(0, 2 * np.pi, 20001)))
    assert found.largest_pressure.value == pytest.approx(fine.pressure.max(), rel=1e-8)
    assert found.largest_pressure.value >= found.pressure.max()


def test_the_roller_changes_sides_where_the_cam_force_changes_its_sign():
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


def test_hardness_and_pressure_are_each_other_s_inverse():
    found = contact()
    assert ks.design.pressure_from_hardness(found.hardness) == pytest.approx(found.largest_pressure.value, rel=1e-13)
    with pytest.raises(ks.ParameterError, match="tells of 180 to 400 HB, got 500"):
        ks.design.pressure_from_hardness(500.0)


BROKEN = {
    "pressure": (5e8, r"Hertz pressure: 8\.1\S+ Pa at 180\.\d+ deg, more than 5e\+08"),
    "pin_load": (4e4, r"load of the roller's pin: \S+ N at 180\.\d+ deg, more than 40000"),
    "friction_coefficient": (1e-6, "friction coefficient that keeps the roller rolling: 0.0"),
    "pressure_angle": (0.05, r"ring: the pressure angle reaches 4\.23\d+ deg at crank angle"),
    "life": (1e6, r"life of the roller's bearing: \S+ h, less than 1e\+06"),
    "lift_off_speed": (1.0, "speed of lift-off: 0 rad/s, less than 1"),
    "starting_torque": (1e3, r"torque to start: 3\d{4}\S* N m at \S+ deg, more than 1000"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_exceeds_a_limit_is_said_with_both_numbers(name):
    limit, message = BROKEN[name]
    found = contact(load_rating=120e3, roller_mass=2.0, limits={name: limit})
    (text,) = found.exceeded
    assert re.match(message, text), text
    assert text in repr(found)
    wide = 1e-9 if name in ("life", "lift_off_speed") else 1e12
    if name != "lift_off_speed":
        assert contact(load_rating=120e3, roller_mass=2.0, limits={name: wide}).exceeded == ()


def test_the_table_has_a_row_for_each_angle_and_what_the_contact_gives():
    found = contact(roller_mass=2.0)
    table = found.frame()
    assert len(table) == len(ANGLES)
    assert_allclose(table["pressure [Pa]"], found.pressure)
    assert set(table["side"]) == {"ring"}


def test_a_cam_from_a_table_states_the_error_of_its_forces():
    angle = np.radians(np.arange(360))
    sampled = ks.cams.Sampled(angle, np.round(CAM.radius(angle)[0], 6), noise=0.29e-6)
    machine = ks.cam_crank_slider(sampled, CAM.coupler_length, slider=ks.Link(600.0))
    found = contact(solved(machine=machine))
    assert found.force_error == sampled.force_error
    assert "forces by 0.0004" in repr(found)
    assert contact().force_error is None

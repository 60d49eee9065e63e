"""What a placement knows of how joints move agrees with where they are."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.placement import UNKNOWN, Throw

ANGLES = np.linspace(0.1, 6.2, 9)


def near(found, expected):
    return np.max(np.abs(np.subtract(found, expected))) < 1e-15


def test_pins_of_the_crank_are_throws_as_far_from_o_as_told():
    placement = ks.Mechanism("crank", ks.Crank(0.3), (ks.Pin(on="crank", at=(0.03, -0.04), name="P"),)).place(ANGLES)
    for name in ("A", "P"):
        radius, direction = placement.course(name).throw.polar
        x, y = placement.joints[name].position
        assert near(np.hypot(x, y), radius)
        ahead = 0.0 if direction is None else np.angle(complex(*direction))
        assert near(np.exp(1j * (ANGLES + ahead)), (x + 1j * y) / radius)


def test_what_rounding_takes_off_a_throw_beside_the_ray_is_kept():
    radius, rest = Throw((0.1, 0.2)).radius_and_rest
    assert abs(rest) < 2.0**-53 * radius
    assert Throw((0.1, 0.0), ahead=True).radius_and_rest == (0.1, None)


def test_the_pin_of_a_rocker_swings_about_the_pivot():
    placement = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)).place(ANGLES)
    swing = placement.course("B").swing
    found = [centre + swing.radius * part for centre, part in zip(swing.centre, swing.direction, strict=True)]
    assert near(found, placement.joints["B"].position)


@pytest.mark.parametrize("cam", [ks.cams.Circle(0.3, (-0.02, 0.0)), ks.cams.Harmonic((0.3, 0.01))])
def test_a_roller_on_a_cam_departs_as_its_derivatives_tell(cam):
    placement = ks.cam_crank_slider(cam, 2.03).place(ANGLES)
    joint, course = placement.joints["A"], placement.course("A")
    assert near(course.departure, np.add(joint.position, joint.second))
    if isinstance(cam, ks.cams.Harmonic):
        assert near(np.hypot(*joint.position), sum(course.orbit))


def test_of_other_joints_nothing_is_known():
    placement = ks.crank_slider(0.1, 0.4).place(ANGLES)
    assert placement.course("B") is UNKNOWN is placement.course("no joint at all")

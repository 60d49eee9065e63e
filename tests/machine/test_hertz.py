"""Line contact by Hertz: the pressure over the half width is the force again."""

import numpy as np
import pytest

from kinetostatics.machine import hertz

STEEL = hertz.modulus((2.1e11, 0.3), (2.1e11, 0.3))


def test_equal_materials_have_half_of_one_plane_modulus():
    assert pytest.approx(2.1e11 / 0.91 / 2.0, rel=1e-14) == STEEL


def test_an_ellipse_of_the_largest_pressure_bears_the_force():
    p, b = (part(-5e3, 0.02, STEEL, 0.015) for part in (hertz.pressure, hertz.half_width))
    assert 0.5 * np.pi * b * p * 0.02 == pytest.approx(5e3, rel=1e-14)
    assert p / b == pytest.approx(STEEL / (2.0 * 0.015), rel=1e-14)


def test_a_roller_in_a_ring_conforms_and_on_a_disk_does_not():
    disk, ring = hertz.relative_radius(1.0 / 0.3, 0.03, np.array([-1.0, 1.0]))
    assert 1.0 / disk == pytest.approx(1.0 / 0.03 + 1.0 / 0.27, rel=1e-14)
    assert 1.0 / ring == pytest.approx(1.0 / 0.03 - 1.0 / 0.33, rel=1e-14)

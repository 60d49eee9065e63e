"""Drives of a mower knife of 5 kg, stroke 76 mm, 600 rpm, 500 N against it both ways, against hand calculation."""

from math import pi

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every

case = ks.load_case("mower_drives")


@pytest.mark.slow
@every("variant", case.variants)
def test_drives_of_the_knife_do_its_work_over_its_stroke(variant):
    s = case.solve(variant, angles=7200)
    low, high = ks.extremes(s, "slider_position").range
    assert high - low == pytest.approx(0.076, abs=1e-6)
    assert 20 * pi * np.mean(s.balancing_torque) == pytest.approx(10 * 2 * 500 * 0.076, rel=1e-4)


def test_frame_force_of_the_planetary_drive_and_none_with_counterweights():
    """Knife and block go to and fro, arm and planet turn; with counterweights the torque is that of the crop alone."""
    plain, balanced = (case.solve(name) for name in ("planetary", "planetary-balanced"))
    angle, square = plain.crank_angle, (20 * pi) ** 2
    turning, moving = 0.5 * 0.0095 + 0.4 * 0.019, 5.2 * 0.038
    by_hand = square * np.array([(turning + moving) * np.cos(angle), turning * np.sin(angle)])
    np.testing.assert_allclose(plain.shaking_force, by_hand, atol=1e-11)
    assert np.abs(balanced.shaking_force).max() < 1e-11
    np.testing.assert_allclose(balanced.balancing_torque, 19.0 * np.abs(np.sin(angle)), atol=1e-12)

"""What a torque-balancing cam reports: contact, angles and curvature beside the scene itself, texts and table."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks


@pytest.fixture(scope="module")
def found():
    scene = ks.load_case("chain_unit").variants["free-start"].scene
    load = ks.Torque(lambda m: -20.0 * np.sign(m.rate("rocker")), on="rocker")
    scene = ks.Scene(scene.mechanism, scene.crank_speed, loads=(*scene.loads, load))
    return ks.design.torque_balancing_cam(scene, mass=0.3, travel=0.012, guide_offset=0.002)


def test_contact_and_pressure_angle_are_the_extremes_of_the_scene(found):
    s = found.scene.solve(np.linspace(0.001, 6.281, 5000))
    force, angle = s.scalar("contact_force_cam"), np.abs(s.measure("pressure_angle_cam"))
    assert found.least_contact_force.value == pytest.approx(force.min(), rel=1e-5)
    assert found.largest_contact_force.value == pytest.approx(force.max(), rel=1e-5)
    assert found.pressure_angle.value == pytest.approx(angle.max(), rel=1e-5)
    assert found.pressure_angle.value >= angle.max() - 1e-9
    assert found.lifts_off == ()


def test_the_energy_is_that_of_the_spring_between_its_ends(found):
    low, high = found.stretch
    assert_allclose(found.spring.stiffness * (high**2 - low**2) / 2, found.energy, rtol=1e-10)
    assert_allclose(found.travel, 0.012, rtol=1e-12)


def test_the_curvature_is_that_of_the_pitch_curve_as_points(found):
    centre = found.follower.disk.curve(np.linspace(0, 2 * np.pi, 200_001))[0]
    step = np.diff(centre)
    bend = np.abs(np.angle(step[1:] / step[:-1])) / np.abs(step[1:])
    convex = np.angle(step[1:] / step[:-1]) < 0.0  # the roller runs clockwise
    assert found.curvature_radius.value == pytest.approx(1.0 / bend[convex].max(), rel=1e-3)


def test_a_faster_machine_shows_where_it_lifts_off(found):
    scene = found.scene
    faster = ks.Scene(scene.mechanism, 10.0 * scene.crank_speed, loads=scene.loads).solve(360)
    pressing = faster.scalar("contact_force_cam") > 0.0
    inside = np.zeros(360, bool)
    for start, stop in ks.design.lifted(faster, "contact_force_cam"):
        inside |= (np.mod(faster.crank_angle - start, 2 * np.pi)) < stop - start
    assert np.any(inside)
    assert np.array_equal(inside, ~pressing)


def test_the_report_and_the_table_say_what_it_gives_and_costs(found):
    for text in ("N m mean; uneven by", "preload", "positive all the way", "pressure angle      30 deg at most"):
        assert text in found.report()
    table = found.table()
    assert table.loc["mean |T - mean| [N m]", "after"] < 1e-9
    assert table.loc["largest reaction at O [N]", "after"] > table.loc["largest reaction at O [N]", "before"]
    assert "of the unevenness left" in repr(found)

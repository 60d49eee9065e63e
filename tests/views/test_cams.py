"""Views of cams, laws and contacts: what is drawn are the numbers themselves, with their units."""

import matplotlib.pyplot as plt
import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks

DEGREES = np.radians(np.arange(360))
CAM = ks.cams.Sampled(DEGREES, 0.1 + 0.012 * np.cos(3 * DEGREES) + 0.02 * np.cos(DEGREES))
LAW = ks.cams.CosineLaw(0.3, 2.0)


@pytest.fixture(autouse=True)
def closing():
    yield
    plt.close("all")


def line(ax, label):
    (found,) = (item for item in ax.get_lines() if item.get_label() == label)
    return np.array(found.get_data())


@pytest.mark.parametrize("side", ["disk", "ring"])
def test_a_cam_is_drawn_by_its_curves_and_the_roller(side):
    ax = ks.plots.cam_profile(CAM, 0.015, side, angles=(0, 90), cutter_radius=0.01)
    made = CAM.profile(0.015, 1440, side)
    assert_allclose(line(ax, "pitch curve")[:, :-1], made.pitch, rtol=1e-14)
    assert_allclose(line(ax, "working curve")[:, :-1], made.surface, rtol=1e-14)
    assert_allclose(line(ax, "path of the cutter")[:, :-1], made.cutter_path(0.01), rtol=1e-14)
    rollers = [patch for patch in ax.patches if hasattr(patch, "radius")]
    assert_allclose([roller.center for roller in rollers], [[0.132, 0.0], [0.0, 0.1]], atol=1e-15)
    assert ax.get_aspect() == 1.0
    assert ax.get_xlabel() == "x [m]"


def test_curvature_and_pressure_angle_show_limits():
    ax = ks.plots.cam_curvature({"lobes": CAM, "law": LAW}, roller_radius=0.05, side="ring")
    angle, bend = line(ax, "law")
    assert_allclose(bend, 1.0 / LAW.curvature_radius(np.radians(angle)), rtol=1e-9)
    assert_allclose(line(ax, "undercut by the roller, ring")[1], -20.0)
    ax = ks.plots.cam_pressure_angle(LAW, largest=np.radians(5.0))
    assert_allclose(sorted(item.get_ydata()[0] for item in ax.get_lines()[1:3]), [-5.0, 5.0])
    assert ax.get_ylabel() == "pressure angle [deg]"


def test_contact_pressure_shows_limit_and_side():
    saw = ks.cam_crank_slider(LAW, LAW.coupler_length, slider=ks.Link(600.0))
    solution = ks.solve(saw, DEGREES, crank_speed=25.0, loads=ks.Spring.balancing(600.0, 33.5, 2.0))
    found = ks.design.contact(solution, 0.05, 0.06, 210e9, 0.3, limits={"pressure": 5e8})
    ax = ks.plots.contact_pressure({"here": found})
    assert_allclose(line(ax, "here")[1], found.pressure / 1e6)
    marks = [item.get_xdata()[0] for item in ax.get_lines() if item.get_linestyle() == ":"]
    assert_allclose(marks, np.degrees(found.changes))
    assert 500.0 in [item.get_ydata()[0] for item in ax.get_lines()]


def test_a_law_is_drawn_from_position_to_jerk():
    law = ks.laws.cosine(0.3, 2.0)
    four = ks.plots.law_motion({"cosine": law})
    for part, values in zip(four, law(np.linspace(0.0, 2 * np.pi, 2881)), strict=True):
        assert_allclose(part.get_lines()[0].get_ydata(), values)
    assert [part.get_ylabel().split(" ")[0] for part in four] == ["position", "velocity", "acceleration", "jerk"]

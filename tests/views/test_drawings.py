"""Drawings of mechanisms: everything that groups and loads declare is drawn, and labels keep clear of each other."""

import itertools
from pathlib import Path

import numpy as np
import pytest
from matplotlib.patches import Polygon

import kinetostatics as ks
from kinetostatics.views import symbols
from kinetostatics.views.canvas import LOAD
from support.chains import chain

BARS = {"coupler": ks.Link(2.0, (0.2, 0.05), 0.1), "rocker": ks.Link(1.0, 0.1, 0.02)}
FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), **BARS)
SAW = ks.crank_slider(0.1, 0.4, crank=ks.Link(1.0, -0.06, 0.1), slider=ks.Link(1.0))


def drawn(mechanism, ax, loads=(), angle=40.0, **options):
    """Solution at the angle of a drawing of it; the number of corners of all its lines."""
    solution = ks.Scene(mechanism, 10.0, loads=loads).solve(24)
    ks.plots.mechanism(solution, angles=(angle,), ax=ax, **options)
    return solution.at(np.radians([angle]))


def lines_between(ax, start, end):
    """Lines that begin and end at these places."""
    found = (line.get_xydata() for line in ax.lines)
    return [line for line in found if len(line) > 1 and np.allclose(line[[0, -1]], [start, end])]


def plates(ax):
    return [np.unique(patch.get_xy(), axis=0) for patch in ax.patches if isinstance(patch, Polygon)]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("seed", range(6))
def test_random_chains_are_drawn_with_every_joint_and_its_name(seed, axes):
    scene, angles = chain(seed)
    angle = float(np.degrees(angles[1]))
    ks.plots.mechanism(scene.solve(angles), angles=(angle,), ax=axes)
    pose = ks.solve(scene.mechanism, angles[1:2], crank_speed=1.0)
    points = np.concatenate([line.get_xydata() for line in axes.lines])
    for joint in scene.mechanism.joints:
        assert np.any(np.all(np.abs(points - pose.position(joint)[:, 0]) < 1e-12, axis=1))
    names = {name for text in axes.texts for name in text.get_text().split(", ")}
    assert names >= set(scene.mechanism.joints)


def test_views_know_no_kind_of_group_or_load():
    words = [name for kind in (*ks.machine.loads.KINDS, ks.LeverGroup, ks.Dyad, ks.Pin) for name in (kind.__name__,)]
    for module in ("drawings", "shape", "symbols", "labels"):
        text = (Path(ks.__file__).parent / "views" / f"{module}.py").read_text()
        assert not [word for word in words if f"import {word}" in text or f" {word}," in text or f"({word}" in text]


def test_springs_and_dampers_are_drawn_between_their_points_and_fixed_ends_stand_on_ground(axes):
    loads = ks.PointSpring(100.0, 0.1, between=("B", (0.6, 0.5))), ks.PointDamper(5.0, between=(("coupler", 0.1), "O2"))
    pose = drawn(FOUR_BAR, axes, loads)
    (spring,) = lines_between(axes, pose.position("B")[:, 0], (0.6, 0.5))
    (damper,) = lines_between(axes, pose.position(("coupler", 0.1))[:, 0], (0.35, 0.1))
    assert len(spring) == len(symbols.SPRING)
    assert len(damper) == len(symbols.DAMPER)
    grounds = [line.get_xydata()[0] for line in axes.lines if line.get_marker() is symbols.PIVOT]
    assert {(0.6, 0.5), (0.35, 0.1), (0.0, 0.0)} == {tuple(place) for place in grounds}


def arrow_of(ax):
    return next(line.get_xydata() for line in ax.lines if line.get_color() == LOAD and len(line.get_xdata()) > 2)


@pytest.mark.parametrize("value", [-3.0, 3.0])
def test_arrows_of_forces_start_at_their_points_and_point_as_the_forces_act(axes, value):
    load = ks.Force(value, at=("coupler", 0.1), direction=0.5, along="coupler")
    pose = drawn(FOUR_BAR, axes, load)
    arrow = arrow_of(axes)
    axis = pose.position("B")[:, 0] - pose.position("A")[:, 0]
    way = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]]) @ axis
    assert np.allclose(arrow[0], pose.position(("coupler", 0.1))[:, 0])
    found = arrow[1] - arrow[0]
    assert np.allclose(found / np.hypot(*found), np.sign(value) * way / np.hypot(*way))


GAS = ks.Table([0.29, 0.4, 0.51], [-9.0, -5.0, -9.0], over="travel", back=[2.0, 2.0, 2.0])
WAYS = {
    "outward against gas": (GAS, 320.0, 10.0, -1),
    "back by suction": (GAS, 40.0, 10.0, 1),
    "outward as the crank turns the other way": (GAS, 40.0, -10.0, -1),
    "zero where it is drawn, negative elsewhere": (
        ks.Table(np.radians([0, 90, 180, 270]), [0, 0, -4, 0]),
        40.0,
        10,
        -1,
    ),
    "a table of torques of the crank angle": (ks.Table(np.radians([0, 90, 180, 270]), [5, 5, -4, 5]), 40.0, 10, 1),
    "nothing": (0.0, 40.0, 10.0, 1),
    "a function": (lambda motion: -motion.crank_angle, 40.0, 10.0, 1),
}


@pytest.mark.parametrize("name", WAYS)
def test_arrows_of_process_forces_point_as_they_act_in_the_pose(axes, name):
    force, angle, speed, way = WAYS[name]
    solution = ks.Scene(SAW, speed, loads=ks.ProcessForce(force)).solve(24)
    ks.plots.mechanism(solution, angles=(angle, 100.0), ax=axes)
    start, tip, *_ = arrow_of(axes)
    assert np.sign(tip[0] - start[0]) == way


def test_a_table_that_ends_short_of_the_pose_is_drawn_as_its_largest_value(axes):
    load = ks.ProcessForce(ks.Table([0.45, 0.48], [-9.0, -1.0], over="travel"))
    narrow = ks.solve(SAW, np.radians([40.0]), crank_speed=10.0, loads=load)
    ks.plots.mechanism(narrow, angles=(180.0,), ax=axes)
    start, tip, *_ = arrow_of(axes)
    assert tip[0] < start[0]


def test_values_over_the_crank_angles_turn_their_arrow_in_an_animation(axes):
    turn = np.radians([40.0, 130.0, 220.0, 310.0])
    solution = ks.solve(SAW, turn, crank_speed=10.0, loads=ks.ProcessForce(np.array([3.0, -3.0, -9.0, 3.0])))
    film = ks.plots.animation(solution, joints=("O",), frames=4, ax=axes)
    ways = []
    for step in range(4):
        film._draw_frame(step)
        start, tip, *_ = arrow_of(axes)
        ways.append(np.sign(tip[0] - start[0]))
    film._draw_was_started = True
    assert ways == [1, -1, -1, 1]


def test_a_couple_that_is_negative_is_drawn_clockwise(axes):
    drawn(FOUR_BAR, axes, ks.Torque(5.0, on="rocker"))
    drawn(FOUR_BAR, axes, ks.Torque(-5.0, on="rocker"))
    one, other = (line.get_xydata() for line in axes.lines if line.get_color() == LOAD)
    assert np.allclose(one[:, 0], other[:, 0])
    assert np.allclose(one[:, 1] - 0.1, 0.1 - other[:, 1])


def test_a_spring_along_a_guide_is_drawn_from_the_slider_beyond_its_way(axes):
    pose = drawn(SAW, axes, ks.Spring(100.0, 0.4))
    springs = [line.get_xydata() for line in axes.lines if len(line.get_xdata()) == len(symbols.SPRING)]
    assert len(springs) == 1
    assert pose.position("B")[0, 0] < springs[0][0, 0]
    assert springs[0][-1, 0] > 0.5  # the end of the stroke
    assert np.allclose(springs[0][[0, -1], 1], 0.0)


def test_a_counterweight_has_its_centroid_where_the_mass_centre_is(axes):
    pose = drawn(SAW, axes)
    sector = max((patch.get_xy() for patch in axes.patches), key=len)
    x, y = sector[:-1].T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    centroid = [np.sum((part + np.roll(part, -1)) * cross) / (3 * np.sum(cross)) for part in (x, y)]
    assert np.allclose(centroid, pose.position("crank")[:, 0], rtol=3e-3)


def test_links_with_three_joints_are_plates_with_corners_at_them(axes):
    parts = (*FOUR_BAR.groups, ks.Pin(on="coupler", at=(0.2, 0.15), name="C"))
    pose = drawn(ks.Mechanism("ternary", FOUR_BAR.crank, parts), axes)
    corners = np.unique([pose.position(name)[:, 0] for name in "ABC"], axis=0)
    assert any(len(plate) == 3 and np.allclose(plate, corners) for plate in plates(axes))


def test_mass_centres_are_marked_on_links_with_mass_only(axes):
    pose = drawn(FOUR_BAR, axes)
    marked = [line.get_xydata()[0] for line in axes.lines if line.get_marker() is symbols.MASS_CENTRE]
    assert np.allclose(marked, [pose.position(link)[:, 0] for link in ("coupler", "rocker")])


def test_labels_lie_clear_of_each_other(axes):
    parts = (
        *FOUR_BAR.groups,
        ks.Pin(on="coupler", at=(0.38, 0.01), name="C"),
        ks.Pin(on="rocker", at=(0.29, 0.01), name="D"),
    )
    solution = ks.Scene(ks.Mechanism("crowded", FOUR_BAR.crank, parts), 10.0).solve(24)
    ks.plots.mechanism(solution, angles=(40, 42, 44), ax=axes)
    axes.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in axes.texts]
    assert len(boxes) == 9
    assert not [pair for pair in itertools.combinations(boxes, 2) if pair[0].overlaps(pair[1])]


def test_the_roller_of_a_cam_is_drawn_about_its_centre(axes):
    machine = ks.cam_crank_slider(ks.cams.Circle(0.1, (-0.01, 0.0)), 0.6, slider=ks.Link(1.0))
    pose = drawn(machine, axes)
    centre = pose.position("A")[:, 0]
    rings = [patch.get_xy() for patch in axes.patches if len(patch.get_xy()) == 34]
    assert len(rings) == 1
    distances = np.hypot(*(rings[0].T - centre[:, None]))
    assert np.allclose(distances, distances[0])
    assert distances[0] > 0


def test_a_weight_beyond_the_crank_pin_is_drawn_at_its_mass_centre(axes):
    pose = drawn(ks.crank_slider(0.1, 0.4, crank=ks.Link(1.0, 0.16, 0.1), slider=ks.Link(1.0)), axes)
    ring = next(patch.get_xy() for patch in axes.patches if len(patch.get_xy()) == 34)
    assert np.allclose(np.mean(ring[:-2], axis=0), pose.position("crank")[:, 0])


def test_fixed_pivots_stand_within_the_axes_with_their_ground(axes):
    drawn(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, -0.2), **BARS), axes)
    axes.figure.canvas.draw()
    for line in axes.lines:
        if line.get_marker() is symbols.PIVOT:
            (x, y) = axes.transData.transform(line.get_xydata()[0])
            assert axes.bbox.y0 + 0.5 * line.get_markersize() < y
            assert axes.bbox.x0 < x < axes.bbox.x1


def test_a_crank_angle_at_which_the_machine_does_not_close_is_said_to_be_one(axes):
    machine = ks.crank_slider(0.2, 0.3, guide_offset=0.15, slider=ks.Link(1.0))
    solution = ks.solve(machine, np.radians(np.arange(0.0, 360.0, 5.0)), crank_speed=1.0, on_gap="nan")
    ks.plots.mechanism(solution, ax=axes, angles=(40, 160, 280))
    told = [text.get_text() for text in axes.texts if "°" in text.get_text()]
    assert told == ["40°", "160°", "280°: cannot be assembled"]

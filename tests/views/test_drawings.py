"""Drawings of mechanisms and cams."""

import itertools
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.patches import Polygon
from matplotlib.path import Path as CurvePath
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.views import drawings, labels, strokes
from kinetostatics.views.canvas import LOAD
from kinetostatics.views.labels import label
from kinetostatics.views.strokes import Shape, strokes_by_owner
from support.chains import chain
from support.every import every

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
@pytest.mark.parametrize("seed", range(3))
def test_random_chains_show_every_joint(seed, axes):
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
    for module in ("drawings", "strokes", "labels", "sketches"):
        text = (Path(ks.__file__).parent / "views" / f"{module}.py").read_text()
        assert not [word for word in words if f"import {word}" in text or f" {word}," in text or f"({word}" in text]


def test_springs_and_dampers_join_their_points(axes):
    loads = ks.PointSpring(100.0, 0.1, between=("B", (0.6, 0.5))), ks.PointDamper(5.0, between=(("coupler", 0.1), "O2"))
    pose = drawn(FOUR_BAR, axes, loads)
    (spring,) = lines_between(axes, pose.position("B")[:, 0], (0.6, 0.5))
    (damper,) = lines_between(axes, pose.position(("coupler", 0.1))[:, 0], (0.35, 0.1))
    assert len(spring) == len(strokes.SPRING)
    assert len(damper) == len(strokes.DAMPER)
    grounds = [line.get_xydata()[0] for line in axes.lines if line.get_marker() is drawings.PIVOT]
    assert {(0.6, 0.5), (0.35, 0.1), (0.0, 0.0)} == {tuple(place) for place in grounds}


def arrow_of(ax):
    return next(line.get_xydata() for line in ax.lines if line.get_color() == LOAD and len(line.get_xdata()) > 2)


@pytest.mark.parametrize("value", [-3.0, 3.0])
def test_force_arrows_point_as_forces_act(axes, value):
    load = ks.Force(value, at=("coupler", 0.1), direction=0.5, along="coupler")
    pose = drawn(FOUR_BAR, axes, load)
    arrow = arrow_of(axes)
    axis = pose.position("B")[:, 0] - pose.position("A")[:, 0]
    way = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]]) @ axis
    assert np.allclose(arrow[0], pose.position(("coupler", 0.1))[:, 0])
    found = arrow[1] - arrow[0]
    assert np.allclose(found / np.hypot(*found), np.sign(value) * way / np.hypot(*way))


GAS = ks.Table([0.29, 0.4, 0.51], [-9.0, -5.0, -9.0], over="travel", back=[2.0, 2.0, 2.0])
QUARTERS = np.radians([0, 90, 180, 270])
WAYS = {
    "outward against gas": (GAS, 320.0, 10.0, -1),
    "back by suction": (GAS, 40.0, 10.0, 1),
    "outward as the crank turns the other way": (GAS, 40.0, -10.0, -1),
    "zero where it is drawn, negative elsewhere": (ks.Table(QUARTERS, [0, 0, -4, 0]), 40.0, 10.0, -1),
    "a table of torques of the crank angle": (ks.Table(QUARTERS, [5, 5, -4, 5]), 40.0, 10.0, 1),
    "nothing": (0.0, 40.0, 10.0, 1),
    "a function": (lambda motion: -motion.crank_angle, 40.0, 10.0, 1),
}


@pytest.mark.parametrize("name", WAYS)
def test_process_force_arrows_follow_the_pose(axes, name):
    force, angle, speed, way = WAYS[name]
    solution = ks.Scene(SAW, speed, loads=ks.ProcessForce(force)).solve(24)
    ks.plots.mechanism(solution, angles=(angle, 100.0), ax=axes)
    start, tip, *_ = arrow_of(axes)
    assert np.sign(tip[0] - start[0]) == way


def test_short_table_is_drawn_at_its_largest(axes):
    load = ks.ProcessForce(ks.Table([0.45, 0.48], [-9.0, -1.0], over="travel"))
    narrow = ks.solve(SAW, np.radians([40.0]), crank_speed=10.0, loads=load)
    ks.plots.mechanism(narrow, angles=(180.0,), ax=axes)
    start, tip, *_ = arrow_of(axes)
    assert tip[0] < start[0]


def test_array_loads_turn_their_arrow(axes):
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


def test_guide_spring_is_drawn_beyond_the_slider(axes):
    pose = drawn(SAW, axes, ks.Spring(100.0, 0.4))
    springs = [line.get_xydata() for line in axes.lines if len(line.get_xdata()) == len(strokes.SPRING)]
    assert len(springs) == 1
    assert pose.position("B")[0, 0] < springs[0][0, 0]
    assert springs[0][-1, 0] > 0.5  # the end of the stroke
    assert np.allclose(springs[0][[0, -1], 1], 0.0)


def test_mass_centre_and_force_off_their_link_are_joined_to_it(axes):
    force = ks.Force(100.0, at=("coupler", 0.1, -0.08))
    solution = drawn(FOUR_BAR, axes, [force])
    for place in ((0.2, 0.05), (0.1, -0.08)):
        ends = (solution.position(("coupler", along, across))[:, 0] for along, across in (place, (place[0], 0.0)))
        assert len(lines_between(axes, *ends)) == 1
    assert not list(Shape(strokes.whole_turn(solution)).ties(solution, links=("rocker",)))  # its centre lies on it


def test_spring_from_far_away_leaves_the_machine_large(axes):
    spring = ks.PointSpring(10.0, 0.0, between=("B", (8.0, 0.0)))
    solution = drawn(SAW, axes, [spring])
    assert np.ptp(axes.get_xlim()) < 2.0
    b = solution.position("B")[:, 0]
    lines = (line.get_xydata() for line in axes.lines)
    ((start, *_, end),) = [line for line in lines if np.allclose(line[:1], [b]) and len(line) > 10]
    assert_allclose((end - start)[1], 0.0, atol=1e-12)
    assert 0.0 < (end - start)[0] < 0.5


@pytest.mark.slow
def test_working_curve_is_drawn_on_each_side_that_is_pressed(axes):
    cam, roller = ks.cams.CosineLaw(0.3, 2.0), ks.Roller(0.05, 0.04, 210e9, 0.3)
    saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600.0), roller=roller)
    for loads, sides in ((ks.ProcessForce(-3e4), ("disk", "ring")), ((), ("ring",))):
        solution = ks.Scene(saw, 10.0, loads=loads).solve(24)
        found = list(strokes.working_curves(solution))
        assert [body for body, _ in found] == ["frame"] * len(sides)
        for (_, points), side in zip(found, sides, strict=True):
            assert_allclose(points[:, :-1], cam.profile(0.05, points.shape[1] - 1, side).surface, atol=1e-15)
    ks.plots.mechanism(solution, ax=axes)
    assert "working curve of the cam" in [line.get_label() for line in axes.lines]
    assert not list(strokes.working_curves(ks.Scene(ks.cam_crank_slider(cam, cam.coupler_length), 10.0).solve(8)))


def test_working_curve_of_a_follower_turns_with_the_crank():
    follower = ks.RollerFollower(ks.laws.cosine(0.03, 0.12), roller=ks.Roller(0.02, 0.02, 210e9, 0.3))
    machine = ks.Mechanism("valve", ks.Crank(None), (follower,))
    solution = ks.Scene(machine, 10.0, loads=ks.ProcessForce(-600.0, on="follower")).solve(24)
    (stroke,) = strokes.moving_surfaces(solution, solution)
    gap = np.hypot(*(stroke.points - solution.position("R")[:, None])).min(axis=0)
    assert_allclose(gap, 0.02, atol=1e-5)


def test_counterweight_is_drawn_at_its_centre(axes):
    pose = drawn(SAW, axes)
    sector = max((patch.get_xy() for patch in axes.patches), key=len)
    x, y = sector[:-1].T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    centroid = [np.sum((part + np.roll(part, -1)) * cross) / (3 * np.sum(cross)) for part in (x, y)]
    assert np.allclose(centroid, pose.position("crank")[:, 0], rtol=3e-3)


def test_three_joint_links_are_plates(axes):
    parts = (*FOUR_BAR.groups, ks.Pin(on="coupler", at=(0.2, 0.15), name="C"))
    pose = drawn(ks.Mechanism("ternary", FOUR_BAR.crank, parts), axes)
    corners = np.unique([pose.position(name)[:, 0] for name in "ABC"], axis=0)
    assert any(len(plate) == 3 and np.allclose(plate, corners) for plate in plates(axes))


@pytest.mark.slow
def test_only_links_with_mass_show_a_centre(axes):
    pose = drawn(FOUR_BAR, axes)
    marked = [line.get_xydata()[0] for line in axes.lines if line.get_marker() is drawings.MASS_CENTRE_PATH]
    assert np.allclose(marked, [pose.position(link)[:, 0] for link in ("coupler", "rocker")])


@pytest.mark.slow
def test_labels_lie_clear_of_each_other(axes):
    pins = ks.Pin(on="coupler", at=(0.38, 0.01), name="C"), ks.Pin(on="rocker", at=(0.29, 0.01), name="D")
    parts = (*FOUR_BAR.groups, *pins)
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


@pytest.mark.slow
def test_pivots_stand_within_the_axes(axes):
    drawn(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, -0.2), **BARS), axes)
    axes.figure.canvas.draw()
    for line in axes.lines:
        if line.get_marker() is drawings.PIVOT:
            (x, y) = axes.transData.transform(line.get_xydata()[0])
            assert axes.bbox.y0 + 0.5 * line.get_markersize() < y
            assert axes.bbox.x0 < x < axes.bbox.x1


def test_open_crank_angle_is_named(axes):
    machine = ks.crank_slider(0.2, 0.3, guide_offset=0.15, slider=ks.Link(1.0))
    solution = ks.solve(machine, np.radians(np.arange(0.0, 360.0, 5.0)), crank_speed=1.0, on_gap="nan")
    ks.plots.mechanism(solution, ax=axes, angles=(40, 160, 280))
    told = [text.get_text() for text in axes.texts if "°" in text.get_text()]
    assert told == ["40°", "160°", "280°: cannot be assembled"]


# What a mechanism looks like, read off what it declares


TURN = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)


def shape(mechanism):
    return Shape(ks.solve(mechanism, TURN, crank_speed=0.0).dynamics)


@every("direction, tail", [(None, []), (-np.pi / 2, []), (np.pi, [[1, 0]]), (0.0, [[-1, 0]])])
def test_weight_that_does_not_act_down_has_an_arrow(direction, tail):
    _, ax = plt.subplots()
    drawn(SAW, ax, [] if direction is None else [ks.Gravity(direction=direction)])
    arrows = [text for text in ax.texts if text.get_text() == "g"]
    assert_allclose([text.get_position() for text in arrows], drawings.GRAVITY_LENGTH * np.array(tail), atol=1e-9)


def test_cam_on_the_crank_passes_its_roller():
    follower = ks.RollerFollower(ks.laws.cosine(0.02, 0.08), ks.Guide.at(0.7, 0.01))
    made = shape(ks.Mechanism("cam drive", ks.Crank(0.1), (follower,)))
    (outline,) = (stroke.points for stroke in made.strokes(made.turn) if stroke.kind == "outline")
    roller = made.turn.position("R")
    nearest = np.min(np.hypot(*(outline - roller[:, None, :])), axis=0)
    assert np.max(nearest) < 2e-3
    radius = np.hypot(*outline)
    np.testing.assert_allclose(radius, np.broadcast_to(radius[:, :1], radius.shape), rtol=1e-12)


# Signs of drawings


def test_ground_is_hatched_on_the_right_of_its_line():
    points = strokes.hatched_line(np.array([0.0, 0.0]), np.array([1.0, 0.0]), 0.1)
    assert points[:, :2].T.tolist() == [[0, 0], [1, 0]]
    assert np.nanmin(points[1]) == pytest.approx(-0.1)
    assert np.nanmax(points[1]) == 0.0


# Machines that look alike, and what of counterweights and loads each has of its own


SLIDER = ks.Link(1.0)


def solved(machine, **options):
    return ks.Scene(machine, 10.0, **options).solve(12)


PLAIN = solved(ks.crank_slider(0.1, 0.4, slider=SLIDER))
WEIGHED = solved(ks.crank_slider(0.1, 0.4, crank=ks.Link(2.0, -0.06), slider=SLIDER), loads=ks.Spring(9.0, 0.4))


def test_strokes_have_the_labels_of_all_that_bear_them():
    found = strokes_by_owner({"plain": PLAIN, "one": WEIGHED, "other": WEIGHED}, np.array([40.0]))
    assert {stroke.kind for stroke, _ in found} == {"counterweight", "spring"}
    assert all(owners == ["one", "other"] for _, owners in found)


# Labels that keep clear of each other and of what is drawn


@pytest.fixture
def axes():
    figure, ax = plt.subplots()
    ax.plot([0.0, 1.0], [0.5, 0.5])
    yield ax
    plt.close(figure)


def boxes(ax, texts):
    ax.figure.canvas.draw()
    return [text.get_window_extent() for text in texts]


@pytest.mark.slow
def test_labels_of_one_point_do_not_overlap(axes):
    found = boxes(axes, [label(axes, f"label {place}", (0.5, 0.5)) for place in range(4)])
    assert not any(one.overlaps(other) for place, one in enumerate(found) for other in found[:place])


def test_a_label_leaves_the_curve_beneath_it(axes):
    (box,) = boxes(axes, [label(axes, "here", (0.5, 0.5))])
    assert not box.contains(*axes.transData.transform((0.5, 0.5)))
    height = axes.transData.transform((0.5, 0.5))[1]
    assert box.y0 > height or box.y1 < height


@pytest.mark.slow
def test_leader_lines_do_not_cross(monkeypatch):
    """Ten points in a heap: labels never lie on each other; a leader may pass behind one, which has a ground."""
    count = 0
    drawn = SimpleNamespace(draw=lambda renderer: None)
    for seed in range(12):
        lines: list[CurvePath] = []
        monkeypatch.setattr(
            labels, "Line2D", lambda x, y, to=lines, **style: to.append(CurvePath(np.array([x, y]).T)) or drawn
        )
        figure, ax = plt.subplots()
        spots = 0.5 + 0.006 * np.random.default_rng(seed).normal(size=(10, 2))
        found = boxes(ax, [label(ax, f"{20 * place}°", spot) for place, spot in enumerate(spots)])
        plt.close(figure)
        assert not any(one.intersects_path(other, False) for place, one in enumerate(lines) for other in lines[:place])
        assert not any(one.padded(-1.0).overlaps(other.padded(-1.0)) for one, other in itertools.combinations(found, 2))
        count += len(lines)
    assert count


# Views of cams, laws and contacts

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


@pytest.mark.slow
def test_cam_of_a_flat_face_is_drawn_with_faces_that_touch_it():
    law = ks.laws.cosine(0.004, 0.03)
    ax = ks.plots.cam_profile(ks.FlatFollower(law, ks.Guide.at(np.pi / 2)).disk, angles=(0, 90))
    faces = [line.get_xydata() for line in ax.lines if len(line.get_xdata()) == 2 and line.get_linestyle() == "-"]
    assert len(faces) == 2
    (surface,) = (line.get_xydata() for line in ax.lines if line.get_label() == "working curve")
    for start, end in faces:
        normal = np.array([start[1] - end[1], end[0] - start[0]]) / np.hypot(*(end - start))
        normal *= np.sign(normal @ start)
        assert (surface @ normal).max() == pytest.approx(normal @ start, rel=1e-5)


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


@pytest.mark.slow
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

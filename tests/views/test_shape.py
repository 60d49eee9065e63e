"""What a mechanism looks like, read off what it declares."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.shape import Shape

TURN = np.linspace(0.0, 2 * np.pi, 36, endpoint=False)


def shape(mechanism):
    return Shape(ks.solve(mechanism, TURN, crank_speed=0.0).dynamics)


def test_the_size_is_the_largest_extent_over_the_turn_and_blocks_follow_it():
    small, large = (shape(ks.crank_slider(0.1 * size, 0.4 * size)) for size in (1.0, 3.0))
    assert small.size == pytest.approx(0.6, rel=1e-9)
    assert large.unit == pytest.approx(3.0 * small.unit, rel=1e-9)


def test_the_way_of_a_slider_reaches_over_its_stroke():
    (ends,) = shape(ks.crank_slider(0.1, 0.4)).ways.values()
    assert np.ptp(ends, axis=-1).max() >= 0.2 - 1e-9 or np.ptp(ends, axis=0).max() >= 0.2 - 1e-9


def test_strokes_of_a_pose_are_finite_lines_of_known_kinds():
    made = shape(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)))
    strokes = list(made.strokes(made.turn))
    assert len(strokes) >= 3
    assert all(stroke.points.shape[0] == 2 and stroke.points.shape[-1] == 36 for stroke in strokes)


def test_a_cam_on_the_crank_is_drawn_through_its_roller_in_every_pose():
    follower = ks.RollerFollower(ks.laws.cosine(0.02, 0.08), ks.Guide.at(0.7, 0.01))
    made = shape(ks.Mechanism("cam drive", ks.Crank(0.1), (follower,)))
    (outline,) = (stroke.points for stroke in made.strokes(made.turn) if stroke.kind == "outline")
    roller = made.turn.position("R")
    nearest = np.min(np.hypot(*(outline - roller[:, None, :])), axis=0)
    assert np.max(nearest) < 2e-3
    radius = np.hypot(*outline)
    np.testing.assert_allclose(radius, np.broadcast_to(radius[:, :1], radius.shape), rtol=1e-12)

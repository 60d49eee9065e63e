"""Animations: all that moves is within the axes, at every step of the period, with its forces."""

import numpy as np

import kinetostatics as ks

BARS = {"coupler": ks.Link(2.0, (0.2, 0.05), 0.1), "rocker": ks.Link(1.0, 0.1, 0.02)}
FOUR_BAR = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), **BARS)


def test_force_arrows_point_along_reactions(axes):
    pose = ks.load_case("sawframe_2r63").solve("plain", 360)
    film = ks.plots.animation(pose, joints=("A", "guide"), frames=4, ax=axes)
    film._draw_frame(90)  # drawing one pose is what saving does for each
    arrows = next(item for item in axes.collections if hasattr(item, "U"))
    np.testing.assert_allclose(arrows.get_offsets(), [pose.position("A")[:, 90], pose.position("B")[:, 90]])
    np.testing.assert_allclose(np.array([arrows.U, arrows.V]).T, [pose.reaction(j)[:, 90] for j in ("A", "guide")])
    film._draw_was_started = True


def test_animation_shows_all_moving_parts(axes):
    solution = ks.solve(FOUR_BAR, np.linspace(0, 2 * np.pi, 24, endpoint=False), crank_speed=10.0)
    ks.plots.animation(solution, frames=2, ax=axes)._draw_was_started = True
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    for x, y in (solution.position(name) for name in FOUR_BAR.joints):
        assert left < x.min() <= x.max() < right
        assert bottom < y.min() <= y.max() < top


def test_animation_covers_both_turns(axes):
    deltoid = ks.four_bar(0.1, 0.2, 0.2, rocker_pivot=(0.1, 0.0), assembly="open", **BARS)
    solution = ks.solve(deltoid, np.linspace(0.1, 2 * np.pi + 0.1, 24, endpoint=False), crank_speed=10.0)
    film = ks.plots.animation(solution, joints=("O",), frames=8, ax=axes)
    shown = []
    for step in film.new_frame_seq():
        film._draw_frame(step)
        shown.append(axes.texts[-1].get_text())
    film._draw_was_started = True
    assert shown == [f"crank angle {angle}°" for angle in range(6, 726, 90)]

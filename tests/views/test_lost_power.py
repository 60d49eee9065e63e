"""Figures of lost power: stacks that add up, labels with units, an error without friction."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import drives, figures


@pytest.fixture(scope="module")
def saw():
    case = ks.load_case("sawframe_2r63_friction")
    return {name: case.solve(name, 180) for name in ("plain", "cam-cosine")}


@pytest.mark.slow
def test_stack_reaches_the_whole_loss(saw, axes):
    solution = saw["plain"]
    assert ks.plots.lost_power(solution, ax=axes) is axes
    top = np.max([path.vertices[:, 1].max() for item in axes.collections for path in item.get_paths()])
    assert top == pytest.approx(1e-3 * ks.extremes(solution, "friction_loss").largest, rel=1e-12)
    assert axes.get_ylabel() == "power lost [kW]"
    assert axes.get_xlabel() == "crank angle from +x, counter-clockwise [deg]"
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["mean", "guide", "B", "A", "O"]
    (mean,) = (line for line in axes.get_lines() if line.get_label() == "mean")
    assert mean.get_ydata()[0] == pytest.approx(1e-3 * solution.losses.total, rel=1e-12)


def test_bars_stand_on_each_other_up_to_the_mean_loss(saw, axes):
    ks.plots.losses(saw, ax=axes)
    tops = [max(bar.get_y() + bar.get_height() for bar in bars) for bars in zip(*axes.containers, strict=True)]
    assert tops == pytest.approx([1e-3 * s.losses.total for s in saw.values()], rel=1e-12)
    assert [text.get_text() for text in axes.texts] == ["42.9", "11.7"]
    assert axes.get_ylabel() == "mean power lost [kW]"
    assert axes.get_ylim()[1] > max(tops) * 1.1
    assert [text.get_text() for text in axes.get_xticklabels()] == list(saw)


def test_single_solution_is_one_bar_in_watts(axes):
    pump = ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0))
    solution = ks.solve(
        pump, [0.0, 1.0], crank_speed=3.0, loads=ks.Gravity(), friction={"guide": ks.GuideFriction(0.1)}
    )
    ks.plots.losses(solution, ax=axes)
    assert len(axes.containers) == len(axes.containers[0]) == 1
    assert axes.get_ylabel() == "mean power lost [W]"


def test_single_solution_has_no_name(saw, axes):
    ax = ks.plots.losses(saw["plain"], ax=axes)
    assert [text.get_text() for text in ax.get_xticklabels()] == [""]


def test_drag_without_friction_is_drawn(axes):
    bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    s = ks.Scene(bar, 10.0, loads=ks.Torque(5.0, on="rocker", opposing=True)).solve(36)
    ks.plots.losses(s, ax=axes)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["Torque on 'rocker'"]
    assert axes.containers[0][0].get_height() == pytest.approx(s.losses.total, rel=1e-12)


@pytest.mark.parametrize("draw", [ks.plots.losses, ks.plots.lost_power])
@pytest.mark.parametrize(
    ("given", "words"),
    [
        (lambda s: ks.solve(s.mechanism, [0.0], crank_speed=1.0), "no friction is given; give friction"),
        (lambda s: s.at(np.zeros((1,))).losses, "must be a Solution"),
        (lambda s: None, "must be a Solution"),
        (lambda s: ks.solve(s.mechanism, [0.0], crank_speed=np.ones((3, 1)), friction=s.friction), "one design"),
    ],
    ids=["frictionless", "losses", "none", "batch"],
)
def test_what_has_no_losses_to_draw_says_why(saw, draw, given, words):
    with pytest.raises(ks.ParameterError, match=words):
        draw(given(saw["plain"]))


@pytest.mark.slow
def test_only_cases_with_friction_have_figures(tmp_path):
    case = ks.load_case("sawframe_2r63_friction")
    (path,) = figures.draw_case(case, tmp_path, "svg", "losses")
    assert "mean power lost [kW]" in path.read_text(encoding="utf-8") or path.stat().st_size > 5000
    with pytest.raises(ks.ParameterError, match="lost_power"):
        figures.draw_case(ks.load_case("sawframe_2r63"), tmp_path, "svg", "lost_power")


# Figures of machines in periodic running


TURN = 2 * math.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
CUT = ks.ProcessForce(ks.Table(np.linspace(0.0, TURN, 41)[:-1], 4e3 + 4e3 * np.sin(TURN / 40 * np.arange(40))))


def driven_saw(*loads):
    return ks.Scene(SAW, 33.0, loads=(ks.Gravity(), *loads))


def test_speed_and_torque_figures_are_drawn():
    run = ks.drive.steady(driven_saw(CUT), MOTOR, 1000.0)
    speed, torques = run.plot()
    assert speed.get_ylabel() == "crank speed [rad/s]"
    drive, machine = (line.get_ydata() for line in torques.get_lines())
    assert drive[:-1:2].shape == (360,)
    assert machine[:-1] == pytest.approx(run.solution.balancing_torque, abs=1e-6)
    assert drive[:-1] == pytest.approx(MOTOR.transmission * run.motor_torque)


@pytest.mark.parametrize("given", [None, 3, {"saw": None}, {"saw": ks.Scene(ks.crank_slider(0.1, 0.4), 10.0)}])
def test_what_is_no_running_is_refused_in_words(given):
    for figure in (drives.crank_speed, drives.energy_flow, drives.drive_torques):
        with pytest.raises(ks.ParameterError, match=r"runs must be a Running or a dict of label to Running, as \{"):
            figure(given)


def test_no_running_at_all_is_refused_in_words():
    for figure, words in ((drives.crank_speed, "runs must be"), (drives.drive_torques, "there is nothing to draw")):
        with pytest.raises(ks.ParameterError, match=words):
            figure({})

"""Gaps of solutions in figures: shaded and named, and no axis set by what grows without bound beside them."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import canvas
from kinetostatics.views.canvas import with_peaks
from support.every import every

TURN = np.radians(np.arange(0.0, 360.0, 0.5))
SHORT = ks.crank_slider(0.3, 0.25, coupler=ks.Link(5.0, 0.1, 0.05), slider=ks.Link(60.0))
LONG = ks.crank_slider(0.3, 0.9, slider=ks.Link(60.0))


def solved(mechanism, speed=7.0, **options):
    return ks.solve(mechanism, TURN, crank_speed=speed, on_gap="nan", **options)


def shades(ax):
    return [tuple(np.round([patch.get_x(), patch.get_x() + patch.get_width()], 6)) for patch in ax.patches]


def words(ax):
    return [text.get_text() for text in ax.texts if not text.get_text().startswith("beyond")]


@every("quantity", ["balancing_torque", "O", "slider_velocity"])
def test_gaps_are_shaded_from_value_to_value_and_named(quantity):
    figure, ax = plt.subplots()
    ks.plots.over_turn(solved(SHORT), quantity, ax=ax)
    open_at = np.degrees(np.arcsin(0.25 / 0.3))
    before, behind = np.floor(2 * open_at) / 2, np.ceil(2 * (180 - open_at)) / 2
    assert shades(ax) == [(before, behind), (before + 180, behind + 180)]
    assert words(ax) == ["cannot be assembled"] * 2
    assert ax.get_xlim() == (0, 360)
    plt.close(figure)


def test_gap_of_some_is_named_as_theirs(axes):
    ks.plots.torque({"long": solved(LONG), "short": solved(SHORT), "slow": solved(SHORT, 3.0)}, ax=axes)
    assert words(axes) == ["short, slow: cannot be assembled"] * 2


def test_what_jams_is_not_said_to_be_open(axes):
    friction = {"guide": ks.GuideFriction(0.9), "B": ks.PinFriction(0.9, 0.02)}
    solution = solved(ks.crank_slider(0.3, 0.42, slider=ks.Link(60.0)), friction=friction)
    assert solution.closed.all()
    assert np.isnan(solution.balancing_torque).any()
    ks.plots.torque(solution, ax=axes)
    assert set(words(axes)) == {"jams"}


def test_without_gaps_nothing_is_shaded(axes):
    solution = solved(LONG)
    ks.plots.torque(solution, ax=axes)
    assert (shades(axes), list(axes.texts)) == ([], [])
    assert axes.get_ylim()[1] >= solution.balancing_torque.max()


@every("samples", [180, 720, 3600])
def test_limits_ignore_values_near_gaps(samples):
    solution = ks.Scene(SHORT, 7.0).solve(samples, on_gap="nan")
    torque, far = solution.balancing_torque, 3.0 * np.abs(ks.Scene(SHORT, 7.0).solve([0.75]).balancing_torque).item()
    figure, ax = plt.subplots()
    ks.plots.torque(solution, ax=ax)
    low, high = ax.get_ylim()
    assert 0.5 * far < high < 2.0 * far < np.nanmax(torque)
    assert low == pytest.approx(-high, rel=0.2)
    assert f"beyond the frame: up to {np.nanmax(np.abs(torque)):.3g} N m" in [text.get_text() for text in ax.texts]
    assert np.array_equal(ax.lines[0].get_ydata(), torque, equal_nan=True)
    plt.close(figure)


def test_hodograph_beside_a_gap_is_readable(axes):
    four_bar = ks.four_bar(0.3, 0.4, 0.3, rocker_pivot=(0.51, 0.0), rocker=ks.Link(3, 0.1, 0.05))
    solution = solved(four_bar, loads=ks.Gravity())
    ks.plots.hodograph(solution, ax=axes, marks=30)
    x, y = axes.lines[0].get_data()
    assert np.nanmax(np.hypot(x, y)) <= canvas.drawn_limit([np.hypot(*solution.reaction("O"))])
    told = " ".join(text.get_text() for text in axes.texts)
    assert "beyond the frame: up to" in told
    assert "nan" not in told
    assert not {"150°", "180°", "210°"} & set(told.replace(",", " ").split())
    assert {"0°", "30°", "300°", "330°"} <= {text.get_text() for text in axes.texts}


def test_hodograph_ends_in_arrows_or_crosses(axes):
    pump = ks.crank_slider(0.3, 0.6, slider=ks.Link(600.0))
    loads, friction = [ks.Gravity(), ks.ProcessForce(500.0)], {"guide": ks.GuideFriction(1.9)}
    solution = solved(pump, 30.0, loads=loads, friction=friction)
    ks.plots.hodograph(solution, ax=axes)
    solution = with_peaks({"": solution}, "O")[""]
    whole, drawn = solution.reaction("O"), np.array(axes.lines[0].get_data())[:, :-1]
    found = list(canvas.curve_ends(solution, whole, drawn))
    there, missing = np.isfinite(drawn[0]), np.isnan(whole[0])
    assert len(found) == np.sum(there & ~np.roll(there, -1)) + np.sum(there & ~np.roll(there, 1)) > 2
    for end in found:
        beside = [row % there.size for row in (end.row - 1, end.row + 1) if not there[row % there.size]]
        assert {"jams" if missing[row] else "" for row in beside} == {end.why}
    assert {end.why for end in found} == {"", "jams"}
    marks = [line.get_marker() for line in axes.lines if len(line.get_xdata()) == 1]
    assert {mark if isinstance(mark, str) else mark[0] for mark in marks} == {"x", 3}
    (note,) = [text.get_text() for text in axes.texts if "beyond" in text.get_text()]
    assert note.splitlines()[1] == "× jams"
    assert {f"{np.degrees(solution.crank_angle[end.row]):.4g}°" for end in found if not end.why} & {
        text.get_text() for text in axes.texts
    }


def test_the_head_of_an_arrow_points_along_the_curve():
    x = np.array([0.0, 1.0, 2.0, np.nan, np.nan, -1.0])
    curve = np.array([x, 0.5 * x])
    solution = solved(SHORT)
    first, second = canvas.curve_ends(solution, np.nan_to_num(curve, nan=9.0), curve)
    assert (first.row, second.row) == (2, 5)
    assert first.angle == pytest.approx(np.degrees(np.arctan2(0.5, 1.0)))
    assert second.angle == pytest.approx(np.degrees(np.arctan2(-0.5, -1.0)))

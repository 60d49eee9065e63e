"""Figures hold the curves of the solutions, over the longest period, and say what they show."""

import builtins
import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.report import figures
from support.reports import near_change_points, subject

pytest.importorskip("bokeh")


def lines(plot):
    return {item.name: item.data_source.data for item in plot.renderers if item.name.startswith("line")}


def at(found, degrees):
    """Rows of a line at crank angles, degrees; between them stand extremes."""
    rows = np.searchsorted(found["angle"], degrees - 1e-9)
    np.testing.assert_allclose(np.asarray(found["angle"])[rows], degrees, atol=1e-9)
    return rows


@pytest.mark.slow
def test_report_curve_is_the_solutions():
    solutions = subject("sawframe_2r63").solutions
    plot = figures.over_turn(solutions, "balancing_torque")
    found = lines(plot)["line 2"]
    torque = solutions["cam-cosine"].balancing_torque
    rows = at(found, np.arange(361))
    np.testing.assert_allclose(found["value"][rows], 1e-3 * np.append(torque, torque[0]), rtol=1e-14)
    extremes = 1e-3 * ks.extremes(solutions["cam-cosine"], "balancing_torque").value
    assert (found["value"].max(), found["value"].min()) == pytest.approx((extremes.max(), extremes.min()), rel=1e-13)
    assert plot.left[0].axis_label.text == "balancing torque [kN·m]"
    assert set(found["variant"]) == {"cam-cosine"}


def test_shorter_periods_are_repeated():
    found = lines(figures.over_turn(subject("v_twin").solutions, "balancing_torque"))
    assert [found[f"line {row}"]["angle"][-1] for row in range(3)] == pytest.approx([720, 720, 720])
    value, rows = found["line 0"]["value"], at(found["line 0"], np.arange(721))
    np.testing.assert_allclose(value[rows[360:]], value[rows[:361]], rtol=1e-14)


def test_absent_quantity_has_an_empty_line():
    found = lines(figures.over_turn(subject("sawframe_2r63").solutions, "cam_force"))
    assert [len(found[f"line {row}"]["angle"]) > 360 for row in range(3)] == [False, True, True]
    assert len(found["line 0"]["angle"]) == 0


def test_hodograph_has_components_and_points():
    solutions = subject("pumpjack").solutions
    plot = figures.hodograph(solutions, "O")
    for row, solution in enumerate(solutions.values()):
        x, y = 1e-3 * solution.reaction("O")
        found = lines(plot)[f"line {row}"]
        rows = at(found, np.arange(360))
        np.testing.assert_allclose([found["x"][rows], found["y"][rows]], [x, y], rtol=1e-14)
        largest = 1e-3 * ks.extremes(solution, "O").largest
        assert np.hypot(found["x"], found["y"]).max() == pytest.approx(largest, rel=1e-13)
        tip = next(item for item in plot.renderers if item.name == f"tip {row}")
        assert (tip.data_source.data["x"][0], tip.data_source.data["y"][0]) == (x[0], y[0])


def test_letters_of_formulas_in_names_stay_as_they_are():
    plot = figures.curves_over(["$$x$$"], {0: (np.arange(360.0), np.ones(360))}, "$$x$$ [1]")
    assert type(plot.left[0].axis_label).__name__ == "PlainText"


def test_without_bokeh_it_is_said_how_to_get_it(monkeypatch):
    load = builtins.__import__

    def absent(name, *rest):
        if name.partition(".")[0] == "bokeh":
            raise ImportError(name)
        return load(name, *rest)

    monkeypatch.setattr(builtins, "__import__", absent)
    with pytest.raises(ks.KinetostaticsError, match=r'pip install "kinetostatics\[report\]"'):
        figures.require_bokeh()


def test_unbounded_values_are_not_drawn():
    with warnings.catch_warnings(action="ignore"):
        solution = near_change_points().solve(360)
        size = np.hypot(*solution.reaction("O"))
        plots = figures.over_turn({"a": solution}, "O"), figures.hodograph({"a": solution}, "O")
    assert size.max() > 1e12
    curve, tip = (lines(plot)["line 0"] for plot in plots)
    for found, drawn in ((curve, curve["value"]), (tip, np.hypot(tip["x"], tip["y"]))):
        assert np.nanmax(drawn) < 1e3
        drawn = drawn[at(found, np.arange(360))]
        kept = np.isfinite(drawn)
        assert 340 < kept.sum() < 360
        np.testing.assert_allclose(drawn[kept], size[kept], rtol=1e-14)
    assert plots[0].left[0].axis_label.text == "|reaction O| [N]"

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


def test_a_curve_is_that_of_the_solution_closed_at_the_end():
    solutions = subject("sawframe_2r63").solutions
    plot = figures.over_turn(solutions, "balancing_torque")
    found = lines(plot)["line 2"]
    torque = solutions["cam-cosine"].balancing_torque
    np.testing.assert_allclose(found["value"], 1e-3 * np.append(torque, torque[0]), rtol=1e-14)
    np.testing.assert_allclose(found["angle"], np.arange(361), atol=1e-9)
    assert plot.left[0].axis_label.text == "balancing torque [kN·m]"
    assert set(found["variant"]) == {"cam-cosine"}


def test_curves_of_shorter_periods_are_repeated_over_the_longest():
    found = lines(figures.over_turn(subject("v_twin").solutions, "balancing_torque"))
    assert [len(found[f"line {row}"]["angle"]) for row in range(3)] == [721, 721, 721]
    np.testing.assert_allclose(found["line 0"]["value"][360:], found["line 0"]["value"][:361], rtol=1e-14)


def test_a_machine_without_the_quantity_has_an_empty_line():
    found = lines(figures.over_turn(subject("sawframe_2r63").solutions, "cam_force"))
    assert [len(found[f"line {row}"]["angle"]) for row in range(3)] == [0, 361, 361]


def test_a_hodograph_has_the_components_and_a_point_for_each_machine():
    solutions = subject("pumpjack").solutions
    plot = figures.hodograph(solutions, "O")
    for row, solution in enumerate(solutions.values()):
        x, y = 1e-3 * solution.reaction("O")
        found = lines(plot)[f"line {row}"]
        np.testing.assert_allclose([found["x"][:-1], found["y"][:-1]], [x, y], rtol=1e-14)
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
        figures.require()


def test_what_grows_without_bound_is_not_drawn_and_sets_no_unit():
    with warnings.catch_warnings(action="ignore"):
        solution = near_change_points().solve(360)
        size = np.hypot(*solution.reaction("O"))
        plots = figures.over_turn({"a": solution}, "O"), figures.hodograph({"a": solution}, "O")
    assert size.max() > 1e12
    curve, tip = (lines(plot)["line 0"] for plot in plots)
    for drawn in (curve["value"], np.hypot(tip["x"], tip["y"])):
        kept = np.isfinite(drawn[:360])
        assert np.nanmax(drawn) < 1e3
        assert 340 < kept.sum() < 360
        np.testing.assert_allclose(drawn[:360][kept], size[kept], rtol=1e-14)
    assert plots[0].left[0].axis_label.text == "|reaction O| [N]"

"""Charts of the studies: axes, units, and a curve for each method."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import charts
from support.studied import FEW, torque_study

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

TIME = "time [ns/angle]"


@pytest.fixture(scope="module")
def torque():
    return torque_study()


def test_work_precision_chart_has_logarithmic_axes_with_units_and_a_curve_for_each_setting(torque):
    figure, ax = plt.subplots()
    assert charts.work_precision(torque, ax=ax) is ax
    assert ks.plots.work_precision is charts.work_precision
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_xlabel() == "time [ns per crank angle]"
    assert ax.get_ylabel() == "largest error / largest value [1]"
    handles, names = ax.get_legend_handles_labels()
    methods = [f"{method.name} ({method.setting})" if method.setting else method.name for method in FEW]
    assert names == [*methods, "proven bound on the error below it"]
    for line, method in zip(handles[:-1], FEW, strict=True):
        rows = torque[(torque["method"] == method.name) & torque["error"].notna()]
        np.testing.assert_array_equal(line.get_xydata(), rows[[TIME, "error"]].to_numpy())
    figure.canvas.draw()
    plt.close(figure)


def test_a_method_that_runs_on_an_accelerator_says_so_in_the_legend(torque):
    table = torque.assign(device=["gpu: X" if name == "ours, NumPy" else "cpu" for name in torque["method"]])
    labels = charts.work_precision(table).get_legend_handles_labels()[1]
    assert "ours, NumPy, on gpu: X" in labels
    assert sum("on gpu" in label for label in labels) == 1


def test_error_of_zero_is_drawn_below_rounding_and_a_method_that_gives_nothing_is_not_drawn(torque):
    table = torque.assign(error=torque["error"].where(torque["method"] != "two-mass coupler"))
    table.loc[table["method"] == "ours, NumPy", "error"] = 0.0
    figure, ax = plt.subplots()
    charts.work_precision(table, ax=ax)
    curves = {line.get_label(): line.get_ydata() for line in ax.lines}
    assert list(curves["ours, NumPy"]) == [charts.EXACT]
    assert ax.get_ylim()[0] < charts.EXACT
    assert "two-mass coupler" not in curves
    plt.close(figure)

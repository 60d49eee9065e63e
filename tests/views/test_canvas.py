"""What every figure shares: units, axes, legends."""

import inspect

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.views import canvas

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
PUMP = ks.solve(ks.crank_slider(0.1, 0.5), TURN, crank_speed=1.0)


@pytest.mark.parametrize(
    ("unit", "largest", "expected"),
    [("N", 9e3, (1.0, "N")), ("N", -2e4, (1e-3, "kN")), ("N m", 1e4, (1e-3, "kN m")), ("m", 1e5, (1.0, "m"))],
)
def test_large_forces_read_in_kilonewtons(unit, largest, expected):
    assert canvas.display_unit(unit, [np.array([0.0, np.nan, largest])]) == expected


def test_angles_read_in_degrees():
    assert canvas.display_unit("rad", [np.ones(1)]) == (180 / np.pi, "deg")


def test_axes_given_are_those_drawn_on():
    figure, ax = plt.subplots()
    assert canvas.axes(ax) is ax
    plt.close(figure)
    with pytest.raises(ks.ParameterError, match="ax must be matplotlib Axes"):
        canvas.axes(3)


def test_single_solution_is_labelled_by_quantity():
    (label,) = canvas.solutions_by_label(PUMP, "balancing_torque")
    assert "torque" in label
    named = canvas.solutions_by_label({"a": PUMP, "b": PUMP}, "balancing_torque")
    assert [style for *_, style in canvas.with_line_styles(named)] == list(canvas.STYLES[:2])
    assert canvas.single_solution(PUMP) is PUMP


def test_a_curve_over_the_turn_is_closed():
    assert canvas.close_curve(np.array([[1, 2, 3], [4, 5, 6]])).tolist() == [[1, 2, 3, 1], [4, 5, 6, 4]]


def test_missing_columns_and_rows_are_named():
    with pytest.raises(ks.ParameterError, match="no column 'b'; it has a"):
        canvas.require_columns("plots", pd.DataFrame({"a": [1]}), ["a", "b"])
    with pytest.raises(ks.ParameterError, match="no rows"):
        canvas.require_columns("plots", pd.DataFrame({"a": []}), ["a"])


def test_equal_curves_share_a_label():
    turn = np.linspace(0, 6, 50)
    curves = {
        "a": np.sin(turn),
        "b": np.sin(turn) + 1e-4,
        "c": np.sin(turn) + 1e-2,
        "rounding": 1e-15 * np.cos(turn),
        "short": np.sin(turn[:9]),
    }
    assert canvas.distinct_curves(curves) == {"a, b": "a", "c": "c", "rounding (0)": "rounding", "short": "short"}


def test_small_curves_are_not_called_zero():
    assert canvas.distinct_curves({"a": np.array([0.0, 1e-12]), "b": np.array([1e-12, 0.0])}) == {"a": "a", "b": "b"}
    assert canvas.distinct_curves({"alone": np.zeros(3)}) == {"alone": "alone"}


def test_crank_angles_are_counted_there_and_back():
    angles = np.array([0.0, 90.0, 123.0, 359.0])
    assert np.array_equal(canvas.FROM_X(angles), angles)
    assert canvas.FROM_Y_CLOCKWISE(angles).tolist() == [90.0, 0.0, 327.0, 91.0]
    back = canvas.FROM_Y_CLOCKWISE.from_x(canvas.FROM_Y_CLOCKWISE(angles))
    assert np.allclose(np.mod(back, 360.0), angles)


@pytest.mark.parametrize(
    ("column", "text"),
    [
        ("spring.stiffness [kN/m]", "spring stiffness [kN/m]"),
        ("coupler_length", "coupler length [SI]"),
        ("mean_absolute balancing_torque [N m]", "mean absolute balancing torque [N m]"),
        ("ratio largest O [1]", "ratio of largest O, reference / design [1]"),
    ],
)
def test_headings_of_tables_read_as_words_with_units(column, text):
    assert canvas.axis_words(column) == text


@pytest.mark.parametrize(
    ("values", "largest", "seen"),
    [
        ([1.0, -3.0, 2.0], 3.0, np.inf),
        ([*np.linspace(1.0, 2.0, 101), 8e16], 1.91, 5.73),  # near a change point
        ([*np.linspace(1.0, 2.0, 101), np.inf], 1.9, 5.7),
        ([*np.linspace(1.0, 2.0, 101), 400.0], 400.0, np.inf),  # a press strikes
        ([0.0] * 50 + [5.0], 5.0, np.inf),
        ([np.nan, 2.0], 2.0, np.inf),
        ([], 0.0, np.inf),
    ],
)
def test_few_unbounded_values_set_no_unit(values, largest, seen):
    arrays = [np.array(values, dtype=float)]
    assert canvas.ordinary_size(arrays) == pytest.approx(largest, rel=1e-3)
    assert canvas.drawn_limit(arrays) == pytest.approx(seen, rel=1e-3)


def test_a_unit_is_chosen_by_ordinary_values():
    reaction = np.append(np.linspace(10.0, 20.0, 99), 8e16)
    assert canvas.display_unit("N", [reaction]) == (1.0, "N")
    assert canvas.display_unit("N", [1e4 * reaction]) == (1e-3, "kN")


@pytest.mark.parametrize(("width", "columns"), [(6.4, 3), (3.4, 2), (1.6, 1)])
def test_legend_stands_above_the_curves(width, columns):
    figure, ax = plt.subplots(figsize=(width, 4.0))
    for name in ("plain", "cam-circle", "cam-cosine", "plain-rolling", "cam-rolling"):
        ax.plot([0.0, 180.0, 360.0], [-1.0, 1.0, -1.0], label=name)
    canvas.finish_axes(ax, "force [N]", True)
    figure.canvas.draw()
    legend = ax.get_legend()
    box, frame = legend.get_window_extent(), ax.get_window_extent()
    assert legend._ncols == columns
    assert frame.x0 <= box.x0
    assert box.x1 <= frame.x1
    assert ax.transData.transform((180.0, 1.0))[1] < box.y0 + 0.02 * frame.height
    plt.close(figure)


# The door to all figures


def test_every_figure_function_has_an_example():
    figures = {name: getattr(ks.plots, name) for name in ks.plots.__all__}
    assert all(">>>" in inspect.getdoc(figure) for figure in figures.values())
    without_axes = {name for name, figure in figures.items() if "ax" not in inspect.signature(figure).parameters}
    assert without_axes == {"before_and_after"}


def test_only_figures_are_listed():
    assert dir(ks.plots) == sorted(ks.plots.__all__)

"""The canvas, and gaps in what is drawn on it."""

import inspect

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.views import canvas
from kinetostatics.views.canvas import with_peaks
from support.every import every

TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
PUMP = ks.solve(ks.crank_slider(0.1, 0.5), TURN, crank_speed=1.0)


@pytest.mark.parametrize(
    ("unit", "largest", "expected"),
    [
        ("N", 9e3, (1.0, "N")),
        ("N", -2e4, (1e-3, "kN")),
        ("N m", 1e4, (1e-3, "kN m")),
        ("m", 1e5, (1.0, "m")),
        ("rad", 1.0, (180 / np.pi, "deg")),
    ],
)
def test_large_forces_read_in_kilonewtons_and_angles_in_degrees(unit, largest, expected):
    assert canvas.display_unit(unit, [np.array([0.0, np.nan, largest])]) == expected


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
    curves = {name: np.sin(turn) + more for name, more in (("a", 0.0), ("b", 1e-4), ("c", 1e-2))}
    curves |= {"rounding": 1e-15 * np.cos(turn), "short": np.sin(turn[:9])}
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


@pytest.mark.parametrize(("lowest", "bottom"), [(0.0, -0.05), (-1e-12, -0.05), (-1.0, -1.1)])
def test_curves_above_zero_stand_on_the_axis(lowest, bottom):
    figure, ax = plt.subplots()
    ax.plot([0.0, 180.0, 360.0], [lowest, 1.0, lowest])
    canvas.finish_axes(ax, "force [N]", False)
    assert ax.get_ylim()[0] == pytest.approx(bottom)
    plt.close(figure)


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
    assert dir(ks.plots) == sorted(ks.plots.__all__)
    figures = {name: getattr(ks.plots, name) for name in ks.plots.__all__}
    assert all(">>>" in inspect.getdoc(figure) for figure in figures.values())
    without_axes = {name for name, figure in figures.items() if "ax" not in inspect.signature(figure).parameters}
    assert without_axes == {"bearing", "before_and_after", "hodographs", "mount"}


# Gaps of solutions in figures

HALF_DEGREES = np.radians(np.arange(0.0, 360.0, 0.5))
SHORT = ks.crank_slider(0.3, 0.25, coupler=ks.Link(5.0, 0.1, 0.05), slider=ks.Link(60.0))
LONG = ks.crank_slider(0.3, 0.9, slider=ks.Link(60.0))


def solved(mechanism, speed=7.0, **options):
    return ks.solve(mechanism, HALF_DEGREES, crank_speed=speed, on_gap="nan", **options)


def shades(ax):
    return [tuple(np.round([patch.get_x(), patch.get_x() + patch.get_width()], 6)) for patch in ax.patches]


def words(ax):
    return [text.get_text() for text in ax.texts if not text.get_text().startswith("beyond")]


@pytest.mark.slow
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


@pytest.mark.slow
def test_gap_of_some_is_named_as_theirs(axes):
    ks.plots.torque({"long": solved(LONG), "short": solved(SHORT), "slow": solved(SHORT, 3.0)}, ax=axes)
    assert words(axes) == ["short, slow: cannot be assembled"] * 2


@pytest.mark.slow
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


@pytest.mark.slow
@every("samples", [180, 1440])
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


@pytest.mark.slow
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


@pytest.mark.slow
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

"""Figures and movement of a report."""

import builtins
import warnings

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.report import figures
from kinetostatics.views.report.movement import ARROW_REACH, FILLED_KINDS, MAX_ARROW, movements, to_base64
from kinetostatics.views.strokes import Shape
from support.reports import from_base64, near_change_points, subject

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


def test_axis_of_a_turn_ends_at_360_degrees():
    """Crank angles of peaks stand between the even ones: no step is that from the last angle to the next turn."""
    angle = np.append(np.arange(0.0, 360.0, 1.0), 359.4)
    plot = figures.curves_over(["saw"], {0: (angle, np.cos(np.radians(angle)))}, "torque [N m]")
    assert plot.x_range.end == 360.0
    assert plot.below[0].ticker.ticks == [0.0, 90.0, 180.0, 270.0, 360.0]
    angle = np.append(angle, 360.0 + angle)
    plot = figures.curves_over(["saw"], {0: (angle, np.cos(np.radians(angle)))}, "torque [N m]")
    assert plot.below[0].ticker.ticks == [0.0, 180.0, 360.0, 540.0, 720.0]


@pytest.mark.slow
def test_shorter_periods_are_repeated():
    found = lines(figures.over_turn(subject("v_twin").solutions, "balancing_torque"))
    assert [found[f"line {row}"]["angle"][-1] for row in range(3)] == pytest.approx([720, 720, 720])
    value, rows = found["line 0"]["value"], at(found["line 0"], np.arange(721))
    np.testing.assert_allclose(value[rows[360:]], value[rows[:361]], rtol=1e-14)


def test_absent_quantity_has_an_empty_line():
    found = lines(figures.over_turn(subject("sawframe_2r63").solutions, "cam_force"))
    assert [len(found[f"line {row}"]["angle"]) > 360 for row in range(3)] == [False, True, True]
    assert len(found["line 0"]["angle"]) == 0


def test_absent_vector_has_an_empty_line_and_no_point():
    plot = figures.hodograph(subject("sawframe_2r63").solutions, "ground cam")
    assert [len(lines(plot)[f"line {row}"]["angle"]) > 360 for row in range(3)] == [False, True, True]
    tips = {item.name: item.data_source.data["x"] for item in plot.renderers if item.name.startswith("tip")}
    assert [len(tips[f"tip {row}"]) for row in range(3)] == [0, 1, 1]


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


# Drawings as data


def drawn(case):
    return movements(subject(case).machines)


def points_of(stroke, count):
    """Points of a stroke in all poses, (2, K, N), as the page draws them."""
    first = from_base64(stroke["points"]).reshape(-1, 2).T.astype(float)
    if "shapes" in stroke:
        return from_base64(stroke["shapes"]).reshape(count, -1, 2).transpose(2, 1, 0)
    if "poses" not in stroke:
        return np.repeat(first[..., None], count, axis=2)
    x, y, angle = from_base64(stroke["poses"]).reshape(count, 3).T.astype(float)
    turned = [
        first[0][:, None] * np.cos(angle) - first[1][:, None] * np.sin(angle) + x,
        first[0][:, None] * np.sin(angle) + first[1][:, None] * np.cos(angle) + y,
    ]
    return np.stack(turned)


def test_numbers_come_back_as_they_were_packed():
    values = np.array([0.1, -2.5e300, np.nan, np.inf])
    np.testing.assert_array_equal(from_base64(to_base64(values, "<f8"), "<f8"), values)


@pytest.mark.slow
def test_strokes_are_restored_in_each_pose():
    for case in ("sawframe_2r63", "mower_drive", "shaper"):
        for machine, drawing in zip(subject(case).machines.values(), drawn(case)["drawings"], strict=True):
            solution = machine.solution
            shape = Shape(solution)
            wanted = [*shape.counterweights(solution), *shape.strokes(solution), *shape.signs(solution.loads, solution)]
            sent = drawing["strokes"][-len(wanted) :]
            for stroke, item in zip(wanted, sent, strict=True):
                assert item["kind"] == stroke.kind
                found = points_of(item, solution.crank_angle.size)
                np.testing.assert_allclose(found, stroke.points, atol=3e-5 * shape.size)


def test_moving_parts_are_stored_as_poses():
    strokes = drawn("sawframe_2r63")["drawings"][1]["strokes"]
    kinds = {
        stroke["kind"]: "shapes" if "shapes" in stroke else "poses" if "poses" in stroke else "" for stroke in strokes
    }
    assert kinds["bar"] == "poses"
    assert kinds["curve"] == kinds["rail"] == kinds["ground"] == ""
    assert "shapes" in [next(iter(set(stroke) & {"shapes"}), "") for stroke in strokes if stroke["kind"] == "spring"]
    assert all(stroke["filled"] == (stroke["kind"] in FILLED_KINDS) for stroke in strokes)


def test_arrows_have_one_scale_for_all_machines():
    found = drawn("sawframe_2r63")
    frames = [{key: drawing[key] for key in ("box", "scale", "longest")} for drawing in found["drawings"]]
    frame = frames[0]
    assert frames == [frame] * len(frames)
    solution = subject("sawframe_2r63").machines["plain"].solution
    largest = max(np.hypot(*solution.reaction(name)).max() for name in solution.reactions)
    shapes = [Shape(machine.solution) for machine in subject("sawframe_2r63").machines.values()]
    size = max(shape.size for shape in shapes)
    assert np.isclose(frame["scale"] * largest, ARROW_REACH * size)
    assert np.isclose(frame["longest"], MAX_ARROW * size)


def test_small_machine_beside_large_ones_has_its_own_frame():
    widths = {}
    for drawing in drawn("mower_drives")["drawings"]:
        left, _, right, _ = drawing["box"]
        widths[drawing["name"]] = right - left
        x = [
            solution.position(joint)[0]
            for solution in [subject("mower_drives").machines[drawing["name"]].solution]
            for joint in solution.mechanism.joints
        ]
        assert np.ptp(x) > 0.3 * (right - left), drawing["name"]
    assert widths["crank-slider"] == widths["crank-rocker"] > 2.0 * widths["planetary"]


def test_box_holds_joints_and_arrow_tips():
    found = drawn("shaper")
    left, low, right, high = found["drawings"][0]["box"]
    for machine in subject("shaper").machines.values():
        solution = machine.solution
        for joint, drawing in zip(["A"], found["drawings"][:1], strict=True):
            tip = solution.position(drawing["arrows"][joint]) + drawing["scale"] * solution.reaction(joint)
            assert (tip[0] >= left - 1e-9).all()
            assert (tip[0] <= right + 1e-9).all()
        for joint in solution.mechanism.joints:
            x, y = solution.position(joint)
            assert (x >= left - 1e-9).all()
            assert (x <= right + 1e-9).all()
            assert (y >= low - 1e-9).all()
            assert (y <= high + 1e-9).all()


def test_arrows_stand_at_declared_joints():
    assert drawn("sawframe_2r63")["drawings"][0]["arrows"] == {"A": "A", "B": "B", "guide": "B", "O": "O"}


def test_unbounded_reaction_hides_no_other():
    import warnings

    import kinetostatics as ks
    from kinetostatics.views.report.report import subject_of

    parallelogram = ks.four_bar(0.1, 0.3, 0.1, rocker_pivot=(0.3, 0.0), assembly="open", rocker=ks.Link(mass=1.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.ConditionWarning)
        found = movements(subject_of(ks.Scene(parallelogram, 10.0, loads=ks.Gravity())).machines)
    assert found["drawings"][0]["scale"] > 0.0
    assert np.isfinite(found["drawings"][0]["box"]).all()

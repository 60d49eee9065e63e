"""Charts of designs."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import charts, figures
from kinetostatics.views.canvas import with_peaks
from support.case_files import FRONT, STIFFER, saw_with
from support.improved_saws import front
from support.studied import FEW, torque_study

pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")

TIME = "time [ns/angle]"


@pytest.fixture(scope="module")
def torque():
    return torque_study()


@pytest.mark.slow
def test_work_precision_chart_is_logarithmic(torque):
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


def test_accelerator_is_named_in_the_legend(torque):
    table = torque.assign(device=["gpu: X" if name == "ours, NumPy" else "cpu" for name in torque["method"]])
    labels = charts.work_precision(table).get_legend_handles_labels()[1]
    assert "ours, NumPy, on gpu: X" in labels
    assert sum("on gpu" in label for label in labels) == 1


def test_zero_error_is_drawn_below_rounding(torque):
    table = torque.assign(error=torque["error"].where(torque["method"] != "two-mass coupler"))
    table.loc[table["method"] == "ours, NumPy", "error"] = 0.0
    figure, ax = plt.subplots()
    charts.work_precision(table, ax=ax)
    curves = {line.get_label(): line.get_ydata() for line in ax.lines}
    assert list(curves["ours, NumPy"]) == [charts.MIN_DRAWN_ERROR]
    assert ax.get_ylim()[0] < charts.MIN_DRAWN_ERROR
    assert "two-mass coupler" not in curves
    plt.close(figure)


# A front as a figure


@pytest.mark.slow
def test_a_front_is_drawn_with_the_source_beside_it():
    import matplotlib.pyplot as plt

    ax = ks.plots.front(front())
    line, mark = ax.get_lines()
    np.testing.assert_allclose(line.get_xdata(), front().table.iloc[:, 1])
    np.testing.assert_allclose(line.get_ydata(), front().table.iloc[:, 0] / 1e3)
    assert mark.get_xdata()[0] == pytest.approx(6.08, abs=0.01)
    assert (ax.get_ylabel(), ax.get_xlabel()) == (
        "largest absolute cam force [kN]",
        "ratio of mean absolute balancing torque, reference / design [1]",
    )
    plt.close(ax.figure)


# Figures of the studies


UNIT = ks.linkage.chain_unit(0.1, 1.0, 0.5)


def test_chain_unit_motion_is_relative(axes):
    for speed in (1.0, 7.0, -7.0):
        for order in (1, 2):
            ks.plots.chain_unit_motion(ks.Scene(UNIT, speed).solve(90), "rocker", order, ax=axes)
    first, second, *others = (line.get_ydata() for line in axes.lines if len(line.get_ydata()) > 2)
    for number, curve in enumerate(others):
        sense = -1 if number == 3 else 1  # as fast either way round; the acceleration points the other way then
        np.testing.assert_allclose(sense * curve, (first, second)[number % 2], atol=1e-12)


def test_motion_relative_to_a_crank_at_rest_is_refused(axes):
    with pytest.raises(ks.ParameterError, match="the crank speed of rocker rate is 0"):
        ks.plots.chain_unit_motion(ks.Scene(UNIT, 0.0).solve(8), "rocker", ax=axes)


def test_shaking_force_is_drawn_to_its_size():
    s = ks.Scene(ks.crank_slider(0.04, 0.3, slider=ks.Link(5.0)), 60.0).solve(90)
    ax = ks.plots.shaking_force(s)
    s = with_peaks({"": s}, "shaking_force")[""]
    angle, size = ax.lines[0].get_data()
    x, y = s.shaking_force
    np.testing.assert_allclose(size[:-1] * np.cos(angle[:-1]) * np.hypot(x, y).max() / size.max(), x, atol=1e-9)


# Figures of designs


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    return ks.load_case(saw_with(STIFFER + FRONT, tmp_path_factory.mktemp("saw")))


@pytest.fixture(scope="module")
def found(case):
    return {name: item.find() for name, item in case.designs.items()}


@pytest.mark.slow
def test_every_design_has_its_page(case, found, tmp_path):
    paths = figures.draw_designs(case, found, tmp_path / "new", "svg")
    assert [path.name for path in paths] == ["saw_stiffer.svg", "saw_trade.svg"]
    assert sorted((tmp_path / "new").iterdir()) == paths


@pytest.mark.slow
def test_page_shows_curves_before_and_after(found):
    figure = figures.before_and_after(found["stiffer"])
    titles = [ax.get_title() for ax in figure.axes]
    assert {"pitch curve of the cam", "support reaction, before", "support reaction, after"} <= set(titles)
    for ax in figure.axes:
        assert ax.get_xlabel().endswith("]")
        assert ax.get_ylabel().endswith("]")
    plt.close(figure)


@pytest.mark.slow
def test_page_without_cam_shows_the_machine():
    vary = {"coupler_length": ("1.9 m", "2.1 m")}
    found = ks.design.optimise(ks.load_case("sawframe_2r63"), vary, "largest O", angles=36, variant="plain")
    figure = figures.before_and_after(found)
    assert [ax.get_title() for ax in figure.axes].count("after") == 1
    plt.close(figure)


def test_radii_of_cams_are_those_of_the_cams():
    cams = {"one": ks.cams.Circle(0.3, (-0.02, 0.0)), "other": ks.cams.Circle(0.28)}
    ax = figures.cam_radius(cams)
    one, other = (line.get_ydata() for line in ax.lines)
    assert one.min() == pytest.approx(280.0)
    assert one.max() == pytest.approx(320.0)
    assert other == pytest.approx(280.0)
    assert ax.get_ylim()[0] < 280.0
    plt.close(ax.figure)


def test_curves_of_cams_lie_around_the_crank():
    ax = figures.pitch_curves({"one": ks.cams.Circle(0.3, (-0.02, 0.0))})
    x, y = ax.lines[0].get_data()
    assert ((x + 20) ** 2 + y**2) == pytest.approx(300.0**2)
    plt.close(ax.figure)


@pytest.mark.slow
def test_an_input_is_never_overwritten(case, found, tmp_path):
    (tmp_path / "file").write_text("old")
    with pytest.raises(ks.ParameterError, match="figures"):
        figures.draw_designs(case, found, tmp_path / "file")

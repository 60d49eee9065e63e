"""Figures of designs: a page for each, with labelled axes; nothing drawn where one cannot be."""

import matplotlib.pyplot as plt
import pytest

import kinetostatics as ks
from kinetostatics.views import figures
from support.case_files import FRONT, STIFFER, saw_with


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


def test_page_without_cam_shows_the_machine():
    vary = {"coupler_length": ("1.9 m", "2.1 m")}
    found = ks.design.optimise(ks.load_case("sawframe_2r63"), vary, "largest O", angles=36, variant="plain")
    figure = figures.before_and_after(found)
    assert [ax.get_title() for ax in figure.axes].count("after") == 1
    assert figures.cam_of(found.scene) is None
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


def test_an_input_is_never_overwritten(case, found, tmp_path):
    (tmp_path / "file").write_text("old")
    with pytest.raises(ks.ParameterError, match="figures"):
        figures.draw_designs(case, found, tmp_path / "file")

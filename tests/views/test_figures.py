"""The figures of a case: which there are, that each can be read, and that nothing is drawn where one cannot be."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import figures, strokes
from kinetostatics.views.canvas import FROM_X, FROM_Y_CLOCKWISE
from kinetostatics.views.figures import draw_case
from support.case_files import shipped
from support.every import every

pytestmark = pytest.mark.slow

CASE = shipped("sawframe_2r63")


def drawn(name, figure, counted=FROM_X, angles=360):
    """A figure of a shipped case: of the variants compared with its reference."""
    case = shipped(name)
    names = [case.reference, *case.comparisons[case.reference]]
    return figures.FIGURES[figure][0]({other: case.solve(other, angles) for other in names}, counted)


def test_one_figure_is_drawn_to_its_file(tmp_path):
    case = shipped("sawframe_2r63_optimal")
    (path,) = draw_case(case, tmp_path, "svg", only="pressure_angle")
    assert path == tmp_path / "sawframe_2r63_optimal_pressure_angle.svg"
    assert list(tmp_path.iterdir()) == [path]


def test_unknown_figure_lists_the_known_ones(tmp_path):
    with pytest.raises(ks.ParameterError, match=r"figure is 'presure_angle'.*did you mean 'pressure_angle'"):
        draw_case(CASE, tmp_path, only="presure_angle")
    with pytest.raises(ks.ParameterError, match="figure is 'cam_force'"):
        draw_case(ks.load_case("chain_unit"), tmp_path, only="cam_force")
    assert list(tmp_path.iterdir()) == []


@every("name", ["sawframe_2r63", "mower_drive", "chain_unit"])
def test_every_axis_has_its_unit(name):
    case = shipped(name)
    counted = FROM_Y_CLOCKWISE if name == "chain_unit" else FROM_X
    for figure in figures.figures_of(case):
        made = drawn(name, figure, counted, 72)
        for ax in made.axes:
            if ax.name != "polar":
                assert all(text.endswith("]") for text in (ax.get_xlabel(), ax.get_ylabel())), figure
            if "crank angle" in ax.get_xlabel():
                assert ax.get_xlabel() == counted.axis
        plt.close(made)


def test_counterweight_variants_share_a_panel():
    made = drawn("mower_drive", "mechanism")
    (ax,) = made.axes
    assert ax.get_title() == "unbalanced, full, partial-1, partial-2, partial-3, optimal"
    legend = [text.get_text() for text in ax.get_legend().get_texts()]
    assert legend == [f"counterweight: {name}" for name in ("full", "partial-1", "partial-2", "partial-3", "optimal")]
    weights = [patch for patch in ax.patches if len(patch.get_xy()) > 20]
    assert len(weights) == 6  # full balancing needs two
    plt.close(made)


def test_different_geometry_has_its_own_panel():
    made = drawn("sawframe_2r63", "mechanism")
    assert [ax.get_title() for ax in made.axes] == ["plain", "cam-circle", "cam-cosine"]
    plt.close(made)


def test_part_of_one_variant_is_in_the_legend():
    made = drawn("compressor", "mechanism")
    (ax,) = made.axes
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["load: loaded"]
    plt.close(made)


MEANT = {
    "sawframe_2r63": True,
    "sawframe_2r63_optimal": True,
    "mower_drive": False,
    "yoke_pump": False,
    "shaper": False,
}


@every("name", MEANT)
def test_cosine_law_is_compared_where_meant(name):
    assert ("acceleration_error" in figures.figures_of(shipped(name))) == MEANT[name]


@pytest.mark.parametrize(
    ("name", "number"),
    [("torque", "figure 6a of the study"), ("hodograph", "figure 7 of the study"), ("mechanism", None)],
)
def test_a_figure_of_the_study_carries_its_number(name, number, tmp_path, monkeypatch):
    seen = []
    monkeypatch.setattr(figures, "save_figure", lambda figure, path, *_: seen.append(figure) or path)
    draw_case(CASE, tmp_path, only=name)
    assert [text.get_text() for text in seen[0].texts] == ([] if number is None else [number])
    plt.close(seen[0])


def test_number_of_an_absent_figure_is_refused(tmp_path):
    text = CASE.path.read_text(encoding="utf-8").replace('torque = "6a"', 'torqe = "6a"')
    path = tmp_path / "saw.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ks.CaseError, match=r"published.figures is 'torqe'.*did you mean 'torque'"):
        draw_case(ks.load_case(path), tmp_path)


def test_chain_unit_figures_count_as_the_study():
    solution = shipped("chain_unit").solve("rho-0.5", 360)
    ax = ks.plots.torque(solution, counted=FROM_Y_CLOCKWISE)
    curve = next(line for line in ax.lines if len(line.get_xdata()) > 2)
    degrees, torque = curve.get_data()
    assert np.all(np.diff(degrees) > 0)
    row = int(np.argmin(np.abs(degrees - 30.0)))
    assert torque[row] == pytest.approx(solution.balancing_torque[60])  # 60 degrees from +x
    plt.close(ax.figure)


def test_drawing_leaves_the_settings_of_others_alone(tmp_path):
    before = dict(plt.rcParams), plt.get_fignums()
    draw_case(shipped("yoke_pump"), tmp_path, only="hodograph")
    assert (dict(plt.rcParams), plt.get_fignums()) == before


@pytest.mark.parametrize(
    ("case", "name"),
    [("compressor", "loaded"), ("toggle_press", "coining"), ("shaper", "cutting"), ("sawframe_2r63", "cam-cosine")],
)
def test_overview_takes_the_variant_with_loads(case, name):
    ax = drawn(case, "overview", angles=36).axes[0]
    assert ax.get_title().startswith(f"{name}: ")
    assert any(len(line.get_xdata()) == len(strokes.ARROW) for line in ax.lines) or case == "sawframe_2r63"
    plt.close(ax.figure)

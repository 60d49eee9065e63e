"""The figures of a case: which there are, and that nothing is drawn where one cannot be."""

import pytest

import kinetostatics as ks
from kinetostatics.views.figures import draw_case
from support.shipped import shipped

CASE = shipped("sawframe_2r63")


def test_one_figure_is_drawn_to_its_file(tmp_path):
    (path,) = draw_case(CASE, tmp_path, "svg", only="pressure_angle")
    assert path == tmp_path / "sawframe_2r63_pressure_angle.svg"
    assert list(tmp_path.iterdir()) == [path]


def test_a_figure_that_the_case_has_not_is_answered_with_those_it_has(tmp_path):
    with pytest.raises(ks.ParameterError, match=r"figure is 'presure_angle'.*did you mean 'pressure_angle'"):
        draw_case(CASE, tmp_path, only="presure_angle")
    with pytest.raises(ks.ParameterError, match="figure is 'cam_force'"):
        draw_case(ks.load_case("chain_unit"), tmp_path, only="cam_force")
    assert list(tmp_path.iterdir()) == []

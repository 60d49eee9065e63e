"""Pages of a hand calculation: 80 columns of text, LaTeX whose braces match, HTML that is well formed and alone."""

import re
from xml.etree import ElementTree as ET

import pytest

import kinetostatics as ks
from kinetostatics.solution.explanation_pages import STYLE
from support.chains import chain
from support.friction_machines import Drawn


@pytest.fixture(scope="module", params=["friction of a cam", "chain", "balanced cam"])
def told(request):
    if request.param == "balanced cam":
        return ks.load_case("sawframe_2r63_optimal").variants["cam-robust"].scene.solve(0.7).explain("O", 0.7)
    if request.param == "chain":
        scene, angles = chain(1)
        return scene.solve(angles).explain("O", float(angles[0]))
    return Drawn("cam", 1).scene.solve(0.3).explain("balancing_torque", 0.3)


def test_text_fits_80_columns_and_has_every_step(told):
    assert max(map(len, told.text.splitlines())) <= 80
    for step in told.steps:
        assert f"  {step.symbol} " in told.text


def test_a_formula_broken_over_lines_is_the_same_formula(told):
    together = re.sub(r"\s+", "", told.text)
    for step in told.steps:
        if step.formula:
            assert re.sub(r"\s+", "", f"{step.symbol}={step.formula}=") in together


def test_html_is_well_formed_and_asks_for_nothing(told):
    tree = ET.fromstring(told.html.replace(STYLE, ""))
    assert len(tree.findall(".//math")) > 2 * len(told.steps)
    assert not re.search(r"https?:|src=|href=|@import|url\(", told.page)
    assert told.page.startswith("<!DOCTYPE html>")
    headings = [heading.text for heading in tree.findall("h4")]
    assert headings == list(dict.fromkeys(headings))


def test_latex_has_matching_braces_and_a_line_for_each_step(told):
    assert told.latex.count("{") == told.latex.count("}")
    assert told.latex.count(" &= ") == len(told.steps)
    assert told.latex.count(r"\begin{align*}") == told.latex.count(r"\end{align*}")
    assert r"\left(" in told.latex


def test_names_with_signs_of_latex_and_html_are_escaped():
    pump = ks.Mechanism("50% & <b>", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(1.0)),))
    told = ks.solve(pump, 0.7, crank_speed=9.0).explain("balancing_torque", 0.7)
    assert r"50\% \& <b>" in told.latex
    assert "50% &amp; &lt;b&gt;" in told.html
    ET.fromstring(told.html.replace(STYLE, ""))

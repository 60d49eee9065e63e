"""What a user sees of a hand calculation: beside one done by hand, as text, steps, LaTeX and HTML."""

import re
from math import asin, cos, degrees, hypot, pi, sin
from xml.etree import ElementTree as ET

import pytest

import kinetostatics as ks
from kinetostatics.explain.explanation import STYLE
from support.chains import chain
from support.friction_machines import Drawn

R, L, MASS, SPEED, ANGLE = 0.05, 0.2, 1.5, 100.0, 0.7
PUMP = ks.solve(ks.crank_slider(R, L, slider=ks.Link(MASS)), 0.0, crank_speed=SPEED)
TOLD = PUMP.explain("balancing_torque", ANGLE)


def value(symbol, told=TOLD):
    return next(step.value for step in told.steps if step.symbol == symbol)


def test_explanation_is_the_textbook_calculation():
    """Crank-slider by the angle beta of the rod: sin(beta) = r/l sin(phi), forces from the slider inwards."""
    beta = -asin(R / L * sin(ANGLE))
    ratio = -R * cos(ANGLE) / (L * cos(beta))
    slope = (R * sin(ANGLE) + L * sin(beta) * ratio**2) / (L * cos(beta))
    acceleration = -R * cos(ANGLE) - L * cos(beta) * ratio**2 - L * sin(beta) * slope
    along = MASS * SPEED**2 * acceleration
    across = along * sin(beta) / cos(beta)
    torque = R * cos(ANGLE) * across - R * sin(ANGLE) * along
    for symbol, wanted in {
        "x_A": R * cos(ANGLE),
        "w": L * cos(beta),
        "uy_coupler": sin(beta),
        "theta_coupler'": ratio,
        "theta_coupler''": slope,
        "s_slider''": acceleration,
        "Px_slider": -along,
        "Rx_A": along,
        "Ry_A": across,
        "T": torque,
    }.items():
        assert value(symbol) == pytest.approx(wanted, rel=1e-13), symbol
    assert f"unit vector of the crank, at {degrees(ANGLE):.6g} deg" in TOLD.text


def test_text_gives_formula_numbers_and_unit():
    lines = TOLD.text.splitlines()
    assert lines[0] == "crank-slider: balancing torque at crank angle 0.7 rad = 40.107 deg"
    assert "  l_crank   = 0.05 m                crank_length" in lines
    assert "    x_A = l_crank*ux_crank = 0.05*0.764842 = 0.0382421 m" in lines
    assert "  angular velocity ratio of the coupler" in lines
    assert "    theta_coupler' = -y_A'/w = -0.0382421/0.197389 = -0.19374" in lines
    assert "  balancing torque, on the crank, counter-clockwise, to keep the motion" in lines
    assert lines[-1] == f"balancing_torque = {TOLD.value:.6g} N m"
    assert str(TOLD) == TOLD.text


def test_steps_are_data():
    step = TOLD.results[0]
    assert step is TOLD.steps[-1]
    assert (step.title, step.symbol, step.formula, step.unit) == ("Forces on crank", "T", "-M_crank", "N m")
    assert step.value == TOLD.value == float(PUMP.at(ANGLE).balancing_torque)
    assert step.shown == f"{TOLD.value:.6g}"
    given = TOLD.steps[0]
    assert (given.title, given.words, given.formula, given.numbers) == ("Given", "crank_length", "", "")


def test_vector_ends_with_components_and_magnitude():
    told = PUMP.explain("O", ANGLE)
    x, y = told.value
    assert [step.value for step in told.results] == [x, y]
    assert told.conclusion == f"O = ({x:.6g}, {y:.6g}) N, magnitude {hypot(x, y):.6g} N"
    assert "reaction O at crank angle" in told.title


def test_an_angle_is_told_in_degrees_beside_rad():
    cam = ks.cams.Circle(0.3, (-0.02, 0.0))
    told = ks.solve(ks.cam_crank_slider(cam, 2.0), 0.0, crank_speed=1.0).explain("pressure_angle", 1.0)
    assert told.conclusion.endswith(f"rad = {degrees(told.value):.6g} deg")


def test_absent_terms_are_zero_without_a_step():
    told = PUMP.explain("crank_angular_acceleration", ANGLE)
    assert told.value == 0.0
    assert told.conclusion == "crank_angular_acceleration = 0 rad/s2"


def test_rounding_stands_as_zero():
    told = PUMP.explain("slider_velocity", 0.0)
    assert told.results[0].shown == "0"
    assert (
        ks.solve(ks.crank_slider(R, L), 0.0, crank_speed=9.0)
        .explain("slider_velocity", 3.141592653589793)
        .results[0]
        .shown
        == "0"
    )


@pytest.mark.slow
def test_table_rounding_is_zero_too():
    """Horizontally the counterweights of the mower balance the pin: 3e-10 N are left of kilonewtons."""
    solution = ks.load_case("mower_drive").solve("full", 8)
    told = solution.explain("A", 1.5 * pi)
    left = [abs(step.value) for step in told.results if step.shown == "0"]
    assert left
    assert all(0.0 < size <= 1e-13 * solution.largest_force_term for size in left)


def test_notebooks_and_prompts_show_it():
    assert TOLD._repr_html_() == TOLD.html
    assert TOLD._repr_latex_() == TOLD.latex
    assert repr(TOLD) == f"<Explanation: {TOLD.title}, {len(TOLD.steps)} steps; print it>"


# Pages of a hand calculation


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


def test_broken_formula_is_the_same_formula(told):
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


def test_latex_has_matching_braces_a_line_a_step(told):
    assert told.latex.count("{") == told.latex.count("}")
    assert told.latex.count(" &= ") == len(told.steps)
    assert told.latex.count(r"\begin{align*}") == told.latex.count(r"\end{align*}")
    assert r"\left(" in told.latex


def test_latex_and_html_signs_are_escaped():
    pump = ks.Mechanism("50% & <b>", ks.Crank(0.05), (ks.SliderGroup(0.2, slider=ks.Link(1.0)),))
    told = ks.solve(pump, 0.7, crank_speed=9.0).explain("balancing_torque", 0.7)
    assert r"50\% \& <b>" in told.latex
    assert "50% &amp; &lt;b&gt;" in told.html
    ET.fromstring(told.html.replace(STYLE, ""))

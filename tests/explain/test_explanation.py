"""Hand calculations of values: every step is printed, computes, and gives the value of the solution."""

import math
import re
import sys
import warnings
from math import asin, cos, degrees, hypot, pi, sin
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.casefile.reading import shipped_cases
from kinetostatics.explain.explanation import STYLE
from kinetostatics.mechanics.quantities import components, of_scene
from kinetostatics.solution.parameters import tables_over_angles
from support.case_files import shipped
from support.chains import chain
from support.every import every
from support.followers import KINDS as FOLLOWERS
from support.followers import scene as with_follower
from support.friction_machines import KINDS as RUBBING
from support.friction_machines import Drawn
from support.retold import largest_error
from support.scenes import ANGLES, FORCES, OWN, SCENES, SPEED
from support.scenes import solve as solved

R, L, MASS, PUMP_SPEED, ANGLE = 0.05, 0.2, 1.5, 100.0, 0.7
PUMP = ks.solve(ks.crank_slider(R, L, slider=ks.Link(MASS)), 0.0, crank_speed=PUMP_SPEED)
TOLD = PUMP.explain("balancing_torque", ANGLE)


def value(symbol, told=TOLD):
    return next(step.value for step in told.steps if step.symbol == symbol)


def test_explanation_is_the_textbook_calculation():
    """Crank-slider by the angle beta of the rod: sin(beta) = r/l sin(phi), forces from the slider inwards."""
    beta = -asin(R / L * sin(ANGLE))
    ratio = -R * cos(ANGLE) / (L * cos(beta))
    slope = (R * sin(ANGLE) + L * sin(beta) * ratio**2) / (L * cos(beta))
    acceleration = -R * cos(ANGLE) - L * cos(beta) * ratio**2 - L * sin(beta) * slope
    along = MASS * PUMP_SPEED**2 * acceleration
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


def test_the_stroke_of_a_cut_is_told_at_its_dead_centres():
    cut = ks.Sawing(kerf=3.2e-3, height=0.25, saws=8, feed_per_stroke=0.02, resistance=50e6)
    told = ks.solve(ks.crank_slider(0.3, 2.0), 0.0, crank_speed=1.0, loads=cut).explain("balancing_torque", 2.0)
    assert "crank angle of the far dead centre" in " ".join(str(told).split())


def test_a_table_from_a_dead_centre_is_read_at_the_angle_from_it():
    gas = ks.ProcessForce(ks.Table([0.0, 2.0, 4.0], [-9e3, -1e3, 0.0], zero="TDC"))
    machine = ks.crank_slider(0.05, 0.2, guide_angle=1.3)
    told = ks.solve(machine, 0.0, crank_speed=1.0, loads=gas).explain("balancing_torque", 2.0)
    text = " ".join(str(told).split())
    assert "crank angle of the dead centre at which the table begins" in text
    assert "(phi - phi_0_process_force - start_process_force)" in text


def test_absent_terms_are_zero_without_a_step():
    told = PUMP.explain("crank_angular_acceleration", ANGLE)
    assert told.value == 0.0
    assert told.conclusion == "crank_angular_acceleration = 0 rad/s2"


def test_rounding_stands_as_zero():
    light = ks.solve(ks.crank_slider(R, L), 0.0, crank_speed=9.0)
    for solution, angle in ((PUMP, 0.0), (light, pi)):
        assert solution.explain("slider_velocity", angle).results[0].shown == "0"


@pytest.mark.slow
def test_table_rounding_is_zero_too():
    """Horizontally the counterweights of the mower balance the pin: 3e-10 N are left of kilonewtons."""
    solution = shipped("mower_drive").solve("full", 8)
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
        return shipped("sawframe_2r63_optimal").variants["cam-robust"].scene.solve(0.7).explain("O", 0.7)
    if request.param == "chain":
        scene, angles = chain(1)
        return scene.solve(angles).explain("O", float(angles[0]))
    return Drawn("cam", 1).scene.solve(0.3).explain("balancing_torque", 0.3)


@pytest.mark.slow
def test_text_fits_80_columns_and_has_every_step(told):
    assert max(map(len, told.text.splitlines())) <= 80
    for step in told.steps:
        assert f"  {step.symbol} " in told.text


@pytest.mark.slow
def test_broken_formula_is_the_same_formula(told):
    together = re.sub(r"\s+", "", told.text)
    for step in told.steps:
        if step.formula:
            assert re.sub(r"\s+", "", f"{step.symbol}={step.formula}=") in together


@pytest.mark.slow
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


# Hand calculations

STEP, CHAIN, VALUE = 1e-15, 1e-14, 1e-13
LOADED = ks.Scene(
    ks.crank_slider(0.05, 0.2, coupler=ks.Link(0.5, (0.08, 0.01), 0.01), slider=ks.Link(1.0)), 100.0, loads=ks.Gravity()
)
CHANGING = {
    "antiparallelogram": ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0.0), assembly="crossed", rocker=ks.Link(1.0)),
    "parallelogram": ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0.0), assembly="open", coupler=ks.Link(1.0, 0.2)),
    "kite": ks.four_bar(0.1, 0.1, 0.4, rocker_pivot=(0.4, 0.0), assembly="open", rocker=ks.Link(1.0, 0.1)),
    "one change point": ks.four_bar(0.1, 0.3, 0.25, rocker_pivot=(0.45, 0.0), assembly="open", rocker=ks.Link(1.0)),
    "slider across": ks.crank_slider(0.1, 0.1, assembly="open", slider=ks.Link(1.0)),
    "lever": ks.slotted_lever(0.2, pivot=(0.0, -0.2), assembly="open", lever=ks.Link(1.0, 0.1, 0.01)),
}


def ask(solution, quantity, angle, design=None):
    """The calculation, looked at in every way."""
    told = solution.explain(quantity, angle, design)
    if not tables_over_angles(solution):
        place = () if design is None else (design, 0)
        found = [np.asarray(part)[place] for part in components(solution.at(angle), quantity)]
        np.testing.assert_allclose(np.ravel(told.value), found, rtol=VALUE, atol=VALUE * max(map(abs, found)))
    if told.results:
        np.testing.assert_array_equal([step.value for step in told.results], np.ravel(told.value))
    assert largest_error(told) < STEP
    assert largest_error(told, chained=True) < CHAIN
    assert max(map(len, told.text.splitlines())) <= 80
    return told


def some(solution, seed, count=2):
    """The torque, and a few other quantities."""
    names = [name for name, found in of_scene(solution).items() if found.kind != "check" and name != "balancing_torque"]
    return ["balancing_torque", *np.random.default_rng(seed).choice(names, count, replace=False).tolist()]


@pytest.mark.slow
@every("name", shipped_cases())
def test_shipped_cases(name):
    case = ks.load_case(name)
    solution = case.variant(list(case.variants)[-1]).scene.solve(2.3)
    for quantity in some(solution, 0, 1):
        ask(solution, quantity, 2.3)


@pytest.mark.slow
@every("seed", range(3))
def test_random_chains_of_every_group(seed):
    scene, angles = chain(seed)
    solution = scene.solve(angles)
    for quantity in some(solution, seed, 1):
        ask(solution, quantity, float(angles[1]))


@pytest.mark.slow
@every("kind", FOLLOWERS)
def test_followers(kind):
    ask(with_follower(FOLLOWERS[kind]()).solve(3), "O", 0.7)


@pytest.mark.slow
@every("kind", RUBBING)
def test_friction_is_told_by_the_law_that_it_satisfies(kind):
    told = ask(Drawn(kind, 1).scene.solve(0.3), "balancing_torque", 0.3)
    assert any("solved together with the reactions" in step.words for step in told.steps)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("name", CHANGING)
def test_branches_that_pass_change_points(name):
    solution = ks.solve(CHANGING[name], 0.7, crank_speed=9.0, loads=ks.Gravity())
    for quantity in ("balancing_torque", "O"):
        ask(solution, quantity, 0.7)


@pytest.mark.slow
@every("quantity", ["|O|", "|B|", "|shaking_force|"])
def test_a_magnitude_is_told_by_its_components(quantity):
    solution = solved(SCENES["plain, everything"], 1.1)
    told, vector = solution.explain(quantity, 1.1), solution.explain(quantity.strip("|"), 1.1)
    assert told.value == told.results[0].value == pytest.approx(np.hypot(*vector.value), rel=1e-15)
    assert told.label == f"|{vector.label}|"
    assert told.text.endswith(f"{quantity} = {told.results[0].shown} N")
    assert [step.formula for step in told.steps[:-1]] == [step.formula for step in vector.steps]
    assert largest_error(told) < STEP


@every(("quantity", "words"), [("|balancing_torque|", "only vectors have"), ("|Q|", "quantity is 'Q', allowed")])
def test_magnitudes_of_what_is_no_vector_are_refused(quantity, words):
    with pytest.raises(ks.QuantityError, match=words):
        solved(SCENES["plain, everything"], 1.1).explain(quantity, 1.1)


@pytest.mark.slow
@every("name", ["plain, everything", "circle cam, everything", "six-bar"])
def test_inclined_guides_and_all_masses(name):
    for quantity in ("balancing_torque", "shaking_moment", "kinetic_energy"):
        ask(solved(SCENES[name], 1.1), quantity, 1.1)


LOADS = {
    "force along a link": ks.Force(30.0, at=("coupler", 0.1, 0.02), direction=0.4, along="coupler"),
    "point force": ks.PointForce(30.0, between=("B", (0.0, 0.5))),
    "point spring": ks.PointSpring(1e3, 0.1, between=("A", (0.0, 0.5))),
    "spring of length 0": ks.PointSpring(1e3, between=("A", (0.0, 0.5))),
    "point damper": ks.PointDamper(20.0, between=("B", (0.3, 0.5))),
    "torque": ks.Torque(5.0, on="coupler", against="crank"),
    "torsion spring": ks.TorsionSpring(5.0, 0.1, on="coupler", moment=0.3),
    "torsion damper": ks.TorsionDamper(0.3, on="coupler", against="crank"),
    "cubic spring": ks.Spring(1e3, 0.2, cubic=1e5),
    "spring with mass": ks.Spring(1e3, 0.2, mass=0.001),
    "gas spring": ks.GasSpring(1e-3, 3e-4, 3e5, at=0.2),
    "balance shaft": ks.BalanceShaft(0.01, -2, 0.3, (0.1, 0.0), 0.01),
    "table over the angle": ks.ProcessForce(ks.Table([0.0, 2.0, 4.0], [1.0, 5.0, 2.0])),
    "table over travel": ks.ProcessForce(ks.Table([0.1, 0.2, 0.3], [9.0, 5.0, 7.0], over="travel")),
}


@pytest.mark.slow
@every("name", LOADS)
def test_every_load(name):
    scene = ks.Scene(LOADED.mechanism, 40.0, 30.0, (ks.Gravity(), LOADS[name]))
    told = ask(scene.solve(0.7), "balancing_torque", 0.7)
    assert len({step.title for step in told.steps}) > 5


@pytest.mark.slow
@every("name", OWN)
def test_own_groups_and_cams_are_explained(name):
    told = ask(solved(OWN[name][0], 0.7), "balancing_torque", 0.7)
    assert told.steps


@pytest.mark.slow
@every("name", ["function that can be recorded", "function of plain numbers"])
def test_functions_of_the_users_own(name):
    solution = ks.solve(LOADED.mechanism, 0.7, crank_speed=SPEED, loads=ks.ProcessForce(FORCES[name][0]))
    ask(solution, "balancing_torque", 0.7)


def test_array_load_is_read_at_its_own_angle():
    solution = ks.solve(LOADED.mechanism, ANGLES, crank_speed=SPEED, loads=ks.ProcessForce(1e3 * np.sin(ANGLES)))
    told = ask(solution, "balancing_torque", float(ANGLES[40]))
    assert told.value == pytest.approx(solution.balancing_torque[40], rel=VALUE)
    with pytest.raises(
        ks.ParameterError, match="ProcessForce is a table over the given crank angles, without values between"
    ):
        solution.explain("balancing_torque", 0.7)


def test_a_machine_at_its_true_speed():
    motor = ks.drive.Motor.kloss(2000.0, 150.0, synchronous_speed=157.0, overload=2.5, transmission=1.5)
    run = ks.drive.steady(ks.Scene(LOADED.mechanism, 100.0, loads=ks.Gravity()), motor, flywheel=0.5).solution
    told = ask(run, "balancing_torque", float(run.crank_angle[7]))
    assert told.value == pytest.approx(run.balancing_torque[7], rel=1e-12)


def test_one_of_several_designs():
    sizes = np.array([[0.05], [0.06]])
    mechanism = ks.crank_slider(sizes, 0.2, slider=ks.Link(2.0 * sizes), guide_angle=0.1)
    solution = ks.solve(mechanism, [0.1, 0.2], crank_speed=50.0, loads=ks.ProcessForce(1e3 * sizes))
    told = ask(solution, "balancing_torque", 0.7, design=1)
    assert next(step.value for step in told.steps if step.words == "crank_length") == 0.06
    with pytest.raises(ks.ParameterError, match=r"choose one of the designs of shape \(2,\), as design=0"):
        solution.explain("balancing_torque", 0.7)
    with pytest.raises(ks.ParameterError, match=r"design 2 is not among the designs of shape \(2,\)"):
        solution.explain("balancing_torque", 0.7, design=2)


@every(
    "asked, words",
    [
        (("torque", 0.7), "quantity is 'torque', allowed: 'balancing_torque'"),
        ((None, 0.7), "quantity is None"),
        ((["O"], 0.7), "quantity is"),
        (("friction_residual", 0.7), "quantity is 'friction_residual'"),
        (("O", [0.1, 0.2]), "give one crank angle, got 2"),
        (("O", math.nan), "finite"),
        (("O", "0.7"), "crank_angle"),
    ],
)
def test_unexplainable_is_one_library_error(asked, words):
    with pytest.raises(ks.KinetostaticsError) as error:
        LOADED.solve(0.0).explain(*asked)
    assert words in str(error.value)


def test_a_gap_is_an_assembly_error_with_its_numbers():
    rocking = ks.four_bar(0.3, 0.4, 0.3, rocker_pivot=(0.5, 0.0), rocker=ks.Link(1.0))
    solution = ks.solve(rocking, [0.5, 3.0], crank_speed=1.0, on_gap="nan")
    with pytest.raises(ks.AssemblyError, match="the distance from A to O2"):
        solution.explain("balancing_torque", 3.0)


def test_hints_are_not_told_again():
    odd = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0, 30.0))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        solution = ks.solve(odd, 0.7, crank_speed=1.0)
        count = len(told)
        solution.explain("balancing_torque", 0.7)
    assert count
    assert len(told) == count


def test_a_running_profiler_goes_on():
    solution, calls = LOADED.solve(0.0), []

    def profiler(frame, event, value):
        calls.append(event)

    sys.setprofile(profiler)
    try:
        told = solution.explain("balancing_torque", 0.7)
        assert sys.getprofile() is profiler
    finally:
        sys.setprofile(None)
    assert calls
    assert largest_error(told) < STEP
    assert told.value == solution.explain("balancing_torque", 0.7).value


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning", "ignore::kinetostatics.HintWarning")
@every("angle", [math.asin(0.5) - 1e-17, math.nextafter(math.asin(0.5), 1.0)])
def test_limit_of_the_divisor_is_explained(angle):
    solution = ks.solve(ks.crank_slider(0.2, 0.1, slider=ks.Link(1.0)), angle, crank_speed=9.0)
    told = ask(solution, "balancing_torque", angle)
    assert any("/max(w, " in step.formula for step in told.steps)
    assert next(step.shown for step in told.steps if step.symbol == "theta_coupler''") != "0"

"""Formulas of a hand calculation: their steps, number formats and symbols."""

from itertools import pairwise
from xml.etree import ElementTree as ET

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Graph, Node
from kinetostatics.explain.formats import (
    GREEK,
    LATEX,
    MATHML,
    TEXT,
    Symbol,
    format_number,
    load_keys,
    path_symbol,
    quantity_symbol,
    write_formula,
)
from kinetostatics.explain.formulas import formula, names_in
from kinetostatics.explain.named_recording import name_result, node_of, record_with_names
from kinetostatics.explain.steps import MAX_FORMULA_SIZE, lines
from kinetostatics.mechanics.quantities import of_scene
from tests.support.every import every
from tests.support.scenes import SCENES, solve


def spelled(make):
    """Text of what is made of recorded numbers a, b, c."""
    graph = Graph()
    given = [graph.parameter(place) for place in range(3)]
    tree = formula(make(*given), set(given))
    return write_formula(tree, TEXT, lambda place: Symbol("abc"[place]))


@every(
    "make, text",
    [
        (lambda a, b, c: a + b - c, "a + b - c"),
        (lambda a, b, c: a - (b + c), "a - (b + c)"),
        (lambda a, b, c: a - (b - c), "a - (b - c)"),
        (lambda a, b, c: (a + b) * c, "(a + b)*c"),
        (lambda a, b, c: a * (b / c), "a*(b/c)"),
        (lambda a, b, c: a / (b * c), "a/(b*c)"),
        (lambda a, b, c: a / b / c, "a/b/c"),
        (lambda a, b, c: a * a * b, "a^2*b"),
        (lambda a, b, c: (a + b) * (a + b), "(a + b)^2"),
        (lambda a, b, c: -a * b + c, "-a*b + c"),
        (lambda a, b, c: a * -b, "-a*b"),
        (lambda a, b, c: -(a + b), "-(a + b)"),
        (lambda a, b, c: c - a / -b, "c + a/b"),
        (lambda a, b, c: 0.0 * a + b, "b"),
        (lambda a, b, c: 0.0 - a, "-a"),
        (lambda a, b, c: 2.0 * a + 0.1, "2*a + 0.1"),
        (lambda a, b, c: -1.0 * a, "-a"),
        (lambda a, b, c: a.sin() * b.cos() + abs(c), "sin(a)*cos(b) + abs(c)"),
        (lambda a, b, c: a.forgiving_root(b * b), "sqrt(a)"),
        (lambda a, b, c: a.kept_off_zero(b) * c, "a*c"),
        (lambda a, b, c: a.moved_apart(b), "a"),
        (lambda a, b, c: (a * a + 1e-290).sqrt(), "sqrt(a^2)"),
        (lambda a, b, c: 0.5 * (a + b + abs(a - b)), "max(a, b)"),
        (lambda a, b, c: a.held() + b.arctan() * c.sign(), "a + atan(b)*sign(c)"),
    ],
)
def test_rounding_terms_are_dropped_and_signs_gathered(make, text):
    assert spelled(make) == text


def test_a_formula_lists_its_inputs_once_in_order():
    graph = Graph()
    a, b = graph.parameter(0), graph.parameter(1)
    inner = b * b
    tree = formula(inner * a + inner, {a, inner})
    assert [graph[place] is node for place, node in zip(names_in(tree), (inner, a), strict=True)] == [True, True]


def test_one_number_may_stand_for_another():
    graph = Graph()
    a = graph.parameter(0)
    turned = -a
    held = Node(graph, "held", (turned,), turned.varies)
    assert formula(turned * a, {a, held}, {turned: held}) == ("product", ("name", held.index), ("name", a.index))
    assert formula(held, {a, held}, {turned: held}) == ("negative", ("name", a.index))


# Lines


def found(solution, quantity):
    made, recorder = record_with_names(solution.dynamics, {}, {})
    nodes = [node_of(part) for part in name_result(made, quantity, of_scene(solution)[quantity])]
    return made.names, lines(made.names, nodes, recorder, solution.dynamics)


@pytest.mark.slow
@every("name", ["circle cam, everything", "four-bar", "six-bar"])
def test_formulas_are_short_and_name_lines_before_them(name):
    _, told_lines = found(solve(SCENES[name], np.array(0.7)), "balancing_torque")
    before = set()
    for line in told_lines:
        if line.tree:
            needed = names_in(line.tree)
            assert len(needed) <= MAX_FORMULA_SIZE
            assert before.issuperset(needed)
        before.add(line.node.index)
    titles = [line.named.title for line in told_lines]
    assert sum(one != other for one, other in pairwise(titles)) < 1.5 * len(set(titles))


def test_an_unexplained_line_joins_its_only_user():
    _, told_lines = found(solve(SCENES["plain"], np.array(0.7)), "balancing_torque")
    assert {line.named.kind for line in told_lines} == {"given", "protocol", "term"}


def test_units_follow_from_those_given():
    solution = ks.solve(
        ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 0.7, crank_speed=9.0, loads=ks.Spring(1e3, 0.2, cubic=10.0)
    )
    made, recorder = record_with_names(
        solution.dynamics,
        dict(enumerate(("crank_length", "coupler_length", "slider.mass", "crank_speed", "k", "s0", "c"))),
        {"crank_length": "m", "coupler_length": "m", "slider.mass": "kg", "crank_speed": "rad/s"}
        | {"k": "N/m", "s0": "m", "c": "N/m**3"},
    )
    nodes = [node_of(part) for part in name_result(made, "kinetic_energy", of_scene(solution)["kinetic_energy"])]
    units = {line.named.symbol.text: line.unit for line in lines(made.names, nodes, recorder, solution.dynamics)}
    assert units["w"] == "m"
    assert units["E_kinetic"] == "J"
    assert units["s_slider'"] == "m"


def test_what_is_rounding_of_larger_terms_is_noise():
    solution = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), np.pi, crank_speed=9.0)
    _, told_lines = found(solution, "slider_velocity")
    noise = {line.named.symbol.text for line in told_lines if line.is_noise}
    assert {"uy_crank", "y_A", "v_slider"} <= noise
    assert "x_A" not in noise


# Styles

A, B = ("name", 0), ("name", 1)
SYMBOLS = [Symbol("theta", owner="coupler", primes=1), Symbol("F", "x", "slider")]
TREES = {
    "sum": ("sum", (1, A), (-1, B)),
    "quotient": ("quotient", ("sum", (1, A), (1, B)), ("power", A, 2)),
    "product": ("product", A, ("negative", B)),
    "root": ("call", "sqrt", ("call", "abs", A)),
    "others": ("product", ("call", "max", A, B), ("call", "sign", A), ("call", "atan", ("call", "sin", B))),
}


@every(
    "style, name, text",
    [
        (TEXT, "sum", "theta_coupler' - Fx_slider"),
        (TEXT, "quotient", "(theta_coupler' + Fx_slider)/(theta_coupler')^2"),
        (TEXT, "product", "theta_coupler'*(-Fx_slider)"),
        (LATEX, "sum", r"\theta_{\mathrm{coupler}}' - F_{x,\mathrm{slider}}"),
        (LATEX, "root", r"\sqrt{\left|\theta_{\mathrm{coupler}}'\right|}"),
    ],
)
def test_symbols(style, name, text):
    assert write_formula(TREES[name], style, SYMBOLS.__getitem__) == text


@every("value, text", [(-0.5, "(-0.5)/(-0.5)^2"), (2.0, "2/2^2"), (1e-7, "1e-07/(1e-07)^2")])
def test_numbers_are_bracketed_where_they_must(value, text):
    assert write_formula(("quotient", A, ("power", A, 2)), TEXT, lambda place: value) == text


@every("name", TREES)
def test_mathml_is_well_formed(name):
    for given in (SYMBOLS.__getitem__, [-1.5e-7, 3.0].__getitem__):
        ET.fromstring(f"<math>{write_formula(TREES[name], MATHML, given)}</math>")


def test_values_have_six_digits_and_constants_all():
    assert format_number(1 / 3) == "0.333333"
    assert format_number(0.0) == "0"
    assert format_number(1 / 3, True) == "0.3333333333333333"
    assert format_number(2.0, True) == "2"
    assert LATEX.number(-2.5e-8) == r"-2.5 \cdot 10^{-8}"
    assert "−8" in MATHML.number(-2.5e-8)


def test_greek_letters_are_greek_in_latex_and_mathml():
    for name, letter in GREEK.items():
        assert LATEX.symbol(Symbol(name)) == f"\\{name}"
        assert MATHML.symbol(Symbol(name)) == f"<mi>{letter}</mi>"


# Symbols


@every(
    "path, text",
    [
        ("crank_length", "l_crank"),
        ("coupler_length2", "l_coupler2"),
        ("guide_angle", "beta"),
        ("guide_offset2", "e_2"),
        ("slider.mass", "m_slider"),
        ("coupler.centre.across", "b_coupler"),
        ("crank_speed", "omega"),
        ("gravity.acceleration", "g"),
        ("spring2.stiffness", "k_spring2"),
        ("rocker_pivot.x", "x_rocker_pivot"),
        ("cam.cosine.2", "cosine2_cam"),
        ("friction.A.mu", "mu_friction_A"),
        ("slot_angle", "slot_angle"),
    ],
)
def test_numbers_of_a_scene(path, text):
    assert path_symbol(path).text == text


@every(
    "quantity, text",
    [
        ("balancing_torque", "T"),
        ("guide_force2", "F_guide2"),
        ("coupler_rate", "omega_coupler"),
        ("coupler_angular_acceleration", "alpha_coupler"),
        ("slider_acceleration", "a_slider"),
        ("A_friction_loss", "P_A"),
        ("reduced_inertia", "reduced_inertia"),
    ],
)
def test_quantities(quantity, text):
    assert quantity_symbol(quantity).text == text


def test_a_symbol_as_text():
    assert Symbol("F", "x", "slider").text == "Fx_slider"
    assert Symbol("theta", owner="coupler", primes=2).text == "theta_coupler''"
    assert Symbol("w", again=2).text == "w2"
    assert Symbol("R", "x", "A pan").text == "Rx_A_pan"


def test_loads_of_a_kind_are_counted_as_in_paths():
    loads = (ks.Spring(1.0, 0.0), ks.Gravity(), ks.Spring(2.0, 0.0))
    assert load_keys(loads) == ["spring", "gravity", "spring2"]

"""Named recordings: each number has the name and symbol of its kernel variable, joint, link or load."""

import importlib
import inspect
import pkgutil

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import machine
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program
from kinetostatics.engines.record import Recording
from kinetostatics.explain.formats import Symbol
from kinetostatics.explain.named_recording import Names, name_result, node_of, record_with_names
from kinetostatics.mechanics.quantities import of_scene
from tests.support.scenes import SCENES, everything, solve

TERMS = {"wide": ("W", "a wide line"), "explained.given": ("G", "an argument that is explained")}


def explained(given):
    wide = given * given
    narrow, _hidden = wide + given, wide * 3.0
    pair = (narrow * 5.0, narrow * 7.0)
    return pair


def recorded():
    graph = Graph()
    names = Names(graph, {__name__})
    given = graph.parameter(0) + 1.0
    with names.under("A heading"):
        pair = explained(given)
    return graph, names, given, pair


def test_lines_are_named_by_variables_or_terms():
    _, names, given, pair = recorded()
    found = {named.symbol.text: named for named in names.of.values()}
    assert set(found) == {"W", "G", "narrow", "pairx", "pairy"}
    assert found["W"].words == "a wide line"
    assert found["W"].kind == "term"
    assert found["narrow"].kind == "line"
    assert names.of[given].words == "an argument that is explained"
    assert {named.title for named in found.values()} == {"A heading"}
    assert names.of[pair[1]].symbol == Symbol("pair", "y")


def test_a_mechanism_s_name_precedes_a_line():
    _, names, _, pair = recorded()
    x, y = names.vector(pair, Symbol("R", owner="B"), "reaction", "N")
    assert (x, y) == tuple(pair) or (x is pair[0] and y is pair[1])
    assert names.of[pair[0]].symbol.text == "Rx_B"
    assert names.has_own_name(pair[0])


def test_a_second_name_makes_another_number():
    _, names, given, _ = recorded()
    first = names.number(given, Symbol("a"))
    again = names.number(first, Symbol("b"), again=True)
    assert first is given
    assert names.number(first, Symbol("b")) is given
    (node,) = again
    assert node.operation == "held"
    assert node.arguments == (given,)


def test_a_negated_number_keeps_its_name_if_asked():
    _, names, given, _ = recorded()
    turned = -given
    (onward,) = names.number(turned, Symbol("a"))
    assert onward.arguments[0] is turned
    assert names.number(given - 2.0, Symbol("b"), turned="within") is not None
    other = -(given * 3.0)
    (held,) = names.number(other, Symbol("c"), turned="everywhere")
    assert names.stands_for[other] is held


def test_zero_has_no_name_but_as_a_result():
    _, names, given, _ = recorded()
    zero = given * 0.0
    names.number(zero, Symbol("z"))
    assert zero not in names.of
    names.number(zero, Symbol("z"), turned="always")
    assert names.of[zero].symbol.text == "z"
    assert names.number(np.float64(2.0), Symbol("n")) == 2.0


def test_symbols_spelled_alike_are_told_apart():
    _, names, given, _ = recorded()
    others = [given * 11.0, given * 13.0]
    for node in others:
        names.number(node, Symbol("q"))
    assert [symbol.text for symbol in names.symbols(others).values()] == ["q", "q2"]


def modules():
    for module in pkgutil.walk_packages(machine.__path__, f"{machine.__name__}."):
        found = importlib.import_module(module.name)
        if hasattr(found, "TERMS"):
            yield found


def kernels(module):
    """Variables by name of every function and method of a module."""
    found: dict[str, set] = {}
    parts = [part for part in vars(module).values() if getattr(part, "__module__", "") == module.__name__]
    methods = [item for part in parts if inspect.isclass(part) for item in vars(part).values()]
    for function in (*parts, *methods):
        code = getattr(inspect.unwrap(getattr(function, "func", function)), "__code__", None)
        if code is not None:
            found.setdefault(code.co_name, set()).update(code.co_varnames)
    return found


def test_terms_name_variables_of_their_kernels():
    looked_at = 0
    for module in modules():
        variables = kernels(module)
        for term in module.TERMS:
            kernel, dot, variable = term.rpartition(".")
            known = variables.get(kernel, set()) if dot else set().union(*variables.values())
            assert variable in known, f"{module.__name__}: no kernel has a variable {term!r}"
            looked_at += 1
    assert looked_at > 50


# Told scenes


def named(solution, quantity):
    made, recorder = record_with_names(solution.dynamics, {}, {})
    return made, recorder, name_result(made, quantity, of_scene(solution)[quantity])


@pytest.mark.slow
def test_every_quantity_is_computed_to_the_same_bits():
    solution = solve(SCENES["circle cam, everything"], np.array(0.7))
    _, leaves = solution.apart
    for quantity in everything(solution):
        _, recorder, found = named(solution, quantity)
        nodes = [node for node in map(node_of, found) if node is not None]
        recording = Recording(
            (), tuple(nodes), (), (), tuple(recorder.parameters), tuple(recorder.tables), recorder.graph
        )
        values = Program(recording).run(solution.dynamics, leaves)
        wanted = np.ravel(of_scene(solution)[quantity].read(solution))
        np.testing.assert_array_equal(values, wanted if len(nodes) == wanted.size else wanted[wanted != 0], quantity)


def test_names_are_those_of_joints_links_and_loads():
    solution = solve(SCENES["plain, everything"], np.array(0.7))
    made, _, _ = named(solution, "balancing_torque")
    names = {found.symbol.text for found in made.names.of.values() if found.kind == "protocol"}
    assert {"x_A", "y_A'", "ux_coupler", "theta_coupler''", "s_slider", "L_spring"} <= names
    assert {"rx_slider", "Px_coupler", "K_slider", "Fs_slider", "Rx_B", "F_guide", "M_guide", "M_crank", "T"} <= names


def test_headings_follow_the_calculation():
    solution = solve(SCENES["six-bar"], np.array(0.7))
    made, _, _ = named(solution, "balancing_torque")
    titles = made.names.titles
    order = [
        "Crank",
        "Motion of coupler and rocker, joint B and O2",
        "Forces on coupler2 and slider2",
        "Forces on crank",
    ]
    assert [title for title in titles if title in order] == order


def test_numbers_without_a_path_have_a_symbol():
    made, _ = record_with_names(
        ks.solve(ks.crank_slider(0.05, 0.2), 0.7, crank_speed=1.0).dynamics, {0: "crank_length"}, {}
    )
    symbols = [found.symbol.text for found in made.names.of.values() if found.kind == "given"]
    assert symbols == ["l_crank", "c_2", "c_3", "phi"]

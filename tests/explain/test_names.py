"""Names of recorded numbers: the mechanism's, then those of kernels' own lines."""

import importlib
import inspect
import pkgutil

import numpy as np

from kinetostatics import machine
from kinetostatics.engines.graph import Graph
from kinetostatics.explain.formats import Symbol
from kinetostatics.explain.named_recording import Names

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


def test_lines_of_a_kernel_are_called_as_its_variables_or_as_its_terms_say():
    _, names, given, pair = recorded()
    found = {named.symbol.text: named for named in names.of.values()}
    assert set(found) == {"W", "G", "narrow", "pairx", "pairy"}
    assert found["W"].words == "a wide line"
    assert found["W"].kind == "term"
    assert found["narrow"].kind == "line"
    assert names.of[given].words == "an argument that is explained"
    assert {named.title for named in found.values()} == {"A heading"}
    assert names.of[pair[1]].symbol == Symbol("pair", "y")


def test_the_mechanisms_name_comes_before_a_line_of_a_kernel():
    _, names, _, pair = recorded()
    x, y = names.vector(pair, Symbol("R", owner="B"), "reaction", "N")
    assert (x, y) == tuple(pair) or (x is pair[0] and y is pair[1])
    assert names.of[pair[0]].symbol.text == "Rx_B"
    assert names.has_own_name(pair[0])


def test_a_second_name_is_another_number_that_is_told_from_the_first():
    _, names, given, _ = recorded()
    first = names.number(given, Symbol("a"))
    again = names.number(first, Symbol("b"), again=True)
    assert first is given
    assert names.number(first, Symbol("b")) is given
    (node,) = again
    assert node.operation == "held"
    assert node.arguments == (given,)


def test_a_turned_number_keeps_its_name_onward_and_everywhere_if_told_so():
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


def test_terms_of_the_library_name_variables_that_its_kernels_have():
    looked_at = 0
    for module in modules():
        variables = kernels(module)
        for term in module.TERMS:
            kernel, dot, variable = term.rpartition(".")
            known = variables.get(kernel, set()) if dot else set().union(*variables.values())
            assert variable in known, f"{module.__name__}: no kernel has a variable {term!r}"
            looked_at += 1
    assert looked_at > 50

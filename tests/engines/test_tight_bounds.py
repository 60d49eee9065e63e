"""Tight bounds on rounding errors: never less than the true error, and smaller where errors cancel."""

from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.engines import NUMPY
from kinetostatics.engines.error_bounds import STRETCH, Error, ErrorBounds, tight_bounds
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program, operations, program_of
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies.stability import PLACES
from support.bounded import FAMILIES, errors, solution
from support.case_files import shipped
from support.every import every
from support.graphs import new_graph

MORE = 1.0 + 1e-12
"""For the rounding of bounds themselves."""


def found(graph, output, angle, *values):
    """Forward and tight bound of an output at a crank angle and some values of the parameters of a graph."""
    both = (*ErrorBounds(graph).of([output]), *tight_bounds(graph, {}, [output]))
    return Program(None, both)._by_numbers(np.array([angle]), values, (1,))[:, 0]


@pytest.mark.slow
@every("family", FAMILIES)
def test_random_machines_lie_within_tight_bounds(flint, family):
    made = next(found for found in (solution(family, seed, 8) for seed in range(9)) if found is not None)
    compared = errors(made, ("balancing_torque", "O"), tight=True)
    assert compared.values > 10
    assert compared.wrong == []


@every("design", [True, False])
def test_errors_under_nested_roots_count_in_full(design):
    graph = Graph()
    tiny = graph.parameter(0) if design else graph.parameter(0) * graph.angle()
    root = (tiny * tiny + tiny * tiny).sqrt().sqrt().sqrt()  # computed 0
    _, tight = found(graph, root, 1.0, 1e-166)
    assert not tight < 3.4e-42


def test_tiny_design_numbers_do_not_lose_an_adjoint():
    graph = Graph()
    row, tiny, unit = graph.row(0), *map(graph.parameter, range(2))
    root = (row.kept_off_zero(unit) * tiny).forgiving_root(unit)
    (bound,) = tight_bounds(graph, {row: lambda bounds: Error(0.0, graph.row(1))}, [root])
    (least,) = Program(None, (bound,)).by_numpy(np.zeros(1), [4e-164, 1e-152], [np.full(1, 3e-5), np.ones(1)], (1,))
    assert least >= 0.5 * UNIT_ROUNDOFF * (4e-164 / 3e-5) ** 0.5


def test_errors_of_what_is_used_twice_cancel():
    graph, other, factor = new_graph(2)
    rounded = graph.angle() + other + other
    forward, tight = found(graph, rounded - factor * rounded, 1.0, 0.3, 1.0 + 2.0**-30)
    assert forward > 7.0 * UNIT_ROUNDOFF
    assert tight == pytest.approx(1.6 * UNIT_ROUNDOFF, rel=0.01, abs=0.0)


def test_design_constants_carry_all_their_errors():
    graph, one, other = new_graph(2)
    lost = (one + other) - one  # computed 0, truly 2^-54
    rounded = lost * graph.angle() + lost * graph.angle().sin() + (3000.0 * lost) * graph.angle().cos()
    _, tight = found(graph, rounded, 1.0, 1.0, 2.0**-54)
    assert tight >= 2.0**-54 * (1.0 + np.sin(1.0) + 3000.0 * np.cos(1.0))


def test_uncertain_signs_have_no_tight_bound():
    graph, one, tiny = new_graph(2)
    doubtful = (graph.angle() + tiny) - one  # computed 0, truly 2^-54
    forward, tight = found(graph, doubtful + abs(doubtful) * one, 1.0, 1.0, 2.0**-54)
    assert forward >= 2.0**-53
    assert not np.isfinite(tight)
    assert np.isfinite(found(graph, doubtful + abs(doubtful) * one, 2.0, 1.0, 2.0**-54)).all()


def test_functions_have_terms_of_second_order():
    graph, error = Graph(), 2.0**-23
    row = graph.row(0)
    found = ErrorBounds(graph, {row: lambda bounds: Error(0.0, graph.row(1))}, weight=STRETCH).of([row.sin()])
    (bound,) = Program(None, found)._plain(0.0, 0.0, 1.0, [], [1.0, error / UNIT_ROUNDOFF])
    assert bound >= error + 0.5 * STRETCH * error**2


def test_second_order_errors_are_bounded():
    graph, other, tiny = new_graph(2)
    lost = [(part + tiny) - part for part in (graph.angle(), other)]  # computed 0, truly 2^-54
    _, tight = found(graph, lost[0] * lost[1], 1.0, 1.0, 2.0**-54)
    assert tight >= 2.0**-108


def test_large_second_order_uses_the_running_bound():
    graph = Graph()
    one, other = graph.angle(), graph.parameter(0)
    difference = one * one - other * other
    forward, tight = found(graph, one / difference, 1.0, 1.0 + 100 * UNIT_ROUNDOFF * STRETCH**0.5)
    assert np.isfinite(forward)
    assert not np.isfinite(tight)
    place = next(place for place in PLACES if place.name == "limit position")
    s = place.scene(1e-10)
    forward = s.error_bound("O")
    assert np.isfinite(forward).any()
    assert np.array_equal(np.isfinite(s.error_bound("O", tight=True)), np.isfinite(forward))


@pytest.mark.filterwarnings("ignore::kinetostatics.HintWarning")
def test_tight_bounds_are_finite_and_no_larger():
    for size in (1e-9, 1.0, 1e9):
        pump = ks.crank_slider(0.05 * size, 0.2 * size, slider=ks.Link(mass=1e-12), coupler=ks.Link(1e9, 0.1 * size))
        s = ks.solve(pump, np.linspace(0.1, 6.0, 40), crank_speed=1e-3)
        tight, forward = s.error_bound("balancing_torque", tight=True), s.error_bound("balancing_torque")
        assert np.all(tight <= MORE * forward)
        assert np.all(tight > 0.0)


@pytest.mark.slow
@every("family", FAMILIES)
def test_tight_exceeds_plain_by_its_remainder_only(family):
    """That makes the plain one larger by terms of second order, stretched; at a place, it is seen."""
    made = next(found for found in (solution(family, seed, 40) for seed in range(9)) if found is not None)
    names = ("balancing_torque", "O")
    plain, tight = (NUMPY.with_bounds(made.dynamics, names, way)[1] for way in (False, True))
    for name in names:
        known = np.isfinite(plain[name])
        assert np.all(tight[name][known] <= 1.01 * plain[name][known])


def test_tight_is_no_larger_where_tables_jump():
    s = shipped("yoke_pump").variants["pumping"].scene.solve(np.pi / 4 * np.arange(8))
    for name in ("O", "A", "guide"):
        assert np.all(s.error_bound(name, tight=True) <= MORE * s.error_bound(name))


def test_without_cancellation_tight_is_running():
    graph, one, other = new_graph(2)
    forward, tight = found(graph, (graph.angle() + one) * other / (one + 0.3), 1.0, 0.7, 0.9)
    assert tight == pytest.approx(forward, rel=1e-12, abs=0.0)


def test_an_exact_zero_has_what_may_underflow_as_tight_bound():
    graph, one = new_graph(1)
    recording = SimpleNamespace(graph=graph, inputs={})
    program = Program(recording, (one * one * graph.angle(),)).bounded(tight=True)
    found = program.by_numpy(np.zeros(3), [1.7], [], (3,))
    assert not found[0].any()
    assert np.all((found[1] >= 0.0) & (found[1] < 1e-300))


@pytest.mark.slow
@every(
    "case, variant",
    [("sawframe_2r63", "plain"), ("sawframe_2r63", "cam-cosine"), ("chain_unit", "rho-0.5"), ("toggle_press", "idle")],
)
def test_tight_takes_at_most_8_times_the_operations(case, variant):
    s = shipped(case).variants[variant].scene.solve(4)
    program, _ = program_of(s.dynamics, ("balancing_torque",))
    assert operations(program.bounded(tight=True).outputs) <= 8.0 * operations(program.outputs)


def test_arrays_that_underflow_have_numbers_bounds():
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1e-300))
    angles = np.linspace(0.3, 6.0, 30)
    many, alone = (ks.Scene(pump, 1e-9).solve(part).dynamics for part in (angles, angles[:1]))
    bound = [NUMPY.with_bounds(state, ("balancing_torque",))[1]["balancing_torque"] for state in (many, alone)]
    assert np.all(bound[0] > 0.0)
    assert bound[0][0] == bound[1][0]

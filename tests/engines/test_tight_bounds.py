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

MORE = 1.0 + 1e-12
"""For the rounding of bounds themselves."""


def found(graph, output, angle, *values):
    """Forward and tight bound of an output at a crank angle and some values of the parameters of a graph."""
    both = (*ErrorBounds(graph).of([output]), *tight_bounds(graph, {}, [output]))
    return Program(None, both)._by_numbers(np.array([angle]), values, (1,))[:, 0]


@every("family", FAMILIES)
def test_no_value_of_random_machines_is_off_by_more_than_its_tight_bound(flint, family):
    made = next(found for found in (solution(family, seed, 20) for seed in range(9)) if found is not None)
    compared = errors(made, ("balancing_torque", "O"), tight=True)
    assert compared.values > 10
    assert compared.wrong == []


@every("design", [True, False])
def test_what_is_lost_under_roots_of_roots_counts_in_full(design):
    graph = Graph()
    tiny = graph.parameter(0) if design else graph.parameter(0) * graph.angle()
    root = (tiny * tiny + tiny * tiny).sqrt().sqrt().sqrt()  # computed 0
    _, tight = found(graph, root, 1.0, 1e-166)
    assert not tight < 3.4e-42


def test_an_adjoint_is_not_lost_by_numbers_of_a_design_that_are_tiny():
    graph = Graph()
    row, tiny, unit = graph.row(0), *map(graph.parameter, range(2))
    root = (row.kept_off_zero(unit) * tiny).forgiving_root(unit)
    (bound,) = tight_bounds(graph, {row: lambda bounds: Error(0.0, graph.row(1))}, [root])
    (least,) = Program(None, (bound,)).by_numpy(np.zeros(1), [4e-164, 1e-152], [np.full(1, 3e-5), np.ones(1)], (1,))
    assert least >= 0.5 * UNIT_ROUNDOFF * (4e-164 / 3e-5) ** 0.5


def test_errors_of_what_is_used_twice_cancel():
    graph = Graph()
    other, factor = map(graph.parameter, range(2))
    rounded = graph.angle() + other + other
    forward, tight = found(graph, rounded - factor * rounded, 1.0, 0.3, 1.0 + 2.0**-30)
    assert forward > 7.0 * UNIT_ROUNDOFF
    assert tight == pytest.approx(1.6 * UNIT_ROUNDOFF, rel=0.01, abs=0.0)


def test_what_a_design_fixes_has_the_errors_of_all_that_it_is_computed_from():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    lost = (one + other) - one  # computed 0, truly 2^-54
    rounded = lost * graph.angle() + lost * graph.angle().sin() + (3000.0 * lost) * graph.angle().cos()
    _, tight = found(graph, rounded, 1.0, 1.0, 2.0**-54)
    assert tight >= 2.0**-54 * (1.0 + np.sin(1.0) + 3000.0 * np.cos(1.0))


def test_what_may_have_the_other_sign_than_its_magnitude_has_no_tight_bound_of_its_own():
    graph = Graph()
    one, tiny = map(graph.parameter, range(2))
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


def test_errors_that_count_in_second_order_alone_are_bounded():
    graph = Graph()
    other, tiny = map(graph.parameter, range(2))
    lost = [(part + tiny) - part for part in (graph.angle(), other)]  # computed 0, truly 2^-54
    _, tight = found(graph, lost[0] * lost[1], 1.0, 1.0, 2.0**-54)
    assert tight >= 2.0**-108


def test_where_terms_of_second_order_are_not_small_the_forward_bound_stands_in():
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
def test_tight_bounds_of_values_of_every_size_are_finite_and_no_larger():
    for size in (1e-9, 1.0, 1e9):
        pump = ks.crank_slider(0.05 * size, 0.2 * size, slider=ks.Link(mass=1e-12), coupler=ks.Link(1e9, 0.1 * size))
        s = ks.solve(pump, np.linspace(0.1, 6.0, 40), crank_speed=1e-3)
        tight, forward = s.error_bound("balancing_torque", tight=True), s.error_bound("balancing_torque")
        assert np.all(tight <= MORE * forward)
        assert np.all(tight > 0.0)


@every("family", FAMILIES)
def test_a_tight_bound_is_no_larger_than_the_plain_one_but_for_its_remainder(family):
    """That makes the plain one larger by terms of second order, stretched; at a place, it is seen."""
    made = next(found for found in (solution(family, seed, 40) for seed in range(9)) if found is not None)
    names = ("balancing_torque", "O")
    plain, tight = (NUMPY.with_bounds(made.dynamics, names, way)[1] for way in (False, True))
    for name in names:
        known = np.isfinite(plain[name])
        assert np.all(tight[name][known] <= 1.01 * plain[name][known])


def test_a_tight_bound_is_no_larger_where_a_table_steps_at_dead_centres():
    s = shipped("yoke_pump").variants["pumping"].scene.solve(np.pi / 4 * np.arange(8))
    for name in ("O", "A", "guide"):
        assert np.all(s.error_bound(name, tight=True) <= MORE * s.error_bound(name))


def test_where_no_errors_cancel_the_tight_bound_is_that_of_running_error_analysis():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    forward, tight = found(graph, (graph.angle() + one) * other / (one + 0.3), 1.0, 0.7, 0.9)
    assert tight == pytest.approx(forward, rel=1e-12, abs=0.0)


def test_what_is_exactly_zero_has_no_tight_bound_but_zero_by_numpy():
    graph = Graph()
    one = graph.parameter(0)
    recording = SimpleNamespace(graph=graph, inputs={})
    program = Program(recording, (one * one * graph.angle(),)).bounded(tight=True)
    found = program.by_numpy(np.zeros(3), [1.7], [], (3,))
    assert found.tolist() == [[0.0] * 3] * 2


@every(
    "case, variant",
    [("sawframe_2r63", "plain"), ("sawframe_2r63", "cam-cosine"), ("chain_unit", "rho-0.5"), ("toggle_press", "idle")],
)
def test_tight_bounds_take_at_most_eight_times_the_operations_of_values(case, variant):
    s = shipped(case).variants[variant].scene.solve(4)
    program, _ = program_of(s.dynamics, ("balancing_torque",))
    assert operations(program.bounded(tight=True).outputs) <= 8.0 * operations(program.outputs)


def test_numpy_tells_where_a_product_is_too_small_for_a_double():
    for count in range(1, 70):
        values = np.full((count, 2), 1e-200)
        for part in (values[:, 0], values[:, 0].copy()):
            with pytest.raises(FloatingPointError), np.errstate(all="ignore", under="raise"):
                np.multiply(part, part, out=np.empty(count))
            with pytest.raises(FloatingPointError), np.errstate(all="ignore", under="raise"):
                np.divide(part, 1e200, out=np.empty(count))


def test_bounds_of_arrays_with_values_too_small_for_a_double_are_those_of_plain_numbers():
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1e-300))
    angles = np.linspace(0.3, 6.0, 30)
    many, alone = (ks.Scene(pump, 1e-9).solve(part).dynamics for part in (angles, angles[:1]))
    bound = [NUMPY.with_bounds(state, ("balancing_torque",))[1]["balancing_torque"] for state in (many, alone)]
    assert np.all(bound[0] > 0.0)
    assert bound[0][0] == bound[1][0]

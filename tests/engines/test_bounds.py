"""Bounds on rounding errors: never less than the true error, and not much more."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import ConditionWarning
from kinetostatics.engines import programs
from kinetostatics.engines.error_bounds import ErrorBounds, tight_bounds
from kinetostatics.engines.trace import Graph
from kinetostatics.numbers.elementary import UNIT, rest, total
from kinetostatics.studies.methods.enclosures import enclosure
from support import bounded as bounded_machines
from support.bounded import FAMILIES, errors, over_worst, solution
from support.every import every

FINE_TURN = np.linspace(0.0, 2 * np.pi, 180, endpoint=False) + 0.01
"""Angles enough for the worst error of a turn."""
TURN = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)


def bounded(scene, quantity, angles=TURN):
    s = scene.solve(angles)
    return s, s.error_bound(quantity)


@every("family", FAMILIES)
def test_no_value_of_random_machines_is_off_by_more_than_its_bound(flint, family):
    made = next(found for found in (solution(family, seed) for seed in range(9)) if found is not None)
    found = errors(made, ("balancing_torque", *made.reactions, "crank_angular_acceleration", "kinetic_energy"))
    assert found.values > 10
    assert found.wrong == []


@every("case, variant, most", over_worst("double"))
def test_bounds_are_not_much_more_than_the_worst_error_of_a_turn(flint, case, variant, most):
    scene = ks.load_case(case).variants[variant].scene
    s, bound = bounded(scene, "balancing_torque", FINE_TURN)
    exact = enclosure(s, "balancing_torque").exact[0]
    error = np.array([abs(float(truth - float(value))) for truth, value in zip(exact, s.balancing_torque, strict=True)])
    assert np.all(error <= bound)
    assert np.max(bound) < most * np.max(error)
    tight = s.error_bound("balancing_torque", tight=True)
    assert np.all(error <= tight)
    assert np.all(tight <= bound * 1.01)  # its remainder is of stretched bounds, which are a little larger
    assert np.median(tight / bound) < 1.0


def bounds_of(graph, outputs, values, tight=False):
    """Bounds of outputs at some values of the parameters of a graph."""
    found = tight_bounds(graph, {}, outputs) if tight else ErrorBounds(graph).of(outputs)
    return programs.Program(None, found)._by_numbers(np.zeros(1), values, (1,))[:, 0]


def test_sums_products_quotients_and_roots_of_plain_numbers_are_bounded_as_by_hand():
    graph = Graph()
    one, two = graph.parameter(0), graph.parameter(1)
    outputs = one + two, one * two, one / two, (one * one).sqrt(), (one + two) * one
    values = bounds_of(graph, outputs, [3.0, 0.7])
    wanted = [3.7 * UNIT, 2.1 * UNIT, 3.0 / 0.7 * UNIT, 1.5 * 3.0 * UNIT, 2 * 3.7 * 3.0 * UNIT]
    np.testing.assert_allclose(values, wanted, rtol=1e-8)


@every("tight", [False, True])
def test_a_sign_is_no_rounding_of_what_it_multiplies(tight):
    graph = Graph()
    one, two = graph.parameter(0), graph.parameter(1)
    (bound,) = bounds_of(graph, [one.sign() * (one * two)], [-3.0, 0.7], tight)
    assert bound == pytest.approx(2.1 * UNIT, rel=1e-8)


def test_where_a_divisor_may_vanish_or_a_root_be_clamped_there_is_no_bound():
    folded = ks.crank_slider(0.5, 0.5, guide_angle=1.0, coupler=ks.Link(1.0), slider=ks.Link(1.0))
    with pytest.warns(ConditionWarning):
        s = ks.solve(folded, [1.3, 1.0 + np.pi / 2], crank_speed=1.0, on_gap="nan")
    found = s.error_bound("B")
    assert np.isfinite(found[:, 0]).all()
    assert not np.isfinite(found[:, 1]).any()


def test_a_root_of_what_is_proven_to_be_negative_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    square = one * one - other * other
    (bound,) = bounds_of(graph, [square.forgiving_root(unit)], [1.0, 1.0 + 6 * UNIT, 2.0])
    assert not np.isfinite(bound)


def test_a_root_of_what_is_negative_for_sure_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    roots = [(one * other).forgiving_root(unit), (other * other).forgiving_root(unit)]
    negative, positive = bounds_of(graph, roots, [1e-20, -1.0, 2.0])
    assert np.isnan(negative)
    assert positive > 0.0


def test_a_product_with_a_reciprocal_is_bounded_as_the_quotient():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    below = one + other - 1.9999
    outputs = one * (1.0 / below), one / below
    product, quotient = bounds_of(graph, outputs, [1.0, 1.0])
    assert quotient < product < 1.001 * quotient  # one rounding more
    huge = 1.0 / (1e30 * one * 1e30) / 1e250  # loses digits as too small for a double
    (bound,) = bounds_of(graph, [huge * other], [1.0, 1.0])
    assert bound >= 5e-324


def test_rows_of_tables_may_be_of_any_size():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    found = ErrorBounds(graph).of([one * other * graph.row(0)])
    (bound,) = programs.Program(None, found)._plain(0.0, 0.0, 1.0, [1e-170, 1e-170], [1e200])
    assert bound >= 1e-140  # computed 0


def test_products_with_the_number_zero_count_for_nothing():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    rounded = one + other
    (bound,) = bounds_of(graph, [one * other + 0.0 * rounded], [3.0, 0.7])
    assert bound == pytest.approx(2.1 * UNIT, rel=1e-8, abs=0.0)


def test_a_bound_that_is_too_small_is_found(flint, monkeypatch):
    made = next(found for found in (solution("four-bar", seed) for seed in range(9)) if found is not None)
    values, proven = bounded_machines.NUMPY.with_bounds(made.dynamics, ("O",))
    too_small = SimpleNamespace(with_bounds=lambda *given: (values, {"O": 1e-4 * proven["O"]}))
    monkeypatch.setitem(bounded_machines.ENGINES, "numpy", too_small)
    assert errors(made, ("O",)).wrong


@every("tight", [False, True])
def test_what_a_factor_of_two_loses_of_the_smallest_numbers_is_bounded(tight):
    graph = Graph()
    tiny, divisor = map(graph.parameter, range(2))
    found = bounds_of(graph, [0.5 * tiny, 0.5 * tiny / divisor], [5e-324, 1e-29], tight)
    assert found[0] >= 2.5e-324
    assert found[1] >= 2.5e-324 / 1e-29


@every("tight", [False, True])
def test_a_product_of_two_numbers_lost_as_too_small_is_bounded(tight):
    graph = Graph()
    one, other, huge = map(graph.parameter, range(3))
    for scaled in (lambda square: square * (huge * huge), lambda square: square * huge * huge):
        lost = [scaled(part * part).forgiving_root(huge) for part in (one, other)]  # 0, and truly 1e-140
        found = bounds_of(graph, [lost[0] * lost[1], lost[0] + lost[1]], [1e-170, 1e-170, 1e30], tight)
        assert not np.any(found < [1e-280, 2e-140])  # a tight one may be none
        assert np.isfinite(found[1])


def test_a_tight_bound_takes_the_error_of_what_derivatives_hold():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    outputs = [(one + other).held() * one, (one + other) * one]
    held, free = bounds_of(graph, outputs, [3.0, 0.7], tight=True)
    assert held == pytest.approx(free, rel=1e-8, abs=0.0)


def test_numbers_beyond_the_cap_have_no_bound():
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1e31))
    assert np.isinf(ks.solve(pump, TURN, crank_speed=1.0).error_bound("balancing_torque")).all()


def test_what_is_too_small_for_a_double_is_bounded_too():
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1e-300))
    s, bound = bounded(ks.Scene(pump, 1e-9), "balancing_torque", [1.0])
    assert s.balancing_torque[0] == pytest.approx(0.0, abs=1e-300)
    assert 0.0 < bound[0] < 1e-270


def test_bounds_on_the_steep_flank_of_a_table_are_not_much_more_than_its_worst_error(flint):
    scene = ks.load_case("shaper").variants["cutting"].scene
    made = scene.solve(np.radians(np.linspace(177.3, 178.3, 60)))
    (worst, most), (_, tightest) = (_worst(made, "O2", tight) for tight in (False, True))
    assert most < 150 * worst
    assert tightest < 20 * worst


def _worst(solution, quantity, tight):
    """Largest error and largest bound of a vector."""
    pairs = zip(enclosure(solution, quantity).exact, solution.reaction(quantity), strict=True)
    found = [[float(truth - float(own)) for truth, own in zip(*pair, strict=True)] for pair in pairs]
    return np.max(np.hypot(*found)), np.max(np.hypot(*solution.error_bound(quantity, tight)))


def test_a_total_of_given_numbers_is_bounded_by_one_rounding_of_itself():
    graph = Graph()
    parts = [graph.parameter(place) for place in range(4)]
    values = [0.3, 0.6000000000000001, -0.4, -0.5000000000000001]
    whole = math.fsum(values)
    bound, carried = bounds_of(graph, (total(*parts), total(parts[0] * parts[1], parts[2], parts[3])), values)
    assert 1e-17 < abs(whole) < 1e-16
    assert abs(whole) * UNIT <= bound < 1.001 * abs(whole) * UNIT
    assert carried == pytest.approx(0.18 * UNIT + abs(0.18 - 0.9) * UNIT, rel=1e-8)


def test_a_length_and_its_rest_are_bounded_together_where_they_are_taken_so():
    graph = Graph()
    x, y, other = map(graph.parameter, range(3))
    length = (x * x + y * y).sqrt()
    lost = rest(length, x, y)
    sums = (
        total(length, -other, lost),
        total(other, -length, -lost),
        total(length, -other),
        total(length, -other, -lost),
    )
    values = [0.3, 0.4, 0.5]
    ahead, back, alone, against = bounds_of(graph, sums, values)
    (off,) = bounds_of(graph, [lost], values)
    exact = abs(rest(math.hypot(0.3, 0.4), 0.3, 0.4))
    assert exact < 0.5 * UNIT
    assert ahead == back < 1.001 * exact * UNIT + 5.0 * UNIT * UNIT
    assert 0.5 * UNIT < alone < 2.0 * UNIT
    assert against > alone
    assert off == pytest.approx(exact, rel=1e-8)


def test_parts_of_a_length_that_are_rounded_count_in_its_rest():
    graph = Graph()
    x, y, other = map(graph.parameter, range(3))
    rounded = x * y
    length = (rounded * rounded + y * y).sqrt()
    (bound,) = bounds_of(graph, [total(length, -other, rest(length, rounded, y))], [3.0, 0.1, 0.3])
    assert bound > 0.3 * UNIT

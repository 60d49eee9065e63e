"""Bounds that are computed along: never less than the true error, and cheap beside the values."""

from fractions import Fraction

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import programs
from kinetostatics.engines.error_bounds import OWN, ErrorBounds, tight_bounds
from kinetostatics.engines.lean import LeanGraph
from kinetostatics.engines.trace import Graph
from kinetostatics.numbers.elementary import UNIT, UNSEEN, apart, rest, sign, total
from support.every import every
from support.graphs import COMPILED, WAYS, Case
from support.shipped import shipped


def bounds_of(graph, outputs, values, angle=0.0):
    found = ErrorBounds(graph).of(outputs)
    return programs.Program(None, found)._by_numbers(np.array([angle]), values, (1,))[:, 0]


def test_sums_products_quotients_and_roots_of_plain_numbers_are_bounded_as_by_hand():
    graph = Graph()
    one, two = graph.parameter(0), graph.parameter(1)
    outputs = one + two, one * two, one / two, (one * one).sqrt(), (one + two) * one
    values = bounds_of(graph, outputs, [3.0, 0.7])
    wanted = [3.7 * UNIT, 2.1 * UNIT, 3.0 / 0.7 * UNIT, 1.5 * 3.0 * UNIT, 2 * 3.7 * 3.0 * UNIT]
    np.testing.assert_allclose(values, wanted, rtol=1e-8)


@every("digits, finite", [(30, True), (46, True), (52, True), (60, False)])
def test_what_is_divided_by_a_sum_is_bounded_as_long_as_that_is_known(digits, finite):
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    quotient = graph.angle().cos() / (one * one - other * other)
    (bound,) = bounds_of(graph, [quotient], [1.0, 1.0 + 2.0**-digits])
    assert np.isfinite(bound) == finite


@every("form", [lambda root, kept: root / kept, lambda root, kept: root * (1.0 / kept), lambda root, kept: kept / root])
def test_a_root_over_itself_kept_off_zero_has_no_bound_where_that_acts(form):
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    root = (graph.angle().cos() * one - other).forgiving_root(unit)
    share = form(root, root.kept_off_zero(unit))
    (known,), (acting,) = (bounds_of(graph, [share], [1.0, 1.0 - rest, 1e-3]) for rest in (0.5, 2.0**-40))
    assert known < 12.0 * UNIT
    assert not np.isfinite(acting)


@every("form", [lambda root: root / root, lambda root: root * (1.0 / root)])
@every("graph", [Graph, LeanGraph])
def test_a_root_that_may_be_none_leaves_no_bound_though_it_cancels(graph, form):
    recorded = graph()
    one, other, unit = map(recorded.parameter, range(3))
    share = form((recorded.angle().cos() * one - other).forgiving_root(unit))
    known, doubtful = (bounds_of(recorded, [share], [1.0, 1.0 - rest, 1e-3]) for rest in (0.5, UNIT))
    assert known < 20.0 * UNIT
    assert not np.isfinite(doubtful)


@every("unit", [1e-150, 1e-297, 1e-300, 1e-305, 5e-324])
def test_a_guard_that_acts_leaves_no_bound_but_one_as_large_however_small_it_is(unit):
    graph = Graph()
    one, small = map(graph.parameter, range(2))
    part = one * graph.angle()
    outputs = part.kept_off_zero(small), part / part.kept_off_zero(small)
    inside = 1.0 - 2.0**-10
    kept, share = bounds_of(graph, outputs, [inside * unit, unit], angle=1.0)
    assert not kept < unit - inside * unit
    assert not share < 1.0 - inside


def test_a_quotient_by_what_a_guard_makes_larger_elsewhere_keeps_its_own_bound():
    graph = Graph()
    other, unit = map(graph.parameter, range(2))
    sine = graph.angle().sin()
    outputs = other / sine.kept_off_zero(unit), 1.0 / sine.kept_off_zero(unit), (sine + other) / sine
    bounds = bounds_of(graph, outputs, [0.3, 1e8], angle=1e-3)
    assert bounds[-1] >= UNIT * 0.3e3


def test_a_design_s_number_that_a_rounding_makes_too_small_still_counts():
    graph = Graph()
    tiny, small = map(graph.parameter, range(2))
    product = (graph.angle().cos() / small) * tiny
    found = *ErrorBounds(graph).of([product]), *tight_bounds(graph, {}, [product])
    bounds = programs.Program(None, found)._by_numbers(np.array([1.0]), [5e-324, 4.1e-193], (1,))[:, 0]
    assert np.all(bounds >= UNIT * (5e-324 / 4.1e-193) * np.cos(1.0))


@every("function", [lambda part: part.arctan(), sign])
def test_a_function_of_what_is_too_large_for_a_double_has_a_bound_that_is_one(function):
    graph = Graph()
    huge, other = map(graph.parameter, range(2))
    part = graph.angle() * huge + other
    (bound,) = bounds_of(graph, [function(part * part)], [1e160, 1.0], angle=1.0)
    assert not bound < 0.0


@every("power", [1, 3, 12, 20])
def test_errors_of_pivots_make_others_larger_that_they_multiply(power):
    """A difference that is lost has an error of 1e-16, and what divides it one of a hundredth each time."""
    graph = Graph()
    one, other, tiny = map(graph.parameter, range(3))
    over = 1.0 / (one * one - other * other)
    product = (graph.angle().cos() * one + tiny) - one  # computed 0, truly tiny
    for _ in range(power):
        product = product * over
    values = [1.0, 1.0 + 2.0**-47, 2.0**-54]
    (bound,) = bounds_of(graph, [product], values)
    one, other, tiny = map(Fraction, values)
    assert Fraction(bound) >= abs(tiny / (one * one - other * other) ** power)


def test_a_root_of_what_is_or_may_be_negative_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    product = (one * other).forgiving_root(unit)
    difference = (one * one - other * other).forgiving_root(unit)
    assert not np.isfinite(bounds_of(graph, [product], [1e-20, -1.0, 2.0])).any()
    assert not np.isfinite(bounds_of(graph, [difference], [1.0, 1.0 + 6 * UNIT, 2.0])).any()
    assert np.isfinite(bounds_of(graph, [difference, 1.0 / difference], [1.0, 0.9, 2.0])).all()


def test_where_the_guard_of_a_divisor_acts_there_is_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    guarded = 1.0 / (one * one - other * other).sqrt().kept_off_zero(unit)
    clear, acting = (bounds_of(graph, [guarded], [1.0, 0.5, unit])[0] for unit in (1e-8, 0.9))
    assert np.isfinite(clear)
    assert not np.isfinite(acting)


def test_a_product_of_two_differences_that_are_lost_is_bounded_in_second_order():
    graph = Graph()
    one, tiny = map(graph.parameter, range(2))
    lost = [(part + tiny) - part for part in (one, 2.0 * one)]  # computed 0, truly 2^-54
    (bound,) = bounds_of(graph, [lost[0] * lost[1]], [1.0, 2.0**-54])
    assert bound >= 2.0**-108


def test_what_is_lost_as_too_small_is_bounded_beside_a_sum_that_is_zero():
    graph = Graph()
    one, other, huge = map(graph.parameter, range(3))
    zero = graph.angle().sin() - graph.angle().sin() * 3.0
    (bound,) = bounds_of(graph, [(zero + one * other) * huge], [1e-170, 1e-170, 1e30])
    assert bound >= 1e-310


def test_a_total_of_given_numbers_is_bounded_by_few_roundings_of_itself():
    graph = Graph()
    parts = [graph.parameter(place) for place in range(4)]
    values = [0.3, 0.6000000000000001, -0.4, -0.5000000000000001]
    (bound,) = bounds_of(graph, [total(*parts) * parts[0]], values)
    assert bound < 1e-31


def test_a_length_and_its_rest_leave_few_roundings_of_what_a_design_is_off_another():
    graph = Graph()
    x, y, other = (graph.parameter(place) for place in range(3))
    length = (x * x + y * y).sqrt()
    off = total(length, rest(length, x, y), -other)
    (bound,) = bounds_of(graph, [off * graph.angle().sin()], [0.21, 0.81, 0.83], angle=1.0)
    assert bound < 8 * UNIT * (0.83679 - 0.83)


def test_a_length_of_the_angle_and_its_rest_are_bounded_to_their_last_bits():
    graph = Graph()
    x, y = graph.parameter(0), graph.angle()
    length = (x * x + y * y).sqrt()
    (bound,) = bounds_of(graph, [total(length, rest(length, x, y))], [0.21], angle=0.81)
    assert 0.5 * UNIT * 0.83 < bound < 12 * UNIT * 0.84


def test_what_is_turned_by_the_sign_of_a_clear_sum_keeps_its_error():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    turning = graph.angle().sin() * one - other
    (bound,) = bounds_of(graph, [sign(turning) * one], [3.0, 0.5], angle=1.0)
    assert bound < 1e-9 * UNIT


def test_a_quotient_by_one_and_a_magnitude_is_bounded_by_the_slope_at_its_value():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    cosine = graph.angle().cos() * one - other
    (bound, alone) = bounds_of(graph, [one / (1.0 + abs(cosine)), cosine], [100.0, 50.0])
    assert bound < 1.2 * (100.0 / 51.0**2 * (alone + 51.0 * UNIT) + 100.0 / 51.0 * UNIT)


def test_a_product_with_what_is_moved_off_zero_is_off_by_all_of_it():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    product = apart(one, UNSEEN) * other
    for dust in (OWN.dust, None):
        (bound,) = ErrorBounds(graph, arithmetic=OWN._replace(dust=dust)).of([product])
        values = programs.Program(None, (product, bound))._plain(0.0, 0.0, 1.0, [0.0, 3.0], ())
        assert values[1] >= values[0] > 0.0


def test_a_bound_does_not_hang_on_what_else_is_asked_for():
    s = ks.load_case("sawframe_2r63").variants["cam-cosine"].scene.solve(np.linspace(0.1, 6.0, 5))
    alone, together = (
        programs.of(s.dynamics, names)[0].bounded().run(s.dynamics, s.dynamics.apart[1])
        for names in (("O",), ("slider_velocity", "B", "O"))
    )
    np.testing.assert_allclose(alone[2:], together[-2:], rtol=1e-12)


@every(
    "case, variant",
    [("sawframe_2r63", "plain"), ("sawframe_2r63", "cam-cosine"), ("chain_unit", "rho-0.5"), ("mower_drive", "full")],
)
def test_values_with_bounds_take_few_times_the_operations(case, variant):
    s = shipped(case).variants[variant].scene.solve(4)
    program, _ = programs.of(s.dynamics, ("balancing_torque",))
    assert programs.operations(program.bounded().outputs) <= 4.1 * programs.operations(program.outputs)


@every("case, variant", [("chain_unit", "rho-0.5"), ("toggle_press", "idle")])
def test_values_with_bounds_are_those_alone_to_the_last_bit(case, variant):
    s = shipped(case).variants[variant].scene.solve(np.linspace(0.0, 6.0, 20))
    program, leaves = programs.of(s.dynamics, ("balancing_torque", *s.reactions))
    alone = program.run(s.dynamics, leaves)
    np.testing.assert_array_equal(program.bounded().run(s.dynamics, leaves)[: len(alone)], alone)


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_a_fold_leaves_a_bound_though_the_crank_angle_is_a_rounding_from_it():
    """A design's number beside the sine may be a rounding itself, as is a component of gravity, and tells no size."""
    link = ks.Link(2.0, 0.05, 0.01)
    folding = ks.crank_slider(0.3, 0.3, coupler=link, slider=link, assembly="open")
    s = ks.solve(folding, [np.pi / 2], crank_speed=7.0, loads=ks.Gravity())
    assert np.max(s.error_bound("B")) < 1e-12


@every("other", [lambda turning, two: two * turning, lambda turning, two: two * (turning * turning).sqrt()])
def test_a_sum_of_what_vanishes_with_what_turns_is_known_where_it_does(other):
    graph = Graph()
    one, two = map(graph.parameter, range(2))
    turning = graph.angle().sin()
    (bound,) = bounds_of(graph, [one * turning - other(turning, two)], [0.3, 0.1], angle=1e-9)
    assert bound < 8.0 * UNIT * 1e-9


def test_where_the_square_of_a_root_is_too_large_for_a_double_there_is_no_bound():
    """One over the root is computed 0, and truly 5.8e-155."""
    graph = Graph()
    one, tiny, huge = map(graph.parameter, range(3))
    part = one / tiny / tiny / tiny * graph.angle()
    share = huge / (part + part * 1.0000001).sqrt()
    found = share, *ErrorBounds(graph).of([share]), *tight_bounds(graph, {}, [share])
    line = programs.Program(None, found)._by_numbers
    value, *bounds = line(np.array([1.0]), [1.2e30, 2.0e-93, 1e30], (1,))[:, 0]
    assert value == 0.0
    assert not np.isfinite(bounds).any()
    assert np.isfinite(line(np.array([1.0]), [1.2e30, 3.0e-92, 1e30], (1,))).all()


@every("first", [lambda one, angle: one, lambda one, angle: angle])
def test_what_a_root_lost_counts_times_what_a_sum_lost_that_is_zero(first):
    graph = Graph()
    one, tiny, small, huge = map(graph.parameter, range(4))
    angle = graph.angle()
    zero = (first(one, angle) + tiny) - one  # computed 0, truly 2^-60
    root = (small * small * (angle.sin() * angle.sin())).sqrt()  # computed 0, truly 8.4e-171
    product = zero * root * huge
    found = *ErrorBounds(graph).of([product]), *tight_bounds(graph, {}, [product])
    values = [1.0, 2.0**-60, 1e-170, 1e30]
    bounds = programs.Program(None, found)._by_numbers(np.array([1.0]), values, (1,))[:, 0]
    assert np.all(bounds >= 2.0**-60 * 1e-170 * 1e30 * np.sin(1.0))


@every("function", ["sin", "arctan"])
def test_a_function_of_the_smallest_numbers_is_not_told_to_be_exact(function):
    graph = Graph()
    one = graph.parameter(0)
    (bound,) = bounds_of(graph, [getattr(one, function)()], [5e-324])
    assert bound > 0.0


def test_a_reciprocal_of_a_tiny_number_is_none_to_tell_a_pivot_by():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    part = graph.angle() * one * one * one
    below = part - other
    outputs = 1e-250 / below, 1e-30 / below
    (_, bound) = bounds_of(graph, outputs, [2.0**90, 2.0**90], angle=1.0)
    assert bound >= 3.5 * UNIT * 1e-30 / 2.0**270


def test_no_random_graph_of_extreme_numbers_is_off_by_more_than_its_bounds(flint):
    """Every operation, zeros, numbers of every size; many thousands: ``Case(seed).wrong`` of more seeds."""
    assert [wrong for seed in range(60) for wrong in Case(seed).wrong(WAYS)] == []


def test_no_random_graph_is_off_by_more_than_its_bounds_compiled(flint, numba):
    assert [wrong for seed in range(2) for wrong in Case(seed).wrong(COMPILED)] == []


def test_an_output_that_is_a_plain_number_is_exact():
    assert ErrorBounds(Graph()).of([0.0]) == (0.0,)


@every("case, variant", [("sawframe_2r63", "cam-cosine"), ("chain_unit", "rho-0.5"), ("shaper", "cutting")])
def test_nothing_is_too_small_in_ordinary_machines_so_that_numpy_takes_the_shorter_bounds(case, variant):
    """Where anything were, all would be computed again with what may be lost."""
    s = shipped(case).variants[variant].scene.solve(np.linspace(0.0, 6.0, 30))
    program, leaves = programs.of(s.dynamics, (*s.reactions, "balancing_torque"))
    bounded = program.bounded()
    assert np.array_equal(bounded.run(s.dynamics, leaves), bounded._without_dust.run(s.dynamics, leaves))

"""Bounds on rounding errors: never less than the true error, not much more, and cheap beside the values."""

import math
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics import ConditionWarning
from kinetostatics.engines import numba_backend
from kinetostatics.engines.error_bounds import (
    OWN,
    Error,
    ErrorBounds,
    of_magnitude,
    tight_bounds,
    where_known,
)
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.numba_backend import numba_available
from kinetostatics.engines.program import Program, operations, program_of
from kinetostatics.engines.simplify import SimplifiedGraph
from kinetostatics.numbers.arithmetic import (
    NEGLIGIBLE_LENGTH,
    RELATIVE_OFFSET,
    UNIT_ROUNDOFF,
    compensated_sum,
    length_error,
    offset_from_zero,
    sign,
)
from kinetostatics.studies.methods.high_precision.enclosures import enclosure
from support import bounded as bounded_machines
from support.bounded import FAMILIES, errors, over_worst, solution
from support.case_files import shipped
from support.every import every
from support.graphs import COMPILED, WAYS, Case

FINE_TURN = np.linspace(0.0, 2 * np.pi, 180, endpoint=False) + 0.01
"""Angles enough for the worst error of a turn."""
TURN = np.linspace(0.0, 2 * np.pi, 90, endpoint=False)


def bounded(scene, quantity, angles=TURN):
    s = scene.solve(angles)
    return s, s.error_bound(quantity)


@pytest.mark.slow
@every("family", FAMILIES)
def test_values_of_random_machines_lie_within_bounds(flint, family):
    made = next(found for found in (solution(family, seed) for seed in range(9)) if found is not None)
    found = errors(made, ("balancing_torque", *made.reactions, "crank_angular_acceleration", "kinetic_energy"))
    assert found.values > 10
    assert found.wrong == []


@pytest.mark.slow
@every("case, variant, most", over_worst("double"))
def test_bounds_stay_near_the_worst_error_of_a_turn(flint, case, variant, most):
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


def bounds_of(graph, outputs, values, tight=False, angle=0.0):
    """Bounds of outputs at some values of the parameters of a graph, and a crank angle."""
    found = tight_bounds(graph, {}, outputs) if tight else ErrorBounds(graph).of(outputs)
    return Program(None, found)._by_numbers(np.array([angle]), values, (1,))[:, 0]


def test_operations_on_numbers_are_bounded_as_by_hand():
    graph = Graph()
    one, two = graph.parameter(0), graph.parameter(1)
    outputs = one + two, one * two, one / two, (one * one).sqrt(), (one + two) * one
    values = bounds_of(graph, outputs, [3.0, 0.7])
    wanted = [
        3.7 * UNIT_ROUNDOFF,
        2.1 * UNIT_ROUNDOFF,
        3.0 / 0.7 * UNIT_ROUNDOFF,
        1.5 * 3.0 * UNIT_ROUNDOFF,
        2 * 3.7 * 3.0 * UNIT_ROUNDOFF,
    ]
    np.testing.assert_allclose(values, wanted, rtol=1e-8)


@every("tight", [False, True])
def test_a_sign_is_no_rounding_of_what_it_multiplies(tight):
    graph = Graph()
    one, two = graph.parameter(0), graph.parameter(1)
    (bound,) = bounds_of(graph, [one.sign() * (one * two)], [-3.0, 0.7], tight)
    assert bound == pytest.approx(2.1 * UNIT_ROUNDOFF, rel=1e-8)


def test_no_bound_at_zero_divisors_and_clamped_roots():
    folded = ks.crank_slider(0.5, 0.5, guide_angle=1.0, coupler=ks.Link(1.0), slider=ks.Link(1.0))
    with pytest.warns(ConditionWarning):
        s = ks.solve(folded, [1.3, 1.0 + np.pi / 2], crank_speed=1.0, on_gap="nan")
    found = s.error_bound("B")
    assert np.isfinite(found[:, 0]).all()
    assert not np.isfinite(found[:, 1]).any()


def test_a_root_of_a_provably_negative_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    square = one * one - other * other
    (bound,) = bounds_of(graph, [square.forgiving_root(unit)], [1.0, 1.0 + 6 * UNIT_ROUNDOFF, 2.0])
    assert not np.isfinite(bound)


def test_a_root_of_a_certain_negative_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    roots = [(one * other).forgiving_root(unit), (other * other).forgiving_root(unit)]
    negative, positive = bounds_of(graph, roots, [1e-20, -1.0, 2.0])
    assert np.isnan(negative)
    assert positive > 0.0


def test_a_reciprocal_product_is_bounded_as_a_quotient():
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
    (bound,) = Program(None, found)._plain(0.0, 0.0, 1.0, [1e-170, 1e-170], [1e200])
    assert bound >= 1e-140  # computed 0


def test_products_with_zero_add_no_error():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    rounded = one + other
    (bound,) = bounds_of(graph, [one * other + 0.0 * rounded], [3.0, 0.7])
    assert bound == pytest.approx(2.1 * UNIT_ROUNDOFF, rel=1e-8, abs=0.0)


def test_a_bound_that_is_too_small_is_found(flint, monkeypatch):
    made = next(found for found in (solution("four-bar", seed) for seed in range(9)) if found is not None)
    values, proven = bounded_machines.NUMPY.with_bounds(made.dynamics, ("O",))
    too_small = SimpleNamespace(with_bounds=lambda *given: (values, {"O": 1e-4 * proven["O"]}))
    monkeypatch.setitem(bounded_machines.ENGINES, "numpy", too_small)
    assert errors(made, ("O",)).wrong


@every("tight", [False, True])
def test_halving_a_subnormal_is_bounded(tight):
    graph = Graph()
    tiny, divisor = map(graph.parameter, range(2))
    found = bounds_of(graph, [0.5 * tiny, 0.5 * tiny / divisor], [5e-324, 1e-29], tight)
    assert found[0] >= 2.5e-324
    assert found[1] >= 2.5e-324 / 1e-29


@every("tight", [False, True])
def test_a_product_that_underflows_is_bounded(tight):
    graph = Graph()
    one, other, huge = map(graph.parameter, range(3))
    for scaled in (lambda square: square * (huge * huge), lambda square: square * huge * huge):
        lost = [scaled(part * part).forgiving_root(huge) for part in (one, other)]  # 0, and truly 1e-140
        found = bounds_of(graph, [lost[0] * lost[1], lost[0] + lost[1]], [1e-170, 1e-170, 1e30], tight)
        assert not np.any(found < [1e-280, 2e-140])  # a tight one may be none
        assert np.isfinite(found[1])


def test_tight_bounds_include_errors_of_stop_gradient():
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


def test_bounds_on_steep_tables_stay_near_the_error(flint):
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


def test_a_sum_of_inputs_is_bounded_by_one_rounding():
    graph = Graph()
    parts = [graph.parameter(place) for place in range(4)]
    values = [0.3, 0.6000000000000001, -0.4, -0.5000000000000001]
    whole = math.fsum(values)
    bound, carried = bounds_of(
        graph, (compensated_sum(*parts), compensated_sum(parts[0] * parts[1], parts[2], parts[3])), values
    )
    assert 1e-17 < abs(whole) < 1e-16
    assert abs(whole) * UNIT_ROUNDOFF <= bound < 1.001 * abs(whole) * UNIT_ROUNDOFF
    assert carried == pytest.approx(0.18 * UNIT_ROUNDOFF + abs(0.18 - 0.9) * UNIT_ROUNDOFF, rel=1e-8)


def test_a_length_and_its_rest_are_bounded_together():
    graph = Graph()
    x, y, other = map(graph.parameter, range(3))
    length = (x * x + y * y).sqrt()
    lost = length_error(length, x, y)
    sums = (
        compensated_sum(length, -other, lost),
        compensated_sum(other, -length, -lost),
        compensated_sum(length, -other),
        compensated_sum(length, -other, -lost),
    )
    values = [0.3, 0.4, 0.5]
    ahead, back, alone, against = bounds_of(graph, sums, values)
    (off,) = bounds_of(graph, [lost], values)
    exact = abs(length_error(math.hypot(0.3, 0.4), 0.3, 0.4))
    assert exact < 0.5 * UNIT_ROUNDOFF
    assert ahead == back < 1.001 * exact * UNIT_ROUNDOFF + 5.0 * UNIT_ROUNDOFF * UNIT_ROUNDOFF
    assert 0.5 * UNIT_ROUNDOFF < alone < 2.0 * UNIT_ROUNDOFF
    assert against > alone
    assert off == pytest.approx(exact, rel=1e-8)


def test_rounded_parts_of_a_length_count_in_its_rest():
    graph = Graph()
    x, y, other = map(graph.parameter, range(3))
    rounded = x * y
    length = (rounded * rounded + y * y).sqrt()
    (bound,) = bounds_of(graph, [compensated_sum(length, -other, length_error(length, rounded, y))], [3.0, 0.1, 0.3])
    assert bound > 0.3 * UNIT_ROUNDOFF


@every("digits, finite", [(30, True), (46, True), (52, True), (60, False)])
def test_a_quotient_by_a_sum_is_bounded_while_known(digits, finite):
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    quotient = graph.angle().cos() / (one * one - other * other)
    (bound,) = bounds_of(graph, [quotient], [1.0, 1.0 + 2.0**-digits])
    assert np.isfinite(bound) == finite


@every("form", [lambda root, kept: root / kept, lambda root, kept: root * (1.0 / kept), lambda root, kept: kept / root])
def test_a_guard_that_acts_is_an_error(form):
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    root = (graph.angle().cos() * one - other).forgiving_root(unit)
    share = form(root, root.kept_off_zero(unit))
    (known,), (acting,) = (bounds_of(graph, [share], [1.0, 1.0 - rest, 1e-3]) for rest in (0.5, 2.0**-40))
    assert known < 12.0 * UNIT_ROUNDOFF
    off = form(2.0**-20, 1e-3) - 1.0
    assert not acting < abs(off)


@every("form", [lambda root: root / root, lambda root: root * (1.0 / root)])
@every("graph", [Graph, SimplifiedGraph])
def test_an_undefined_root_that_cancels_has_no_bound(graph, form):
    recorded = graph()
    one, other, unit = map(recorded.parameter, range(3))
    share = form((recorded.angle().cos() * one - other).forgiving_root(unit))
    known, doubtful = (bounds_of(recorded, [share], [1.0, 1.0 - rest, 1e-3]) for rest in (0.5, UNIT_ROUNDOFF))
    assert known < 20.0 * UNIT_ROUNDOFF
    assert not np.isfinite(doubtful)


@every("unit", [1e-150, 1e-297, 1e-300, 1e-305, 5e-324])
def test_an_active_guard_leaves_only_a_large_bound(unit):
    graph = Graph()
    one, small = map(graph.parameter, range(2))
    part = one * graph.angle()
    outputs = part.kept_off_zero(small), part / part.kept_off_zero(small)
    inside = 1.0 - 2.0**-10
    kept, share = bounds_of(graph, outputs, [inside * unit, unit], angle=1.0)
    assert not kept < unit - inside * unit
    assert not share < 1.0 - inside


def test_an_unguarded_quotient_keeps_its_own_bound():
    graph = Graph()
    other, unit = map(graph.parameter, range(2))
    sine = graph.angle().sin()
    outputs = other / sine.kept_off_zero(unit), 1.0 / sine.kept_off_zero(unit), (sine + other) / sine
    bounds = bounds_of(graph, outputs, [0.3, 1e8], angle=1e-3)
    assert bounds[-1] >= UNIT_ROUNDOFF * 0.3e3


def test_an_input_that_underflows_still_counts():
    graph = Graph()
    tiny, small = map(graph.parameter, range(2))
    product = (graph.angle().cos() / small) * tiny
    found = *ErrorBounds(graph).of([product]), *tight_bounds(graph, {}, [product])
    bounds = Program(None, found)._by_numbers(np.array([1.0]), [5e-324, 4.1e-193], (1,))[:, 0]
    assert np.all(bounds >= UNIT_ROUNDOFF * (5e-324 / 4.1e-193) * np.cos(1.0))


@every("function", [lambda part: part.arctan(), sign])
def test_a_function_of_an_overflow_has_a_finite_bound(function):
    graph = Graph()
    huge, other = map(graph.parameter, range(2))
    part = graph.angle() * huge + other
    (bound,) = bounds_of(graph, [function(part * part)], [1e160, 1.0], angle=1.0)
    assert not bound < 0.0


@every("power", [1, 3, 12, 20])
def test_pivot_errors_enlarge_errors_they_multiply(power):
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


def test_a_root_of_a_possible_negative_has_no_bound():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    product = (one * other).forgiving_root(unit)
    difference = (one * one - other * other).forgiving_root(unit)
    assert not np.isfinite(bounds_of(graph, [product], [1e-20, -1.0, 2.0])).any()
    assert not np.isfinite(bounds_of(graph, [difference], [1.0, 1.0 + 6 * UNIT_ROUNDOFF, 2.0])).any()
    assert np.isfinite(bounds_of(graph, [difference, 1.0 / difference], [1.0, 0.9, 2.0])).all()


def test_a_guarded_divisor_is_off_by_its_guard():
    graph = Graph()
    one, other, unit = map(graph.parameter, range(3))
    guarded = 1.0 / (one * one - other * other).sqrt().kept_off_zero(unit)
    clear, acting = (bounds_of(graph, [guarded], [1.0, 0.5, unit])[0] for unit in (1e-8, 0.9))
    assert clear < 4.0 * UNIT_ROUNDOFF
    assert 1.0 / 0.75**0.5 - 1.0 / 0.9 <= acting < 0.05


def test_a_product_of_lost_differences_is_bounded():
    graph = Graph()
    one, tiny = map(graph.parameter, range(2))
    lost = [(part + tiny) - part for part in (one, 2.0 * one)]  # computed 0, truly 2^-54
    (bound,) = bounds_of(graph, [lost[0] * lost[1]], [1.0, 2.0**-54])
    assert bound >= 2.0**-108


def test_underflow_beside_a_zero_sum_is_bounded():
    graph = Graph()
    one, other, huge = map(graph.parameter, range(3))
    zero = graph.angle().sin() - graph.angle().sin() * 3.0
    (bound,) = bounds_of(graph, [(zero + one * other) * huge], [1e-170, 1e-170, 1e30])
    assert bound >= 1e-310


def test_a_sum_of_inputs_is_bounded_by_few_roundings():
    graph = Graph()
    parts = [graph.parameter(place) for place in range(4)]
    values = [0.3, 0.6000000000000001, -0.4, -0.5000000000000001]
    (bound,) = bounds_of(graph, [compensated_sum(*parts) * parts[0]], values)
    assert bound < 1e-31


def test_designs_near_each_other_lose_few_roundings():
    graph = Graph()
    x, y, other = (graph.parameter(place) for place in range(3))
    length = (x * x + y * y).sqrt()
    off = compensated_sum(length, length_error(length, x, y), -other)
    (bound,) = bounds_of(graph, [off * graph.angle().sin()], [0.21, 0.81, 0.83], angle=1.0)
    assert bound < 8 * UNIT_ROUNDOFF * (0.83679 - 0.83)


def test_a_length_of_the_angle_is_bounded_to_its_bits():
    graph = Graph()
    x, y = graph.parameter(0), graph.angle()
    length = (x * x + y * y).sqrt()
    (bound,) = bounds_of(graph, [compensated_sum(length, length_error(length, x, y))], [0.21], angle=0.81)
    assert 0.5 * UNIT_ROUNDOFF * 0.83 < bound < 12 * UNIT_ROUNDOFF * 0.84


def test_the_sign_of_a_clear_sum_keeps_the_error():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    turning = graph.angle().sin() * one - other
    (bound,) = bounds_of(graph, [sign(turning) * one], [3.0, 0.5], angle=1.0)
    assert bound < 1e-9 * UNIT_ROUNDOFF


def test_one_over_one_plus_magnitude_uses_its_slope():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    cosine = graph.angle().cos() * one - other
    (bound, alone) = bounds_of(graph, [one / (1.0 + abs(cosine)), cosine], [100.0, 50.0])
    assert bound < 1.2 * (100.0 / 51.0**2 * (alone + 51.0 * UNIT_ROUNDOFF) + 100.0 / 51.0 * UNIT_ROUNDOFF)


def test_a_product_with_an_offset_from_zero_counts_all():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    product = offset_from_zero(one, NEGLIGIBLE_LENGTH) * other
    for dust in (OWN.dust, None):
        (bound,) = ErrorBounds(graph, arithmetic=OWN._replace(dust=dust)).of([product])
        values = Program(None, (product, bound))._plain(0.0, 0.0, 1.0, [0.0, 3.0], ())
        assert values[1] >= values[0] > 0.0


def test_a_bound_does_not_depend_on_other_outputs():
    s = ks.load_case("sawframe_2r63").variants["cam-cosine"].scene.solve(np.linspace(0.1, 6.0, 5))
    alone, together = (
        program_of(s.dynamics, names)[0].bounded().run(s.dynamics, s.dynamics.apart[1])
        for names in (("O",), ("slider_velocity", "B", "O"))
    )
    np.testing.assert_allclose(alone[2:], together[-2:], rtol=1e-12)


@every(
    "case, variant",
    [("sawframe_2r63", "plain"), ("sawframe_2r63", "cam-cosine"), ("chain_unit", "rho-0.5"), ("mower_drive", "full")],
)
def test_bounds_take_few_times_the_operations(case, variant):
    s = shipped(case).variants[variant].scene.solve(4)
    program, _ = program_of(s.dynamics, ("balancing_torque",))
    assert operations(program.bounded().outputs) <= 4.1 * operations(program.outputs)


@every("case, variant", [("chain_unit", "rho-0.5"), ("toggle_press", "idle")])
def test_values_with_bounds_keep_their_bits(case, variant):
    s = shipped(case).variants[variant].scene.solve(np.linspace(0.0, 6.0, 20))
    program, leaves = program_of(s.dynamics, ("balancing_torque", *s.reactions))
    alone = program.run(s.dynamics, leaves)
    np.testing.assert_array_equal(program.bounded().run(s.dynamics, leaves)[: len(alone)], alone)


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_a_fold_has_a_bound_a_rounding_from_the_angle():
    """A design's number beside the sine may be a rounding itself, as is a component of gravity, and tells no size."""
    link = ks.Link(2.0, 0.05, 0.01)
    folding = ks.crank_slider(0.3, 0.3, coupler=link, slider=link, assembly="open")
    s = ks.solve(folding, [np.pi / 2], crank_speed=7.0, loads=ks.Gravity())
    assert np.max(s.error_bound("B")) < 1e-12


@every("other", [lambda turning, two: two * turning, lambda turning, two: two * (turning * turning).sqrt()])
def test_a_sum_of_a_zero_and_a_rotation_is_known(other):
    graph = Graph()
    one, two = map(graph.parameter, range(2))
    turning = graph.angle().sin()
    (bound,) = bounds_of(graph, [one * turning - other(turning, two)], [0.3, 0.1], angle=1e-9)
    assert bound < 8.0 * UNIT_ROUNDOFF * 1e-9


def test_a_root_whose_square_overflows_has_no_bound():
    """One over the root is computed 0, and truly 5.8e-155."""
    graph = Graph()
    one, tiny, huge = map(graph.parameter, range(3))
    part = one / tiny / tiny / tiny * graph.angle()
    share = huge / (part + part * 1.0000001).sqrt()
    found = share, *ErrorBounds(graph).of([share]), *tight_bounds(graph, {}, [share])
    line = Program(None, found)._by_numbers
    value, *bounds = line(np.array([1.0]), [1.2e30, 2.0e-93, 1e30], (1,))[:, 0]
    assert value == 0.0
    assert not np.isfinite(bounds).any()
    assert np.isfinite(line(np.array([1.0]), [1.2e30, 3.0e-92, 1e30], (1,))).all()


@every("first", [lambda one, angle: one, lambda one, angle: angle])
def test_errors_of_a_root_and_a_zero_sum_multiply(first):
    graph = Graph()
    one, tiny, small, huge = map(graph.parameter, range(4))
    angle = graph.angle()
    zero = (first(one, angle) + tiny) - one  # computed 0, truly 2^-60
    root = (small * small * (angle.sin() * angle.sin())).sqrt()  # computed 0, truly 8.4e-171
    product = zero * root * huge
    found = *ErrorBounds(graph).of([product]), *tight_bounds(graph, {}, [product])
    values = [1.0, 2.0**-60, 1e-170, 1e30]
    bounds = Program(None, found)._by_numbers(np.array([1.0]), values, (1,))[:, 0]
    assert np.all(bounds >= 2.0**-60 * 1e-170 * 1e30 * np.sin(1.0))


@every("function", ["sin", "arctan"])
def test_functions_of_subnormals_are_not_exact(function):
    graph = Graph()
    one = graph.parameter(0)
    (bound,) = bounds_of(graph, [getattr(one, function)()], [5e-324])
    assert bound > 0.0


def test_a_reciprocal_of_a_tiny_number_is_no_pivot():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    part = graph.angle() * one * one * one
    below = part - other
    outputs = 1e-250 / below, 1e-30 / below
    (_, bound) = bounds_of(graph, outputs, [2.0**90, 2.0**90], angle=1.0)
    assert bound >= 3.5 * UNIT_ROUNDOFF * 1e-30 / 2.0**270


@pytest.mark.slow
def test_random_extreme_graphs_lie_within_bounds(flint):
    """Every operation, zeros, numbers of every size; many thousands: ``Case(seed).wrong`` of more seeds."""
    assert [wrong for seed in range(30) for wrong in Case(seed).wrong(WAYS)] == []


@pytest.mark.slow
def test_compiled_random_graphs_lie_within_bounds(flint, numba):
    assert list(Case(0).wrong(COMPILED)) == []


def test_an_output_that_is_a_plain_number_is_exact():
    assert ErrorBounds(Graph()).of([0.0]) == (0.0,)


# functions

OTHER = {"sin": "cos", "cos": "sin"}
SMALL_TURN = 2.0**-27
"""Sine or cosine below which the other is 1 or -1 exactly."""
BOUNDS = {
    "running": lambda graph, output, inputs=None: ErrorBounds(graph, inputs).of([output])[0],
    "tight": lambda graph, output, inputs=None: tight_bounds(graph, inputs, [output])[0],
}


def bound_of(way, graph, output, angle, *values):
    return Program(None, [BOUNDS[way](graph, output)])._by_numbers(np.array([angle]), values, (1,))[0, 0]


@every("function, exact", [("sin", "sin"), ("cos", "cos"), ("arctan", "atan")])
def test_functions_of_both_engines_keep_to_their_ulp(flint, function, exact):
    random = np.random.default_rng(1)
    angles = np.concatenate(
        [random.uniform(-7, 7, 400), random.uniform(-1, 1, 400) * 10.0 ** random.uniform(-12, 6, 400)]
    )
    found = [getattr(np, function)(angles)]
    if numba_available() and function != "arctan":
        found.append(numba_backend.compiled_sines(angles[None])[function == "cos"][0])
    with flint.ctx.workprec(200):
        truth = [getattr(flint.arb(float(angle)), exact)() for angle in angles]
        error = [float(abs((flint.arb(float(v)) - t) / t)) for own in found for v, t in zip(own, truth, strict=True)]
    assert max(error) <= OWN.ulp * UNIT_ROUNDOFF


@every("function", OTHER)
def test_a_sine_is_a_sign_where_the_cosine_is_small(function):
    random = np.random.default_rng(2)
    folds = (np.arange(-3000, 3000) + 0.5 * (function == "sin")) * np.pi
    angles = [folds, folds + random.choice([-1, 1], 6000) * 10.0 ** -random.uniform(8, 17, 6000)]
    angles = np.concatenate([*angles, 10.0 ** -np.arange(8.2, 320) if function == "cos" else []])
    turns = [(np.sin(angles), np.cos(angles))]
    if numba_available():
        turns.append([part[0] for part in numba_backend.compiled_sines(angles[None])])
    for turn in turns:
        own, other = turn if function == "sin" else turn[::-1]
        small = np.abs(other) < SMALL_TURN
        assert np.count_nonzero(small) > 6000
        assert np.all(np.abs(own[small]) == 1.0)


@every("way", BOUNDS)
@every("function", OTHER)
@every("side", [1.0, -1.0])
def test_one_minus_cosine_is_bounded_by_sine_squared(way, function, side):
    for distance in (1e-12, 1e-9, 3e-8, 1e-4):
        graph = Graph()
        part = sign(graph.parameter(0)) * getattr(graph.angle(), function)()
        angle = {"sin": 0.5 * np.pi, "cos": 0.0}[function] + (np.pi if side < 0.0 else 0.0) + distance
        other = getattr(np, OTHER[function])(angle)
        for output in (part - side, side - part, part + -side):
            bound = bound_of(way, graph, output, angle, 0.3)
            assert 0.5 * other * other * (distance < SMALL_TURN) <= bound < 8.0 * min(other * other, UNIT_ROUNDOFF)


@every("way", BOUNDS)
def test_a_sign_that_may_be_the_other_is_no_known_one(way):
    graph = Graph()
    given, other = graph.parameter(0), graph.parameter(1)
    angle, values = 1e-9, (0.1 + 0.2, 0.3)
    for unsure in ((given + 1.0) - (other + 1.0), graph.angle() - other):
        folded = sign(unsure) * graph.angle().cos() - 1.0
        assert not bound_of(way, graph, folded, angle, *values) < UNIT_ROUNDOFF
    for sure in (given + 1e-300, given - other):  # one rounding turns no sign
        assert bound_of(way, graph, sign(sure) * graph.angle().cos() - 1.0, angle, *values) < 1e-17


@every("way", BOUNDS)
def test_an_exact_sum_of_inputs_has_no_error(way):
    """As where lengths fall in line: an error of their sum would count beside what is however small."""
    graph = Graph()
    parts = [graph.parameter(place) for place in range(5)]
    for values, least in (([0.5, 0.2, -0.5, -0.2, 0.0], 1e-290), ([0.1, 0.2, -0.3, 1e-40, 1e-60], 1e-46)):
        exact = sum(map(Fraction, values))
        off = abs(Fraction(compensated_sum(*values)) - exact)
        bound = Fraction(bound_of(way, graph, compensated_sum(*parts) * graph.angle(), 1.0, *values))
        assert off <= bound <= 9 * UNIT_ROUNDOFF * abs(exact) + Fraction(least)


@pytest.mark.slow
@every("family, seed", [("place", 70019), ("place", 70138), ("inclined", 70017), ("inclined", 70115)])
@every("tight", [False, True])
def test_an_offset_that_gives_a_direction_is_bounded(flint, family, seed, tight):
    """Where linkages fold, 4e-121 of their lengths make 6e-93 of an acceleration that is truly none."""
    assert errors(solution(family, seed, 8), tight=tight).wrong == []


@every("way", BOUNDS)
def test_an_offset_by_a_share_of_lengths_is_bounded(way):
    graph = Graph()
    moved = offset_from_zero(0.5 * graph.angle(), graph.parameter(0) + graph.parameter(1))
    assert bound_of(way, graph, moved, 0.0, 3.0, 4.0) >= RELATIVE_OFFSET * 7.0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("angle", [1e-100, 1e-121, 1e-150, -1e-150, 1e-300])
def test_bounds_near_change_points_hold_or_are_inf(flint, angle):
    links = {name: ks.Link(1.0, (0.15, 0.0), 0.01) for name in ("crank", "coupler", "rocker")}
    for assembly in (1, "open", "crossed"):
        rhombus = ks.four_bar(0.3, 0.3, 0.3, rocker_pivot=(0.3, 0.0), assembly=assembly, **links)
        s = ks.solve(rhombus, [angle, 2.0 * angle], crank_speed=3.0, loads=[ks.Gravity()], on_gap="nan")
        assert errors(s).wrong == []


@every("way", BOUNDS)
@every("given", [-1e-130, -0.9 * RELATIVE_OFFSET * NEGLIGIBLE_LENGTH])
def test_an_offset_may_turn_an_unknown_sign(way, given):
    """Along an axis a pivot so near to O is taken to lie on its other side."""
    graph = Graph()
    folded = sign(offset_from_zero(graph.parameter(0), NEGLIGIBLE_LENGTH)) * graph.angle().cos() - 1.0
    assert not bound_of(way, graph, folded, 1e-9, given) < 1.0
    assert bound_of(way, graph, folded, 1e-9, 0.3) < 1e-17


@every("way", BOUNDS)
def test_a_sign_is_known_if_its_error_cannot_turn_it(way):
    graph = Graph()
    given = graph.parameter(0)
    inputs = {given: lambda bounds: Error(4.0, None)}
    folded = sign(given - 0.3) * graph.angle().cos() - 1.0
    for value, is_known in ((0.3 + 2.0**-54, False), (0.3 + 1e-9, True)):
        found = Program(None, [BOUNDS[way](graph, folded, inputs)])._by_numbers(np.array([1e-9]), [value], (1,))[0, 0]
        assert (found < 1e-17) == is_known


# products with 0


@every("kind", [Graph, SimplifiedGraph])
@every(
    "made",
    [
        lambda root, one: 0.0 * root.held(),
        lambda root, one: one + 0.0 * root,
        lambda root, one: one * one.graph.angle() - 0.0 * root,
        lambda root, one: (one + 0.0 * (1.0 + root)).sin(),
        lambda root, one: one / (one + 0.0 * root),
        lambda root, one: compensated_sum(one, one, 0.0 * root),
        lambda root, one: sign(0.0 * root),
        lambda root, one: 0.0 * sign(root - one),
    ],
)
def test_zero_times_an_undefined_root_has_no_bound(kind, made):
    graph = kind()
    one, other, unit = map(graph.parameter, range(3))
    root = (graph.angle().cos() * one - other).forgiving_root(unit)
    output = made(root, one)
    found = *ErrorBounds(graph).of([output]), *tight_bounds(graph, {}, [output])
    line = Program(None, found)._by_numbers
    for square, known in ((0.5, True), (2.0**-52, False)):  # that of the root is found nearly zero
        bounds = line(np.array([0.0]), [1.0, 1.0 - square, 1e-3], (1,))[:, 0]
        assert (np.isfinite(bounds) == known).all()


def test_a_constant_of_known_parts_is_exact():
    graph = SimplifiedGraph()
    one, other, unit = map(graph.parameter, range(3))
    output = one + 0.0 * (graph.angle().cos() * one - other).forgiving_root(unit).held()
    line = Program(None, ErrorBounds(graph).of([output]))._by_numbers
    assert line(np.array([0.0]), [1.0, 0.5, 1e-3], (1,)) == 0.0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_no_bound_of_a_rate_where_assembly_is_open():
    """A rounding from where the coupler is barely long enough; elsewhere the rate is exact."""
    machine = ks.crank_slider(0.3, 0.25, coupler=ks.Link(2.0, 0.1, 0.1), slider=ks.Link(1.0))
    edge = np.nextafter(np.arcsin(0.25 / 0.3), 0.0)
    s = ks.Scene(machine, 7.0).solve([0.5, edge], on_gap="nan")
    far, near = s.error_bound("crank_rate")
    assert far == 0.0
    assert not np.isfinite(near)


# as users have them


def test_a_magnitude_covers_components_and_rounding():
    rng = np.random.default_rng(3)
    values, bounds = rng.normal(size=(2, 200)), 1e-9 * rng.random((2, 200))
    off = np.abs(np.hypot(*(values + bounds)) - np.hypot(*values))
    assert np.all(off <= of_magnitude(values, bounds))
    assert np.all(of_magnitude(values, 0.0 * bounds) > 0.0)


def test_a_missing_bound_is_inf_and_of_a_gap_nan():
    bounds = where_known(np.array([1.0, 2.0, np.nan]), np.array([0.1, np.nan, 0.1]))
    np.testing.assert_array_equal(bounds, [0.1, np.inf, np.nan])


def test_a_value_too_large_for_a_double_has_no_bound():
    assert where_known(np.array([1.0, np.inf, np.nan]), np.array([0.5, 0.5, 0.5])).tolist()[:2] == [0.5, np.inf]

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
from support.graphs import COMPILED, WAYS, Case, new_graph

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


def bound_at(way, graph, output, angle, *values):
    return Program(None, [BOUNDS[way](graph, output)])._by_numbers(np.array([angle]), values, (1,))[0, 0]


def bound_of(way, make, angle, *values):
    """Bound of what a function makes of the crank angle and the parameters of a graph."""
    graph = Graph()
    output = make(graph.angle(), *map(graph.parameter, range(len(values))))
    return bound_at(way, graph, output, angle, *values)


BOUNDS = {
    "running": lambda graph, output, inputs=None: ErrorBounds(graph, inputs).of([output])[0],
    "tight": lambda graph, output, inputs=None: tight_bounds(graph, inputs, [output])[0],
}
U, TINY, EXACT = UNIT_ROUNDOFF, 5e-324, 1e-8
FOUR = 0.3, 0.6000000000000001, -0.4, -0.5000000000000001
"""Numbers whose sum is small and exact."""
TOTAL = abs(math.fsum(FOUR))
BETWEEN = {
    "product": (lambda _, a, b: a * b, [0.0, 3.0, 0.7], 2.1 * U * (1 - EXACT), 2.1 * U * (1 + EXACT)),
    "sign": (lambda _, a, b: a.sign() * (a * b), [0.0, -3.0, 0.7], 2.1 * U * (1 - EXACT), 2.1 * U * (1 + EXACT)),
    "product with 0": (lambda _, a, b: a * b + 0.0 * (a + b), [0.0, 3.0, 0.7], 2.1 * U * (1 - EXACT), 2.1 * U * 1.001),
    "half of a subnormal": (lambda _, a: 0.5 * a, [0.0, TINY], 0.5 * TINY, np.inf),
    "half of a subnormal, divided": (lambda _, a, b: 0.5 * a / b, [0.0, TINY, 1e-29], 2.5e-324 / 1e-29, np.inf),
    "sine of a subnormal": (lambda _, a: a.sin(), [0.0, TINY], TINY, np.inf),
    "arctangent of a subnormal": (lambda _, a: a.arctan(), [0.0, TINY], TINY, np.inf),
    "input that underflows": (
        lambda phi, a, b: phi.cos() / b * a,
        [1.0, TINY, 4.1e-193],
        U * (TINY / 4.1e-193) * np.cos(1.0),
        np.inf,
    ),
    "root and zero sum, truly 2^-60 and 8.4e-171": (
        lambda phi, a, b, c, d: ((a + b) - a) * (c * c * (phi.sin() * phi.sin())).sqrt() * d,
        [1.0, 1.0, 2.0**-60, 1e-170, 1e30],
        2.0**-60 * 1e-170 * 1e30 * np.sin(1.0),
        np.inf,
    ),
    "root and zero sum of the angle": (
        lambda phi, a, b, c, d: ((phi + b) - a) * (c * c * (phi.sin() * phi.sin())).sqrt() * d,
        [1.0, 1.0, 2.0**-60, 1e-170, 1e30],
        2.0**-60 * 1e-170 * 1e30 * np.sin(1.0),
        np.inf,
    ),
    "lost differences, truly 2^-54": (
        lambda _, a, b: ((a + b) - a) * ((2.0 * a + b) - 2.0 * a),
        [0.0, 1.0, 2.0**-54],
        2.0**-108,
        np.inf,
    ),
    "offset by a share of lengths": (
        lambda phi, a, b: offset_from_zero(0.5 * phi, a + b),
        [0.0, 3.0, 4.0],
        RELATIVE_OFFSET * 7.0,
        np.inf,
    ),
}
"""By both ways: the crank angle and the parameters, and what the bound lies between."""
RUNNING_BETWEEN = {
    "underflow beside a zero sum": (
        lambda phi, a, b, c: (phi.sin() - phi.sin() * 3.0 + a * b) * c,
        [0.0, 1e-170, 1e-170, 1e30],
        1e-310,
        np.inf,
    ),
    "sum of inputs": (lambda _, *four: compensated_sum(*four), [0.0, *FOUR], U * TOTAL, 1.001 * U * TOTAL),
    "sum of a product": (
        lambda _, a, b, *rest: compensated_sum(a * b, *rest),
        [0.0, *FOUR],
        0.9 * U * (1 - EXACT),
        0.9 * U * (1 + EXACT),
    ),
    "near lengths": (
        lambda phi, x, y, a: compensated_sum(length(x, y), length_error(length(x, y), x, y), -a) * phi.sin(),
        [1.0, 0.21, 0.81, 0.83],
        0.0,
        8 * U * (0.83679 - 0.83),
    ),
    "length of the angle": (
        lambda y, x: compensated_sum(length(x, y), length_error(length(x, y), x, y)),
        [0.81, 0.21],
        0.5 * U * 0.83,
        12 * U * 0.84,
    ),
    "rounded part of a length": (
        lambda _, x, y, a: compensated_sum(length(x * y, y), -a, length_error(length(x * y, y), x * y, y)),
        [0.0, 3.0, 0.1, 0.3],
        0.3 * U,
        np.inf,
    ),
    "sign of a clear sum": (lambda phi, a, b: sign(phi.sin() * a - b) * a, [1.0, 3.0, 0.5], 0.0, 1e-9 * U),
    "zero and a rotation": (lambda phi, a, b: a * phi.sin() - b * phi.sin(), [1e-9, 0.3, 0.1], 0.0, 8e-9 * U),
    "zero and its size": (
        lambda phi, a, b: a * phi.sin() - b * (phi.sin() * phi.sin()).sqrt(),
        [1e-9, 0.3, 0.1],
        0.0,
        8e-9 * U,
    ),
    "reciprocal of a tiny number": (
        lambda phi, a, b: 1e-30 / (phi * a * a * a - b),
        [1.0, 2.0**90, 2.0**90],
        3.5 * U * 1e-30 / 2.0**270,
        np.inf,
    ),
    "quotient without guard": (lambda phi, a: (phi.sin() + a) / phi.sin(), [1e-3, 0.3], U * 0.3e3, np.inf),
    "guard that does not act": (
        lambda _, a, b, c: 1.0 / (a * a - b * b).sqrt().kept_off_zero(c),
        [0.0, 1.0, 0.5, 1e-8],
        0.0,
        4.0 * U,
    ),
    "guard that acts": (
        lambda _, a, b, c: 1.0 / (a * a - b * b).sqrt().kept_off_zero(c),
        [0.0, 1.0, 0.5, 0.9],
        1.0 / 0.75**0.5 - 1.0 / 0.9,
        0.05,
    ),
}


def length(x, y):
    return (x * x + y * y).sqrt()


@every(
    ("way", "name"),
    [*((way, name) for way in BOUNDS for name in BETWEEN), *(("running", name) for name in RUNNING_BETWEEN)],
)
def test_bounds_hold_and_are_near(way, name):
    make, at, least, most = (BETWEEN | RUNNING_BETWEEN)[name]
    assert least <= bound_of(way, make, *at) <= most


ROOTS = [
    (lambda _, a, b, c: (a * b).forgiving_root(c), [1e-20, -1.0, 2.0], False),
    (lambda _, a, b, c: (b * b).forgiving_root(c), [1e-20, -1.0, 2.0], True),
    (lambda _, a, b, c: (a * a - b * b).forgiving_root(c), [1.0, 1.0 + 6 * U, 2.0], False),
    (lambda _, a, b, c: (a * a - b * b).forgiving_root(c), [1.0, 0.9, 2.0], True),
    (lambda _, a, b, c: 1.0 / (a * a - b * b).forgiving_root(c), [1.0, 0.9, 2.0], True),
    *((lambda phi, a, b: phi.cos() / (a * a - b * b), [1.0, 1.0 + 2.0**-n], n < 60) for n in (30, 46, 52, 60)),
]


@every(("make", "values", "known"), ROOTS)
def test_what_may_be_negative_or_zero_has_no_bound(make, values, known):
    bound = bound_of("running", make, 0.0, *values)
    assert np.isfinite(bound) == known
    assert bound > 0.0 or not known


@every("function", [lambda part: part.arctan(), sign])
def test_a_function_of_an_overflow_is_no_negative_bound(function):
    make = lambda phi, a, b: function((phi * a + b) * (phi * a + b))  # noqa: E731
    assert not bound_of("running", make, 1.0, 1e160, 1.0) < 0.0


def test_operations_on_numbers_are_bounded_as_by_hand():
    graph, one, two = new_graph(2)
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


def test_no_bound_at_zero_divisors_and_clamped_roots():
    folded = ks.crank_slider(0.5, 0.5, guide_angle=1.0, coupler=ks.Link(1.0), slider=ks.Link(1.0))
    with pytest.warns(ConditionWarning):
        s = ks.solve(folded, [1.3, 1.0 + np.pi / 2], crank_speed=1.0, on_gap="nan")
    found = s.error_bound("B")
    assert np.isfinite(found[:, 0]).all()
    assert not np.isfinite(found[:, 1]).any()


def test_a_reciprocal_product_is_bounded_as_a_quotient():
    graph, one, other = new_graph(2)
    below = one + other - 1.9999
    outputs = one * (1.0 / below), one / below
    product, quotient = bounds_of(graph, outputs, [1.0, 1.0])
    assert quotient < product < 1.001 * quotient  # one rounding more
    huge = 1.0 / (1e30 * one * 1e30) / 1e250  # loses digits as too small for a double
    (bound,) = bounds_of(graph, [huge * other], [1.0, 1.0])
    assert bound >= 5e-324


def test_rows_of_tables_may_be_of_any_size():
    graph, one, other = new_graph(2)
    found = ErrorBounds(graph).of([one * other * graph.row(0)])
    (bound,) = Program(None, found)._plain(0.0, 0.0, 1.0, [1e-170, 1e-170], [1e200])
    assert bound >= 1e-140  # computed 0


def test_a_bound_that_is_too_small_is_found(flint, monkeypatch):
    made = next(found for found in (solution("four-bar", seed) for seed in range(9)) if found is not None)
    values, proven = bounded_machines.NUMPY.with_bounds(made.dynamics, ("O",))
    too_small = SimpleNamespace(with_bounds=lambda *given: (values, {"O": 1e-4 * proven["O"]}))
    monkeypatch.setitem(bounded_machines.ENGINES, "numpy", too_small)
    assert errors(made, ("O",)).wrong


@every("tight", [False, True])
def test_a_product_that_underflows_is_bounded(tight):
    graph, one, other, huge = new_graph(3)
    for scaled in (lambda square: square * (huge * huge), lambda square: square * huge * huge):
        lost = [scaled(part * part).forgiving_root(huge) for part in (one, other)]  # 0, and truly 1e-140
        found = bounds_of(graph, [lost[0] * lost[1], lost[0] + lost[1]], [1e-170, 1e-170, 1e30], tight)
        assert not np.any(found < [1e-280, 2e-140])  # a tight one may be none
        assert np.isfinite(found[1])


def test_tight_bounds_include_errors_of_stop_gradient():
    graph, one, other = new_graph(2)
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


@pytest.mark.slow
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


def test_a_length_and_its_rest_are_bounded_together():
    graph, x, y, other = new_graph(3)
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


@every("form", [lambda root, kept: root / kept, lambda root, kept: root * (1.0 / kept), lambda root, kept: kept / root])
def test_a_guard_that_acts_is_an_error(form):
    graph, one, other, unit = new_graph(3)
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
    graph, one, small = new_graph(2)
    part = one * graph.angle()
    outputs = part.kept_off_zero(small), part / part.kept_off_zero(small)
    inside = 1.0 - 2.0**-10
    kept, share = bounds_of(graph, outputs, [inside * unit, unit], angle=1.0)
    assert not kept < unit - inside * unit
    assert not share < 1.0 - inside


@every("power", [1, 3, 12, 20])
def test_pivot_errors_enlarge_errors_they_multiply(power):
    """A difference that is lost has an error of 1e-16, and what divides it one of a hundredth each time."""
    graph, one, other, tiny = new_graph(3)
    over = 1.0 / (one * one - other * other)
    product = (graph.angle().cos() * one + tiny) - one  # computed 0, truly tiny
    for _ in range(power):
        product = product * over
    values = [1.0, 1.0 + 2.0**-47, 2.0**-54]
    (bound,) = bounds_of(graph, [product], values)
    one, other, tiny = map(Fraction, values)
    assert Fraction(bound) >= abs(tiny / (one * one - other * other) ** power)


def test_one_over_one_plus_magnitude_uses_its_slope():
    graph, one, other = new_graph(2)
    cosine = graph.angle().cos() * one - other
    (bound, alone) = bounds_of(graph, [one / (1.0 + abs(cosine)), cosine], [100.0, 50.0])
    assert bound < 1.2 * (100.0 / 51.0**2 * (alone + 51.0 * UNIT_ROUNDOFF) + 100.0 / 51.0 * UNIT_ROUNDOFF)


def test_a_product_with_an_offset_from_zero_counts_all():
    graph, one, other = new_graph(2)
    product = offset_from_zero(one, NEGLIGIBLE_LENGTH) * other
    for dust in (OWN.dust, None):
        (bound,) = ErrorBounds(graph, arithmetic=OWN._replace(dust=dust)).of([product])
        values = Program(None, (product, bound))._plain(0.0, 0.0, 1.0, [0.0, 3.0], ())
        assert values[1] >= values[0] > 0.0


@pytest.mark.slow
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


@pytest.mark.slow
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


def test_a_root_whose_square_overflows_has_no_bound():
    """One over the root is computed 0, and truly 5.8e-155."""
    graph, one, tiny, huge = new_graph(3)
    part = one / tiny / tiny / tiny * graph.angle()
    share = huge / (part + part * 1.0000001).sqrt()
    found = share, *ErrorBounds(graph).of([share]), *tight_bounds(graph, {}, [share])
    line = Program(None, found)._by_numbers
    value, *bounds = line(np.array([1.0]), [1.2e30, 2.0e-93, 1e30], (1,))[:, 0]
    assert value == 0.0
    assert not np.isfinite(bounds).any()
    assert np.isfinite(line(np.array([1.0]), [1.2e30, 3.0e-92, 1e30], (1,))).all()


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


@pytest.mark.slow
@every("function, exact", [("sin", "sin"), ("cos", "cos"), ("arctan", "atan"), ("exp", "exp"), ("log", "log")])
def test_functions_of_both_engines_keep_to_their_ulp(flint, function, exact):
    random = np.random.default_rng(1)
    angles = np.concatenate(
        [random.uniform(-7, 7, 400), random.uniform(-1, 1, 400) * 10.0 ** random.uniform(-12, 6, 400)]
    )
    if function == "exp":
        angles = angles[abs(angles) < 700.0]
    if function == "log":
        angles = np.concatenate([abs(angles), 1.0 + angles[400:] * 1e-6])
        angles = angles[(angles > 0.0) & (angles != 1.0)]
    found = [getattr(np, function)(angles)]
    if numba_available() and function in OTHER:
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
            bound = bound_at(way, graph, output, angle, 0.3)
            assert 0.5 * other * other * (distance < SMALL_TURN) <= bound < 8.0 * min(other * other, UNIT_ROUNDOFF)


@every("way", BOUNDS)
def test_a_sign_that_may_be_the_other_is_no_known_one(way):
    graph, given, other = new_graph(2)
    angle, values = 1e-9, (0.1 + 0.2, 0.3)
    for unsure in ((given + 1.0) - (other + 1.0), graph.angle() - other):
        folded = sign(unsure) * graph.angle().cos() - 1.0
        assert not bound_at(way, graph, folded, angle, *values) < UNIT_ROUNDOFF
    for sure in (given + 1e-300, given - other):  # one rounding turns no sign
        assert bound_at(way, graph, sign(sure) * graph.angle().cos() - 1.0, angle, *values) < 1e-17


@every("way", BOUNDS)
def test_an_exact_sum_of_inputs_has_no_error(way):
    """As where lengths fall in line: an error of their sum would count beside what is however small."""
    graph = Graph()
    parts = [graph.parameter(place) for place in range(5)]
    for values, least in (([0.5, 0.2, -0.5, -0.2, 0.0], 1e-290), ([0.1, 0.2, -0.3, 1e-40, 1e-60], 1e-46)):
        exact = sum(map(Fraction, values))
        off = abs(Fraction(compensated_sum(*values)) - exact)
        bound = Fraction(bound_at(way, graph, compensated_sum(*parts) * graph.angle(), 1.0, *values))
        assert off <= bound <= 9 * UNIT_ROUNDOFF * abs(exact) + Fraction(least)


@pytest.mark.slow
@every("family, seed", [("place", 70019), ("place", 70138), ("inclined", 70017), ("inclined", 70115)])
@every("tight", [False, True])
def test_an_offset_that_gives_a_direction_is_bounded(flint, family, seed, tight):
    """Where linkages fold, 4e-121 of their lengths make 6e-93 of an acceleration that is truly none."""
    assert errors(solution(family, seed, 8), tight=tight).wrong == []


@pytest.mark.slow
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
    assert not bound_at(way, graph, folded, 1e-9, given) < 1.0
    assert bound_at(way, graph, folded, 1e-9, 0.3) < 1e-17


@every("way", BOUNDS)
def test_a_sign_is_known_if_its_error_cannot_turn_it(way):
    graph, given = new_graph(1)
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
    graph, one, other, unit = new_graph(3, kind)
    root = (graph.angle().cos() * one - other).forgiving_root(unit)
    output = made(root, one)
    found = *ErrorBounds(graph).of([output]), *tight_bounds(graph, {}, [output])
    line = Program(None, found)._by_numbers
    for square, known in ((0.5, True), (2.0**-52, False)):  # that of the root is found nearly zero
        bounds = line(np.array([0.0]), [1.0, 1.0 - square, 1e-3], (1,))[:, 0]
        assert (np.isfinite(bounds) == known).all()


def test_a_constant_of_known_parts_is_exact():
    graph, one, other, unit = new_graph(3, SimplifiedGraph)
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

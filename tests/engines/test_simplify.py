"""Simplified graphs have fewer operations; fused sums keep exact zeros."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.graph import Graph, needed
from kinetostatics.engines.program import Program, program_of
from kinetostatics.engines.record import Recording
from kinetostatics.engines.simplify import SimplifiedGraph, fused_sums


@pytest.fixture
def lean():
    """Sine and cosine of the crank angle, and two numbers of a design, that record few operations."""
    graph = SimplifiedGraph()
    angle = graph.angle()
    return angle.sin(), angle.cos(), graph.parameter(0), graph.parameter(1)


def told(node):
    """Operations behind a number, in order."""
    return [part.operation for part in needed([node]) if part.arguments and part.operation != "parameter"]


def test_quotients_by_one_divisor_share_a_reciprocal(lean):
    sine, cosine, length, _ = lean
    root = cosine.sqrt()
    total = (sine + length) / root + (sine - length) / root
    assert told(total).count("/") == 1
    assert told(sine / length + cosine / length).count("/") == 1
    assert (sine / length).arguments[1].varies == length.varies  # once for a design


def test_a_quotient_by_a_quotient_becomes_one(lean):
    sine, cosine, length, _ = lean
    assert told(sine / (cosine.sqrt() / length)) == ["sin", "cos", "sqrt", "/", "*", "*"]


def test_a_quotient_leaves_its_sign_to_sums(lean):
    sine, cosine, length, _ = lean
    assert told(-(sine * cosine) / cosine) == ["sin", "-"]
    assert told(length + -sine / cosine) == ["sin", "cos", "/", "-"]


def test_the_secant_of_an_inclined_root_adds_no_root(lean):
    """1 + x^2 / (a^2 - x^2) = a^2 / (a^2 - x^2), whatever the sign of a, and in whichever order it is written."""
    sine, _, length, _ = lean
    for one, other in ((length - sine, length + sine), (sine + length, length - sine)):
        over = sine / (one * other).sqrt()
        for square in (1.0 + over * over, over * over + 1.0):
            assert told(square.sqrt()).count("sqrt") == 1
            assert "abs" in told(square.sqrt())
    slope = sine / ((length - sine) * (length + 2.0 * sine)).sqrt()
    assert told((1.0 + slope * slope).sqrt()).count("sqrt") == 2


def test_zeros_are_dropped_unless_they_may_be_gaps(lean):
    sine, cosine, length, _ = lean
    assert 0.0 * sine == 0.0
    assert cosine * 0.0 == 0.0
    assert told(length * sine + 0.0 * cosine) == ["sin", "*", "+"]  # a zero that is added gives a zero its sign
    gap = 0.0 * cosine.sqrt()
    assert told(gap)[-1] == "*"
    assert told(0.0 + gap)[-1] == "+"


def test_a_factor_multiplied_and_divided_cancels(lean):
    sine, cosine, length, other = lean
    assert sine / length * length is sine
    assert length * (sine / length) is sine
    assert sine * cosine / cosine is sine
    assert length / other / (length / other) is not sine  # of a design alone nothing is rewritten


def test_products_leave_signs_to_sums(lean):
    sine, cosine, length, _ = lean
    assert length - (-sine) * cosine is length + sine * cosine
    assert (-sine) * (-cosine) is sine * cosine
    assert cosine + -sine / length is cosine - sine / length


def test_zero_divisors_of_a_design_stay_in_place(lean):
    sine, *_ = lean
    assert told(sine / 0.0) == ["sin", "/"]


def test_divisors_without_a_reciprocal_stay():
    """Zero by the smallest number is zero; zero times infinity would be none."""
    graph = SimplifiedGraph()
    x, length = graph.angle(), graph.parameter(0)
    for small in (x + 5e-324, x * x, x + 1.0):
        assert (length / small).operation == "/"
        assert (length / (length * small)).operation == "/"
    assert (x / (length * x.sqrt())).operation == "*"


def test_a_size_along_the_crank_needs_no_root(lean):
    sine, cosine, length, other = lean
    force = length * cosine + other
    for x, y in ((force * sine, cosine * force), (-force * cosine, force * sine)):
        assert told((x * x + y * y).sqrt())[-1] == "abs"
        assert "sqrt" not in told((x * x + y * y).sqrt())
    x, y = force * sine, (force + other) * cosine
    assert told((x * x + y * y).sqrt())[-1] == "sqrt"
    x, y = force * sine, force * sine
    assert told((x * x + y * y).sqrt())[-1] == "sqrt"


@pytest.fixture
def graph():
    return Graph()


def numbers(graph):
    """Sine and cosine of the crank angle, and some numbers of a design."""
    angle = graph.angle()
    return angle.sin(), angle.cos(), *map(graph.parameter, range(4))


def parts(total):
    found = fused_sums(needed([total])).get(total)
    return found and (found.sign, {found.one, found.other}, found.rest_sign, found.rest)


def test_a_product_enters_a_sum_with_its_sign(graph):
    sine, cosine, one, other, *_ = numbers(graph)
    product = sine * cosine
    assert parts(product + one) == (1, {sine, cosine}, 1, one)
    assert parts(one - product) == (-1, {sine, cosine}, 1, one)
    assert parts(product - other) == (1, {sine, cosine}, -1, other)
    assert parts(-product - other) == (-1, {sine, cosine}, -1, other)
    assert parts(sine + one) is None
    assert parts(one * other + one) is None  # once for a design


def test_the_product_known_later_is_fused(graph):
    sine, cosine, one, *_ = numbers(graph)
    early, late = sine * sine, (cosine + one) * cosine
    for total in (early + late, late + early):
        assert parts(total) == (1, {cosine + one, cosine}, 1, early)


def test_products_of_equal_structure_are_not_fused(graph):
    sine, cosine, one, other, third, fourth = numbers(graph)
    force, twin = one * (other * sine + one) * cosine, third * (fourth * sine - other) * cosine
    for total in (force - twin, twin + (force + one), (one - force) - (twin + cosine).held()):
        assert fused_sums([*needed([total])]).get(total) is None
    assert parts(force - sine * sine) is not None


@pytest.mark.slow
def test_fused_loops_keep_the_zero_of_equal_products(graph):
    pytest.importorskip("numba")
    sine, cosine, one, other, third, fourth = numbers(graph)
    lever, twin = one * sine + other * cosine, third * sine + fourth * cosine
    outputs = lever * lever * cosine - twin * twin * cosine, lever * sine - twin * sine, lever - twin
    program = Program(Recording((), outputs, (), (), (one, other, third, fourth), (), graph))
    angles = np.linspace(0.0, 6.0, 500)
    assert not program.by_loop(angles, [0.1, 0.7, 0.1, 0.7], (), angles.shape).any()
    assert program.by_loop(angles, [0.1, 0.7, 0.1, 0.8], (), angles.shape).any(axis=-1).all()


@pytest.mark.slow
def test_values_do_not_depend_on_other_outputs():
    pytest.importorskip("numba")
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, (1.0, 0.1), 20.5), slider=ks.Link(600.0))
    s = ks.solve(saw, np.linspace(0.0, 6.0, 500), crank_speed=33.5, loads=ks.Gravity(), engine="compiled")
    (alone, leaves), (together, _) = (program_of(s.dynamics, names) for names in (("O",), ("balancing_torque", "O")))
    expected = alone.run(s.dynamics, leaves, compiled=True)
    for made in (together, together.bounded(), together.by_parameters((0, 1))):
        rows = made.run(s.dynamics, leaves, compiled=True)[: len(together.outputs)]
        assert np.array_equal(together.recording.named(rows)["O"], expected)

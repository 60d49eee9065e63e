"""Graphs with fewer operations: what is left of what is written, and that it is the same."""

import pytest

from kinetostatics.engines.graph import needed
from kinetostatics.engines.simplify import SimplifiedGraph


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


def test_a_quotient_by_a_quotient_is_one_by_its_numerator(lean):
    sine, cosine, length, _ = lean
    assert told(sine / (cosine.sqrt() / length)) == ["sin", "cos", "sqrt", "/", "*", "*"]


def test_a_quotient_leaves_its_sign_to_sums(lean):
    sine, cosine, length, _ = lean
    assert told(-(sine * cosine) / cosine) == ["sin", "-"]
    assert told(length + -sine / cosine) == ["sin", "cos", "/", "-"]


def test_the_secant_of_a_leaning_root_is_no_root_of_its_own(lean):
    """1 + x^2 / (a^2 - x^2) = a^2 / (a^2 - x^2), whatever the sign of a, and in whichever order it is written."""
    sine, _, length, _ = lean
    for one, other in ((length - sine, length + sine), (sine + length, length - sine)):
        over = sine / (one * other).sqrt()
        for square in (1.0 + over * over, over * over + 1.0):
            assert told(square.sqrt()).count("sqrt") == 1
            assert "abs" in told(square.sqrt())
    slope = sine / ((length - sine) * (length + 2.0 * sine)).sqrt()
    assert told((1.0 + slope * slope).sqrt()).count("sqrt") == 2


def test_what_is_zero_at_every_crank_angle_is_left_out_but_not_what_may_be_a_gap(lean):
    sine, cosine, length, _ = lean
    assert 0.0 * sine == 0.0
    assert cosine * 0.0 == 0.0
    assert told(length * sine + 0.0 * cosine) == ["sin", "*", "+"]  # a zero that is added gives a zero its sign
    gap = 0.0 * cosine.sqrt()
    assert told(gap)[-1] == "*"
    assert told(0.0 + gap)[-1] == "+"


def test_what_is_multiplied_and_divided_by_the_same_number_is_left(lean):
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


def test_zero_divisors_of_a_design_are_divided_by_where_they_stand(lean):
    sine, *_ = lean
    assert told(sine / 0.0) == ["sin", "/"]


def test_what_may_be_so_small_that_it_has_no_reciprocal_is_divided_by_as_it_is():
    """Zero by the smallest number is zero; zero times infinity would be none."""
    graph = SimplifiedGraph()
    x, length = graph.angle(), graph.parameter(0)
    for small in (x + 5e-324, x * x, x + 1.0):
        assert (length / small).operation == "/"
        assert (length / (length * small)).operation == "/"
    assert (x / (length * x.sqrt())).operation == "*"


def test_the_size_of_what_lies_along_the_crank_or_across_it_needs_no_root(lean):
    sine, cosine, length, other = lean
    force = length * cosine + other
    for x, y in ((force * sine, cosine * force), (-force * cosine, force * sine)):
        assert told((x * x + y * y).sqrt())[-1] == "abs"
        assert "sqrt" not in told((x * x + y * y).sqrt())
    x, y = force * sine, (force + other) * cosine
    assert told((x * x + y * y).sqrt())[-1] == "sqrt"
    x, y = force * sine, force * sine
    assert told((x * x + y * y).sqrt())[-1] == "sqrt"

"""Errors of products are counts of roundings: nothing is computed for them."""

from kinetostatics.engines.counted import EXACT, NO_POWER, Counted, Relative
from kinetostatics.engines.graph import Graph, needed


def counted(output, dust=0.0):
    found = Counted(output.graph, {}, dust)
    found.count(needed([output]))
    return found, found.relative(output)


def test_products_quotients_and_roots_of_given_numbers_count_their_roundings():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    assert counted(one)[1] == EXACT
    assert counted(one * other / one)[1] == Relative(2.0, {}, 0.0)
    assert counted(one * one)[1].roundings == 1.0
    assert counted((one * one).sqrt())[1].roundings == 1.5
    assert counted(0.5 * one)[1].roundings == 0.0
    assert counted(graph.angle().sin() * one)[1].roundings == 3.0


def test_one_sum_of_given_numbers_is_rounded_once_and_sums_of_squares_keep_the_larger_count():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    assert counted(one - other)[1] == Relative(1.0, {}, None)
    assert counted((one * other) * (one * other) + one * one)[1].roundings == 4.0
    assert counted(one * other - one * one)[1] is None


def test_what_is_divided_by_a_sum_has_it_as_a_pivot_that_a_product_may_cancel_but_for_its_being_there():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    total = one * other - one
    root = total.sqrt()
    found = counted(one / root)[1]
    assert (found.roundings, found.pivots) == (2.0, {total: -0.5})
    assert counted((one / root) * root)[1].pivots == {total: NO_POWER}


def test_magnitudes_that_a_design_fixes_do_not_hang_on_the_crank_angle():
    graph = Graph()
    radius, unit = map(graph.parameter, range(2))
    height = radius * graph.angle().sin()
    found, _ = counted(height * (1.0 / (height + radius).sqrt().kept_off_zero(unit)), 2.0**-960)
    assert found.cap(height) is abs(radius)
    assert found.cap(1.0 / (height + radius).sqrt().kept_off_zero(unit)).varies == radius.varies
    assert found.cap(graph.row(0)).varies == height.varies


def test_only_one_over_the_root_of_a_sum_is_never_too_small():
    graph = Graph()
    one, unit = map(graph.parameter, range(2))
    total, dust = one * one - one * unit, 2.0**-960
    for over in (1.0 / total.sqrt(), -2.0 / total.sqrt(), 1.0 / total.sqrt().kept_off_zero(unit)):
        assert counted(over, dust)[1].dust is None
    for over in (1.0 / total, 0.5 / total.sqrt(), one / total.sqrt(), 1.0 / abs(one).sqrt()):
        assert counted(over, dust)[1].dust is not None


def test_what_cannot_be_negative_is_its_own_magnitude():
    graph = Graph()
    one, other = map(graph.parameter, range(2))
    found, _ = counted(one * other)
    square = one * one
    assert found.size(square + abs(other)) is square + abs(other)
    assert found.size(-square) is square
    assert found.size(square - one) is abs(square - one)

"""What is none where a mechanism may not be assembled has no bound there, though it is found without it."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import programs
from kinetostatics.engines.error_bounds import ErrorBounds, tight_bounds
from kinetostatics.engines.lean import LeanGraph
from kinetostatics.engines.trace import Graph
from kinetostatics.numbers.elementary import sign, total
from support.every import every


@every("kind", [Graph, LeanGraph])
@every(
    "made",
    [
        lambda root, one: 0.0 * root.held(),
        lambda root, one: one + 0.0 * root,
        lambda root, one: one * one.graph.angle() - 0.0 * root,
        lambda root, one: (one + 0.0 * (1.0 + root)).sin(),
        lambda root, one: one / (one + 0.0 * root),
        lambda root, one: total(one, one, 0.0 * root),
        lambda root, one: sign(0.0 * root),
        lambda root, one: 0.0 * sign(root - one),
    ],
)
def test_a_product_of_zero_with_a_root_that_may_not_be_there_has_no_bound(kind, made):
    graph = kind()
    one, other, unit = map(graph.parameter, range(3))
    root = (graph.angle().cos() * one - other).forgiving_root(unit)
    output = made(root, one)
    found = *ErrorBounds(graph).of([output]), *tight_bounds(graph, {}, [output])
    line = programs.Program(None, found)._by_numbers
    for rest, known in ((0.5, True), (2.0**-52, False)):  # that of the root is found nearly zero
        bounds = line(np.array([0.0]), [1.0, 1.0 - rest, 1e-3], (1,))[:, 0]
        assert (np.isfinite(bounds) == known).all()


def test_a_constant_is_exact_where_what_is_behind_it_is_known():
    graph = LeanGraph()
    one, other, unit = map(graph.parameter, range(3))
    output = one + 0.0 * (graph.angle().cos() * one - other).forgiving_root(unit).held()
    line = programs.Program(None, ErrorBounds(graph).of([output]))._by_numbers
    assert line(np.array([0.0]), [1.0, 0.5, 1e-3], (1,)) == 0.0


@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
def test_the_rate_of_a_crank_has_no_bound_where_its_machine_may_not_be_assembled():
    """A rounding from where the coupler is barely long enough; elsewhere the rate is exact."""
    machine = ks.crank_slider(0.3, 0.25, coupler=ks.Link(2.0, 0.1, 0.1), slider=ks.Link(1.0))
    edge = np.nextafter(np.arcsin(0.25 / 0.3), 0.0)
    s = ks.Scene(machine, 7.0).solve([0.5, edge], on_gap="nan")
    far, near = s.error_bound("crank_rate")
    assert far == 0.0
    assert not np.isfinite(near)

"""Arithmetic of a compiled loop: every operation is that of single numbers, to the last bit."""

import math
from operator import add, mul, neg, sub, truediv

import numpy as np
import pytest

from kinetostatics.engines import numba_backend
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.operations import BY_DESIGN
from kinetostatics.engines.program import Program
from kinetostatics.engines.record import Recording
from kinetostatics.numbers import elementary

SPECIAL = [0.0, -0.0, 1.0, -1.0, 0.3, 5e-324, -5e-324, 1e-300, 1e300, math.inf, -math.inf, math.nan, -4e-15, -5e-15]


def program(outputs, graph, parameters=()):
    return Program(Recording((), outputs, (), (), parameters, (), graph))


def of_rows(write, rows):
    """Outputs that a function makes of as many rows of tables, compiled: (outputs, N)."""
    graph = Graph()
    given = [graph.row(place) for place in range(len(rows))]
    made = program(tuple(write(*given)), graph)
    angle = np.linspace(0.0, 1.0, rows.shape[-1])
    return made.by_loop(angle, [], list(rows), angle.shape)


@pytest.mark.slow_start
def test_each_operation_is_that_of_numbers_at_signs_of_zero_infinities_and_what_is_none(numba):
    one, other = (part.ravel() for part in np.meshgrid(SPECIAL, SPECIAL))
    more = np.roll(one, 5)

    def write(a, b, c):
        yield from (operation(a, b) for operation in (add, sub, mul, truediv))
        yield from (neg(a), abs(a), a.sqrt(), a.sign(), a.forgiving_root(b), a.kept_off_zero(b))
        yield elementary.total(a, b, c)
        yield from (2.5 - a, 2.5 / a, a * 0.1)

    with np.errstate(all="ignore"):
        wanted = [operation(one, other) for operation in (add, sub, mul, truediv)]
        wanted += [-one, abs(one), np.sqrt(one), np.copysign(1.0, one), BY_DESIGN["root"](one, other)]
        wanted += [np.where(one < other, other, one), elementary.total(one, other, more)]
        wanted += [2.5 - one, 2.5 / one, one * 0.1]
    found = of_rows(write, np.array([one, other, more]))
    for place, (values, expected) in enumerate(zip(found, wanted, strict=True)):
        assert np.array_equal(values, expected, equal_nan=True), place
        real = ~np.isnan(expected) & (place != 8)  # a root of less than zero is 0.0, whatever its sign
        assert np.array_equal(np.signbit(values[real]), np.signbit(expected[real])), place


@pytest.mark.slow_start
def test_functions_called_for_each_number_are_those_of_the_library(numba):
    values = np.linspace(-7.0, 7.0, 37)
    found = of_rows(lambda a: (a.sin(), a.cos(), a.arctan()), values[None])
    for row, function in zip(found, (math.sin, math.cos, math.atan), strict=True):
        np.testing.assert_array_max_ulp(row, np.array(list(map(function, values.tolist()))), 1)


@pytest.mark.slow_start
def test_any_number_of_angles_and_designs_gives_the_same_bits(numba):
    graph = Graph()
    angle, length, offset = graph.angle(), graph.parameter(0), graph.parameter(1)
    sine = length * angle.sin() + offset
    outputs = (sine / (2.0 + angle.cos()), sine, length, 1.5, angle, offset * offset)
    made = program(outputs, graph, (length, offset))
    angles = np.linspace(0.0, 6.0, 43)
    numbers = [np.array([[0.1], [0.7]]), 0.25]
    whole = made.by_loop(angles, numbers, [], (2, angles.size))
    np.testing.assert_allclose(whole, made.by_numpy(angles, numbers, [], (2, angles.size)), rtol=0, atol=1e-15)
    for count in (1, 2, 3, 4, 7, 8, 9, 16, 23):
        assert np.array_equal(made.by_loop(angles[:count], numbers, [], (2, count)), whole[..., :count])


@pytest.mark.slow_start
def test_angles_and_tables_of_each_design_are_its_own(numba):
    graph = Graph()
    angle, length = graph.angle(), graph.parameter(0)
    made = program((angle + graph.row(1), graph.row(0) * angle.cos() * length), graph, (length,))
    angles, rows = np.random.default_rng(0).random((3, 50)), np.random.default_rng(1).random((2, 3, 50))
    found = made.by_loop(angles, [1.0], list(rows), angles.shape)
    assert np.array_equal(found[0], angles + rows[1])
    assert np.array_equal(found[1], rows[0] * numba_backend.compiled_sines(angles)[1])

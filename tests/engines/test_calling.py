"""Compiled loops called by other machine code."""

import numpy as np
import pytest

from kinetostatics.engines import calling, compiled, loops, writing
from kinetostatics.engines.trace import Graph


@pytest.mark.slow_start
def test_a_loop_called_by_its_address_fills_the_same_results(numba):
    graph = Graph()
    angle, length = graph.angle(), graph.parameter(0)
    loop = compiled.loaded(writing.loop((length * angle.sin(), angle.cos() / length))).loop
    call = calling.calling()

    @numba.njit
    def each(address, angle, sine, cosine, parameters, tables, results):
        for k in range(parameters.shape[0]):
            call(address, angle, sine, cosine, parameters[k : k + 1], tables, results[k : k + 1])

    angles = np.linspace(0.0, 6.0, 45)[None]
    lengths = np.array([[0.5], [2.0], [3.0]])
    given = angles, *loops.turn(angles), lengths, loops.NO_ROWS
    wanted, found = np.empty((2, 3, 2, 45))
    loop(*given, wanted)
    each(calling.address_of(loop), *given, found)
    assert np.array_equal(found, wanted)


@pytest.mark.slow_start
def test_arrays_that_a_loop_does_not_take_are_refused(numba):
    call = calling.calling()

    @numba.njit
    def crooked(table):
        call(0, table.T, table, table, table, table, table)

    with pytest.raises(numba.core.errors.TypingError, match="a loop takes other arrays"):
        crooked(np.zeros((2, 2)))

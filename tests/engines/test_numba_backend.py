"""Compiled loops: bits, gaps, limit positions, threads, and what happens without numba."""

import math
import sys
import threading
import warnings
from operator import add, mul, neg, sub, truediv
from time import perf_counter

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.engines.codegen import BY_DESIGN
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program, program_of
from kinetostatics.engines.record import Recording
from kinetostatics.numbers import arithmetic
from support.both_engines import ULP, again, assert_same
from support.scenes import (
    ANGLES,
    SAMPLES,
    SCENES,
    SIZES,
    solve,
)


def test_machine_code_gives_the_same_on_one_thread_and_on_several(numba, monkeypatch):
    """Of many designs each thread takes some, of a single one some angles."""
    expected = solve(SCENES["plain"], SAMPLES + SIZES), solve(SCENES["plain"], ANGLES)
    alone = [again(s).reaction("O") for s in expected]
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    for s, before in zip(expected, alone, strict=True):
        found = again(s).reaction("O")
        assert np.array_equal(found, before)
        assert np.abs(found - s.reaction("O")).max() <= 8 * ULP * np.abs(before).max()


def test_parameters_stand_in_a_row_for_each_design():
    numbers = 1.0, np.array([[2.0], [3.0]]), np.array([4.0]), 5
    assert numba_backend.parameter_table(numbers, (2,)).tolist() == [[1, 2, 4, 5], [1, 3, 4, 5]]
    assert numba_backend.parameter_table((1.0, np.float64(2.0)), ()).tolist() == [[1, 2]]
    assert (
        numba_backend.parameter_table((1.0, np.array([[[6.0]], [[7.0]]])), (2, 3)).tolist()
        == [[1, 6]] * 3 + [[1, 7]] * 3
    )


def test_a_row_of_a_table_for_one_design_may_have_an_axis_of_designs():
    rows = [np.arange(3.0)[None], 7.0, np.arange(3.0)]
    expected = [[[0.0, 1.0, 2.0]], [[7.0] * 3], [[0.0, 1.0, 2.0]]]
    for shape in ((3,), (1, 3), (1, 1, 3), (5, 3)):
        np.testing.assert_array_equal(numba_backend.row_table(rows, shape), expected)


def test_memory_begins_where_vectors_are_loaded_at_once():
    held = [numba_backend.aligned_memory(count, 3, 8) for count in (1, 2, 5)]
    assert [part.shape for part in held] == [(1, 3, 8), (2, 3, 8), (5, 3, 8)]
    assert [part.ctypes.data % 64 for part in held] == [0, 0, 0]


def too_short(engine, **options):
    mechanism = ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0))
    return ks.solve(mechanism, ANGLES, crank_speed=3.0, engine=engine, **options)


def test_gaps_are_refused_with_the_same_words_or_left_open(interpreted):
    messages = []
    for engine in ("numpy", "compiled"):
        with pytest.raises(ks.AssemblyError) as caught:
            too_short(engine)
        messages.append((str(caught.value), caught.value.intervals))
    assert messages[0] == messages[1]
    assert_same(too_short("compiled", on_gap="nan"), too_short("numpy", on_gap="nan"))


def test_a_limit_position_is_warned_of_with_the_same_words_from_the_same_place(interpreted):
    found = []
    for engine in ("numpy", "compiled"):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ks.solve(ks.crank_slider(0.3, 0.3), [0.2, np.pi / 2], crank_speed=1.0, engine=engine)
        found.append([(item.category, str(item.message), item.filename) for item in caught])
    assert found[0] == found[1]
    assert [(kind, file) for kind, _, file in found[0]] == [(ks.ConditionWarning, __file__)]


@pytest.mark.slow
def test_loops_of_many_outputs_are_vectorised(numba):
    state = ks.load_case("sawframe_2r63").variants["plain"].scene.solve(np.linspace(0.0, 6.0, 3600)).dynamics
    values, leaves = program_of(state, ("O", "A", "B", "guide"))
    bounded = values.bounded()
    assert len(bounded.outputs) > 12
    times = {of: min(seconds(of, state, leaves) for _ in range(20)) for of in (values, bounded)}
    assert times[bounded] < 8.0 * times[values]  # fifteen times, if they are not


def seconds(program, state, leaves):
    begun = perf_counter()
    program.run(state, leaves, compiled=True)
    return perf_counter() - begun


def test_missing_numba_is_said_with_the_way_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba", None)
    with pytest.raises(ks.errors.MissingLibraryError, match=r'pip install "kinetostatics\[fast\]".*engine="numpy"'):
        solve(SCENES["plain"], SAMPLES, engine="compiled")


def test_single_precision_is_refused_by_the_compiled_engine(interpreted):
    with (
        pytest.warns(UserWarning, match="single precision"),
        pytest.raises(ks.ParameterError, match='double precision; use engine="numpy"'),
    ):
        solve(SCENES["plain"], SAMPLES.astype(np.float32), engine="compiled")


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
        yield arithmetic.compensated_sum(a, b, c)
        yield from (2.5 - a, 2.5 / a, a * 0.1)

    with np.errstate(all="ignore"):
        wanted = [operation(one, other) for operation in (add, sub, mul, truediv)]
        wanted += [-one, abs(one), np.sqrt(one), np.copysign(1.0, one), BY_DESIGN["root"](one, other)]
        wanted += [np.where(one < other, other, one), arithmetic.compensated_sum(one, other, more)]
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


@pytest.fixture
def counted():
    calls = []

    @numba_backend.keep_for_same_angles
    def compute(angle):
        calls.append(angle.size)
        return np.sin(angle)

    return compute, calls


def test_equal_angles_are_computed_once_and_others_anew(counted):
    compute, calls = counted
    angle = np.linspace(0.0, 1.0, 5)
    first = compute(angle)
    assert compute(angle.copy()) is first
    assert np.array_equal(compute(angle + 1.0), np.sin(angle + 1.0))
    angle[0] = 9.0
    assert compute(angle)[0] == np.sin(9.0)
    assert calls == [5, 5, 5]


def test_the_same_numbers_in_another_shape_are_others(counted):
    compute, calls = counted
    assert compute(np.zeros(4)).shape == (4,)
    assert compute(np.zeros((2, 2))).shape == (2, 2)
    assert calls == [4, 4]


def test_too_many_are_not_kept_each_thread_has_its_own_and_all_may_be_forgotten(counted):
    compute, calls = counted
    for _ in range(2):
        compute(np.zeros(numba_backend.MAX_KEPT_ANGLES + 1))
    compute(np.zeros(3))
    thread = threading.Thread(target=compute, args=(np.zeros(3),))
    thread.start()
    thread.join()
    numba_backend.forget_angles()
    compute(np.zeros(3))
    assert calls == [numba_backend.MAX_KEPT_ANGLES + 1] * 2 + [3] * 3

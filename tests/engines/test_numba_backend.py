"""Compiled loops: bits, threads, gaps, memory, and reductions by vectors."""

import itertools
import math
import threading
import warnings
from operator import add, mul, neg, sub, truediv

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend, simd_reductions
from kinetostatics.engines.codegen import BY_DESIGN
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program
from kinetostatics.engines.record import Recording
from kinetostatics.numbers import arithmetic
from support import by_arrays
from support.both_engines import ULP, again, assert_same
from support.scenes import (
    ANGLES,
    SAMPLES,
    SCENES,
    SIZES,
    solve,
)


@pytest.mark.slow
def test_threads_do_not_change_machine_code_results(numba, monkeypatch):
    """Of many designs each thread takes some, of a single one some angles."""
    expected = solve(SCENES["plain"], SAMPLES + SIZES), solve(SCENES["plain"], ANGLES)
    alone = [again(s).reaction("O") for s in expected]
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    for s, before in zip(expected, alone, strict=True):
        found = again(s).reaction("O")
        assert np.array_equal(found, before)
        assert np.abs(found - s.reaction("O")).max() <= 8 * ULP * np.abs(before).max()


def test_buffers_are_aligned_for_vector_loads():
    held = [numba_backend.aligned_memory(count, 3, 8) for count in (1, 2, 5)]
    assert [part.shape for part in held] == [(1, 3, 8), (2, 3, 8), (5, 3, 8)]
    assert [part.ctypes.data % 64 for part in held] == [0, 0, 0]


def too_short(engine, **options):
    mechanism = ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0))
    return ks.solve(mechanism, ANGLES, crank_speed=3.0, engine=engine, **options)


def test_gaps_are_refused_alike_or_left_open(interpreted):
    messages = []
    for engine in ("numpy", "compiled"):
        with pytest.raises(ks.AssemblyError) as caught:
            too_short(engine)
        messages.append((str(caught.value), caught.value.intervals))
    assert messages[0] == messages[1]
    assert_same(too_short("compiled", on_gap="nan"), too_short("numpy", on_gap="nan"))


def test_limit_positions_warn_alike_on_both_engines(interpreted):
    found = []
    for engine in ("numpy", "compiled"):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ks.solve(ks.crank_slider(0.3, 0.3), [0.2, np.pi / 2], crank_speed=1.0, engine=engine)
        found.append([(item.category, str(item.message), item.filename) for item in caught])
    assert found[0] == found[1]
    assert [(kind, file) for kind, _, file in found[0]] == [(ks.ConditionWarning, __file__)]


def test_the_compiled_engine_refuses_single_precision(interpreted):
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


@pytest.mark.slow
def test_operations_agree_at_zeros_infs_and_nans(numba):
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


@pytest.mark.slow
def test_scalar_functions_are_those_of_the_library(numba):
    values = np.linspace(-7.0, 7.0, 37)
    found = of_rows(lambda a: (a.sin(), a.cos(), a.arctan()), values[None])
    for row, function in zip(found, (math.sin, math.cos, math.atan), strict=True):
        np.testing.assert_array_max_ulp(row, np.array(list(map(function, values.tolist()))), 1)


@pytest.mark.slow
def test_angle_and_design_counts_do_not_change_bits(numba):
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


def test_equal_angles_are_computed_once(counted):
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


def test_the_cache_is_bounded_per_thread_and_clearable(counted):
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


# Rows looked through in vectors

ROWS = (12, 63, 64, 65, 66, 67, 127, 128, 130, 360, 1441)
SCANS = ("rising", "falling", "negative")


def values_of(size):
    """Waves with plateaus, zeros of both signs, and numbers that are none."""
    found = np.round(5.0 * np.sin(np.arange(size) * 0.7)) * np.random.default_rng(size).choice([1.0, -1.0], size)
    found[7::29] = math.nan
    found[5::31] = -0.0
    return found


def jitted(intrinsic, arguments):
    from numba import njit

    names = ", ".join("abcd"[:arguments])
    scope = {"intrinsic": intrinsic}
    exec(f"def call({names}):\n    return intrinsic({names})", scope)
    return njit(scope["call"])


@pytest.mark.slow
def test_bits_are_set_exactly_where_conditions_hold(numba):
    rising, falling, negative = (getattr(simd_reductions, name) for name in SCANS)
    loops = {
        conditions: (jitted(simd_reductions.bits_of_steps(*conditions), 4), by_arrays.bits_of_steps(*conditions))
        for conditions in ((rising, falling), (negative,))
    }
    for size, (conditions, (own, expected)) in itertools.product(ROWS, loops.items()):
        results = np.zeros((2, 3, size))
        results[1, 2] = values_of(size)
        words, wanted = np.full((2, len(conditions), size // 64 + 1), 2**64 - 1, np.uint64)
        own(results, 1, 2, words)
        expected(results, 1, 2, wanted)
        filled = (size + 63) // 64
        assert wanted[:, :filled].any(axis=1).all()
        assert np.array_equal(words[:, :filled], wanted[:, :filled]), size


def test_what_holds_is_what_reductions_mean():
    values = [0.0, 1.0, 1.0, 0.0, math.nan, -1.0, -0.0, 0.0]
    steps = list(enumerate(zip(values, [*values[1:], values[0]], strict=True)))
    places = {name: [k for k, step in steps if getattr(simd_reductions, name)(*step)] for name in SCANS}
    assert places == {"rising": [0, 3, 4, 5], "falling": [2, 3, 4], "negative": [5]}


@pytest.mark.slow_start
def test_columns_of_a_table_become_a_function_of_them(numba):
    def function(parts, chosen, sqrt):
        one, other, *_ = parts
        return chosen("<", one, other, 2.0 * one, 3.0), sqrt(abs(one - other))

    own, expected = jitted(simd_reductions.over_columns(function, 3), 2), by_arrays.over_columns(function, 3)
    for count in (1, simd_reductions.COLUMNS, simd_reductions.COLUMNS + 1):
        table = np.random.default_rng(count).normal(size=(3, 4 * simd_reductions.COLUMNS))
        found, wanted = table.copy(), table.copy()
        own(found, count)
        expected(wanted, count)
        assert np.array_equal(found[:, :count], wanted[:, :count])
        assert np.array_equal(found[:, count:], table[:, count:])
        assert np.array_equal(found[2], table[2])


@pytest.mark.slow
def test_sums_of_every_other_value_lose_little(numba):
    terms = {"sizes": abs, "squares": lambda value: value * value}
    for name, term in terms.items():
        own = jitted(simd_reductions.summing(term), 3)
        for size in ROWS:
            values = np.random.default_rng(size).normal(size=size)
            wanted = [math.fsum(term(values[first::2]).tolist()) for first in (0, 1)]
            scale = np.abs(term(values)).sum()
            assert np.abs(np.subtract(own(np.array([[0.0 * values, values]]), 0, 1), wanted)).max() < 2e-16 * scale, (
                name,
                size,
            )


@pytest.mark.slow_start
def test_the_lowest_bit_is_found_at_either_end(numba):
    own = jitted(simd_reductions.lowest_bit(), 1)
    for bit in (0, 1, 31, 32, 63):
        assert own(np.uint64(2**63 | 2**bit)) == bit == by_arrays.lowest_bit()(2**63 | 2**bit)

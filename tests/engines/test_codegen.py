"""Generated source: plain numbers, arrays and compiled loops compute the same."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines.codegen import (
    _OPERATIONS,
    ARRAYS,
    BY_DESIGN,
    PLAIN,
    SCALARS,
    buffered_source,
    line_source,
    loop_source,
)
from kinetostatics.engines.graph import Graph
from kinetostatics.engines.program import Program, program_of
from kinetostatics.engines.record import Recording
from kinetostatics.numbers import arithmetic
from kinetostatics.numbers.arithmetic import SQUARE_TOLERANCE
from support.every import every

ANGLE = np.linspace(0.0, 6.0, 9)
S = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), ANGLE, crank_speed=5.0, loads=ks.Gravity())


@pytest.fixture(scope="module")
def recorded():
    return program_of(S.dynamics, ("balancing_torque", "guide_force"), False)


def test_a_line_of_plain_numbers_is_python_and_gives_the_solution(recorded):
    made, leaves = recorded
    scope = {name: getattr(math, name) for name in ("sin", "cos", "sqrt")}
    scope |= {"root": lambda square, unit: math.sqrt(square), "divisor": max}
    exec(line_source(made.outputs), scope)
    for place, angle in enumerate(ANGLE):
        found = scope["line"](angle, math.sin(angle), math.cos(angle), leaves.numbers, ())
        assert found == pytest.approx((S.balancing_torque[place], S.guide_force[place]), rel=1e-13, abs=1e-12)


def test_a_loop_assigns_each_output_its_row_and_a_buffered_line_its_result(recorded):
    made, _ = recorded
    loop, (line, buffers) = loop_source(made.outputs), buffered_source(made.outputs)
    compile(loop, "loop", "exec")
    compile(line, "line", "exec")
    for place, output in enumerate(made.outputs):
        assert f"    v{output.index} = " in loop
        assert f"results[start + uint64({place}) * count + i] = v{output.index}\n" in loop
        assert f"r{place}" in line
    assert 0 < buffers < len(line.splitlines())


def test_an_output_that_is_a_sine_of_the_crank_angle_itself_is_computed_too():
    graph = Graph()
    angle, radius = graph.angle(), graph.parameter(0)
    outputs = angle.sin(), radius * angle.cos(), angle.cos(), angle
    program = Program(Recording((), outputs, (), (), (radius,), (), graph))
    angles = np.linspace(0.0, 6.0, 50)
    found = program.by_numpy(angles, [2.0], (), angles.shape)
    np.testing.assert_array_equal(found, [np.sin(angles), 2.0 * np.cos(angles), np.cos(angles), angles])


@pytest.mark.slow_start
def test_a_total_loses_nothing_in_any_engine():
    pytest.importorskip("numba")
    graph = Graph()
    parts = [graph.parameter(place) for place in range(4)]
    outputs = (arithmetic.compensated_sum(*parts), arithmetic.compensated_sum(parts[0], graph.angle(), -parts[3]))
    values, angles = [0.3, 0.6000000000000001, -0.4, -0.5000000000000001], np.array([0.1, 0.7])
    program = Program(Recording((), outputs, (), (), tuple(parts), (), graph))
    wanted = [[math.fsum(values)] * 2, [math.fsum((0.3, angle, -values[3])) for angle in angles]]
    for compute in (program.by_numpy, program.by_loop):
        np.testing.assert_array_equal(compute(angles, values, (), angles.shape), wanted)


@pytest.mark.slow_start
def test_a_rest_is_the_same_in_any_engine():
    pytest.importorskip("numba")
    graph = Graph()
    x, y, length = parts = [graph.parameter(place) for place in range(3)]
    whole, values = (x * x + y * y).sqrt(), [0.3, 0.4, 0.5000000000000001]
    outputs = (
        arithmetic.length_error(whole, x, y),
        arithmetic.compensated_sum(whole, -length, arithmetic.length_error(whole, x, y)),
    )
    program = Program(Recording((), outputs, (), (), tuple(parts), (), graph))
    least = np.sqrt(0.3 * 0.3 + 0.4 * 0.4)
    lost = arithmetic.length_error(least, 0.3, 0.4)
    for compute in (program.by_numpy, program.by_loop):
        found = compute(np.zeros(1), values, (), (1,))
        np.testing.assert_array_equal(found[:, 0], [lost, math.fsum((least, -values[2], lost))])


VALUES = (-1.0, -SQUARE_TOLERANCE / 2, 0.0, 1e-300, 0.3, 2.0)


@every("name", ["sin", "cos", "atan", "sqrt", "abs", "root", "divisor", "fma", "total"])
def test_plain_numbers_and_arrays_agree(name):
    count = {"root": 1, "divisor": 1, "fma": 2, "total": 3}.get(name, 0)
    with np.errstate(invalid="ignore"):
        arrays = BY_DESIGN[name](np.array(VALUES), *[1.0] * count)
    for value, found in zip(VALUES, arrays, strict=True):
        plain = PLAIN[name](value, *[1.0] * count)
        assert plain == pytest.approx(found, rel=1e-15, abs=0, nan_ok=True)


@every("name", ["sin", "cos", "sqrt", "abs", "root", "divisor", "fma", "total", "lost", "rest", "lost_by_squares"])
def test_numbers_of_numpy_agree_with_arrays_and_stay_so(name):
    count = {"root": 1, "divisor": 1, "fma": 2, "total": 3, "lost": 3, "rest": 2, "lost_by_squares": 2}.get(name, 0)
    given = np.array([0.3, 1e-300, 0.0, -1.0][: 1 if count == 2 else 4]), *[0.7] * count
    with np.errstate(invalid="ignore"):
        arrays = BY_DESIGN[name](*given)
        for value, found in zip(given[0], arrays, strict=True):
            scalar = SCALARS[name](value, *map(np.float64, given[1:]))
            assert type(scalar) is np.float64
            assert scalar == pytest.approx(found, rel=1e-15, abs=1e-33, nan_ok=True)


def test_numbers_of_numpy_tell_squares_that_are_too_small():
    tiny = np.float64(1e-170)
    with np.errstate(under="raise"):
        for name in ("rest", "lost_by_squares"):
            with pytest.raises(FloatingPointError):
                SCALARS[name](tiny, tiny, tiny)


@every("operation", [kind for kind in _OPERATIONS if kind[0] in BY_DESIGN])
def test_memory_given_receives_the_same(operation):
    kind, count = operation
    values, out = np.array(VALUES), np.empty(len(VALUES))
    with np.errstate(invalid="ignore"):
        ARRAYS[_OPERATIONS[operation]](values, *[1.0] * (count - 1), out)
        expected = BY_DESIGN[kind](values, *[1.0] * (count - 1))
    np.testing.assert_array_equal(out, expected)


def test_a_root_forgives_rounding_only():
    assert PLAIN["root"](-SQUARE_TOLERANCE / 2, 1.0) == 0.0
    assert math.isnan(PLAIN["root"](-3 * SQUARE_TOLERANCE, 1.0))


def test_a_total_of_plain_numbers_too_large_is_infinite_or_nothing():
    assert PLAIN["total"](1e308, 1e308, -1.0, 0.0) != PLAIN["total"](1.0, 2.0, 3.0, 4.0) == 10.0
    assert not math.isfinite(PLAIN["total"](math.inf, -math.inf, 0.0, 0.0))

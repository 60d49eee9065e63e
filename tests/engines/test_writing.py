"""Source of programs: every way of writing recorded arithmetic computes the same."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import programs, writing

ANGLE = np.linspace(0.0, 6.0, 9)
S = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(3.0)), ANGLE, crank_speed=5.0, loads=ks.Gravity())


@pytest.fixture(scope="module")
def recorded():
    return programs.of(S.dynamics, ("balancing_torque", "guide_force"), False)


def test_a_line_of_plain_numbers_is_python_and_gives_the_solution(recorded):
    made, leaves = recorded
    scope = {name: getattr(math, name) for name in ("sin", "cos", "sqrt")}
    scope |= {"root": lambda square, unit: math.sqrt(square), "divisor": max}
    exec(writing.line(made.outputs), scope)
    for place, angle in enumerate(ANGLE):
        found = scope["line"](angle, math.sin(angle), math.cos(angle), leaves.numbers, ())
        assert found == pytest.approx((S.balancing_torque[place], S.guide_force[place]), rel=1e-13, abs=1e-12)


def test_a_loop_assigns_each_output_its_row_and_a_buffered_line_its_result(recorded):
    made, _ = recorded
    loop, (line, buffers) = writing.loop(made.outputs), writing.buffered_line(made.outputs)
    compile(loop, "loop", "exec")
    compile(line, "line", "exec")
    for place in range(len(made.outputs)):
        assert f"row_{place}[i] = " in loop
        assert f"r{place}" in line
    assert 0 < buffers < len(line.splitlines())


def test_many_outputs_are_written_in_loops_of_few(recorded):
    made, _ = recorded
    many = [made.outputs[0]] * (2 * writing.ROWS_AT_ONCE + 1)
    assert writing.loop(many).count("for i in range(angle.shape[1])") == 3

"""Programs in two parts: single precision by NumPy and compiled to the same bits, all else computed in double."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.engines.backends import Backend
from kinetostatics.engines.program import program_of
from kinetostatics.engines.split import MixedPrecision
from support.elsewhere import ANGLES, PUMP, diverse
from support.every import every
from support.scenes import SCENES, solve

NUMPY, COMPILED = Backend("numpy", "single"), Backend("compiled", "single")


def made(solution, names):
    return *program_of(solution.dynamics, names), solution.dynamics


def rows(backend, solution, names=("balancing_torque", "O", "A", "slider_acceleration")):
    program, leaves, state = made(solution, names)
    return backend.run(program, state, leaves)


@every("name", diverse())
def test_a_loop_gives_the_bits_of_numpy_in_single_precision(interpreted, name):
    """Programs run by Python as they are written: what numba makes of them is tested below."""
    s = diverse()[name]
    found, same = rows(COMPILED, s), rows(NUMPY, s)
    assert found.dtype == same.dtype == np.float32
    assert found.shape == same.shape == (same.shape[0], *s.shape)
    assert np.array_equal(found, same, equal_nan=True)


@pytest.mark.slow_start
def test_compiled_loops_give_the_bits_of_numpy_in_single_precision(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    s = diverse()["designs"]
    expected = rows(NUMPY, s)
    assert np.array_equal(rows(COMPILED, s), expected)
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    assert np.array_equal(rows(COMPILED, s), expected)
    turn = solve(SCENES["plain"], ANGLES)
    assert np.array_equal(rows(COMPILED, turn), rows(NUMPY, turn))


@every("name", diverse())
def test_single_precision_is_within_its_digits_of_double(name):
    s = diverse()[name]
    program, leaves, state = made(s, ("balancing_torque", "O"))
    exact = program.run(state, leaves)
    found = NUMPY.run(program, state, leaves)
    assert np.max(np.abs(found - exact)) < 3e-6 * np.max(np.abs(exact))
    assert np.max(np.abs(found - exact)) > 1e-9 * np.max(np.abs(exact))


def test_many_turns_cost_single_precision_nothing():
    near = rows(NUMPY, ks.solve(PUMP, ANGLES, crank_speed=100.0))
    far = rows(NUMPY, ks.solve(PUMP, ANGLES + 2e5 * np.pi, crank_speed=100.0))
    assert np.max(np.abs(near - far)) < 2e-6 * np.max(np.abs(near))


def test_what_a_design_fixes_is_computed_in_double():
    """Mass 1 kg + 1e-9 kg of counterweight less 1 kg: in single precision nothing would be left of it."""
    crank = ks.Link(1.0, 1e-9)
    s = ks.solve(ks.crank_slider(0.05, 0.2, crank=crank), ANGLES, crank_speed=100.0, loads=ks.Gravity())
    exact = np.stack(s.reaction("O"))
    assert np.max(np.abs(rows(NUMPY, s, ("O",)) - exact)) < 1e-6 * np.max(np.abs(exact))


def test_all_constants_and_fixed_numbers_are_parameters_of_what_is_left():
    split = MixedPrecision(made(solve(SCENES["plain"], ANGLES), ("balancing_torque",))[0])
    graph = split.at_angles.outputs[0].graph
    assert all(node.varies or node.operation == "parameter" for node in graph)
    arguments = [part for node in graph if node.operation not in ("parameter", "table") for part in node.arguments]
    assert not any(isinstance(part, float) for part in arguments)


@every("backend", [NUMPY, COMPILED])
def test_gaps_of_machines_too_small_for_single_precision_are_gaps(interpreted, backend):
    s = ks.Scene(ks.crank_slider(0.3e-30, 0.25e-30, slider=ks.Link(1.0)), 7.0).solve([0.1, 1.5], on_gap="nan")
    assert np.isnan(s.slider_position).tolist() == [False, True]
    assert np.isnan(rows(backend, s, ("slider_position", "coupler_rate"))).all(), "no sign of a square is known"

"""Backends in single precision and by JAX: shapes, types, errors, and the same bits by NumPy and compiled."""

import pickle
import sys
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import jax_backend, numba_backend
from kinetostatics.engines.jax_backend import Backend, MixedPrecision
from kinetostatics.engines.program import program_of
from support.elsewhere import ANGLES, PUMP, diverse, errors, exact_values
from support.every import every
from support.scenes import SCENES, solve

SINGLE, DOUBLE = Backend("jax", "single", "cpu"), Backend("jax", "double", "cpu")


@pytest.mark.slow
@pytest.mark.slow_start
@every("name", ["designs", "one angle of a table", "designs under a table", "friction", "speeds"])
def test_jax_gives_values_within_their_bounds(jax, name):
    s = diverse()[name]
    program, leaves = program_of(s.dynamics, ("balancing_torque", "O"))
    exact = program.run(s.dynamics, leaves)
    double, single = (backend.run(program, s.dynamics, leaves) for backend in (DOUBLE, SINGLE))
    assert double.dtype == float
    assert single.dtype == np.float32
    assert double.shape == single.shape == exact.shape
    assert np.max(np.abs(double - exact)) < 1e-13 * np.max(np.abs(exact))
    assert np.all(np.abs(single - exact) <= SINGLE.bounds(program, s.dynamics, leaves))


@pytest.mark.slow
def test_jax_keeps_to_its_bounds_in_both_precisions(jax):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    scene = ks.load_case("sawframe_2r63").variants["cam-cosine"].scene
    s = scene.solve(np.linspace(0.01, 6.2, 20))
    for backend, found in errors(s, exact_values(s, ("balancing_torque", "O")), [SINGLE, DOUBLE]).items():
        assert found.values == 60
        assert found.unbounded == 0
        assert found.wrong == [], backend


@pytest.mark.slow
def test_jax_gives_nan_only_where_assembly_is_open(jax):
    short = ks.Scene(ks.crank_slider(0.5, 0.3, slider=ks.Link(1.0)), 1.0, loads=ks.Gravity())
    angles = np.linspace(0.01, 6.2, 40)
    expected = ks.compile(short, ("B", "slider_acceleration"), engine="numpy")(angles)
    for precision in ("single", "double"):
        found = ks.compile(short, ("B", "slider_acceleration"), engine="jax", precision=precision)(angles)
        for name, value in expected.items():
            assert 0 < np.isnan(value).sum() < value.size
            assert np.array_equal(np.isnan(found[name]), np.isnan(value))


@pytest.mark.slow
def test_xla_keeps_quotients_and_roots_as_recorded(jax):
    """Else (a / b) / c becomes a / (b c) and a / sqrt(b) a product, and bounds would be those of other arithmetic."""

    def compute(a, b, c):
        return (a / b) / c, a / (b / c), a / jax.numpy.sqrt(c)

    a, b, c = (np.random.default_rng(seed).uniform(0.5, 2.0, 500).astype(np.float32) for seed in range(3))
    with jax.default_device(jax.devices("cpu")[0]):
        found = jax.jit(compute).lower(a, b, c).compile(compiler_options=jax_backend.AS_WRITTEN)(a, b, c)
    for own, exact in zip(found, ((a / b) / c, a / (b / c), a / np.sqrt(c)), strict=True):
        assert np.array_equal(own, exact)


@pytest.mark.slow
def test_the_mode_of_jax_is_as_it_was(jax):
    before = jax.config.jax_enable_x64
    s = diverse()["plain"]
    program, leaves = program_of(s.dynamics, ("slider_acceleration",))
    for backend in (DOUBLE, SINGLE):
        backend.run(program, s.dynamics, leaves)
        assert jax.config.jax_enable_x64 == before


@pytest.mark.slow
def test_the_device_is_the_first_or_the_one_requested(jax):
    assert jax_backend.device_of() is jax.devices()[0]
    assert jax_backend.device_name(jax_backend.device_of("cpu")) == DOUBLE.device == "cpu"
    assert jax_backend.device_name(SimpleNamespace(platform="gpu", device_kind="NVIDIA X")) == "gpu: NVIDIA X"


def test_a_missing_device_is_refused_with_a_list(jax):
    with pytest.raises(ks.ParameterError, match=r"device 'abacus': JAX finds none, only .*cpu"):
        jax_backend.device_of("abacus")


def test_no_bound_on_a_device_of_untested_functions(jax, monkeypatch):
    s = diverse()["plain"]
    program, leaves = program_of(s.dynamics, ("slider_acceleration",))
    strange = SimpleNamespace(platform="gpu", device_kind="NVIDIA X")
    monkeypatch.setattr(jax_backend, "device_of", lambda platform: strange)
    with pytest.raises(ks.NotGivenError, match=r"no bound can be given on gpu: NVIDIA X.*device=.cpu"):
        Backend("jax", "single").bounds(program, s.dynamics, leaves)


def test_without_jax_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "jax", None)
    with pytest.raises(ks.MissingLibraryError, match=r"pip install .kinetostatics\[grad\]"):
        jax_backend.device_of()


SMALL_PUMP = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))


def state(angles):
    return ks.solve(SMALL_PUMP, angles, crank_speed=100.0).dynamics


@every("precision, dtype", [("double", np.float64), ("single", np.float32)])
@every("angles", [0.3, [0.1, 0.2], np.linspace(0, 6, 40), np.zeros((2, 1, 5))], ids=np.shape)
def test_results_and_bounds_have_the_shape_of_angles(precision, dtype, angles):
    backend = Backend("numpy", precision)
    made, leaves = program_of(state(angles), ("O",))
    found, bounds = backend.run(made, state(angles), leaves), backend.bounds(made, state(angles), leaves)
    assert found.shape == bounds.shape == (2, *np.shape(angles))
    assert (found.dtype, bounds.dtype) == (dtype, float)


def test_double_is_the_program_and_its_bounds():
    solution = ks.solve(SMALL_PUMP, [0.1, 0.2], crank_speed=100.0)
    made, leaves = program_of(solution.dynamics, ("O",))
    backend = Backend("numpy")
    assert backend.is_own
    assert not Backend("numpy", "single").is_own
    assert not Backend("jax").is_own
    assert np.array_equal(backend.run(made, solution.dynamics, leaves), solution.reaction("O"))
    assert np.array_equal(backend.bounds(made, solution.dynamics, leaves), solution.error_bound("O"))


def test_beyond_the_largest_input_there_is_no_bound():
    solution = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(1e31)), [0.1], crank_speed=1.0)
    made, leaves = program_of(solution.dynamics, ("O",))
    assert np.isinf(Backend("numpy").bounds(made, solution.dynamics, leaves)).all()


def test_copies_are_equal():
    backend = Backend("jax", "single", "cpu")
    assert pickle.loads(pickle.dumps(backend)) == backend


NUMPY, COMPILED = Backend("numpy", "single"), Backend("compiled", "single")


def made(solution, names):
    return *program_of(solution.dynamics, names), solution.dynamics


def rows(backend, solution, names=("balancing_torque", "O", "A", "slider_acceleration")):
    program, leaves, state = made(solution, names)
    return backend.run(program, state, leaves)


@pytest.mark.slow
@every("name", [name for name in diverse() if "gas" not in name])
def test_a_loop_gives_numpy_s_bits_in_single(interpreted, name):
    """Programs run by Python as they are written: what numba makes of them is tested below.

    Without gas springs, for exponentials and logarithms of both differ by a rounding.
    """
    s = diverse()[name]
    found, same = rows(COMPILED, s), rows(NUMPY, s)
    assert found.dtype == same.dtype == np.float32
    assert found.shape == same.shape == (same.shape[0], *s.shape)
    assert np.array_equal(found, same, equal_nan=True)


@pytest.mark.slow
def test_compiled_loops_give_numpy_s_bits_in_single(monkeypatch):
    pytest.importorskip("numba", reason="numba is not installed (extra: fast)")
    s = diverse()["designs"]
    expected = rows(NUMPY, s)
    assert np.array_equal(rows(COMPILED, s), expected)
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    assert np.array_equal(rows(COMPILED, s), expected)
    turn = solve(SCENES["plain"], ANGLES)
    assert np.array_equal(rows(COMPILED, turn), rows(NUMPY, turn))


@pytest.mark.slow
@every("name", diverse())
def test_single_agrees_with_double_to_its_digits(name):
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


def test_constants_are_parameters_of_the_remainder():
    split = MixedPrecision(made(solve(SCENES["plain"], ANGLES), ("balancing_torque",))[0])
    graph = split.at_angles.outputs[0].graph
    assert all(node.varies or node.operation == "parameter" for node in graph)
    arguments = [part for node in graph if node.operation not in ("parameter", "table") for part in node.arguments]
    assert not any(isinstance(part, float) for part in arguments)


@every("backend", [NUMPY, COMPILED])
def test_gaps_too_small_for_single_remain_gaps(interpreted, backend):
    s = ks.Scene(ks.crank_slider(0.3e-30, 0.25e-30, slider=ks.Link(1.0)), 7.0).solve([0.1, 1.5], on_gap="nan")
    assert np.isnan(s.slider_position).tolist() == [False, True]
    assert np.isnan(rows(backend, s, ("slider_position", "coupler_rate"))).all(), "no sign of a square is known"

"""Programs by JAX: values of every kind of scene, devices by name, and refusals where there is no JAX or no device."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import jax_backend
from kinetostatics.engines.backends import Backend
from kinetostatics.engines.program import program_of
from support.elsewhere import diverse, errors, exact_values
from support.every import every

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


@pytest.mark.slow_start
def test_jax_keeps_to_its_bounds_in_both_precisions(jax):
    pytest.importorskip("flint", reason="python-flint is not installed (extra: precision)")
    scene = ks.load_case("sawframe_2r63").variants["cam-cosine"].scene
    s = scene.solve(np.linspace(0.01, 6.2, 20))
    for backend, found in errors(s, exact_values(s, ("balancing_torque", "O")), [SINGLE, DOUBLE]).items():
        assert found.values == 60
        assert found.unbounded == 0
        assert found.wrong == [], backend


def test_jax_gives_nan_where_the_mechanism_does_not_close_and_numbers_elsewhere(jax):
    short = ks.Scene(ks.crank_slider(0.5, 0.3, slider=ks.Link(1.0)), 1.0, loads=ks.Gravity())
    angles = np.linspace(0.01, 6.2, 40)
    expected = ks.compile(short, ("B", "slider_acceleration"), engine="numpy")(angles)
    for precision in ("single", "double"):
        found = ks.compile(short, ("B", "slider_acceleration"), engine="jax", precision=precision)(angles)
        for name, value in expected.items():
            assert 0 < np.isnan(value).sum() < value.size
            assert np.array_equal(np.isnan(found[name]), np.isnan(value))


def test_xla_writes_quotients_and_roots_as_they_are_recorded(jax):
    """Else (a / b) / c becomes a / (b c) and a / sqrt(b) a product, and bounds would be those of other arithmetic."""

    def compute(a, b, c):
        return (a / b) / c, a / (b / c), a / jax.numpy.sqrt(c)

    a, b, c = (np.random.default_rng(seed).uniform(0.5, 2.0, 500).astype(np.float32) for seed in range(3))
    with jax.default_device(jax.devices("cpu")[0]):
        found = jax.jit(compute).lower(a, b, c).compile(compiler_options=jax_backend.AS_WRITTEN)(a, b, c)
    for own, exact in zip(found, ((a / b) / c, a / (b / c), a / np.sqrt(c)), strict=True):
        assert np.array_equal(own, exact)


def test_the_mode_of_jax_is_as_it_was(jax):
    before = jax.config.jax_enable_x64
    s = diverse()["plain"]
    program, leaves = program_of(s.dynamics, ("slider_acceleration",))
    for backend in (DOUBLE, SINGLE):
        backend.run(program, s.dynamics, leaves)
        assert jax.config.jax_enable_x64 == before


def test_the_device_is_the_first_that_jax_has_or_the_one_asked_for(jax):
    assert jax_backend.device_of() is jax.devices()[0]
    assert jax_backend.device_name(jax_backend.device_of("cpu")) == DOUBLE.device == "cpu"
    assert jax_backend.device_name(SimpleNamespace(platform="gpu", device_kind="NVIDIA X")) == "gpu: NVIDIA X"


def test_a_device_that_is_not_there_is_refused_with_those_that_are(jax):
    with pytest.raises(ks.ParameterError, match=r"device 'abacus': JAX finds none, only .*cpu"):
        jax_backend.device_of("abacus")


def test_no_bound_is_given_on_a_device_whose_functions_are_not_tested(jax, monkeypatch):
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

"""Load functions without declared kinks: where they are not smooth."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.cycle.kinks import FUNCTION_STEP, FunctionSamples


def places(function):
    load = ks.ProcessForce(function)
    solution = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0)), 0.0, crank_speed=5.0, loads=load)
    return FunctionSamples.of(load, solution).rough_places


@pytest.mark.parametrize(
    "function", [lambda q: 2.0, lambda q: np.sin(30.0 * q.crank_angle), lambda q: q.slider_velocity]
)
def test_smooth_functions_are_not_split(function):
    assert places(function).size == 0


@pytest.mark.parametrize("width", [0.1, 0.6, 90.0])
def test_jumps_lie_between_close_places(width):
    start, stop = 1.0, 1.0 + np.radians(width)
    (found,) = places(lambda q: np.where((q.crank_angle > start) & (q.crank_angle < stop), -1e3, 0.0))
    for jump in (start, stop):
        after = np.searchsorted(found, jump)
        assert 0 < after < found.size
        assert found[after] - found[after - 1] <= 8.0 * FUNCTION_STEP


def test_designs_have_their_own_places():
    mass = np.array([[1.0], [2.0]])
    load = ks.ProcessForce(lambda q: np.where(q.crank_angle > mass, 1.0, 0.0))
    solution = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(mass)), 0.0, crank_speed=5.0, loads=load)
    found = FunctionSamples.of(load, solution).rough_places
    for row, jump in zip(found, mass.ravel(), strict=True):
        assert np.nanmin(np.abs(row - jump)) <= 4.0 * FUNCTION_STEP


def test_noise_is_split_evenly():
    rows = np.linspace(0.0, 2.0 * np.pi, 3600, endpoint=False)
    noise = np.random.default_rng(0).normal(size=rows.size)
    (found,) = places(lambda q: np.interp(q.crank_angle, rows, noise, period=2.0 * np.pi))
    assert np.diff(found).max() <= 4.0 * FUNCTION_STEP * (1.0 + 1e-9)

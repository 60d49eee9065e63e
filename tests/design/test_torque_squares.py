"""Least squares of the torque: near in few steps, from anywhere near, and smooth cams first."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.design.cam_start import Options, begun
from kinetostatics.design.problem import Problem
from kinetostatics.design.torque_squares import least_squares, wave
from support.case_files import shipped

pytestmark = pytest.mark.slow

SAW = shipped("sawframe_2r63")


def search(cosine, sine):
    start = begun(SAW.variant("cam-cosine").scene, Options(cosine, sine))
    return start, Problem(start.machine, start.vary, ["balancing_torque", "slider_position"], None, 360)


def squares(problem, values):
    return np.sqrt(np.mean(problem.curves(values)["balancing_torque"].values ** 2))


@pytest.mark.parametrize("harmonics", [(3, 0), (4, 4), (8, 8)])
def test_least_squares_from_the_studys_cam_within_20_evaluations(harmonics):
    start, problem = search(*harmonics)
    assert_allclose(problem.start[: 1 + harmonics[0]][1], -0.0219, atol=3e-3)
    first = squares(problem, problem.start)
    found = least_squares(problem, start, problem.start)
    assert problem.evaluations <= 20
    assert squares(problem, found) < 0.05 * first


@pytest.mark.parametrize("harmonics", [(4, 4), (8, 8)])
def test_random_starts_reach_the_same_least_squares(harmonics):
    start, problem = search(*harmonics)
    best = squares(problem, least_squares(problem, start, problem.start))
    generator = np.random.default_rng(7)
    starts = [start.random(problem.names, problem.start, generator) for _ in range(6)]
    assert max(abs(values[0] - 0.3) for values in starts) <= 0.03
    ends = [squares(problem, least_squares(problem, start, values)) for values in starts]
    assert np.mean(np.isclose(ends, best, rtol=1e-6)) >= 0.6


def test_smooth_cams_come_first():
    """Waves are counted from the second harmonic on."""
    names = ("cam.cosine.0", "cam.cosine.1", "cam.sine.3", "coupler_length")
    assert [wave(name) for name in names] == [0.0, 0.0, 9.0, 0.0]

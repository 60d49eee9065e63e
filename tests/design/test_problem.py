"""Outputs as functions of the numbers that vary, with their derivatives."""

import numpy as np

from kinetostatics.design.problem import Problem
from support.improved_saws import CIRCLE


def test_derivatives_of_a_design_are_those_of_small_changes():
    problem = Problem(CIRCLE, {"coupler_length": (1.9, 2.1), "slider.mass": (500, 700)}, ["O", "balancing_torque"])
    start = problem.start
    for name in ("O", "balancing_torque"):
        for place, step in enumerate((1e-6, 1e-2)):
            move = step * np.eye(2)[place]
            high, low = (problem.curves(start + side * move)[name][0] for side in (1, -1))
            slopes = problem.curves(start)[name].slopes[place]
            assert np.abs((high - low) / (2 * step) - slopes).max() < 1e-6 * np.abs(slopes).max()

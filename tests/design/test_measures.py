"""Outputs with their derivatives: the same numbers as sweeps, derivatives by small changes."""

import numpy as np
from numpy.testing import assert_allclose

from kinetostatics.design import measures

COUNT = 180
ANGLE = 2 * np.pi * np.arange(COUNT) / COUNT
WAVES = np.array([np.ones(COUNT), np.cos(ANGLE), np.sin(2 * ANGLE), np.cos(3 * ANGLE + 0.4), np.sin(5 * ANGLE)])
POINT = np.array([0.3, 1.0, -0.7, 0.4, 0.2])


def curve(point, shift=0.0):
    return measures.Curve(point @ WAVES + shift, WAVES)


def test_swing_is_the_largest_of_its_parts():
    whole, rises = measures.reduced("swing", curve(POINT), turns=2)
    values, slopes = measures.bounded("swing", curve(POINT), turns=2)
    assert_allclose(values.max(), whole, rtol=1e-12)
    assert_allclose(slopes[:, values.argmax()], rises, rtol=1e-12)
    step = 1e-6
    for place in range(POINT.size):
        move = step * np.eye(POINT.size)[place]
        high, low = (measures.bounded("swing", curve(POINT + side * move), turns=2)[0] for side in (1, -1))
        assert_allclose(slopes[place], (high - low) / (2 * step), rtol=0, atol=2e-7)

"""Derivatives of reductions on pieces, against differences of the reductions themselves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from kinetostatics.cycle.piecewise import Pieces
from kinetostatics.design import measures

TURN = 2 * np.pi
POINT = np.array([0.7, 1.3, 0.4])


def curve(point, vector=False):
    """A curve with a kink that moves with the first number, where it is least; of a vector its magnitude."""
    place, height, more = point
    kinks = np.mod(place + np.array([[0.0, np.pi]]), TURN)
    pieces = Pieces.between(kinks, TURN, TURN / 12, 16)
    angle = pieces.angle
    wave, side = np.sin(angle - place), np.sign(np.sin(angle - place))
    values = height * np.abs(wave) + more * np.cos(2 * angle) - 0.4
    slopes = np.array([-height * side * np.cos(angle - place), np.abs(wave), np.cos(2 * angle)])
    if vector:
        return measures.PiecewiseCurve(*measures.size(np.array([values, 0 * values + 2]), both(slopes)), pieces, True)
    return measures.PiecewiseCurve(values, slopes, pieces)


def both(slopes):
    return np.stack([slopes, 0.0 * slopes], axis=1)


@pytest.mark.parametrize("vector", [False, True])
@pytest.mark.parametrize(
    "reduction",
    ["largest", "smallest", "largest_absolute", "range", "mean", "mean_absolute", "rms", "harmonic_0", "harmonic_2",
     "harmonic_3", "swing"],
)  # fmt: skip
def test_derivatives_equal_differences(reduction, vector):
    _, slopes = measures.reduced(reduction, curve(POINT, vector))
    step = 1e-5
    for number, move in enumerate(step * np.eye(3)):
        high, low = (measures.reduced(reduction, curve(POINT + side * move, vector))[0] for side in (1, -1))
        assert_allclose(slopes[number], (high - low) / (2 * step), rtol=1e-7, atol=1e-8)


@pytest.mark.parametrize("reduction", ["largest", "smallest", "swing"])
def test_the_largest_part_is_the_reduction(reduction):
    values, slopes = measures.bounded(reduction, curve(POINT))
    whole, rises = measures.reduced(reduction, curve(POINT))
    assert_allclose(values.max(), -whole if reduction == "smallest" else whole, rtol=1e-14)
    assert_allclose(slopes[:, values.argmax()], -rises if reduction == "smallest" else rises, rtol=1e-9)


@pytest.mark.slow
def test_largest_values_of_sectors_are_those_of_dense_angles():
    own = curve(POINT)
    found, _ = own.tops(1.0, 72)
    angle = np.linspace(0.0, TURN, 72 * 4000 + 1)
    dense = own.pieces.evaluate(own.pieces.series(own.values), angle)
    truth = [dense[4000 * k : 4000 * (k + 1) + 1].max() for k in range(72)]
    assert_allclose(found, truth, rtol=0, atol=1e-8)

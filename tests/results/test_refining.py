"""Pieces halved until they tell an output: whatever bends on them, and nothing where nothing does."""

import numpy as np
import pytest

from kinetostatics.results.pieces import Pieces
from kinetostatics.results.reductions import parsed
from kinetostatics.results.refining import GOAL, MOST, refined

TURN = 2 * np.pi
PLACE = np.array([[1.2345], [3.2109], [5.0]])


def run(text, function, count=3, vector=False, goal=GOAL, angles=192):
    """Numbers of designs, whether they are rough, and how many pieces each has."""
    output = parsed(text)
    pieces = Pieces.of(np.full((count, 1), np.nan), TURN, angles, output.order or 0)
    values = {output.quantity: function(pieces.angle, np.arange(count))}
    evaluate = lambda designs, angle: {output.quantity: function(angle, designs)}  # noqa: E731
    numbers, rough, pieces_of = np.full(count, np.nan), np.zeros(count, bool), np.zeros(count, int)
    for designs, own, told in refined(pieces, values, [(output, vector)], evaluate, goal):
        numbers[designs], rough[designs] = own.estimated(output, told[output.quantity], vector)
        pieces_of[designs] = (own.width > 0).sum(axis=1)
    return numbers, rough, pieces_of


def hyperbola(width):
    """What friction does where a reaction passes near zero: a size that turns about within so wide an angle."""
    return lambda angle, designs: 1.0 + np.hypot(2.0 * np.sin(0.5 * (angle - PLACE[designs])), width)


@pytest.mark.parametrize("width", [0.0, 1e-9, 1e-6, 1e-4, 1e-2])
@pytest.mark.parametrize("text", ["smallest O", "largest O", "mean O", "smallest_at O", "rms O", "range O"])
def test_a_size_that_passes_near_zero_is_told_however_near(text, width):
    numbers, rough, pieces = run(text, hyperbola(width))
    high, angle = np.hypot(2.0, width), np.linspace(0.0, TURN, 7)
    fine = np.sort(np.concatenate([[0.0], np.ravel([TURN * 2.0**-k for k in range(45)]), angle[1:-1]]))
    share, weights = np.polynomial.legendre.leggauss(40)
    nodes = fine[:-1, None] + 0.5 * np.diff(fine)[:, None] * (1.0 + share)
    values = 1.0 + np.hypot(2.0 * np.sin(0.5 * nodes), width)
    mean, square = (0.5 * np.sum(np.diff(fine) * (part @ weights)) / TURN for part in (values, values**2))
    truth = {
        "smallest O": 1.0 + width,
        "largest O": 1.0 + high,
        "mean O": mean,
        "rms O": np.sqrt(square),
        "range O": high - width,
        "smallest_at O": PLACE[:, 0],
    }[text]
    assert not rough.any()
    np.testing.assert_allclose(numbers, truth, rtol=0, atol=(1e-6 if text.endswith("_at") else 1e-7))
    assert pieces.max() < 150


def test_a_jump_that_nobody_declares_is_told_from_both_sides():
    step = lambda angle, designs: np.where((angle > 1.0) & (angle < PLACE[designs]), 2.0, 0.5)  # noqa: E731
    for text, truth in {"largest O": 2.0, "smallest O": 0.5, "range O": 1.5}.items():
        numbers, rough, _ = run(text, step)
        assert not rough.any()
        np.testing.assert_allclose(numbers, truth, rtol=1e-14)
    numbers, rough, _ = run("mean O", step)
    assert not rough.any()
    np.testing.assert_allclose(numbers, 0.5 + 1.5 * (PLACE[:, 0] - 1.0) / TURN, rtol=0, atol=1e-8)


def test_where_everything_bends_it_is_said():
    rough_one = lambda angle, designs: np.sin(3e5 * angle) + 0.0 * PLACE[designs]  # noqa: E731
    _, rough, pieces = run("mean_absolute O", rough_one)
    _, peak, _ = run("largest O", rough_one)
    assert rough.all()
    assert peak.all()
    assert pieces.max() <= 24 + MOST

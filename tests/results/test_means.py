"""Means over the turn of any functions of the crank angle: smooth, with corners, with jumps, several at once."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.means import (
    NODES,
    _mean_of_absolute_torque,
    closed_turn,
    energy_per_turn,
    mean_absolute_torque,
    mean_absolute_torque_errors,
    means,
)

TURN = ks.solve(ks.crank_slider(0.1, 0.4, slider=ks.Link(1.0)), 0.0, crank_speed=3.0).sampled
WHOLE = 2 * np.pi

FUNCTIONS = {
    "power": (lambda x: x**3, WHOLE**3 / 4),
    "sine": (np.sin, 0.0),
    "corner": (lambda x: np.abs(np.sin(x - 0.123)), 2 / np.pi),
    "root": (lambda x: np.sqrt(np.abs(x - 1.0)), (2 / 3 * (1 + (WHOLE - 1) ** 1.5)) / WHOLE),
    "jump": (lambda x: np.where(x > 1.2345, 2.0, -1.0), 2.0 - 3.0 * 1.2345 / WHOLE),
    "peak": (lambda x: 1e-4 / ((x - 2.0) ** 2 + 1e-8), (np.arctan(2e4) + np.arctan((WHOLE - 2) * 1e4)) / WHOLE),
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_mean_is_that_of_calculus(name):
    function, expected = FUNCTIONS[name]
    found, error = means(lambda x: function(x)[None], TURN, 1e-14)
    assert found[0] == pytest.approx(expected, rel=1e-11, abs=1e-14)
    assert error[0] < 1e-10


@pytest.mark.parametrize("of", [mean_absolute_torque, energy_per_turn])
def test_jamming_leaves_no_mean(of):
    solution = ks.solve(
        ks.crank_slider(0.1, 0.13, slider=ks.Link(3.0)), 0.3, crank_speed=3.0, friction={"guide": ks.GuideFriction(0.9)}
    )
    with pytest.raises(ks.JammingError, match="friction jams at") as caught:
        of(solution)
    assert caught.value.angles
    assert "on_gap" not in str(caught.value)


def test_errors_of_a_mean_are_rounding_and_quadrature():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    s = ks.solve(saw, 8, crank_speed=33.5, loads=[ks.Gravity()])
    rounding, quadrature = mean_absolute_torque_errors(s)
    mean = mean_absolute_torque(s)
    assert 0 < rounding < 1e-13 * mean
    assert 0 <= quadrature < 1e-12 * mean
    assert ks.compare(s, s).mean_torque_errors[0] == (rounding, quadrature)


def _exact_rule():
    """Nodes and weights of Gauss's quadrature on the unit panel, by Legendre's polynomial in 40 digits."""
    mp = pytest.importorskip("mpmath")
    with mp.workdps(40):
        legendre = partial(mp.legendre, NODES.size)
        roots = sorted(mp.polyroots(mp.taylor(legendre, 0, NODES.size)[::-1], maxsteps=200, extraprec=200))
        slopes = [mp.diff(legendre, x) for x in roots]
        return [(1 + x) / 2 for x in roots], [
            1 / ((1 - x * x) * slope**2) for x, slope in zip(roots, slopes, strict=True)
        ]


def test_rounding_bound_of_a_mean_is_near():
    """The torque of a Scotch yoke is m r^2 omega^2 sin 2 phi / 2; the sum of its nodes is taken in 40 digits."""
    mp = pytest.importorskip("mpmath")
    s = ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 0.0, crank_speed=7.0)
    mean, _, _, (start, width) = _mean_of_absolute_torque(closed_turn(s, "mean torque"))
    _, weights = _exact_rule()
    angle = start[:, None] + width[:, None] * NODES
    with mp.workdps(40):
        size = mp.mpf(0.1) ** 2 * 3 * 49 / 2
        total = mp.mpf(0)
        for row, breadth in zip(angle.tolist(), width.tolist(), strict=True):
            parts = (weight * abs(mp.sin(2 * mp.mpf(x))) for x, weight in zip(row, weights, strict=True))
            total += mp.mpf(breadth) * mp.fsum(parts)
        error = abs(mp.mpf(mean) - size * total / mp.mpf(s.period))
    rounding = mean_absolute_torque_errors(s).rounding
    assert mean == mean_absolute_torque(s)
    assert 0 < error <= rounding < 5e-15 * mean


def test_unbounded_torque_has_infinite_mean(monkeypatch):
    s = ks.solve(ks.scotch_yoke(0.1, slider=ks.Link(3.0)), 0.0, crank_speed=7.0)
    found = ks.extremes(s, "balancing_torque")
    growing = replace(found, value=np.where(found.maximum, np.inf, found.value))
    monkeypatch.setattr("kinetostatics.results.means.extrema", lambda *_: growing)
    with pytest.warns(ks.ConditionWarning, match="grows without bound"):
        assert mean_absolute_torque(s) == np.inf
    assert mean_absolute_torque_errors(s) == (np.inf, np.inf)

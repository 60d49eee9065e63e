"""Friction laws of a part together: closed forms of one and two, and how far they are from jamming."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinetostatics.mechanics.friction_laws import Channel, Law
from kinetostatics.mechanics.friction_system import System

PASSES = 6


def system(factors, free, columns, kinds=None):
    """Laws that watch ``free + columns amounts``, each acting by a channel of its own, one way."""
    names = [f"channel {number}" for number in range(len(factors))]
    kinds = kinds or ["size"] * len(factors)

    def watched(place):
        return lambda found: (found.values[place],)

    laws = [
        Law(name, factor, watched(place), kind, ((Channel(name), 1),))
        for place, (name, factor, kind) in enumerate(zip(names, factors, kinds, strict=True))
    ]
    of = [SimpleNamespace(values=values) for values in (free, *np.transpose(columns).tolist())]
    return System(laws, names, of[0], of[1:])


@pytest.mark.parametrize(("load", "kappa"), [(3.0, 0.4), (-3.0, 0.4), (3.0, -0.4), (-3.0, -0.4)])
def test_one_force_is_its_closed_form(load, kappa):
    """N = N0 + kappa mu |N|."""
    made = system([0.5], [load], [[kappa]])
    (amount,) = made.solved(PASSES, 0.0)
    normal = load / (1.0 - 0.5 * kappa * np.sign(load))
    assert amount == pytest.approx(0.5 * abs(normal), rel=1e-15)
    assert made.margin == pytest.approx(0.8)
    assert made.residual < 1e-15


def test_two_forces_that_feed_each_other_satisfy_their_laws():
    columns, free, factors = np.array([[0.2, -0.5], [0.7, 0.1]]), np.array([4.0, -7.0]), np.array([0.3, 0.2])
    found = np.array(system(factors.tolist(), free.tolist(), columns).solved(PASSES, 0.0))
    np.testing.assert_allclose(found, factors * np.abs(free + columns @ found), rtol=1e-15)


@pytest.mark.parametrize(("kappa", "jams"), [(0.99, False), (1.01, True)])
def test_it_jams_where_feedback_reaches_one(kappa, jams):
    made = system([1.0], [3.0], [[kappa]])
    with np.errstate(invalid="ignore"):
        (amount,) = made.solved(PASSES, 0.0)
    assert (made.margin < 0.0) == jams
    assert np.isnan(amount) == jams


def test_without_feedback_friction_is_found_at_once():
    made = system([0.5, 0.25], [3.0, -2.0], [[None, None], [None, None]])
    assert made.margin is None
    assert made.solved(PASSES, 0.0) == [1.5, 0.5]

"""Friction of one pair, and the equations of all friction of a part: closed forms, directions, kinks, jamming."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinetostatics.mechanics.friction import (
    Channel,
    FrictionEquations,
    FrictionLaw,
    direction_of,
    kink_functions,
    larger,
    size_of,
    smaller,
)

PASSES = 6
PARTS = [(3.0, -4.0), (-3.0, None), (None, 2.0), (-1.0, 0.5), (2.0, 2.5)]
SIZES = {"length": np.hypot, "larger": lambda a, b: max(abs(a), abs(b))}


@pytest.mark.parametrize("parts", PARTS)
@pytest.mark.parametrize("kind", SIZES)
def test_factor_times_direction_times_parts(kind, parts):
    law = FrictionLaw("B", 0.3, None, kind, ())
    size = SIZES[kind](*(0.0 if part is None else part for part in parts))
    assert size_of(kind, parts) == pytest.approx(size, rel=1e-15)
    along = zip(direction_of(law, parts), parts, strict=True)
    assert sum(one * other for one, other in along if other is not None) == pytest.approx(0.3 * size, rel=1e-15)


def test_a_number_has_its_size_or_is_itself():
    assert size_of("size", (-2.0,)) == 2.0
    assert size_of("itself", (-2.0,)) == -2.0
    assert direction_of(FrictionLaw("B", 0.3, None, "itself", ()), (-2.0,)) == (0.3,)
    assert direction_of(FrictionLaw("B", 0.3, None, "size", ()), (-2.0,)) == (-0.3,)
    assert size_of("length", (None, None)) is None


def test_kinks_lie_where_a_size_or_the_larger_changes():
    assert kink_functions("size", (-2.0,)) == [-2.0]
    assert kink_functions("length", (3.0, 4.0)) == []
    assert kink_functions("larger", (3.0, -4.0)) == [3.0, -4.0, -1.0]


def test_larger_and_smaller_are_those_of_two():
    assert (larger(2.0, -3.0), smaller(2.0, -3.0)) == (2.0, -3.0)


def equations(factors, free, columns, kinds=None):
    """Laws whose reactions are ``free + columns amounts``, each with a channel of its own, one way."""
    names = [f"channel {number}" for number in range(len(factors))]
    kinds = kinds or ["size"] * len(factors)

    def reaction(place):
        return lambda found: (found.values[place],)

    laws = [
        FrictionLaw(name, factor, reaction(place), kind, ((Channel(name), 1),))
        for place, (name, factor, kind) in enumerate(zip(names, factors, kinds, strict=True))
    ]
    of = [SimpleNamespace(values=values) for values in (free, *np.transpose(columns).tolist())]
    return FrictionEquations(laws, names, of[0], of[1:])


@pytest.mark.parametrize(("load", "kappa"), [(3.0, 0.4), (-3.0, 0.4), (3.0, -0.4), (-3.0, -0.4)])
def test_one_force_is_its_closed_form(load, kappa):
    """N = N0 + kappa mu |N|."""
    made = equations([0.5], [load], [[kappa]])
    (amount,) = made.solve(PASSES, 0.0)
    normal = load / (1.0 - 0.5 * kappa * np.sign(load))
    assert amount == pytest.approx(0.5 * abs(normal), rel=1e-15)
    assert made.margin == pytest.approx(0.8)
    assert made.residual < 1e-15


def test_coupled_friction_forces_satisfy_their_laws():
    columns, free, factors = np.array([[0.2, -0.5], [0.7, 0.1]]), np.array([4.0, -7.0]), np.array([0.3, 0.2])
    found = np.array(equations(factors.tolist(), free.tolist(), columns).solve(PASSES, 0.0))
    np.testing.assert_allclose(found, factors * np.abs(free + columns @ found), rtol=1e-15)


@pytest.mark.parametrize(("kappa", "jams"), [(0.99, False), (1.01, True)])
def test_it_jams_where_feedback_reaches_one(kappa, jams):
    made = equations([1.0], [3.0], [[kappa]])
    with np.errstate(invalid="ignore"):
        (amount,) = made.solve(PASSES, 0.0)
    assert (made.margin < 0.0) == jams
    assert np.isnan(amount) == jams


def test_without_feedback_friction_is_found_at_once():
    made = equations([0.5, 0.25], [3.0, -2.0], [[None, None], [None, None]])
    assert made.margin is None
    assert made.solve(PASSES, 0.0) == [1.5, 0.5]

"""Places where methods may fail: each is a family of scenes that leads toward it."""

from dataclasses import replace

import numpy as np
import pytest

from kinetostatics.mechanics.quantities import components
from kinetostatics.numbers.arithmetic import UNIT_ROUNDOFF
from kinetostatics.studies import stability
from kinetostatics.studies.precision import METHODS
from kinetostatics.studies.stability import PLACES
from support.bounded import errors
from support.every import every
from support.inclined import INCLINED

DIGITS = 0.05
"""Largest share of a result that one rounding of the crank angle may make, so that it has digits."""
BOUND, MEETING = 200, 20_000
"""How many times what that makes bounds may be, and where A meets O2: a link's direction is bounded across it as along.
"""


@every("place", PLACES, ids=lambda place: place.name)
def test_every_place_has_a_scene_of_one_design(place):
    for number in (place.numbers[0], place.numbers[-1]):
        solution = place.scene(number)
        assert solution.shape == solution.crank_angle.shape
        assert np.isfinite(solution.crank_angle).all()
        assert place.quantity in (*solution.reactions, *solution.scalars, "slider_position", "balancing_torque")


def test_names_are_told_apart_and_axes_have_units():
    assert len({place.name for place in PLACES}) == len(PLACES)
    assert all(place.axis.endswith("]") for place in PLACES)


FOLDING = [
    place
    for place in PLACES
    if place.name in ("four-bar change point", "rhombus", "kite", "coupler as long as the crank")
    or place.name in ("kite, A passing O2", "parallelogram, folded", "four-bar that only just turns")
]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::kinetostatics.ConditionWarning")
@every("place", FOLDING, ids=lambda place: place.name)
@every("tight", [False, True])
def test_bounds_hold_near_aligned_links(place, tight):
    for number in place.numbers[:-2:3]:
        solution = place.scene(number)
        bound, size = solution.error_bound(place.quantity, tight), np.abs(components(solution, place.quantity)).max()
        assert np.max(bound) < 4e-14 * size, number


@pytest.mark.slow
@every("place", INCLINED, ids=lambda place: place.name)
def test_inclined_twins_are_as_near_as_rounding(flint, place):
    rows = stability.study([replace(place, numbers=place.numbers[::3])], METHODS[:1])
    counted = rows[rows["angle rounding"] < DIGITS]
    assert len(counted) >= 3
    assert np.all(counted["error"] <= 30 * (UNIT_ROUNDOFF + counted["angle rounding"]))
    most = MEETING if place.name in (f"{name}, inclined" for name in ("rhombus", "kite, A passing O2")) else BOUND
    assert np.all(counted["bound"] <= most * (20 * UNIT_ROUNDOFF + counted["angle rounding"]))
    assert not rows[["lost", "flipped", "nan"]].any(axis=None)
    assert set(rows["raised"]) == {""}


@pytest.mark.slow
@every("place", INCLINED, ids=lambda place: place.name)
def test_inclined_twin_values_stay_in_bounds(flint, place):
    for number in place.numbers[::5]:
        found = errors(place.scene(number), (place.quantity, "balancing_torque_by_power"))
        assert found.values > 20
        assert found.wrong == []

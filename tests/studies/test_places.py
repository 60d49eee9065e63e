"""Places where methods may fail: each is a family of scenes that leads toward it."""

from dataclasses import replace

import numpy as np
import pytest

from kinetostatics.numbers.elementary import UNIT
from kinetostatics.studies import stability
from kinetostatics.studies.methods import METHODS
from kinetostatics.studies.places import PLACES
from support.bounded import errors
from support.every import every
from support.inclined import INCLINED

DIGITS = 0.05
"""Largest share of a result that one rounding of the crank angle may make, so that it has digits."""


@pytest.mark.parametrize("place", PLACES, ids=lambda place: place.name)
def test_every_number_of_a_place_has_a_scene_of_one_design_with_its_quantity(place):
    for number in (place.numbers[0], place.numbers[-1]):
        solution = place.scene(number)
        assert solution.shape == solution.crank_angle.shape
        assert np.isfinite(solution.crank_angle).all()
        assert place.quantity in (*solution.reactions, *solution.scalars, "slider_position", "balancing_torque")


def test_names_are_told_apart_and_axes_have_units():
    assert len({place.name for place in PLACES}) == len(PLACES)
    assert all(place.axis.endswith("]") for place in PLACES)


@pytest.mark.slow
@every("place", INCLINED, ids=lambda place: place.name)
def test_inclined_twins_of_places_are_as_near_as_the_crank_angle_allows(flint, place):
    rows = stability.study([replace(place, numbers=place.numbers[::3])], METHODS[:1])
    counted = rows[rows["angle rounding"] < DIGITS]
    assert len(counted) >= 3
    assert np.all(counted["error"] <= 30 * (UNIT + counted["angle rounding"]))
    assert not rows[["lost", "flipped", "nan"]].any(axis=None)
    assert set(rows["raised"]) == {""}


@every("place", INCLINED, ids=lambda place: place.name)
def test_no_value_of_an_inclined_twin_is_off_by_more_than_its_bound(flint, place):
    for number in place.numbers[::5]:
        found = errors(place.scene(number), (place.quantity, "balancing_torque_by_power"))
        assert found.values > 20
        assert found.wrong == []

"""Places where methods may fail: each is a family of scenes that leads toward it."""

import numpy as np
import pytest

from kinetostatics.studies.places import PLACES


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

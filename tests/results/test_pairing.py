"""Which extrema of two mechanisms belong together."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinetostatics.results.extremes import Extremes
from kinetostatics.results.pairing import chosen, counted, of_partners, partners

TURN = 2 * np.pi


def extrema(*places, turns=1, value=None):
    """Extrema at these degrees, maxima if positive in sign of `+0.5`."""
    angle, maximum = np.array([abs(place) for place in places], dtype=float), np.array([place > 0 for place in places])
    solution = SimpleNamespace(period=turns * TURN)
    value = np.where(maximum, 1.0, -1.0) if value is None else np.array(value)
    return Extremes("torque", np.radians(angle), value, maximum, solution=solution)


@pytest.mark.parametrize(
    ("reference", "balanced", "found"),
    [
        ((10, -100, 190, -280), (20, -110, 200, -290), [0, 1, 2, 3]),
        ((10, -100, 190, -280), (-10, 100, -190, 280), [1, 0, 3, 2]),  # reversed: a quarter of a turn apart
        ((350, -100), (10, -110), [0, 1]),  # nearest is across 0
        ((10, -100), (-10, 200), [-1, 0]),  # within a third of a turn
        ((10, -60, 100, -300), (90, -300), [-1, -1, 0, 1]),  # each belongs to one
        ((10,), (185, -20), [-1]),
        ((10, 100), (100, 200), [-1, 0]),  # what is near stays together
        ((), (10, -20), []),
        ((10, -20), (), [-1, -1]),
    ],
)
def test_extrema_of_one_kind_that_are_near_belong_together_each_to_one(reference, balanced, found):
    assert partners(extrema(*reference), extrema(*balanced)).tolist() == found


def test_a_turn_is_compared_with_each_of_two():
    one, two = extrema(90, -270), extrema(90, -270, 450, -630, turns=2)
    assert partners(two, one).tolist() == [0, 1, 0, 1]
    assert sorted(partners(one, two).tolist()) in ([0, 1], [0, 3], [1, 2], [2, 3])


def test_what_has_no_partner_has_no_value():
    assert np.array_equal(of_partners(np.array([1, -1, 0]), np.array([5.0, 7.0])), [7.0, np.nan, 5.0], equal_nan=True)


def test_the_two_sides_of_a_jump_on_a_flank_do_not_count():
    found = extrema(10, -180, 180, -270, value=[5.0, 1.0, 2.0, -5.0])
    assert counted(found).tolist() == [True, False, False, True]
    assert chosen(found, counted(found)).value.tolist() == [5.0, -5.0]
    peak = extrema(10, -180, 180, -270, value=[5.0, 1.0, 7.0, -5.0])
    assert counted(peak).all()

"""Sign changes of functions over a period."""

from types import SimpleNamespace

import numpy as np
import pytest

from kinetostatics.machine.links import Joint
from kinetostatics.machine.loads.table_pieces import stops_and_crossings
from kinetostatics.numbers.sign_changes import sign_changes

TURN = 2 * np.pi


@pytest.mark.parametrize("depth", [1e-4, 1e-6, 1e-9])
def test_two_changes_between_two_samples_are_found(depth):
    """A function that barely passes zero and turns back within half a degree."""
    place = np.array([[2.0012], [3.0034]])
    angle = sign_changes(lambda angle: [1.0 - depth - np.cos(angle - place)], TURN, 180).angle
    half = np.arccos(1.0 - depth)
    np.testing.assert_allclose(angle, np.column_stack([place - half, place + half]), rtol=0, atol=1e-7)


def test_a_slider_that_turns_back_and_forth_between_two_samples_stops_twice():
    place, half = 2.0012, 1e-3

    def moved(angle):
        rate = (1.0 + np.cos(angle)) * (np.cos(half) - np.cos(angle - place)) + 1e-30
        return SimpleNamespace(travels={"slider": Joint(np.sin(angle), rate, None)})

    mechanism = SimpleNamespace(turns=1, place=moved)
    stops, _ = stops_and_crossings(SimpleNamespace(mechanism=mechanism), "slider", np.zeros(1))
    np.testing.assert_allclose(np.sort(stops[0]), [place - half, place + half], rtol=0, atol=1e-9)


def test_functions_and_axes_of_designs_are_independent():
    shift = np.array([[[0.2], [0.9]], [[1.7], [6.1]], [[3.0], [4.0]]])
    found = sign_changes(lambda angle: [np.sin(angle - shift), np.cos(angle)], TURN, 90)
    assert found.angle.shape == found.row.shape == (3, 2, 4)
    assert found.values.shape == (2, 3, 2, 91)
    for place in np.ndindex(3, 2):
        own = np.sort(np.mod(shift[place] + [0.0, np.pi], TURN))
        np.testing.assert_allclose(np.sort(found.angle[place][found.row[place] == 0]), own, rtol=0, atol=1e-14)
        np.testing.assert_allclose(
            np.sort(found.angle[place][found.row[place] == 1]), [np.pi / 2, 3 * np.pi / 2], rtol=0, atol=1e-14
        )


def test_no_function_has_no_changes():
    assert sign_changes(lambda angle: [], TURN, 720).angle.shape == (1, 0)

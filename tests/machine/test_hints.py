"""Hints: what looks like degrees for radians, or kilograms for grams, is said and computed all the same."""

import warnings

import numpy as np
import pytest

import kinetostatics as ks

AROUND = 2 * np.pi * np.arange(72) / 72
ROD = ks.Link(2.0, (0.2, 0.05), 0.03)


def mechanism(**changes):
    values = {"crank_length": 0.1, "coupler_length": 0.4, "coupler": ROD, "slider": ks.Link(3.0)} | changes
    return ks.crank_slider(**values)


def solve(made=None, angle=AROUND, **changes):
    return ks.solve(made or mechanism(), angle, **{"crank_speed": 5.0, "loads": ks.Gravity()} | changes)


@pytest.mark.parametrize(
    "angles",
    [
        np.arange(0, 360, 5),
        np.arange(0, 360, 10.0),
        np.linspace(0, 360, 73),
        np.linspace(0, 360, 720, endpoint=False),
        np.arange(-180, 181, 1),
        np.arange(360, -1, -1),
        [0, 90, 180, 270],
        np.linspace(0, 720, 145),
    ],
)
def test_angles_in_degrees_are_hinted_at(angles):
    with pytest.warns(ks.HintWarning, match="look like degrees; they are taken as radians") as caught:
        solve(angle=angles)
    assert [item.filename for item in caught] == [__file__]


@pytest.mark.parametrize(
    "angles",
    [
        AROUND,
        10 * AROUND,
        np.arange(7.0),
        np.arange(0, 100, 0.1),
        np.linspace(0, 50, 101),
        100.0,
        [3.0, 90.0],
        AROUND - 100,
    ],
)
def test_angles_in_radians_are_not(angles):
    with warnings.catch_warnings():
        warnings.simplefilter("error", ks.HintWarning)
        solve(angle=angles, on_gap="nan")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"coupler": ks.Link(2.0, 200.0)}, r"coupler.centre.along is 200 m, 500 times the longest link .*mm\?"),
        ({"slider": ks.Link(2.0, (0.0, 9.0))}, "slider.centre.across is 9 m"),
        ({"coupler": ks.Link(150.0, 0.2, 1e-3)}, "inertia of the coupler, 0.001 kg m2, is less than a thousandth"),
        ({"coupler": ks.Link(np.array([[1.0], [150.0]]), 0.2, 1e-3)}, "inertia of the coupler"),
        ({"coupler": ks.Link(1.0, np.array([[1.0], [150.0]]))}, "coupler.centre.along is 150 m"),
    ],
)
def test_solve_hints_at_unit_slips_in_links(changes, words):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        made = mechanism(**changes)
    with pytest.warns(ks.HintWarning, match=words):
        solve(made)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ks.HintWarning)
        solve(made)

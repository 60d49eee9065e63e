"""Mechanisms, their builders, and hints on values in other units."""

import warnings
from dataclasses import dataclass

import numpy as np
import pytest

import kinetostatics as ks
from support.every import every


def two_sliders(*labels):
    """A crank that drives a slider of each label."""
    sliders = (ks.SliderGroup(0.4, ks.Guide.at(turn), pin=f"B{turn}", label=label) for turn, label in enumerate(labels))
    return ks.solve(ks.Mechanism("engine", ks.Crank(0.1), tuple(sliders)), ANGLES_OF_SLIDERS, crank_speed=5.0)


ANGLES_OF_SLIDERS = np.linspace(0.1, 6.0, 5)


@every("labels, meant", [(("2",), "slider2"), (("", "2"), "slider"), (("2", ""), "slider")])
def test_single_or_unlabelled_slider_needs_no_name(labels, meant):
    s = two_sliders(*labels)
    assert np.array_equal(s.slider_position, s.travel(meant))
    assert np.array_equal(s.slider_velocity, s.travel_velocity(meant))
    assert np.array_equal(s.slider_acceleration, s.travel_acceleration(meant))
    assert np.array_equal(s.elongation(0.2), s.elongation(0.2, meant))


def test_one_of_several_sliders_must_be_named():
    with pytest.raises(
        ks.QuantityError, match=r'engine has 2 sliders, slider1, slider2; choose one, .*travel\("slider1"\)'
    ):
        two_sliders("1", "2").slider_position  # noqa: B018
    with pytest.raises(ks.QuantityError, match="four-bar has no slider"):
        ks.solve(ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), 0.1, crank_speed=1.0).slider_velocity  # noqa: B018


# Names in a chain of parts


def test_a_repeated_group_is_told_briefly():
    """Links that two groups share are named; what follows from their names is not told too, and the remedy once."""
    with pytest.raises(ks.ParameterError) as told:
        ks.Mechanism("twice", ks.Crank(0.1), (ks.SliderGroup(0.5), ks.SliderGroup(0.5, on="A", pin="D")))
    text = str(told.value)
    assert "adds link 'coupler' a second time" in text
    assert "coupler_rate" not in text
    assert "slider_position" not in text
    assert text.count("give the second group another pin, pivot_name or label") == 1
    assert text.endswith("label")


# The crank, and what is derived from it


@dataclass(frozen=True, eq=False)
class Forgetful(ks.Crank):
    """A crank that leaves out the torque it declares."""

    def resolve(self, placement, loads, along):
        """All but the torque."""
        return super().resolve(placement, loads, along)._replace(scalars={})


def test_derived_crank_is_checked():
    groups = (ks.SliderGroup(2.0, slider=ks.Link(600.0)),)
    assert ks.Mechanism("own", ks.Crank(0.3), groups).trusted
    own = ks.Mechanism("own", Forgetful(0.3), groups)
    assert not own.trusted
    with pytest.raises(ks.ParameterError, match=r"Forgetful declares .*'balancing_torque', but does not resolve it"):
        ks.solve(own, np.linspace(0.0, 6.0, 8), crank_speed=30.0).balancing_torque  # noqa: B018


# Builders

TURN = np.linspace(0.0, 2 * np.pi, 9)
LINKS = {name: ks.Link(mass, (0.1, 0.01), 0.2) for mass, name in enumerate(("crank", "coupler", "slider"), 1)}
MADE = {
    "crank-slider": (
        ks.crank_slider(0.1, 0.4, guide_angle=0.2, guide_offset=0.02, assembly=-1, **LINKS),
        ks.Crank(0.1, LINKS["crank"]),
        ks.SliderGroup(0.4, ks.Guide.at(0.2, 0.02), -1, LINKS["coupler"], LINKS["slider"]),
    ),
    "four-bar": (
        ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1), assembly=-1, rocker=LINKS["slider"]),
        ks.Crank(0.1),
        ks.RockerGroup(0.4, 0.3, (0.35, 0.1), -1, rocker=LINKS["slider"]),
    ),
}


@every("name", MADE)
def test_a_mechanism_of_everyday_is_crank_and_group(name):
    made, crank, group = MADE[name]
    found, expected = (
        ks.solve(item, TURN, crank_speed=5.0, crank_acceleration=2.0, loads=ks.Gravity())
        for item in (made, ks.Mechanism(name, crank, (group,)))
    )
    assert np.array_equal(found.balancing_torque, expected.balancing_torque)
    assert list(found.reactions) == list(expected.reactions)


def test_a_guide_may_be_given_in_place_of_its_numbers():
    whole, parts = (
        ks.solve(ks.crank_slider(0.1, 0.4, **guide), TURN, crank_speed=1.0).position("B")
        for guide in ({"guide": ks.Guide.at(0.2, 0.02)}, {"guide_angle": 0.2, "guide_offset": 0.02})
    )
    assert np.array_equal(whole, parts)


def test_a_yoke_follows_the_cosine():
    yoke = ks.scotch_yoke(0.1, slider=ks.Link(3.0))
    found = ks.solve(yoke, TURN, crank_speed=7.0)
    assert found.slider_acceleration == pytest.approx(-0.1 * 49.0 * np.cos(TURN), abs=1e-14)


# Hints

AROUND = 2 * np.pi * np.arange(72) / 72
ROD = ks.Link(2.0, (0.2, 0.05), 0.03)


def mechanism(**changes):
    values = {"crank_length": 0.1, "coupler_length": 0.4, "coupler": ROD, "slider": ks.Link(3.0)} | changes
    return ks.crank_slider(**values)


def solve(made=None, angle=AROUND, **changes):
    return ks.solve(made or mechanism(), angle, **{"crank_speed": 5.0, "loads": ks.Gravity()} | changes)


@every(
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
    with pytest.warns(ks.HintWarning, match="look like degrees; they are used as radians") as caught:
        solve(angle=angles)
    assert [item.filename for item in caught] == [__file__]


@every(
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


@every(
    "changes, words",
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

"""Builders: mechanisms of everyday as one would make them of crank and groups."""

import numpy as np
import pytest

import kinetostatics as ks

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


@pytest.mark.parametrize("name", MADE)
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

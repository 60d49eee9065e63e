"""Pairs of links that rub, as a mechanism completes them."""

import pytest

import kinetostatics as ks
from kinetostatics.machine.pairs import Rolling, Sliding, Turning

SAW = ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.02, 0.0)), 2.0)
ROCKER = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.0))


@pytest.mark.parametrize(
    ("mechanism", "name", "pair"),
    [
        (SAW, "O", Turning("crank", "O", "frame")),
        (SAW, "B", Turning("slider", "B", "coupler")),
        (SAW, "guide", Sliding("slider", "B", "frame", "guide_force", "guide_moment")),
        (SAW, "cam", Rolling("block", "A", "cam_force")),
        (ROCKER, "A", Turning("coupler", "A", "crank")),
        (ROCKER, "O2", Turning("rocker", "O2", "frame")),
    ],
)
def test_a_pin_is_fixed_to_the_link_that_owns_its_joint(mechanism, name, pair):
    assert mechanism.pairs[name] == pair


def test_what_is_one_rigid_triangle_does_not_turn_against_itself():
    parts = ks.Pin("crank", (0.2, 0.1), "P"), ks.Dyad(0.1, 0.2, on=("A", "P"), pin="D")
    made = ks.Mechanism("chain", ks.Crank(0.1), parts)
    assert {name: pair.link == pair.against for name, pair in made.pairs.items() if name != "O"} == dict.fromkeys(
        (name for name in made.pairs if name != "O"), True
    )

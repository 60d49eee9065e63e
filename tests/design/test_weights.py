"""What carries the weight that a symmetric cam cannot."""

import pytest

import kinetostatics as ks
from support.shipped import shipped

pytestmark = pytest.mark.slow

SAW, MOWER = shipped("sawframe_2r63"), shipped("mower_drive")
RATIO = "ratio mean_absolute balancing_torque"
PEAK, SQUARES = "largest_absolute balancing_torque", "rms balancing_torque"


def test_ways_to_carry_the_weight_are_told_with_their_prices():
    table = ks.design.weight_options(SAW, 3)
    ratios = table[f"{RATIO} [1]"]
    assert ratios["symmetric"] < table.loc["symmetric", "bound"] < ratios["sine terms"] < ratios["coupler spring"]
    assert table["largest O [N]"].idxmax() == "counterweight"
    assert table["largest_absolute guide_moment [N m]"].idxmax() == "coupler spring"

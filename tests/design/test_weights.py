"""What carries the weight that a symmetric cam cannot."""

import pytest

import kinetostatics as ks
from support.case_files import shipped
from support.every import every

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


@every("machine", [
    ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1)), ks.scotch_yoke(0.1), ks.slotted_lever(0.1, pivot=(0.0, -0.2)),
    ks.crank_slider(0.1, 0.4, assembly=-1),
])  # fmt: skip
def test_other_machines_than_crank_sliders_are_refused_in_words(machine):
    with pytest.raises(ks.ParameterError, match="takes a crank-slider, plain or with a cam, whose slider"):
        ks.design.weight_options(ks.Scene(machine, 1.0), 2)

"""States of links beside those of joints, guides and slots: each comparison of a right group, and what it sees."""

import numpy as np
import pytest

import kinetostatics as ks

NAMES = {
    "slider": (ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1)), "acceleration of B as a point of slider"),
    "travel": (ks.SliderGroup(0.5, ks.Guide.at(0.3, 0.1)), "acceleration of the travel of slider"),
    "rocker": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "acceleration of B by coupler"),
    "frame": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "velocity of O2 as a point of the frame"),
    "swing": (ks.RockerGroup(0.4, 0.3, (0.35, 0.1)), "centre and radius of the swing of B"),
    "slot": (ks.LeverGroup((0.1, -0.3), offset=0.05), "distance of A from the slot of lever"),
    "sliding": (ks.LeverGroup((0.1, -0.3), offset=0.05), "moment of sliding of slot"),
    "rod": (ks.CylinderGroup((0.3, -0.4)), "direction of rod along cylinder"),
    "pin": (ks.Pin(on="coupler", at=(0.1, 0.2), name="C"), "acceleration of C as a point of coupler"),
}


@pytest.mark.parametrize("name", NAMES)
def test_each_comparison_is_made_and_holds_to_rounding(name):
    group, what = NAMES[name]
    assert ks.check(group).errors[what] < 1e-12


def test_an_acceleration_of_another_sign_is_named_once_for_each_thing_it_disagrees_with():
    class Own(ks.SliderGroup):
        """A slider group whose link says that it is slowed down where it is driven."""

        def place(self, placement):
            """Place, and turn an acceleration round."""
            super().place(placement)
            motion = placement.links["slider"]
            joint = motion.joint._replace(second=tuple(-part for part in motion.joint.second))
            placement.links["slider"] = motion._replace(joint=joint)

    wrong = {what for what, error in ks.check(Own(0.5)).errors.items() if error > 1e-6}
    assert {"acceleration of B as a point of slider", "acceleration of the travel of slider"} <= wrong
    assert np.all(["B" in what or "slider" in what for what in wrong])

"""The table of true extremes: each beside its crank angle, rounding as zero."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.tables import extremes_frame

YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))


def test_extremes_stand_beside_their_crank_angles():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    row = table.loc["slider acceleration"]
    assert row["unit"] == "m/s2"
    assert row[["smallest", "smallest at [deg]", "largest", "largest at [deg]"]].tolist() == pytest.approx(
        [-10.0, 0.0, 10.0, 180.0], abs=1e-6
    )


def test_what_is_rounding_stands_as_zero():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    assert (table.loc["guide force", ["smallest", "largest"]] == 0.0).all()

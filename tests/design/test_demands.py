"""Texts of what is asked of a design."""

import numpy as np
import pytest

from kinetostatics.design.demands import demand
from support.improved_saws import CIRCLE, RATIO


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("largest O <= 0.75 kN", ("<=", 750.0)),
        ("largest O ≤ 750 N", ("<=", 750.0)),
        ("  smallest cam_force >= -2 kN ", (">=", -2000.0)),
        ("largest slider_position == 2300 mm", ("=", 2.3)),
        ("largest_absolute pressure_angle <= 30 deg", ("<=", np.pi / 6)),
        (f"{RATIO} >= 50", (">=", 50.0)),
    ],
)
def test_limits_are_read_with_their_units(text, expected):
    found = demand(text, CIRCLE.scene)
    assert (found.relation, found.value) == (expected[0], pytest.approx(expected[1], rel=1e-15))

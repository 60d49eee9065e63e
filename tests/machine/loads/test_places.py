"""Places at which loads act."""

import numpy as np
import pytest

import kinetostatics as ks
from support.machines import largest

CRANK, COUPLER = 0.1, 0.4
PUMP = ks.crank_slider(CRANK, COUPLER)
"""Its slider pin passes 0.4 m on its way and stops at 0.5 and 0.3 m."""


def test_a_coupler_curve_is_the_position_of_a_place_on_the_coupler():
    s = ks.solve(PUMP, [0.3, 2.0], crank_speed=9.0)
    for order in ("position", "velocity", "acceleration"):
        ask = getattr(s, order)
        assert largest(ask(("coupler", COUPLER)) - ask("B")) < 1e-13 * max(1.0, largest(ask("B")))
        assert np.array_equal(ask(("crank", CRANK, 0.0)), ask("A"))
    assert s.position((0.2, -0.1)).tolist() == [[0.2, 0.2], [-0.1, -0.1]]
    assert not s.velocity((0.2, -0.1)).any()
    with pytest.raises(ks.ParameterError, match="point must be a joint"):
        s.position((1.0, 2.0, 3.0))
    with pytest.raises(ks.QuantityError, match="'couplr', allowed: 'crank', 'coupler'"):
        s.position(("couplr", 0.1))


def test_a_pivot_stands_for_the_link_that_turns_about_it_and_a_fixed_point_for_the_frame():
    bar = ks.four_bar(0.1, 0.4, 0.3, rocker_pivot=(0.35, 0.1))
    on_rocker, on_frame = (
        ks.solve(bar, [0.7], crank_speed=1.0, loads=ks.Force(5.0, at=at)) for at in ("O2", (0.35, 0.1))
    )
    assert on_rocker.reaction("O2")[:, 0].tolist() == [-5.0, 0.0]
    assert not on_frame.reaction("O2").any()

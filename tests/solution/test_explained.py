"""The door to hand calculations on a solution."""

import pytest

import kinetostatics as ks


def test_a_solution_tells_the_value_it_gives():
    s = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0).solve([0.5])
    assert float(s.explain("balancing_torque", 0.5).value) == pytest.approx(s.balancing_torque[0], rel=1e-14)

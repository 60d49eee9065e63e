"""Slider group: closed forms of the crank-slider, in either assembly."""

import numpy as np
import pytest

import kinetostatics as ks

TURN = np.linspace(0.05, 2 * np.pi, 25)
CRANK, L, E = 0.1, 0.4, 0.03


@pytest.mark.parametrize("assembly", [1, -1])
def test_position_and_velocity_are_the_closed_form(assembly):
    s = ks.solve(ks.crank_slider(CRANK, L, guide_offset=E, assembly=assembly), TURN, crank_speed=3.0)
    root = np.sqrt(L**2 - (E - CRANK * np.sin(TURN)) ** 2)
    assert s.slider_position == pytest.approx(CRANK * np.cos(TURN) + assembly * root, rel=1e-14)
    slope = -CRANK * np.sin(TURN) + assembly * (E - CRANK * np.sin(TURN)) * CRANK * np.cos(TURN) / root
    assert s.slider_velocity == pytest.approx(3.0 * slope, abs=1e-14)


def test_a_massless_coupler_is_a_two_force_member():
    s = ks.solve(ks.crank_slider(CRANK, L, slider=ks.Link(2.0)), TURN, crank_speed=30.0, loads=ks.Gravity())
    rod, force = s.position("B") - s.position("A"), s.reaction("B")
    assert np.abs(rod[0] * force[1] - rod[1] * force[0]).max() < 1e-13 * np.abs(force).max()
    assert s.guide_force - 2.0 * 9.81 == pytest.approx(force[1] * np.sign(force[1] * (s.guide_force - 19.62)), abs=1e-9)


def test_short_coupler_is_refused_with_its_intervals():
    with pytest.raises(ks.AssemblyError) as caught:
        ks.solve(ks.crank_slider(0.4, 0.3), TURN, crank_speed=1.0)
    assert caught.value.intervals[0][1] == pytest.approx(np.pi - np.arcsin(0.75), abs=1e-12)

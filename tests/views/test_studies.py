"""Figures of the studies: what their curves hold, and what they are refused."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views.peaks import with_peaks

UNIT = ks.linkage.chain_unit(0.1, 1.0, 0.5)


def test_motion_of_the_chain_unit_is_relative_to_the_speed_and_counted_in_the_sense_of_the_crank(axes):
    for speed in (1.0, 7.0, -7.0):
        for order in (1, 2):
            ks.plots.chain_unit_motion(ks.Scene(UNIT, speed).solve(90), "rocker", order, ax=axes)
    first, second, *others = (line.get_ydata() for line in axes.lines if len(line.get_ydata()) > 2)
    for number, curve in enumerate(others):
        sense = -1 if number == 3 else 1  # as fast either way round; the acceleration points the other way then
        np.testing.assert_allclose(sense * curve, (first, second)[number % 2], atol=1e-12)


def test_motion_relative_to_a_crank_at_rest_is_refused(axes):
    with pytest.raises(ks.ParameterError, match="the crank speed of rocker rate is 0"):
        ks.plots.chain_unit_motion(ks.Scene(UNIT, 0.0).solve(8), "rocker", ax=axes)


def test_shaking_force_is_as_long_as_it_is_large_in_its_own_direction():
    s = ks.Scene(ks.crank_slider(0.04, 0.3, slider=ks.Link(5.0)), 60.0).solve(90)
    ax = ks.plots.shaking_force(s)
    s = with_peaks({"": s}, "shaking_force")[""]
    angle, size = ax.lines[0].get_data()
    x, y = s.shaking_force
    np.testing.assert_allclose(size[:-1] * np.cos(angle[:-1]) * np.hypot(x, y).max() / size.max(), x, atol=1e-9)

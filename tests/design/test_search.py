"""The search itself: several starts, and demands that cannot be met."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.design import search
from kinetostatics.design.demands import Demand
from kinetostatics.results.reductions import parsed
from support.improved_saws import RATIO, SAW, SPRING, TORQUE

pytestmark = pytest.mark.slow


def test_several_starts_reach_the_same_design_and_the_seed_repeats_them():
    one, other = (
        ks.design.optimise(SAW, SPRING, TORQUE, variant="cam-circle", starts=4, seed=3, angles=360) for _ in range(2)
    )
    assert one.starts == other.starts
    assert_allclose(one.starts, one.starts[0], rtol=1e-6)


def test_demands_end_with_how_near_the_best_comes():
    with pytest.raises(ks.DesignError, match=r"nearest misses ratio .* >= 100, where it comes to 52\.8") as error:
        ks.design.optimise(SAW, SPRING, TORQUE, limits=f"{RATIO} >= 100", variant="cam-circle", angles=180)
    assert set(error.value.values) == {"spring.stiffness"}


def test_a_machine_that_cannot_be_built_within_the_bounds_is_said():
    pump = ks.Scene(ks.crank_slider(0.1, 0.3, slider=ks.Link(1.0)), 10.0)
    with pytest.raises(ks.DesignError, match="no design that can be built"):
        ks.design.optimise(pump, {"coupler_length": (0.05, 0.09)}, "largest O", angles=90)


class Circle:
    """Numbers within bounds, and by how much the sum of their squares exceeds a limit."""

    def __init__(self, high):
        self.low, self.high = np.zeros(2), np.array(high)

    def output(self, output, values):
        """The sum of squares, and its derivatives."""
        return float(values @ values), 2.0 * values


LIMIT = Demand(parsed("mean_absolute balancing_torque"), "<=", 1.0)


def test_what_a_search_misses_by_little_is_made_good_by_the_least_change():
    values = search.restored(Circle([2.0, 2.0]), [LIMIT], np.array([0.6, 0.8]) * (1.0 + 1e-6))
    assert_allclose(values, [0.6, 0.8], rtol=1e-12)
    kept = np.array([0.3, 0.4])
    assert search.restored(Circle([2.0, 2.0]), [LIMIT], kept) is kept


def test_what_is_made_good_stays_within_its_bounds():
    level = Demand(LIMIT.output, "=", 1.0)
    values = search.restored(Circle([0.6, 2.0]), [level], np.array([0.6, 0.8 - 1e-6]))
    assert_allclose(values, [0.6, 0.8], rtol=1e-12)
    assert values[0] <= 0.6


def test_what_has_no_derivatives_is_not_made_good():
    class Corner(Circle):
        def output(self, output, values):
            found, slopes = super().output(output, values)
            return found, np.nan * slopes

    missed = np.array([0.6, 0.8]) * (1.0 + 1e-6)
    assert search.restored(Corner([2.0, 2.0]), [LIMIT], missed) is missed

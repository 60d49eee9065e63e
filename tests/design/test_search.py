"""The search itself: several starts, and demands that cannot be met."""

import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
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

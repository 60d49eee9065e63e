"""Counterweights found by search: the optimum of the true norm, over all that the motion takes."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.balancing import Counterweight, optimal, partial
from support.balanced import mower


@pytest.mark.slow
@pytest.mark.parametrize("norm", ["largest", "along"])
def test_optimum_is_that_of_the_true_extreme_not_of_a_grid(norm):
    """A finer grid to begin with changes nothing, and no classical ratio is better."""
    found = [optimal(mower(), norm, angles=angles, crank=Counterweight(arm=0.035)) for angles in (72, 720)]

    def peak(balanced):
        s = ks.solve(balanced.mechanism, [0.0], crank_speed=1.0)
        return abs(ks.extremes(s, "shaking_force" if norm == "largest" else lambda s: s.shaking_force[0]).largest)

    coarse, fine = map(peak, found)
    assert coarse == pytest.approx(fine, rel=1e-7)
    for ratio in ("across", "along", "overall"):
        assert fine <= peak(partial(mower(), ratio, crank=Counterweight(mass=5.0))) * (1 + 1e-9)


@pytest.mark.parametrize("norm", ["mean", "weighted"])
def test_the_norm_is_taken_over_both_turns_of_a_branch_that_closes_after_two(norm):
    links = {name: ks.Link(2.0, (0.1, side)) for name, side in [("crank", 0.03), ("coupler", 0.08), ("rocker", -0.05)]}
    passing = ks.four_bar(0.1, 0.3, 0.2, rocker_pivot=(0.4, 0.0), assembly="open", **links)
    found = optimal(passing, norm, crank=Counterweight(arm=0.1)).mechanism.links["crank"]
    before, after = (link.mass * np.array(link.centre) for link in (links["crank"], found))

    def size(share):
        """Of the shaking force over both turns, with so much of the counterweight found."""
        unbalance = before + share * (after - before)
        weighted = passing.with_link("crank", ks.Link(1.0, tuple(unbalance)))
        force = np.hypot(*ks.Scene(weighted, 1.0).solve(720).shaking_force)
        return np.mean(force if norm == "mean" else force**2)

    assert passing.turns == 2
    assert size(1.0) < min(size(0.99), size(1.01))

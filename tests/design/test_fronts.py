"""Fronts of two outputs: ends are the best of each alone, between them none is better in both."""

import numpy as np
import pytest

import kinetostatics as ks
from support.improved_saws import FORCE, FRONT_OF, RATIO, SAW, front


def test_no_design_of_a_front_is_better_in_both():
    force, ratio = (front().table[f"{name} [{unit}]"].to_numpy() for name, unit in ((FORCE, "N"), (RATIO, "1")))
    assert np.all(np.diff(force) > 0)
    assert np.all(np.diff(ratio) > 0)


def test_ends_are_the_best_of_each_output_alone():
    least = ks.design.optimise(SAW, FRONT_OF, FORCE, variant="cam-circle", angles=180)
    greatest = ks.design.optimise(SAW, FRONT_OF, maximise=RATIO, variant="cam-circle", angles=180)
    assert front().table.iloc[0, 0] == pytest.approx(least.report().iloc[0]["after"], rel=1e-6)
    assert front().table.iloc[-1, 1] == pytest.approx(greatest.report().iloc[0]["after"], rel=1e-6)

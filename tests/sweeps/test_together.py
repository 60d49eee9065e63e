"""Designs as one batch: the same numbers whoever comes with them."""

import numpy as np
import pandas as pd
import pytest

from kinetostatics.sweeps.sweeps import FAILED
from support import factories
from support.factories import DESIGNS, OUTPUTS
from support.sweeping import SAW, assert_equal, rising, sweep


def test_a_function_of_plain_numbers_is_called_for_each_design():
    found = sweep(factories.by_plain_numbers, DESIGNS, OUTPUTS, angles=36)
    pd.testing.assert_frame_equal(found, sweep(factories.pump, DESIGNS, OUTPUTS, angles=36), rtol=1e-14)


def test_a_batch_of_another_shape_is_refused():
    made = lambda crank, mass: factories.pump(np.full((3, 1), 0.1), 1.0)  # noqa: E731
    found = sweep(made, DESIGNS[:2], OUTPUTS, angles=36)
    assert found[FAILED].str.contains("arrays must have the shape (designs, 1)", regex=False).all()


@pytest.mark.slow
@pytest.mark.parametrize("engine", ["numpy", "compiled"])
def test_it_does_not_matter_which_designs_come_together(interpreted, engine):
    outputs = ["harmonic_2 O", "mean O", "rms O", "largest_at O", "smallest balancing_torque"]
    options = {"variant": "cam-circle", "angles": 12, "engine": engine}
    found = [sweep(SAW, rising(60), outputs, chunk=chunk, **options) for chunk in (1, 7, 10_000)]
    assert_equal(found[0], found[2])
    assert_equal(found[1], found[2])

"""How numbers spread: what is refused, and weights of ordered samples."""

import numpy as np
import pytest

from kinetostatics.design.spread import harrell_davis


def test_weights_of_ordered_samples_sum_to_one_and_estimate_the_quantile():
    weights = harrell_davis(0.05, 4096)
    assert weights.sum() == pytest.approx(1.0, abs=1e-12)
    assert weights @ np.linspace(0, 1, 4096) == pytest.approx(0.05, abs=1e-3)

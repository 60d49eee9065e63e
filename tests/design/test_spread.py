"""How numbers spread: what is refused, and weights of ordered samples."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.spread import deviations, harrell_davis
from kinetostatics.errors import ParameterError
from support.every import every

TOLD = {"slider.mass": "normal 0 % +- 1 %", "crank_length": "-1..1 mm"}


def test_weights_of_ordered_samples_sum_to_one_and_estimate_the_quantile():
    weights = harrell_davis(0.05, 4096)
    assert weights.sum() == pytest.approx(1.0, abs=1e-12)
    assert weights @ np.linspace(0, 1, 4096) == pytest.approx(0.05, abs=1e-3)


def test_deviations_are_the_same_whatever_the_design_and_know_their_units():
    spread = ks.design.Spread(0.05, TOLD, samples=64)
    shares, found = deviations(spread, {"slider.mass": "kg", "crank_length": "m"}, 64)
    assert shares == {"slider.mass"}
    assert np.abs(found["crank_length"]).max() <= 1e-3
    assert found["slider.mass"].std() == pytest.approx(0.01, rel=0.2)
    _, again = deviations(spread, {"slider.mass": "kg", "crank_length": "m"}, 64)
    np.testing.assert_array_equal(found["slider.mass"], again["slider.mass"])


@every(
    "options, message",
    [
        ({"quantile": 1.5}, "between 0 and 1"),
        ({"spreads": {}}, "dict of path to text"),
        ({"samples": 100}, "power of two"),
        ({"trim": -0.1}, "trim"),
        ({"seed": "x"}, "seed"),
    ],
)
def test_what_is_no_spread_is_refused(options, message):
    with pytest.raises(ParameterError, match=message):
        ks.design.Spread(**{"quantile": 0.05, "spreads": TOLD} | options)

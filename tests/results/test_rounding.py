"""What of a table is rounding: relative to the terms of each machine, never by a size of its own."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.rounding import without_rounding, zeroed

YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))


@pytest.mark.parametrize("speed", [10.0, 1e-6])
def test_small_values_are_0_beside_the_terms_of_their_machine_only(speed):
    """The inertia force of the slider is 3 kg x 0.1 m x speed^2: 30 N, and 3e-13 N in a machine that creeps."""
    solution = ks.solve(YOKE, np.linspace(0, 6, 24), crank_speed=speed)
    force = 0.3 * speed**2
    values = [1e-10 * force, 1e-15 * force, -1e-15 * force]
    assert without_rounding(solution, "guide_force", values).tolist() == [1e-10 * force, 0.0, 0.0]
    assert ks.extremes(solution, "O").largest == pytest.approx(force)


def test_nan_stays():
    assert np.isnan(zeroed([np.nan], 1.0)).all()

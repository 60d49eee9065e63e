"""Formulas as the studies print them: coefficients, extrema, and the sign that is wrong."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.mechanics.quantities import magnitude
from support.sawframe_study import CANCELLED, CIRCLE, COLUMNS, COSINE, PLAIN, PUBLISHED

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("column", COLUMNS)
def test_coefficients_of_each_reading_of_the_study(column):
    s, extremum_ratios, mean_ratio, reaction_ratio, cam_force = COLUMNS[column]
    found = ks.compare(PLAIN, s)
    np.testing.assert_allclose(found.torque_extremum_ratios, extremum_ratios, rtol=0, atol=5.1e-4)
    assert found.mean_torque_ratio == pytest.approx(mean_ratio, abs=5.1e-4)
    assert found.peak_reaction_ratio("O") == pytest.approx(reaction_ratio, abs=5.1e-3)
    assert found.cam_force_range()[1][1] == pytest.approx(1e3 * cam_force, abs=5.1)


def test_extrema_as_printed_lie_at_48_137_224_and_311_degrees_from_the_outer_dead_centre():
    found = ks.extremes(COLUMNS["as printed"][0], "balancing_torque")
    np.testing.assert_allclose(np.degrees(found.angle), [48, 137, 224, 311], atol=0.6)
    assert CIRCLE.at(np.zeros(1)).slider_position[0] == pytest.approx(ks.extremes(CIRCLE, "slider_position").largest)


def test_published_coefficients_follow_from_the_printed_sign_within_0_7_percent_and_from_no_right_one():
    def errors(s):
        found = ks.compare(PLAIN, s)
        pairs = zip(
            [*found.torque_extremum_ratios, found.mean_torque_ratio], [*PUBLISHED["n_d"], PUBLISHED["k_d"]], strict=True
        )
        return [abs(ratio / printed - 1) for ratio, printed in pairs]

    assert max(errors(COLUMNS["as printed"][0])) < 0.007
    assert ks.compare(PLAIN, COLUMNS["as printed"][0]).peak_reaction_ratio("O") == pytest.approx(
        PUBLISHED["O"], abs=0.5
    )
    for right in (CANCELLED, CIRCLE, COSINE):
        assert max(errors(right)[:4]) > 0.18


@pytest.mark.parametrize("column", ["as printed", "right sign", "linear spring"])
def test_coupler_inertia_force_has_four_extrema_a_cycle_in_every_reading(column):
    """The study counts three: its fourth lies at 0 = 360 degrees, on the edge of the chart."""
    found = ks.extremes(COLUMNS[column][0], lambda s: magnitude(s.inertia_force("coupler")))
    angles = (np.degrees(found.angle) + 1) % 360 - 1
    np.testing.assert_allclose(np.sort(angles), [0, 90.1, 180, 269.9], atol=0.05)
    np.testing.assert_allclose(found.range, [25.33e3, 53.86e3], atol=5.1)

"""Bounds as users have them: of magnitudes, and infinite where none is proven."""

import numpy as np

from kinetostatics.engines.error_bounds import of_magnitude, where_known


def test_the_bound_of_a_magnitude_covers_the_errors_of_its_components_and_its_own_rounding():
    rng = np.random.default_rng(3)
    values, bounds = rng.normal(size=(2, 200)), 1e-9 * rng.random((2, 200))
    off = np.abs(np.hypot(*(values + bounds)) - np.hypot(*values))
    assert np.all(off <= of_magnitude(values, bounds))
    assert np.all(of_magnitude(values, 0.0 * bounds) > 0.0)


def test_a_bound_that_is_none_is_infinite_and_that_of_a_gap_is_none():
    bounds = where_known(np.array([1.0, 2.0, np.nan]), np.array([0.1, np.nan, 0.1]))
    np.testing.assert_array_equal(bounds, [0.1, np.inf, np.nan])


def test_a_value_too_large_for_a_double_has_no_bound():
    assert where_known(np.array([1.0, np.inf, np.nan]), np.array([0.5, 0.5, 0.5])).tolist()[:2] == [0.5, np.inf]

"""The table of true extremes: each beside its crank angle, rounding as zero."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.tables import extremes_by_name, extremes_frame, frames

YOKE = ks.scotch_yoke(0.1, slider=ks.Link(3.0))


def test_extremes_stand_beside_their_crank_angles():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    row = table.loc["slider acceleration"]
    assert row["unit"] == "m/s2"
    assert row[["smallest", "smallest at [deg]", "largest", "largest at [deg]"]].tolist() == pytest.approx(
        [-10.0, 0.0, 10.0, 180.0], abs=1e-6
    )


def test_what_is_rounding_stands_as_zero():
    table = extremes_frame(ks.solve(YOKE, np.zeros(1), crank_speed=10.0))
    assert (table.loc["guide force", ["smallest", "largest"]] == 0.0).all()


def test_the_tables_of_values_and_of_bounds_have_the_same_rows_and_columns():
    saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    solution = ks.solve(saw, 0.0, crank_speed=33.5)
    values, bounds = frames(extremes_by_name(solution))
    assert values.equals(extremes_frame(solution))
    assert (values.index.equals(bounds.index), list(values)) == (True, list(bounds))
    assert bounds["largest at [deg]"].isna().all()
    largest = ks.extremes(solution, "balancing_torque").error_bound.max()
    assert bounds.loc["balancing torque", "largest"] == pytest.approx(largest, rel=1e-12, abs=0.0)
    proven = bounds["largest"].notna()
    assert proven.sum() > 10
    assert (bounds["largest"][proven] < 1e-11 * values["largest"][proven].abs() + 1e-9).all()

"""The table of balanced variants: masses, arms and forces as `report` and `extremes` tell them."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.design.balancing_table import balancing_table
from support.case_files import shipped

CASE = shipped("mower_drive")
NAME = next(name for name, variant in CASE.variants.items() if variant.balanced is not None)
BALANCED = CASE.variants[NAME].balanced


@pytest.fixture(scope="module")
def solutions():
    return CASE.solve(CASE.reference, 36), CASE.solve(NAME, 36)


def test_rows_are_those_of_the_report_in_millimetres(solutions):
    table = balancing_table(solutions[0], {NAME: (BALANCED, solutions[1])})
    for link, row in BALANCED.report().iterrows():
        column = table[f"{NAME} {link}"]
        assert column["counterweight arm [mm]"] == pytest.approx(1e3 * row["counterweight arm [m]"], abs=1e-8)
        assert column["counterweight mass [kg]"] == pytest.approx(row["counterweight mass [kg]"], abs=1e-8)


def test_the_largest_force_is_the_true_extreme_and_that_of_a_grid_is_no_larger(solutions):
    table = balancing_table(solutions[0], {NAME: (BALANCED, solutions[1])}, sampling=np.radians(5.0))
    first = table.iloc[:, 0]
    largest = ks.extremes(solutions[1], "shaking_force").range[1]
    assert first["largest |F| [N]"] == pytest.approx(largest, rel=1e-9)
    assert first["largest |F| on the study's grid [N]"] <= largest * (1 + 1e-12)
    assert (
        "largest |F| on the study's grid [N]"
        not in balancing_table(solutions[0], {NAME: (BALANCED, solutions[1])}).index
    )

"""Spreads as texts: what each form means, and all that cannot be read told at once."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.numbers import spreads
from support.every import every


def test_each_form_is_the_distribution_it_names():
    found = spreads.distributions(
        {"a": "600..900 kN/m", "b": "normal 712 kN/m +- 5 kN/m", "c": "triangular 690..710..740 kN/m"}
    )
    middles = [distribution.mean() for distribution, unit in found.values() if unit == "kN/m"]
    np.testing.assert_allclose(middles, [750.0, 712.0, (690 + 710 + 740) / 3], rtol=1e-12)


@every("reader", [spreads.parse_grid, spreads.parse_spread])
@every("given", ["70..85:10", "70 .. 85", "uniform 70..85", "triangular 70..80..85", "normal 80 +- 2"])
def test_numbers_without_a_unit_are_said_to_have_none(reader, given):
    with pytest.raises(ks.ParameterError, match=r'it has no unit \("1" where there is none\); write "600'):
        spreads.read_spreads({"crank_length": given}, reader)


@every("given", [[70, 85], (0.07, 0.085, 10), np.linspace(0.07, 0.085, 3), ["70 mm", "85 mm"]])
def test_bare_numbers_name_the_allowed_forms(given):
    with pytest.raises(ks.ParameterError, match=r'each with its unit; write "600\.\.900 kN/m:40" for a grid'):
        spreads.read_spreads({"crank_length": given}, spreads.parse_grid)


@every(
    "given",
    ["600..900 kN/m", "normal 712 kN/m +- 5 kN/m", *(f"triangular 69..{mode}..78 kN/m" for mode in (69, 71, 76))],
)
def test_median_and_deviation_are_those_of_the_distribution(given):
    spread = spreads.parse_spread(given)
    assert spread.median == pytest.approx(spread.distribution.median(), rel=1e-14)
    assert spread.deviation == pytest.approx(spread.distribution.std(), rel=1e-14)

"""Numbers and units as a reader wants them."""

import math

from kinetostatics.views.report.words import angle, number, pretty
from support.every import every


@every("value, text", [(286771.94, "286772"), (math.inf, "∞"), (-math.inf, "-∞"), (math.nan, ""), ("word", "word")])
def test_a_number_is_that_of_all_tables_with_a_sign_for_infinity(value, text):
    assert number(value) == text


@every("unit, text", [
    ("N m", "N·m"), ("kg m2", "kg·m²"), ("kg m^2", "kg·m²"), ("m/s2", "m/s²"), ("rad/s", "rad/s"), ("deg", "°"),
    ("1", ""), ("", ""),
    ("N/m**3", "N/m³"),
])  # fmt: skip
def test_units_have_raised_exponents_and_dots(unit, text):
    assert pretty(unit) == text


def test_an_angle_of_rounding_is_zero():
    assert angle(1.1e-13) == angle(-1e-9) == "0.00"
    assert angle(math.nan) == ""

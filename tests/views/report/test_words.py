"""Numbers and units as a reader wants them."""

import math

from kinetostatics.views.report.words import angle, at_most, number, pretty
from support.every import every


@every("value, digits, text", [
    (286771.9, 5, "286770"), (1234567890123.0, 6, "1.23457e+12"), (-0.0, 6, "0"), (0.1 + 0.2, 6, "0.3"),
    (2.1e-16, 2, "2.1e-16"), (math.nan, 6, ""), (math.inf, 6, "∞"), (-math.inf, 6, "-∞"),
    ("mid-length", 6, "mid-length"),
    (123.456, 0, "100"), (123.456, 15, "123.456"),
])  # fmt: skip
def test_a_number_has_the_digits_that_are_known_and_no_power_of_ten_where_none_is_needed(value, digits, text):
    assert number(value, digits) == text


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


@every("bound, text", [(1.23e-10, "1.3e-10"), (0.25, "0.25"), (0.2500001, "0.26"), (9.91, "10"), (0.0, "0")])
def test_a_bound_is_never_told_smaller_than_it_is(bound, text):
    assert at_most(bound) == text

"""Numbers and units as a reader wants them."""

import math

from kinetostatics.views.report.words import angle, pretty
from support.every import every


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

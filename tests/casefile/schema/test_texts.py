"""Text with a unit in a case file."""

import numpy as np
import pytest

from kinetostatics.numbers.units import to_si


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("300 mm", "m", 0.3),
        ("320 rpm", "rad/s", 320 * np.pi / 30),
        ("-90 deg", "rad", -np.pi / 2),
        ("20.5 kg m2", "kg m^2", 20.5),
        ("9.81 m/s2", "m/s^2", 9.81),
        ("650 kN/m", "N/m", 650e3),
        ("5 tf", "N", 49033.25),
        ("1e-3 km", "m", 1.0),
    ],
)
def test_text_with_a_unit_reads_as_si(text, unit, value):
    assert to_si(text, unit) == pytest.approx(value, rel=1e-15)

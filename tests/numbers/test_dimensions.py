"""Dimensions: powers of m, kg and s, from the text of a unit and back."""

from kinetostatics.numbers.dimensions import dimension, spelled
from tests.support.every import every


@every(
    "unit, powers",
    [
        ("m", (1, 0, 0)),
        ("N*m*s/rad", (2, 1, -1)),
        ("N*m/rad", (2, 1, -2)),
        ("kg*m**2", (2, 1, 0)),
        ("N/m**3", (-2, 1, -2)),
        ("rad/s**2", (0, 0, -2)),
        ("m/s2", (1, 0, -2)),
        ("Pa", (-1, 1, -2)),
        ("1", (0, 0, 0)),
        ("", (0, 0, 0)),
    ],
)
def test_powers_of_a_unit(unit, powers):
    assert dimension(unit) == powers


@every("unit", ["1", "m", "m2", "kg m2", "rad/s", "m/s2", "N", "N/m", "N m", "W", "N s/m"])
def test_units_that_engineers_write_come_back(unit):
    assert spelled(dimension(unit)) == unit


def test_other_powers_are_written_by_bases():
    assert spelled((5.0, 1.0, -1.5)) == "m5 kg s-1.5"

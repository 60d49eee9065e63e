"""Text with a unit to SI, and the dimension of a unit."""

import math

import pytest

from kinetostatics.numbers import units
from kinetostatics.numbers.units import USUAL_UNITS, base_factor, dimension, factor, quoted, to_si, unit_name
from support.every import every


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("300 mm", "m", 0.3),
        ("320 rpm", "rad/s", 320 * math.pi / 30),
        ("-12.5 deg", "rad", math.radians(-12.5)),
        ("1.5 kN/mm", "N/m", 1.5e6),
        ("2e3 g cm^2", "kg m^2", 2e-4),
        ("0.5 N m s", "N*m*s", 0.5),
        ("0.5 kN m s/rad", "N*m*s", 500.0),
    ],
)
def test_text_is_read_in_the_unit_asked_for(text, unit, value):
    assert to_si(text, unit) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "unit"), [("5 Hz", "rad/s"), ("3 kg", "m"), ("5", "m"), ("12 m s", "m/s"), ("1 N m s/m", "N*m*s")]
)
def test_what_measures_something_else_is_refused(text, unit):
    with pytest.raises(ValueError, match=r"does not measure the same|has no unit"):
        to_si(text, unit)


@every("unit", ["degC", "°C", "degF", "°F", "dB"])
@every("wanted", ["K", "m"])
def test_units_with_their_own_zero_are_refused(unit, wanted):
    with pytest.raises(ValueError, match=f'unit "{unit}" has its own zero point.* as K, or delta_degC'):
        to_si(f"20 {unit}", wanted)


@pytest.mark.parametrize(("text", "unit", "value"), [("20 delta_degC", "K", 20.0), ("2 J/degC", "J/K", 2.0)])
def test_differences_of_temperature_are_numbers_as_any(text, unit, value):
    assert to_si(text, unit) == value


def test_factors_go_to_the_unit_and_to_the_base():
    assert factor("kN", "N") == base_factor("kN") == 1000.0


def test_long_values_are_shown_short():
    assert len(quoted("x" * 1000)) < 100


@every(
    ("text", "unit", "advice"),
    [
        ("250", "rad", '"250 deg" or "250 rad"'),
        ("60", "rad/s", '"60 rpm" or "60 rad/s"'),
        ("down", "rad", '"90 deg"'),
        ("450", "m", '"450 mm" or "450 m"'),
        (450, "m", '"450 mm" or "450 m"'),
        ("long", "m", '"300 mm"'),
        (0.5, "kg", '"0.5 kg"'),
        (math.nan, "m", '"300 mm"'),
        (True, "m", '"300 mm"'),
    ],
)
def test_advice_is_in_the_units_of_drawings(text, unit, advice):
    with pytest.raises(ValueError, match=f"write for example {advice}$"):
        to_si(text, unit)


# Dimensions


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
    assert unit_name(dimension(unit)) == unit


def test_other_powers_are_written_by_bases():
    assert unit_name((5.0, 1.0, -1.5)) == "m5 kg s-1.5"


def test_usual_units_are_those_of_pint():
    for name in USUAL_UNITS:
        scale, base, zero = units._by_pint(((name, 1),))
        own, powers, _ = units._by_table(((name, 1),))
        assert own == pytest.approx(scale, rel=3e-16)
        assert (powers, zero) == (base, 0.0)


def test_products_of_usual_units_are_exact():
    assert factor("g cm^2", "kg m^2") == 1e-7
    assert factor("kN/mm", "N/m") == 1e6

"""Quantities of pint of any registry, as plain numbers."""

import subprocess
import sys
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pint
import pytest

import kinetostatics as ks
from kinetostatics.numbers.checks import DimensionError, is_quantity, to_plain
from kinetostatics.numbers.units import to_si
from support.every import every
from support.units import UNITS

DECIMALS = pint.UnitRegistry(non_int_type=Decimal)
UNITS.define("span = 0.25 * meter")


class Labelled:
    """An array as xarray's are: its to_numpy drops the unit."""

    shape, ndim = (2,), 1
    data = UNITS.Quantity(np.array([250.0, 500.0]), "mm")

    def to_numpy(self):
        """The magnitudes."""
        return self.data.magnitude


RIGHT = {
    "a length": (UNITS.Quantity(250.0, "mm"), "m", 0.25),
    "a whole number": (UNITS.Quantity(2, "km"), "m", 2000),
    "an angle in degrees": (UNITS.Quantity(180.0, "deg"), "rad", np.pi),
    "revolutions": (UNITS.Quantity(30.0, "rpm"), "rad/s", np.pi),
    "revolutions per minute": (UNITS.Quantity(60.0, "revolution") / UNITS.Quantity(1.0, "minute"), "rad/s", 2 * np.pi),
    "a ratio": (UNITS.Quantity(12.5, "percent"), "1", 0.125),
    "a ratio of lengths": (UNITS.Quantity(1.0, "mm") / UNITS.Quantity(1.0, "m"), "1", 1e-3),
    "decibels": (UNITS.Quantity(-10.0, "dB"), "1", 0.1),
    "pounds": (UNITS.Quantity(1.0, "lbf"), "N", 4.4482216152605),
    "a torque": (UNITS.Quantity(2.0, "N*m"), "N*m", 2.0),
    "a torsion spring": (UNITS.Quantity(np.pi, "N*m/deg"), "N*m/rad", 180.0),
    "a mass by its weight": (UNITS.Quantity(2.0, "kg*m/s**2"), "N", 2.0),
    "the application's registry": (pint.Quantity(250.0, "mm"), "m", 0.25),
    "a registry with units of one's own": (UNITS.Quantity(2.0, "span"), "m", 0.5),
    "decimals": (DECIMALS.Quantity(Decimal("250"), "mm"), "m", 0.25),
    "a decimal in a registry of floats": (UNITS.Quantity(Decimal("250"), "mm"), "m", 0.25),
    "a float in a registry of decimals": (DECIMALS.Quantity(250.0, "mm"), "m", 0.25),
    "a fraction": (UNITS.Quantity(Fraction(1, 4), "m"), "m", 0.25),
}


@every(("value", "unit", "wanted"), RIGHT.values(), ids=RIGHT)
def test_quantities_become_numbers_in_the_unit_wanted(value, unit, wanted):
    assert float(to_plain(value, unit)) == pytest.approx(wanted, rel=4e-16)


WRONG = {
    "frequency for a speed": (
        UNITS.Quantity(5.0, "Hz"),
        "rad/s",
        r"\[angle\] / \[time\].* which measures 1 / \[time\]",
    ),
    "1/s for a speed": (UNITS.Quantity(5.0, "1/s"), "rad/s", r"give \.to\('rad/s'\) where that is meant"),
    "a ratio for an angle": (UNITS.Quantity(5.0, ""), "rad", r"which measures a plain number"),
    "an angle for a ratio": (UNITS.Quantity(5.0, "deg"), "1", r"a plain number, as a ratio"),
    "N m for a torsion spring": (UNITS.Quantity(5.0, "N*m"), "N*m/rad", r"an angle is no plain number"),
    "a temperature": (UNITS.Quantity(20.0, "degC"), "m", r"which measures \[temperature\]"),
    "a difference of temperatures": (UNITS.Quantity(20.0, "delta_degF"), "kg", r"which measures \[temperature\]"),
    "an area for a length": (UNITS.Quantity(20.0, "cm**2"), "m", r"which measures \[length\]\^2"),
    "a unit alone": (UNITS.kg, "kg", "got the unit kilogram without one"),
    "an array": (UNITS.Quantity(np.ones(9), "kg"), "m", r"an array in kilogram, which measures \[mass\]"),
    "one of many": ([UNITS.Quantity(1, "m"), UNITS.Quantity(1, "s")], "m", r"got 1 second, which measures \[time\]"),
    "a unit that nobody knows": (UNITS.Quantity(1.0, "m"), "", "nothing tells its unit"),
    "a long text": (UNITS.Quantity(10**200, "kg"), "m", r"\.\.\., which measures"),
}


@every(("value", "unit", "words"), WRONG.values(), ids=WRONG)
def test_another_dimension_is_told_with_what_is_wanted(value, unit, words):
    with pytest.raises(DimensionError, match=words):
        to_plain(value, unit)


def test_a_registry_that_lacks_the_unit_is_said_so():
    bare = pint.UnitRegistry(None)
    bare.define("ell = [ell]")
    with pytest.raises(ks.ParameterError, match=r"mass must be a number in kg, got 3 ell.*not defined"):
        ks.Link(bare.Quantity(3, "ell"))


def test_lists_and_arrays_of_quantities_convert():
    parts = [UNITS.Quantity(250.0, "mm"), UNITS.Quantity(2.0, "span"), 0.75]
    assert to_plain(parts, "m") == [0.25, 0.5, 0.75]
    assert to_plain(tuple(parts), "m") == (0.25, 0.5, 0.75)
    assert to_plain(np.array(parts, dtype=object), "m").tolist() == [0.25, 0.5, 0.75]
    assert to_plain(UNITS.Quantity([[250.0], [500.0]], "mm"), "m").tolist() == [[0.25], [0.5]]
    assert to_plain(Labelled(), "m").tolist() == [0.25, 0.5]


def test_what_is_no_quantity_comes_back_itself():
    for value in (1.0, 3, None, "300 mm", (1.0, 2.0), [1.0], np.ones(3), np.array([None, 1.0]), {}, True):
        assert to_plain(value, "m") is value
        assert not is_quantity(value)


def test_wrong_magnitudes_are_refused():
    for magnitude, words in (
        (1j, "complex number"),
        (np.ma.array([1.0]), "masked array"),
        (np.array([True]), "a truth value"),
    ):
        with pytest.raises(ks.ParameterError, match=words):
            ks.Link(UNITS.Quantity(magnitude, "g"))


def test_quantities_agree_with_the_texts_of_case_files():
    for text, unit in (("300 mm", "m"), ("320 rpm", "rad/s"), ("712 kN/m", "N/m"), ("12 deg", "rad"), ("5 lb", "kg")):
        assert to_plain(UNITS.Quantity(text), unit) == pytest.approx(to_si(text, unit), rel=4e-16)


@every("kind", [np.float16, np.float32, np.uint8])
def test_few_digits_are_converted_in_double_precision(kind):
    assert to_plain(UNITS.Quantity(kind(100), "mm"), "m") == 0.1
    assert to_plain(UNITS.Quantity(np.array([100], dtype=kind), "mm"), "m")[0] == 0.1
    with pytest.raises(ks.ParameterError, match="masked array"):
        ks.Link(UNITS.Quantity(np.ma.array([[1]], mask=[[True]], dtype=kind), "g"))


@pytest.mark.slow
def test_plain_numbers_import_no_pint():
    code = (
        "import sys, kinetostatics as ks; s = ks.solve(ks.crank_slider(0.1, 0.3, slider=ks.Link(1.0)), [0.1, 0.2], "
        "crank_speed=3.0).balancing_torque; sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0

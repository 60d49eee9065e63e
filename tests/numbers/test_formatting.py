"""Number formats, headings, files and texts of spreads."""

import math
import os
from pathlib import Path

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.errors import CaseError
from kinetostatics.numbers import spreads
from kinetostatics.numbers.files import headings, read_columns, read_text, write_atomically
from kinetostatics.numbers.formatting import angle, number, plain, pretty_unit, round_bound_up, si_columns
from support.every import every


@every("value, digits, text", [
    (40578.94111, 6, "40578.9"), (286771.9, 5, "286770"), (1234567.8, 6, "1234568"), (-2.5e8, 6, "-250000000"),
    (1234567890123.0, 6, "1.23457e+12"), (1e9, 6, "1e+09"), (-0.0, 6, "0"), (0.1 + 0.2, 6, "0.3"), (1e-9, 6, "1e-09"),
    (2.1e-16, 2, "2.1e-16"), (math.nan, 6, ""), (math.inf, 6, "inf"), (-math.inf, 6, "-inf"), ("words", 6, "words"),
    (123.456, 0, "100"), (123.456, 15, "123.456"), (5, 6, "5"), (True, 6, "1"),
])  # fmt: skip
def test_number_has_six_digits_without_exponent(value, digits, text):
    assert number(value, digits) == text


@every("value, unit, text", [
    (1128.8123456, "kg m2", "1128.81 kg m2"), (np.float64(0.25), "", "0.25"), (0.5, "1", "0.5"), (3, "", "3"),
    ((np.float64(0.1), 0.2), "m", "(0.1, 0.2) m"), ((1.0,), "", "(1,)"), (np.array(2.0), "N", "2 N"),
    (np.array([1.0, -0.0]), "N", "[1, 0] N"), (np.zeros((2, 9)), "N", "<array of shape (2, 9)> N"),
    ({"crank": (np.float64(0.12), 0.0)}, "kg m", "{'crank': (0.12, 0)} kg m"), (math.nan, "J", "nan J"),
    ("start", "", "'start'"), (True, "", "True"), (None, "", "None"),
])  # fmt: skip
def test_values_of_results_have_units(value, unit, text):
    assert plain(value, unit) == text


PUMP = ks.crank_slider(0.05, 0.2, crank=ks.Link(2.0, 0.05), slider=ks.Link(1.0))
RUNNING = ks.Scene(PUMP, 100.0, loads=ks.ProcessForce(-200.0))


@every(
    ("make", "text"),
    [
        (
            lambda: ks.drive.flywheel(RUNNING, 0.01),
            "Flywheel(inertia=0.259863 kg m2, energy=25.9863 J, fluctuation=0.01)",
        ),
        (
            lambda: ks.drive.Motor.linear(10.0, 100.0),
            "Linear(transmission=1, inertia=0 kg m2, standstill_torque=10 N m, ",
        ),
        (lambda: ks.drive.Motor.table([0.0, 9.0], [4.0, 0.0]), "speeds=[0, 9] rad/s, torques=[4, 0] N m)"),
        (lambda: ks.principal_points(PUMP), "PrincipalPoints(mass=3 kg, static_moments={'crank': (0.15, 0), "),
        (lambda: ks.balancing.partial(PUMP, 0.5, crank=ks.Counterweight(arm=-0.1)), "Balanced(counterweights={'crank'"),
        (lambda: RUNNING.solve(2).ground["O"], "Support(force=[[1425, -1575]"),
        (lambda: ks.extremes(RUNNING.solve(2), "O").range, "("),
    ],
)
def test_results_have_units(make, text):
    found = repr(make())
    assert text in found
    assert "np." not in found


@every("value, bound, text", [
    (40578.93, 3.0, "40579"), (40578.93, 0.02, "40578.9"), (40578.93, 30.0, "40580"), (40578.93, 300.0, "40600"),
    (40578.93, 9.99, "40579"), (40578.93, 40578.0, "40000"), (40578.93, 40579.0, "0"), (-1.5e-10, 1.5e-10, "0"),
    (1.6e-10, 1.5e-10, "2e-10"), (1.23456789, 1e-3, "1.235"), (-9.9996, 1e-3, "-10"), (1234567.8, 3.0, "1234568"),
    (1234567.8, 40.0, "1234570"), (1234567.8, 4e5, "1200000"), (3.0, math.inf, "3"), (3.0, math.nan, "3"),
    (math.nan, 1.0, ""), (math.inf, 1.0, "inf"), (0.0, 1.0, "0"), (1e-300, 1e-305, "1e-300"),
])  # fmt: skip
def test_uncertain_digits_are_not_shown(value, bound, text):
    assert number(value, bound=bound) == text


@every("power", [-300, -12, -3, 0, 4, 8, 12, 300])
def test_shown_value_is_within_half_a_place(power):
    for share in (1.0, 0.3, 2e-2, 7e-4, 3e-6, 5e-9):
        value = 1.7632549871 * 10.0**power
        told = float(number(value, bound=share * value) or "0")
        assert abs(told - value) <= max(share, 1e-5) * value


@every("bound, text", [(1.23e-10, "1.3e-10"), (0.25, "0.25"), (0.2500001, "0.26"), (9.91, "10"), (0.0, "0")])
def test_a_bound_is_never_told_smaller_than_it_is(bound, text):
    assert round_bound_up(bound) == text


@every("value, text", [(math.inf, "∞"), (-math.inf, "-∞"), (math.nan, ""), (1.5, "1.5")])
def test_infinity_may_have_a_sign_of_its_own(value, text):
    assert number(value, infinity="∞") == text


@every("unit, text", [
    ("N m", "N·m"), ("kg m2", "kg·m²"), ("kg m^2", "kg·m²"), ("m/s2", "m/s²"), ("rad/s", "rad/s"), ("deg", "°"),
    ("1", ""), ("", ""),
    ("N/m**3", "N/m³"),
])  # fmt: skip
def test_units_have_raised_exponents_and_dots(unit, text):
    assert pretty_unit(unit) == text


@every("degrees, text", [(1.1e-13, "0"), (-1e-9, "0"), (math.nan, ""), (138.58297, "138.583"), ("at", "at")])
def test_an_angle_has_three_decimals(degrees, text):
    assert angle(degrees) == text


# Headings of columns


def test_unit_in_round_brackets_is_corrected():
    _, problems = si_columns(["length (mm)", "size (mm)"], {"length": "m"})
    assert problems[0] == "parameter 'length (mm)' has its unit in round brackets; write 'length [mm]'"
    assert "allowed: 'length'" in problems[1]


# Files


def test_blanks_in_headings_count_as_underscores(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("crank angle [deg], force back [kN]\n0, 1\n360, 1\n")
    assert headings(path) == [("crank_angle", "deg"), ("force_back", "kN")]
    assert [column.tolist() for column in read_columns(path, {"force_back": "N"})] == [[1000.0, 1000.0]]


def test_too_large_a_file_is_refused(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text("x" * 100)
    assert read_text(path, 100) == "x" * 100
    with pytest.raises(CaseError, match="cannot be read"):
        read_text(path, 99)


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="the system has no names for open files")
def test_an_open_pipe_takes_what_is_written():
    reading, writing = os.pipe()
    with write_atomically(f"/dev/fd/{writing}") as path:
        Path(path).write_text("whole", encoding="utf-8")
    os.close(writing)
    assert os.read(reading, 99) == b"whole"
    os.close(reading)


# Spreads as texts


@pytest.mark.slow
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
def test_median_and_deviation_match_the_distribution(given):
    spread = spreads.parse_spread(given)
    assert spread.median == pytest.approx(spread.distribution.median(), rel=1e-14)
    assert spread.deviation == pytest.approx(spread.distribution.std(), rel=1e-14)

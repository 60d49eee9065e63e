"""Numbers, units and spreads as text that are wrong: each ends in one clear error, or the right number."""

import re
import warnings

import pytest
from hypothesis import given, settings, strategies

import kinetostatics as ks
from kinetostatics.cli import main
from kinetostatics.numbers.units import factor, to_si
from kinetostatics.sweeps import designs
from support.case_files import BADLY_WRITTEN
from support.every import every


@pytest.fixture(scope="module", autouse=True)
def libraries():
    """Loads pint and scipy before the clock of any test runs."""
    designs.distributions({"a": "0..1 m"})
    ks.load_case("sawframe_2r63")


@every("unit", ["m", "kN/mm", "kg m^2"])
@every("number", BADLY_WRITTEN)
def test_badly_written_numbers_are_corrected(number, unit):
    with pytest.raises(ValueError, match=r"must be text of a number and a unit") as caught:
        to_si(f"{number} {unit}", unit)
    assert all(f'"{right} {unit}"' in str(caught.value) for right in BADLY_WRITTEN[number])


@every("number", BADLY_WRITTEN)
@every("form", ["0..{} m:3", "{}..9e9 m", "normal 1 m +- {} m", "triangular 0..{}..9e9 m"])
def test_badly_written_spreads_are_corrected(number, form):
    made = designs.grid if ":" in form else designs.distributions
    with pytest.raises(ks.ParameterError, match=r"cannot read") as caught:
        made({"a": form.format(number)})
    assert f'"{form.format(BADLY_WRITTEN[number][0])}"' in str(caught.value)


NO_NUMBER = [
    *("", " ", "m", "nan m", "inf m", "-inf m", "1e3e3 m", "1.2.3 m", "1,2,3 m", "--5 m", "+-5 m", "1/2 m", "½ m"),
    *("'5' m", "$5 m", "5-3 m", "5:3 m", "True", "5.1/s", "1e5,3 m", "e5 m", ". m", "\x00", "1" * 10_000 + " m"),
    *(5, 5.0, None, True, [1, "m"], {"a": 1}, b"5 m", float("nan")),
]


@every("text", NO_NUMBER, ids=lambda text: repr(text)[:20])
def test_what_holds_no_number_is_refused(text):
    with pytest.raises(
        ValueError, match=r'must be text of a number and a unit that converts to m, found .*"1.5 m"|write'
    ):
        to_si(text, "m")


BAD_UNITS = [
    *(
        "m*10**10**10",
        "10**10**10",
        "m^9999999999",
        "m^1e9",
        "m**10**10",
        "m/0",
        "m^0",
        "m^0.5",
        "m**-",
        "m^",
        "^2",
        "m//s",
    ),
    *("2 m", "m 3", "m + m", "m - m", "(m)", "((((m", "m)", "m;", "m,", "m!", "m=m", "m__class__", "__import__", "m.s"),
    *(
        "lambda: m",
        "[m]",
        "{m}",
        "m if m",
        "m\x00",
        "m\nm;",
        "furlog",
        "m" * 10_000,
        "1",
        "1/1",
        "1 m",
        "m²³",
    ),
    *("'m'", '"m"', "m\\", "#m", "m#", "m@m", "m%m", "m~", "~m", "m&m", "m|m", "nan", "inf", "None", "x10", "0"),
]


@every("unit", BAD_UNITS, ids=lambda text: repr(text)[:20])
def test_units_outside_the_grammar_are_refused(unit):
    with pytest.raises(ValueError, match=r"is not known|does not measure the same|must be text of a number"):
        to_si(f"5 {unit}", "m")


@every(
    ("unit", "value"),
    [
        *(("m", 1.0), ("mm", 1e-3), ("km", 1e3), ("in", 0.0254), ("m^1", 1.0), ("m**1", 1.0), ("m^2/m", 1.0)),
        *(("m2/m", 1.0), ("m²/m", 1.0), ("m·m/m", 1.0), ("m * m / m", 1.0), ("mm m^-1 m", 1e-3), ("m per s s", 1.0)),
        *(("\u00b5m", 1e-6), ("\u03bcm", 1e-6), ("metre", 1.0), ("1/m m^2", 1.0)),
    ],
)
def test_a_unit_within_the_grammar_is_read(unit, value):
    assert to_si(f"1 {unit}", "m") == pytest.approx(value, rel=1e-15)


@every("space", ["", " ", "  ", "\t", "\u00a0", "\u2009", "\u202f"])
def test_any_space_may_precede_the_unit(space):
    assert to_si(f"5{space}mm", "m") == 0.005


@pytest.mark.parametrize("unit", ["m*10**10**10", "m/0", "kg)"])
def test_design_columns_use_the_unit_grammar(unit):
    with pytest.raises(ValueError, match=r"is not known"):
        factor(unit, "m")


@every(
    ("spreads", "message"),
    [
        ({"a": "0..1 m:1000000000"}, "1000000000 values are too many"),
        ({"a": "0..1 m:" + "9" * 100}, "values are too many"),
        ({"a": "0..1 m:100000", "b": "0..1 m:100000"}, "too many for one table"),
        ({"a": "0...1 m:3"}, "write two dots"),
        ({"a": "0..1 m:٣"}, "another form"),
        ({"a": "0..1 m:" + "0" * 10_000}, "longer than 200 letters"),
        ({"a": 5}, "must be text"),
        ({"a": None}, "must be text"),
        ({"a": "0..1 m*10**10**10:3"}, "is not known"),
    ],
)
def test_large_or_untyped_grids_are_refused(spreads, message):
    with pytest.raises(ks.ParameterError, match=message):
        designs.grid(spreads)


@every("count", [0, -1, 1.5, True, "8", None, 10**12])
@every("kind", [designs.latin_hypercube, designs.sobol, designs.random])
def test_samples_of_no_or_too_many_designs_are_refused(kind, count):
    with pytest.raises(ks.ParameterError, match=r"how many must be|too many for one table"):
        kind({"a": "0..1 m"}, count)


@settings(max_examples=300, deadline=None)
@given(strategies.text("0123456789.,eE+-*/^ mkNsg()²\u2009\u2212٣'_", max_size=12))
def test_any_text_is_one_number_or_refused(text):
    """What is accepted is a number as Python writes it, up to the first letter that is no exponent, and a unit."""
    try:
        found = to_si(text, "m")
    except ValueError:
        return
    number, unit = re.fullmatch(r"\s*([-+0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([^\W\d].*?)\s*", text).groups()
    assert found == float(number) * factor(unit, "m")


@pytest.mark.slow_start
@every(
    ("vary", "message"),
    [
        (["spring.stiffness=600,5..900 kN/m:4"], 'write "600.5..900 kN/m:4"'),
        (
            ["spring.stiffness=600..900 kN/m:4", "spring.stiffness=1..2 kN/m:2"],
            "spring.stiffness is given more than once",
        ),
        (
            ["spring.stiffness = 1..2 kN/m:2", "spring.stiffness=1..2 kN/m:2"],
            "spring.stiffness is given more than once",
        ),
        (["spring.stiffness [N/m]=600..900 kN/m:4"], "parameter is 'spring.stiffness [N/m] [kN/m]'"),
        (["spring.stiffness=600..900 kN/m*10**10**10:4"], "is not known"),
        (["spring.stiffness=0..1 kN/m:1000000000"], "too many"),
        (["=0..1 kN/m:2"], "parameter is ''"),
    ],
)
def test_wrong_spreads_are_refused_in_one_line(capsys, vary, message):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["sweep", "sawframe_2r63", *(f"--vary={text}" for text in vary)]) == 2
    printed = capsys.readouterr().err
    assert message in printed
    assert printed.count("\n") == 1

"""Styles: the same formula as text, LaTeX and MathML."""

from xml.etree import ElementTree as ET

from kinetostatics.explain.formats import GREEK, LATEX, MATHML, TEXT, Symbol, format_number, write_formula
from tests.support.every import every

A, B = ("name", 0), ("name", 1)
SYMBOLS = [Symbol("theta", owner="coupler", primes=1), Symbol("F", "x", "slider")]
TREES = {
    "sum": ("sum", (1, A), (-1, B)),
    "quotient": ("quotient", ("sum", (1, A), (1, B)), ("power", A, 2)),
    "product": ("product", A, ("negative", B)),
    "root": ("call", "sqrt", ("call", "abs", A)),
    "others": ("product", ("call", "max", A, B), ("call", "sign", A), ("call", "atan", ("call", "sin", B))),
}


@every(
    "style, name, text",
    [
        (TEXT, "sum", "theta_coupler' - Fx_slider"),
        (TEXT, "quotient", "(theta_coupler' + Fx_slider)/(theta_coupler')^2"),
        (TEXT, "product", "theta_coupler'*(-Fx_slider)"),
        (LATEX, "sum", r"\theta_{\mathrm{coupler}}' - F_{x,\mathrm{slider}}"),
        (LATEX, "root", r"\sqrt{\left|\theta_{\mathrm{coupler}}'\right|}"),
    ],
)
def test_symbols(style, name, text):
    assert write_formula(TREES[name], style, SYMBOLS.__getitem__) == text


@every("value, text", [(-0.5, "(-0.5)/(-0.5)^2"), (2.0, "2/2^2"), (1e-7, "1e-07/(1e-07)^2")])
def test_numbers_are_bracketed_where_they_must(value, text):
    assert write_formula(("quotient", A, ("power", A, 2)), TEXT, lambda place: value) == text


@every("name", TREES)
def test_mathml_is_well_formed(name):
    for given in (SYMBOLS.__getitem__, [-1.5e-7, 3.0].__getitem__):
        ET.fromstring(f"<math>{write_formula(TREES[name], MATHML, given)}</math>")


def test_values_have_six_digits_and_constants_all_theirs():
    assert format_number(1 / 3) == "0.333333"
    assert format_number(0.0) == "0"
    assert format_number(1 / 3, True) == "0.3333333333333333"
    assert format_number(2.0, True) == "2"
    assert LATEX.number(-2.5e-8) == r"-2.5 \cdot 10^{-8}"
    assert "−8" in MATHML.number(-2.5e-8)


def test_greek_letters_are_greek_in_latex_and_mathml():
    for name, letter in GREEK.items():
        assert LATEX.symbol(Symbol(name)) == f"\\{name}"
        assert MATHML.symbol(Symbol(name)) == f"<mi>{letter}</mi>"

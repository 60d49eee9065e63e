"""Symbols of numbers and quantities in hand calculations, and formulas as text, LaTeX and MathML."""

import re
from collections.abc import Callable
from html import escape
from typing import NamedTuple

from ..numbers.formatting import number, shortest_exact


class Symbol(NamedTuple):
    """Symbol of a number: ("F", "x", "slider") is the x component of force F of the slider.

    `primes` is the order of the derivative by the crank angle, `again` the number among equal spellings.
    """

    base: str
    axis: str = ""
    owner: str = ""
    primes: int = 0
    again: int = 1

    @property
    def text(self):
        count = str(self.again) if self.again > 1 else ""
        stem = "_".join(part for part in (self.base + self.axis + count, self.owner) if part)
        return re.sub(r"[^\w.]", "_", stem) + "'" * self.primes


def load_keys(loads):
    """Name of each load as in paths, with its number if there are several of a kind."""
    found, counts = [], dict[str, int]()
    for item in loads:
        key = getattr(item, "PATH", "") or type(item).__name__
        counts[key] = counts.get(key, 0) + 1
        found.append(f"{key}{counts[key]}" if counts[key] > 1 else key)
    return found


LETTERS = {
    "mass": "m",
    "inertia": "J",
    "along": "a",
    "across": "b",
    "stiffness": "k",
    "coefficient": "c",
    "radius": "r",
    "pin_radius": "r",
    "roller_radius": "R",
    "rolling_arm": "e",
    "half_length": "h",
    "mu": "mu",
    "free_position": "s0",
    "free_length": "l0",
    "free_angle": "theta0",
}
PATH_LETTERS = {
    "crank_speed": "omega",
    "crank_acceleration": "alpha",
    "gravity.acceleration": "g",
    "gravity.direction": "gamma",
}


def path_symbol(path):
    """Symbol of a number of the scene, by its path."""
    if path in PATH_LETTERS:
        return Symbol(PATH_LETTERS[path])
    *owner, last = [part for part in path.split(".") if part != "centre"]
    if last in ("x", "y"):
        return Symbol(last, "", "_".join(owner))
    if last.isdecimal() and owner:
        last = owner.pop() + last
    for name, letter in (("_length", "l"), ("guide_angle", "beta"), ("guide_offset", "e")):
        stem, found, label = last.partition(name)
        if found:
            return Symbol(letter, "", "_".join((*owner, stem + label)).strip("_"))
    return Symbol(LETTERS.get(last, last), "", "_".join(owner))


ENDING_LETTERS = {
    "_force": "F",
    "_moment": "M",
    "_position": "s",
    "_velocity": "v",
    "_angular_acceleration": "alpha",
    "_acceleration": "a",
    "_rate": "omega",
    "_energy": "E",
    "_friction_loss": "P",
}
"""Letters of quantities by ending of their names."""


def quantity_symbol(quantity):
    """Symbol of a quantity by name."""
    if quantity.startswith("balancing_torque"):
        return Symbol("T")
    for ending, letter in ENDING_LETTERS.items():
        stem, found, label = quantity.partition(ending)
        if found:
            return Symbol(letter, "", stem + label)
    return Symbol(quantity)


SUM, NEGATIVE, PRODUCT, POWER, ATOM = range(5)
"""Precedence of a part of a formula: a part of lower precedence than its place requires gets brackets."""


class Style(NamedTuple):
    """Templates of one format: text, LaTeX or MathML."""

    number: Callable[..., str]
    symbol: Callable[[Symbol], str]
    plus: str
    minus: str
    times: str
    quotient: str
    power: str
    brackets: str
    call: str
    """Template of a function's name and arguments; `calls` has others for some functions."""
    comma: str
    calls: dict[str, str]
    stands_alone: bool
    """Whether a quotient is a fraction with a bar, which needs no brackets."""


def write_formula(tree, style, name):
    """A formula in a style; ``name(index)`` gives the `Symbol` or the value of a named number."""
    return _write(tree, style, name)[0]


def _write(tree, style, name):
    """Text of a formula, and its precedence."""
    kind, *parts = tree

    def inner(part, least):
        text, hold = _write(part, style, name)
        return text if hold >= least else style.brackets.format(text)

    if kind == "name":
        found = name(parts[0])
        if isinstance(found, Symbol):
            return style.symbol(found), POWER if found.primes else ATOM
        return style.number(found), _binding(found)
    if kind == "number":
        return style.number(parts[0], True), _binding(parts[0])
    if kind == "sum":
        (sign, first), *rest = parts
        text = style.minus.strip() + inner(first, PRODUCT) if sign < 0 else inner(first, NEGATIVE)
        for sign, part in rest:
            text += (style.plus if sign > 0 else style.minus) + inner(part, PRODUCT)
        return text, SUM
    if kind == "negative":
        return style.minus.strip() + inner(parts[0], PRODUCT), NEGATIVE
    if kind == "product":
        later = PRODUCT if style.stands_alone else POWER
        return style.times.join((inner(parts[0], PRODUCT), *(inner(part, later) for part in parts[1:]))), PRODUCT
    if kind == "quotient":
        over, under = (0, 0) if style.stands_alone else (PRODUCT, POWER)
        return style.quotient.format(inner(parts[0], over), inner(parts[1], under)), PRODUCT
    if kind == "power":
        return style.power.format(inner(parts[0], ATOM), parts[1]), POWER
    arguments = style.comma.join(_write(part, style, name)[0] for part in parts[1:])
    return style.calls.get(parts[0], style.call).format(arguments, name=parts[0]), ATOM


def _binding(value):
    return NEGATIVE if value < 0 else PRODUCT if "e" in format_number(value) else ATOM


def format_number(value, exactly=False):
    """A number to 6 digits, or in the fewest digits that give it exactly."""
    return shortest_exact(value) if exactly else number(value) or "nan"


GREEK_NAMES = "alpha", "beta", "gamma", "eta", "theta", "kappa", "lambda", "mu", "xi", "sigma", "tau", "phi", "omega"
GREEK = dict(zip(GREEK_NAMES, "αβγηθκλμξστφω", strict=True))


def _latex_number(value, exactly=False):
    digits, found, power = format_number(value, exactly).partition("e")
    return rf"{digits} \cdot 10^{{{int(power)}}}" if found else digits


def _latex_word(word):
    word = word.replace("_", "~")
    return word if len(word) == 1 else rf"\mathrm{{{word}}}"


def _latex_symbol(symbol):
    base = f"\\{symbol.base}" if symbol.base in GREEK else _latex_word(symbol.base)
    below = ",".join(_latex_word(part) for part in _below(symbol))
    return base + (f"_{{{below}}}" if below else "") + "'" * symbol.primes


def _below(symbol):
    """Parts of the subscript."""
    return [part for part in (symbol.axis, symbol.owner, str(symbol.again) if symbol.again > 1 else "") if part]


def _mathml_number(value, exactly=False):
    digits, found, power = format_number(value, exactly).partition("e")
    text = f"<mn>{digits}</mn>"
    if found:
        text = f"<mrow>{text}<mo>·</mo><msup><mn>10</mn><mn>{int(power)}</mn></msup></mrow>"
    return text.replace("-", "−")


def _mathml_symbol(symbol):
    base = f"<mi>{escape(GREEK.get(symbol.base, symbol.base))}</mi>"
    below = escape(", ".join(_below(symbol)).replace("_", " "))
    prime = ["", "<mo>′</mo>", "<mo>″</mo>"][symbol.primes]
    if below and prime:
        return f"<msubsup>{base}<mtext>{below}</mtext>{prime}</msubsup>"
    if below:
        return f"<msub>{base}<mtext>{below}</mtext></msub>"
    return f"<msup>{base}{prime}</msup>" if prime else base


TEXT = Style(
    format_number,
    lambda symbol: symbol.text,
    " + ",
    " - ",
    "*",
    "{}/{}",
    "{}^{}",
    "({})",
    "{name}({})",
    ", ",
    {},
    False,
)
LATEX = Style(
    _latex_number,
    _latex_symbol,
    " + ",
    " - ",
    r" \cdot ",
    r"\frac{{{}}}{{{}}}",
    "{}^{{{}}}",
    r"\left({}\right)",
    r"\{name}\left({}\right)",
    ", ",
    {
        "sqrt": r"\sqrt{{{}}}",
        "atan": r"\arctan\left({}\right)",
        "abs": r"\left|{}\right|",
        "sign": r"\operatorname{{sign}}\left({}\right)",
    },
    True,
)
MATHML = Style(
    _mathml_number,
    _mathml_symbol,
    "<mo>+</mo>",
    "<mo>−</mo>",
    "<mo>·</mo>",
    "<mfrac><mrow>{}</mrow><mrow>{}</mrow></mfrac>",
    "<msup><mrow>{}</mrow><mn>{}</mn></msup>",
    "<mrow><mo>(</mo>{}<mo>)</mo></mrow>",
    "<mrow><mi>{name}</mi><mo>(</mo>{}<mo>)</mo></mrow>",
    "<mo>,</mo>",
    {
        "atan": "<mrow><mi>arctan</mi><mo>(</mo>{}<mo>)</mo></mrow>",
        "sqrt": "<msqrt><mrow>{}</mrow></msqrt>",
        "abs": "<mrow><mo>|</mo>{}<mo>|</mo></mrow>",
    },
    True,
)

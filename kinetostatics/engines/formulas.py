"""Formulas of recorded numbers: trees that end at named numbers, and how they are written as text, LaTeX and MathML."""

from collections.abc import Callable
from html import escape
from types import MappingProxyType
from typing import Any, NamedTuple

from ..numbers.elementary import APART
from .naming import Symbol
from .trace import Node

SUM, NEGATIVE, PRODUCT, POWER, ATOM = range(5)
"""How tightly parts of a formula hold together."""
CALLS = {"sqrt": "sqrt", "root": "sqrt", "sin": "sin", "cos": "cos", "atan": "atan", "abs": "abs", "sign": "sign"}
"""Functions by recorded operation; the second argument of a root only says what rounding is."""
UNSEEN = 1e-250
"""Constant that is added to keep a square or distance off zero."""
ONE, ZERO = ("number", 1.0), ("number", 0.0)


def formula(node, ends, stands_for=MappingProxyType({})):
    """Tree of a recorded number: tuples of a kind and its parts.

    Kinds are "number" of a value, "name" of a node by its place in the graph, "sum" of pairs (sign, part), "product" of
    parts, "negative", "quotient", "power" and "call".

    Parameters
    ----------
    node : Node or float
    ends : container of Node
        Where a formula ends; not at the node itself.
    stands_for : dict of Node to Node
        What stands in formulas for another of the same value.
    """
    if not isinstance(node, Node):
        return ("negative", ("number", -float(node))) if node < 0 else ("number", float(node))

    def part_of(part):
        found = stands_for.get(part, part) if isinstance(part, Node) else part
        if found is not node:
            part = found
        return ("name", part.index) if isinstance(part, Node) and part in ends else formula(part, ends, stands_for)

    return _OPERATIONS[node.operation](*(part_of(part) for part in node.arguments if not _is_nothing(part)))


def _is_nothing(part):
    """Whether an argument only keeps a number off zero, as `elementary.apart` does, and changes no digit."""
    if isinstance(part, Node):
        return part.operation == "*" and any(isinstance(one, float) and one == APART for one in part.arguments)
    return 0.0 < abs(part) < UNSEEN


def _sum(left, right=ZERO):
    terms = tuple(term for term in (*_terms(left), *_terms(right)) if term[1] != ZERO)
    return _of_terms(terms)


def _difference(left, right=None):
    if right is None:
        return _negative(left)
    sign, part = (1, right[1]) if right[0] == "negative" else (-1, right)
    return _of_terms(tuple(term for term in (*_terms(left), (sign, part)) if term[1] != ZERO))


def _of_terms(terms):
    if len(terms) > 1:
        return ("sum", *terms)
    if not terms:
        return ZERO
    ((sign, part),) = terms
    return part if sign > 0 else _negative(part)


def _terms(part):
    if part[0] == "sum":
        return part[1:]
    return ((-1, part[1]),) if part[0] == "negative" else ((1, part),)


def _negative(part):
    if part == ZERO:
        return ZERO
    return part[1] if part[0] == "negative" else ("negative", part)


def _product(left, right):
    if ZERO in (left, right):
        return ZERO
    larger = _larger(left, right)
    if larger:
        return larger[0] if len(larger) == 1 else ("call", "max", *larger)
    if left[0] == "negative" or right[0] == "negative":
        parts = [part[1] if part[0] == "negative" else part for part in (left, right)]
        whole = _product(*parts)
        return whole if left[0] == right[0] else _negative(whole)
    factors: list[Any] = []
    for part in (left, right):
        for factor in part[1:] if part[0] == "product" else (part,):
            base, count = factor[1:] if factor[0] == "power" else (factor, 1)
            known = next((place for place, (other, _) in enumerate(factors) if other == base), None)
            if base == ONE:
                continue
            if known is None or base[0] == "number":
                factors.append((base, count))
            else:
                factors[known] = base, factors[known][1] + count
    made = [base if count == 1 else ("power", base, count) for base, count in factors]
    return ("product", *made) if len(made) > 1 else made[0] if made else ONE


def _quotient(left, right):
    if left == ZERO:
        return ZERO
    if left[0] == "negative":
        return _negative(_quotient(left[1], right))
    if right[0] == "negative":
        return _negative(_quotient(left, right[1]))
    return ("quotient", left, right)


def _call(name, part):
    if part == ZERO and name in ("sqrt", "abs"):
        return ZERO
    if name == "abs" and part[0] == "negative":
        return _call(name, part[1])
    return part if name == "abs" and part[:2] == ("call", "abs") else ("call", name, part)


def _larger(left, right):
    """Parts of 0.5 (a + b + |a - b|), the larger of two; None if that is something else."""
    if left != ("number", 0.5) or right[0] != "sum":
        return None
    terms = [part for sign, part in right[1:] if sign > 0]
    if len(terms) != len(right) - 1:
        return None
    if len(terms) == 2 and terms[0] == terms[1]:
        return terms[:1]
    matches = len(terms) == 3 and terms[2] == ("call", "abs", ("sum", (1, terms[0]), (-1, terms[1])))
    return terms[:2] if matches else None


_OPERATIONS: dict[str, Callable[..., Any]] = {
    "+": _sum,
    "-": _difference,
    "*": _product,
    "/": _quotient,
    "held": lambda part: part,
    "divisor": lambda part, unit: part,
    **{name: (lambda part, *unit, name=name: _call(CALLS[name], part)) for name in CALLS},
}


def names_in(tree):
    """Places of the nodes that a formula names, in order, each once."""
    found: dict[int, None] = {}

    def look(part):
        if part[0] == "name":
            found[part[1]] = None
        else:
            for inner in part[1:]:
                if isinstance(inner, tuple):
                    look(inner[1] if isinstance(inner[0], int) else inner)

    look(tree)
    return list(found)


# How formulas are written


class Style(NamedTuple):
    """A way to write: templates of text, LaTeX or MathML."""

    number: Callable[..., str]
    symbol: Callable[[Symbol], str]
    plus: str
    minus: str
    times: str
    quotient: str
    power: str
    brackets: str
    calls: dict[str, str]
    sign: str
    stands_alone: bool
    """Whether a quotient needs no brackets, being a fraction with a bar."""


def written(tree, style, name):
    """A formula in a style; ``name(place)`` gives what stands for a named number, a `Symbol` or a float."""
    return _written(tree, style, name)[0]


def _written(tree, style, name):
    """Text of a formula, and how tightly it holds together."""
    kind, *parts = tree

    def inner(part, least):
        text, hold = _written(part, style, name)
        return text if hold >= least else style.brackets.format(text)

    if kind == "name":
        found = name(parts[0])
        if isinstance(found, Symbol):
            return style.symbol(found), POWER if found.primes else ATOM
        return style.number(found), _hold_of(found)
    if kind == "number":
        return style.number(parts[0], 12), _hold_of(parts[0])
    if kind == "sum":
        (sign, first), *rest = parts
        text = style.sign + inner(first, PRODUCT) if sign < 0 else inner(first, NEGATIVE)
        for sign, part in rest:
            text += (style.plus if sign > 0 else style.minus) + inner(part, PRODUCT)
        return text, SUM
    if kind == "negative":
        return style.sign + inner(parts[0], PRODUCT), NEGATIVE
    if kind == "product":
        later = PRODUCT if style.stands_alone else POWER
        return style.times.join((inner(parts[0], PRODUCT), *(inner(part, later) for part in parts[1:]))), PRODUCT
    if kind == "quotient":
        over, under = (0, 0) if style.stands_alone else (PRODUCT, POWER)
        return style.quotient.format(inner(parts[0], over), inner(parts[1], under)), PRODUCT
    if kind == "power":
        return style.power.format(inner(parts[0], ATOM), parts[1]), POWER
    return style.calls[parts[0]].format(*(_written(part, style, name)[0] for part in parts[1:])), ATOM


def _hold_of(value):
    return NEGATIVE if value < 0 else PRODUCT if "e" in shown(value) else ATOM


def shown(value, digits=6):
    """A number to so many digits."""
    return f"{value:.{digits}g}" if value else "0"


LETTERS = "alpha α beta β gamma γ eta η theta θ kappa κ lambda λ mu μ xi ξ sigma σ tau τ phi φ omega ω".split()
GREEK = dict(zip(LETTERS[::2], LETTERS[1::2], strict=True))


def _latex_number(value, digits=6):
    digits, found, power = shown(value, digits).partition("e")
    return rf"{digits} \cdot 10^{{{int(power)}}}" if found else digits


def _latex_word(word):
    word = word.replace("_", "~")
    return word if len(word) == 1 else rf"\mathrm{{{word}}}"


def _latex_symbol(symbol):
    base = f"\\{symbol.base}" if symbol.base in GREEK else _latex_word(symbol.base)
    below = ",".join(_latex_word(part) for part in _below(symbol))
    return base + (f"_{{{below}}}" if below else "") + "'" * symbol.primes


def _below(symbol):
    """What stands below the line."""
    return [part for part in (symbol.axis, symbol.owner, str(symbol.again) if symbol.again > 1 else "") if part]


def _mathml_number(value, digits=6):
    digits, found, power = shown(value, digits).replace("-", "−").partition("e")
    if found:
        power = int(power.replace("−", "-"))
        return (
            f"<mrow><mn>{digits}</mn><mo>·</mo><msup><mn>10</mn><mn>{str(power).replace('-', '−')}</mn></msup></mrow>"
        )
    return f"<mn>{digits}</mn>"


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
    shown,
    lambda symbol: symbol.text,
    " + ",
    " - ",
    "*",
    "{}/{}",
    "{}^{}",
    "({})",
    {**{name: f"{name}({{}})" for name in CALLS.values()}, "max": "max({}, {})"},
    "-",
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
    {
        "sqrt": r"\sqrt{{{}}}",
        "sin": r"\sin\left({}\right)",
        "cos": r"\cos\left({}\right)",
        "atan": r"\arctan\left({}\right)",
        "abs": r"\left|{}\right|",
        "sign": r"\operatorname{{sign}}\left({}\right)",
        "max": r"\max\left({}, {}\right)",
    },
    "-",
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
    {
        **{name: f"<mrow><mi>{name}</mi><mo>(</mo>{{}}<mo>)</mo></mrow>" for name in ("sin", "cos", "sign")},
        "atan": "<mrow><mi>arctan</mi><mo>(</mo>{}<mo>)</mo></mrow>",
        "sqrt": "<msqrt><mrow>{}</mrow></msqrt>",
        "abs": "<mrow><mo>|</mo>{}<mo>|</mo></mrow>",
        "max": "<mrow><mi>max</mi><mo>(</mo>{}<mo>,</mo>{}<mo>)</mo></mrow>",
    },
    "<mo>−</mo>",
    True,
)

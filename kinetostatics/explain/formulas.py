"""Formulas of recorded numbers: trees that end at named numbers.

Terms that only guard against rounding are left out; signs and equal factors are collected as by hand. Nothing else is
rearranged.
"""

from collections.abc import Callable
from types import MappingProxyType
from typing import Any

from ..engines.graph import Node
from ..numbers.arithmetic import RELATIVE_OFFSET

CALLS = {name: name for name in ("sqrt", "sin", "cos", "atan", "exp", "log", "abs", "sign")} | {"root": "sqrt"}
"""Functions by recorded operation; the second argument of a root, its scale of rounding, is left out."""
MAX_OFFSET = 1e-120
"""Largest constant that only keeps a square or distance away from zero."""
ONE, ZERO = ("number", 1.0), ("number", 0.0)


def formula(node, ends, stands_for=MappingProxyType({}), guarded=()):
    """Tree of a recorded number: tuples of a kind and its parts.

    Kinds are "number" of a value, "name" of a node by its place in the graph, "sum" of pairs (sign, part), "product" of
    parts, "negative", "quotient", "power" and "call". The formula ends at the nodes in `ends`, except the node itself.
    `stands_for` maps a node to another of the same value; `guarded` are divisors at their least value,
    shown as "max" with that value.
    """
    if not isinstance(node, Node):
        return ("negative", ("number", -float(node))) if node < 0 else ("number", float(node))

    def part_of(part):
        found = stands_for.get(part, part) if isinstance(part, Node) else part
        part = part if found is node else found
        if isinstance(part, Node) and part in ends:
            return ("name", part.index)
        return formula(part, ends, stands_for, guarded)

    if node in guarded:
        return ("call", "max", *map(part_of, node.arguments))
    kept = (part for part in node.arguments if node.operation != "+" or not _is_offset(part))
    return _OPERATIONS[node.operation](*map(part_of, kept))


def _is_offset(term):
    """Whether a term of a sum only keeps it away from zero and changes no digit."""
    if isinstance(term, Node):
        factors = (part for part in term.arguments if isinstance(part, float))
        return term.operation == "*" and RELATIVE_OFFSET in factors
    return 0.0 < abs(term) < MAX_OFFSET


def _sum(*parts):
    terms = [term for part in parts for term in _terms(part) if term[1] != ZERO]
    if len(terms) > 1:
        return ("sum", *terms)
    ((sign, part),) = terms or [(1, ZERO)]
    return part if sign > 0 else ("negative", part)


def _difference(left, right=None):
    return _negative(left) if right is None else _sum(left, _negative(right))


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
    """Parts of 0.5 (a + b + |a - b|), the larger of two; None for any other sum."""
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
    "total": _sum,
    "rest": lambda *parts: ZERO,
    "held": lambda part: part,
    "divisor": lambda part, unit: part,
    **{name: (lambda part, *unit, name=name: _call(CALLS[name], part)) for name in CALLS},
}


def names_in(tree):
    """Indices of the nodes that a formula names, in order, each once."""
    if tree[0] == "name":
        return [tree[1]]
    found: dict[int, None] = {}
    for part in tree[1:]:
        if isinstance(part, tuple):
            found |= dict.fromkeys(names_in(part[1] if isinstance(part[0], int) else part))
    return list(found)

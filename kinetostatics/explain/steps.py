"""Lines of a calculation: which recorded numbers have their own formula, their values and units.

A formula ends at numbers named by the mechanism or by a kernel's `TERMS`. It also ends at another line of a kernel if
it is used more than once or the formula would be too long. So every number in a formula is given or appears in an
earlier line.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..engines.graph import INPUTS, Node, is_negative, needed
from ..engines.program import Program
from ..engines.record import Recording
from ..numbers.units import DIMENSIONLESS, dimension, unit_name
from .formulas import formula, names_in
from .named_recording import Named, Symbol

MAX_FORMULA_SIZE = 12
"""Largest number of names and constants in a formula; a longer formula is split."""
NOISE_RATIO = 2.0**-51
"""Largest value, relative to the sum of its terms (`_size`), that is shown as 0, because it is rounding."""


class Line(NamedTuple):
    """A number, its formula (`formulas`; None for a given number) and its value, which may be zero to rounding."""

    named: Named
    tree: Any
    value: float
    unit: str
    is_noise: bool
    node: Node


def lines(names, outputs, recorder, state):
    """Lines that lead to some recorded numbers, given numbers first; `state` is the scene at one crank angle."""
    values, sizes = _values(names, outputs, recorder, state)
    guarded = {node for node in values if node.operation == "divisor" and values[node] != values[node.arguments[0]]}
    ends = _ends(names, outputs, guarded)
    trees: dict[Node, Any] = {}
    waiting = list(outputs)
    while waiting:
        node = waiting.pop()
        if node not in trees:
            law = names.laws.get(node, node)
            if law is not node and law in ends:
                trees[node] = "name", law.index
            else:
                trees[node] = None if law.operation in INPUTS else formula(law, ends, names.stands_for, guarded)
            waiting += (names.graph[place] for place in names_in(trees[node])) if trees[node] else ()
    powers: dict[Node, Any] = {}
    for node in values:
        powers[node] = _powers(names, node, powers)
    noise = {node for node, value in values.items() if math.isfinite(value) and abs(value) <= NOISE_RATIO * sizes[node]}
    if any(node.operation == "/" and values[node] and node.arguments[1] in noise for node in values):
        noise = set()  # the scale of rounding is unknown where rounding divides
    found = []
    for node in _ordered(names, trees):
        named = names.of[node]
        unit = named.unit.replace("**", "").replace("*", " ") or unit_name(powers[node] or DIMENSIONLESS)
        found.append(Line(named, trees[node], values[node], unit, node in noise, node))
    return found


def _ordered(names, trees):
    """Nodes of lines in the order of their names, each after its operands, components of a vector together."""
    places = {node: place for place, node in enumerate(names.of)}
    ranks = {title: rank for rank, title in enumerate(names.titles)}
    wholes: dict[Any, list[Node]] = {}
    for node in sorted(trees, key=places.__getitem__):
        named = names.of[node]
        whole = (named.title, named.symbol._replace(axis="")) if named.kind == "protocol" else node
        wholes.setdefault(whole, []).append(node)
    whole_of = {node: nodes for nodes in wholes.values() for node in nodes}
    found: dict[Node, None] = {}
    begun: set[Node] = set()

    def needs(node):
        return [names.graph[place] for place in names_in(trees[node])] if trees[node] and node not in names.laws else []

    def tell_whole(node):
        if node not in begun:
            begun.update(whole_of[node])
            for part in whole_of[node]:
                for need in needs(part):
                    tell_whole(need)
        for part in whole_of[node]:
            tell(part)

    def tell(node):
        if node not in found:
            for need in needs(node):
                tell(need)
            found[node] = None

    given = [node for node in trees if names.of[node].kind == "given"]
    for node in sorted(given, key=lambda node: node.index):
        tell(node)
    for node in sorted(trees, key=lambda node: (ranks.get(names.of[node].title, -1), places[node])):
        tell_whole(node)
    return list(found)


def _ends(names, outputs, guarded):
    """Nodes at which formulas end."""
    found = _in_order_of_use(names, outputs)
    users = dict.fromkeys(found, 0)
    for node in found:
        for part in set(_parts(names, node)):
            users[part] += 1
    ends = {node for node in found if node.operation in INPUTS or names.has_own_name(node)}
    sizes: dict[Any, int] = {}
    found = [node for node in found if node not in names.laws]
    for place, node in enumerate(found):
        parts = _parts(names, node)
        while sum(1 if part in ends else sizes[part] for part in parts) > MAX_FORMULA_SIZE:
            whole = _largest(parts, ends, sizes, names)
            if whole not in names.of:
                titles = (names.of[one].title for one in found[place:] if names.has_own_name(one))
                names.of[whole] = Named(Symbol("k"), next(titles, names.titles[-1]), kind="line")
            ends.add(whole)
        sizes[node] = max(1, sum(1 if part in ends else sizes[part] for part in parts))
        if node in names.of and node.operation not in ("divisor", "held"):
            is_root = node.operation in ("sqrt", "root")
            if (sizes[node] > 1 or is_root) if names.of[node].kind == "term" else users[node] > 1 and sizes[node] > 2:
                ends.add(node)
    return ends


def _largest(parts, ends, sizes, names):
    """The largest part that is not yet an end; if it has no name, its largest named part of sufficient size."""
    whole = max((part for part in parts if part not in ends), key=sizes.__getitem__)
    inner = whole
    while inner not in names.of:
        below = [part for part in _parts(names, inner) if part not in ends]
        if not below or max(map(sizes.__getitem__, below)) < MAX_FORMULA_SIZE // 3:
            return whole
        inner = max(below, key=sizes.__getitem__)
    return inner


def _parts(names, node):
    """Operands of a node, or its law, as formulas use them."""
    if node in names.laws:
        law = names.laws[node]
        return [names.stands_for.get(law, law)] if isinstance(law, Node) else []
    own = names.stands_for.get(node.arguments[0]) is node if node.operation == "held" else False
    nodes = (part for part in node.arguments if isinstance(part, Node) and part.operation != "rest")
    return [part if own else names.stands_for.get(part, part) for part in nodes]


def _in_order_of_use(names, outputs):
    """Nodes that the outputs depend on, operands first, without iterations of friction."""
    reached: set[Node] = set()
    waiting = list(outputs)
    while waiting:
        node = waiting.pop()
        if node not in reached:
            reached.add(node)
            waiting += _parts(names, node)
    found: dict[Node, None] = {}
    for last in sorted(reached, key=lambda node: (node in names.laws, node.index)):
        waiting = [last]
        while waiting:
            node = waiting[-1]
            missing = [] if node in names.laws else [part for part in _parts(names, node) if part not in found]
            if missing:
                waiting += missing
            else:
                found[waiting.pop()] = None
    return list(found)


def _values(names, outputs, recorder, state):
    """Values by node, and sizes by node, see `_size`."""
    every = needed([*outputs, *names.laws.values(), *names.stands_for.values()])
    recording = Recording((), tuple(every), (), (), tuple(recorder.parameters), tuple(recorder.tables), recorder.graph)
    _, leaves = state.apart
    with np.errstate(all="ignore"):
        rows = Program(recording).run(state, leaves)
    values = dict(zip(every, rows.reshape(len(every)).tolist(), strict=True))
    sizes: dict[Any, float] = {}
    for node in every:
        sizes[node] = _size(node, values, sizes)
    return values, sizes


def _size(node, values, sizes):
    """Magnitude of the value plus, to first order, the effect of the sizes of its operands."""
    value, kind = values[node], node.operation
    if kind in (*INPUTS, "rest"):
        return abs(value)
    if kind == "total":
        parts = {part.arguments[0] if is_negative(part) else part for part in node.arguments if isinstance(part, Node)}
        exact = {part.arguments[0] for part in parts if part.operation == "rest"}
        return abs(value) + sum(sizes[part] - abs(values[part]) for part in parts if part not in exact)
    (a, x), (b, y) = [
        (values[part], sizes[part]) if isinstance(part, Node) else (part, 0.0) for part in (*node.arguments, 0.0)[:2]
    ]
    if kind in ("+", "-"):
        made = x + y
    elif kind == "*":
        made = abs(a) * y + abs(b) * x
    elif kind == "/":
        made = (x + abs(value) * y) / abs(b) if b else 0.0
    elif kind in ("sqrt", "root"):
        made = x / (2.0 * value) if value else 0.0
    elif kind == "exp":
        made = value * x
    elif kind == "log":
        made = x / abs(a) if a else 0.0
    else:
        made = 0.0 if kind == "sign" else x
    return abs(value) + made


def _powers(names, node, known):
    """Powers of m, kg and s of a number's unit, from those of its operands; None for a constant."""
    named, kind = names.of.get(node), node.operation
    if named is not None and named.unit:
        return dimension(named.unit)
    if kind in INPUTS or kind in ("sin", "cos", "atan", "exp", "log", "sign"):
        return DIMENSIONLESS
    parts = [known[part] if isinstance(part, Node) else None for part in node.arguments]
    if kind == "*" and 0.0 in [part for part in node.arguments if not isinstance(part, Node)]:
        return None
    if kind in ("*", "/"):
        sign = 1 if kind == "*" else -1
        if parts[1] is None:
            return parts[0]
        return tuple(a + sign * b for a, b in zip(parts[0] or DIMENSIONLESS, parts[1], strict=True))
    if kind in ("sqrt", "root"):
        return None if parts[0] is None else tuple(part / 2 for part in parts[0])
    return next((part for part in parts if part is not None), None)

"""Proven bounds on the rounding errors of recorded outputs, as further nodes of the same graph.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, section 3.3): beside each value
v go a number k, which the structure fixes, and E, which is computed along with it, so that exact arithmetic on the same
inputs gives a number within ``UNIT (k |v| + E)`` of v. Products, quotients and roots of what has few relative errors
(k) have few as well; E begins where sums cancel. Terms of second order are in it, and what is too small for a double.
"""

import math
from collections.abc import Callable
from functools import reduce
from typing import Any, NamedTuple

from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .functions import ULP, beside_length, beside_one, lost_by_total, moved_apart
from .graph import INPUTS, Node, is_negative, needed

SAFE = 1.0 + 1e-9
"""What a bound is enlarged by for the rounding of its own arithmetic, each time by a few `UNIT` of it."""
DUST = 2.0**-960
"""In `UNIT`: more than what is lost where a product or quotient, of bounds too, is too small for a double."""
CAP = 2.0**100
"""Largest number of a scene, in SI, for which dust stays dust; of tables each value counts."""
LARGEST = 2.0**1000
"""Less than what has a reciprocal too small for a double."""


class Error(NamedTuple):
    """Bound on the error of a value, in `UNIT`: `relative` times the value, and `rest`.

    The rest is None, a number if it is dust only, or a node.
    """

    relative: float
    rest: Any


EXACT = Error(0.0, None)


class Bounds:
    """Bounds for the nodes of a graph, each found once.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        ``input(bounds) -> Error`` of inputs that are not exact.
    dust : float or None
        What a product or quotient may lose if it is too small for a double; None if none is.
    """

    def __init__(self, graph, inputs=None, dust=DUST):
        self._graph, self._inputs, self._dust = graph, inputs or {}, dust
        self._uses: dict[Node, list[str]] = {}
        self._parts: dict[Node, tuple[Any, ...]] = {}
        self._errors: dict[Node, Error] = {}
        self._totals: dict[Node, Any] = {}
        self._clear: dict[Node, Any] = {}
        self._over: dict[Node, Any] = {}
        self._steepest: dict[Node, Any] = {}
        self._caps: dict[Node, float | None] = {}

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN where there is none."""
        nodes = [node for node in needed(outputs) if node not in self._errors]
        self.tell_uses(nodes)
        for node in nodes:
            self._errors[node] = self._found(node)
        return tuple(whole(self.total(part)) for part in outputs)

    def tell_uses(self, nodes):
        """Take note of what nodes are used for: it decides in which of two ways a bound is found."""
        for node in nodes:
            for part in node.arguments:
                self._uses.setdefault(part, []).append(node.operation)

    def _found(self, node):
        if node in self._inputs or node.operation in INPUTS:
            return self._inputs[node](self) if node in self._inputs else EXACT
        relative, rest = self.own(node)
        carried = _CARRIED[node.operation](self, rest, node, *node.arguments)
        return Error(relative + carried.relative, carried.rest)

    def own(self, node) -> Error:
        """What an operation itself adds to the error of its result."""
        kind, arguments = node.operation, node.arguments
        if any(map(is_zero, (node, *arguments))) and kind in "+-*":
            return EXACT
        if self.is_reciprocal(node):
            return Error(1.0, None)
        if kind in ("*", "/"):
            return Error(0.0 if any(map(is_scaling, arguments[kind == "/" :])) else 1.0, self._dust)
        if kind == "total":
            return Error(1.0, lost_by_total(self._graph, node))
        if kind in ("+", "-"):
            return Error(1.0, moved_apart(arguments)) if len(arguments) == 2 else EXACT
        if kind == "divisor":  # none is proven where the guard may act
            root, unit = arguments
            return Error(0.0, 0.0 / self.above(root, self.total(root), unit))
        if kind == "sign" and self.total(arguments[0]) is not None:  # nor where it may be the other
            return Error(0.0, 0.0 / self.clear(arguments[0]))
        return Error(ULP.get(kind, 0.0), None)

    def error(self, part) -> Error:
        return self._errors[part] if isinstance(part, Node) else EXACT

    def total(self, part):
        """The whole bound of a part of an operation; None where it is exact."""
        if isinstance(part, Node) and part not in self._totals:
            self._totals[part] = self._total(part, *self._errors[part])
        return self._totals[part] if isinstance(part, Node) else None

    def _total(self, part, relative, rest):
        if not relative:
            return rest
        if part in self._parts and set(self._uses.get(part, ())) <= {"+", "-"}:  # of a product, none of it by itself
            left, own, right, across = self._parts[part]
            return self.fused(size(right), self.fused(relative, size(left), own), across)
        return self.fused(relative, size(part), rest)

    def of_product(self, node, left, own, right, across):
        """Rest of a product whose left factor has a rest that is a node, beside what else it has."""
        self._parts[node] = left, own, right, across
        return self.fused(size(right), own, across)

    def of_two_parts(self, rest):
        """Bound on the error of a length and its rest together, those of its components among it."""
        dust = None if self._dust is None else self._dust / rest.arguments[0]
        return reduce(plus, map(self.total, rest.arguments[1:]), plus(beside_length(self._graph, rest), dust))

    def uses(self, part):
        """How often a part is used."""
        return len(self._uses.get(part, ()))

    def largest(self, part):
        """Bound on the magnitude of the exact value, but for relative errors."""
        rest = self.error(part).rest
        return size(part) if rest is None else self.fused(UNIT, rest, size(part))

    def clear(self, part):
        """What is left of a value's magnitude when its error is taken off; 0 where nothing is."""
        if part not in self._clear:
            total = self.total(part)
            self._clear[part] = size(part) if total is None else self.above(size(part), total)
        return self._clear[part]

    def above(self, value, total, floor=None):
        """By how much a value is above a floor when its error is taken off; 0 where it may not be."""
        if total is not None:
            value = value - (SAFE * UNIT) * total
        return self._graph.node("divisor", value if floor is None else value - floor, 0.0)

    def over(self, part):
        """Bound on one over the magnitude of the exact value; none where that is too large for a double."""
        if not isinstance(part, Node):
            return 1.0 / abs(part)
        if part not in self._over:
            clear = self.clear(part)
            self._over[part] = self.fused(0.0, clear, 1.0 / clear)
        return self._over[part]

    def is_dust(self, part):
        """Whether the rest of the bound of a part is dust, or none."""
        return not isinstance(self.error(part).rest, Node)

    def is_reciprocal(self, part):
        """Whether a part is one over a number that is not so large that the quotient is too small for a double."""
        if not isinstance(part, Node) or part.operation != "/":
            return False
        above, below = part.arguments
        return not isinstance(above, Node) and abs(above) == 1.0 and (self.cap(below) or math.inf) < LARGEST

    def steepest(self, root, square):
        """Bound on the slope of a root between the square and the exact one; infinite if that may be negative."""
        if root not in self._steepest:
            self._steepest[root] = (0.5 * root) / self.above(square, self.total(square))
        return self._steepest[root]

    def dust(self, rest, part):
        """A rest that is dust times the magnitude of a part: a number still where the part's cap is known."""
        if rest is None:
            return None
        cap = self.cap(part)
        return rest * (size(part) if cap is None else 2.0 * cap)

    def fused(self, one, other, more):
        return fused(self._graph, one, other, more)

    def cap(self, part):
        """Largest magnitude of a part for inputs up to `CAP`; None if only the computed value tells."""
        if not isinstance(part, Node):
            return abs(part)
        if part not in self._caps:
            rule = _CAPS.get(part.operation)
            caps = [] if part.operation in INPUTS else [self.cap(argument) for argument in part.arguments]
            self._caps[part] = None if rule is None or None in caps else rule(*caps)
        return self._caps[part]


def size(part):
    """Magnitude of a part of an operation."""
    if not isinstance(part, Node):
        return abs(part)
    if part.operation == "-" and len(part.arguments) == 1:
        return size(part.arguments[0])
    square = part.operation == "*" and part.arguments[0] is part.arguments[1]
    return part if square or part.operation in ("abs", "sqrt", "root", "divisor") else abs(part)


def whole(total):
    """A bound from one in `UNIT`."""
    return 0.0 if total is None else (SAFE * UNIT) * total


def fused(graph, one, other, more):
    """Product and sum, in one operation where the processor has it."""
    plain = [part for part in (one, other) if not isinstance(part, Node)]
    if more is None or len(plain) == 2 or 1.0 in plain:
        return plus(one * other, more)
    return graph.node("fma", one, other, more)


def is_zero(part):
    """Whether a part of an operation is a product with the number 0."""
    factors = part.arguments if isinstance(part, Node) and part.operation == "*" else ()
    return any(not isinstance(factor, Node) and factor == 0.0 for factor in factors)


def is_scaling(part):
    """Whether a factor is a sign, or a power of two near one: it loses no digit but of dust."""
    if isinstance(part, Node):
        return part.operation == "sign"
    return math.frexp(part)[0] in (0.5, -0.5) and 0.01 < abs(part) < 100.0


# What a result has of the errors of its arguments, and some more


def _of_sum(bounds, more, node, *parts):
    if (near := beside_one(bounds._graph, node, bounds.total)) is not None:
        return Error(0.0, near)
    others = [part for part in parts if not is_zero(part) or bounds.error(part).rest is not None]
    if len(others) < 2 and more is None:
        return bounds.error(others[0]) if others else EXACT
    return Error(0.0, reduce(plus, map(bounds.total, others), more))


def _of_total(bounds, more, node, *parts):
    """Sum of the errors; of a length and its rest, one taken with the other, only what the rest is off."""
    signed = [_signed(part) for part in parts if isinstance(part, Node)]
    places = [(sign, part.index) for sign, part in signed]
    paired = set()
    for place, (sign, part) in enumerate(signed):
        whole = (sign, part.arguments[0].index) if part.operation == "rest" else None
        if whole in places and places.index(whole) not in paired:
            paired |= {place, places.index(whole)}
            more = plus(bounds.of_two_parts(part), more)
    others = (bounds.total(part) for place, (_, part) in enumerate(signed) if place not in paired)
    return Error(0.0, reduce(plus, others, more))


def _signed(part):
    """Sign, and the part that it is the sign of."""
    return (-1, part.arguments[0]) if isinstance(part, Node) and is_negative(part) else (1, part)


def _of_product(bounds, more, node, left, right):
    if is_zero(node):  # of what may be none, it is none
        total = next(bounds.total(factor) for factor in (left, right) if isinstance(factor, Node))
        return Error(0.0, 0.0 * total) if isinstance(total, Node) else EXACT
    for factor, above in ((left, right), (right, left)):
        if bounds.is_reciprocal(factor) and not bounds.is_dust(factor):  # as of a quotient
            rest = _of_quotient(bounds, more, node, above, factor.arguments[1]).rest
            return Error(bounds.error(above).relative + bounds.error(factor).relative, rest)
    first, second = bounds.error(left).rest, bounds.error(right).rest
    if isinstance(second, Node) and not (isinstance(first, Node) and bounds.uses(left) > bounds.uses(right)):
        left, right = right, left
    (first, own), (second, other) = bounds.error(left), bounds.error(right)
    if not isinstance(own, Node):
        across = more if None in (own, other) else plus(UNIT * own * other, more)
        return Error(first + second, plus(plus(bounds.dust(own, right), bounds.dust(other, left)), across))
    if isinstance(other, Node) or (other is not None and bounds.cap(left) is None):
        across = bounds.fused(bounds.largest(left), other, more)
    else:
        across = plus(bounds.dust(other, left), more)
    return Error(first + second, bounds.of_product(node, left, own, right, across))


def _of_quotient(bounds, more, node, above, below):
    (first, own), (second, other) = bounds.error(above), bounds.error(below)
    top = own if other is None else bounds.fused(size(node), other, own)
    return Error(first + second, more if top is None else bounds.fused(bounds.over(below), top, more))


def _of_root(bounds, more, node, square, unit=None):
    relative, rest = bounds.error(square)
    if not bounds.is_dust(square):
        rest = more if rest is None else bounds.fused(bounds.steepest(node, square), rest, more)
    else:
        rest = None if rest is None else math.sqrt(rest / UNIT)
        if node.operation == "root" and size(square) is not square:  # none where it is negative for sure
            rest = plus(0.0 * square.sqrt(), rest)
    return Error(0.5 * relative, rest)


def _of_function(bounds, more, node, argument):
    """Of one that changes no faster than its argument."""
    return Error(0.0, bounds.total(argument))


def _as_of_argument(bounds, more, node, argument, unit=None):
    relative, rest = bounds.error(argument)
    return Error(relative, plus(rest, more))


_CARRIED: dict[str, Callable[..., Error]] = {
    "total": _of_total,
    "rest": lambda bounds, more, node, *arguments: Error(0.0, size(node) * (1.0 / UNIT)),
    "+": _of_sum,
    "-": _of_sum,
    "*": _of_product,
    "/": _of_quotient,
    "sqrt": _of_root,
    "root": _of_root,
    "sin": _of_function,
    "cos": _of_function,
    "atan": _of_function,
    "abs": _as_of_argument,
    "held": _as_of_argument,
    "divisor": _as_of_argument,
    "sign": lambda bounds, more, node, value: Error(0.0, more),
}
_CAPS: dict[str, Callable[..., float]] = {
    "parameter": lambda: CAP,
    "total": lambda *parts: sum(parts),
    "+": lambda left, right: left + right,
    "-": lambda *parts: sum(parts),
    "*": lambda left, right: left * right,
    "sin": lambda angle: 1.0,
    "cos": lambda angle: 1.0,
    "abs": lambda value: value,
    "held": lambda value: value,
    "sqrt": math.sqrt,
    "root": lambda square, unit: math.sqrt(square),
    "divisor": max,
}

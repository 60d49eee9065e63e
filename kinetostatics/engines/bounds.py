"""Proven bounds on the rounding errors of recorded outputs, as further nodes of the same graph.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, section 3.3): beside each value
v go a number k, which the structure fixes, and E, which is computed along with it, so that exact arithmetic on the same
inputs gives a number within ``UNIT (k |v| + E)`` of v. Products, quotients and roots of what has few relative errors
(k) have few as well; E begins where sums cancel. Terms of second order are in it, and what is too small for a double.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .derivatives import adjoints
from .trace import INPUTS, Node, needed

SAFE = 1.0 + 1e-9
"""What a bound is enlarged by for the rounding of its own arithmetic, each time by a few `UNIT` of it."""
DUST = 2.0**-960
"""In `UNIT`: more than what is lost where a product or quotient, of bounds too, is too small for a double."""
CAP = 2.0**100
"""Largest input, in SI, for which dust stays dust."""
ULP = {"sin": 2.0, "cos": 2.0, "atan": 2.0, "sqrt": 1.0, "root": 1.0}
"""Largest relative error of a function of any backend, in `UNIT`; a test holds NumPy and compiled loops to it."""


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
    """

    def __init__(self, graph, inputs=None):
        self._graph, self._inputs = graph, inputs or {}
        self._errors: dict[Node, Error] = {}
        self._totals: dict[Node, Any] = {}
        self._clear: dict[Node, Any] = {}
        self._over: dict[Node, Any] = {}
        self._caps: dict[Node, float | None] = {}

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN where there is none."""
        for node in needed(outputs):
            if node not in self._errors:
                self._errors[node] = self._found(node)
        return tuple(_whole(self.total(part)) for part in outputs)

    def tight(self, output):
        """A bound for one output, as `of` gives it, from what the error of each operation makes of the output.

        Derivatives of the output say so, bounded for all values within the bounds of `of`.
        """
        self.of([output])
        unsure = {node for node in needed([output]) if self.total(node) is not None}
        slopes = adjoints(self._graph, output, unsure) if output in unsure else {}
        self.of(slopes.values())
        total = DUST if slopes else None
        for node, slope in slopes.items():  # what derivatives hold comes with its whole error
            own = self.total(node) if node.operation in (*INPUTS, "held") else self._sum(self.own(node), node)
            if own is not None:
                total = self.fused(self.largest(slope), own, total)
        return _whole(total)

    def _found(self, node):
        if node.operation in INPUTS:
            return self._inputs[node](self) if node in self._inputs else EXACT
        relative, rest = self.own(node)
        carried = _CARRIED[node.operation](self, rest, node, *node.arguments)
        return Error(relative + carried.relative, carried.rest)

    def own(self, node) -> Error:
        """What an operation itself adds to the error of its result."""
        kind, arguments = node.operation, node.arguments
        if kind in ("*", "/"):
            return Error(0.0 if any(map(_is_scaling, arguments[kind == "/" :])) else 1.0, DUST)
        if kind in ("+", "-"):
            return Error(1.0, None) if len(arguments) == 2 else EXACT
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
            self._totals[part] = self._sum(self._errors[part], part)
        return self._totals[part] if isinstance(part, Node) else None

    def _sum(self, error, part):
        return self.fused(error.relative, size(part), error.rest) if error.relative else error.rest

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

    def above(self, value, total, floor=0.0):
        """By how much a value is above a floor when its error is taken off; 0 where it may not be."""
        taken = floor if total is None else (SAFE * UNIT) * total + floor
        return self._graph.node("divisor", value - taken, 0.0)

    def over(self, part):
        """Bound on one over the magnitude of the exact value."""
        if part not in self._over:
            self._over[part] = 1.0 / self.clear(part) if isinstance(part, Node) else 1.0 / abs(part)
        return self._over[part]

    def dust(self, rest, part):
        """A rest that is dust times the magnitude of a part: a number still where the part's cap is known."""
        if rest is None:
            return None
        cap = self.cap(part)
        return rest * (size(part) if cap is None else 2.0 * cap)

    def fused(self, one, other, more):
        """Product and sum, in one operation where the processor has it."""
        plain = [part for part in (one, other) if not isinstance(part, Node)]
        if more is None or len(plain) == 2 or 1.0 in plain:
            return plus(one * other, more)
        return self._graph.node("fma", one, other, more)

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
    square = part.operation == "*" and part.arguments[0] is part.arguments[1]
    return part if square or part.operation in ("abs", "sqrt", "root", "divisor") else abs(part)


def of_magnitude(vector, bounds):
    """Bound on the error of a vector's magnitude, from the vector's values and those of its components."""
    return np.hypot(*bounds) * SAFE + 4 * UNIT * np.hypot(*vector)


def _whole(total):
    return 0.0 if total is None else (SAFE * UNIT) * total


def _is_scaling(part):
    """Whether a factor is a power of two near one: it loses no digit but of dust."""
    return not isinstance(part, Node) and math.frexp(part)[0] in (0.5, -0.5) and 0.01 < abs(part) < 100.0


# What a result has of the errors of its arguments, and some more


def _of_sum(bounds, more, node, *parts):
    if len(parts) == 1:
        return bounds.error(parts[0])
    return Error(0.0, plus(*(bounds.total(part) for part in parts)))


def _of_product(bounds, more, node, left, right):
    if isinstance(bounds.error(right).rest, Node):
        left, right = right, left
    (first, own), (second, other) = bounds.error(left), bounds.error(right)
    if isinstance(own, Node):
        across = more if other is None else bounds.fused(bounds.largest(left), other, more)
        return Error(first + second, bounds.fused(size(right), own, across))
    across = more if None in (own, other) else plus(UNIT * own * other, more)
    return Error(first + second, plus(plus(bounds.dust(own, right), bounds.dust(other, left)), across))


def _of_quotient(bounds, more, node, above, below):
    (first, own), (second, other) = bounds.error(above), bounds.error(below)
    top = own if other is None else bounds.fused(size(node), other, own)
    return Error(first + second, more if top is None else bounds.fused(bounds.over(below), top, more))


def _of_root(bounds, more, node, square, unit=None):
    relative, rest = bounds.error(square)
    if isinstance(rest, Node):
        left = bounds.above(square, bounds.total(square))  # nothing, if it may be negative
        rest = bounds.fused(0.5 * rest, node / left, more)
    elif rest is not None:
        rest = math.sqrt(rest / UNIT)
    return Error(0.5 * relative, rest)


def _of_function(bounds, more, node, argument):
    """Of one that changes no faster than its argument."""
    return Error(0.0, bounds.total(argument))


def _as_of_argument(bounds, more, node, argument, unit=None):
    relative, rest = bounds.error(argument)
    return Error(relative, plus(rest, more))


_CARRIED: dict[str, Callable[..., Error]] = {
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
    "table": lambda: CAP,
    "+": lambda left, right: left + right,
    "-": lambda *parts: sum(parts),
    "*": lambda left, right: left * right,
    "sin": lambda angle: 1.0,
    "cos": lambda angle: 1.0,
    "abs": lambda value: value,
    "held": lambda value: value,
    "sqrt": math.sqrt,
}

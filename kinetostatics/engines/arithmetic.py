"""Bounds on the errors of a program that another arithmetic runs than the one that bounds are computed in.

A value may come in single precision, or from a compiler that fuses products and sums and takes what is too small for
zero. Bounds are then computed beside the same values in double, which differ from the exact ones by less: whatever
order of roundings the other takes, each result is within its unit of the exact one of what went into it.

Of numbers of more digits the same holds: in double a value v has an error of at most 2^-53 (k |v| + E), and what that
makes of a rounding is of second order.
"""

from collections.abc import Callable, Mapping
from functools import partial, reduce
from operator import add
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .bounds import EXACT, SAFE, Bounds, Error, is_zero, size
from .functions import ULP, beside_one, moved_apart
from .graph import BY_ANGLE, INPUTS, Node, needed


class Arithmetic(NamedTuple):
    """What is known of a floating-point arithmetic.

    Attributes
    ----------
    dtype : type
    unit : float
        Largest relative error of one rounding.
    safe : float
        What bounds are enlarged by for terms of second order, over all operations one after the other.
    least : float
        In `unit`: twice the smallest number with all its digits; what is smaller may be lost.
    limit : float
        Half of the largest power of two.
    ulp : mapping of str to float
        Largest relative error of each function, in `unit`; a test holds all engines to it.
    """

    dtype: Any
    unit: float
    safe: float
    least: float
    limit: float
    ulp: Mapping[str, float]


SINGLE_ULP = {"sin": 8.0, "cos": 8.0, "atan": 8.0, "sqrt": 1.0, "root": 1.0}
SINGLE = Arithmetic(np.float32, 2.0**-24, 1.0 + 2.0**-5, 2.0**-101, 2.0**126, SINGLE_ULP)
DOUBLE = Arithmetic(np.float64, UNIT, SAFE, 2.0**-960, 2.0**1022, dict.fromkeys(ULP, 4.0) | {"sqrt": 1.0, "root": 1.0})
LONGER = Arithmetic(np.longdouble, 2.0**-64, 1.0 + 2.0**-10, 2.0**-930, 2.0**1022, {"sin": 0.0, "cos": 0.0})
"""Of numbers of more digits, `longdouble` or `Twofold`, the coarser of both; sines have a bound of their own."""
OF = {"double": DOUBLE, "single": SINGLE}
"""By what a user calls it."""
SECOND_ORDER = 8.0
"""Roundings of an operation, beside those that its arguments bring, that make terms of second order."""


def is_handed_over(node):
    """Whether a node is computed in double beforehand: what a design fixes, tables, sine and cosine of the crank."""
    of_angle = node.operation in ("sin", "cos") and node.arguments[0].operation == "angle"
    return node.varies < BY_ANGLE or node.operation in INPUTS or of_angle


class BoundsElsewhere:
    """Bounds for the nodes of a graph that another arithmetic computes; what is handed over to it is rounded once.

    As in `Bounds` an exact value is within ``unit (k |v| + E)`` of the one computed, but v is the value in double, and
    E, a node or a number, is never absent: in it is what may be lost as too small.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        As for `Bounds`.
    arithmetic : Arithmetic
    """

    @property
    def rules(self):
        return RULES

    def __init__(self, graph, inputs, arithmetic):
        self._graph, self._arithmetic, self._in_double = graph, arithmetic, Bounds(graph, inputs)
        self._inputs = inputs
        self._off = arithmetic.safe * arithmetic.unit
        self._fused = self._in_double.fused
        self._errors: dict[Node, Error] = {}
        self._reaches: dict[Node, Any] = {}
        self._depths: dict[Node, int] = {}

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN where there is none."""
        for node in needed(outputs):
            if node not in self._errors:
                self._errors[node] = self._handed_over(node) if is_handed_over(node) else self._found(node)
                self._look_at(node)
        return tuple(map(self._whole, outputs))

    def _whole(self, part):
        bound = (self._arithmetic.safe * self._arithmetic.unit) * self.total(part)
        if not isinstance(part, Node):
            return bound
        return bound + 0.0 / self._positive(self._arithmetic.limit - self._reaches[part])

    def _handed_over(self, node):
        self._in_double.of([node])
        relative, rest = self._in_double.error(node)
        finer = UNIT / self._arithmetic.unit
        rounded = 0.0 if finer == 1.0 else 1.0
        return Error(rounded + finer * relative, plus(None if rest is None else finer * rest, self._arithmetic.least))

    def _found(self, node):
        if node in self._inputs:
            relative, rest = self._inputs[node](self)
            return Error(relative, plus(rest, self._arithmetic.least))
        kind, parts = node.operation, node.arguments
        relative, carried = self.rules[kind](self, node, *parts)
        own = 0.0 if kind in EXACTLY or (len(parts) < 2 and kind == "-") else self._arithmetic.ulp.get(kind, 1.0)
        is_sum = kind in ("+", "-") and all(isinstance(part, Node) for part in parts)
        return Error(relative + own, carried if is_sum or kind in EXACTLY else carried + self._arithmetic.least)

    def _look_at(self, node):
        """How many operations one after the other lead to a node, and the largest number on the way."""
        parts = [] if is_handed_over(node) else [part for part in node.arguments if isinstance(part, Node)]
        self._depths[node] = 1 + max((self._depths[part] for part in parts), default=0)
        unit, safe = self._arithmetic.unit, self._arithmetic.safe
        if self._depths[node] * (self._errors[node].relative + SECOND_ORDER) * unit > (safe - 1.0) / 4.0:
            raise NotGivenError("no bound can be given in this precision: too many operations follow one another")
        reaches = [self._reaches[part] for part in parts]
        if not parts or node.operation in ("+", "-", "*", "/", "divisor"):
            reaches.append(self.largest(node))
        if node.operation == "total":
            reaches.append(reduce(add, map(self.largest, node.arguments)))
        self._reaches[node] = reduce(partial(self._graph.node, "divisor"), reaches)

    def error(self, part) -> Error:
        """Of a constant too, which may be no number of this arithmetic."""
        if isinstance(part, Node):
            return self._errors[part]
        least = self._arithmetic.least
        with np.errstate(over="ignore"):
            same = float(self._arithmetic.dtype(part)) == part
        exact = part == 0.0 or (same and abs(part) > self._arithmetic.unit * least)
        return Error(0.0, 0.0) if exact else Error(1.0, least)

    def total(self, part):
        """The whole bound of a part of an operation, in units."""
        relative, rest = self.error(part)
        return self._fused(relative, size(part), rest) if relative else rest

    def largest(self, part):
        """Bound on the magnitude of the computed value and of the exact one, but for relative errors."""
        return self._fused(self._off, self.error(part).rest, size(part))

    def clear(self, value, part, floor=0.0):
        """What is left of a value above a floor when the error of a part is taken off; 0 where nothing is."""
        return self._positive(value - self._off * self.total(part) - floor)

    def _positive(self, value):
        return self._graph.node("divisor", value, 0.0) if isinstance(value, Node) else max(value, 0.0)

    def of_sum(self, node, left, right=None):
        if (near := beside_one(self._graph, node, self.total, self._arithmetic.unit)) is not None:
            return Error(0.0, near)
        if right is None:
            return self.error(left)
        moved = moved_apart((left, right), self._arithmetic.unit)
        return Error(0.0, plus(self.total(left) + self.total(right), moved))

    def of_product(self, node, left, right):
        (first, own), (second, other) = self.error(left), self.error(right)
        if is_zero(node):  # of what may be none, it is none
            return Error(0.0, 0.0 * own + 0.0 * other)
        return Error(first + second, self._fused(size(right), own, self.largest(left) * other))

    def of_quotient(self, node, above, below):
        (first, own), (second, other) = self.error(above), self.error(below)
        return Error(first + second, self._fused(size(node), other, own) / self.clear(size(below), below))

    def of_root(self, node, square, unit=None):
        relative, rest = self.error(square)
        return Error(0.5 * relative, 0.5 * rest * (node / self.clear(square, square)))

    def of_total(self, node, *parts):
        """Sums without loss, and what those of their losses lose, more if products are fused with them."""
        lost = (2.0 * (len(parts) - 1)) ** 3 * self._arithmetic.unit
        return Error(0.0, reduce(add, (self._fused(lost, self.largest(part), self.total(part)) for part in parts)))

    def of_divisor(self, node, root, unit):
        """None is proven where the guard may act."""
        relative, rest = self.error(root)
        return Error(relative, rest + 0.0 / self.clear(root, root, 2.0 * self.largest(unit)))


EXACTLY = ("abs", "held", "divisor", "sign")
"""Operations that round nothing."""
RULES: dict[str, Callable[..., Error]] = {
    "+": BoundsElsewhere.of_sum,
    "-": BoundsElsewhere.of_sum,
    "total": BoundsElsewhere.of_total,
    "*": BoundsElsewhere.of_product,
    "/": BoundsElsewhere.of_quotient,
    "sqrt": BoundsElsewhere.of_root,
    "root": BoundsElsewhere.of_root,
    **dict.fromkeys(("sin", "cos", "atan"), lambda bounds, node, argument: Error(0.0, bounds.total(argument))),
    **dict.fromkeys(("abs", "held"), lambda bounds, node, argument: bounds.error(argument)),
    "divisor": BoundsElsewhere.of_divisor,
    "sign": lambda bounds, node, value: Error(0.0, 0.0 / bounds.clear(size(value), value)),
}
"""What a result has of the errors of its arguments."""


OFF = 2.0**-40
"""In `largest` and `clear` of numbers of more digits: far more than the `UNIT` by which doubles beside them are off."""
TURN = 2.0
"""By how much sines and cosines of more digits are off, in their unit; a test holds both kinds to it."""


class BoundsOfLonger(BoundsElsewhere):
    """Bounds for nodes of a graph of which numbers of more digits are found by the same operations, all but inputs.

    Of a `Twofold` the second part is at most ``UNIT (k |v| + E)``, or with a `total` not much more, and an operation
    loses some `UNIT` of that; a product drops that of both second parts, which `OFF` covers.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        As for `Bounds`.
    """

    def __init__(self, graph, inputs):
        super().__init__(graph, inputs, LONGER)
        self._off = OFF

    @property
    def rules(self):
        return RULES_OF_LONGER

    def of(self, outputs):
        for node in needed(outputs):
            if node not in self._errors:
                self._errors[node] = self._given(node) if node.operation in INPUTS else self._found(node)
        return tuple((LONGER.safe * LONGER.unit) * self.total(part) for part in outputs)

    def _given(self, node):
        relative, rest = self._inputs[node](self) if node in self._inputs else EXACT
        finer = UNIT / LONGER.unit
        return Error(finer * relative, plus(None if rest is None else finer * rest, LONGER.least))

    def of_sum(self, node, *parts):
        if len(parts) < 2:
            return self.error(*parts)
        return Error(0.0, plus(reduce(add, map(self.total, parts)), moved_apart(parts, LONGER.unit)))

    def of_total(self, node, *parts):
        """Numbers in two parts are just added, and what second parts lose may cancel less than the total does."""
        return Error(0.0, reduce(add, (self._fused(2.0**-4, self.largest(part), self.total(part)) for part in parts)))

    def of_rest(self, node, length, x, y):
        """Truly nothing, and found as what the length is off from the vector's."""
        return Error(0.0, self.total(length) + self.total(x) + self.total(y) + UNIT * size(length))

    def of_turn(self, node, angle):
        return Error(0.0, self.total(angle) + TURN)


RULES_OF_LONGER = RULES | {
    "+": BoundsOfLonger.of_sum,
    "-": BoundsOfLonger.of_sum,
    "total": BoundsOfLonger.of_total,
    "rest": BoundsOfLonger.of_rest,
    "sin": BoundsOfLonger.of_turn,
    "cos": BoundsOfLonger.of_turn,
}

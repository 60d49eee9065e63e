"""Bounds on the errors of a program that another arithmetic runs than the one that bounds are computed in.

A value may come in single precision, or from a compiler that fuses products and sums and takes what is too small for
zero. Bounds are then computed beside the same values in double, which differ from the exact ones by less: whatever
order of roundings the other takes, each result is within its unit of the exact one of what went into it.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .bounds import SAFE, ULP, Bounds, Error, size
from .trace import BY_ANGLE, INPUTS, Node, needed


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
OF = {"double": DOUBLE, "single": SINGLE}
"""By what a user calls it."""
SECOND_ORDER = 8.0
"""Roundings of an operation, beside those that its arguments bring, that make terms of second order."""


def is_handed_over(node):
    """Whether a node is computed in double beforehand: what a design fixes, tables, sine and cosine of the crank."""
    of_angle = node.operation in ("sin", "cos") and node.arguments[0].operation == "angle"
    return node.varies < BY_ANGLE or node.operation in INPUTS or of_angle


class BoundsElsewhere(Bounds):
    """Bounds for the nodes of a graph that another arithmetic computes; what is handed over to it is rounded once.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        As for `Bounds`.
    arithmetic : Arithmetic
    """

    def __init__(self, graph, inputs, arithmetic):
        super().__init__(graph)
        self.unit, self.safe, self.least, self.ulp = arithmetic[1], arithmetic.safe, arithmetic.least, arithmetic.ulp
        self._arithmetic, self._in_double = arithmetic, Bounds(graph, inputs)
        self._rounded = 0.0 if arithmetic.unit == UNIT else 1.0
        self._reaches: dict[Node, Any] = {}
        self._depths: dict[Node, int] = {}

    def of(self, outputs):
        found = super().of(outputs)
        for node in needed(outputs):
            self._look_at(node)
        return tuple(
            plus(bound, 0.0 / self.above(self._arithmetic.limit, None, self._reaches[part]))
            if isinstance(part, Node)
            else bound
            for part, bound in zip(outputs, found, strict=True)
        )

    def _look_at(self, node):
        """How many operations one after the other lead to a node, and the largest number on the way."""
        if node in self._depths:
            return
        parts = [] if is_handed_over(node) else [part for part in node.arguments if isinstance(part, Node)]
        self._depths[node] = 1 + max((self._depths[part] for part in parts), default=0)
        if self._depths[node] * (self.error(node).relative + SECOND_ORDER) * self.unit > (self.safe - 1.0) / 4.0:
            raise NotGivenError("no bound can be given in this precision: too many operations follow one another")
        own = self.largest(node) if not parts or node.operation in ("+", "-", "*", "/", "divisor") else None
        reaches = [self._reaches[part] for part in parts] + ([] if own is None else [own])
        whole = reaches[0]
        for other in reaches[1:]:
            whole = self._graph.node("divisor", whole, other)
        self._reaches[node] = whole

    def _found(self, node):
        if not is_handed_over(node):
            return super()._found(node)
        self._in_double.of([node])
        relative, rest = self._in_double.error(node)
        finer = UNIT / self.unit
        return Error(self._rounded + finer * relative, plus(None if rest is None else finer * rest, self.least))

    def own(self, node):
        if node.operation == "divisor":
            root, unit = node.arguments
            return Error(0.0, 0.0 / self.above(root, self.total(root), 2.0 * self.largest(unit)))
        relative, rest = super().own(node)
        alone = all(isinstance(part, Node) for part in node.arguments) and node.operation in ("+", "-", "abs", "held")
        return Error(relative, rest if alone else plus(rest, self.least))

    def error(self, part):
        if isinstance(part, Node):
            return super().error(part)
        exact = part == 0.0 or (self._arithmetic.dtype(part) == part and abs(part) > self.unit * self.least)
        return Error(0.0 if exact else 1.0, None if exact else self.least)

    def total(self, part):
        if isinstance(part, Node):
            return super().total(part)
        relative, rest = self.error(part)
        return plus(relative * abs(part), rest) if relative else rest

    def largest(self, part):
        """Bound on the magnitude of the computed value and of the exact one, but for relative errors."""
        rest = self.error(part).rest
        return size(part) if rest is None else self.fused(self.safe * self.unit, rest, size(part))

    def cap(self, part):
        """None of a node: what is lost as too small is weighed with the values themselves."""
        return None if isinstance(part, Node) else abs(part)

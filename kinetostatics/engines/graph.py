"""Recorded arithmetic: numbers that record every operation as nodes of a graph, without branches.

A graph contains each operation once. `record` fills it with the kernels' arithmetic, `derivatives` adds to it,
`codegen` writes source from it; the number of operations at each crank angle is its cost.
"""

from typing import Any

import numpy as np

from ..numbers.arithmetic import RELATIVE_OFFSET
from ..numbers.planar import SymbolicZero

BY_DESIGN, BY_ANGLE = range(2)
"""Whether the value of a node varies only with the design, or also with the crank angle."""
OTHERS = (np.ndarray, SymbolicZero)
"""Operands that combine with a node by their own arithmetic."""
INPUTS = ("angle", "parameter", "table")
"""Operations whose arguments are not nodes."""


def _operators(operation) -> tuple[Any, Any]:
    """Methods of an operator with the node on its left, and on its right."""

    def node_first(self, other):
        return NotImplemented if isinstance(other, OTHERS) else self.graph.node(operation, self, other)

    def node_last(self, other):
        return NotImplemented if isinstance(other, OTHERS) else self.graph.node(operation, other, self)

    return node_first, node_last


def _method(operation) -> Any:
    return lambda self, *others: self.graph.node(operation, self, *others)


class Node:
    """A recorded number: an operation, its arguments, and its dependence."""

    __slots__ = ("arguments", "graph", "index", "operation", "varies")

    def __init__(self, graph, operation, arguments, varies):
        self.graph, self.operation, self.arguments, self.varies = graph, operation, arguments, varies
        self.index = len(graph)
        graph.append(self)

    def __pow__(self, exponent):
        if exponent != 2:
            raise TypeError(f"only squares are recorded, not powers of {exponent}")
        return self * self

    def moved_apart(self, unit):
        return self + RELATIVE_OFFSET * unit

    def total_with(self, terms):
        """Called by `arithmetic.compensated_sum`."""
        return self.graph.node("total", *terms)

    def rest_with(self, length, x, y):
        """Called by `arithmetic.length_error`."""
        return self.graph.node("rest", length, x, y)

    def _unknown(self, other=None):
        raise TypeError("the value of a recorded number is unknown while recording: kernels must not branch on values")

    __bool__ = __float__ = __int__ = __eq__ = __ne__ = __lt__ = __le__ = __gt__ = __ge__ = _unknown
    __hash__ = object.__hash__

    __add__, __radd__ = _operators("+")
    __sub__, __rsub__ = _operators("-")
    __mul__, __rmul__ = _operators("*")
    __truediv__, __rtruediv__ = _operators("/")
    __neg__, __abs__ = _method("-"), _method("abs")
    # called by NumPy for arrays of objects
    sin, cos, sqrt, arctan, exp, log = map(_method, ("sin", "cos", "sqrt", "atan", "exp", "log"))
    # called by `arithmetic`: `sign`, `stop_gradient`, `clamped_sqrt`, `guarded_divisor`
    sign, held, forgiving_root, kept_off_zero = map(_method, ("sign", "held", "root", "divisor"))


class Graph(list):
    """Nodes in the order of their computation; equal operations on equal arguments are one node."""

    def __init__(self):
        super().__init__()
        self._known = {}

    def node(self, operation, *arguments):
        arguments = tuple(part if isinstance(part, Node) else float(part) for part in arguments)
        if operation in "+-":  # without negations of its terms, equal to the last bit
            *left, right = arguments
            if is_negative(right):
                operation, right = "-" if operation == "+" else "+", right.arguments[0]
            if left and is_negative(left[0]) and operation == "+":
                operation, left, right = "-", [right], left[0].arguments[0]
            if not left and operation == "+":
                return right
            arguments = (*left, right)
        factors = [part for part in arguments if isinstance(part, Node) or part != 1.0]
        if operation == "*" and len(factors) == 1:
            return factors[0]
        if operation == "/" and is_number(arguments[1], 1.0):
            return arguments[0]
        key = (operation, *((part.index,) if isinstance(part, Node) else part for part in arguments))
        if key not in self._known:
            varies = max(part.varies for part in arguments if isinstance(part, Node))
            self._known[key] = Node(self, operation, arguments, varies)
        return self._known[key]

    def angle(self):
        return Node(self, "angle", (), BY_ANGLE)

    def parameter(self, place):
        return Node(self, "parameter", (place,), BY_DESIGN)

    def row(self, place):
        """A row of the tables."""
        return Node(self, "table", (place,), BY_ANGLE)


def is_number(part, number):
    return not isinstance(part, Node) and part == number


def varies(part):
    """Whether a part varies with the crank angle."""
    return isinstance(part, Node) and part.varies == BY_ANGLE


def is_negative(part):
    return isinstance(part, Node) and part.operation == "-" and len(part.arguments) == 1


def is_of_angle(part):
    """Whether a part is the sine or cosine of the crank angle."""
    return isinstance(part, Node) and part.operation in ("sin", "cos") and part.arguments[0].operation == "angle"


def needed(outputs):
    """Nodes from which outputs (nodes or plain numbers) are computed, in the order of computation."""
    found: set[Node] = set()
    waiting = [part for part in outputs if isinstance(part, Node)]
    while waiting:
        node = waiting.pop()
        if node not in found:
            found.add(node)
            waiting += [part for part in node.arguments if isinstance(part, Node)]
    return sorted(found, key=lambda node: node.index)


def operations(outputs):
    """Number of operations at each crank angle."""
    return sum(node.varies == BY_ANGLE and node.operation not in INPUTS for node in needed(outputs))


def parted(outputs):
    """Split outputs: values fixed by the design, and outputs of a graph with them as parameters."""
    graph = Graph()
    parameters: list[tuple[Node | float, Node]] = []
    nodes: dict[Node, Node] = {}
    constants: dict[float, Node] = {}

    def copied(part):
        known = nodes if isinstance(part, Node) else constants
        if part not in known:
            known[part] = graph.parameter(len(parameters))
            parameters.append((part, known[part]))
        return known[part]

    for node in needed(outputs):
        if node.varies < BY_ANGLE:
            continue
        if node.operation == "angle":
            nodes[node] = graph.angle()
        elif node.operation == "table":
            nodes[node] = graph.row(*node.arguments)
        else:
            nodes[node] = graph.node(node.operation, *map(copied, node.arguments))
    found = tuple(map(copied, outputs))
    return tuple(part for part, _ in parameters), found

"""Recorded arithmetic: numbers that write down every operation as nodes of a graph, without branches.

A graph keeps each operation once. `record` fills it with the kernels' arithmetic, `derivatives` adds to it, `codegen`
writes source from it; the number of operations at each crank angle is its cost.
"""

import numpy as np

from ..numbers.arithmetic import RELATIVE_OFFSET
from ..numbers.planar import SymbolicZero

BY_DESIGN, BY_ANGLE = range(2)
"""The value of a node varies with the design alone, or with the crank angle as well."""
OTHERS = (np.ndarray, SymbolicZero)
"""Operands that combine with a node by their own arithmetic."""
INPUTS = ("angle", "parameter", "table")
"""Operations whose arguments are not nodes."""


class Node:
    """A recorded number: an operation, its arguments, and what it varies with."""

    __slots__ = ("arguments", "graph", "index", "operation", "varies")

    def __init__(self, graph, operation, arguments, varies):
        self.graph, self.operation, self.arguments, self.varies = graph, operation, arguments, varies
        self.index = len(graph)
        graph.append(self)

    def __add__(self, other):
        return _combined(self, "+", self, other)

    def __radd__(self, other):
        return _combined(self, "+", other, self)

    def __sub__(self, other):
        return _combined(self, "-", self, other)

    def __rsub__(self, other):
        return _combined(self, "-", other, self)

    def __mul__(self, other):
        return _combined(self, "*", self, other)

    def __rmul__(self, other):
        return _combined(self, "*", other, self)

    def __truediv__(self, other):
        return _combined(self, "/", self, other)

    def __rtruediv__(self, other):
        return _combined(self, "/", other, self)

    def __pow__(self, exponent):
        if exponent != 2:
            raise TypeError(f"only squares are recorded, not powers of {exponent}")
        return self * self

    def __neg__(self):
        return self.graph.node("-", self)

    def __abs__(self):
        return self.graph.node("abs", self)

    def sin(self):
        """Called by `numpy.sin` for an array of objects, as `cos` and `sqrt` are."""
        return self.graph.node("sin", self)

    def cos(self):
        return self.graph.node("cos", self)

    def sqrt(self):
        return self.graph.node("sqrt", self)

    def arctan(self):
        return self.graph.node("atan", self)

    def sign(self):
        return self.graph.node("sign", self)

    def held(self):
        return self.graph.node("held", self)

    def forgiving_root(self, unit):
        """Called by `arithmetic.clamped_sqrt`, as the next two by `guarded_divisor` and `offset_from_zero`."""
        return self.graph.node("root", self, unit)

    def kept_off_zero(self, unit):
        return self.graph.node("divisor", self, unit)

    def moved_apart(self, unit):
        return self + RELATIVE_OFFSET * unit

    def total_with(self, terms):
        """Called by `arithmetic.compensated_sum`."""
        return self.graph.node("total", *terms)

    def rest_with(self, length, x, y):
        """Called by `arithmetic.length_error`."""
        return self.graph.node("rest", length, x, y)

    def _unknown(self, other=None):
        raise TypeError("the value of a recorded number is not known yet: kernels must not branch on values")

    __bool__ = __float__ = __int__ = __eq__ = __ne__ = __lt__ = __le__ = __gt__ = __ge__ = _unknown
    __hash__ = object.__hash__


def _combined(node, operation, left, right):
    if isinstance(left, OTHERS) or isinstance(right, OTHERS):
        return NotImplemented
    return node.graph.node(operation, left, right)


class Graph(list):
    """Nodes in the order of their computation; equal operations on equal arguments are one node."""

    def __init__(self):
        super().__init__()
        self._known = {}

    def node(self, operation, *arguments):
        arguments = tuple(part if isinstance(part, Node) else float(part) for part in arguments)
        if operation in "+-":
            operation, arguments = _with_signs_taken_in(operation, *arguments)
            if len(arguments) == 1 and operation == "+":
                return arguments[0]
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


def _with_signs_taken_in(operation, *arguments):
    """The same sum or difference, to the last bit, without negations of its terms."""
    *left, right = arguments
    if is_negative(right):
        operation, right = "-" if operation == "+" else "+", right.arguments[0]
    if left and is_negative(left[0]) and operation == "+":
        return "-", (right, left[0].arguments[0])
    return operation, (*left, right)


def varies(part):
    """Whether a part varies with the crank angle."""
    return isinstance(part, Node) and part.varies == BY_ANGLE


def is_negative(part):
    return isinstance(part, Node) and part.operation == "-" and len(part.arguments) == 1


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
    """Split outputs: values fixed by the design, and outputs of a graph with these as parameters."""
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

"""Numbers that write down every operation: a graph of arithmetic without branches or absent parts.

A graph keeps each operation once. What it costs is its number of operations; `record` fills one with the kernels'
arithmetic, `derivatives` adds to it, `writing` makes source of it.
"""

import numpy as np

from ..numbers.elementary import APART
from ..numbers.nothing import Nothing

BY_DESIGN, BY_ANGLE = range(2)
"""What the value of a node varies with: the design, or the crank angle as well."""
OTHERS = (np.ndarray, Nothing)
"""What arithmetic is left to."""
INPUTS = ("angle", "parameter", "table")
"""Operations without arguments that are nodes."""


class Node:
    """A number that is not known yet, and the operation it comes from."""

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
        """Called by `elementary.root`, as the next two by `divisor` and `apart`."""
        return self.graph.node("root", self, unit)

    def kept_off_zero(self, unit):
        return self.graph.node("divisor", self, unit)

    def moved_apart(self, unit):
        return self + APART * unit

    def total_with(self, terms):
        """Called by `elementary.total`."""
        return self.graph.node("total", *terms)

    def rest_with(self, length, x, y):
        """Called by `elementary.rest`."""
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
    """Nodes in the order in which they can be computed; what was computed before is not computed again."""

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


SMALLEST = 2.0**-1022
"""What is smaller may have no reciprocal."""


class LeanGraph(Graph):
    """The same with fewer operations at each crank angle, and the same values but for rounding.

    Quotients by a root are products with its reciprocal, which they share; those by a design's number leave that to the
    design. Neither has an infinite reciprocal, as what is tiny has, so that zero by it stays zero. Products leave signs
    to sums, to the last bit. A zero that is added stays, for it gives a zero its sign, on which friction hangs. Each is
    decided where it is recorded, by what is there, so that a number is computed in one way whatever else is wanted.
    """

    def node(self, operation, *arguments):
        if operation == "/":
            return self._quotient(*arguments)
        if operation == "sqrt" and (secant := _secant(*arguments)):
            return abs(secant[0]) * self._over(secant[1])
        if operation == "*":
            left, right = arguments
            if _is_none_of_turn(left, right) or _is_none_of_turn(right, left):
                return 0.0
            if is_negative(left):
                return -self.node("*", left.arguments[0], right)
            if is_negative(right):
                return -self.node("*", left, right.arguments[0])
            for one, other in ((left, right), (right, left)):
                if isinstance(one, Node) and one.operation == "*":
                    first, second = one.arguments
                    if _are_inverse(first, other):
                        return second
                    if _are_inverse(second, other):
                        return first
        return super().node(operation, *arguments)

    def _quotient(self, above, below):
        if is_negative(above):
            return -self.node("/", above.arguments[0], below)
        if _varies(below) == BY_ANGLE:
            if isinstance(above, Node) and above.operation == "*":
                left, right = above.arguments
                if below is left or below is right:
                    return right if below is left else left
            if _is_root(below):
                return self.node("*", above, self._over(below))
        elif _varies(above) == BY_ANGLE and (isinstance(below, Node) or abs(below) >= SMALLEST):
            return self.node("*", above, self._over(below))
        return super().node("/", above, below)

    def _over(self, part):
        """One over a part; of what a design's number multiplies, that over the rest."""
        if not isinstance(part, Node):
            return 1.0 / part
        arguments = part.arguments
        if is_negative(part):
            return -self._over(arguments[0])
        if part.operation == "/":
            above, below = arguments
            return below if is_number(above, 1.0) else super().node("/", below, above)
        if (
            part.operation == "*"
            and min(map(_varies, arguments)) < part.varies
            and not any(is_number(part, 0.0) for part in arguments)
        ):
            return self.node("*", *map(self._over, arguments))
        return super().node("/", 1.0, part)


def _is_root(part):
    """Whether a part is a root, or one times a number of the design."""
    while part.operation in ("*", "-"):
        own = [other for other in part.arguments if _varies(other) == BY_ANGLE]
        if len(own) > 1 or (part.operation == "-" and len(part.arguments) > 1):
            return False
        (part,) = own
    return part.operation in ("divisor", "sqrt", "root")


def _varies(part):
    return part.varies if isinstance(part, Node) else BY_DESIGN


def _are_inverse(one, other):
    return _is_over(one, other) or _is_over(other, one)


def _is_over(part, other):
    """Whether a part is one over a node."""
    return (
        isinstance(part, Node)
        and part.operation == "/"
        and part.arguments[1] is other
        and is_number(part.arguments[0], 1.0)
    )


def _is_none_of_turn(part, other):
    """Whether a part is zero and the other the sine or cosine of the crank angle, which is finite."""
    return (
        is_number(part, 0.0)
        and isinstance(other, Node)
        and other.operation in ("sin", "cos")
        and other.arguments[0].operation == "angle"
    )


def _secant(square):
    """Where a square is 1 + x^2 / h^2 with h the root of (a - x) (a + x): a and h, for its root is |a| / h."""
    one, power = _parts(square, "+")
    if not is_number(one, 1.0):
        one, power = power, one
    tangent, same = _parts(power, "*")
    if not is_number(one, 1.0) or tangent is not same:
        return None
    for x, over in _either_way(tangent, "*"):
        above, root = _parts(over, "/")
        if is_number(above, 1.0) and isinstance(root, Node) and root.operation == "sqrt":
            for less, more in _either_way(root.arguments[0], "*"):
                a, other = _parts(less, "-")
                if other is x and any(one is a and two is x for one, two in _either_way(more, "+")):
                    return a, root
    return None


def _parts(part, operation):
    """Both arguments of an operation, or nothing twice."""
    is_one = isinstance(part, Node) and part.operation == operation and len(part.arguments) == 2
    return part.arguments if is_one else (None, None)


def _either_way(part, operation):
    left, right = _parts(part, operation)
    return ((left, right), (right, left))


def is_number(part, number):
    return not isinstance(part, Node) and part == number


def _with_signs_taken_in(operation, *arguments):
    """The same sum or difference, to the last bit, without operations that only turn a sign."""
    *left, right = arguments
    if is_negative(right):
        operation, right = "-" if operation == "+" else "+", right.arguments[0]
    if left and is_negative(left[0]) and operation == "+":
        return "-", (right, left[0].arguments[0])
    return operation, (*left, right)


def varies(part):
    """Whether a part is a number of the crank angle."""
    return isinstance(part, Node) and part.varies == BY_ANGLE


def is_negative(part):
    return isinstance(part, Node) and part.operation == "-" and len(part.arguments) == 1


def needed(outputs):
    """Nodes that outputs, nodes or plain numbers, are computed from, in order."""
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
    """What a design hands over to the operations at each crank angle, and outputs of a graph of these alone."""
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

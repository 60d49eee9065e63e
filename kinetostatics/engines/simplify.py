"""Algebraic simplification of recorded arithmetic, and fused multiply-add (FMA).

No FMA for a b - c d when both products have the same structure, as for twin groups: for equal inputs the result must be
exactly 0, but FMA would return the rounding error of a b. Factors and terms fixed by the design do not count as
structure. Each decision depends only on the nodes below a sum, so a result has the same bits whatever else is computed.
"""

from itertools import product
from typing import Any, NamedTuple

from .graph import BY_ANGLE, Graph, Node, is_negative, is_number, is_of_angle, varies

MIN_DIVISOR = 2.0**-1022
"""Divisors below this may have no finite reciprocal."""


class SimplifiedGraph(Graph):
    """Graph with fewer operations at each crank angle and the same values except for rounding.

    A quotient by a root becomes a product with its reciprocal, shared with other quotients. A quotient by a number of
    the design becomes a product with a reciprocal computed once. Divisors with infinite reciprocals keep the quotient,
    so 0 / x stays 0. The length of a vector along the crank, or across it, needs no root. Signs of factors move to
    sums, to the last bit. An added zero stays, because it decides the sign of a zero for friction. Each decision uses
    only the recorded arguments, so a number is always computed in the same way.
    """

    def node(self, operation, *arguments):
        if operation == "/":
            return self._quotient(*arguments)
        if operation == "sqrt" and (secant := _secant(*arguments)):
            return abs(secant[0]) * self._over(secant[1])
        if operation == "sqrt" and (size := _turned(*arguments)) is not None:
            return abs(size)
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
        if varies(below):
            if isinstance(above, Node) and above.operation == "*":
                left, right = above.arguments
                if below is left or below is right:
                    return right if below is left else left
            if _is_root(below):
                return self.node("*", above, self._over(below))
        elif varies(above) and (isinstance(below, Node) or abs(below) >= MIN_DIVISOR):
            return self.node("*", above, self._over(below))
        return super().node("/", above, below)

    def _over(self, part):
        """1 / part, with reciprocals of the design's factors computed separately from those at each angle."""
        if not isinstance(part, Node):
            return 1.0 / part
        arguments = part.arguments
        if is_negative(part):
            return -self._over(arguments[0])
        if part.operation == "/":
            above, below = arguments
            return below if is_number(above, 1.0) else super().node("/", below, above)
        is_mixed = part.operation == "*" and varies(part) and not all(map(varies, arguments))
        if is_mixed and not any(is_number(part, 0.0) for part in arguments):
            return self.node("*", *map(self._over, arguments))
        return super().node("/", 1.0, part)


def _is_root(part):
    """Whether a part is a root, or a root times numbers of the design."""
    while part.operation in ("*", "-"):
        own = [other for other in part.arguments if varies(other)]
        if len(own) > 1 or (part.operation == "-" and len(part.arguments) > 1):
            return False
        (part,) = own
    return part.operation in ("divisor", "sqrt", "root")


def _are_inverse(one, other):
    """Whether one part is 1 over the other."""
    return any(
        isinstance(part, Node)
        and part.operation == "/"
        and part.arguments[1] is divisor
        and is_number(part.arguments[0], 1.0)
        for part, divisor in ((one, other), (other, one))
    )


def _is_none_of_turn(part, other):
    """Whether a part is 0 and the other the sine or cosine of the crank angle, which is finite."""
    return is_number(part, 0.0) and is_of_angle(other)


def _secant(square):
    """(a, h) if a square is 1 + x^2 / h^2 with h = sqrt((a - x) (a + x)), so its root is |a| / h; else None."""
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


def _turned(square):
    """Factor a if a square is (a sin)^2 + (a cos)^2 of one angle; else None."""
    for one, other in _either_way(square, "+"):
        (x, same), (y, alike) = _parts(one, "*"), _parts(other, "*")
        if x is same and y is alike:
            for (size, sine), (beside, cosine) in product(_either_way(x, "*"), _either_way(y, "*")):
                operations = [getattr(part, "operation", None) for part in (sine, cosine)]
                is_turn = operations == ["sin", "cos"] and sine.arguments == cosine.arguments
                if is_turn and size is not None and size is beside:
                    return size
    return None


def _parts(part, operation):
    """Both arguments of an operation, or (None, None)."""
    is_one = isinstance(part, Node) and part.operation == operation and len(part.arguments) == 2
    return part.arguments if is_one else (None, None)


def _either_way(part, operation):
    left, right = _parts(part, operation)
    return ((left, right), (right, left))


NONE: frozenset[int] = frozenset()


class FusedSum(NamedTuple):
    """A sum as sign * one * other + rest_sign * rest, with signs 1 or -1."""

    sign: int
    one: Any
    other: Any
    rest_sign: int
    rest: Any


def fused_sums(nodes) -> dict[Node, FusedSum]:
    """FMA of each sum that may be fused, by node; of two products the later one."""
    found: dict[Node, FusedSum] = {}
    ways: dict[Node, int] = {}
    held: dict[Node, frozenset[int]] = {}
    depths: dict[Node, int] = {}
    numbers: dict[tuple, int] = {}
    for node in nodes:
        if node.varies < BY_ANGLE:
            continue
        kind, moving = node.operation, [part for part in node.arguments if varies(part)]
        is_sum, minus = kind in ("+", "-", "held"), -1 if kind == "-" else 1
        depths[node] = 1 + max((depths[part] for part in moving), default=0)
        if len(moving) == 1 and (is_sum or kind == "*"):
            ways[node] = ways[moving[0]]
        else:
            key = "+" if is_sum else kind, *sorted(ways[part] for part in moving)
            ways[node] = numbers.setdefault(key, len(numbers))
        held[node] = NONE.union(*(held[part] for part in moving)) if is_sum else NONE
        if kind == "*":
            held[node] = frozenset((ways[node],))
        if is_sum and len(node.arguments) == 2:
            left, right = node.arguments
            choices = [
                (depths[part], FusedSum(own * sign, product.arguments[0], product.arguments[1], others, rest))
                for part, own, others, rest in ((left, 1, minus, right), (right, minus, 1, left))
                for sign, product in (_product(part),)
                if product is not None and ways[product] not in held.get(rest, NONE)
            ]
            if choices:
                found[node] = max(choices, key=lambda choice: choice[0])[1]
    return found


def operands_of(node, sums):
    """Nodes that are arguments of a node, or of its fused sum."""
    found = (sums[node].one, sums[node].other, sums[node].rest) if node in sums else node.arguments
    return [part for part in found if isinstance(part, Node)]


def drop_unused(nodes, outputs, sums):
    """Nodes without products that only their fused sums use."""
    wanted = {part for part in outputs if isinstance(part, Node)}
    for node in reversed(nodes):
        if node in wanted:
            wanted.update(operands_of(node, sums))
    return [node for node in nodes if node in wanted]


def _product(part):
    """Sign, and product node or None, of a part."""
    sign, part = (-1, part.arguments[0]) if varies(part) and is_negative(part) else (1, part)
    return sign, part if varies(part) and part.operation == "*" else None

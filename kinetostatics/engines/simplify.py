"""A graph with fewer operations: what is recorded is written in the way that takes least at each crank angle."""

from itertools import product

from .graph import BY_ANGLE, BY_DESIGN, Graph, Node, is_negative, is_number

MIN_DIVISOR = 2.0**-1022
"""What is smaller may have no reciprocal."""


class SimplifiedGraph(Graph):
    """The same with fewer operations at each crank angle, and the same values but for rounding.

    Quotients by a root are products with its reciprocal, which they share; those by a design's number leave that to the
    design. Neither has an infinite reciprocal, as what is tiny has, so that zero by it stays zero. The size of what
    lies along the crank, or across it, needs no root. Products leave signs to sums, to the last bit. A zero that is
    added stays, for it gives a zero its sign, on which friction hangs. Each is decided where it is recorded, by what is
    there, so that a number is computed in one way whatever else is wanted.
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
        if _varies(below) == BY_ANGLE:
            if isinstance(above, Node) and above.operation == "*":
                left, right = above.arguments
                if below is left or below is right:
                    return right if below is left else left
            if _is_root(below):
                return self.node("*", above, self._over(below))
        elif _varies(above) == BY_ANGLE and (isinstance(below, Node) or abs(below) >= MIN_DIVISOR):
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


def _turned(square):
    """What is multiplied by a sine and the cosine beside it where a square is the sum of the squares of both."""
    for one, other in _either_way(square, "+"):
        (x, same), (y, alike) = _parts(one, "*"), _parts(other, "*")
        if x is same and y is alike:
            for (size, sine), (beside, cosine) in product(_either_way(x, "*"), _either_way(y, "*")):
                if size is not None and size is beside and _are_of_one_angle(sine, cosine):
                    return size
    return None


def _are_of_one_angle(sine, cosine):
    operations = [part.operation if isinstance(part, Node) else None for part in (sine, cosine)]
    return operations == ["sin", "cos"] and sine.arguments == cosine.arguments


def _parts(part, operation):
    """Both arguments of an operation, or nothing twice."""
    is_one = isinstance(part, Node) and part.operation == operation and len(part.arguments) == 2
    return part.arguments if is_one else (None, None)


def _either_way(part, operation):
    left, right = _parts(part, operation)
    return ((left, right), (right, left))

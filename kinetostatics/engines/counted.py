"""Errors of recorded values that are products: counts of roundings, and what a design tells of magnitudes.

Products, quotients and roots of what has few relative errors have few as well (Higham, *Accuracy and Stability of
Numerical Algorithms*, 2002, section 3.4, the counter <k>): nothing has to be computed for them.
"""

import math
from collections.abc import Callable
from functools import reduce
from typing import Any, NamedTuple

from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .behind import Behind
from .bounds import SAFE, Bounds, Error, fused, is_scaling, is_zero
from .functions import ULP, is_over_root, moved_apart
from .graph import BY_ANGLE, INPUTS, Graph, Node, is_number, varies

ROUNDED = SAFE * UNIT
"""What a rounding counts for in a bound, beside that of the bound itself."""
DIVIDING = ("/", "sqrt", "root", "divisor")
"""Operations that have pivots."""
TINIEST = 2.0**-1074
"""What a product may lose that is too small for a double, rounded as it is."""
NO_POWER = 2.0**-60
"""Stands for the power 0 of a pivot, so that a bound is infinite where that may vanish or its guard acts."""


class Relative(NamedTuple):
    """Error of a value that is a product: how many `roundings`, powers of `pivots`, and what it lost as too small."""

    roundings: float
    pivots: dict[Node, float]
    dust: Any


EXACT = Relative(0.0, {}, None)


class Counted:
    """What is relative among the nodes of a graph.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        ``input(bounds) -> Error`` of inputs that are not exact.
    dust : float or None
        What a product or quotient may lose if it is too small for a double; None if none is.

    Attributes
    ----------
    behind : Behind
    no_power : float
        Stands for the power 0 of a pivot; 0 where pivots are known not to vanish.
    """

    no_power = NO_POWER

    def __init__(self, graph: Graph, inputs: dict[Node, Callable[..., Error]] | None, dust: float | None):
        self._graph, self._inputs, self._dust = graph, inputs or {}, dust or 0.0
        self._lost = ROUNDED * self._dust
        self._take_by_design(dust)
        self._relative: dict[Node, Relative | None] = {}
        self._pivots: dict[Node, Any] = {}
        self._guards: dict[Node, dict[Node, None]] = {}
        self._squares: set[Any] = set()
        self._divisors: set[Any] = set()
        self._reciprocals: dict[tuple[Node | None, Node], Any] = {}
        self._caps: dict[Node, Any] = {}
        self._depths: dict[Node, int] = {}
        self._positive: dict[Node, bool] = {}
        self.behind = Behind(graph)

    def count(self, nodes):
        """Find what is relative among nodes in the order of computing."""
        self._squares.update(node.arguments[0] for node in nodes if node.operation in ("sqrt", "root"))
        self._divisors.update(node.arguments[node.operation == "/"] for node in nodes if node.operation in DIVIDING)
        for node in nodes:
            self._tell_reciprocal(node)
        for node in nodes:
            self._relative[node] = self._counted(node)
            self.behind.tell(node, self._vanishing(node))

    def _vanishing(self, node):
        """Pivots without which an operation has no result; what cannot be negative has a root."""
        if node.operation == "/":
            return self.as_divisor(node.arguments[1]).pivots
        is_one = node.operation in DIVIDING and not self.is_positive(node.arguments[0])
        return (self._relative[node] or EXACT).pivots if is_one else ()

    def _take_by_design(self, dust):
        """Bound what a design fixes, where so much may be lost."""
        self._by_design = Bounds(self._graph, self._inputs, dust)
        self._tiniest = None if dust is None else TINIEST

    def relative(self, part):
        """Error of a part if it is relative, else None."""
        return self._relative[part] if isinstance(part, Node) else EXACT

    def _counted(self, node):
        kind, parts = node.operation, node.arguments
        if kind in INPUTS:
            return self._counted_input(node)
        if node in self._inputs:
            return None
        if kind in ("+", "-", "total"):
            return self._counted_sum(node, [part for part in parts if not is_zero(part)])
        if kind == "*":
            return EXACT if is_zero(node) else self._counted_product(node, 1.0, is_scaling)
        if kind == "/":
            return self._counted_product(node, -1.0, lambda part: part is parts[1] and is_scaling(part))
        if kind in ("sqrt", "root"):
            return self._counted_root(node)
        if kind == "divisor":
            return self._counted_divisor(node)
        found = self.relative(parts[0])
        if kind in ("abs", "held") or found is None:
            return found
        if kind == "sign":  # of a product only what is lost as too small may turn it
            return EXACT if found.dust is None and not found.pivots else None
        return Relative(ULP[kind], {}, None) if is_exact(found) else None

    def _counted_input(self, node):
        if node not in self._inputs:
            return EXACT
        if node.varies == BY_ANGLE:
            return None
        relative, rest = self._inputs[node](self)
        return Relative(relative, {}, None) if rest is None else None

    def _counted_sum(self, node, parts):
        errors = [self.relative(part) for part in parts]
        if not parts:
            return EXACT
        if len(parts) == 1:
            return errors[0]
        if all(map(is_exact, errors)) and node.operation != "total":
            return Relative(1.0, {}, moved_apart(parts))
        is_plus = node.operation == "+" and all(map(self.is_positive, parts))
        if None in errors or not is_plus or any(error.pivots for error in errors):
            return None
        dust = reduce(plus, (error.dust for error in errors), moved_apart(parts))
        return Relative(1.0 + max(error.roundings for error in errors), {}, dust)

    def _counted_product(self, node, sign, is_exactly):
        left, right = node.arguments
        one, other = self.relative(left), self.as_divisor(right) if sign < 0.0 else self.relative(right)
        if one is None or other is None:
            return None
        pivots = {
            pivot: one.pivots.get(pivot, 0.0) + sign * other.pivots.get(pivot, 0.0) or self.no_power
            for pivot in one.pivots | other.pivots
        }
        own = 0.0 if is_exactly(left) or is_exactly(right) else 1.0
        return Relative(
            one.roundings + other.roundings + own,
            {pivot: power for pivot, power in pivots.items() if power},
            self._dust_of_product(node, one, other, sign),
        )

    def _dust_of_product(self, node, one, other, sign):
        left, right = node.arguments
        least = None if is_over_root(node) and other.pivots else self._dust
        dust = least or None
        if not is_nothing(one.dust):
            dust = self.fused(one.dust, self.cap(right) if sign > 0.0 else self._cap_over(right), dust)
        if not is_nothing(other.dust):
            dust = self.fused(other.dust, self.cap(left), dust)
        if not (is_nothing(one.dust) or is_nothing(other.dust)):
            dust = self.fused(UNIT * one.dust, other.dust, dust)
        return least if dust is None else dust

    def as_divisor(self, part):
        """Error of a part that something is divided by: its own if it cannot be lost as too small, or of a pivot."""
        found = self.relative(part)
        return found if found is not None and found.dust is None else Relative(0.0, {part: 1.0}, None)

    def _counted_root(self, node):
        found = self.as_square(node.arguments[0])
        dust = None if found.dust is None else self.root_of_dust(found.dust)
        return Relative(
            1.0 + 0.5 * found.roundings, {pivot: 0.5 * power for pivot, power in found.pivots.items()}, dust
        )

    def root_of_dust(self, dust):
        """What a root is off at most by what its square lost."""
        return math.sqrt(dust / UNIT) if isinstance(dust, float) else (dust / UNIT).sqrt()

    def as_square(self, part):
        """Error of a part whose root is taken: its own if it cannot be negative, or of a pivot."""
        found = self.relative(part)
        is_pivot = found is None or not self.is_positive(part) or varies(found.dust)
        return Relative(0.0, {part: 1.0}, None) if is_pivot else found

    def _counted_divisor(self, node):
        """As what is guarded; where the guard acts that is no pivot."""
        found = self.relative(node.arguments[0])
        if found is None:
            found = Relative(0.0, {node.arguments[0]: 1.0}, None)
        pivot = next((pivot for pivot in found.pivots if pivot not in self._pivots), node)
        self._guards.setdefault(pivot, {})[node] = None
        return found if pivot is not node else found._replace(pivots={**found.pivots, node: 1.0})

    def over(self, node):
        """Bound on one over the magnitude of a computed value: its reciprocal where that is computed."""
        if not isinstance(node, Node):
            return 1.0 / abs(node)
        guards = None, *self._guards.get(node, ())  # where they act, a pivot has no bound in any case
        known = next((self._reciprocals[guard, node] for guard in guards if (guard, node) in self._reciprocals), None)
        if known is None:
            size = node if node in self._squares else self.size(node)  # what is negative has no root
            known = self._reciprocals[None, node] = 1.0 / self._graph.node("divisor", size, 0.0)
        return known

    def _tell_reciprocal(self, node):
        """Take note of reciprocals among the values, of what they are of, and of what that is a root of, or guards."""
        if node.operation != "/" or isinstance(node.arguments[0], Node):
            return
        above, below = node.arguments
        if below in self._squares or abs(above) < 1.0:  # that may be too small for a double
            return
        over, guard = self.size(node) * (1.0 / abs(above)), None
        while isinstance(below, Node) and (guard, below) not in self._reciprocals:
            self._reciprocals[guard, below] = over
            if below.operation in ("sqrt", "root"):
                over = over * over
            elif below.operation == "divisor":
                guard = below
            else:
                return
            below = below.arguments[0]

    def cap(self, part):
        """A magnitude not less than a value's: of its design if possible, then not less than the exact one's either."""
        if not isinstance(part, Node):
            return abs(part)
        if part not in self._caps:
            found = self._cap(part.operation, part.arguments) if varies(part) else self._cap_by_design(part)
            self._caps[part] = self.size(part) if found is None or varies(found) else found
        return self._caps[part]

    def _cap_by_design(self, part):
        """One that a design fixes is zero where its parts cancel, or are too small, and may truly be another."""
        if (found := self.relative(part)) is not None:
            return None if found.dust is None else self.fused(ROUNDED, found.dust, self.size(part))
        return plus(self.size(part), *self._by_design.of([part]))

    def _cap(self, kind, parts):
        if kind in ("sin", "cos"):
            return 1.0
        if kind in ("abs", "held", "+", "-", "divisor"):
            return reduce(plus, map(self.cap, parts))
        if kind == "*":
            return self.cap(parts[0]) * self.cap(parts[1])
        if kind in ("sqrt", "root"):
            square = self.cap(parts[0])
            return square.sqrt() if isinstance(square, Node) and not varies(square) else None
        if kind == "/":
            return self.cap(parts[0]) * self._cap_over(parts[1])
        return None

    def _cap_over(self, part):
        guarded = isinstance(part, Node) and part.operation == "divisor" and not varies(part.arguments[1])
        return self.over(part.arguments[1] if guarded else part)

    def summed(self, terms):
        """Sum of products: of what a design fixes first, then of what is known first; None of nothing."""
        terms = [
            self._stripped(one, other) if isinstance(one, Node) or isinstance(other, Node) else (1.0, one * other)
            for one, other in terms
            if other is not None and not is_number(one, 0.0) and not is_number(other, 0.0)
        ]
        others = [term for term in terms if not self._is_dust(*term)]
        if len(others) < len(terms):
            terms = others
            if not any(is_number(one, 1.0) and varies(other) for one, other in terms):  # a bound, which has dust enough
                terms.append((1.0, self._lost))
        terms.sort(key=lambda term: max(map(self._depth, term)))
        if terms and self._depth(terms[0][0]) + self._depth(terms[0][1]):
            begin = next((term for term in terms if is_number(term[0], 1.0)), terms[0])
            terms.sort(key=lambda term: term is not begin)  # which takes no operation
        total = None
        for one, other in terms:
            total = self.fused(one, other, total)
        return total

    def _depth(self, part):
        """How many operations at a crank angle lead to a part: what is known last is added last."""
        if not varies(part):
            return 0
        if part not in self._depths:
            parts = () if part.operation in INPUTS else part.arguments
            self._depths[part] = 1 + max(map(self._depth, parts), default=0)
        return self._depths[part]

    def _is_dust(self, one, other):
        """Whether a term is a number that is dust, of which there is more than enough."""
        return is_number(one, 1.0) and isinstance(other, float) and 0.0 < other <= 256.0 * self._lost

    def _stripped(self, one, other):
        """A term whose magnitude is of a product with numbers of the design: these multiply the other factor."""
        while not varies(one) and varies(other):
            inner = other.arguments[0] if other.operation == "abs" else other
            if inner.operation != "*" or not self.is_positive(other):
                break
            fixed = [part for part in inner.arguments if not varies(part)]
            if not fixed:
                break
            (rest,) = (part for part in inner.arguments if varies(part))
            one, other = plus(one * self.size(fixed[0]), self._tiniest), self.size(rest)
        return one, other

    def fused(self, one, other, more):
        return fused(self._graph, one, other, more)

    def size(self, part):
        """Magnitude of a part of an operation."""
        if not isinstance(part, Node):
            return abs(part)
        if part.operation == "-" and len(part.arguments) == 1:
            return self.size(part.arguments[0])
        return part if self.is_positive(part) else abs(part)

    def is_positive(self, part):
        """Whether a part cannot be negative, whatever the numbers."""
        if not isinstance(part, Node):
            return part >= 0.0
        if part not in self._positive:
            kind, parts = part.operation, part.arguments
            self._positive[part] = kind in ("abs", "sqrt", "root") or (
                (kind in ("*", "/", "+", "divisor") and all(map(self.is_positive, parts)))
                or (kind == "*" and parts[0] is parts[1])
                or (kind == "divisor" and any(map(self.is_positive, parts)))
            )
        return self._positive[part]


def is_exact(error):
    return error is not None and not error.roundings and not error.pivots and error.dust is None


def is_nothing(dust):
    return dust is None or is_number(dust, 0.0)

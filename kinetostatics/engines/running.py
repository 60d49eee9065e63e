"""Proven bounds on the rounding errors of recorded outputs that cost about as much as the outputs.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, sections 3.1 to 3.4) with what
the structure tells beforehand. A value is either

relative
    exact times (1 + d) for each of some roundings, |d| <= `UNIT`, and times (1 + e) to some power for each of some
    pivots, see `counted`. A pivot is a sum that something is divided by or whose root is taken: its relative error is
    computed once, by a reciprocal that is there if possible, and shared by all products with it.
absolute
    within ``UNIT (bound - reserve |value|)`` of the exact one. The bound is computed along, the reserve is a number.
    A sum needs a rounding of itself, which is at most the sum of its parts' magnitudes: it takes it from their
    reserves, and has what is left. A product with what is relative takes its roundings in the same way. Where nothing
    is left so many roundings of the value itself are added to the bound.

What a design fixes is found once, however many angles there are: where it is not relative the rules of `bounds`, which
are dearer and nearer, bound it, those of lengths and their rests among them. Its reserve is added to that.

With errors a and b of two absolute factors x and y, that of x y is at most |y| a + |x| b + a b. A bound is infinite
where a pivot is not known to a tenth, or where the guard of a divisor acts. Each bound has `DUST` in it.
"""

import math
from collections import Counter
from typing import Any, NamedTuple

from ..numbers.elementary import UNIT
from .bounds import DUST, SAFE, Bounds, is_scaling, is_zero, whole
from .counted import Counted
from .functions import ULP, beside_one
from .trace import BY_DESIGN, INPUTS, Node, needed

KNOWN, CURVED, POWER = 0.1, 18.0, 16.0
"""Relative errors x of pivots stay below `KNOWN`; up to `POWER` then (1 - x)^-m - 1 <= m x (1 + `CURVED` x)."""
LIMIT = 2.0**973
"""What bounds of pivots are held times, in `UNIT`: an overflow where x (1 + `CURVED` x) is 1/4 or more."""
GUARDED = 2.0**1000
"""Makes what a guard adds infinite, times `LIMIT`."""
SECOND = 2.0**-52
"""More than what makes a term of second order of two bounds."""
FEW, MORE = 1.0, 2.0
"""Roundings in reserve: of magnitudes of what is added, and of a value's own, which may be far smaller."""


class Absolute(NamedTuple):
    """Error of a value with sums in it."""

    terms: list
    reserve: float


class RunningBounds(Counted):
    """Bounds for the nodes of a graph, each found once.

    Parameters
    ----------
    graph : Graph
    inputs : mapping of Node to function
        ``input(bounds) -> Error`` of inputs that are not exact, as for `bounds.Bounds`.
    dust : float or None
        What a product or quotient may lose if it is too small for a double; None if none is.
    """

    def __init__(self, graph, inputs=None, dust=DUST):
        super().__init__(graph, inputs, dust)
        self._by_design = Bounds(graph, inputs, dust=dust)
        self._absolute: dict[Node, Absolute] = {}
        self._bounds: dict[Node, Any] = {}
        self._coefficients: dict[Any, Any] = {}
        self._uses: Counter[Node] = Counter()
        self._crossed: Counter[Node] = Counter()

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN where there is none."""
        everything = needed(outputs)
        nodes = [node for node in everything if node not in self._relative]
        self._uses.update(part for part in outputs if isinstance(part, Node))
        self.count(nodes)
        for node in nodes:
            self._uses.update(part for part in node.arguments if isinstance(part, Node))
            if node.operation == "*" and all(self.relative(part) is None for part in node.arguments):
                self._crossed.update(set(node.arguments))
        for node in everything:
            if self._relative[node] is None and node not in self._absolute:
                self._absolute[node] = self._found(node)
        return tuple(whole(self._with_reserve(part)) for part in outputs)

    def pivot(self, node):
        """Bound on the relative error of a pivot, in `UNIT`, times `LIMIT`."""
        if node not in self._pivots:
            guards = self._guards.get(node, {})
            bound = None if node in guards else self._with_reserve(node)
            found = (0.0 if bound is None else bound) * self.over(node)
            for guard in guards:
                found = self.fused(GUARDED, guard - guard.arguments[0], found)
            self._pivots[node] = self.fused(CURVED * UNIT, found, 1.0) * (LIMIT * found)
        return self._pivots[node]

    def _found(self, node):
        kind, parts = node.operation, node.arguments
        if node.varies == BY_DESIGN:
            self._by_design.of([node])
            return Absolute([(MORE, self.size(node)), (1.0, self._by_design.total(node)), (1.0, self._dust)], MORE)
        if kind in INPUTS:
            relative, rest = self._inputs[node](self)
            return Absolute([(relative + MORE, self.size(node)), (1.0, rest), (1.0, self._dust)], MORE)
        if kind == "sign":
            cleared = self.above(self.size(parts[0]), self.total(parts[0]))
            return Absolute([(1.0, 0.0 / cleared), (1.0, self._dust)], 0.0)
        if kind in ("sin", "cos", "atan"):
            terms = [(ULP[kind] + MORE, self.size(node)), (1.0, self.total(parts[0])), (1.0, self._dust)]
            return Absolute(terms, MORE)
        if kind == "rest":  # truly nothing
            return Absolute([(1.0 / UNIT, self.size(node))], 0.0)
        if kind == "*":
            return self._of_product(node)
        return self._of_quotient(node) if kind == "/" else self._of_sum(node)

    def _of_sum(self, node):
        """A sum's error is at most those of its parts and a rounding of the sum of their magnitudes, or of its own."""
        if (near := beside_one(self._graph, node)) is not None:
            return Absolute([(1.0 + MORE, self.size(node)), (1.0, near), (1.0, self._dust)], MORE)
        parts = [part for part in node.arguments if not is_zero(part)]
        own = 1.0 if len(parts) > 1 else 0.0
        reserve = min(
            (self._absolute[part].reserve - own for part in parts if self.relative(part) is None), default=FEW
        )
        is_charged = reserve < 0.0 or node.operation == "total"
        terms = [(1.0, self._dust)]
        if is_charged:
            terms.append((own + MORE, self.size(node)))
        for part in parts:
            found = self.relative(part)
            if found is None:
                terms += self.terms(part)
            else:
                terms.append((self.coefficient(found, 0.0 if is_charged else own + reserve), self.size(part)))
                terms.append((1.0, found.dust))
        if node.operation == "total":  # sums without loss, and what those of their losses lose
            lost = (2.0 * (len(node.arguments) - 1)) ** 3 * UNIT * UNIT
            terms += [(lost, self.size(part)) for part in parts]
        return Absolute(terms, MORE if is_charged else reserve)

    def _of_product(self, node):
        left, right = node.arguments
        if self.relative(left) is not None:
            left, right = right, left
        found = self.relative(right)
        if found is not None:
            own = 0.0 if any(map(is_scaling, node.arguments)) else 1.0
            lost = [] if found.dust is None else [(found.dust, self.cap(left))]
            return self._scaled(left, found, own, self.size(right), lost)
        if left is right:
            bound, size = self.bound(left, 0.5), self.size(left)
            terms = [(self.fused(SECOND, bound, size + size), bound), (1.0, self._dust)]
            return Absolute(terms, 2.0 * max(self._absolute[left].reserve, 0.5) - 1.0)
        held = self._absolute[left].reserve + self._absolute[right].reserve
        one, other = self.bound(left, 0.0 if held >= 1.0 else 1.0), self.bound(right)
        if self._crossed[left] > self._crossed[right]:  # one of both is to be larger, and may be so for others too
            factors = self.size(right), self.larger(left)
        else:
            factors = self.larger(right), self.size(left)
        return Absolute(
            [(factors[0], one), (factors[1], other), (1.0, self._dust)], held - 1.0 if held >= 1.0 else MORE
        )

    def _of_quotient(self, node):
        above, below = node.arguments
        return self._scaled(above, self.as_divisor(below), 1.0, self.over(below), [])

    def _scaled(self, part, found, own, size, lost):
        """An absolute part times, or over, what is relative."""
        own += found.roundings
        held = self._absolute[part].reserve
        if found.pivots:
            charge = self.coefficient(found._replace(roundings=0.0), own + MORE)
            bound, reserve = self.fused(charge, self.larger(part), self.bound(part)), MORE
        elif held >= own:
            bound, reserve = self.bound(part), held - own
        else:
            charge = 4.0 * math.ceil((own + MORE - held) / 4.0)
            bound, reserve = self.fused(charge, self.size(part), self.bound(part)), held + charge - own
        return Absolute([(size, bound), (1.0, self._dust), *lost], reserve)

    def terms(self, part):
        """Terms of the bound of an absolute part; one where it is used again."""
        return self._absolute[part].terms if self._uses[part] < 2 else [(1.0, self.bound(part))]

    def bound(self, part, held=0.0):
        """Bound of an absolute part; with `MORE` in reserve if it has less than wanted."""
        if part not in self._bounds:
            self._bounds[part] = self.summed(self._absolute[part].terms)
        bound = self._bounds[part]
        return bound if self._absolute[part].reserve >= held else self.fused(held + MORE, self.size(part), bound)

    def coefficient(self, found, more=0.0):
        """What a relative error is of the magnitude of its value, in `UNIT`."""
        roundings = found.roundings + more
        if not found.pivots:
            return roundings
        key = roundings, *sorted((pivot.index, power) for pivot, power in found.pivots.items())
        if key not in self._coefficients:
            slope = _slope(found.pivots.values())
            powers = [(pivot, slope * abs(power)) for pivot, power in found.pivots.items()]
            roundings -= sum(power * self._reserve(pivot) / SAFE for pivot, power in powers)
            terms = [(power / LIMIT, self.pivot(pivot)) for pivot, power in powers]
            self._coefficients[key] = self.summed([*terms, (1.0, roundings)])
        return self._coefficients[key]

    def _reserve(self, part):
        return self._absolute[part].reserve if part in self._absolute else 0.0

    def total(self, part):
        """The whole bound of a part of an operation, without reserve; None where it is exact."""
        bound, reserve = self._with_reserve(part), self._reserve(part)
        return self.fused(-reserve / SAFE, self.size(part), bound) if reserve else bound

    def _with_reserve(self, part):
        found = self.relative(part)
        if found is None:
            return self.bound(part)
        return self.summed([(self.coefficient(found), self.size(part)), (1.0, found.dust)])

    def larger(self, part):
        """Bound on the magnitude of the exact value of an absolute part."""
        return self.fused(SECOND, self.bound(part), self.size(part))

    def above(self, value, total, floor=None):
        """By how much a value is above a floor when its error is taken off; 0 where it may not be."""
        if total is not None:
            value = value - (SAFE * UNIT) * total
        return self._graph.node("divisor", value if floor is None else value - floor, 0.0)


def _slope(powers):
    """How much more than `CURVED` allows for pivots to some powers make; by Jensen as if all were one."""
    power = sum(map(abs, powers))
    return max(1.0, math.expm1(-power * math.log1p(-KNOWN)) / (power * KNOWN * (1.0 + CURVED * KNOWN)))

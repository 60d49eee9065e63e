"""Proven bounds on the rounding errors of recorded outputs that cost about as much as the outputs.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, sections 3.1 to 3.4) with what
the structure tells beforehand. What is computed along is as little as can be:

relative value
    Exact times (1 + d) for each of some roundings, |d| <= `UNIT`, and times (1 + e) to some power for each of some
    pivots, see `counted`. Nothing is computed for it.
pivot
    A sum that something is divided by or whose root is taken. Its relative error is computed once, by a reciprocal that
    is there if possible, and shared by all products with it.
absolute value
    Any other. Its bound is computed, once.
bound
    Of an absolute value: at least its error and its reserve.
reserve
    So many roundings of the value itself, a number that no operation hangs on. A sum needs a rounding of itself, which
    is at most the sum of its parts' magnitudes: it takes it from their reserves, and has what is left. A product takes
    its roundings in the same way.
charge
    What is added to a bound so that it has a reserve: roundings of the value, which are an operation unless its
    magnitude is multiplied by something anyhow. So reserves are large where they are free.
total
    The bound without its reserve, in `UNIT`, as `bounds` has it.
dust
    What may be lost as too small for a double.

What a design fixes is found once, however many angles there are: where it is not relative the rules of `bounds`, which
are dearer and nearer, bound it, those of lengths and their rests among them. Its reserve is added to that.

With errors a and b of two absolute factors x and y, that of x y is at most |y| a + |x| b + a b. A bound is infinite
where a pivot is not `KNOWN`, or where the guard of a divisor acts. Each bound has dust in it.
"""

import math
from collections import Counter
from typing import Any, NamedTuple

from ..numbers.elementary import UNIT
from ..numbers.planar import minus
from .bounds import DUST, SAFE, is_scaling, is_zero
from .counted import ROUNDED, Counted
from .functions import ULP, beside_one, moved_apart
from .graph import BY_DESIGN, Node, needed, varies

KNOWN = 2.0**-4
"""Relative errors of pivots stay below it."""
LIMIT = 2.0**1022
"""What relative errors of pivots are held times, over a quarter of `KNOWN`: an overflow where they reach that."""
GUARDED = 2.0**1000
"""Makes what a guard adds infinite, times `LIMIT`."""
UNGUARDED = 2.0**34
"""Over a guard that is too small for it this overflows, and there is no bound."""
RESERVE = 6.0
"""Roundings in reserve where they are free, and those to be left at least where they are charged to a factor."""
STEP = 4.0
"""So many roundings at a time are charged, alone and beside errors of pivots: few sums of these are to be computed."""


class Absolute(NamedTuple):
    """Bound of an absolute value, as the products that it is the sum of, and its reserve."""

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

    Attributes
    ----------
    known : float
        Below which relative errors of pivots stay, or there is no bound.
    """

    known = KNOWN

    def __init__(self, graph, inputs=None, dust=DUST):
        super().__init__(graph, inputs, dust)
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
            if self.is_absolute(node) and node not in self._absolute:
                found = self._found(node)
                self._absolute[node] = found._replace(terms=[*found.terms, *self.overflow(node)])
        return tuple(0.0 if bound is None else bound for bound in map(self._of_output, outputs))

    def _of_output(self, part):
        """Of what no product is, what is lost of the bound itself may be all of it."""
        bound, found = self._with_reserve(part), self.relative(part)
        is_product = found is None or found.dust is not None
        if not (bound is None or is_product):
            bound = self.summed([(1.0, bound), (1.0, self._lost)])
        for pivot in self.unseen(part) if isinstance(part, Node) else ():
            bound = self.fused(0.0, self.pivot(pivot), bound)
        return bound

    def unseen(self, output):
        """Pivots that may vanish with an output, though its error does not grow with theirs."""
        return self.behind.unseen(output)

    def overflow(self, node):
        """Term that is no number where a pivot may be too large for a double: one over it is zero, and truly not."""
        return [(1.0, 0.0 * self.cap(node))] if node in self._divisors else []

    def is_absolute(self, node):
        """Whether a value has a bound of its own."""
        return self._relative[node] is None

    def free(self, node):
        """Reserve of an absolute value where it is free."""
        return RESERVE

    def told(self, node):
        """Error of an input that is not exact."""
        return self._inputs[node](self)

    def pivot(self, node):
        """Bound on the relative error of a pivot, over a quarter of `known`."""
        if node not in self._pivots:
            guards = self._guards.get(node, {})
            bound = None if node in guards else self._with_reserve(node)
            found = (0.0 if bound is None else 4.0 / self.known * bound) * self.over(node)
            for guard in guards:
                root, unit = guard.arguments
                found = self.fused(GUARDED + 0.0 * (UNGUARDED / unit), guard - root, found)
            self._pivots[node] = (LIMIT * found) * (1.0 / LIMIT)
        return self._pivots[node]

    def _found(self, node):
        kind, parts, free = node.operation, node.arguments, self.free(node)
        if node.varies == BY_DESIGN:
            self._by_design.of([node])
            error = self._by_design.total(node)
            return Absolute([(free * ROUNDED, self.size(node)), (ROUNDED, error), (1.0, self._lost)], free)
        if node in self._inputs:
            relative, rest = self.told(node)
            terms = [((relative + free) * ROUNDED, self.size(node)), (ROUNDED, rest), (1.0, self._lost)]
            return Absolute(terms, free)
        if kind == "sign":
            return Absolute([self.doubt(parts[0]), (1.0, self._lost)], 0.0)
        if kind in ("sin", "cos", "atan"):
            terms = [((ULP[kind] + free) * ROUNDED, self.size(node)), (1.0, self._lost)]
            return Absolute([*terms, *self.of_function(self._with_reserve(parts[0]))], free)
        if kind == "rest":  # truly nothing
            return Absolute([(ROUNDED / UNIT, self.size(node))], 0.0)
        if kind == "*":
            return self._of_product(node)
        return self._of_quotient(node) if kind == "/" else self._of_sum(node)

    def _of_sum(self, node):
        """A sum's error is at most those of its parts and a rounding of the sum of their magnitudes, or of its own."""
        free = self.free(node)
        if (near := beside_one(self._graph, node, self._of_sign)) is not None:
            terms = [((1.0 + free) * ROUNDED, self.size(node)), (ROUNDED, near), (1.0, self._lost)]
            return Absolute(terms, free)
        parts = [part for part in node.arguments if not is_zero(part)]
        own = 1.0 if len(parts) > 1 else 0.0
        reserve = min(
            (self._absolute[part].reserve - own for part in parts if self.relative(part) is None), default=free
        )
        is_charged = reserve < 0.0 or self.is_charged(node)
        moved = moved_apart(parts)
        terms = [(1.0, self._lost)]
        if moved is not None:
            terms.append((ROUNDED, moved))
        if is_charged:
            terms.append(((own + free) * ROUNDED, self.size(node)))
        for part in parts:
            found = self.relative(part)
            if found is None:
                terms += self.terms(part)
            else:
                terms.append((self.coefficient(found, 0.0 if is_charged else own + reserve), self.size(part)))
                terms.append((ROUNDED, found.dust))
        if node.operation == "total":  # sums without loss, and what those of their losses lose
            lost = (2.0 * (len(node.arguments) - 1)) ** 3 * UNIT * UNIT * ROUNDED
            terms += [(lost, self.size(part)) for part in parts]
        return Absolute(terms, free if is_charged else reserve)

    def is_charged(self, node):
        """Whether a sum's own rounding is charged to itself."""
        return node.operation == "total"

    def of_function(self, bound):
        """Terms of a function that changes no faster than its argument, which has a bound."""
        return [(1.0, bound)]

    def doubt(self, part):
        """Term that is no number where the sign of a part may truly be the other, though it be too large for a double.

        So its reserve, which is infinite then, is not taken off.
        """
        return 1.0, 0.0 / self._graph.node("divisor", minus(self.size(part), self._with_reserve(part)), 0.0)

    def _of_sign(self, sign):
        """Bound on the error of a sign that a design has."""
        self._by_design.of([sign])
        return self._by_design.total(sign)

    def _of_product(self, node):
        left, right = node.arguments
        if self.relative(left) is not None:
            left, right = right, left
        found = self.relative(right)
        if found is not None:
            own = 0.0 if any(map(is_scaling, node.arguments)) else 1.0
            return self._scaled(node, left, found, own, self.size(right))
        if left is right:
            terms = [(self.larger(left, 2.0), self.bound(left, 0.5)), (1.0, self._lost)]
            return Absolute(terms, 2.0 * max(self._absolute[left].reserve, 0.5) - 1.0)
        held = self._absolute[left].reserve + self._absolute[right].reserve
        one, other = self.bound(left, 0.0 if held >= 1.0 else 1.0), self.bound(right)
        if self._crossed[left] > self._crossed[right]:  # one of both is to be larger, and may be so for others too
            factors = self.size(right), self.larger(left)
        else:
            factors = self.larger(right), self.size(left)
        terms = [(factors[0], one), (factors[1], other), (1.0, self._lost)]
        return Absolute(terms, held - 1.0 if held >= 1.0 else RESERVE)

    def _of_quotient(self, node):
        above, below = node.arguments
        return self._scaled(node, above, self.as_divisor(below), 1.0, self.over(below))

    def _scaled(self, node, part, found, own, size):
        """An absolute part times, or over, what is relative."""
        own += found.roundings
        held, bound, lost = self._absolute[part].reserve, self.bound(part), found.dust
        if found.pivots:
            reserve = max(held - own, self.free(node))
            charge = self.coefficient(found._replace(roundings=0.0), reserve + own - held)
            bound = self.fused(charge, self.larger(part), bound)
        elif held >= own:
            reserve = held - own
        else:
            charge = self.charge(node, own - held)
            bound, reserve = self.fused(charge * ROUNDED, self.size(part), bound), held + charge - own
        terms = [(size, bound), (1.0, self._lost)]
        if lost is not None and varies(self.cap(part)) and reserve + own >= 1.0 and not (varies(size) or varies(lost)):
            terms[0] = size + lost, bound  # which is a rounding of the part at least
        elif lost is not None:
            most = self.cap(part)
            terms.append((ROUNDED * lost, self.larger(part) if varies(most) else most))
        return Absolute(terms, reserve)

    def charge(self, node, missing):
        """Roundings that the factor of a product is charged with, whose reserve is less than it takes."""
        return stepped(missing + RESERVE)

    def terms(self, part):
        """Terms of the bound of an absolute part; one where it is used again."""
        return self._absolute[part].terms if self._uses[part] < 2 else [(1.0, self.bound(part))]

    def bound(self, part, held=0.0):
        """Bound of an absolute part; with `RESERVE` in reserve if it has less than wanted."""
        if part not in self._bounds:
            self._bounds[part] = self.summed(self._absolute[part].terms)
        bound = self._bounds[part]
        return (
            bound
            if self._absolute[part].reserve >= held
            else self.fused((held + RESERVE) * ROUNDED, self.size(part), bound)
        )

    def coefficient(self, found, more=0.0):
        """What a relative error is of the magnitude of its value."""
        if not found.pivots:
            return ROUNDED * (found.roundings + more)
        roundings = stepped(found.roundings + more)
        key = roundings, *sorted((pivot.index, power) for pivot, power in found.pivots.items())
        if key not in self._coefficients:
            slope = steepest(found.pivots.values())
            powers = [(pivot, slope * abs(power)) for pivot, power in found.pivots.items()]
            held = sum(power * self._reserve(pivot) for pivot, power in powers)
            terms = [(self.known / 4.0 * power, self.pivot(pivot)) for pivot, power in powers]
            self._coefficients[key] = self.summed([*terms, (1.0, ROUNDED * roundings - UNIT * held)])
        return self._coefficients[key]

    def _reserve(self, part):
        return self._absolute[part].reserve if part in self._absolute else 0.0

    def total(self, part):
        """The whole bound of a part of an operation in `UNIT`, as `Bounds` has it; None where it is exact."""
        whole = self.whole(part)
        return None if whole is None else whole * (1.0 / UNIT)

    def whole(self, part):
        """The whole bound of a part of an operation, without reserve; None where it is exact."""
        bound, reserve = self._with_reserve(part), self._reserve(part)
        return self.fused(-UNIT * reserve, self.size(part), bound) if reserve and bound is not None else bound

    def _with_reserve(self, part):
        found = self.relative(part)
        if found is None:
            return self.bound(part)
        return self.summed([(self.coefficient(found), self.size(part)), (ROUNDED, found.dust)])

    def larger(self, part, times=1.0):
        """Bound on the magnitude of the exact value of an absolute part; so many times that of the computed one."""
        return self.fused(times, self.size(part), self.bound(part))

    def above(self, value, total, floor=None):
        """By how much a value is above a floor when its error is taken off; 0 where it may not be."""
        if total is not None:
            value = value - (SAFE * UNIT) * total
        return self._graph.node("divisor", value if floor is None else value - floor, 0.0)


def stepped(roundings):
    """As many roundings or few more, in steps."""
    return STEP * math.ceil(roundings / STEP)


def steepest(powers):
    """How much more than of first order pivots to some powers make while `KNOWN`; by Jensen as if all were one."""
    power = sum(map(abs, powers))
    return math.expm1(-power * math.log1p(-KNOWN)) / (power * KNOWN)

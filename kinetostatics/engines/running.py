"""Proven bounds on the rounding errors of recorded outputs that cost about as much as the outputs.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, sections 3.1 to 3.4) with what
the structure tells beforehand. A value is either

relative
    exact times (1 + d) for each of some `roundings`, |d| <= `UNIT`, and times (1 + e) to some power for each of some
    pivots (Higham's counter <k>, with pivots). Products, quotients and roots only count; nothing is computed. A pivot
    is a sum that something is divided by or whose root is taken: its relative error e is computed once.
absolute
    within `UNIT` times `factor` times (`bound` - `reserve` |value|) of the exact one. `bound` is computed along. It
    has what later roundings need in reserve, as |sum| is at most the sum of magnitudes that `bound` is made of: then a
    sum, or a product by what is relative, adds no term of its own.

A bound is infinite where a pivot is not known to one part in 256, or where the guard of a divisor acts.
"""

import math
from collections import Counter
from functools import reduce
from typing import Any, NamedTuple

from ..numbers.elementary import UNIT
from ..numbers.planar import plus
from .bounds import DUST, SAFE, ULP, is_zero, whole
from .trace import BY_ANGLE, INPUTS, Node, needed

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


class Relative(NamedTuple):
    """Error of a value that is a product: how many `roundings`, powers of `pivots`, and what it lost as too small."""

    roundings: float
    pivots: dict[Node, float]
    dust: Any


class Absolute(NamedTuple):
    """Error of a value with sums in it."""

    terms: list
    reserve: float


EXACT = Relative(0.0, {}, None)


class RunningBounds:
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
        self._graph, self._inputs, self._dust = graph, inputs or {}, dust
        self._relative: dict[Node, Relative | None] = {}
        self._absolute: dict[Node, Absolute] = {}
        self._bounds: dict[Node, Any] = {}
        self._uses: Counter[Node] = Counter()
        self._crossed: Counter[Node] = Counter()
        self._pivots: dict[Node, Any] = {}
        self._coefficients: dict[Any, Any] = {}
        self._reciprocals: dict[Node, Any] = {}
        self._guards: dict[Node, dict[Node, None]] = {}
        self._caps: dict[Node, Any] = {}
        self._positive: dict[Node, bool] = {}

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN where there is none."""
        everything = needed(outputs)
        nodes = [node for node in everything if node not in self._relative]
        self._uses.update(part for part in outputs if isinstance(part, Node))
        for node in nodes:
            self._tell_reciprocal(node)
            self._uses.update(part for part in node.arguments if isinstance(part, Node))
        for node in nodes:
            self._relative[node] = self._counted(node)
        for node in nodes:
            if self._relative[node] is None:
                if node.operation == "*" and self.relative(node.arguments[0]) is self.relative(node.arguments[1]):
                    self._crossed.update(set(node.arguments))
        for node in everything:
            if self._relative[node] is None and node not in self._absolute:
                self._absolute[node] = self._found(node)
        return tuple(whole(self._with_reserve(part)) for part in outputs)


    # What is relative

    def relative(self, part):
        """Error of a part if it is relative, else None."""
        return self._relative[part] if isinstance(part, Node) else EXACT

    def _counted(self, node):
        kind, parts = node.operation, node.arguments
        if kind in INPUTS:
            return self._counted_input(node)
        if kind in ("+", "-", "total"):
            return self._counted_sum(node, [part for part in parts if not is_zero(part)])
        if kind == "*":
            return EXACT if is_zero(node) else self._counted_product(node, 1.0, _is_scaling)
        if kind == "/":
            return self._counted_product(node, -1.0, lambda part: part is parts[1] and _is_scaling(part))
        if kind in ("sqrt", "root"):
            return self._counted_root(node)
        if kind == "divisor":
            return self._counted_divisor(node)
        found = self.relative(parts[0])
        if kind in ("abs", "held") or found is None:
            return found
        is_exact = not found.roundings and found.dust is None
        if kind == "sign":  # of a product only what is lost as too small may turn it
            return EXACT if found.dust is None and not found.pivots else None
        return Relative(ULP[kind], {}, None) if is_exact and not found.pivots else None

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
        if all(error is not None and error == EXACT for error in errors) and node.operation != "total":
            return Relative(1.0, {}, None)
        is_plus = node.operation == "+" and all(map(self.is_positive, parts))
        if None in errors or not is_plus or any(error.pivots for error in errors):
            return None
        dust = reduce(plus, (error.dust for error in errors))
        return Relative(1.0 + max(error.roundings for error in errors), {}, dust)

    def _counted_product(self, node, sign, is_exactly):
        left, right = node.arguments
        one, other = self.relative(left), self.as_divisor(right) if sign < 0.0 else self.relative(right)
        if one is None or other is None:
            return None
        pivots = {pivot: one.pivots.get(pivot, 0.0) + sign * other.pivots.get(pivot, 0.0) for pivot in one.pivots | other.pivots}
        own = 0.0 if is_exactly(left) or is_exactly(right) else 1.0
        return Relative(
            one.roundings + other.roundings + own,
            {pivot: power for pivot, power in pivots.items() if power},
            self._dust_of_product(node, one, other, sign),
        )

    def _dust_of_product(self, node, one, other, sign):
        if self._dust is None:
            return None
        left, right = node.arguments
        dust = self._dust
        if one.dust is not None:
            dust = plus(one.dust * (self.cap(right) if sign > 0.0 else self._cap_over(right)), dust)
        if other.dust is not None:
            dust = plus(other.dust * self.cap(left), dust)
        return dust

    def as_divisor(self, part):
        """Error of a part that something is divided by: its own if it cannot be lost as too small, or of a pivot."""
        found = self.relative(part)
        return found if found is not None and found.dust is None else Relative(0.0, {part: 1.0}, None)

    def _counted_root(self, node):
        square = node.arguments[0]
        found = self.relative(square)
        if found is None or not self.is_positive(square) or _varies(found.dust):
            found = Relative(0.0, {square: 1.0}, None)
        dust = found.dust
        if dust is not None:
            dust = math.sqrt(dust / UNIT) if isinstance(dust, float) else (dust / UNIT).sqrt()
        return Relative(1.0 + 0.5 * found.roundings, {pivot: 0.5 * power for pivot, power in found.pivots.items()}, dust)

    def _counted_divisor(self, node):
        """As what is guarded; where the guard acts that is no pivot."""
        found = self.relative(node.arguments[0])
        if found is None:
            found = Relative(0.0, {node.arguments[0]: 1.0}, None)
        pivot = next((pivot for pivot in found.pivots if pivot not in self._pivots), node)
        self._guards.setdefault(pivot, {})[node] = None
        return found if pivot is not node else found._replace(pivots={**found.pivots, node: 1.0})

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

    def over(self, node):
        """Bound on one over the magnitude of a computed value: its reciprocal where that is computed."""
        if not isinstance(node, Node):
            return 1.0 / abs(node)
        if node not in self._reciprocals:
            above_one = node.operation == "+" and _is_number(node.arguments[0], 1.0) and self.is_positive(node)
            if above_one and node.arguments[1].operation == "abs":
                return 1.0
            self._reciprocals[node] = 1.0 / self._graph.node("divisor", self.size(node), 0.0)
        return self._reciprocals[node]

    def _tell_reciprocal(self, node):
        """Take note of reciprocals among the values, of what is guarded, and of squares of what they are of."""
        if node.operation != "/" or isinstance(node.arguments[0], Node):
            return
        above, below = node.arguments
        over = self.size(node) * (1.0 / abs(above)) if above else None
        while over is not None and isinstance(below, Node) and below not in self._reciprocals:
            self._reciprocals[below] = over
            if below.operation in ("sqrt", "root"):
                over = over * over
            elif below.operation != "divisor":
                return
            below = below.arguments[0]

    # What is absolute

    def _found(self, node):
        kind, parts = node.operation, node.arguments
        if kind in INPUTS:
            relative, rest = self._inputs[node](self)
            return Absolute([(relative + MORE, self.size(node)), (1.0, rest)], MORE)
        if kind == "sign":
            return Absolute([(1.0, 0.0 / self.above(self.size(parts[0]), self.total(parts[0])))], 0.0)
        if kind in ("sin", "cos", "atan"):
            return Absolute([(ULP[kind] + MORE, self.size(node)), (1.0, self.total(parts[0]))], MORE)
        if kind == "*":
            return self._of_product(node)
        return self._of_quotient(node) if kind == "/" else self._of_sum(node)

    def _of_sum(self, node):
        """A sum's error is at most those of its parts and a rounding of the sum of their magnitudes, or of its own."""
        parts = [part for part in node.arguments if not is_zero(part)]
        own = 1.0 if len(parts) > 1 else 0.0
        reserve = min((self._absolute[part].reserve - own for part in parts if self.relative(part) is None), default=FEW)
        is_charged = reserve < 0.0 or node.operation == "total" or node.varies < BY_ANGLE
        terms = [(own + MORE, self.size(node))] if is_charged else []
        for part in parts:
            found = self.relative(part)
            if found is None:
                terms += self.terms(part)
            else:
                terms.append((self.coefficient(found, 0.0 if is_charged else own + reserve), self.size(part)))
                terms.append((1.0, found.dust))
        if node.operation == "total":  # three sums without loss, and what they lose
            terms += [(216.0 * UNIT * UNIT, self.size(part)) for part in parts]
        return Absolute(terms, MORE if is_charged else reserve)

    def _of_product(self, node):
        left, right = node.arguments
        if self.relative(left) is not None:
            left, right = right, left
        found = self.relative(right)
        if found is not None:
            own = 0.0 if any(map(_is_scaling, node.arguments)) else 1.0
            lost = [] if found.dust is None else [(found.dust, self.cap(left))]
            return self._scaled(left, found, own, self.size(right), lost)
        if left is right:
            bound, size = self.bound(left, 0.5), self.size(left)
            terms = [(self.fused(SECOND, bound, size + size), bound), (1.0, self._dust)]
            return Absolute(terms, 2.0 * max(self._absolute[left].reserve, 0.5) - 1.0)
        if self._crossed[left] > self._crossed[right]:
            left, right = right, left
        held = [self._absolute[part].reserve for part in (left, right)]
        bound = self.bound(left, 0.0 if sum(held) >= 1.0 else 1.0)
        terms = [(self.larger(right), bound), (self.size(left), self.bound(right)), (1.0, self._dust)]
        return Absolute(terms, sum(held) - 1.0 if sum(held) >= 1.0 else MORE)

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
            roundings -= sum(power * self._reserve(pivot) for pivot, power in powers)
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

    # Arithmetic

    def summed(self, terms):
        """Sum of products: of what a design fixes first, the others one after the other; None of nothing."""
        terms = [
            self._stripped(one, other)
            for one, other in terms
            if other is not None and not _is_number(one, 0.0) and not _is_number(other, 0.0)
        ]
        if any(_is_number(one, 1.0) and _varies(other) for one, other in terms):  # it has dust enough
            terms = [term for term in terms if not (_is_number(term[0], 1.0) and self._is_dust(term[1]))]
        terms.sort(key=lambda term: _varies(term[0]) or _varies(term[1]))
        total = None
        for one, other in terms:
            total = self.fused(one, other, total)
        return total

    def _is_dust(self, part):
        return isinstance(part, float) and self._dust is not None and part <= 256.0 * self._dust

    def _stripped(self, one, other):
        """A term whose magnitude is of a product with numbers of the design: these multiply the other factor."""
        while not _varies(one) and _varies(other):
            inner = other.arguments[0] if other.operation == "abs" else other
            if inner.operation != "*" or not self.is_positive(other):
                break
            fixed = [part for part in inner.arguments if not _varies(part)]
            if not fixed:
                break
            (rest,) = (part for part in inner.arguments if _varies(part))
            one, other = one * self.size(fixed[0]), self.size(rest)
        return one, other

    def fused(self, one, other, more):
        """Product and sum, in one operation where the processor has it."""
        plain = [part for part in (one, other) if not isinstance(part, Node)]
        if more is None or len(plain) == 2 or 1.0 in plain:
            return plus(one * other, more)
        return self._graph.node("fma", one, other, more)

    def above(self, value, total, floor=None):
        """By how much a value is above a floor when its error is taken off; 0 where it may not be."""
        if total is not None:
            value = value - (SAFE * UNIT) * total
        return self._graph.node("divisor", value if floor is None else value - floor, 0.0)

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

    def cap(self, part):
        """A magnitude not less than a value's: of its design if possible."""
        if not isinstance(part, Node):
            return abs(part)
        if part not in self._caps:
            found = None
            if part.varies == BY_ANGLE and part.operation not in INPUTS:
                found = self._cap(part.operation, part.arguments)
            self._caps[part] = self.size(part) if found is None or _varies(found) else found
        return self._caps[part]

    def _cap(self, kind, parts):
        if kind in ("sin", "cos"):
            return 1.0
        if kind in ("abs", "held", "+", "-", "divisor"):
            return reduce(plus, map(self.cap, parts))
        if kind == "*":
            return self.cap(parts[0]) * self.cap(parts[1])
        if kind in ("sqrt", "root"):
            square = self.cap(parts[0])
            return square.sqrt() if isinstance(square, Node) and not _varies(square) else None
        if kind == "/":
            return self.cap(parts[0]) * self._cap_over(parts[1])
        return None

    def _cap_over(self, part):
        guarded = isinstance(part, Node) and part.operation == "divisor" and not _varies(part.arguments[1])
        return self.over(part.arguments[1] if guarded else part)


def _is_scaling(part):
    """Whether a factor is a power of two near one: it loses no digit but of dust."""
    return not isinstance(part, Node) and math.frexp(part)[0] in (0.5, -0.5) and 0.01 < abs(part) < 100.0


def _is_number(part, number):
    return not isinstance(part, Node) and part == number


def _varies(part):
    return isinstance(part, Node) and part.varies == BY_ANGLE


def _slope(powers):
    """How much more than `CURVED` allows for pivots to some powers make; by Jensen as if all were one."""
    power = sum(map(abs, powers))
    return max(1.0, math.expm1(-power * math.log1p(-KNOWN)) / (power * KNOWN * (1.0 + CURVED * KNOWN)))

"""Proven bounds on the rounding errors of recorded outputs, as further nodes of the same graph.

Running error analysis (Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, section 3.3): each value v has a
number k, fixed by the structure, and E, computed with the value. The exact result is within ``unit (k |v| + E)`` of v.
Products, quotients and roots of values with few relative errors (k) have few as well; E is needed where sums cancel.
One table of rules serves every arithmetic; engines see only the recorded operations.

Tight bounds follow from the adjoints of one output. With coefficients c of the computed values the error of a value is
exactly the sum of c e over its arguments, its own rounding, and q of second order. So the error of the output is the
sum of a (own + q) over all values, with their adjoints a (Linnainmaa 1976, *BIT* 16, 146; Langlois 2001, *BIT* 41,
606). Let C be running bounds with terms of second order and underflow ``STRETCH`` times as large. They are at least
sum |a| STRETCH q, so C / STRETCH covers all q. Twice that also covers the rounding of the adjoints and of products of
k.
"""

import math
from collections.abc import Callable
from functools import partial, reduce
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..numbers.arithmetic import NEGLIGIBLE_LENGTH, RELATIVE_OFFSET, UNIT_ROUNDOFF
from ..numbers.planar import plus, product
from .derivatives import adjoints
from .graph import BY_ANGLE, BY_DESIGN, INPUTS, Node, is_negative, is_of_angle, needed, varies

SAFE = 1.0 + 1e-9
"""Factor on bounds for the rounding of their own arithmetic and for products of counted roundings."""
CAP = 2.0**100
"""Largest number of a scene, in SI units, with bounds; rows of tables may be larger."""
MAX_DIVISOR = 2.0**1000
"""A divisor up to this size has a reciprocal with all digits."""
TURN_SHARE = 4.5
"""Largest error of a sine or cosine near 1, relative to the other one squared, in any precision."""
LOST_SQUARE = 2.0**-900
"""Underflow of the square of a sine or cosine, in units."""
SECOND_ORDER = 8.0
"""Roundings of an operation in terms of second order, besides those of its arguments."""
SUMS = {"+", "-"}
"""Operations that need the total bound of a part, not its two numbers."""
CHARGED = 2.0
"""Number of roundings of both parts above which the rounding of their sum is added to it, without an operation."""
STRETCH = 2.0**16
"""Factor on terms of second order in the running bounds that give the remainder of a tight bound."""
SEED = 2.0**900
"""Adjoint of the output of a tight bound: no significant adjoint underflows."""


class Arithmetic(NamedTuple):
    """Properties of a floating-point arithmetic.

    `unit` is the largest relative error of one rounding, `safe` a factor on bounds for terms of second order, over all
    operations in a row. `dust` is the underflow of one operation, in units; None if nothing underflows. `ulp` is the
    largest relative error of sin, cos, atan, exp and log, in units; tests check all engines. `limit` is half of the
    largest power of two.

    `as_recorded`: the recorded operations run in order in IEEE double precision. Otherwise a compiler may fuse products
    with sums and flush small results to zero, inputs are rounded once, and bounds are computed beside values in double.
    """

    dtype: Any
    unit: float
    safe: float
    dust: float | None
    ulp: float
    limit: float = math.inf
    as_recorded: bool = False


OWN = Arithmetic(np.float64, UNIT_ROUNDOFF, SAFE, 2.0**-960, 2.0, as_recorded=True)
DOUBLE = Arithmetic(np.float64, UNIT_ROUNDOFF, SAFE, 2.0**-960, 4.0, 2.0**1022)
SINGLE = Arithmetic(np.float32, 2.0**-24, 1.0 + 2.0**-5, 2.0**-101, 8.0, 2.0**126)
PRECISIONS = {"double": DOUBLE, "single": SINGLE}
"""Arithmetic of programs that JAX runs, or that run in another precision, by the name users give."""


class Error(NamedTuple):
    """Bound on the error of a value, in units: `relative` times the value, and `rest`.

    The rest is None, a number if only underflow can cause it, or a node.
    """

    relative: float
    rest: Any


EXACT = Error(0.0, None)


class ErrorBounds:
    """Running bounds for the nodes of a graph, each computed once.

    ``inputs[node](bounds)`` is the `Error` of an input that is not exact. `given` has bounds, in double, for inputs and
    for values that the design fixes. `weight` is a factor on terms of second order: 1 for a bound; 0 leaves them out,
    with all doubts on signs and guards. Where ``cuts(node, error)`` is true, users of a node take it as exact; `cut`
    then has its bound in units.
    """

    def __init__(self, graph, inputs=None, arithmetic=OWN, given=None, weight=1.0, cuts=None):
        self.graph, self.arithmetic, self.weight, self.cut = graph, arithmetic, weight, {}
        self.inputs, self._cuts = inputs or {}, cuts
        self._given = given if given or arithmetic.as_recorded else ErrorBounds(graph, inputs)
        self.off = arithmetic.safe * arithmetic.unit
        self._errors: dict[Node, Error] = {}
        self.factors: dict[Node, tuple[Any, ...]] = {}
        self._users: dict[Any, set[str]] = {}
        self._caps: dict[Node, float | None] = {}
        self._positive: dict[Node, bool] = {}
        self._peaks: dict[Node, tuple[int, Any]] = {}

    def of(self, outputs):
        """A bound for each output, not negative; infinite or NaN without a bound.

        `NotGivenError` if code of the user's rounds in an unknown way, or terms of second order may be too large.
        """
        self.look_at(outputs)
        return tuple(map(self._whole, outputs))

    def look_at(self, outputs):
        """Find the errors of all nodes that outputs depend on."""
        nodes = [node for node in needed(outputs) if node not in self._errors]
        for node in nodes:
            for part in node.arguments:
                self._users.setdefault(part, set()).add(node.operation)
        for node in nodes:
            if node in self._errors:  # an input needed it before
                continue
            error = self._errors[node] = self._error_of(node)
            if self._cuts is not None and self._cuts(node, error):
                self.cut[node], self._errors[node] = self.total(node), EXACT
            if not self.arithmetic.as_recorded:
                self._require_small(node)

    def _whole(self, part):
        total = self.total(part)
        if total is None:
            return 0.0
        own = None if is_zero(total) else self.arithmetic.dust  # possible loss of the bound itself
        bound = self.fused(self.off, total, product(self.off, own))
        if part in self._peaks:
            bound = bound + 0.0 / self._positive_part(self.arithmetic.limit - self._peaks[part][1])
        return bound

    def _error_of(self, node):
        if self._given is None or not is_handed_over(node):
            if node in self.inputs:
                return self.inputs[node](self)
            return EXACT if node.operation in INPUTS else RULES[node.operation](self, node, *node.arguments)
        self._given.look_at([node])
        relative, rest = self._given.error(node)
        if self.arithmetic.as_recorded:
            return Error(relative, rest)
        finer = UNIT_ROUNDOFF / self.arithmetic.unit  # it is rounded once
        return Error(float(finer < 1.0) + finer * relative, plus(product(finer, rest), self.arithmetic.dust))

    def _require_small(self, node):
        """Check that terms of second order are small; keep the largest number that a node depends on."""
        parts = [] if is_handed_over(node) else [part for part in node.arguments if isinstance(part, Node)]
        depth = 1 + max((self._peaks[part][0] for part in parts), default=0)
        unit, safe = self.arithmetic.unit, self.arithmetic.safe
        if depth * (self._errors[node].relative + SECOND_ORDER) * unit > (safe - 1.0) / 4.0:
            raise NotGivenError("no bound can be given in this precision: there are too many operations in a row")
        peaks = [self._peaks[part][1] for part in parts]
        if not parts or node.operation in ("+", "-", "*", "/", "divisor", "exp"):
            peaks.append(self.largest(node))
        if node.operation == "total":
            peaks.append(reduce(plus, map(self.largest, node.arguments)))
        self._peaks[node] = depth, reduce(partial(self.graph.node, "divisor"), peaks)

    def error(self, part) -> Error:
        """Error of a part of an operation: a node or a plain number, which may not be one of the arithmetic."""
        if isinstance(part, Node):
            return self._errors[part]
        unit, dust = self.arithmetic.unit, self.arithmetic.dust
        if self.arithmetic.as_recorded or part == 0.0:
            return EXACT
        with np.errstate(over="ignore"):
            exact = float(self.arithmetic.dtype(part)) == part and abs(part) > unit * dust
        return EXACT if exact else Error(1.0, dust)

    def total(self, part, more=0.0):
        """The total bound of a part of an operation, in units, and `more` roundings of it; None if it is exact."""
        relative, rest = self.error(part)
        relative += more
        if not relative:
            return rest
        if part in self.factors and self._users.get(part, SUMS) <= SUMS:  # by factors: it needs no magnitude
            left, own, right, across = self.factors[part]
            return self.fused(self.size(right), self.fused(relative, self.size(left), own), across)
        return self.fused(relative, self.size(part), rest)

    def largest(self, part):
        """Bound on the magnitude of the exact value, without its relative errors."""
        rest = self.error(part).rest if self.weight else None
        return self.size(part) if rest is None else self.fused(self.weight * self.off, rest, self.size(part))

    def above(self, value, total):
        """A value less its error in units; 0 if the error is larger."""
        exact = total is None or not self.weight
        return self._positive_part(value if exact else value - (self.weight * self.off) * total)

    def _positive_part(self, value):
        return self.graph.node("divisor", value, 0.0) if isinstance(value, Node) else max(value, 0.0)

    def doubt(self, part):
        """0 if the magnitude of a part exceeds its error, otherwise infinite or NaN; None if it is exact."""
        total = self.total(part) if self.weight else None
        return total if total is None or is_zero(part) else 0.0 / self.clear(part)

    def clear(self, part):
        """Magnitude of a part less its error; 0 if the error is larger."""
        total = self.total(part)
        return self.size(part) if total is None else self.above(self.size(part), total)

    def over(self, part):
        """Bound on one over the magnitude of the exact value; NaN where that is too large for a double."""
        if not isinstance(part, Node):
            return 1.0 / (abs(part) * (1.0 - self.off))
        clear = self.clear(part)
        return self.fused(0.0, clear, 1.0 / clear)

    def underflow(self, rest, part):
        """A rest from underflow times the magnitude of a part: a number if its `cap` is known."""
        cap = None if rest is None else self.cap(part)
        return product(rest, self.largest(part) if cap is None else 2.0 * cap)

    def cap(self, part):
        """Largest magnitude of a part for numbers up to `CAP`; None if it depends on the value."""
        if not isinstance(part, Node):
            return abs(part)
        if part not in self._caps:
            rule = CAPS.get(part.operation) if self.arithmetic.as_recorded else None
            caps = [] if part.operation in ("parameter", "sin", "cos") else [self.cap(one) for one in part.arguments]
            self._caps[part] = None if rule is None or None in caps else rule(*caps)
        return self._caps[part]

    def is_reciprocal(self, part):
        """Whether a part is one over a number whose reciprocal cannot underflow."""
        if not isinstance(part, Node) or part.operation != "/" or isinstance(part.arguments[0], Node):
            return False
        above, below = part.arguments
        return abs(above) == 1.0 and (self.cap(below) or math.inf) < MAX_DIVISOR

    def rounds(self, *factors):
        """Roundings of a product or quotient: none, except underflow, for a sign or a power of two near one."""
        for part in factors if self.arithmetic.as_recorded else ():
            is_power = not isinstance(part, Node) and math.frexp(part)[0] in (0.5, -0.5) and 0.01 < abs(part) < 100.0
            if is_power or getattr(part, "operation", None) == "sign":
                return 0.0
        return 1.0

    def fused(self, one, other, more):
        """Product and sum, in one operation if the processor has it."""
        plain = [part for part in (one, other) if not isinstance(part, Node)]
        if more is None or len(plain) == 2 or 1.0 in plain:
            return plus(one * other, more)
        return self.graph.node("fma", one, other, more)

    def size(self, part):
        """Magnitude of a part of an operation."""
        if not isinstance(part, Node):
            return abs(part)
        if is_negative(part):
            return self.size(part.arguments[0])
        return part if self.is_positive(part) else abs(part)

    def is_positive(self, part):
        """Whether a part cannot be negative, for any numbers."""
        if not isinstance(part, Node):
            return part >= 0.0
        if part not in self._positive:
            kind, parts = part.operation, part.arguments
            self._positive[part] = (
                kind in ("abs", "sqrt", "root", "exp")
                or (kind in ("*", "/", "+") and all(map(self.is_positive, parts)))
                or (kind == "*" and parts[0] is parts[1])
                or (kind == "divisor" and any(map(self.is_positive, parts)))
            )
        return self._positive[part]


def is_handed_over(node):
    """Whether a node is computed in double beforehand: by design, from a table, or as sine or cosine of the crank."""
    return node.varies < BY_ANGLE or node.operation in INPUTS or is_of_angle(node)


def is_zero(part):
    """Whether a part of an operation is a product with the number 0."""
    factors = part.arguments if isinstance(part, Node) and part.operation == "*" else ()
    return any(not isinstance(factor, Node) and factor == 0.0 for factor in factors)


# Rules: the error of a result from those of its arguments


def _of_sum(bounds, node, *parts):
    unit, flushed = bounds.arithmetic.unit, None if bounds.arithmetic.as_recorded else bounds.arithmetic.dust
    if (near := _beside_one(bounds, node)) is not None:
        return Error(1.0, plus(near, flushed))
    others = [part for part in parts if not is_zero(part) or bounds.error(part).rest is not None]
    moved = _moved_apart(parts, unit)
    if len(others) < 2 and moved is None:
        return bounds.error(others[0]) if others else EXACT
    own, more = 0.0 if any(map(is_zero, parts)) else 1.0, 0.0
    if own and min(bounds.error(part).relative for part in parts) >= CHARGED:  # a sum is at most the sum of its parts
        own, more = 0.0, 1.0
    return Error(own, reduce(plus, (bounds.total(part, more) for part in others), plus(moved, flushed)))


def _of_total(bounds, node, *parts):
    """Sum of the errors; of a length and its rest together, only the error of the rest."""
    if node.varies == BY_DESIGN and bounds.arithmetic.as_recorded:
        more = 8.0 * bounds.graph.node("lost", *parts)
    else:  # compensated sums have errors of third order, or of second order if products are fused
        share = (2.0 * (len(parts) - 1)) ** 3 * bounds.arithmetic.unit ** (2 if bounds.arithmetic.as_recorded else 1)
        more = plus(share * reduce(plus, map(bounds.largest, parts)), bounds.arithmetic.dust)
    signed = [(-1, part.arguments[0]) if is_negative(part) else (1, part) for part in parts]
    alone = dict(enumerate(parts))
    for place, (sign, part) in enumerate(signed):
        if isinstance(part, Node) and part.operation == "rest":
            pairs = (other for other in alone if signed[other][0] == sign and signed[other][1] is part.arguments[0])
            if (length := next(pairs, None)) is not None:
                del alone[place], alone[length]
                whole, x, y = part.arguments
                lost = bounds.graph.node("lost_by_squares", whole, x, y)
                own = 4.0 * abs(part) + (part * part * (1.0 / UNIT_ROUNDOFF) + 8.0 * lost) / whole
                dust = product(1.0 / whole, bounds.arithmetic.dust)
                more = plus(reduce(plus, map(bounds.total, (x, y)), plus(own, dust)), more)
    return Error(1.0, reduce(plus, map(bounds.total, alone.values()), more))


def _of_product(bounds, node, left, right):
    if is_zero(node):  # exact, or NaN if the other factor is NaN
        total = bounds.total(right if isinstance(right, Node) else left)
        return Error(0.0, 0.0 * total) if isinstance(total, Node) else EXACT
    own, more = bounds.rounds(left, right), bounds.arithmetic.dust
    for factor, above in ((left, right), (right, left)):
        if bounds.is_reciprocal(factor) and isinstance(bounds.error(factor).rest, Node):
            rest = _rest_of_quotient(bounds, node, above, factor.arguments[1], more)
            return Error(own + bounds.error(above).relative + bounds.error(factor).relative, rest)
    if isinstance(bounds.error(right).rest, Node) and not isinstance(bounds.error(left).rest, Node):
        left, right = right, left
    (first, one), (second, other) = bounds.error(left), bounds.error(right)
    relative = own + first + second
    if not isinstance(one, Node):
        return Error(relative, plus(plus(bounds.underflow(one, right), bounds.underflow(other, left)), more))
    if isinstance(other, Node):
        across = bounds.fused(bounds.largest(left), other, more)
    else:
        across = plus(bounds.underflow(other, left), more)
    bounds.factors[node] = left, one, right, across
    return Error(relative, bounds.fused(bounds.size(right), one, across))


def _of_quotient(bounds, node, above, below):
    relative = bounds.rounds(below) + bounds.error(above).relative + bounds.error(below).relative
    more = None if bounds.is_reciprocal(node) else bounds.arithmetic.dust
    return Error(relative, _rest_of_quotient(bounds, node, above, below, more))


def _rest_of_quotient(bounds, node, above, below, more):
    one, other = bounds.error(above).rest, bounds.error(below).rest
    top = one if other is None else bounds.fused(bounds.size(node), other, one)
    return more if top is None else bounds.fused(bounds.over(below), top, more)


def _of_root(bounds, node, square, unit=None):
    relative, rest = bounds.error(square)
    more = None if bounds.arithmetic.as_recorded else bounds.arithmetic.dust
    if isinstance(rest, Node):
        slope = (0.5 * node) / bounds.above(square, bounds.total(square))
        rest = bounds.fused(slope, rest, more)
    else:
        small = None if rest is None else math.sqrt(rest * max(bounds.weight, 1.0) / bounds.arithmetic.unit)
        rest = plus(small, more)
        if node.operation == "root" and not bounds.is_positive(square):  # NaN where the square is negative
            rest = plus(0.0 * square.sqrt(), rest)
    return Error(0.5 * relative + 1.0, rest)


def _of_function(bounds, node, argument):
    """Error of a function with a slope of at most 1, and a change of slope of at most 1."""
    total = bounds.total(argument)
    rest = plus(total, None if bounds.arithmetic.as_recorded else bounds.arithmetic.dust)
    if total is not None and bounds.weight > 1.0:
        rest = bounds.fused((0.5 * bounds.weight * bounds.off) * total, total, rest)
    return Error(bounds.arithmetic.ulp, rest)


def _of_exponential(bounds, node, exponent):
    """With e the error of the exponent, e^|e| - 1 <= |e| / (1 - |e|); infinite where |e| may be 1."""
    total = bounds.total(exponent)
    if total is None:
        return Error(bounds.arithmetic.ulp, bounds.arithmetic.dust)
    return Error(bounds.arithmetic.ulp, bounds.fused(total, node, bounds.arithmetic.dust) / bounds.above(1.0, total))


def _of_logarithm(bounds, node, value):
    """With e the relative error of the value, |log(1 - e)| <= |e| / (1 - |e|)."""
    total, dust = bounds.total(value), None if bounds.arithmetic.as_recorded else bounds.arithmetic.dust
    return Error(bounds.arithmetic.ulp, dust if total is None else plus(total / bounds.clear(value), dust))


def _of_magnitude(bounds, node, value):
    """Linear only if the sign is known, which the terms of second order assume."""
    relative, rest = bounds.error(value)
    return Error(relative, plus(rest, bounds.doubt(value) if bounds.weight > 1.0 else None))


def _of_guarded(bounds, node, value, unit):
    """Exact arithmetic has no guard, so the error includes its shift of the value."""
    relative, rest = bounds.error(value)
    own = 0.0 if bounds.arithmetic.as_recorded else 2.0  # of values near the guard; both are rounded
    return Error(relative + own, bounds.fused(1.0 / bounds.arithmetic.unit, node - value, rest))


RULES: dict[str, Callable[..., Error]] = {
    **dict.fromkeys(("+", "-"), _of_sum),
    "total": _of_total,
    "rest": lambda bounds, node, *arguments: Error(0.0, bounds.size(node) * (1.0 / bounds.arithmetic.unit)),
    "*": _of_product,
    "/": _of_quotient,
    **dict.fromkeys(("sqrt", "root"), _of_root),
    **dict.fromkeys(("sin", "cos", "atan"), _of_function),
    "exp": _of_exponential,
    "log": _of_logarithm,
    "abs": _of_magnitude,
    "held": lambda bounds, node, value: bounds.error(value),
    "divisor": _of_guarded,
    "sign": lambda bounds, node, value: Error(0.0, bounds.doubt(value)),
}
"""By operation: ``rule(bounds, node, *arguments)``, the error of its result."""
CAPS: dict[str, Callable[..., float]] = {
    "parameter": lambda: CAP,
    **dict.fromkeys(("+", "-", "total"), lambda *parts: sum(parts)),
    "*": lambda left, right: left * right,
    **dict.fromkeys(("sin", "cos"), lambda: 1.0),
    **dict.fromkeys(("abs", "held"), lambda value: value),
    "sqrt": math.sqrt,
    "root": lambda square, unit: math.sqrt(square),
    "divisor": max,
}
"""By operation: the largest magnitude of its result from those of its arguments."""


def _beside_one(bounds, node):
    """Bound on the error, in units, of a sum of one and a sine or cosine of the crank angle; None for other nodes.

    Where the sum vanishes, as when linkages fold, its error vanishes as well, unlike the error of the function. Along
    an axis the function is times a sign of the design, whose doubt makes the bound infinite.
    """
    if len(node.arguments) != 2:
        return None
    turn, one = sorted(node.arguments, key=lambda part: not isinstance(part, Node))
    if isinstance(one, Node) or abs(one) != 1.0:
        return None
    sign = None
    if turn.operation == "*":
        sign, turn = sorted(turn.arguments, key=is_of_angle)
        if not (isinstance(sign, Node) and sign.operation == "sign" and sign.varies == BY_DESIGN):
            return None
    if not is_of_angle(turn):
        return None
    other = bounds.graph.node("cos" if turn.operation == "sin" else "sin", *turn.arguments)
    unsure = None if sign is None else bounds.total(sign)
    square = (-TURN_SHARE / bounds.arithmetic.unit) * (other * other)
    most = -plus(OWN.ulp, unsure)  # for every precision: it is rounded once
    return -bounds.graph.node("divisor", square - plus(LOST_SQUARE, unsure), most)


def _moved_apart(parts, unit):
    """Distance, in units, by which `arithmetic.offset_from_zero` moved a number off zero; None if it did not."""
    for part in parts:
        if not isinstance(part, Node):
            if part == RELATIVE_OFFSET * NEGLIGIBLE_LENGTH:
                return RELATIVE_OFFSET * NEGLIGIBLE_LENGTH / unit
        elif part.operation == "*" and RELATIVE_OFFSET in (
            factor for factor in part.arguments if not isinstance(factor, Node)
        ):
            return part * (1.0 / unit)
    return None


# Bounds of outputs


def running_bounds(graph, inputs, outputs, arithmetic=OWN):
    """A bound for each output, as `ErrorBounds.of`."""
    return ErrorBounds(graph, inputs, arithmetic).of(outputs)


def tight_bounds(graph, inputs, outputs, arithmetic=OWN):
    """A bound for each output, as `ErrorBounds.of`, smaller if errors cancel; NaN if only running bounds exist."""
    plain = ErrorBounds(graph, inputs, arithmetic)
    stretched = arithmetic if arithmetic.dust is None else arithmetic._replace(dust=STRETCH * arithmetic.dust)
    running = ErrorBounds(graph, inputs, stretched, plain, STRETCH)
    bounds = zip(outputs, running.of(outputs), strict=True)
    return tuple(_tight_bound(output, most, running, plain) for output, most in bounds)


def _tight_bound(output, most, running, plain):
    """Bound of first order by adjoints of the values that are used more than once, and the remainder.

    Errors of other values add up as running bounds up to their users. Divisors and squares are cut as well, because
    many products share their errors.
    """
    if not isinstance(most, Node):
        return most
    graph, nodes = running.graph, needed([output])
    users: dict[Node, list[Node]] = {}
    for node in nodes:
        for part in node.arguments if node.varies == BY_ANGLE else ():
            if isinstance(part, Node):
                users.setdefault(part, []).append(node)

    def cuts(node, error):
        uses = users.get(node, ())
        divides = any(
            user.operation in ("sqrt", "root", "divisor") or (user.operation == "/" and user.arguments[1] is node)
            for user in uses
        )
        return isinstance(error.rest, Node) and (len(uses) > 1 or divides)

    first = ErrorBounds(graph, running.inputs, running.arithmetic._replace(dust=None), plain, 0.0, cuts)
    (own,) = first.of([output])
    wanted = set(first.cut)
    for node in nodes:
        if varies(node) and any(part in wanted for part in node.arguments if isinstance(part, Node)):
            wanted.add(node)
    ends = {node for node in wanted if not varies(node)}
    slopes = adjoints(graph, output, wanted, SEED, 1.0, ends)
    shared: Any = len(slopes) * 2.0**-48 / UNIT_ROUNDOFF  # adjoints that underflow
    for node, error in first.cut.items():
        shared = first.fused(abs(slopes[node]), error, shared) if node in slopes else shared
    bound = first.fused(first.off / SEED, shared, own)
    return -graph.node("divisor", -first.fused(2.0 / STRETCH, most, bound), -most)


# Bounds for users


def of_magnitude(vector, bounds):
    """Bound on the error of a vector's magnitude, from the vector's values and the bounds of its components."""
    return np.hypot(*bounds) * SAFE + 4 * UNIT_ROUNDOFF * np.hypot(*vector)


def where_known(values, bounds):
    """Bounds for users: infinite without proof, NaN without a value."""
    return np.where(np.isnan(values), np.nan, np.where((bounds >= 0.0) & ~np.isinf(values), bounds, np.inf))


def with_bounds(program, state, leaves, compiled=False, tight=False):
    """Values (outputs, *shape) of a program and bounds on their errors; running ones where tight ones are infinite."""
    count = len(program.outputs)
    rows = program.bounded(tight).run(state, leaves, compiled)
    values, bounds = rows[:count], rows[count:]
    if tight and not np.isfinite(bounds).all():
        bounds = np.fmin(bounds, with_bounds(program, state, leaves, compiled)[1])
    return values, bounds

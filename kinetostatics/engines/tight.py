"""Tight bounds on rounding errors, by what the error of each operation makes of one output: a sweep in reverse.

By coefficients c of the computed values the error of a value is, exactly, the sum of c e over what it is computed from,
what the operation itself adds, and q, of second order (-e e' of a product). The error of an output is thus the sum of
a (own + q) over all values, with adjoints a by the same coefficients (Linnainmaa 1976, *BIT* 16, 146; Langlois 2001,
*BIT* 41, 606). Where values are used once their own errors add up as forward, by the rules of `running`; only absolute
values that are used more than once, where errors may cancel, are cut off and have an adjoint, and divisors and squares,
whose errors many products share. That is a bound F but for q, and for what is too small for a double.

Running bounds C with both taken ``STRETCH`` times as large are at least the sum of |a| (own + STRETCH q), each way by
itself: F leaves out no more than C / STRETCH. A relative value is one operation here, of its pivots: its q is what
(1 + e)^p is more than 1 + p e, and STRETCH times that while e < KNOWN / STRETCH is no more than the `steepest` slope
holds while e < KNOWN. Twice C / STRETCH has room for second order of what is only counted, and for the rounding of the
adjoints, some thousand `UNIT` of what F would be if nothing cancelled. As C is a bound too, the lesser one is taken.
"""

from collections.abc import Callable
from typing import Any

from .bounds import DUST
from .counted import EXACT
from .functions import moved_apart
from .graph import BY_ANGLE, INPUTS, Node, needed
from .running import KNOWN, Absolute, RunningBounds

STRETCH = 2.0**16
SEED = 2.0**900
"""Adjoint of the output, so large that no adjoint that counts is too small for a double."""


def tight_bound(graph, inputs, output, dust=DUST):
    """A bound on the error of one output, as `RunningBounds.of` gives it; NaN or infinite where that is to be asked."""
    stretched = _Stretched(graph, inputs, None if dust is None else STRETCH * dust)
    (most,) = stretched.of([output])
    if not isinstance(most, Node):
        return most
    local = _Local(graph, inputs, stretched, output, dust)
    (own,) = local.of([output])
    slopes, cancelling = _adjoints(output, local), None
    for node, (_, slope) in slopes.items():
        if node in local.cut:
            cancelling = local.fused(abs(slope), local.bound(node), cancelling)
    small = 0.0 if dust is None else 4.0 * len(slopes) * 2.0**-50 / SEED
    least = local.summed([(2.0 / STRETCH, most), (1.0, own), (1.0, small)])
    if cancelling is not None:  # by itself: the seed comes first, so that nothing gets too small
        least = local.fused(1.0 / SEED, cancelling, least)
    return -graph.node("divisor", -least, -most)


class _OfBoth(RunningBounds):
    """Running bounds with all that is of second order in sight: what is moved off zero is no dust."""

    def _counted_sum(self, node, parts):
        return super()._counted_sum(node, parts) if moved_apart(parts) is None else None


class _Stretched(_OfBoth):
    """Bounds with terms of second order so many times as large, and none where those are not small."""

    known = KNOWN / STRETCH

    def larger(self, part, times=1.0):
        return self.fused(STRETCH, self.bound(part), times * self.size(part))

    def root_of_dust(self, dust):
        """So many times what it is of dust that is not stretched, too."""
        return super().root_of_dust(STRETCH * dust)

    def of_function(self, bound):
        """Its slope changes no faster than its argument either."""
        return super().of_function(bound) + ([] if bound is None else [(0.5 * STRETCH * bound, bound)])

    def _found(self, node):
        """None is proven where an absolute value may have the other sign than its magnitude was taken with."""
        if node.operation != "abs" or node.varies < BY_ANGLE:
            return super()._found(node)
        (part,) = node.arguments
        return Absolute([self.doubt(part), (1.0, self.bound(part))], self._absolute[part].reserve)


class _Local(_OfBoth):
    """Bounds of first order on what operations after the last cuts add; what is before them counts as exact.

    Nothing is too small for a double here, no divisor or square near zero, no sign in doubt: the stretched bounds have
    all that. They know inputs that are not exact, too. No rounding is in reserve: each is charged where it is made.

    Attributes
    ----------
    cut : set of Node
    """

    no_power = 0.0

    def __init__(self, graph, inputs, stretched, output, dust):
        super().__init__(graph, inputs, dust=None)
        self._take_by_design(dust)
        self._stretched, self._output, self.cut = stretched, output, set()
        self._users: dict[Node, list[Node]] = {}
        for node in needed([output]):
            for part in node.arguments if node.varies == BY_ANGLE else ():
                if isinstance(part, Node):
                    self._users.setdefault(part, []).append(node)

    def count(self, nodes):
        """What a design fixes first: it is cut where angles come in only, as adjoints go no further."""
        fixed = [node for node in nodes if node.varies < BY_ANGLE]
        super().count(fixed)
        for node in fixed:
            found = self._relative[node]
            self._relative[node] = self._unless_cut(node, None if found and found.pivots else found)
        super().count([node for node in nodes if node.varies == BY_ANGLE])

    def _counted(self, node):
        found = EXACT if node.operation == "sign" else super()._counted(node)
        return found if node.varies < BY_ANGLE else self._unless_cut(node, found)

    def _unless_cut(self, node, found):
        """Error of a value; none if it is cut."""
        users = self._users.get(node, ())
        if found is not None or (len(users) < 2 and not any(_divides(node, user) for user in users)):
            return found
        self.cut.add(node)
        return EXACT

    def as_divisor(self, part):
        return self.relative(part) or super().as_divisor(part)

    as_square = as_divisor

    def over(self, node):
        """By a guard's reciprocal too: where that acts the stretched bounds are infinite."""
        known = next((over for (_, part), over in self._reciprocals.items() if part is node), None)
        return super().over(node) if known is None else known

    def _counted_divisor(self, node):
        return self.as_divisor(node.arguments[0])

    def is_absolute(self, node):
        return super().is_absolute(node) or node in self.cut

    def unseen(self, output):
        return []

    def told(self, node):
        return self._inputs[node](self._stretched if node.operation in INPUTS else self)

    def larger(self, part, times=1.0):
        return times * self.size(part)

    def overflow(self, node):
        return []

    def is_charged(self, node):
        return super().is_charged(node) or node is self._output

    def charge(self, node, missing):
        return missing

    def free(self, node):
        return 0.0


def _divides(node, user):
    """Whether a node is what its user divides by, or takes the root of."""
    return user.operation in ("sqrt", "root", "divisor") or (user.operation == "/" and user.arguments[1] is node)


def _adjoints(output, local):
    """By node that leads from cuts to an output: a sign and a number, `SEED` times the adjoint but for the sign."""
    wanted = set()
    nodes = needed([output])
    for node in nodes:
        after = node.varies == BY_ANGLE and any(part in wanted for part in node.arguments if isinstance(part, Node))
        if after or node in local.cut:
            wanted.add(node)
    parts: dict[Node, list[tuple[float, Any]]] = {output: [(1.0, SEED)]}
    found = {}
    for node in reversed(nodes):
        if node in parts and node in wanted:
            sign, slope = found[node] = _sum(parts[node])
            if node.varies < BY_ANGLE:
                continue
            for argument, turn, part in _RULES[node.operation](local.over, node, slope, *node.arguments):
                if argument in wanted:
                    parts.setdefault(argument, []).append((sign * turn, part()))
    return found


def _sum(parts):
    (sign, total), *others = parts
    for turn, part in others:
        total = total + part if turn == sign else total - part
    return sign, total


def _none(over, node, slope, *arguments):
    return ()


def _of_product(over, node, slope, left, right):
    return (left, 1.0, lambda: slope * right), (right, 1.0, lambda: slope * left)


def _of_quotient(over, node, slope, above, below):
    def share():
        return slope * (1.0 / below)

    return (above, 1.0, share), (below, -1.0, lambda: share() * node)


def _of_sum(over, node, slope, *parts):
    return [(part, 1.0, lambda: slope) for part in parts]


def _of_difference(over, node, slope, *parts):
    signs = (1.0, -1.0) if len(parts) == 2 else (-1.0,)
    return [(part, sign, lambda: slope) for part, sign in zip(parts, signs, strict=True)]


def _same(over, node, slope, argument, unit=None):
    return ((argument, 1.0, lambda: slope),)


def _of_root(over, node, slope, square, unit=None):
    return ((square, 1.0, lambda: slope * (0.5 * over(node))),)


_RULES: dict[str, Callable[..., Any]] = {
    **dict.fromkeys((*INPUTS, "sign", "rest"), _none),
    **dict.fromkeys(("+", "total"), _of_sum),
    "-": _of_difference,
    "*": _of_product,
    "/": _of_quotient,
    "sqrt": _of_root,
    "root": _of_root,
    "held": _same,
    "divisor": _same,
    "sin": lambda over, node, slope, angle: ((angle, 1.0, lambda: slope * angle.cos()),),
    "cos": lambda over, node, slope, angle: ((angle, -1.0, lambda: slope * angle.sin()),),
    "atan": lambda over, node, slope, part: ((part, 1.0, lambda: slope * (1.0 / (1.0 + part * part))),),
    "abs": lambda over, node, slope, value: ((value, 1.0, lambda: slope * value.sign()),),
}

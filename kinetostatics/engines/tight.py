"""Tight bounds on rounding errors, by what the error of each operation makes of one output: a sweep in reverse.

By coefficients c of the computed values the error of a node is, exactly, the sum of c e over its arguments, what the
operation itself adds, and q, of second order (-e e' of a product). The error of an output is thus the sum of
a (own + q) over all nodes, with adjoints a by the same coefficients (Linnainmaa 1976, *BIT* 16, 146; Langlois 2001,
*BIT* 41, 606). Where values are used once their own errors add up as forward; only what is used more than once and made
of sums, where errors may cancel, is cut off and has an adjoint. That is a bound F but for q, and for what is too small
for a double. A forward bound C with both taken ``STRETCH`` times as large exceeds F by ``STRETCH`` times their sum over
all nodes, by |a|, and by what cancels. So the mean (1 - 1 / STRETCH) F + C / STRETCH is a bound. It holds the rounding
of the adjoints too, some thousand `UNIT` of what F would be if nothing cancelled: `bounds.SAFE` does where little
cancels, and C where much does. Where nothing cancels it is the forward bound itself.
"""

from collections.abc import Callable
from typing import Any

from .bounds import DUST
from .counted import EXACT
from .running import RESERVE, RunningBounds
from .trace import BY_ANGLE, INPUTS, Node, needed

STRETCH = 2.0**16
WEIGHT = 2.0 / STRETCH
SEED = 2.0**900
"""Adjoint of the output, so large that no adjoint that counts is too small for a double."""


def tight_bound(graph, inputs, output, dust=DUST):
    """A bound on the error of one output, as `RunningBounds.of` gives it; NaN or infinite where that is to be asked."""
    if not isinstance(output, Node):
        return 0.0
    stretched = RunningBounds(graph, inputs, None if dust is None else STRETCH * dust, STRETCH)
    (most,) = stretched.of([output])
    local = _Local(graph, inputs, stretched, output)
    (own,) = local.of([output])
    slopes, cancelling = _adjoints(graph, output, local.cut), None
    for node, (_, slope) in slopes.items():
        if node in local.cut:
            cancelling = local.fused(abs(slope), local.bound(node), cancelling)
    mean = local.fused(WEIGHT, most, None if dust is None else 4.0 * len(slopes) * 2.0**-50 / SEED)
    for weight, part in ((1.0 - WEIGHT, own), ((1.0 - WEIGHT) / SEED, cancelling)):
        mean = mean if part is None else local.fused(weight, part, mean)
    return mean


class _Local(RunningBounds):
    """Errors of first order that come from operations after the last cuts; what is before them counts as exact.

    Nothing is too small for a double here, and no divisor or root near zero: the stretched bounds have that.

    Attributes
    ----------
    cut : set of Node
        Values where errors may cancel.
    """

    def __init__(self, graph, inputs, stretched, output):
        super().__init__(graph, inputs, dust=None)
        self._stretched, self._output, self.cut = stretched, output, set()
        self._users: dict[Node, list[Node]] = {}
        for node in needed([output]):
            for part in node.arguments if node.varies == BY_ANGLE else ():
                if isinstance(part, Node):
                    self._users.setdefault(part, []).append(node)

    def count(self, nodes):
        """What a design fixes first: for itself nothing is cut, as adjoints go no further than to it."""
        fixed = [node for node in nodes if node.varies < BY_ANGLE]
        super().count(fixed)
        for node in fixed:
            found = self._relative[node]
            self._relative[node] = self._cut(node, None if found and found.pivots else found)
        super().count([node for node in nodes if node.varies == BY_ANGLE])

    def _counted(self, node):
        found = EXACT if node.operation == "sign" else super()._counted(node)
        return found if node.varies < BY_ANGLE else self._cut(node, found)

    def _cut(self, node, found):
        """Error of a value, or none if it is absolute and used more than once, or as a divisor or square."""
        users = self._users.get(node, ())
        is_cut = len(users) > 1 or any(
            user.operation in ("sqrt", "root", "divisor") or (user.operation == "/" and user.arguments[1] is node)
            for user in users
        )
        if found is not None or not is_cut:
            return found
        self.cut.add(node)
        return EXACT

    def as_divisor(self, part):
        return self.relative(part) or super().as_divisor(part)

    as_square = as_divisor

    def _counted_divisor(self, node):
        return self.as_divisor(node.arguments[0])

    def is_absolute(self, node):
        return super().is_absolute(node) or node in self.cut

    def told(self, node):
        return self._inputs[node](self._stretched if node.operation in INPUTS else self)

    def larger(self, part):
        return self.size(part)

    def is_charged(self, node):
        return super().is_charged(node) or node is self._output

    def charge(self, node, missing):
        return missing + self.free(node)

    def free(self, node):
        """As many as are taken from it by the one value that it is used for, and what that is used for."""
        users = self._users.get(node, ())
        if len(users) != 1 or not self.is_absolute(users[0]) or users[0] in self._inputs:
            return 0.0
        (user,) = users
        more = 0.0 if user in self.cut else self.free(user)
        if user.operation in ("*", "/"):
            (other,) = (part for part in user.arguments if part is not node)
            found = self.relative(other)
            more = 0.5 * (more + 1.0) if found is None else more + found.roundings + 1.0
        elif user.operation in "+-" and len(user.arguments) == 2 and not self.is_charged(user):
            more += 1.0
        return min(more, RESERVE)


def _adjoints(graph, output, cut):
    """By node that leads from cuts to an output: a sign and a number, `SEED` times the adjoint but for the sign."""
    wanted = set()
    nodes = needed([output])
    for node in nodes:
        after = node.varies == BY_ANGLE and any(part in wanted for part in node.arguments if isinstance(part, Node))
        if after or node in cut:
            wanted.add(node)
    parts: dict[Node, list[tuple[float, Any]]] = {output: [(1.0, SEED)]}
    found = {}
    for node in reversed(nodes):
        if node in parts and node in wanted:
            sign, slope = found[node] = _sum(parts[node])
            if node.varies < BY_ANGLE:
                continue
            for argument, turn, part in _RULES[node.operation](graph, node, slope, *node.arguments):
                if argument in wanted:
                    parts.setdefault(argument, []).append((sign * turn, part()))
    return found


def _sum(parts):
    (sign, total), *others = parts
    for turn, part in others:
        total = total + part if turn == sign else total - part
    return sign, total


def _none(graph, node, slope, *arguments):
    return ()


def _of_product(graph, node, slope, left, right):
    return (left, 1.0, lambda: slope * right), (right, 1.0, lambda: slope * left)


def _of_quotient(graph, node, slope, above, below):
    def share():
        return slope * (1.0 / below)

    return (above, 1.0, share), (below, -1.0, lambda: share() * node)


def _of_sum(graph, node, slope, *parts):
    return [(part, 1.0, lambda: slope) for part in parts]


def _of_difference(graph, node, slope, *parts):
    signs = (1.0, -1.0) if len(parts) == 2 else (-1.0,)
    return [(part, sign, lambda: slope) for part, sign in zip(parts, signs, strict=True)]


def _same(graph, node, slope, argument, unit=None):
    return ((argument, 1.0, lambda: slope),)


def _of_root(graph, node, slope, square, unit=None):
    return ((square, 1.0, lambda: slope * (0.5 / node)),)


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
    "sin": lambda graph, node, slope, angle: ((angle, 1.0, lambda: slope * graph.node("cos", angle)),),
    "cos": lambda graph, node, slope, angle: ((angle, -1.0, lambda: slope * graph.node("sin", angle)),),
    "atan": lambda graph, node, slope, part: ((part, 1.0, lambda: slope * (1.0 / (1.0 + part * part))),),
    "abs": lambda graph, node, slope, value: ((value, 1.0, lambda: slope * graph.node("sign", value)),),
}

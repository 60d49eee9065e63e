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

from collections import Counter
from collections.abc import Callable
from typing import Any

from ..numbers.elementary import UNIT
from .bounds import DUST, EXACT, SAFE, Bounds, size
from .trace import BY_ANGLE, INPUTS, Node, needed

STRETCH = 2.0**16
SEED = 2.0**900
"""Adjoint of the output, so large that no adjoint that counts is too small for a double."""


def tight_bound(graph, inputs, output, dust=DUST):
    """A bound on the error of one output, as `Bounds.of` gives it; NaN or infinite where that is to be asked."""
    if not isinstance(output, Node):
        return 0.0
    coarse = Bounds(graph, inputs, STRETCH, None if dust is None else STRETCH * dust)
    coarse.of([output])
    local = _Local(graph, inputs, coarse, output)
    most, slopes, cancelling = coarse.total(output), _adjoints(graph, output, local.cut), None
    if most is None:
        return 0.0
    for node, (_, slope) in slopes.items():
        if node in local.cut:
            cancelling = local.fused(abs(slope), local.cut[node], cancelling)
    unit, share = SAFE * UNIT, 1.0 - 1.0 / STRETCH
    mean = local.fused(unit / STRETCH, most, None if dust is None else unit * 4.0 * len(slopes) * 2.0**-50 / SEED)
    for weight, part in ((unit * share, local.total(output)), (unit * share / SEED, cancelling)):
        mean = mean if part is None else local.fused(weight, part, mean)
    return mean


class _Local(Bounds):
    """Errors of first order that come from operations after the last cuts; what is before them counts as exact.

    Nothing is too small for a double here: the coarse bound has that.

    Attributes
    ----------
    cut : dict of Node to node
        Bounds on the errors, so counted, of values where they may cancel.
    """

    def __init__(self, graph, inputs, coarse, output):
        told = {node: error for node, error in (inputs or {}).items() if node.operation not in INPUTS}
        super().__init__(graph, told, dust=None)
        self.coarse, self.cut = coarse, {}
        behind: set[Node] = set()
        nodes = needed([output])
        self.tell_uses(nodes)
        uses = Counter(
            part for node in nodes if node.varies == BY_ANGLE for part in node.arguments if isinstance(part, Node)
        )
        for node in nodes:
            by_angle = node.varies == BY_ANGLE  # adjoints go no further than to what a design fixes
            after = by_angle and not behind.isdisjoint(part for part in node.arguments if isinstance(part, Node))
            is_own = after or (coarse.is_dust(node) and node.operation not in INPUTS)
            self._errors[node] = error = self._found(node) if is_own else coarse.error(node)
            if after:
                behind.add(node)
            elif not is_own:
                self._totals[node] = coarse.total(node)
            if uses[node] > 1 and node is not output and isinstance(error.rest, Node):
                self.cut[node] = self.total(node)
                self._errors[node], self._totals[node] = EXACT, None
                behind.add(node)

    def _found(self, node):
        found = super()._found(node)
        if node.operation in ("sqrt", "root") and self.is_dust(node.arguments[0]):  # of dust, which is not counted else
            return found._replace(rest=self.coarse.error(node).rest)
        return found

    def own(self, node):
        return EXACT if node.operation in ("divisor", "sign") else super().own(node)

    def largest(self, part):
        return size(part)

    def over(self, part):
        return self.coarse.over(part)

    def is_dust(self, part):
        return self.coarse.is_dust(part)

    def steepest(self, root, square):
        return self.coarse.steepest(root, square)


def _adjoints(graph, output, cut):
    """By node that leads from cuts to an output: a sign and a number, `SEED` times the adjoint but for the sign."""
    wanted = set()
    nodes = needed([output])
    for node in nodes:
        if node in cut or any(part in wanted for part in node.arguments if isinstance(part, Node)):
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
    **dict.fromkeys((*INPUTS, "sign"), _none),
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

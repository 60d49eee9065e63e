"""What is behind outputs in products with 0 alone: such a product is exactly 0, or none where its other factor is none.

An even crank rate is thus one where its mechanism may be assembled only; by itself no rule of errors tells that it may
not. Left out are margins of friction against jamming, roots over the plain number 1, whose bounds take 7 % of a
program: within a rounding of jamming, bounds of what rubs are those of the solution that was found.
"""

from functools import reduce
from operator import or_

from .bounds import is_zero
from .graph import Node


class Behind:
    """Pivots behind nodes, as bits of a number by their places in the graph, and which of them their bounds have."""

    def __init__(self, graph):
        self._graph = graph
        self._all: dict[Node, int] = {}
        self._seen: dict[Node, int] = {}

    def tell(self, node, pivots):
        """Take note of a node, after its arguments, that is none where one of some pivots may vanish."""
        bits = sum(1 << pivot.index for pivot in pivots)
        self._all[node], seen = (
            reduce(or_, (known.get(part, 0) for part in node.arguments if isinstance(part, Node)), bits)
            for known in (self._all, self._seen)
        )
        self._seen[node] = 0 if is_zero(node) else seen
        if node.operation == "root" and not isinstance(node.arguments[1], Node):  # a margin of friction
            self._all[node] = 0

    def unseen(self, output):
        """Pivots behind an output that its bound does not have, but for those that bounds of others of them have."""
        missing, found = self._all[output] & ~self._seen[output], []
        while missing:
            found.append(self._graph[missing.bit_length() - 1])
            missing &= ~(self._seen.get(found[-1], 0) | 1 << found[-1].index)
        return found

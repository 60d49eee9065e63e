"""Recorded outputs made NaN also where groups cannot be assembled on which they hang without being computed from them.

Such are the weight of the crank, moments that are zero, and energies beside a group without mass.
"""

import numpy as np

from ..mechanics.gaps import groups_behind, places
from .graph import Node

ROOTS = ("root", "sqrt")
"""Operations that have no value where a group cannot be assembled."""


class Gaps:
    """What outputs of a recorded scene lack to have the gaps of the groups behind them.

    Roots are told as bits of a number, one for each in the graph as it is now.
    """

    def __init__(self, graph, scene):
        self._placement, self._behind = scene.placement, groups_behind(scene.mechanism)
        self._roots: list[Node] = []
        self._bits: list[int] = []
        for node in graph:
            bits = self._of(node.arguments)
            if node.operation in ROOTS:
                bits |= 1 << len(self._roots)
                self._roots.append(node)
            self._bits.append(bits)

    def added(self, output, name):
        """An output of a quantity, with the roots that it lacks: the last ones, which have no value without others."""
        parts = (np.ravel(part)[0] for part in places(self._placement, self._behind[name]))
        missing = self._of(parts) & ~self._of([output])
        for place, root in reversed([*enumerate(self._roots)]):
            if missing >> place & 1:
                missing &= ~self._of([root])
                nothing = 0.0 * root.held()
                output = output + nothing if isinstance(output, Node) or output else nothing
        return output

    def _of(self, parts):
        bits = 0
        for part in parts:
            if isinstance(part, Node):
                bits |= self._bits[part.index]
        return bits

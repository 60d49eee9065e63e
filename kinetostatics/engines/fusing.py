"""Sums that a compiled loop takes together with one of their products: one operation, rounded once.

Two products that are meant to be equal have a difference of zero only if both are rounded: a b - c d with a b held
exactly is what rounding took off a b. So a product stays apart where the other part, or a sum that it is, holds one
that is computed from the crank angle in the same way, as that of a twin group: numbers may make them equal. What a
design's numbers multiply, or add, is no difference. Only what a sum is computed from decides, so that it is the same to
the last bit whatever else is computed.
"""

from typing import Any, NamedTuple

from .graph import BY_ANGLE, Node

NONE: frozenset[int] = frozenset()


class FusedSum(NamedTuple):
    """A sum as one product and the rest, each with a sign, 1 or -1."""

    sign: int
    one: Any
    other: Any
    rest_sign: int
    rest: Any


def fused_sums(nodes) -> dict[Node, FusedSum]:
    """Sums that are fused among nodes in the order of computing; of two products the one that is known later."""
    found: dict[Node, FusedSum] = {}
    ways: dict[Node, int] = {}
    held: dict[Node, frozenset[int]] = {}
    depths: dict[Node, int] = {}
    numbers: dict[tuple, int] = {}
    for node in nodes:
        if node.varies < BY_ANGLE:
            continue
        kind, moving = node.operation, [part for part in node.arguments if _varies(part)]
        is_sum, minus = kind in ("+", "-", "held"), -1 if kind == "-" else 1
        depths[node] = 1 + max((depths[part] for part in moving), default=0)
        if len(moving) == 1 and (is_sum or kind == "*"):
            ways[node] = ways[moving[0]]
        else:
            key = "+" if is_sum else kind, *sorted(ways[part] for part in moving)
            ways[node] = numbers.setdefault(key, len(numbers))
        held[node] = NONE.union(*(held[part] for part in moving)) if is_sum else NONE
        if kind == "*":
            held[node] = frozenset((ways[node],))
        if is_sum and len(node.arguments) == 2:
            left, right = node.arguments
            choices = [
                (depths[part], FusedSum(own * sign, product.arguments[0], product.arguments[1], others, rest))
                for part, own, others, rest in ((left, 1, minus, right), (right, minus, 1, left))
                for sign, product in (_product(part),)
                if product is not None and ways[product] not in held.get(rest, NONE)
            ]
            if choices:
                found[node] = max(choices, key=lambda choice: choice[0])[1]
    return found


def operands_of(node, sums):
    """Nodes that a node is computed from, as it is or as a product and the rest."""
    found = (sums[node].one, sums[node].other, sums[node].rest) if node in sums else node.arguments
    return [part for part in found if isinstance(part, Node)]


def drop_unused(nodes, outputs, sums):
    """Nodes without products that are in their sums only."""
    wanted = {part for part in outputs if isinstance(part, Node)}
    for node in reversed(nodes):
        if node in wanted:
            wanted.update(operands_of(node, sums))
    return [node for node in nodes if node in wanted]


def _product(part):
    """Sign and product that a part is; None if it is none."""
    sign = 1
    if _varies(part) and part.operation == "-" and len(part.arguments) == 1:
        sign, part = -1, part.arguments[0]
    return sign, part if _varies(part) and part.operation == "*" else None


def _varies(part):
    return isinstance(part, Node) and part.varies == BY_ANGLE

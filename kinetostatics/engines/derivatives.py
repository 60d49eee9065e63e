"""Exact derivatives of recorded outputs, as further nodes of the same graph, compiled with it.

Forward mode gives the derivative of every node by one parameter, reverse mode that of one output by every node
(Griewank and Walther, *Evaluating Derivatives*, 2008, chapters 3.1 and 3.2). `gradients` uses the mode with fewer
sweeps: one per parameter forward, one per output in reverse.
"""

import operator
from collections.abc import Callable
from functools import reduce
from typing import Any

import numpy as np

from .codegen import BY_DESIGN
from .graph import INPUTS, Node, needed


def gradients(graph, outputs, parameters):
    """Derivatives of outputs by parameters: a tuple of nodes or numbers for each output."""
    if len(outputs) >= len(parameters):
        columns = [tangents(graph, outputs, {parameter: 1.0}) for parameter in parameters]
        return list(zip(*columns, strict=True))
    rows = []
    for output in outputs:
        wanted = set(parameters)
        for node in needed([output]):
            if any(part in wanted for part in node.arguments if isinstance(part, Node)):
                wanted.add(node)
        found = adjoints(graph, output, wanted)
        rows.append(tuple(found.get(parameter, 0.0) for parameter in parameters))
    return rows


def tangents(graph, outputs, slopes):
    """Derivatives of outputs along one direction, a tuple of nodes or numbers.

    `slopes` maps inputs to their own derivatives along it, nodes or numbers; missing inputs have derivative 0.
    """
    slopes = dict(slopes)
    for node in needed(outputs):
        parts = [
            _product(partial, slopes[argument])
            for argument, partial in _partials(graph, node, slopes)
            if argument in slopes
        ]
        if parts:
            slopes[node] = reduce(operator.add, parts)
    return tuple(slopes.get(output, 0.0) for output in outputs)


def adjoints(graph, output, wanted, seed=1.0, stop_gradient_slope=0.0, ends=frozenset()):
    """Derivatives of one output by the wanted nodes that it depends on: a dict of nodes or numbers.

    They are multiplied by `seed`. `stop_gradient_slope` is the derivative of `arithmetic.stop_gradient`: 0 for
    sensitivities, 1 for rounding errors. Nodes among `ends` count as independent.
    """
    parts: dict[Node, list] = {output: [seed]}
    found = {}
    for node in reversed(needed([output])):
        if node in parts and node in wanted:
            whole = found[node] = reduce(operator.add, parts[node])
            if node in ends:
                continue
            if node.operation == "held" and stop_gradient_slope:
                parts.setdefault(node.arguments[0], []).append(stop_gradient_slope * whole)
            for argument, partial in _partials(graph, node, wanted):
                parts.setdefault(argument, []).append(_product(partial, whole))
    return found


def _product(one, other):
    """Product that records a negation for a factor -1.0."""
    if isinstance(one, float) and one == -1.0:
        return -other
    return one * other


def _partials(graph, node, wanted):
    """Pairs of a wanted argument and the derivative of the node by it, a list."""
    if node.operation not in _PARTIAL_DERIVATIVES:
        return []
    partials = _PARTIAL_DERIVATIVES[node.operation](graph, node, *node.arguments)
    return [pair for pair in zip(node.arguments, partials, strict=True) if pair[0] in wanted]


_PARTIAL_DERIVATIVES: dict[str, Callable[..., tuple]] = {
    "+": lambda graph, node, left, right: (1.0, 1.0),
    "-": lambda graph, node, *parts: (1.0, -1.0) if len(parts) == 2 else (-1.0,),
    "total": lambda graph, node, *parts: (1.0,) * len(parts),
    "*": lambda graph, node, left, right: (right, left),
    "/": lambda graph, node, above, below: (over := 1.0 / below, -(node * over)),
    "sin": lambda graph, node, angle: (graph.node("cos", angle),),
    "cos": lambda graph, node, angle: (-graph.node("sin", angle),),
    "sqrt": lambda graph, node, square: (0.5 / node,),
    "atan": lambda graph, node, slope: (1.0 / (1.0 + slope * slope),),
    "exp": lambda graph, node, exponent: (node,),
    "log": lambda graph, node, value: (1.0 / value,),
    "abs": lambda graph, node, value: (graph.node("sign", value),),
    "root": lambda graph, node, square, unit: (0.5 / node, 0.0),
    "divisor": lambda graph, node, root, unit: (1.0, 0.0),
}
"""By operation: its derivatives by its arguments. Derivatives by the guards of "root" and "divisor" are 0, because a
guard acts only where no digit is correct."""


_FUNCTIONS: dict[str, Any] = BY_DESIGN | {
    "+": operator.add,
    "-": lambda *parts: parts[0] - parts[1] if len(parts) == 2 else -parts[0],
    "*": operator.mul,
    "/": np.divide,
    "sign": lambda value: np.copysign(1.0, value),
    "held": lambda value: value,
}


class Evaluation:
    """Outputs of a graph on arrays that broadcast, by NumPy operation by operation.

    It is for a few calls, where writing and compiling source costs more than it saves. Each array is released after its
    last use, so the next one reuses memory that is still in the cache.
    """

    def __init__(self, outputs):
        self._outputs = outputs
        nodes, kept = needed(outputs), set(outputs)
        last = {part: node for node in nodes for part in node.arguments if isinstance(part, Node) and part not in kept}
        spent: dict[Node, list[Node]] = {node: [] for node in nodes}
        for part, node in last.items():
            spent[node].append(part)
        computed = [node for node in nodes if node.operation not in INPUTS]
        self._steps = [(node, _FUNCTIONS[node.operation], node.arguments, spent[node]) for node in computed]

    def __call__(self, inputs):
        """Values of the outputs, a list of numbers and arrays, from the values of all inputs, a mapping by node."""
        values = dict(inputs)
        for node, function, arguments, spent in self._steps:
            values[node] = function(*[values[part] if part.__class__ is Node else part for part in arguments])
            for part in spent:
                del values[part]
        return [values[part] if part.__class__ is Node else part for part in self._outputs]

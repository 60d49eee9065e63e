"""Values at crank angles that all designs of a sweep share, computed once.

If only masses, springs or loads vary, all designs have the same motion. The program is split in two: one loop computes
the shared values, the other reads them as rows of a table. FMAs stay as in the whole program, so no result changes.
"""

from typing import Any

import numpy as np

from .codegen import loop_source
from .graph import BY_ANGLE, INPUTS, Graph, Node, is_of_angle, needed, operations, varies
from .numba_backend import load_compiled
from .program import Program
from .simplify import drop_unused, fused_sums, operands_of

MIN_SHARED_VALUES = 10_000_000
"""Least number of values, designs times angles, for which two loops replace one."""
MIN_SHARE = 0.25
"""Least share of the operations that all designs share, for which two loops replace one."""


def shared_loop(program, numbers, angle, tables, count):
    """Compiled loop for `count` designs, and its tables: the given ones, with rows of shared values if it is split.

    `numbers` are the parameters of the recording, floats or, where they vary, arrays (designs, 1). `angle` is (1 or
    designs, N), rad, `tables` are (T, 1 or designs, N).
    """
    if count * angle.shape[1] < MIN_SHARED_VALUES or len(angle) > 1 or tables.shape[1] > 1:
        return program.loop, tables
    varied = {place for place, number in enumerate(numbers) if np.ndim(number)}
    common, rest = split_common(program.outputs, varied, len(tables))
    if operations(common) < MIN_SHARE * operations(program.outputs):
        return program.loop, tables
    fixed = [0.0 if np.ndim(number) else number for number in numbers]
    rows = Program(program.recording, common).by_loop(angle[0], fixed, list(tables[:, 0]), angle.shape[1:])
    loop = load_compiled(loop_source(rest, fuse=False)).loop
    return loop, np.concatenate([tables.reshape(-1, *angle.shape), rows[:, None]])


def split_common(outputs, varied, first=0):
    """Nodes of the shared values, and outputs in a new graph that reads these values as table rows from `first` on.

    `varied` is the set of indices of the parameters that vary.
    """
    nodes = needed(outputs)
    sums = fused_sums(nodes)
    nodes = drop_unused(nodes, outputs, sums)
    own: set[Node] = set()
    for node in nodes:
        is_varied = node.operation == "parameter" and node.arguments[0] in varied
        if is_varied or not own.isdisjoint(operands_of(node, sums)):
            own.add(node)
    asked = {part for node in nodes if node in own for part in operands_of(node, sums)}.union(outputs)
    given = {node for node in nodes if node.operation in INPUTS or is_of_angle(node)}
    common = [node for node in nodes if node in asked and varies(node) and node not in own and node not in given]
    rows = {node: first + place for place, node in enumerate(common)}
    graph = Graph()
    copies: dict[Node, Any] = {}

    def copied(part):
        return copies[part] if isinstance(part, Node) else part

    for node in nodes:
        if node in rows:
            copies[node] = graph.row(rows[node])
        elif node.operation in INPUTS:
            copies[node] = Node(graph, node.operation, node.arguments, node.varies)
        elif node in sums and node in own:
            found = sums[node]
            one, rest = copied(found.one), copied(found.rest)
            one, rest = one if found.sign > 0 else -one, rest if found.rest_sign > 0 else -rest
            copies[node] = graph.node("fma", one, copied(found.other), rest)
        elif node in own or node.varies < BY_ANGLE or is_of_angle(node):
            copies[node] = graph.node(node.operation, *map(copied, node.arguments))
    return tuple(common), tuple(map(copied, outputs))

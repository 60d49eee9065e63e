"""Record what the kernels compute: the same functions, run once on numbers that write down every operation.

The result is a straight line of arithmetic without branches, absent parts or quantities nobody asked for: what it costs
is its number of operations, and compiled it is as fast as a loop written by hand (see `compiled`).
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from ..machine.cam_roller import CamRoller
from ..machine.cams import Cam
from ..machine.crank import ray
from ..machine.loads import Gravity, ProcessForce
from ..mechanics.quantities import components
from ..mechanics.quantities import sizes as sizes_of
from ..numbers.elementary import APART
from ..numbers.substitution import with_fields, with_numbers
from ..solution.solution import Solution, pushed

BY_DESIGN, BY_ANGLE = range(2)
"""What the value of a node varies with: the design, or the crank angle as well."""
INPUTS = ("angle", "parameter", "table")


class Node:
    """A number that is not known yet, and the operation it comes from."""

    __slots__ = ("arguments", "graph", "index", "operation", "varies")

    def __init__(self, graph, operation, arguments, varies):
        self.graph, self.operation, self.arguments, self.varies = graph, operation, arguments, varies
        self.index = len(graph)
        graph.append(self)

    def __add__(self, other):
        return _combined(self, "+", self, other)

    def __radd__(self, other):
        return _combined(self, "+", other, self)

    def __sub__(self, other):
        return _combined(self, "-", self, other)

    def __rsub__(self, other):
        return _combined(self, "-", other, self)

    def __mul__(self, other):
        return _combined(self, "*", self, other)

    def __rmul__(self, other):
        return _combined(self, "*", other, self)

    def __truediv__(self, other):
        return _combined(self, "/", self, other)

    def __rtruediv__(self, other):
        return _combined(self, "/", other, self)

    def __pow__(self, exponent):
        if exponent != 2:
            raise TypeError(f"only squares are recorded, not powers of {exponent}")
        return self * self

    def __neg__(self):
        return self.graph.node("-", self)

    def __abs__(self):
        return self.graph.node("abs", self)

    def sin(self):
        """Called by `numpy.sin` for an array of objects, as `cos` and `sqrt` are."""
        return self.graph.node("sin", self)

    def cos(self):
        return self.graph.node("cos", self)

    def sqrt(self):
        return self.graph.node("sqrt", self)

    def forgiving_root(self, unit):
        """Called by `elementary.root`, as the next two by `divisor` and `apart`."""
        return self.graph.node("root", self, unit)

    def kept_off_zero(self, unit):
        return self.graph.node("divisor", self, unit)

    def moved_apart(self, unit):
        return self + APART * unit

    def arctan(self):
        return self.graph.node("atan", self)

    def _unknown(self, other=None):
        raise TypeError("the value of a recorded number is not known yet: kernels must not branch on values")

    __bool__ = __float__ = __int__ = __eq__ = __ne__ = __lt__ = __le__ = __gt__ = __ge__ = _unknown
    __hash__ = object.__hash__


def _combined(node, operation, left, right):
    if isinstance(left, np.ndarray) or isinstance(right, np.ndarray):
        return NotImplemented
    return node.graph.node(operation, left, right)


class Graph(list):
    """Nodes in the order in which they can be computed; what was computed before is not computed again."""

    def __init__(self):
        super().__init__()
        self._known = {}

    def node(self, operation, *arguments):
        arguments = tuple(part if isinstance(part, Node) else float(part) for part in arguments)
        factors = [part for part in arguments if isinstance(part, Node) or part != 1.0]
        if operation == "*" and len(factors) == 1:
            return factors[0]
        key = (operation, *((part.index,) if isinstance(part, Node) else part for part in arguments))
        if key not in self._known:
            varies = max(part.varies for part in arguments if isinstance(part, Node))
            self._known[key] = Node(self, operation, arguments, varies)
        return self._known[key]


@dataclass(frozen=True, eq=False)
class Trace:
    """The arithmetic behind some quantities of a mechanism under load.

    Attributes
    ----------
    outputs : tuple of Node or float
        What is computed, components one after the other.
    widths : tuple of int
        How many components each quantity has: 1, or 2 for a vector.
    parameters : tuple
        Values of the numbers that belong to the design, in their order: numbers or arrays (designs, 1).
    tables : tuple of functions of a Solution
        What NumPy must compute beforehand at the crank angles, each giving rows: a sampled cam, a process force.
    """

    outputs: tuple[Any, ...]
    widths: tuple[int, ...]
    parameters: tuple[Any, ...]
    tables: tuple[Callable[[Solution], Any], ...]

    @cached_property
    def nodes(self):
        """What the outputs need, in order."""
        needed: set[Node] = set()
        waiting = [part for part in self.outputs if isinstance(part, Node)]
        while waiting:
            node = waiting.pop()
            if node not in needed:
                needed.add(node)
                waiting += [part for part in node.arguments if isinstance(part, Node)]
        return sorted(needed, key=lambda node: node.index)

    @cached_property
    def rows(self):
        """Number of rows of the tables that the outputs need."""
        return max((node.arguments[0] + 1 for node in self.nodes if node.operation == "table"), default=0)

    @property
    def operations(self):
        """Number of operations at each crank angle."""
        return sum(node.varies == BY_ANGLE and node.operation not in INPUTS for node in self.nodes)


def trace(solution, quantities, sizes=False) -> Trace:
    """Arithmetic of some quantities of a solution.

    Parameters
    ----------
    solution : Solution
        What its numbers are does not matter, except that a plain zero is taken to be absent.
    quantities : sequence of str
        Names as for `quantities.components`.
    sizes : bool
        Whether the magnitude of a vector is wanted, not its components.
    """
    recorder = _Recorder(solution)
    recorded = recorder.recorded
    found = [(sizes_of if sizes else components)(recorded, name) for name in quantities]
    outputs = tuple(part.flat[0] for parts in found for part in parts)
    return Trace(outputs, tuple(map(len, found)), tuple(recorder.parameters), tuple(recorder.tables))


class _Recorder:
    """Puts nodes in place of the numbers of a solution."""

    def __init__(self, solution):
        self.graph = Graph()
        self.parameters: list[Any] = []
        self.tables: list[Callable[[Solution], Any]] = []
        self._rows = 0
        self.angle = np.array([Node(self.graph, "angle", (), BY_ANGLE)], dtype=object)
        drive = {name: self._driven(solution, name) for name in ("crank_speed", "crank_acceleration")}
        idle = replace(solution, mechanism=self._copied(solution.mechanism), crank_angle=self.angle, **drive, loads=())
        loads = (self._load(item, number, idle) for number, item in enumerate(solution.loads))
        self.recorded = replace(idle, loads=tuple(loads))

    def _copied(self, item):
        return with_numbers(item, self._parameter, {CamRoller: self._roller})

    def _roller(self, roller):
        return with_fields(roller, cam=self._cam(roller.cam), block=self._copied(roller.block))

    def _parameter(self, value):
        if np.ndim(value) == 1:  # a table, of a cam or a load
            return value
        self.parameters.append(value)
        return Node(self.graph, "parameter", (len(self.parameters) - 1,), BY_DESIGN)

    def _driven(self, solution, name):
        value = getattr(solution, name)
        if np.shape(value)[-1:] in ((), (1,)):
            return self._copied(value)
        return self._tabled(1, lambda solution: [getattr(solution, name)])[0]

    def _tabled(self, rows, compute):
        self.tables.append(compute)
        nodes = [Node(self.graph, "table", (self._rows + row,), BY_ANGLE) for row in range(rows)]
        self._rows += rows
        return [np.array([node], dtype=object) for node in nodes]

    def _cam(self, cam):
        """The cam with nodes for its numbers, or its values from a table if it takes plain numbers only."""
        known = len(self.parameters)
        try:
            copied = self._copied(cam)
            self._require_elementwise(lambda angle: copied.polar(angle, ray(angle)))
        except Exception:  # whatever fails on recorded numbers
            del self.parameters[known:]
            values = self._tabled(
                3, lambda solution: solution.mechanism.group(CamRoller).cam.radius(solution.crank_angle)
            )
            return _Tabled(tuple(values))
        return copied

    def _load(self, item, number, motion):
        known = len(self.parameters)
        table = isinstance(item, ProcessForce) and np.shape(item.force)[-1:] not in ((), (1,))
        try:
            if table:
                raise TypeError
            copied = self._copied(item)
            if not isinstance(item, Gravity):
                self._require_elementwise(lambda angle: [copied.push(replace(motion, crank_angle=angle))])
        except Exception:  # whatever fails on recorded numbers
            del self.parameters[known:]
            (values,) = self._tabled(1, lambda solution: [pushed(solution.loads[number], solution)])
            return ProcessForce(values, item.on)
        return copied

    def _require_elementwise(self, compute):
        """Raise an error unless each result at a crank angle is the same whatever other angles are computed with it."""
        other = np.array([Node(self.graph, "angle", (), BY_ANGLE)], dtype=object)
        alone = [np.broadcast_to(part, 1)[0] for part in compute(self.angle)]
        for place, pair in enumerate([(self.angle, other), (other, self.angle)]):
            beside = [np.broadcast_to(part, 2)[place] for part in compute(np.concatenate(pair))]
            if any(one is not two and one != two for one, two in zip(alone, beside, strict=True)):
                raise ValueError("it depends on other crank angles")


@dataclass(frozen=True, eq=False)
class _Tabled(Cam):
    """A cam whose radius and derivatives are handed in."""

    values: tuple

    def polar(self, angle, ray):
        return self.values

"""Recording: the kernels run once on numbers that record every operation.

Groups, loads, names, absent parts and the assembly mode of a scene form its structure; the recorded arithmetic is valid
for all scenes of that structure, with any numbers. An output becomes NaN where a group it depends on is open, even if
no recorded operation links the two. The weight of the crank, zero moments, and energies of massless groups are
examples.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..machine import loads
from ..machine.crank import ray
from ..machine.loads import Load, ProcessForce, table_pieces
from ..mechanics.dynamics import Dynamics
from ..mechanics.load_values import title_of, user_value, without_forces
from ..mechanics.motion import coordinates, required_groups
from ..mechanics.quantities import FRICTION_CHECKS, components, of_scene, resolved_names
from ..mechanics.quantities import component_sizes as sizes_of
from ..numbers.arithmetic import UNIT_ROUNDOFF
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import replace_unchecked, unflatten
from ..numbers.planar import plus
from .error_bounds import Error
from .graph import Graph, Node, needed, operations
from .simplify import SimplifiedGraph

ROOTS = ("root", "sqrt")
"""Operations that are NaN where a group is open."""


class Gaps:
    """Makes outputs NaN where a group they depend on is open.

    An integer for each node marks the square roots that enter it, with one bit for each root of the graph.
    """

    def __init__(self, graph, scene):
        self._placement, self._behind = scene.placement, required_groups(scene.mechanism)
        self._roots: list[Node] = []
        self._bits: list[int] = []
        for node in graph:
            bits = self._of(node.arguments)
            if node.operation in ROOTS:
                bits |= 1 << len(self._roots)
                self._roots.append(node)
            self._bits.append(bits)

    def added(self, output, name):
        """The output plus 0 times each root of its groups that does not enter it yet: NaN where the root is NaN."""
        parts = (np.ravel(part)[0] for part in coordinates(self._placement, self._behind[name]))
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


WITHOUT_GAPS = ("closure", *FRICTION_CHECKS)
"""Quantities that report where a group is open, and so have values there."""


class Table(NamedTuple):
    """Rows of values that ``compute(motion, leaves)`` gives at the crank angles before the program runs.

    `rows` are the row indices, `names` the name, the order of derivative by the crank angle and the unit of each.
    `user_code` names user code whose derivatives by the parameters are unknown; "" if there is none. `of` is the cam,
    or the index of the load, that uses them.
    """

    rows: range
    compute: Callable[[Any, Any], Any]
    user_code: str = ""
    names: tuple = ()
    of: str | int = ""

    def filled(self, motion, leaves, wanted):
        """The rows; 0 for unwanted rows."""
        return [0.0] * len(self.rows) if wanted.isdisjoint(self.rows) else self.compute(motion, leaves)


@dataclass(frozen=True, eq=False)
class Recording:
    """The arithmetic of some quantities for all scenes of one structure.

    `outputs` are nodes or numbers, components of a vector one after the other. `widths` are the numbers of rows of the
    quantities: 1 for a scalar, 2 for a vector, one per group for the closure. `parameters` has a node for each number
    of a scene, in the order of its leaves. `inputs` give the errors of inexact nodes, see `ErrorBounds`.
    """

    quantities: tuple[str, ...]
    outputs: tuple[Any, ...]
    widths: tuple[int, ...]
    vectors: tuple[bool, ...]
    parameters: tuple[Node, ...]
    tables: tuple[Table, ...]
    graph: Graph
    inputs: dict[Node, Callable[[Any], Error]] = field(default_factory=dict)

    def named(self, rows):
        """Results by name from rows (outputs, ...): (...) for a scalar, (rows, ...) for a vector and the closure."""
        return dict(zip(self.quantities, map(rows.__getitem__, self._places), strict=True))

    @cached_property
    def _places(self):
        """Row or rows of each quantity."""
        ends = accumulate(self.widths)
        return [
            end - 1 if width == 1 and not vector and name != "closure" else slice(end - width, end)
            for name, end, width, vector in zip(self.quantities, ends, self.widths, self.vectors, strict=True)
        ]

    @property
    def operations(self):
        """Number of operations at each crank angle."""
        return operations(self.outputs)

    @property
    def row_count(self):
        """Number of rows of the tables that the outputs need."""
        return max((node.arguments[0] + 1 for node in needed(self.outputs) if node.operation == "table"), default=0)


def record(structure, quantities, sizes=False, placement_method=None) -> Recording:
    """Record the arithmetic of some quantities of a structure, see `parameter_tree.flatten`.

    `quantities` are names as for `quantities.components`; None: closure and all results of the groups. `sizes` records
    magnitudes of vectors instead of their components; `placement_method` is that of `Dynamics`.
    """
    recorder = Recorder(structure, placement_method, SimplifiedGraph())
    if quantities is None:
        quantities = resolved_names(recorder.recorded)
    found = [(sizes_of if sizes else components)(recorder.recorded, name) for name in quantities]
    gaps = Gaps(recorder.graph, recorder.recorded)
    outputs = tuple(
        part.flat[0] if name in WITHOUT_GAPS else gaps.added(part.flat[0], name)
        for name, parts in zip(quantities, found, strict=True)
        for part in parts
    )
    known = of_scene(recorder.recorded)
    vectors = tuple(name != "closure" and known[name].vector and not sizes for name in quantities)
    return Recording(
        tuple(quantities),
        outputs,
        tuple(map(len, found)),
        vectors,
        tuple(recorder.parameters),
        tuple(recorder.tables),
        recorder.graph,
        recorder.inputs,
    )


class Recorder:
    """Replaces the numbers of a structure by nodes of a graph: a new plain `Graph` unless one is given."""

    def __init__(self, structure, placement_method=None, graph=None):
        self.graph = Graph() if graph is None else graph
        self.parameters: list[Node] = []
        self.tables: list[Table] = []
        self.inputs: dict[Node, Callable[[Any], Error]] = {}
        self._rows = self._arrays = 0
        mechanism, speed, acceleration, items, friction, sense = unflatten(
            structure, self._parameter, self._array, lambda: None
        )
        self.angle = _nodes(self.graph.angle())
        groups = [self._with_cam(group, place) for place, group in enumerate(mechanism.groups)]
        object.__setattr__(mechanism, "groups", tuple(groups))
        for guide in mechanism.guides.values():
            rounded = (part for part in guide.rounded if isinstance(part, Node))
            self.inputs |= dict.fromkeys(rounded, lambda bounds: Error(1.0, None))
        idle = Dynamics(mechanism, self.angle, speed, acceleration, (), friction, sense, placement_method)
        self.recorded = replace(idle, loads=tuple(self._load(load, place, idle) for place, load in enumerate(items)))

    def _parameter(self):
        self.parameters.append(self.graph.parameter(len(self.parameters)))
        return self.parameters[-1]

    def _array(self):
        place = self._arrays
        self._arrays += 1
        return self._tabled((("value", 0, ""),), lambda motion, leaves: [leaves.tables[place]])[0]

    def _tabled(self, names, compute, user_code="", of=""):
        """Nodes of the rows of a new table."""
        rows = range(self._rows, self._rows + len(names))
        self._rows = rows.stop
        self.tables.append(Table(rows, compute, user_code, names, of))
        found = list(map(self.graph.row, rows))

        def unproven(bounds):
            raise NotGivenError(
                f"no bound can be given: {user_code} does more than arithmetic with sin, cos and sqrt of `arithmetic`, "
                "so its rounding is unknown"
            )

        if user_code:
            self.inputs.update(dict.fromkeys(found, unproven))
        return list(map(_nodes, found))

    def _with_cam(self, group, place):
        """The group; its cam's values are from a table if the cam's code does not run on recorded numbers."""
        if not hasattr(group, "cam") or self._is_elementwise(
            group.cam, lambda angle: group.cam.polar(angle, ray(angle))
        ):
            return group
        values = self._tabled(
            tuple((group.LAW[0], order, group.LAW[1]) for order in range(3)),
            lambda motion, leaves: motion.mechanism.groups[place].cam.radius(motion.crank_angle),
            "" if group.cam is None else type(group.cam).__name__,
            f"cam{group.label}",
        )
        object.__setattr__(group, "cam", _Tabled(tuple(values)))
        return group

    def _load(self, load, place, idle):
        """The load; its values are from a table if its code does not run on recorded numbers."""
        if getattr(load, "STROKE", False):
            load = replace_unchecked(load, ends=self._stroke(load, place, idle))
        if not isinstance(load, Load):
            if self._is_elementwise(load, lambda angle: [load.push(without_forces(replace(idle, crank_angle=angle)))]):
                return load
            return ProcessForce(self._given(load, place), load.on)
        value = load.value_now
        if isinstance(value, loads.Table):
            return replace_unchecked(load, **{load.VALUE: self._read(value, load.UNIT, place, idle)})
        if not callable(value) or self._is_elementwise(
            value, lambda angle: [value(without_forces(replace(idle, crank_angle=angle)))]
        ):
            return load
        return replace_unchecked(load, **{load.VALUE: self._given(load, place)})

    def _stroke(self, load, place, idle):
        """Coordinates of the dead centres of a load's slider, at their crank angles from a table.

        The angles count as constants: the coordinate has an extremum there, so an error of the angle does not change
        it to first order, and derivatives are exact. For a cam from a table the coordinates come from a table too.
        """
        mechanism, is_tabled = idle.mechanism, _has_tabled_cam(idle.mechanism)
        rows = self._tabled(
            (("s_f", 0, "m"), ("s_n", 0, "m")) if is_tabled else (("phi_f", 0, "rad"), ("phi_n", 0, "rad")),
            lambda motion, leaves: loads.dead_centres(motion, load.on)[is_tabled],
            f"{load.title} with a cam from samples" if is_tabled else "",
            place,
        )
        return rows if is_tabled else [mechanism.place(row).travels[load.on].position for row in rows]

    def _zero_angle(self, table, item, place, idle):
        """Crank angle of the dead centre where a table begins."""
        is_tabled = _has_tabled_cam(idle.mechanism)
        ((zero,),) = self._tabled(
            (("phi_0", 0, "rad"),),
            lambda motion, leaves: [item(motion).zero_angle(motion)],
            f"a table from {table.zero} beside a cam of samples" if is_tabled else "",
            place,
        )
        slider = table.slider or next(iter(idle.mechanism.guides))
        return _nodes(zero) if is_tabled else self._refined(_nodes(zero), idle.mechanism, slider)

    def _refined(self, angle, mechanism, slider):
        """Crank angle of a dead centre after a Newton step, which gives its derivatives: the rate is zero there."""
        travel = mechanism.place(angle).travels[slider]
        return angle - travel.first / travel.second

    def _given(self, load, place):
        """Values of a load given by user code, from a table."""
        names = (("value", 0, getattr(load, "UNIT", "N")),)
        (values,) = self._tabled(
            names, lambda motion, leaves: [user_value(motion.loads[place], motion)], title_of(load), place
        )
        return values

    def _read(self, table, unit, place, idle):
        """Values of a table over the crank angle; for others, a function of the motion on a piece chosen before."""

        def item(motion):
            return motion.loads[place].value_now

        def rounding(motion, leaves):
            return [table_pieces.rounding_bound(item(motion), motion) / UNIT_ROUNDOFF]

        by_angle = table.over == "angle"
        if by_angle and not table.from_dead_centre:
            (values,) = self._tabled((("value", 0, unit),), lambda motion, leaves: [item(motion)(motion)], of=place)
            (errors,) = self._tabled(ERRORS[:1], rounding)
            self.inputs[values[0]] = lambda bounds: Error(0.0, errors[0])
            return values
        own = "rad" if by_angle else "m"
        names = ("start", 0, own), ("value", 0, unit), ("slope", 0, f"{unit}/{own}")
        start, value, slope = self._tabled(names, lambda motion, leaves: item(motion).pieces(motion), of=place)
        kinks = self._tabled(ERRORS, lambda motion, leaves: table_pieces.kink_bounds(item(motion), motion))
        own_error = self._tabled(ERRORS[:1], rounding)[0][0] if by_angle else None
        zero = self._zero_angle(table, item, place, idle) if by_angle else None

        def read(motion):
            given = (motion.crank_angle - zero, 1.0) if by_angle else (table.place(motion), table.rate(motion))
            travel, rate = (np.ravel(part)[0] for part in given)
            nearby = {"kinks": [row[0] for row in kinks], "own": own_error}
            self.inputs[value[0]] = partial(_error_of_piece, travel=travel, rate=rate, **nearby)
            self.inputs[slope[0]] = lambda bounds: Error(3.0, None)
            return table.read(motion, (start, value, slope), zero)

        return read

    def _is_elementwise(self, part, compute):
        """Whether a part computes with recorded numbers, and each result depends on its own crank angle alone."""
        try:
            given = compute(self.angle)
            if not all(isinstance(found, float | np.ndarray | Node) for found in given):
                return False
            alone = [np.broadcast_to(found, 1)[0] for found in given]
            if getattr(part, "ELEMENTWISE", False):
                return True
            other = self.graph.angle()
            for place, pair in enumerate([(self.angle[0], other), (other, self.angle[0])]):
                beside = [np.broadcast_to(found, 2)[place] for found in compute(_nodes(*pair))]
                if any(one is not two and one != two for one, two in zip(alone, beside, strict=True)):
                    return False
        except Exception:  # any failure on recorded numbers
            return False
        return True


@dataclass(frozen=True, eq=False)
class _Tabled:
    """A cam with given radius and derivatives."""

    values: tuple

    def polar(self, angle, ray):
        return self.values


# Errors of inputs that are not exact

ERRORS = tuple(("error", order, "") for order in range(4))
"""Names of the table rows with terms of errors, which only the bounds use."""


def _nodes(*nodes):
    return np.array(nodes, dtype=object)


def _has_tabled_cam(mechanism):
    return any(isinstance(getattr(group, "cam", None), _Tabled) for group in mechanism.groups)


def _error_of_piece(bounds, kinks, travel, rate, own=None):
    """Error of a table's value: its rounding, `own`, and a change of piece or stroke, from `kinks` (`kink_bounds`)."""
    change, jump, near, distance = kinks
    bounds.look_at((travel, rate))
    jumps = plus(plus(jump / UNIT_ROUNDOFF, own), 0.0 / bounds.above(near, bounds.total(rate)))
    total = bounds.total(travel)
    if total is None:  # the place is exact
        return Error(0.0, jumps)
    off = 2.0 * total  # also of the place that selected the piece
    jumps = plus(jumps, 0.0 / bounds.above(near, off))
    return Error(0.0, bounds.fused(change, bounds.above(off - distance / UNIT_ROUNDOFF, None), jumps))

"""Recording of a scene in which each number of the mechanism has a name: the source of hand calculations.

`record_with_names` runs the kernels of `Dynamics` once on recorded numbers; nothing else is computed. Joints, links,
forces and other results of the mechanism's protocol get names; formulas end at them. Numbers in between are named as
the local variables of the kernel, read when it returns. A module may give a variable a symbol and words in `TERMS`:

    TERMS = {"across": ("d", "distance from the inner joint across to the guide"), "resolve.across": ...}

A number without a name stays part of a formula.
"""

import sys
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from ..engines.graph import INPUTS, Node
from ..engines.record import Recorder
from ..machine.group import Resolved
from ..machine.kinematic_state import place as placed
from ..machine.kinematic_state import sense_of
from ..machine.links import Joint, Wrench, arm, first_at, second_at
from ..machine.loads import value_of
from ..mechanics.dynamics import Dynamics
from ..mechanics.friction import FrictionSolver, size_of
from ..mechanics.load_values import title_of
from ..mechanics.quantities import magnitude
from ..numbers.lazy import cached_property
from ..numbers.planar import number_or_zero, product
from .formats import Symbol, load_keys, path_symbol, quantity_symbol

KERNELS = (
    "kinetostatics.machine",
    "kinetostatics.mechanics.energy_contact",
    "kinetostatics.mechanics.principal_points",
)
"""Modules whose local variables give names."""
GENERIC = tuple(f"kinetostatics.machine.{name}" for name in ("group", "friction", "kinematic_state"))
AXES = ("x", "y")
DEAD_CENTRES = {
    "phi_f": "crank angle of the far dead centre",
    "phi_n": "crank angle of the near dead centre",
    "phi_0": "crank angle of the dead centre at which the table begins",
}
"""Words for the angles at which the stroke of a load's slider is evaluated."""


class NamedRecorder(Recorder):
    """Recorder without the steps that only derivatives need."""

    def _refined(self, angle, mechanism, slider):
        return angle


class Named(NamedTuple):
    """A recorded number with a name: its symbol, the heading above it, its description in words, and its SI unit.

    The unit is "" if it follows from the formula. `kind` is "given", "protocol" (a result of the mechanism), "term" of
    a kernel's `TERMS`, or only a "line" of a kernel.
    """

    symbol: Symbol
    title: str
    words: str = ""
    unit: str = ""
    kind: str = "protocol"


class Names:
    """Names `of` the nodes of a graph.

    `modules` are those besides `KERNELS` whose local variables give names, of the user's groups and loads. `laws` are
    shown instead of iterations whose results satisfy them, and may contain later numbers. `stands_for` gives the
    named number of the same value that formulas use instead of a node.
    """

    def __init__(self, graph, modules=()):
        self.graph, self.modules, self.of = graph, modules, {}
        self.laws: dict[Node, Any] = {}
        self.stands_for: dict[Node, Node] = {}
        self.title, self.reading = "", True
        self.titles: list[str] = []

    @contextmanager
    def under(self, title):
        """Put all calculations of the block under a heading, and name local variables of kernels.

        If a profiler is already active it stays active, and lines of kernels have no names.
        """
        before, self.title = self.title, title
        if title not in self.titles:
            self.titles.append(title)
        known = sys.getprofile()
        if known is None:
            sys.setprofile(self._read)
        try:
            yield
        finally:
            if known is None:
                sys.setprofile(None)
            self.title = before

    def _read(self, frame, event, _):
        """Name the local variables of a kernel that returns; outer kernels override, arguments get no name."""
        if event != "return" or not self.reading:
            return
        module = frame.f_globals.get("__name__", "")
        if module in GENERIC or not (module.startswith(KERNELS) or module in self.modules):
            return
        code, found = frame.f_code, frame.f_locals
        kernel, arguments = code.co_name, code.co_varnames[: code.co_argcount]
        if kernel.startswith("<"):
            return
        terms = frame.f_globals.get("TERMS", {})
        for variable, value in list(found.items()):
            if variable[0] == "_" or (variable in arguments and f"{kernel}.{variable}" not in terms):
                continue
            base, words = terms.get(f"{kernel}.{variable}") or terms.get(variable) or (variable, "")
            kind = "term" if words else "line"
            for path, axis, node in _flat(value):
                known = self.of.get(node)
                is_better = known is not None and (
                    known.kind in ("protocol", "given")
                    or known.title != self.title
                    or (kind == "line" and (known.kind == "term" or bool(path)))
                )
                if node.operation in (*INPUTS, "rest") or is_better:
                    continue
                stem = base.rstrip("'")
                symbol = Symbol(".".join((stem, *path)), axis, primes=len(base) - len(stem))
                self.of[node] = Named(symbol, self.title, words, kind=kind)

    def number(self, value, symbol, words="", unit="", again=False, turned="onward"):
        """Name a number and return it, or an equivalent node.

        A number that already has a name of the mechanism gets a second one only with `again`. The recorder moves the
        sign of a negated number into sums, where its name would be lost. With `turned` "onward" the returned node keeps
        the name, with "everywhere" formulas use it also for earlier uses, and "within" names the number itself. A
        number that is always zero is named only if `turned` is "always", like results.
        """
        node = node_of(value)
        if node is None or (self.has_own_name(node) and (not again or self.of[node].symbol == symbol)):
            return value
        if _vanishes(node) and turned != "always":
            return value
        is_turned = node.operation == "-" and len(node.arguments) == 1 and turned in ("onward", "everywhere")
        if self.has_own_name(node) or is_turned:
            held = Node(self.graph, "held", (node,), node.varies)
            if turned == "everywhere" and not self.has_own_name(node):
                self.stands_for[node] = held
            node, value = held, np.array([held], dtype=object)
        self.of.pop(node, None)
        self.of[node] = Named(symbol, self.title, words, unit)
        return value

    def vector(self, parts, symbol, words="", unit="", again=False, turned="onward"):
        """Name both components of a vector, which may be absent; arguments as for `number`."""
        if parts is None:
            return None
        return tuple(
            self.number(part, symbol._replace(axis=symbol.axis + axis), words, unit, again, turned)
            for part, axis in zip(parts, AXES, strict=True)
        )

    def has_own_name(self, node):
        """Whether a node is given or named by the mechanism's protocol; every formula ends there."""
        return node in self.of and self.of[node].kind in ("protocol", "given")

    def symbols(self, nodes):
        """Symbols of nodes, numbered if several have the same spelling."""
        counts: dict[Symbol, int] = {}
        found = {}
        for node in nodes:
            symbol = self.of[node].symbol
            counts[symbol] = counts.get(symbol, 0) + 1
            found[node] = symbol._replace(again=counts[symbol])
        return found


def _vanishes(node, depth=4):
    """Whether a recorded number is zero for all inputs, as far as a few operations can show."""
    if not isinstance(node, Node):
        return node == 0.0
    if node.operation in INPUTS or not depth:
        return False
    parts = [_vanishes(part, depth - 1) for part in node.arguments]
    if node.operation == "*":
        return any(parts)
    return all(parts) if node.operation in ("+", "-", "held") else node.operation == "/" and parts[0]


def node_of(value):
    if isinstance(value, np.ndarray) and value.dtype == object and value.size == 1:
        value = value.flat[0]
    return value if isinstance(value, Node) else None


def _flat(value, path=()):
    """Recorded numbers in a local variable: names of fields, axis of a component, node."""
    node = node_of(value)
    if node is not None:
        yield path, "", node
    elif isinstance(value, tuple):
        fields = getattr(value, "_fields", None)
        if fields is None and len(value) == 2:
            for axis, part in zip(AXES, value, strict=True):
                node = node_of(part)
                if node is not None:
                    yield path, axis, node
        elif fields is not None:
            for name, part in zip(fields, value, strict=True):
                yield from _flat(part, (*path, name))


GIVEN, WEIGHT = "Given", "Weight"
ORDERS = ("", "first", "second")


def record_with_names(state, paths, units):
    """The scene of a `Dynamics` recorded with names, a `NamedDynamics`, and its recorder.

    `paths` maps the place of a number among the leaves to its path, `units` paths to SI units.
    """
    structure, _ = state.apart
    recorder = NamedRecorder(structure)
    groups, values = state.mechanism.groups, map(value_of, state.loads)
    users = {type(part).__module__ for part in (*groups, *(getattr(one, "cam", None) for one in groups), *state.loads)}
    users |= {getattr(value, "__module__", "") for value in values if callable(value)}
    scene, names = recorder.recorded, Names(recorder.graph, users)
    names.title = GIVEN
    for place, node in enumerate(recorder.parameters):
        path = paths.get(place)
        symbol = path_symbol(path) if path else Symbol("c", "", str(place + 1))
        names.of[node] = Named(symbol, GIVEN, path or "a number of the scene", units.get(path, ""), "given")
    names.of[recorder.graph[recorder.angle[0].index]] = Named(Symbol("phi"), GIVEN, "crank angle", "rad", "given")
    heads = [(title_of(item), key) for item, key in zip(state.loads, load_keys(state.loads), strict=True)]
    rows = {
        row: (table, *spelled)
        for table in recorder.tables
        for row, spelled in zip(table.rows, table.names, strict=True)
    }
    for node in [node for node in recorder.graph if node.operation == "table"]:
        table, name, primes, unit = rows[node.arguments[0]]
        owner = heads[table.of][1] if isinstance(table.of, int) else table.of
        words = DEAD_CENTRES.get(name, "read at this crank angle")
        names.of[node] = Named(Symbol(name, "", owner, primes), GIVEN, words, unit, "given")
    made = object.__new__(NamedDynamics)
    vars(made).update(vars(scene))
    vars(made).update(names=names, heads=heads, runs=bool(state.crank_speed != 0))
    return made, recorder


def name_result(made, quantity, found, sized=False):
    """Named numbers of a quantity: one, or two of a vector, or its magnitude if `sized`; constants are plain."""
    parts = found.read(made)
    with made.names.under("Result"):
        symbol = Symbol("R", "", quantity) if found.kind == "reaction" else quantity_symbol(quantity)
        words = found.label
        if found.vector:
            parts = made.names.vector(tuple(parts), symbol, words, found.unit, turned="always")
            if not sized:
                return parts
            parts, words = magnitude(parts), f"magnitude of the {words}"
        return (made.names.number(parts, symbol, words, found.unit, turned="always"),)


class NamedDynamics(Dynamics):
    """A recorded scene that names its results; made by `record_with_names`."""

    names: Any
    heads: Any  # title of each load, and its name in paths
    runs: bool

    @cached_property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        names, crank = self.names, self.mechanism.crank
        with names.under("Crank"):
            placement = crank.place(self.crank_angle)
            self._placed(placement, crank)
        for group in self.mechanism.groups:
            moved = [_joined(list(group.links))] if group.links else []
            moved += [f"joint {_joined(group.joints)}"] if group.joints else []
            with names.under(f"Motion of {', '.join(moved)}"):
                for slider, guide in group.guides.items():
                    symbol = Symbol("u", "", f"guide{group.label}")
                    names.vector(guide.direction, symbol, f"unit vector of the guide of the {slider}", "1")
                placed(group, placement)
                self._placed(placement, group)
        for name, link in self.mechanism.links.items():
            motion, body = placement.links[name], link.body
            with names.under(f"Mass centre of the {name}"):
                words = f"from {self.mechanism.references[name]} to the mass centre of the {name}"
                place = None if body.mass is None else arm(motion.direction, body.along, body.across)
                to_centre = names.vector(place, Symbol("r", "", name), words, "m")
                slopes = (first_at(motion, to_centre), second_at(motion, to_centre)) if to_centre is not None else ()
                for order, part in enumerate(slopes, 1):
                    words = _derivative(order, f"position of the mass centre of the {name}")
                    for axis, value in zip(AXES, part or (), strict=False):
                        names.number(value, Symbol(axis, "", f"S_{name}", order), words, "m", turned="everywhere")
        return placement

    def _placed(self, placement, part):
        """Name joints, links and coordinates along guides of a part, in its placement too."""
        names = self.names
        for name in part.links:
            link = placement.links[name]
            direction = names.vector(link.direction, Symbol("u", "", name), f"unit vector of the {name}", "1")
            ratio = names.number(link.ratio, Symbol("theta", "", name, 1), f"angular velocity ratio of the {name}", "1")
            words = f"slope of that ratio of the {name}"
            ratio_slope = names.number(link.ratio_slope, Symbol("theta", "", name, 2), words, "1")
            placement.links[name] = link._replace(direction=direction, ratio=ratio, ratio_slope=ratio_slope)
        for slider in (name for name in part.links if name in placement.travels):
            words = f"coordinate of the {slider} along its guide"
            travel = [
                names.number(value, Symbol("s", "", slider, order), _derivative(order, words), "m")
                for order, value in enumerate(placement.travels[slider])
            ]
            placement.travels[slider] = Joint(*travel)
        for name in part.joints:
            found = []
            for order, values in enumerate(placement.joints[name]):
                words = _derivative(order, f"position of {name}")
                named = (
                    names.number(value, Symbol(axis, "", name, order), words, "m", again=True)
                    for value, axis in zip(values or (), AXES, strict=False)
                )
                found.append(tuple(named) or None)
            placement.joints[name] = Joint(*found)
        for name, link in placement.links.items():
            reference = self.mechanism.references[name]
            if name in part.links and link.joint is not None and reference in placement.joints:
                placement.links[name] = link._replace(joint=placement.joints[reference])

    @cached_property
    def gravity(self):
        """Acceleration by weight, m/s2; None if absent."""
        with self.names.under(WEIGHT):
            return self.names.vector(super().gravity, Symbol("g"), "acceleration by weight", "m/s2")

    def _mass_load(self, link, gravity):
        what = f"{'inertia' if gravity is None else 'inertia and weight'} of the {link}"
        with self.names.under(what.capitalize()):
            return self._wrench(super()._mass_load(link, gravity), ("P", "K"), link, what)

    def _spring_load(self, slider, mass):
        what = f"{'inertia' if self.gravity is None else 'inertia and weight'} of the springs on the {slider}"
        with self.names.under(what.capitalize()):
            return self._wrench(super()._spring_load(slider, mass), ("P", "K"), f"spring_{slider}", what)

    def _wrench(self, wrench, letters, owner, words):
        force, moment = letters
        return Wrench(
            self.names.vector(wrench.force, Symbol(force, "", owner), f"force of {words}", "N", False, "everywhere"),
            self.names.number(wrench.moment, Symbol(moment, "", owner), f"moment of {words}", "N m"),
        )

    def _wrenches_of(self, place):
        title, key = self.heads[place]
        with self.names.under(title):
            return [
                (link, self._wrench(wrench, ("L", "K"), f"{key}_{link}", f"{key.replace('_', ' ')} on the {link}"))
                for link, wrench in super()._wrenches_of(place)
            ]

    def _push_of(self, place):
        title, key = self.heads[place]
        with self.names.under(title):
            words = f"{key.replace('_', ' ')} along the guide of the {self.loads[place].on}"
            return self.names.number(super()._push_of(place), Symbol("L", "", key), words, "N")

    @property
    def acting(self):
        """Loads by link and forces along guides by slider, as input of the groups."""
        self.placement, self.link_loads, self.pushes  # noqa: B018  named first
        with self.names.under("Inertia and springs along guides"):
            return super().acting

    def departure(self, item):
        """Second derivative of a slider's coordinate plus the elongation of a spring on it, m; None if not known."""
        words = f"second derivative of the coordinate of the {item.on} plus the elongation of its spring"
        return self.names.number(super().departure(item), Symbol("w", "", item.on), words, "m")

    def outward(self, item):
        """Elongation of a spring on a slider, or its opposite, as a length of the design and a remainder, m."""
        if (found := super().outward(item)) is None:
            return None
        length, more = found
        elongation = f"the elongation of the spring on the {item.on}, or its opposite,"
        words = f"{elongation} less a length of the cam"
        return length, self.names.number(more, Symbol("u", "", item.on), words, "m")

    @cached_property
    def powers(self):
        """Power of each load divided by the crank speed."""
        wrenches = [*self.spring_loads, *self.wrenches]
        owners = [(name, "") for name in (*self.mass_loads, *(name for name, _ in wrenches))]
        owners += [(name, "s") for name in self.pushes]
        with self.names.under("Powers"):
            words = (f"power of the loads on the {owner} over the crank speed" for owner, _ in owners)
            return [
                self.names.number(power, Symbol("W", axis, owner), text, "N m")
                for (owner, axis), power, text in zip(owners, super().powers, words, strict=True)
            ]

    @cached_property
    def friction_solver(self):
        """Solver that resolves each part, with friction or without, and names the results."""
        way = sense_of(self.crank_speed, None) if self.runs and self.sense is None else self.crank_sense
        return _NamedFrictionSolver(self.mechanism, self.friction, way, self.names)


class _NamedFrictionSolver(FrictionSolver):
    """Resolves parts, and names the loads on their links and the results."""

    def __init__(self, mechanism, friction, direction, names):
        super().__init__(mechanism, friction, direction)
        self.names, self.laws = names, []

    def __call__(self, part, placement, loads, along):
        names = self.names
        with names.under(f"Forces on {_joined(list(part.links))}" if part.links else "Forces"):
            loads, along = dict(loads), dict(along)
            for name in part.links:
                rest = "with its inertia and the groups attached to it"
                words = f"that acts on the {name}, {'except what is listed separately' if name in along else rest}"
                loads[name] = Wrench(
                    names.vector(loads[name].force, Symbol("F", "", name), f"force {words}", "N"),
                    names.number(loads[name].moment, Symbol("M", "", name), f"moment {words}", "N m"),
                )
                if name in along:
                    words = f"other loads on the {name} along its guide"
                    along[name] = names.number(along[name], Symbol("F", "s", name), words, "N")
            names.reading, self.laws = not any(name in self.acting for name in part.pairs), []
            resolved = super().__call__(part, placement, loads, along)
            reactions, scalars = dict(resolved.reactions), dict(resolved.scalars)
            for name, (unit, vector, text, *_) in part.outputs.items():
                words = f"{name.replace('_', ' ')}{', ' * bool(text)}{text}"
                if vector:
                    symbol, words = Symbol("R", "", name), f"reaction {words}"
                    reactions[name] = names.vector(reactions.get(name), symbol, words, unit, True, "within")
                else:
                    scalars[name] = names.number(scalars.get(name), quantity_symbol(name), words, unit, True, "within")
            resolved = Resolved(reactions, scalars, resolved.demands)
            names.reading = True
            for law, amount in self.laws:
                size = node_of(number_or_zero(product(law.factor, size_of(law.kind, law.reaction(resolved)))))
                node = node_of(amount)
                if node is not None and size is not None and size is not node:
                    names.laws[node], named = size, names.of[node]
                    names.of[node] = named._replace(words=f"{named.words}, solved together with the reactions")
        return resolved

    def _amounts(self, equations, laws, placement):
        found = []
        for law, amount in zip(laws, super()._amounts(equations, laws, placement), strict=True):
            moment = law.kind in ("length", "itself")
            symbol = Symbol("M" if moment else "F", "", f"friction_{law.name}")
            words = f"friction {'moment' if moment else 'force'} at {law.name}"
            found.append(self.names.number(amount, symbol, words, "N m" if moment else "N", again=True))
            self.laws.append((law, found[-1]))
        self.names.reading = True
        return found


def _derivative(order, words):
    return f"{ORDERS[order]} derivative by phi of the {words}" if order else words


def _joined(names):
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last

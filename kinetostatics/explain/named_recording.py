"""The kernels run once on recorded numbers, each result named as the mechanism calls it: what a hand calculation tells.

Nothing is computed here that `Dynamics` does not compute; what is found gets a name and goes on under it.

Names of recorded numbers: what the protocol calls a number, else what the kernel's own line calls it.

A formula ends at numbers that have a name. Joints, links, forces and what else the mechanism keeps have names of their
own (`told`); the lines of a kernel in between are called as its local variables, read when it returns. A module may say
in `TERMS` how an engineer writes such a variable, and what it is:

    TERMS = {"across": ("d", "distance from the inner joint across to the guide"), "resolve.across": ...}

What no one has named stays part of a formula.
"""

import sys
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from ..engines.graph import INPUTS, Node
from ..engines.record import Recorder
from ..machine.group import FRAME, Resolved
from ..machine.kinematic_state import place as placed
from ..machine.kinematic_state import sense_of
from ..machine.links import Joint, Wrench, arm, first_at, load, second_at
from ..machine.loads import value_of
from ..mechanics.dynamics import Dynamics
from ..mechanics.friction import FrictionSolver, size_of
from ..mechanics.load_values import evaluate_load, slider_push, title_of
from ..mechanics.quantities import magnitude
from ..numbers.lazy import cached_property
from ..numbers.planar import number_or_zero, plus, product
from .symbols import Symbol, load_keys, path_symbol, quantity_symbol

KERNELS = (
    "kinetostatics.machine",
    "kinetostatics.mechanics.energy_contact",
    "kinetostatics.mechanics.principal_points",
)
"""Modules whose local variables are names."""
GENERIC = tuple(f"kinetostatics.machine.{name}" for name in ("group", "friction", "kinematic_state"))
AXES = ("x", "y")


class Named(NamedTuple):
    """A recorded number with a name.

    Attributes
    ----------
    symbol : Symbol
    title : str
        Heading that it stands under.
    words : str
        What it is.
    unit : str
        SI; "" where the formula tells it.
    kind : str
        "given", "told" by the protocol, "term" of a kernel's `TERMS`, or only a "line" of a kernel.
    """

    symbol: Symbol
    title: str
    words: str = ""
    unit: str = ""
    kind: str = "told"


class Names:
    """Names of the nodes of a graph.

    Attributes
    ----------
    modules : collection of str
        Modules besides `KERNELS` whose local variables are names: those of groups and loads of the user's own.
    of : dict of Node to Named
    laws : dict of Node to formula
        Law that a number satisfies which was found by iteration: its own operations are not told.
    stands_for : dict of Node to Node
        Named number of the same value that formulas end at instead.
    """

    def __init__(self, graph, modules=()):
        self.graph, self.modules, self.of = graph, modules, {}
        self.laws: dict[Node, Any] = {}
        self.stands_for: dict[Node, Node] = {}
        self.title, self.reading = "", True
        self.titles: list[str] = []

    @contextmanager
    def under(self, title):
        """What is computed within stands under a heading; local variables of kernels are names.

        Where a profiler runs already it is left alone, and kernels' lines have no names.
        """
        before, self.title = self.title, title
        if title not in self.titles:
            self.titles.append(title)
        known = sys.getprofile()
        if known is None:
            sys.setprofile(self._returned)
        try:
            yield
        finally:
            if known is None:
                sys.setprofile(None)
            self.title = before

    def _returned(self, frame, event, value):
        if event == "return" and self.reading:
            self._read(frame)

    def _read(self, frame):
        """Name what a kernel that returns has computed; names of the outermost win, arguments have none."""
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
                if node.operation in (*INPUTS, "rest") or self._is_better(node, kind, path):
                    continue
                stem = base.rstrip("'")
                symbol = Symbol(".".join((stem, *path)), axis, primes=len(base) - len(stem))
                self.of[node] = Named(symbol, self.title, words, kind=kind)

    def _is_better(self, node, kind, path):
        known = self.of.get(node)
        if known is None:
            return False
        if known.kind in ("told", "given") or known.title != self.title:
            return True
        return kind == "line" and (known.kind == "term" or bool(path))

    def number(self, value, symbol, words="", unit="", again=False, turned="onward"):
        """Name a number; what has a name of the mechanism's is repeated under the new one if it is told `again`.

        Arithmetic takes in the sign of a number that is another one `turned`; to keep its name, what is returned takes
        its place "onward", or "everywhere"; else it is named "within" the arithmetic alone. What is zero whatever
        happens has no name, but as a result, that is "always" told.
        """
        node = node_of(value)
        if node is None or (self.is_told(node) and (not again or self.of[node].symbol == symbol)):
            return value
        if _vanishes(node) and turned != "always":
            return value
        is_turned = node.operation == "-" and len(node.arguments) == 1 and turned in ("onward", "everywhere")
        if self.is_told(node) or is_turned:
            held = Node(self.graph, "held", (node,), node.varies)
            if turned == "everywhere" and not self.is_told(node):
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

    def is_told(self, node):
        """Whether a node has a name of the mechanism's, at which every formula ends."""
        return node in self.of and self.of[node].kind in ("told", "given")

    def satisfies(self, node, law):
        """Tell a number by the law that it satisfies, in which numbers after it may stand."""
        if node is not None and law is not None and law is not node:
            self.laws[node] = law
            named = self.of[node]
            self.of[node] = named._replace(words=f"{named.words}, found together with the reactions")

    def symbols(self, nodes):
        """Symbols of nodes, told apart where several are spelled alike."""
        counts: dict[Symbol, int] = {}
        found = {}
        for node in nodes:
            symbol = self.of[node].symbol
            counts[symbol] = counts.get(symbol, 0) + 1
            found[node] = symbol._replace(again=counts[symbol])
        return found


def _vanishes(node, depth=4):
    """Whether a recorded number is plainly zero, whatever it is computed from."""
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
    """Recorded numbers in a value of a local variable, with names of fields, and the axis of a component."""
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
    """The scene of a `Dynamics`, recorded with names, and what recorded it.

    Parameters
    ----------
    state : Dynamics
    paths : dict of int to str
        What each number among its leaves is called, as in case files.
    units : dict of str to str
        SI unit by path.
    """
    structure, _ = state.apart
    recorder = Recorder(structure)
    scene, names = recorder.recorded, Names(recorder.graph, _modules(state))
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
        words = "read at this crank angle"
        names.of[node] = Named(Symbol(name, "", owner, primes), GIVEN, words, unit, "given")
    made = object.__new__(NamedDynamics)
    vars(made).update(vars(scene))
    vars(made).update(names=names, heads=heads, runs=bool(state.crank_speed != 0))
    return made, recorder


def name_result(made, quantity, found, sized=False):
    """Recorded numbers of a quantity, named, of a vector that is `sized` its magnitude; what nothing makes is plain."""
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
    """A recorded scene that names what it finds; made by `told`."""

    names: Any
    heads: Any
    runs: bool

    @cached_property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        names, crank = self.names, self.mechanism.crank
        with names.under("Crank"):
            placement = crank.place(self.crank_angle)
            self._placed(placement, crank)
        for group in self.mechanism.groups:
            with names.under(_motion_title(group)):
                for slider, guide in group.guides.items():
                    symbol = Symbol("u", "", f"guide{group.label}")
                    names.vector(guide.direction, symbol, f"unit vector of the guide of the {slider}", "1")
                placed(group, placement)
                self._placed(placement, group)
        for name, link in self.mechanism.links.items():
            with names.under(f"Mass centre of the {name}"):
                self._name_centre(name, placement.links[name], link.body)
        return placement

    def _placed(self, placement, part):
        """Name joints, links and coordinates along guides of a part; what is kept of it goes on under these names."""
        names = self.names
        for name in part.links:
            link = placement.links[name]
            turning = Symbol("theta", "", name)
            placement.links[name] = link._replace(
                direction=names.vector(link.direction, Symbol("u", "", name), f"unit vector of the {name}", "1"),
                ratio=names.number(
                    link.ratio, turning._replace(primes=1), f"angular velocity ratio of the {name}", "1"
                ),
                ratio_slope=names.number(
                    link.ratio_slope, turning._replace(primes=2), f"slope of that ratio of the {name}", "1"
                ),
            )
        for slider in (name for name in part.links if name in placement.travels):
            words = f"coordinate of the {slider} along its guide"
            placement.travels[slider] = Joint(
                *(
                    names.number(value, Symbol("s", "", slider, order), _derivative(order, words), "m")
                    for order, value in enumerate(placement.travels[slider])
                )
            )
        for name in part.joints:
            placement.joints[name] = self._named_joint(placement.joints[name], name)
        for name, link in placement.links.items():
            reference = self.mechanism.references[name]
            if name in part.links and link.joint is not None and reference in placement.joints:
                placement.links[name] = link._replace(joint=placement.joints[reference])

    def _named_joint(self, joint, name):
        found = []
        for order, part in enumerate(joint):
            words = _derivative(order, f"position of {name}")
            named = (
                self.names.number(value, Symbol(axis, "", name, order), words, "m", again=True)
                for value, axis in zip(part or (), AXES, strict=False)
            )
            found.append(tuple(named) or None)
        return Joint(*found)

    @cached_property
    def gravity(self):
        """Acceleration by weight, m/s2; None without."""
        with self.names.under(WEIGHT):
            return self.names.vector(super().gravity, Symbol("g"), "acceleration by weight", "m/s2")

    def _mass_loads(self, gravity):
        links = self.placement.links
        found = {}
        what = "inertia" if gravity is None else "inertia and weight"
        for name, link in self.mechanism.links.items():
            with self.names.under(f"{what} of the {name}".capitalize()):
                wrench = load(links[name], link.body, *self.accelerating, gravity)
                found[name] = self._wrench(wrench, ("P", "K"), name, f"{what} of the {name}")
        return found

    def _name_centre(self, name, motion, body):
        """Name the arm of a mass centre, and its kinematic coefficients."""
        if body.mass is None:
            return
        words = f"from {self.mechanism.references[name]} to the mass centre of the {name}"
        place = arm(motion.direction, body.along, body.across)
        to_centre = self.names.vector(place, Symbol("r", "", name), words, "m")
        if to_centre is not None:
            for order, part in enumerate((first_at(motion, to_centre), second_at(motion, to_centre)), 1):
                words = _derivative(order, f"position of the mass centre of the {name}")
                for axis, value in zip(AXES, part or (), strict=False):
                    self.names.number(value, Symbol(axis, "", f"S_{name}", order), words, "m", turned="everywhere")

    def _wrench(self, wrench, letters, owner, words):
        force, moment = letters
        return Wrench(
            self.names.vector(wrench.force, Symbol(force, "", owner), f"force of {words}", "N", False, "everywhere"),
            self.names.number(wrench.moment, Symbol(moment, "", owner), f"moment of {words}", "N m"),
        )

    @cached_property
    def wrenches(self):
        """Pairs of a link and a wrench on it, of all loads that act so."""
        found = []
        for item, (title, key) in zip(self.loads, self.heads, strict=True):
            if hasattr(item, "wrenches"):
                with self.names.under(title):
                    for link, wrench in evaluate_load(item, self).wrenches(self):
                        if link != FRAME:
                            words = f"{key.replace('_', ' ')} on the {link}"
                            found.append((link, self._wrench(wrench, ("L", "K"), f"{key}_{link}", words)))
        return found

    @cached_property
    def pushes(self):
        """Applied force along its guide by slider, N."""
        pushes: dict[str, Any] = {}
        for item, (title, key) in zip(self.loads, self.heads, strict=True):
            if hasattr(item, "push"):
                with self.names.under(title):
                    words = f"{key.replace('_', ' ')} along the guide of the {item.on}"
                    push = self.names.number(slider_push(item, self), Symbol("L", "", key), words, "N")
                    pushes[item.on] = plus(pushes.get(item.on), push)
        return pushes

    @property
    def acting(self):
        """Loads by link and forces along guides by slider as groups resolve them."""
        self.placement, self.link_loads, self.pushes  # noqa: B018  told before
        with self.names.under("Inertia and springs along guides"):
            return super().acting

    def departure(self, item):
        """Second derivative of a slider's coordinate plus the elongation of a spring on it, m; None if not known."""
        words = f"second derivative of the coordinate of the {item.on} plus the elongation of its spring"
        return self.names.number(super().departure(item), Symbol("w", "", item.on), words, "m")

    def outward(self, item):
        """Elongation of a spring on a slider, or its opposite, as a length of the design and some more, m."""
        if (found := super().outward(item)) is None:
            return None
        length, more = found
        words = (
            f"how much the elongation of the spring on the {item.on}, or its opposite, is more than a length of the cam"
        )
        return length, self.names.number(more, Symbol("u", "", item.on), words, "m")

    @cached_property
    def powers(self):
        """Power of each load divided by the crank speed."""
        owners = [(name, "") for name in (*self.mass_loads, *(name for name, _ in self.wrenches))]
        owners += [(name, "s") for name in self.pushes]
        with self.names.under("Powers"):
            return [
                self.names.number(
                    power, Symbol("W", axis, owner), f"power of what acts on the {owner} over the crank speed", "N m"
                )
                for (owner, axis), power in zip(owners, super().powers, strict=True)
            ]

    @cached_property
    def friction_solver(self):
        """What resolves each part, with friction or without."""
        way = sense_of(self.crank_speed, None) if self.runs and self.sense is None else self.crank_sense
        return _NamedFrictionSolver(self.mechanism, self.friction, way, self.names)


class _NamedFrictionSolver(FrictionSolver):
    """Resolves parts, and names what acts on their links and what is found."""

    def __init__(self, mechanism, friction, direction, names):
        super().__init__(mechanism, friction, direction)
        self.names, self.laws = names, []

    def __call__(self, part, placement, loads, along):
        names = self.names
        with names.under(_forces_title(part)):
            loads, along = dict(loads), dict(along)
            for name in part.links:
                how = "but for what is told apart" if name in along else "with its inertia and what hangs on it"
                loads[name] = self._total(loads[name], name, f"acts on the {name}, {how}")
                if name in along:
                    words = f"what acts on the {name} along its guide besides"
                    along[name] = names.number(along[name], Symbol("F", "s", name), words, "N")
            names.reading, self.laws = not any(name in self.acting for name in part.pairs), []
            resolved = self._named(super().__call__(part, placement, loads, along), part)
            names.reading = True
            for law, amount in self.laws:
                size = number_or_zero(product(law.factor, size_of(law.kind, law.reaction(resolved))))
                names.satisfies(node_of(amount), node_of(size))
        return resolved

    def _total(self, wrench, name, words):
        return Wrench(
            self.names.vector(wrench.force, Symbol("F", "", name), f"force that {words}", "N"),
            self.names.number(wrench.moment, Symbol("M", "", name), f"moment that {words}", "N m"),
        )

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

    def _named(self, resolved, part):
        names, outputs = self.names, part.outputs
        reactions, scalars = dict(resolved.reactions), dict(resolved.scalars)
        for name, (unit, vector, text, *_) in outputs.items():
            words = f"{name.replace('_', ' ')}{', ' * bool(text)}{text}"
            if vector:
                symbol, words = Symbol("R", "", name), f"reaction {words}"
                reactions[name] = names.vector(reactions.get(name), symbol, words, unit, True, "within")
            else:
                scalars[name] = names.number(scalars.get(name), quantity_symbol(name), words, unit, True, "within")
        return Resolved(reactions, scalars, resolved.demands)


def _modules(state):
    """Modules that groups, cams, loads and functions of the user's come from."""
    parts = [*state.mechanism.groups, *(getattr(group, "cam", None) for group in state.mechanism.groups), *state.loads]
    values = [value for value in map(value_of, state.loads) if callable(value)]
    return {type(part).__module__ for part in parts} | {getattr(value, "__module__", "") for value in values}


def _derivative(order, words):
    return f"{ORDERS[order]} derivative by phi of the {words}" if order else words


def _joined(names):
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def _motion_title(group):
    joints = f"joint {_joined(group.joints)}" if group.joints else ""
    return (
        f"Motion of {_joined(list(group.links))}{', ' * bool(joints)}{joints}" if group.links else f"Motion of {joints}"
    )


def _forces_title(part):
    return f"Forces on {_joined(list(part.links))}" if part.links else "Forces"

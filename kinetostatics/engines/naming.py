"""Names of recorded numbers: what the protocol calls a number, else what the kernel's own line calls it.

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

from ..explain.symbols import Symbol
from .graph import INPUTS, Node

KERNELS = (
    "kinetostatics.machine",
    "kinetostatics.mechanics.energy_contact",
    "kinetostatics.mechanics.principal_points",
)
"""Modules whose local variables are names."""
GENERIC = tuple(f"kinetostatics.machine.{name}" for name in ("group", "friction", "placement"))
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

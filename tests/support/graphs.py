"""Random small graphs of every recorded operation with extreme numbers, and their errors beside proven bounds."""

from types import SimpleNamespace

import numpy as np

from kinetostatics.engines.error_bounds import Error
from kinetostatics.engines.graph import INPUTS, Graph, Node, needed
from kinetostatics.engines.program import Program
from kinetostatics.engines.simplify import SimplifiedGraph
from kinetostatics.numbers import arithmetic
from kinetostatics.numbers.arithmetic import NEGLIGIBLE_LENGTH, RELATIVE_OFFSET, UNIT_ROUNDOFF

PARAMETERS, UNITS = 5, 2
DESIGNS, ANGLES = 6, 3
DIGITS = 5000
"""Bits of exact values: sums of the largest and smallest numbers cancel."""
OPERATIONS = (
    *("+", "-", "*", "/", "+", "-", "*", "/", "square-root", "squares", "root", "guard", "apart"),
    *(
        "abs",
        "sign",
        "sin",
        "cos",
        "atan",
        "held",
        "total",
        "rest",
        "minus",
        "scaled",
        "beside one",
        "sum",
        "exp",
        "log",
    ),
)
CONSTANTS = 0.5, 2.0, -1.0, 1.0 / 3.0, 1e-30, 1e30, 5e-324
"""Plain numbers that others are multiplied by."""


def new_graph(count, kind=Graph):
    """A graph and its first parameters."""
    graph = kind()
    return graph, *map(graph.parameter, range(count))


def recipe(random, count):
    """Operations one after the other, each with the places of its arguments among what is there before."""
    steps, there = [], PARAMETERS + UNITS + 4
    for _ in range(count):
        kind = OPERATIONS[random.integers(len(OPERATIONS))]
        first = there - 1 - min(int(random.exponential(4.0)), there - 1)
        others = random.integers(there, size=3).tolist()
        steps.append((kind, first, *others))
        there += 1
    return steps


def recorded(steps, inputs):
    """All nodes of a recipe: inputs are parameters, units, the angle, its sine and cosine, and a row of a table."""
    values = list(inputs)
    for kind, *places in steps:
        unit = values[PARAMETERS + places[1] % UNITS]
        if kind == "rest":  # of lengths of a design alone
            places = [place % PARAMETERS for place in places[:2]] + places[2:]
        if kind == "sum":
            parts = [values[place % len(values)] for place in range(places[0], places[0] + 2 + places[1] % 5)]
            values.append(arithmetic.compensated_sum(*parts))
        elif kind == "scaled":
            values.append(values[places[0]] * CONSTANTS[places[1] % len(CONSTANTS)])
        else:
            values.append(_recorded(kind, *(values[place] for place in places), unit))
    return values


def _recorded(kind, one, other, third, fourth, unit):
    """An operation on recorded numbers, by what the kernels call."""
    two_parts = {
        "+": lambda: one + other,
        "-": lambda: one - other,
        "*": lambda: one * other,
        "/": lambda: one / other,
        "square-root": lambda: one.sqrt(),
        "squares": lambda: (one * one + other * other).sqrt(),
        "root": lambda: one.forgiving_root(unit),
        "guard": lambda: one.kept_off_zero(unit),
        "apart": lambda: one.moved_apart(unit),
        "total": lambda: arithmetic.compensated_sum(one, other, third),
        "rest": lambda: _with_rest(one, other, third),
        "minus": lambda: -one,
        "abs": lambda: abs(one),
        "atan": lambda: one.arctan(),
        "beside one": lambda: 1.0 + one,
    }
    return two_parts[kind]() if kind in two_parts else getattr(one, kind)()


def _with_rest(x, y, other):
    length = (x * x + y * y).sqrt()
    return arithmetic.compensated_sum(length, arithmetic.length_error(length, x, y), -other)


def exactly(nodes, inputs):
    """Values of recorded nodes as enclosures; None where there is none, NaN where it is not known whether there is.

    Nothing guards divisors and nothing is moved off zero; lengths have no rest. What cancels, as a root over itself
    that may truly be none, has no value here though bounds count it as one.
    """
    from flint import arb

    values = {}
    for node in nodes:
        kind, parts = (
            node.operation,
            [part for part in node.arguments if node.operation not in "+-" or not _moves(part)],
        )
        given = [values[part] if isinstance(part, Node) else arb(part) for part in parts]
        if kind in INPUTS:
            values[node] = inputs[kind, *node.arguments]
        elif kind == "rest":
            values[node] = arb(0)
        elif None in given[: 1 if kind in ("root", "divisor") else None]:
            values[node] = None
        elif not all(part.is_finite() for part in given):
            values[node] = arb("nan")
        else:
            values[node] = _EXACTLY[kind](*given)
    return values


def _moves(part):
    factors = part.arguments if isinstance(part, Node) and part.operation == "*" else (part,)
    return any(
        not isinstance(factor, Node) and factor in (RELATIVE_OFFSET, RELATIVE_OFFSET * NEGLIGIBLE_LENGTH)
        for factor in factors
    )


def _root(square, unit=None):
    """What is negative and too small for a double counts as zero: no sign is known of it."""
    return square.sqrt() if square > -(2.0**-900) else None


_EXACTLY = {
    "+": lambda *parts: sum(parts),
    "total": lambda *parts: sum(parts),
    "-": lambda one, other=None: -one if other is None else one - other,
    "*": lambda one, other: one * other,
    "/": lambda one, other: None if other.is_zero() else one / other,
    "sqrt": _root,
    "root": _root,
    "divisor": lambda one, unit: one,
    "held": lambda one: one,
    "abs": abs,
    "sign": lambda one: one / 0 if one.contains(0) else one.sgn(),
    "sin": lambda one: one.sin(),
    "cos": lambda one: one.cos(),
    "atan": lambda one: one.atan(),
    "exp": lambda one: one.exp(),
    "log": lambda one: one.log() if one > 0 else None,
}


def numbers(random, count):
    """Numbers of every size that a scene may hold, many of them alike, zero or such that sums and products vanish."""
    kinds = random.integers(8, size=count)
    sizes = [
        random.uniform(0.1, 2.0, count),
        10.0 ** random.uniform(-30, 30, count),
        10.0 ** random.uniform(-323, -150, count),
        10.0 ** random.uniform(-170, -140, count),
        2.0 ** random.integers(-60, 60, count),
        np.ones(count) + UNIT_ROUNDOFF * random.integers(-4, 40, count),
        random.choice([0.0, -0.0, 1.0, 0.5, 2.0**100, 5e-324, 2.0**-54, 2.0**-511], count),
        10.0 ** random.uniform(-160, -100, count),
    ]
    return np.choose(kinds, sizes) * random.choice([-1.0, 1.0, 1.0], count)


class Case:
    """A random recipe of less than so many operations, recorded; its values, bounds and exact values.

    Attributes
    ----------
    program : Program
    """

    def __init__(self, seed, most=16):
        self._random = random = np.random.default_rng(seed)
        graph = (SimplifiedGraph if random.random() < 0.7 else Graph)()
        self.steps = recipe(random, int(random.integers(3, most)))
        angle = graph.angle()
        parameters = [graph.parameter(place) for place in range(PARAMETERS + UNITS)]
        row = graph.row(0)
        self._off_row = float(random.choice([0.0, 1.0, 2.0**30]))
        errors = graph.row(1)
        inputs = {row: lambda bounds: Error(0.0, errors)} if self._off_row else {}
        values = recorded(self.steps, [*parameters, angle, angle.sin(), angle.cos(), row])
        self.places = sorted({len(values) - 1, *random.integers(len(values) - len(self.steps), len(values), size=2)})
        recording = SimpleNamespace(graph=graph, inputs=inputs, tables=(), parameters=parameters)
        self.program = Program(recording, tuple(values[place] for place in self.places))

    def wrong(self, ways):
        """By way, program and how it is run: every value that is off by more than its bound."""
        random = self._random
        table = numbers(random, DESIGNS * (PARAMETERS + UNITS)).reshape(DESIGNS, -1)
        table[:, PARAMETERS:] = abs(table[:, PARAMETERS:])
        angle = random.choice([0.0, np.pi / 2, np.pi, 1.0, 0.3, 1e-9, 5.0, -2.0], (DESIGNS, ANGLES))
        rows = [numbers(random, DESIGNS * ANGLES).reshape(DESIGNS, ANGLES), np.full((DESIGNS, ANGLES), self._off_row)]
        given = [column[:, None] for column in table.T]
        exact = [
            [self._exact(table[design], angle[design, place], rows[0][design, place]) for place in range(ANGLES)]
            for design in range(DESIGNS)
        ]
        found = []
        for name, way in ways.items():
            with np.errstate(all="ignore"):
                results = way(self.program, angle, given, rows)
            count = len(self.places)
            for place in np.ndindex(DESIGNS, ANGLES):
                for output in range(count):
                    value, bound = (results[part][place] for part in (output, output + count))
                    truth = exact[place[0]][place[1]][output]
                    if _is_off(value, float(bound), truth):
                        found.append((name, self.places[output], place, value, bound, truth, table[place[0]].tolist()))
        return found

    def _exact(self, parameters, angle, row):
        from flint import arb, ctx

        ctx.prec, before = DIGITS, ctx.prec
        try:
            off = arb(self._off_row) * arb(UNIT_ROUNDOFF) * arb(self._random.choice([-1, 1]).item())
            inputs = {("parameter", place): arb(number) for place, number in enumerate(parameters.tolist())}
            inputs |= {("angle",): arb(float(angle)), ("table", 0): arb(float(row)) + off}
            values = exactly(needed(self.program.outputs), inputs)
            return [values[output] if isinstance(output, Node) else arb(output) for output in self.program.outputs]
        finally:
            ctx.prec = before


def _is_off(value, bound, truth):
    """Whether a value is off by more than its bound."""
    from flint import arb, ctx

    if not np.isfinite(value):  # which has no bound that users see
        return False
    if not np.isfinite(bound):
        return bound < 0.0
    if truth is None:
        return True
    ctx.prec, before = DIGITS, ctx.prec
    try:
        return bound < 0.0 or abs(arb(float(value)) - truth) > arb(bound)
    finally:
        ctx.prec = before


WAYS = {
    "numpy": lambda program, *given: program.bounded().by_numpy(*given, given[0].shape),
    "one by one": lambda program, *given: _one_by_one(program.bounded(), *given),
    "tight": lambda program, *given: program.bounded(tight=True).by_numpy(*given, given[0].shape),
    "tight, one by one": lambda program, *given: _one_by_one(program.bounded(tight=True), *given),
}
COMPILED = {
    "compiled": lambda program, *given: program.bounded().by_loop(*given, given[0].shape),
    "tight, compiled": lambda program, *given: program.bounded(tight=True).by_loop(*given, given[0].shape),
}


def _one_by_one(program, angle, given, rows):
    """Each design by itself, as a user's call has it."""
    designs = [
        program.by_numpy(
            angle[design], [float(number[design, 0]) for number in given], [row[design] for row in rows], (ANGLES,)
        )
        for design in range(len(angle))
    ]
    return np.moveaxis(np.array(designs), 0, 1)

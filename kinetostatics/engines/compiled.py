"""Compiled programs: the recorded arithmetic of the kernels as one loop over designs and crank angles, by numba.

`tracing` turns the kernels of any mechanism into straight-line arithmetic; here that becomes the source of a loop, is
compiled once, and kept on disk for the next session. Sines and cosines of the crank angle come first, in a loop of
their own, and are shared by all designs; what is left has no calls, so the compiler vectorises it.
"""

import importlib
import importlib.util
import math
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields
from functools import cache, cached_property, lru_cache
from types import ModuleType
from typing import Any

import numpy as np

from ..errors import MissingLibraryError, NotGivenError
from ..machine.loads import Gravity, ProcessForce, Spring
from ..mechanics import assembly
from ..numbers.elementary import ROUNDING, read_only
from ..solution.solution import Solution, is_given
from .machine_code import load
from .tracing import BY_ANGLE, Node, Trace, trace

SHARE = 100_000
"""Values over designs and angles that are worth a thread of their own."""
GIVEN, FILLED = "Array(float64, {}, 'C', True)", "Array(float64, {}, 'C')"
"""Arrays of so many axes that a loop reads, which may be locked, and that it writes, as numba names them."""
TURN = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import cos, sin

from numba import njit


@njit("void({", ".join([GIVEN, FILLED, FILLED]).format(1, 1, 1)})", nogil=True, cache=KEEP)
def shared(angle, sine, cosine):
    for i in range(angle.size):
        cosine[i] = cos(angle[i])
        sine[i] = sin(angle[i])
'''
HEADER = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import atan, cos, inf, nan, sin, sqrt

from numba import njit

options = dict(error_model="numpy", nogil=True)


@njit(**options)
def root(square, unit):
    return sqrt(max(square, 0.0)) if square >= {-ROUNDING!r} * unit else nan


@njit(**options)
def divisor(root, unit):
    return root if root != root else max(root, unit)


@njit("void({", ".join([GIVEN] * 5 + [FILLED]).format(2, 2, 2, 2, 3, 3)})", cache=KEEP, **options)
def loop(angle, sine, cosine, parameters, tables, results):
    for design in range(parameters.shape[0]):
        first = design * (angle.shape[0] > 1)
        table = design * (tables.shape[1] > 1)
'''


def source(trace: Trace) -> str:
    """Source of a module with the loops that compute the outputs of a trace.

    ``loop(angle, sine, cosine, parameters, tables, results)`` takes angles (1 or designs, N) with their sines and
    cosines, parameters (designs, P), tables (T, 1 or designs, N), and fills results (designs, outputs, N).
    """
    by_design = [f"{_name(node)} = {_expression(node)}" for node in trace.nodes if node.varies < BY_ANGLE]
    rows = [f"row_{number} = results[design, {number}]" for number in range(len(trace.outputs))]
    by_angle = [
        f"{_name(node)} = {_expression(node)}"
        for node in trace.nodes
        if node.varies == BY_ANGLE and node.operation != "angle"
    ]
    stores = [f"row_{number}[i] = {_name(part)}" for number, part in enumerate(trace.outputs)]
    return (
        HEADER
        + "".join(f"        {line}\n" for line in by_design + rows)
        + "        for i in range(angle.shape[1]):\n"
        + "".join(f"            {line}\n" for line in by_angle + stores)
    )


def _name(part):
    if not isinstance(part, Node):
        return repr(part)
    return "angle[first, i]" if part.operation == "angle" else f"v{part.index}"


def _expression(node):
    kind = node.operation
    if kind == "parameter":
        return f"parameters[design, {node.arguments[0]}]"
    if kind == "table":
        return f"tables[{node.arguments[0]}, table, i]"
    if kind in ("sin", "cos") and node.arguments[0].operation == "angle":
        return f"{'sine' if kind == 'sin' else 'cosine'}[first, i]"
    names = [_name(part) for part in node.arguments]
    if kind in ("+", "-", "*", "/"):
        return f" {kind} ".join(names) if len(names) == 2 else f"{kind}{names[0]}"
    return f"{kind}({', '.join(names)})"


@dataclass(frozen=True, eq=False)
class Program:
    """A compiled loop for some quantities of one mechanism or a batch of designs; made by `program`.

    Attributes
    ----------
    trace : Trace
    parameters : array (designs, P)
    shape : tuple
        Batch shape of the designs.
    """

    trace: Trace
    parameters: Any
    shape: tuple[int, ...]
    _module: ModuleType

    def __call__(self, angle, tables=None):
        """Results (outputs, designs, N) at crank angles (N,) or (designs, N), rad."""
        angle = np.array(angle, dtype=float, ndmin=2, order="C")
        if tables is None:
            tables = np.empty((0, 1, angle.shape[1]))
        return self.at(angle, *self.turn(angle), tables)

    def tabulated(self, solution):
        """What NumPy must compute beforehand at the crank angles of a solution, (T, 1 or designs, N)."""
        if not self.trace.tables:
            return np.empty((0, 1, np.shape(np.atleast_1d(solution.crank_angle))[-1]))
        rows = [row for compute in self.trace.tables for row in compute(solution)]
        shape = np.broadcast_shapes(np.shape(np.atleast_1d(solution.crank_angle)), *map(np.shape, rows))
        shape = (*self.shape, shape[-1]) if len(shape) > 1 else shape
        tables = np.array([np.broadcast_to(row, shape) for row in rows], dtype=float)
        return tables.reshape(len(rows), math.prod(shape[:-1]), shape[-1])

    def turn(self, angle) -> tuple[Any, Any]:
        """Sines and cosines of crank angles (1 or designs, N), which designs may share."""
        sine, cosine = np.empty(angle.shape), np.empty(angle.shape)
        _loaded(TURN).shared(angle.ravel(), sine.ravel(), cosine.ravel())
        return sine, cosine

    def at(self, angle, sine, cosine, tables, parameters=None, results=None):
        """Results (outputs, designs, N) from angles, their sines and cosines (1 or designs, N), and tables.

        Other parameters (designs, P) may be given, some rows of its own for instance, and memory for the results
        (designs, outputs, N) that is used again from call to call.
        """
        parameters = self.parameters if parameters is None else parameters
        designs, angles = len(parameters), angle.shape[1]
        fits = len(angle) in (1, designs) and tables.shape[1] in (1, designs) and tables.shape[2] == angles
        if not fits or len(tables) < self.trace.rows:
            raise ValueError(
                f"angles {angle.shape} and tables {tables.shape} do not fit {designs} designs and {self.trace.rows} "
                "tabulated values: make tables by `tabulated` from a solution at these angles"
            )
        shape = (designs, len(self.trace.outputs), angles)
        if results is None:
            results = np.empty(shape)
        elif results.shape != shape:
            raise ValueError(f"memory for results {shape} is needed, not {results.shape}")
        pieces = designs * angles // SHARE
        if pieces > 1:
            pieces = min(pieces, cores(), designs if designs > 1 else angles)
        if pieces > 1:
            self._in_pieces(pieces, angle, sine, cosine, tables, parameters, results)
        else:
            self._module.loop(angle, sine, cosine, parameters, tables, results)
        return results.swapaxes(0, 1)

    def _in_pieces(self, pieces, angle, sine, cosine, tables, parameters, results):
        """Fill results (designs, outputs, N) with a thread for each of some designs, or some angles of a single one."""
        designs, angles = len(parameters), angle.shape[1]
        edges = np.linspace(0, designs if designs > 1 else angles, pieces + 1, dtype=int)

        def piece(start, stop):
            given = [_part(array, start, stop, designs) for array in (angle, sine, cosine, tables)]
            if designs > 1:
                self._module.loop(*given[:3], parameters[start:stop], given[3], results[start:stop])
            else:
                found = np.empty((1, results.shape[1], stop - start))
                self._module.loop(*given[:3], parameters, given[3], found)
                results[..., start:stop] = found

        with ThreadPoolExecutor(pieces) as threads:
            list(threads.map(piece, edges[:-1], edges[1:]))


def program(solution, quantities, sizes=False) -> Program:
    """Loop for some quantities of a solution, compiled or taken from disk.

    Parameters
    ----------
    solution : Solution
        Its mechanism, drive and loads, single or a batch; of its crank angles only the batch shape.
    quantities : sequence of str
        As for `quantities.components`.
    sizes : bool
        Whether the magnitude of a vector is wanted, not its components.

    Raises
    ------
    MissingLibraryError
        numba is not installed.
    NotGivenError
        A group or load of the user's own cannot be recorded.
    """
    try:
        recorded = trace(solution, quantities, sizes)
    except (TypeError, AttributeError) as error:
        raise NotGivenError(
            f"the compiled engine cannot take {solution.mechanism.name}: a group or load of it does more than "
            f'arithmetic with sin, cos and sqrt of `elementary` ({error}); use engine="numpy"'
        ) from error
    shape = solution.shape[:-1]
    designs = [np.broadcast_to(value, (*shape, 1)).ravel() for value in recorded.parameters]
    parameters = np.array(designs, dtype=float).reshape(len(designs), -1).T.copy()
    return Program(recorded, parameters, shape, _loaded(source(recorded)))


def _part(array, start, stop, designs):
    """Columns of an array (..., designs, N) for some designs, or for some angles of a single one."""
    if designs == 1:
        return np.ascontiguousarray(array[..., start:stop])
    return array if array.shape[-2] == 1 else np.ascontiguousarray(array[..., start:stop, :])


def cores():
    """Number of cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _problem():
    """Why numba cannot be used, or None."""
    if importlib.util.find_spec("numba") is None:
        return "is not installed"
    try:
        importlib.import_module("numba")
    except ImportError as error:  # installed beside a NumPy that it does not know, for instance
        return f"cannot be imported: {error}"
    return None


def available():
    """Whether numba is installed, and can be imported."""
    return _problem() is None


def require():
    """Raise `MissingLibraryError` unless numba is available."""
    if not available():
        raise MissingLibraryError(
            f'the compiled engine needs numba, which {_problem()}: pip install "kinetostatics[fast]"; engine="numpy" '
            "works without"
        )


@cache
def _loaded(text):
    """Module of the source, its machine code kept on disk."""
    require()
    return load(text, keep=True)


@dataclass(frozen=True, eq=False, repr=False)
class CompiledSolution(Solution):
    """A solution whose forces, torque and shaking come from compiled loops; motion is NumPy's.

    Of a small problem one loop computes all forces at once, of a large one each quantity has its own when asked for.
    """

    def _surely_closes(self):
        return assembly.surely_well(self, self._kept("closure"))

    @property
    def reactions(self):
        return self._names[0]

    @property
    def scalars(self):
        return self._names[1]

    def reaction(self, joint):
        self._look_up("reaction", joint, self.reactions)
        return self._kept(joint)

    def scalar(self, name):
        self._look_up("quantity", name, self.scalars)
        return self._kept(name)[0]

    @property
    def shaking_force(self):
        return self._kept("shaking_force")

    @property
    def shaking_moment(self):
        return self._kept("shaking_moment")[0]

    @property
    def balancing_torque_by_power(self):
        return self._kept("balancing_torque_by_power")[0]

    @property
    def _unchanging(self):
        """Whether nothing of it can change behind our back: all plain numbers, no arrays, no functions."""
        drive = isinstance(self.crank_speed, float | int) and isinstance(self.crank_acceleration, float | int)
        plain = (Gravity, Spring, ProcessForce)
        fixed = all(isinstance(item, plain) and not callable(getattr(item, "force", None)) for item in self.loads)
        return drive and fixed and self.mechanism.batch == () and all(item.batch == () for item in self.loads)

    @cached_property
    def _found(self):
        return {}

    @cached_property
    def _names(self):
        return _names(self.mechanism)

    def _look_up(self, kind, name, table):
        return super()._look_up(kind, name, dict.fromkeys(table) if isinstance(table, tuple) else table)

    def _kept(self, quantity):
        if quantity not in self._found:
            together = ("closure", *self.reactions, *self.scalars)
            small = math.prod(self.shape) < SHARE and quantity in together
            self._run(together if small else (quantity,))
        return self._found[quantity]

    def _run(self, quantities):
        made = (_program if self._unchanging else _program.__wrapped__)(
            self.mechanism, self.crank_speed, self.crank_acceleration, self.loads, self.shape[:-1], quantities
        )
        angle = self.crank_angle
        if math.prod(angle.shape[:-1]) > 1:
            angle = np.broadcast_to(angle, (*self.shape[:-1], angle.shape[-1])).reshape(-1, angle.shape[-1])
        rows = read_only(made(angle, made.tabulated(self)).reshape(-1, *self.shape))
        if not all(map(is_given, self.loads)) and np.isnan(rows).any():
            self._pushes  # noqa: B018  raises an error if a load is no number where the mechanism closes
        edges = np.cumsum(made.trace.widths)
        for name, stop, width in zip(quantities, edges, made.trace.widths, strict=True):
            self._found[name] = rows[stop - width : stop]


@lru_cache(maxsize=64)
def _program(mechanism, crank_speed, crank_acceleration, loads, shape, quantities):
    given = Solution(mechanism, np.zeros((*shape, 1)), crank_speed, crank_acceleration, loads)
    return program(given, quantities)


@lru_cache(maxsize=64)
def _names(mechanism):
    """Names of the reactions, and of the other forces and moments, of a mechanism."""
    found = Solution(mechanism, np.zeros(1), 1.0, 0.0)
    return found.reactions, found.scalars


def made_of(solution) -> CompiledSolution:
    """The solution on the compiled engine.

    Raises
    ------
    NotGivenError
        A group or load of the user's own cannot be recorded.
    """
    given = {field.name: getattr(solution, field.name) for field in fields(Solution)}
    made = CompiledSolution(**given)
    made._kept("closure")
    return made

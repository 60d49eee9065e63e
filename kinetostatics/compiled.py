"""Compiled programs: the recorded arithmetic of the kernels as one loop over designs and crank angles, by numba.

`tracing` turns the kernels of any mechanism into straight-line arithmetic; here that becomes the source of a loop, is
compiled once, and kept on disk for the next session. Sines and cosines of the crank angle come first, in a loop of
their own, and are shared by all designs; what is left has no calls, so the compiler vectorises it.
"""

import hashlib
import importlib.util
import math
import os
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from .elementary import ROUNDING, TINY
from .errors import MissingLibraryError
from .files import written_whole
from .tracing import BY_ANGLE, Node, Trace, trace

HEADER = f'''"""Written by kinetostatics; may be deleted at any time."""

from math import atan, cos, nan, sin, sqrt

from numba import njit

options = dict(error_model="numpy", nogil=True, cache=True)


@njit(**options)
def shared(angle, sine, cosine):
    for i in range(angle.size):
        cosine[i] = cos(angle[i])
        sine[i] = sin(angle[i])


@njit(**options)
def root(square, unit):
    return sqrt(max(square, {TINY!r} * unit)) if square >= {-ROUNDING!r} * unit else nan


@njit(**options)
def loop(angle, sine, cosine, parameters, tables, results):
    for design in range(parameters.shape[0]):
        first = design * (angle.shape[0] > 1)
        table = design * (tables.shape[1] > 1)
'''


def source(trace: Trace) -> str:
    """Source of a module with the loops that compute the outputs of a trace.

    ``loop(angle, sine, cosine, parameters, tables, results)`` takes angles (1 or designs, N) with their sines and
    cosines, parameters (designs, P), tables (T, 1 or designs, N), and fills results (outputs, designs, N).
    """
    by_design = [f"{_name(node)} = {_expression(node)}" for node in trace.nodes if node.varies < BY_ANGLE]
    rows = [f"row_{number} = results[{number}, design]" for number in range(len(trace.outputs))]
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
        return repr(part) if math.isfinite(part) else "nan"
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
        angle = np.array(angle, dtype=float, ndmin=2, order="C")  # a copy: numba would compile anew for a locked one
        if tables is None:
            tables = np.empty((0, 1, angle.shape[1]))
        return self.at(angle, *self.turn(angle), tables)

    def tabulated(self, solution):
        """What NumPy must compute beforehand at the crank angles of a solution, (T, 1 or designs, N)."""
        rows = [row for compute in self.trace.tables for row in compute(solution)]
        shape = np.broadcast_shapes(np.shape(np.atleast_1d(solution.crank_angle)), *map(np.shape, rows))
        shape = (*self.shape, shape[-1]) if len(shape) > 1 else shape
        tables = np.array([np.broadcast_to(row, shape) for row in rows], dtype=float)
        return tables.reshape(len(rows), math.prod(shape[:-1]), shape[-1])

    def turn(self, angle):
        """Sines and cosines of crank angles (1 or designs, N), which designs may share."""
        sine, cosine = np.empty(angle.shape), np.empty(angle.shape)
        self._module.shared(angle.ravel(), sine.ravel(), cosine.ravel())
        return sine, cosine

    def at(self, angle, sine, cosine, tables):
        """Results (outputs, designs, N) from angles, their sines and cosines (1 or designs, N), and tables."""
        designs = len(self.parameters)
        fits = len(angle) in (1, designs) and tables.shape[1] in (1, designs) and tables.shape[2] == angle.shape[1]
        if not fits or len(tables) < self.trace.rows:
            raise ValueError(
                f"angles {angle.shape} and tables {tables.shape} do not fit {designs} designs and {self.trace.rows} "
                "tabulated values: make tables by `tabulated` from a solution at these angles"
            )
        results = np.empty((len(self.trace.outputs), designs, angle.shape[1]))
        self._module.loop(angle, sine, cosine, self.parameters, tables, results)
        return results


def program(solution, quantities) -> Program:
    """Loop for some quantities of a solution, compiled or taken from disk.

    Parameters
    ----------
    solution : Solution
        Its mechanism, drive and loads, single or a batch; of its crank angles only the batch shape.
    quantities : sequence of str
        As for `quantities.components`.

    Raises
    ------
    MissingLibraryError
        numba is not installed.
    """
    recorded = trace(solution, quantities)
    shape = solution.shape[:-1]
    designs = [np.broadcast_to(value, (*shape, 1)).ravel() for value in recorded.parameters]
    parameters = np.array(designs, dtype=float).reshape(len(designs), -1).T.copy()
    return Program(recorded, parameters, shape, _loaded(source(recorded)))


@cache
def _loaded(text):
    """Module of the source, from the folder where numba keeps its machine code too."""
    if importlib.util.find_spec("numba") is None:
        raise MissingLibraryError(
            'the compiled engine needs numba: pip install "kinetostatics[fast]"; engine="numpy" works without'
        )
    name = f"kinetostatics_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    path = _folder() / f"{name}.py"
    if not path.exists():
        with written_whole(path) as temporary:
            Path(temporary).write_text(text, encoding="utf-8")
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _folder():
    """Where compiled programs are kept: KINETOSTATICS_CACHE, else the user's cache folder."""
    from platformdirs import user_cache_path

    return Path(os.environ.get("KINETOSTATICS_CACHE") or user_cache_path("kinetostatics"))

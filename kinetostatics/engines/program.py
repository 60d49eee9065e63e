"""Programs: one recording for all scenes of a structure, run on plain numbers, by NumPy, or as a compiled loop.

`program_of` caches programs by structure; `plausibility_test` is a fast test of a scene's numbers, compiled once per
structure: only scenes that fail get the full test.
"""

import math
import threading
from typing import Any

import numpy as np

from ..errors import NotGivenError, QuantityError
from ..machine import plausibility
from ..machine.links import present
from ..numbers.checks.rules import MAX_LENGTH_IN_LINKS
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import FLOATS, Leaves
from . import numba_backend
from .codegen import ARRAYS, BY_DESIGN, PLAIN, buffered_source, compile_line, line_source, loop_source
from .derivatives import gradients
from .error_bounds import OWN, running_bounds, tight_bounds
from .graph import needed, operations
from .numba_backend import keep_for_same_angles, load_compiled, numba_available
from .record import Recorder, record

MAX_PLAIN_ANGLES = 12
"""Largest number of crank angles computed one by one on plain numbers."""
MIN_LONG_OPERATIONS, MIN_COMPILED_OPERATIONS = 300, 20_000_000
"""Total number of operations after which a program is compiled even for few angles."""
BUFFER_VALUES = 2048
"""Values in one buffer of array operations."""


class Program:
    """Outputs of a `Recording`, or of other nodes of its graph, ready to run."""

    def __init__(self, recording, outputs=None):
        self.recording = recording
        self.outputs = recording.outputs if outputs is None else outputs
        self._kept: dict[Any, Any] = {}
        self._computed, self._operations = 0.0, operations(self.outputs)

    def kept(self, key, make) -> Any:
        """Result of ``make()``, computed once for a key."""
        if key not in self._kept:
            self._kept[key] = make()
        return self._kept[key]

    def by_parameters(self, places):
        """Program of all outputs, followed by their derivatives by the parameters at some places.

        `NotGivenError` if an output depends on code of the user that could not be recorded.
        """
        if self.unrecorded:
            raise NotGivenError(
                f"no derivatives exist: {', '.join(self.unrecorded)} does more than arithmetic with "
                "sin, cos and sqrt of `arithmetic`, so the dependence of its values on the parameters is not recorded"
            )
        parameters = [self.recording.parameters[place] for place in places]
        return self.kept(places, lambda: self._with(*gradients(self.recording.graph, self.outputs, parameters)))

    def _with(self, *more):
        """Program of all outputs, followed by others."""
        return Program(self.recording, (*self.outputs, *(part for row in more for part in row)))

    def bounded(self, tight=False, arithmetic=OWN):
        """Program of all outputs and a proven bound on the error of each, infinite or NaN without a bound.

        Tight bounds may be infinite where running bounds are finite. `NotGivenError` if an output depends on user code
        that could not be recorded, or on a cam made of samples.
        """
        bounds = tight_bounds if tight else running_bounds
        inputs = self.recording.graph, self.recording.inputs, self.outputs, arithmetic
        return self.kept((tight, arithmetic), lambda: self._with(bounds(*inputs)))

    @cached_property
    def unrecorded(self):
        """Names of the user's code that outputs depend on and that could not be recorded."""
        tables = (table for table in self.recording.tables if not self._rows_needed.isdisjoint(table.rows))
        return tuple(table.user_code for table in tables if table.user_code)

    @cached_property
    def _plain(self):
        return compile_line(line_source(self.outputs), PLAIN)

    @cached_property
    def buffered(self):
        """Array functions for one design and for a batch, and their count of buffers."""
        source, count = buffered_source(self.outputs)
        code = compile(source, "<program>", "exec")  # takes longer than the rest
        return [compile_line(code, ARRAYS | by_design) for by_design in (PLAIN, BY_DESIGN)], count

    @cached_property
    def loop(self):
        """The compiled loop, see `codegen.loop_source`."""
        return load_compiled(loop_source(self.outputs)).loop

    @cached_property
    def _short_loop(self):
        """A compiled loop that rounds every operation, as plain numbers do."""
        return load_compiled(loop_source(self.outputs, fuse=False)).loop

    def rows(self, state, leaves):
        """Rows of the tables at the crank angles of a `Dynamics` with its leaves; 0 if no output needs them."""
        rows: list[Any] = []
        for table in self.recording.tables:
            rows += table.filled(state, leaves, self._rows_needed)
        return rows

    @cached_property
    def _rows_needed(self):
        return {node.arguments[0] for node in needed(self.outputs) if node.operation == "table"}

    def run(self, state, leaves, compiled=False):
        """Outputs (outputs, *shape) of a `Dynamics` with its leaves."""
        angle, shape = state.crank_angle, state.shape
        count = math.prod(shape)
        if len(shape) < 2 and count <= MAX_PLAIN_ANGLES and not self.recording.tables:
            if compiled and self._has_paid(count):
                return self.by_loop(angle, leaves.numbers, (), shape, self._short_loop, _sines)
            return self._by_numbers(angle, leaves.numbers, shape)
        run = self.by_loop if compiled else self.by_numpy
        if angle.shape[-1:] != state.shape[-1:]:  # a single angle, and tables over more
            angle = np.broadcast_to(angle, angle.shape[:-1] + state.shape[-1:])
        return run(angle, leaves.numbers, self.rows(state, leaves), shape)

    def by_numpy(self, angle, numbers, rows, shape, turn=None):
        """Outputs (outputs, *shape), in the dtype of the crank angles (..., N).

        Numbers may be arrays (..., 1), rows of tables (..., N); `turn` has known sines and cosines of the crank angles.
        """
        if not shape:
            return self.by_numpy(np.reshape(angle, 1), numbers, [np.reshape(row, 1) for row in rows], (1,))[:, 0]
        (single, batch), count = self.buffered
        results = np.empty((len(self.outputs), *shape), angle.dtype)
        with np.errstate(all="ignore"):
            sine, cosine = turn or numpy_sines(angle)
            if len(shape) == 1:
                size = max(1, count * min(shape[0], BUFFER_VALUES))
                if not hasattr(_memory, "held") or _memory.held.size < size:
                    _memory.held = np.empty(size)
                try:
                    for start in range(0, shape[0], BUFFER_VALUES):
                        part = slice(start, start + BUFFER_VALUES)
                        given = [row[part] if np.size(row) > 1 else row for row in rows]
                        own = results[:, part]
                        free = _memory.held.view(own.dtype)[: count * own.shape[1]].reshape(count, own.shape[1])
                        single(angle[part], sine[part], cosine[part], numbers, given, free, own)
                    return results
                except ZeroDivisionError:  # plain numbers raise it, NumPy numbers give infinity or NaN
                    numbers = list(map(np.float64, numbers))
            batch(angle, sine, cosine, numbers, rows, np.empty((count, *shape), results.dtype), results)
        return results

    def _has_paid(self, count):
        """Whether all computations of few angles so far took longer than a compilation.

        From then on the loop computes them, with the same bits except for the arc tangent.
        """
        if self._operations < MIN_LONG_OPERATIONS:
            return False
        self._computed += count * self._operations
        if self._computed > MIN_COMPILED_OPERATIONS and not numba_available():
            self._computed = -math.inf
        return self._computed > MIN_COMPILED_OPERATIONS

    def at_one(self, angle, numbers, compiled):
        """Outputs at one crank angle, a list of floats; for programs without tables."""
        if compiled and self._has_paid(1):
            return self.by_loop(np.array([angle]), numbers, (), (1,), self._short_loop, _sines)[:, 0].tolist()
        return self._at(_plain_numbers(numbers), angle, float(np.sin(angle)), float(np.cos(angle)))

    def _by_numbers(self, angle, numbers, shape):
        angle, numbers = angle.ravel(), _plain_numbers(numbers)
        given = zip(angle.tolist(), np.sin(angle).tolist(), np.cos(angle).tolist(), strict=True)
        return np.array([self._at(numbers, *one) for one in given]).T.reshape(-1, *shape)

    def _at(self, numbers, angle, sine, cosine):
        try:
            return self._plain(angle, sine, cosine, numbers, ())
        except (ZeroDivisionError, OverflowError):  # arrays give infinity or NaN
            return self.by_numpy(np.array([angle]), numbers, (), (1,))[:, 0].tolist()

    def by_loop(self, angle, numbers, rows, shape, loop=None, sines=numba_backend.compiled_sines):
        """Outputs (outputs, *shape), as `by_numpy`, by a compiled loop in the dtype of the crank angles.

        ``sines(angle)`` returns sine and cosine of crank angles (1 or designs, N).
        """
        shape_of_rows = shape or (1,)
        angle = numba_backend.angle_rows(angle, shape_of_rows)
        parameters = numba_backend.parameter_table(_plain_numbers(numbers) if len(shape) < 2 else numbers, shape[:-1])
        tables = numba_backend.row_table(rows, shape_of_rows)
        if angle.dtype != float:
            parameters, tables = (array.astype(angle.dtype) for array in (parameters, tables))
        results = np.empty((len(parameters), len(self.outputs), angle.shape[1]), angle.dtype)
        sine, cosine = sines(angle)
        numba_backend.run_loop(loop or self.loop, angle, sine, cosine, parameters, tables, results)
        return results.swapaxes(0, 1).reshape(-1, *shape)


def _plain_numbers(numbers):
    if FLOATS.issuperset(map(type, numbers)):
        return numbers
    return [number.item() if type(number) is np.ndarray else number for number in numbers]


def _sines(angle):
    return np.sin(angle), np.cos(angle)


numpy_sines = keep_for_same_angles(_sines)


_memory = threading.local()
"""Scratch buffers, reused in each thread; allocating costs more than the computation."""


# Programs cached by structure


def program_of(state, quantities=None, sizes=False, lasting=False) -> tuple[Program, Leaves]:
    """Program of some quantities for the structure of a `Dynamics`, and the leaves of that `Dynamics`.

    It is recorded at the first call for a structure. Scenes with objects that may change unnoticed are recorded at
    every call, unless `lasting` refuses them. `quantities` and `sizes` are as in `record.record`. `NotGivenError` if a
    user's group or load cannot be recorded.
    """
    structure, leaves = state.apart
    if not leaves.lasting or state.placement_method is not None:
        if lasting:
            raise NotGivenError(f"{state.mechanism.name} has parts that may change unnoticed, so no recording is valid")
        return _recorded(state, structure, quantities, sizes), leaves
    known = state.kind.known
    found = known.get((quantities, sizes))
    if found is None:
        try:
            found = _recorded(state, structure, quantities, sizes)
        except NotGivenError as refusal:
            found = refusal
        known[quantities, sizes] = found
    if isinstance(found, NotGivenError):
        raise found
    return found, leaves


def _recorded(state, structure, quantities, sizes):
    try:
        return Program(record(structure, quantities, sizes, state.placement_method))
    except QuantityError:
        raise
    except (TypeError, AttributeError) as error:
        raise NotGivenError(
            f"the compiled engine cannot run {state.mechanism.name}: a group or load of it does more than arithmetic "
            f'with sin, cos and sqrt of `arithmetic` ({error}); use engine="numpy"'
        ) from error


def plausibility_test(kind, judged=()):
    """Function of a scene's numbers that returns its extent over its shortest length, and whether hints may be due.

    None if the scene cannot be recorded. `judged` are pairs of a leaf and its plausible range, a
    `checks.PlausibleRange`.
    """
    outputs = []

    def noted(value):
        outputs.append(value)
        return f"v[{len(outputs) - 1}]"

    try:
        scene = Recorder(kind.structure).recorded
        extent, reaches, bars, bodies, turning, arms = plausibility.compared_sizes(scene.mechanism)
    except (TypeError, AttributeError):
        return None
    odd, slender = [], 12.0 * plausibility.SMALL_INERTIA_FACTOR
    for leaf, usual in judged:
        if bars or not usual.in_links:
            most, least = (f"{limit!r}{' * longest' * usual.in_links}" for limit in (usual.most, usual.least))
            odd.append(f"not -{most} <= numbers[{leaf}] <= {most}")
            odd += [f"abs(numbers[{leaf}]) < {least}"] if usual.least else []
    if bars:
        odd.append(f"not extent < {MAX_LENGTH_IN_LINKS} * longest")
        odd.append(f"longest > {plausibility.MAX_LENGTH}")
        odd.append(f"longest > {plausibility.MAX_LENGTH_RATIO} * shortest")
    odd += [
        f"{noted(inertia)} > {plausibility.LARGE_INERTIA_FACTOR} * {noted(mass)} * {noted(long)} ** 2"
        for inertia, mass, long in turning
    ]
    if present(scene.crank_speed) is not None and scene.mechanism.crank.length is not None:
        odd += [
            f"abs({noted(scene.crank_speed)}) * {noted(scene.mechanism.crank.length)} > {plausibility.MAX_PIN_SPEED}"
        ]
    odd += [
        f"0.0 < {noted(inertia)} < max(thin, {4.0 / slender} * {noted(centre)} ** 2) * {noted(mass)}"
        for inertia, mass, centre in bodies
    ]
    odd += ["True" for _ in plausibility.loads_beside_rods(scene.mechanism, scene.loads)]
    tables = any(plausibility.doubtful_table(load) is not None for load in kind.numbered.loads)
    odd += ["True"] * (tables or plausibility.needs_look(scene.loads))
    odd += [f"abs({noted(gap)}) <= 1e-9 * {noted(length)}" for length, gap in arms]
    source = f"""def line(numbers):
    v = sizes(0.0, 0.0, 1.0, numbers, ())
    extent, longest = {noted(extent)}, max({", ".join([*map(noted, bars), "0.0", "0.0"])})
    shortest = min({", ".join([*map(noted, reaches), "inf", "inf"])})
    thin = longest * longest / {slender}
    return extent / shortest, {" or ".join(odd) or "False"}"""
    if any(node.operation == "table" for node in needed(outputs)):
        return None
    return compile_line(source, PLAIN | {"sizes": compile_line(line_source(outputs), PLAIN)})

"""Programs by structure: what a scene computes, recorded once for all scenes alike but for their numbers.

A program runs in three ways, all from one recording: on plain numbers, on arrays by NumPy, and as a compiled loop.
"""

import math
import threading
from types import SimpleNamespace
from typing import Any

import numpy as np

from ..errors import NotGivenError, QuantityError
from ..numbers.lazy import cached_property
from ..numbers.leaves import FLOATS, Leaves
from . import loops, writing
from .compiled import available, loaded
from .derivatives import gradients
from .error_bounds import OWN, ErrorBounds, tight_bounds
from .operations import ARRAYS, BY_DESIGN, PLAIN, SCALARS, made
from .recent import kept_for_same_angles
from .record import record
from .trace import needed, operations

FEW = 12
"""Crank angles, up to this many, that are computed one by one on plain numbers."""
LONG, PAYS = 300, 20_000_000
"""Operations from which few angles take longer on plain numbers than by a loop; after how many this is compiled."""
BLOCK = 2048
"""Values over designs and angles that one buffer holds."""


class Program:
    """The arithmetic of one recording, ready to run.

    Attributes
    ----------
    outputs : tuple of Node or float
    recording : Recording
    """

    scopes: Any = (PLAIN, BY_DESIGN)
    extremes: Any = "ignore"

    def __init__(self, recording, outputs=None):
        self.recording = recording
        self.outputs = recording.outputs if outputs is None else outputs
        self._slopes: dict[tuple[int, ...], Program] = {}
        self._bounded: dict[bool, Program] = {}
        self._computed = 0.0

    def by_parameters(self, places):
        """Program of all outputs and, one after the other, their derivatives by each of the parameters at some places.

        Raises
        ------
        NotGivenError
            Code of the user's that could not be recorded is behind the outputs.
        """
        if places not in self._slopes:
            recording = self.recording
            if self.unrecorded:
                raise NotGivenError(
                    f"derivatives cannot be given: {', '.join(self.unrecorded)} does more than arithmetic with "
                    "sin, cos and sqrt of `elementary`, so how its values hang on the parameters is not recorded"
                )
            rows = gradients(recording.graph, self.outputs, [recording.parameters[place] for place in places])
            self._slopes[places] = Program(recording, (*self.outputs, *(part for row in rows for part in row)))
        return self._slopes[places]

    def bounded(self, tight=False):
        """Program of all outputs and a proven bound on the error of each, infinite or NaN where there is none.

        Tight ones may be so where the others are finite.

        Raises
        ------
        NotGivenError
            Code of the user's that could not be recorded, or a cam made of samples, is behind the outputs.
        """
        if tight not in self._bounded:
            self._bounded[tight] = _Bounded(self.recording, self.outputs, tight)
        return self._bounded[tight]

    @cached_property
    def unrecorded(self):
        """Names of code of the user's behind the outputs that could not be recorded."""
        tables = (table for table in self.recording.tables if not self._rows_needed.isdisjoint(table.rows))
        return tuple(table.moved_by for table in tables if table.moved_by)

    @cached_property
    def _plain(self):
        return made(writing.line(self.outputs), PLAIN)

    @cached_property
    def buffered(self):
        """Lines of arrays for one design and for a batch, and how many buffers they take."""
        source, count = writing.buffered_line(self.outputs)
        return [made(source, ARRAYS | by_design) for by_design in self.scopes], count

    @cached_property
    def loop(self):
        """The compiled loop; see `writing.loop`."""
        return loaded(writing.loop(self.outputs)).loop

    @cached_property
    def _short_loop(self):
        """One with every operation rounded, as plain numbers have it."""
        return loaded(writing.loop(self.outputs, fuse=False)).loop

    def rows(self, state, leaves):
        """Rows of the tables at the crank angles of a `Dynamics`, whose leaves are at hand; those needed."""
        rows: list[Any] = []
        for table in self.recording.tables:
            rows += table.filled(state, leaves, self._rows_needed)
        return rows

    @cached_property
    def _rows_needed(self):
        return {node.arguments[0] for node in needed(self.outputs) if node.operation == "table"}

    def run(self, state, leaves, compiled=False):
        """Outputs (outputs, *shape) of a `Dynamics` whose leaves are at hand."""
        angle, shape = state.crank_angle, state.shape
        count = math.prod(shape)
        if len(shape) < 2 and count <= FEW and not self.recording.tables:
            few = self._by_short_loop if compiled and self._has_paid(count) else self._by_numbers
            return few(angle, leaves.numbers, shape)
        run = self.by_loop if compiled else self.by_numpy
        if angle.shape[-1:] != state.shape[-1:]:  # a single angle, and tables over more
            angle = np.broadcast_to(angle, angle.shape[:-1] + state.shape[-1:])
        return run(angle, leaves.numbers, self.rows(state, leaves), shape)

    def by_numpy(self, angle, numbers, rows, shape):
        """Outputs (outputs, *shape) from crank angles (..., N), numbers or arrays (..., 1), and rows of tables."""
        if not shape:
            return self.by_numpy(np.reshape(angle, 1), numbers, [np.reshape(row, 1) for row in rows], (1,))[:, 0]
        (single, batch), count = self.buffered
        results = np.empty((len(self.outputs), *shape))
        with np.errstate(all="ignore", under=self.extremes, over=self.extremes):
            sine, cosine = turn(angle)
            if len(shape) == 1:
                try:
                    for start in range(0, shape[0], BLOCK):
                        part = slice(start, start + BLOCK)
                        given = [row[part] if np.size(row) > 1 else row for row in rows]
                        own, free = results[:, part], _buffers(count, results[0, part].shape)
                        single(angle[part], sine[part], cosine[part], numbers, given, free, own)
                    return results
                except ZeroDivisionError:  # plain numbers raise it, those of NumPy answer with infinity or NaN
                    numbers = list(map(np.float64, numbers))
            batch(angle, sine, cosine, numbers, rows, np.empty((count, *shape)), results)
        return results

    @cached_property
    def _operations(self):
        return operations(self.outputs)

    def _has_paid(self, count):
        """Whether these and all earlier computations of few angles on plain numbers took longer than compiling does.

        For ever after the loop computes them, to the same bits but of the arc tangent.
        """
        if self._operations < LONG:
            return False
        self._computed += count * self._operations
        if self._computed > PAYS and not available():
            self._computed = -math.inf
        return self._computed > PAYS

    def at_one(self, angle, numbers, compiled):
        """Outputs at one crank angle, all floats; of a program without tables."""
        if compiled and self._has_paid(1):
            return self._by_short_loop(np.array([[angle]]), numbers, (1,))[:, 0].tolist()
        return self._by_numbers(np.array([angle]), numbers, (1,))[:, 0].tolist()

    def _by_short_loop(self, angle, numbers, shape):
        """The same by the loop, with the sines that plain numbers have."""
        return self._of_one_design(self._short_loop, angle, numbers, shape, _sines)

    def _of_one_design(self, loop, angle, numbers, shape, turn):
        angle, results = np.ascontiguousarray(angle.reshape(1, -1)), np.empty((1, len(self.outputs), angle.size))
        parameters = loops.table_of_parameters(_plain_numbers(numbers), ())
        sine, cosine = turn(angle)
        loops.run(loop, angle, sine, cosine, parameters, loops.NO_ROWS, results)
        return results.reshape(-1, *shape)

    def _by_numbers(self, angle, numbers, shape):
        angle = angle.ravel()
        numbers = _plain_numbers(numbers)
        given = zip(angle.tolist(), np.sin(angle).tolist(), np.cos(angle).tolist(), strict=True)
        try:
            found = [self._plain(*one, numbers, ()) for one in given]
        except (ZeroDivisionError, OverflowError):  # arrays answer with infinity or NaN
            found = self.by_numpy(angle, numbers, (), angle.shape).T
        return np.array(found).T.reshape(-1, *shape)

    def by_loop(self, angle, numbers, rows, shape):
        """The same by the compiled loop."""
        if len(shape) == 1 and not rows:
            return self._of_one_design(self.loop, angle, numbers, shape, loops.turn)
        parameters = loops.table_of_parameters(numbers, shape[:-1])
        designs = len(parameters)
        own = math.prod(angle.shape[:-1]) > 1
        angles = np.broadcast_to(angle, shape).reshape(designs, -1) if own else angle.reshape(1, -1)
        angles = np.ascontiguousarray(angles)
        results = np.empty((designs, len(self.outputs), angles.shape[1]))
        tables = loops.table_of_rows(rows, shape or (1,))
        sine, cosine = loops.turn(angles)
        loops.run(self.loop, angles, sine, cosine, parameters, tables, results)
        return results.swapaxes(0, 1).reshape(-1, *shape)


class _Bounded(Program):
    """Values with bounds. NumPy reports under- and overflow in arrays: mostly there is none that has to be bounded.

    Attributes
    ----------
    values : tuple of Node or float
    tight : bool
    """

    def __init__(self, recording, values, tight):
        self.values, self.tight = values, tight
        super().__init__(recording, (*values, *_bounds(recording, values, tight)))

    @cached_property
    def _without_dust(self):
        return _Watched(self.recording, (*self.values, *_bounds(self.recording, self.values, self.tight, dust=None)))

    def by_numpy(self, angle, numbers, rows, shape):
        try:
            return self._without_dust.by_numpy(angle, numbers, rows, shape)
        except FloatingPointError:
            return super().by_numpy(angle, numbers, rows, shape)


def _bounds(recording, values, tight, **known):
    graph, inputs, arithmetic = recording.graph, recording.inputs, OWN._replace(**known)
    if tight:
        return tight_bounds(graph, inputs, values, arithmetic)
    return ErrorBounds(graph, inputs, arithmetic).of(values)


class _Watched(Program):
    """Program that NumPy alone runs, plain numbers too; it raises FloatingPointError where one under- or overflows."""

    scopes, extremes = (SCALARS, BY_DESIGN), "raise"

    def by_numpy(self, angle, numbers, rows, shape):
        numbers = [np.float64(number) if isinstance(number, float) else number for number in numbers]
        return super().by_numpy(angle, numbers, rows, shape)


def _plain_numbers(numbers):
    if FLOATS.issuperset(map(type, numbers)):
        return numbers
    return [number.item() if type(number) is np.ndarray else number for number in numbers]


def _sines(angle):
    return np.sin(angle), np.cos(angle)


turn = kept_for_same_angles(_sines)


_memory = threading.local()


def _buffers(count, shape):
    """Memory for values on the way, the same again in each thread."""
    size = count * math.prod(shape)
    held = getattr(_memory, "held", None)
    if held is None or held.size < size:
        held = _memory.held = np.empty(max(size, 1))
    return held[:size].reshape(count, *shape)


# Programs kept by structure


def of(state, quantities=None, sizes=False, lasting=False) -> tuple[Program, Leaves]:
    """Program for some quantities of a `Dynamics` and of all others of its structure, and its own leaves.

    Recorded the first time it is asked for; each time for what may change unseen.

    Parameters
    ----------
    state : Dynamics
    quantities, sizes
        As for `record.record`.
    lasting : bool
        Whether what would have to be recorded each time is refused.

    Raises
    ------
    NotGivenError
        A group or load of the user's own cannot be recorded.
    """
    structure, leaves = state.apart
    if not leaves.lasting or state.way is not None:
        if lasting:
            raise NotGivenError(f"{state.mechanism.name} holds what may change unseen, to be recorded each time")
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


def numbered(state):
    """The scene of a `Dynamics` with the place of each number among its leaves, a `Numbered`, instead of it."""
    parts: list[Any] = list(state.kind.numbered)
    mechanism, speed, acceleration, loads, friction, sense = parts + [None, None][len(parts) - 4 :]
    return SimpleNamespace(
        mechanism=mechanism,
        crank_speed=speed,
        crank_acceleration=acceleration,
        loads=loads,
        friction=friction,
        sense=sense,
    )


def _recorded(state, structure, quantities, sizes):
    try:
        return Program(record(structure, quantities, sizes, state.way))
    except QuantityError:
        raise
    except (TypeError, AttributeError) as error:
        raise NotGivenError(
            f"the compiled engine cannot take {state.mechanism.name}: a group or load of it does more than arithmetic "
            f'with sin, cos and sqrt of `elementary` ({error}); use engine="numpy"'
        ) from error

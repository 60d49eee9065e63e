"""A program in two parts: what a design fixes, and what is left at each crank angle, for another arithmetic.

The first part is computed in double, as are sines and cosines of the crank angle and the rows of tables; all of it is
rounded once when it is handed over, so that a crank angle may be a million turns and masses may nearly cancel.
"""

from typing import Any, NamedTuple

import numpy as np

from ..numbers.lazy import cached_property
from . import numba_backend
from .codegen import line_source, loop_source
from .compiled import load_compiled
from .graph import parted
from .operations import BY_DESIGN, compile_line
from .program import BUFFER_VALUES, Program, numpy_sines


class Given(NamedTuple):
    """What is handed over: arrays of one dtype, and numbers that NumPy takes to be of the same.

    Attributes
    ----------
    angle, sine, cosine : array (..., N)
    parameters : list of number or array (..., 1)
    rows : list of number or array (..., N)
    shape : tuple of int
        Of results, without that of outputs.
    """

    angle: Any
    sine: Any
    cosine: Any
    parameters: list
    rows: list
    shape: tuple


class MixedPrecision:
    """A program whose arithmetic at each crank angle is apart from what a design fixes.

    Attributes
    ----------
    at_angles : Program
        Its parameters are what the design fixes; it has no other constants.
    """

    def __init__(self, program):
        self._whole = program
        given, outputs = parted(program.outputs)
        self._fixed = compile_line(line_source(given), BY_DESIGN)
        self.at_angles = Program(program.recording, outputs)

    def given(self, state, leaves, dtype):
        """What is handed over of a `Dynamics` whose leaves are at hand."""
        shape = state.shape or (1,)
        angle = state.crank_angle.reshape(state.crank_angle.shape or (1,))
        if angle.shape[-1:] != shape[-1:]:
            angle = np.broadcast_to(angle, angle.shape[:-1] + shape[-1:])
        with np.errstate(all="ignore"):
            parameters = [_of_type(part, dtype) for part in self._fixed_by(leaves.numbers)]
            rows = [_of_type(row, dtype) for row in self._whole.rows(state, leaves)]
            angle, sine, cosine = (part.astype(dtype) for part in (angle, *numpy_sines(angle)))
        return Given(angle, sine, cosine, parameters, rows, shape)

    def _fixed_by(self, numbers):
        try:
            return self._fixed(0.0, 0.0, 1.0, numbers, ())
        except (ZeroDivisionError, OverflowError):  # plain numbers raise it, those of NumPy answer with infinity or NaN
            return self._fixed(0.0, 0.0, 1.0, [np.float64(part) for part in numbers], ())

    def by_numpy(self, given):
        """Outputs (outputs, *shape) by array operations."""
        (_, batch), count = self.at_angles.buffered
        results = np.empty((len(self.at_angles.outputs), *given.shape), given.angle.dtype)
        step = BUFFER_VALUES if len(given.shape) == 1 else given.shape[-1]
        with np.errstate(all="ignore"):
            for start in range(0, given.shape[-1], step):
                part = slice(start, start + step)
                turn = [array[..., part] for array in given[:3]]
                rows = [row[..., part] if np.size(row) > 1 else row for row in given.rows]
                own = results[..., part]
                free = np.empty((count, *own.shape[1:]), own.dtype)
                batch(*turn, given.parameters, rows, free, own)
        return results

    def by_loop(self, given):
        """The same by a loop compiled for single precision."""
        shape, dtype = given.shape, given.angle.dtype
        parameters = numba_backend.parameter_table(given.parameters, shape[:-1]).astype(dtype)
        own = given.angle.size > shape[-1]
        turn = [
            np.ascontiguousarray((np.broadcast_to(array, shape) if own else array).reshape(-1, shape[-1]))
            for array in given[:3]
        ]
        rows = numba_backend.row_table(given.rows, shape).astype(dtype)
        results = np.empty((len(parameters), len(self.at_angles.outputs), shape[-1]), dtype)
        angle, sine, cosine = turn
        numba_backend.run_loop(self._loop, angle, sine, cosine, parameters, rows, results)
        return results.swapaxes(0, 1).reshape(-1, *shape)

    @cached_property
    def _loop(self):
        """The loop compiled for single precision."""
        return load_compiled(loop_source(self.at_angles.outputs, fuse=False, kind="float32")).loop


def _of_type(part, dtype):
    return float(part) if isinstance(part, float) else np.asarray(part, dtype)

"""What runs a program: NumPy, a compiled loop or JAX, in single or double precision, on a device.

Programs compiled by JAX (extra `grad`), on the accelerator that it finds or on the processor.

A program in two parts: what a design fixes, and what is left at each crank angle, for another arithmetic.

The first part is computed in double, as are sines and cosines of the crank angle and the rows of tables; all of it is
rounded once when it is handed over, so that a crank angle may be a million turns and masses may nearly cancel.
"""

from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from ..errors import MissingLibraryError, NotGivenError, ParameterError
from ..numbers.elementary import ROUNDING, total
from ..numbers.lazy import cached_property
from . import arithmetic, numba_backend
from .arithmetic import BoundsElsewhere
from .bounded import where_known, with_bounds
from .bounds import CAP
from .codegen import BY_DESIGN, compile_line, line_source, loop_source
from .graph import parted
from .numba_backend import load_compiled
from .program import BUFFER_VALUES, Program, numpy_sines

PROVEN = "cpu"
"""Platform whose functions keep to the errors that bounds take for granted, as a test shows."""
AS_WRITTEN = {
    "xla_disable_hlo_passes": "algsimp",
    "xla_cpu_enable_fast_math": False,
    "xla_cpu_enable_fast_min_max": False,
}
"""There, what keeps XLA from other quotients and roots, with other roundings; it may fuse products and sums still."""


def _jax():
    try:
        import jax
    except ImportError as error:
        raise MissingLibraryError(
            f'engine="jax" needs JAX, which {"is not installed" if error.name == "jax" else f"fails: {error}"}: '
            'pip install "kinetostatics[grad]"; engine="numpy" works without'
        ) from None
    return jax


def device_of(platform=None):
    """The device that JAX takes first, an accelerator if there is one, or the first of a platform.

    Raises
    ------
    ParameterError
        JAX finds no device of the platform; the message lists those that it finds.
    """
    jax = _jax()
    if platform is None:
        return jax.devices()[0]
    try:
        return jax.devices(platform)[0]
    except RuntimeError:
        found = sorted({device.platform for device in jax.devices()} | {PROVEN})
        raise ParameterError(f"device {platform!r}: JAX finds none, only {', '.join(found)}") from None


def device_name(device):
    """What a device is called: "cpu", "gpu: NVIDIA H100"."""
    kind = device.device_kind
    return device.platform if kind.lower() == device.platform else f"{device.platform}: {kind}"


class DeviceProgram:
    """The arithmetic of a `Split` as JAX runs it on a device, compiled for each shape that it meets."""

    def __init__(self, split, device):
        jax = _jax()
        xp = jax.numpy
        self._device, self._compiled = device, {}
        self._options = AS_WRITTEN if device.platform == PROVEN else None
        outputs = split.at_angles.outputs
        scope = {name: getattr(xp, name) for name in ("sin", "cos", "sqrt", "abs", "copysign", "nan", "inf")}
        scope |= {"atan": xp.arctan, "divisor": xp.maximum, "total": total}
        scope["fma"] = lambda one, other, more: one * other + more
        scope["root"] = lambda square, unit: xp.where(
            square > -ROUNDING * unit, xp.sqrt(xp.maximum(square, 0.0)), xp.nan
        )
        line = compile_line(line_source(outputs), scope)

        def computed(angle, sine, cosine, parameters, rows, shape):
            return tuple(xp.broadcast_to(part, shape) for part in line(angle, sine, cosine, parameters, rows))

        self._traced = jax.jit(computed, static_argnums=5)

    def run(self, given):
        """Outputs (outputs, *shape) of what is handed over."""
        jax = _jax()
        with jax.default_device(self._device), _width(jax, given.angle.dtype):
            dtype = given.angle.dtype
            arrays = *given[:3], _stacked(given.parameters, dtype), _stacked(given.rows, dtype)
            key = given.shape, *(part.shape for part in arrays)
            if key not in self._compiled:
                self._compiled[key] = self._traced.lower(*arrays, given.shape).compile(compiler_options=self._options)
            return np.stack([np.asarray(part) for part in self._compiled[key](*arrays)])


def _stacked(parts, dtype):
    """Numbers or arrays of shapes that fit as one array: a transfer for each would take longer than computing."""
    return np.array(np.broadcast_arrays(*parts), dtype)


@contextmanager
def _width(jax, dtype):
    """JAX with numbers in double precision if these are."""
    home: Any = jax if hasattr(jax, "enable_x64") else import_module("jax.experimental")
    with home.enable_x64(dtype == np.float64):
        yield


def require_known_rounding(device):
    """Refuse a bound for a device whose functions have not been held to their errors."""
    if device.platform != PROVEN:
        raise NotGivenError(
            f"no bound can be given on {device_name(device)}: how its functions round has not been tested; compile the "
            f'program with device="{PROVEN}", engine="numpy" or engine="compiled" to have one'
        )


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


_splits: WeakKeyDictionary[Program, MixedPrecision] = WeakKeyDictionary()


@dataclass(frozen=True)
class Backend:
    """An engine, in a precision, on a device.

    Attributes
    ----------
    engine : "numpy", "compiled" or "jax"
    precision : "double" or "single"
    platform : str or None
        Of the device that is asked of JAX; None for the first that it has.
    """

    engine: str
    precision: str = "double"
    platform: str | None = None
    _on_device: Any = field(default_factory=WeakKeyDictionary, compare=False, repr=False)
    _bounded: Any = field(default_factory=WeakKeyDictionary, compare=False, repr=False)

    def __reduce__(self):
        return Backend, (self.engine, self.precision, self.platform)

    @property
    def device(self):
        """What computes: "cpu", or what JAX calls its device."""
        return device_name(device_of(self.platform)) if self.engine == "jax" else "cpu"

    @property
    def is_own(self):
        """Whether programs run as they are, by NumPy or compiled, in double precision."""
        return self.engine != "jax" and self.precision == "double"

    def run(self, program, state, leaves):
        """Outputs (outputs, *shape) of a `Dynamics` whose leaves are at hand."""
        if self.is_own:
            return program.run(state, leaves, self.engine == "compiled")
        if program not in _splits:
            _splits[program] = MixedPrecision(program)
        split = _splits[program]
        given = split.given(state, leaves, arithmetic.OF[self.precision].dtype)
        if self.engine == "jax":
            if program not in self._on_device:
                self._on_device[program] = DeviceProgram(split, device_of(self.platform))
            rows = self._on_device[program].run(given)
        else:
            rows = split.by_loop(given) if self.engine == "compiled" else split.by_numpy(given)
        return rows if state.shape else rows[:, 0]

    def bounds(self, program, state, leaves, tight=False):
        """Bounds (outputs, *shape), in double, on the errors of what `run` gives; infinite where there is none.

        Tight ones there are of what `is_own`.

        Raises
        ------
        NotGivenError
            Code of the user's, or a device, rounds in a way that is not known.
        """
        if self.engine == "jax":
            require_known_rounding(device_of(self.platform))
        compiled = self.engine == "compiled"
        if self.is_own:
            values, found = with_bounds(program, state, leaves, compiled, tight)
        else:
            count, rows = len(program.outputs), self._elsewhere(program).run(state, leaves, compiled)
            values, found = rows[:count], rows[count:]
        small = all(np.all(np.abs(leaf) <= CAP) for leaf in (*leaves.numbers, *leaves.tables))
        return where_known(values, found if small else np.nan)

    def _elsewhere(self, program):
        if program not in self._bounded:
            recording = program.recording
            bounds = BoundsElsewhere(recording.graph, recording.inputs, arithmetic.OF[self.precision])
            self._bounded[program] = Program(recording, (*program.outputs, *bounds.of(program.outputs)))
        return self._bounded[program]

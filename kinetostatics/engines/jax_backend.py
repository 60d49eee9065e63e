"""Backends of a program: NumPy, compiled loop or JAX (extra `grad`), in double or single precision, on a device.

For JAX and single precision a program is split. Values fixed by the design, sines and cosines of the crank angle, and
rows of tables are computed in double and rounded once. The operations at each crank angle follow in the requested
precision. So a crank angle may be a million turns, and masses may nearly cancel.
"""

from dataclasses import dataclass
from importlib import import_module
from typing import Any, NamedTuple

import numpy as np

from ..errors import MissingLibraryError, NotGivenError, ParameterError
from ..numbers.lazy import cached_property
from . import numba_backend
from .codegen import BY_DESIGN, PLAIN, array_functions, compile_line, line_source, loop_source
from .error_bounds import CAP, PRECISIONS, where_known, with_bounds
from .graph import parted
from .numba_backend import load_compiled
from .program import Program, numpy_sines

PROVEN = "cpu"
"""Platform whose function errors are proven by a test, as the bounds assume."""
AS_WRITTEN = {
    "xla_disable_hlo_passes": "algsimp",
    "xla_cpu_enable_fast_math": False,
    "xla_cpu_enable_fast_min_max": False,
}
"""Options that keep XLA on that platform from changing quotients and roots; it may still fuse products and sums."""


def _jax():
    try:
        import jax
    except ImportError as error:
        raise MissingLibraryError(
            f'engine="jax" needs JAX, which {"is not installed" if error.name == "jax" else f"fails: {error}"}: '
            'pip install "kinetostatics[grad]"; engine="numpy" works without it'
        ) from None
    return jax


def device_of(platform=None):
    """The first device of JAX, an accelerator if there is one, or of a platform; `ParameterError` if there is none."""
    jax = _jax()
    if platform is None:
        return jax.devices()[0]
    try:
        return jax.devices(platform)[0]
    except RuntimeError:
        found = sorted({device.platform for device in jax.devices()} | {PROVEN})
        raise ParameterError(f"device {platform!r}: JAX finds none, only {', '.join(found)}") from None


def device_name(device):
    """Name of a device: "cpu", "gpu: NVIDIA H100"."""
    kind = device.device_kind
    return device.platform if kind.lower() == device.platform else f"{device.platform}: {kind}"


class DeviceProgram:
    """A `MixedPrecision` run by JAX on a device, compiled once for each dtype and shape."""

    def __init__(self, split, device):
        jax = _jax()
        self._device, self._compiled = device, {}
        self._options = AS_WRITTEN if device.platform == PROVEN else None
        line = compile_line(line_source(split.at_angles.outputs), PLAIN | array_functions(jax.numpy))

        def computed(angle, sine, cosine, parameters, rows, shape):
            return tuple(jax.numpy.broadcast_to(part, shape) for part in line(angle, sine, cosine, parameters, rows))

        self._traced = jax.jit(computed, static_argnums=5)

    def run(self, given):
        """Outputs (outputs, *shape) for given inputs."""
        jax = _jax()
        dtype = given.angle.dtype
        home: Any = jax if hasattr(jax, "enable_x64") else import_module("jax.experimental")
        with jax.default_device(self._device), home.enable_x64(dtype == np.float64):
            # one array for all: separate transfers would take longer than the computation
            inputs = (np.array(np.broadcast_arrays(*parts), dtype) for parts in (given.parameters, given.rows))
            arrays = *given[:3], *inputs
            key = dtype, given.shape, *(part.shape for part in arrays)
            if key not in self._compiled:
                self._compiled[key] = self._traced.lower(*arrays, given.shape).compile(compiler_options=self._options)
            return np.stack([np.asarray(part) for part in self._compiled[key](*arrays)])


class Given(NamedTuple):
    """Inputs of the operations at each crank angle: arrays (..., N) of a dtype, and numbers that NumPy converts to it.

    Parameters may be arrays (..., 1), rows of tables (..., N); `shape` is that of an output.
    """

    angle: Any
    sine: Any
    cosine: Any
    parameters: list
    rows: list
    shape: tuple


class MixedPrecision:
    """A program split into values fixed by the design and operations at each crank angle.

    The parameters of the program `at_angles` are the values fixed by the design; it has no other constants.
    """

    def __init__(self, program):
        self._whole = program
        given, outputs = parted(program.outputs)
        self._fixed = compile_line(line_source(given), BY_DESIGN)
        self.at_angles = Program(program.recording, outputs)

    def given(self, state, leaves, dtype):
        """Inputs, in a dtype, for a `Dynamics` with its leaves."""
        shape = state.shape or (1,)
        angle = state.crank_angle.reshape(state.crank_angle.shape or (1,))
        if angle.shape[-1:] != shape[-1:]:
            angle = np.broadcast_to(angle, angle.shape[:-1] + shape[-1:])
        with np.errstate(all="ignore"):
            parameters, rows = (
                [float(part) if isinstance(part, float) else np.asarray(part, dtype) for part in parts]
                for parts in (self._fixed_by(leaves.numbers), self._whole.rows(state, leaves))
            )
            angle, sine, cosine = (part.astype(dtype) for part in (angle, *numpy_sines(angle)))
        return Given(angle, sine, cosine, parameters, rows, shape)

    def _fixed_by(self, numbers):
        try:
            return self._fixed(0.0, 0.0, 1.0, numbers, ())
        except (ZeroDivisionError, OverflowError):  # plain numbers raise it, NumPy numbers give infinity or NaN
            return self._fixed(0.0, 0.0, 1.0, [np.float64(part) for part in numbers], ())

    def by_numpy(self, given):
        """Outputs (outputs, *shape) by array operations."""
        return self.at_angles.by_numpy(given.angle, given.parameters, given.rows, given.shape, given[1:3])

    def by_loop(self, given):
        """Outputs (outputs, *shape) by a loop compiled for single precision."""
        turn = [numba_backend.angle_rows(part, given.shape) for part in given[1:3]]
        inputs = given.angle, given.parameters, given.rows, given.shape
        return self.at_angles.by_loop(*inputs, self._single_loop, lambda angle: turn)

    @cached_property
    def _single_loop(self):
        return load_compiled(loop_source(self.at_angles.outputs, fuse=False, kind="float32")).loop


@dataclass(frozen=True)
class Backend:
    """An engine ("numpy", "compiled" or "jax") with its precision and device.

    The precision is "double" or "single"; `platform` is that of the device for JAX, None for its first device.
    """

    engine: str
    precision: str = "double"
    platform: str | None = None

    @property
    def device(self):
        """Name of the device: "cpu", or the name that JAX uses."""
        return device_name(device_of(self.platform)) if self.engine == "jax" else "cpu"

    @property
    def is_own(self):
        """Whether programs run without a split: by NumPy or compiled, in double precision."""
        return self.engine != "jax" and self.precision == "double"

    def run(self, program, state, leaves):
        """Outputs (outputs, *shape) of a `Dynamics` with its leaves."""
        if self.is_own:
            return program.run(state, leaves, self.engine == "compiled")
        split = program.kept("split", lambda: MixedPrecision(program))
        given = split.given(state, leaves, PRECISIONS[self.precision].dtype)
        if self.engine == "jax":
            device = device_of(self.platform)
            rows = program.kept(("jax", device), lambda: DeviceProgram(split, device)).run(given)
        else:
            rows = split.by_loop(given) if self.engine == "compiled" else split.by_numpy(given)
        return rows if state.shape else rows[:, 0]

    def bounds(self, program, state, leaves, tight=False):
        """Bounds (outputs, *shape), in double, on the errors of the outputs of `run`; infinite or NaN without a bound.

        `tight` needs `is_own`. `NotGivenError` if the rounding of user code, or of a device, is unknown.
        """
        if self.engine == "jax" and (device := device_of(self.platform)).platform != PROVEN:
            raise NotGivenError(
                f"no bound can be given on {device_name(device)}: the rounding of its functions is untested; compile "
                f'the program with device="{PROVEN}", engine="numpy" or engine="compiled" to get one'
            )
        compiled = self.engine == "compiled"
        if self.is_own:
            values, found = with_bounds(program, state, leaves, compiled, tight)
        else:
            bounded = program.bounded(arithmetic=PRECISIONS[self.precision])
            values, found = np.split(bounded.run(state, leaves, compiled), 2)
        small = all(np.all(np.abs(leaf) <= CAP) for leaf in (*leaves.numbers, *leaves.tables))
        return where_known(values, found if small else np.nan)

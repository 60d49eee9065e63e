"""Programs compiled by JAX (extra `grad`), on the accelerator that it finds or on the processor."""

from contextlib import contextmanager
from importlib import import_module
from typing import Any

import numpy as np

from ..errors import MissingLibraryError, NotGivenError, ParameterError
from ..numbers.elementary import ROUNDING, total
from .codegen import line_source
from .operations import compile_line

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

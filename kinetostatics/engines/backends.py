"""What runs a program: NumPy, a compiled loop or JAX, in single or double precision, on a device."""

from dataclasses import dataclass, field
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from . import accelerated
from .error_bounds import CAP, PRECISIONS, ErrorBounds, where_known, with_bounds
from .programs import Program
from .split import Split

_splits: "WeakKeyDictionary[Program, Split]" = WeakKeyDictionary()


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
        return accelerated.named(accelerated.device_of(self.platform)) if self.engine == "jax" else "cpu"

    @property
    def is_own(self):
        """Whether programs run as they are, by NumPy or compiled, in double precision."""
        return self.engine != "jax" and self.precision == "double"

    def run(self, program, state, leaves):
        """Outputs (outputs, *shape) of a `Dynamics` whose leaves are at hand."""
        if self.is_own:
            return program.run(state, leaves, self.engine == "compiled")
        if program not in _splits:
            _splits[program] = Split(program)
        split = _splits[program]
        given = split.given(state, leaves, PRECISIONS[self.precision].dtype)
        if self.engine == "jax":
            if program not in self._on_device:
                self._on_device[program] = accelerated.OnDevice(split, accelerated.device_of(self.platform))
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
            accelerated.require_proven(accelerated.device_of(self.platform))
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
            bounds = ErrorBounds(recording.graph, recording.inputs, PRECISIONS[self.precision])
            self._bounded[program] = Program(recording, (*program.outputs, *bounds.of(program.outputs)))
        return self._bounded[program]

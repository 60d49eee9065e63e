"""Engines: each takes a `Dynamics` and names of quantities, and returns values by name.

`KERNELS` runs the kernels directly, on any numbers: JAX, enclosures, single precision, a user's own groups that cannot
be recorded. `NUMPY` runs the recorded program by array operations, `COMPILED` as a loop compiled by numba.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import NotGivenError
from ..mechanics.motion import gap_mask, required_groups
from ..mechanics.quantities import FRICTION_CHECKS, of_scene, resolved_names
from ..numbers.arithmetic import read_only, stack
from ..numbers.planar import plus
from .error_bounds import CAP, with_bounds
from .program import program_of


@dataclass(frozen=True)
class Kernels:
    """The kernels run directly; `placement_method`: another method for the positions, see `Dynamics`."""

    placement_method: Any = None

    def values(self, state, names=None):
        """Values by name; None: closure and all results of the groups."""
        state = state if self.placement_method is None else replace(state, placement_method=self.placement_method)
        names = resolved_names(state) if names is None else names
        behind, found = required_groups(state.mechanism), {}
        for name in names:
            if name == "closure":
                found[name] = read_only(stack(state.closure))
                continue
            value = of_scene(state)[name].read(state)
            is_open = None if name in FRICTION_CHECKS else gap_mask(state.placement, behind[name])
            found[name] = value if name in FRICTION_CHECKS else read_only(plus(value, is_open))
        return found

    def with_bounds(self, state, names, tight=False):
        raise NotGivenError(
            f"{state.mechanism.name}: bounds need recorded arithmetic, but this solution is computed by the "
            "kernels themselves or by another method; solve it with plain numbers"
        )


KERNELS = Kernels()


@dataclass(frozen=True)
class Recorded:
    """The recorded program, run by NumPy or, if `compiled`, as a loop compiled by numba.

    The kernels run directly where a scene cannot be recorded, or would be recorded at every call by NumPy; `strict`
    raises `NotGivenError` instead.
    """

    compiled: bool = False
    strict: bool = False

    def values(self, state, names=None):
        """Values by name; None: closure and all results of the groups."""
        if not is_plain(state.crank_angle):
            return KERNELS.values(state, names)
        try:
            program, leaves = program_of(state, names, lasting=not self.compiled)
        except NotGivenError:
            if self.strict:
                raise
            return KERNELS.values(state, names)
        rows = program.run(state, leaves, self.compiled)
        if not (state.loads_are_given or np.isfinite(rows).all()):
            state.pushes, state.wrenches  # noqa: B018  an error if a load is no number where the mechanism closes
        return program.recording.named(read_only(rows))

    def with_bounds(self, state, names, tight=False):
        """Values by name, and bounds on their rounding errors by name, infinite or NaN without a bound.

        `NotGivenError` if the kernels cannot be recorded, or code of the user's rounds in an unknown way.
        """
        if not is_plain(state.crank_angle):
            return KERNELS.with_bounds(state, names, tight)
        program, leaves = program_of(state, names)
        values, bounds = with_bounds(program, state, leaves, self.compiled, tight)
        named = program.recording.named
        small = all(np.all(np.abs(leaf) <= CAP) for leaf in leaves.numbers)
        return named(values), named(bounds if small else np.full_like(bounds, np.inf))


def is_plain(angle):
    """Whether crank angles are a NumPy array in double precision."""
    return isinstance(angle, np.ndarray) and angle.dtype == float


NUMPY, FASTEST, COMPILED = Recorded(), Recorded(compiled=True), Recorded(compiled=True, strict=True)

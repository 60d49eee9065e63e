"""The library's own path under study: NumPy, compiled, JAX; single precision; torque by powers alone."""

import warnings
from dataclasses import replace

import numpy as np

from ...engines import programs
from ...engines.compiled import require
from ...engines.engines import COMPILED, NUMPY
from ...errors import MissingLibraryError
from ...mechanics.quantities import components
from ...solution.scene import Scene, unchecked
from .method import Method, NotGivenError


def _solved(solution, angle):
    drive = solution.crank_speed, solution.crank_acceleration
    scene = Scene(solution.mechanism, *drive, solution.loads, solution.friction)
    return unchecked(scene, angle, "numpy")


def _numpy(solution, quantity, setting):
    return lambda: components(_solved(solution, solution.crank_angle), quantity)


def compiled_run(solution, quantity):
    """Function that computes a quantity by a compiled loop."""
    require()
    state = solution.dynamics
    made, leaves = programs.of(state, (quantity,))
    return lambda: tuple(made.run(state, leaves, compiled=True))


def _compiled(solution, quantity, setting):
    return compiled_run(solution, quantity)


def _numpy_with_bounds(solution, quantity, setting):
    return lambda: _with_bounds(_solved(solution, solution.crank_angle), quantity, NUMPY)


def _compiled_with_bounds(solution, quantity, setting):
    require()
    return lambda: _with_bounds(solution, quantity, COMPILED)


def _with_bounds(solution, quantity, engine):
    values, _ = engine.with_bounds(solution.dynamics, (quantity,))
    return tuple(np.reshape(values[quantity], (-1, *solution.shape)))


def proven(solution, quantity):
    """Bound on the errors of a solution's values (N,), of a vector on their magnitude."""
    return np.linalg.norm(np.reshape(solution.error_bound(quantity), (-1, *solution.shape)), axis=0)


def _jax(solution, quantity, setting):
    try:
        import jax
    except ImportError:
        raise MissingLibraryError('JAX is not installed: pip install "kinetostatics[grad]"') from None

    with jax.enable_x64(True):
        angle = jax.numpy.asarray(solution.crank_angle)
        compute = jax.jit(lambda angle: components(_solved(solution, angle), quantity))
        try:
            jax.block_until_ready(compute(angle))
        except (TypeError, ValueError) as error:
            raise NotGivenError(f"a load or cam that JAX cannot trace: {str(error).splitlines()[0]}") from error
        compiled_once = compute.lower(angle).compile()
    return lambda: tuple(jax.block_until_ready(compiled_once(angle)))


def _single(solution, quantity, setting):
    angle = solution.crank_angle.astype(np.float32)

    def run():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return components(_solved(solution, angle), quantity)

    return run


def _by_power(solution, quantity, setting):
    if quantity != "balancing_torque":
        raise NotGivenError("virtual power gives the torque of the drive, no reactions")
    return lambda: (replace(solution).balancing_torque_by_power,)


METHODS = (
    Method("ours, NumPy", _numpy, ours=True, bound=proven),
    Method("ours, compiled", _compiled, ours=True, bound=proven),
    Method("ours, NumPy, with proven bounds", _numpy_with_bounds, ours=True, bound=proven),
    Method("ours, compiled, with proven bounds", _compiled_with_bounds, ours=True, bound=proven),
    Method("ours, JAX jit", _jax, ours=True),
    Method("ours, torque by powers", _by_power, ours=True),
    Method("single precision", _single),
)

"""The library's own path under study: NumPy, compiled, JAX, each in single precision too; torque by powers alone."""

import warnings
from dataclasses import replace

import numpy as np

from ...engines.engines import COMPILED, NUMPY
from ...engines.jax_backend import Backend
from ...engines.numba_backend import require_numba
from ...engines.program import program_of
from ...mechanics.quantities import components
from ...solution.scene import Scene, unchecked_solution
from .method import Method, NotGivenError


def _solve(solution, angle):
    return unchecked_solution(Scene.of(solution), angle, "numpy")


def _numpy(solution, quantity, setting):
    return lambda: components(_solve(solution, solution.crank_angle), quantity)


def compiled_function(solution, quantity):
    """Function that computes a quantity by a compiled loop."""
    require_numba()
    state = solution.dynamics
    made, leaves = program_of(state, (quantity,))
    return lambda: tuple(made.run(state, leaves, compiled=True))


def _compiled(solution, quantity, setting):
    return compiled_function(solution, quantity)


def _numpy_with_bounds(solution, quantity, setting):
    return lambda: _with_bounds(_solve(solution, solution.crank_angle), quantity, NUMPY)


def _compiled_with_bounds(solution, quantity, setting):
    require_numba()
    return lambda: _with_bounds(solution, quantity, COMPILED)


def _with_bounds(solution, quantity, engine):
    values, _ = engine.with_bounds(solution.dynamics, (quantity,))
    return tuple(np.reshape(values[quantity], (-1, *solution.shape)))


def proven_bound(solution, quantity):
    """Bound on the errors of a solution's values (N,), of a vector on their magnitude."""
    return np.linalg.norm(np.reshape(solution.error_bound(quantity), (-1, *solution.shape)), axis=0)


def _backend_method(engine, precision):
    """The recorded program in a precision, or by JAX on the device that it finds, with the bounds that are proven."""
    backend = Backend(engine, precision)
    bounding = backend if engine == "jax" else Backend("numpy", precision)

    def prepare(solution, quantity, setting):
        if engine == "compiled":
            require_numba()
        state = solution.dynamics
        made, leaves = program_of(state, (quantity,))
        backend.run(made, state, leaves)
        return lambda: tuple(backend.run(made, state, leaves))

    def bound(solution, quantity):
        made, leaves = program_of(solution.dynamics, (quantity,))
        return np.linalg.norm(bounding.bounds(made, solution.dynamics, leaves), axis=0)

    name = {"numpy": "NumPy", "jax": "JAX"}.get(engine, engine)
    title = f"ours, {name}" + (", single precision" if precision == "single" else "")
    return Method(title, prepare, ours=True, bound=bound, precision=precision, device=lambda: backend.device)


def _single_angles(solution, quantity, setting):
    angle = solution.crank_angle.astype(np.float32)

    def run():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return components(_solve(solution, angle), quantity)

    return run


def _by_power(solution, quantity, setting):
    if quantity != "balancing_torque":
        raise NotGivenError("virtual power gives the torque of the drive, no reactions")
    return lambda: (replace(solution).balancing_torque_by_power,)


METHODS = (
    Method("ours, NumPy", _numpy, ours=True, bound=proven_bound),
    Method("ours, compiled", _compiled, ours=True, bound=proven_bound),
    Method("ours, NumPy, with proven bounds", _numpy_with_bounds, ours=True, bound=proven_bound),
    Method("ours, compiled, with proven bounds", _compiled_with_bounds, ours=True, bound=proven_bound),
    _backend_method("jax", "double"),
    *(_backend_method(engine, "single") for engine in ("numpy", "compiled", "jax")),
    Method("ours, torque by powers", _by_power, ours=True),
    Method("float32 crank angles", _single_angles),
)

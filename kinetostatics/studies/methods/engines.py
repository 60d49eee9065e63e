"""The library's own engines as methods (NumPy, compiled, JAX, single precision), and approximations that run on them.

Approximations: derivatives of the joint positions by finite differences or by FFT, joint paths as truncated Fourier
series, and the coupler as two point masses.
"""

import warnings
from dataclasses import replace
from functools import partial

import numpy as np

from ...engines.engines import COMPILED, NUMPY, Kernels
from ...engines.jax_backend import Backend
from ...engines.numba_backend import require_numba
from ...engines.program import program_of
from ...errors import NotGivenError, ParameterError
from ...mechanics.quantities import components
from ...solution.scene import Scene, unchecked_solution
from ..simplifications import joint_positions, paths_over_turn, placement_from_joints, two_masses, up_to_harmonic
from .method import Method, require_one_design


def _solve(solution, angle):
    return unchecked_solution(Scene.of(solution), angle, "numpy")


def _numpy(solution, quantity, setting):
    return lambda: components(_solve(solution, solution.crank_angle), quantity)


def recorded_function(backend, solution, quantity, setting=None):
    """Function that computes a quantity by the recorded program on a `Backend`, which must be available."""
    if backend.engine == "compiled":
        require_numba()
    state = solution.dynamics
    made, leaves = program_of(state, (quantity,))
    backend.device  # noqa: B018
    return lambda: tuple(backend.run(made, state, leaves))


compiled_function = partial(recorded_function, Backend("compiled"))


def _with_bounds(engine, solution, quantity, setting):
    if engine is COMPILED:
        require_numba()

    def run():
        solved = solution if engine is COMPILED else _solve(solution, solution.crank_angle)
        values, _ = engine.with_bounds(solved.dynamics, (quantity,))
        return tuple(np.reshape(values[quantity], (-1, *solution.shape)))

    return run


def proven_bound(solution, quantity):
    """Bound on the rounding errors of a quantity, (N,), its unit; for a vector, of the error's magnitude."""
    return np.linalg.norm(np.reshape(solution.error_bound(quantity), (-1, *solution.shape)), axis=0)


def _backend_method(engine, precision):
    """Method of a recorded program by an engine in a precision, with proven bounds; JAX chooses its device."""
    backend = Backend(engine, precision)
    bounding = backend if engine == "jax" else Backend("numpy", precision)

    def bound(solution, quantity):
        made, leaves = program_of(solution.dynamics, (quantity,))
        return np.linalg.norm(bounding.bounds(made, solution.dynamics, leaves), axis=0)

    name = {"numpy": "NumPy", "jax": "JAX"}.get(engine, engine)
    title = f"ours, {name}" + (", single precision" if precision == "single" else "")
    prepare = partial(recorded_function, backend)
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
        raise NotGivenError("virtual power gives only the torque of the drive")
    return lambda: (replace(solution).balancing_torque_by_power,)


METHODS = (
    Method("ours, NumPy", _numpy, ours=True, bound=proven_bound),
    Method("ours, compiled", compiled_function, ours=True, bound=proven_bound),
    Method("ours, NumPy, with proven bounds", partial(_with_bounds, NUMPY), ours=True, bound=proven_bound),
    Method("ours, compiled, with proven bounds", partial(_with_bounds, COMPILED), ours=True, bound=proven_bound),
    _backend_method("jax", "double"),
    *(_backend_method(engine, "single") for engine in ("numpy", "compiled", "jax")),
    Method("ours, torque by powers", _by_power, ours=True),
    Method("float32 crank angles", _single_angles),
)


STENCILS = {
    2: ((-1, 0, 1), (-0.5, 0.0, 0.5), (1.0, -2.0, 1.0)),
    4: ((-2, -1, 0, 1, 2), (1 / 12, -2 / 3, 0.0, 2 / 3, -1 / 12), (-1 / 12, 4 / 3, -5 / 2, 4 / 3, -1 / 12)),
}
"""By order: offsets in steps, weights of the first and of the second derivative (Fornberg 1988)."""


def _differences(order, solution, quantity, step):
    offsets, first, second = (np.array(row) for row in STENCILS[order])
    require_one_design(solution)

    def place(mechanism, angle):
        position = joint_positions(mechanism, angle + step * offsets[:, None])
        here = position[:, :, offsets.size // 2]
        slopes = (np.tensordot(part, position, (0, 2)) for part in (first / step, second / step**2))
        return placement_from_joints(mechanism, angle, here, *slopes)

    return _report_coarse_motion(lambda: components(replace(solution, engine=Kernels(place)), quantity))


def _spectral(solution, quantity, samples):
    """Joint positions sampled over the turn, differentiated and interpolated to the crank angles by FFT."""
    require_one_design(solution)
    angle = solution.crank_angle
    turn = np.linspace(0.0, 2 * np.pi, np.size(angle), endpoint=False)
    if np.ndim(angle) != 1 or not np.allclose(angle - angle[0], turn, atol=1e-9):
        raise NotGivenError("spectral differentiation needs even crank angles over one turn, end excluded")
    if samples > angle.size:
        raise NotGivenError(f"{samples} samples are more than the {angle.size} given crank angles")
    sampled = np.linspace(0.0, 2 * np.pi, samples, endpoint=False)
    paths_over_turn(solution.mechanism, sampled)
    harmonic = 1j * np.arange((samples + 1) // 2)
    onward = np.exp(harmonic * angle[0])

    def place(mechanism, angle):
        shift = onward * (angle.size / samples)
        spectrum = np.fft.rfft(joint_positions(mechanism, sampled))[..., : harmonic.size] * shift
        orders = (np.fft.irfft(spectrum * harmonic**k, n=angle.size) for k in range(3))
        return placement_from_joints(mechanism, angle, *orders)

    return _report_coarse_motion(lambda: components(replace(solution, engine=Kernels(place)), quantity))


def _report_coarse_motion(run):
    """The function, with `NotGivenError` if a coarse motion leaves the range of a load's table."""

    def approximated():
        try:
            return run()
        except ParameterError as why:
            raise NotGivenError(f"the computed motion is too coarse: {why}") from why

    return approximated


def _simpler(model, engine, solution, quantity, setting):
    """Method that computes a simpler model by NumPy or a compiled loop."""
    require_one_design(solution)
    simpler = model(setting, solution)
    if simpler is None:
        raise NotGivenError("there is no coupler mass to divide between its joints")
    if engine is COMPILED:
        return _report_coarse_motion(compiled_function(simpler, quantity))
    return _report_coarse_motion(lambda: components(replace(simpler), quantity))


HARMONICS = (1, 2, 4, 6)
STEPS = (3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4)
APPROXIMATE_METHODS = (
    Method("differences, 2nd order", partial(_differences, 2), "step [rad]", (1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5)),
    Method("differences, 4th order", partial(_differences, 4), "step [rad]", STEPS),
    Method("spectral differentiation", _spectral, "samples", (8, 12, 16, 24, 32, 48, 64, 128)),
    Method("harmonic series", partial(_simpler, up_to_harmonic, NUMPY), "harmonics", HARMONICS),
    Method("harmonic series, compiled", partial(_simpler, up_to_harmonic, COMPILED), "harmonics", HARMONICS),
    Method("two-mass coupler", partial(_simpler, two_masses, NUMPY)),
    Method("two-mass coupler, compiled", partial(_simpler, two_masses, COMPILED)),
)

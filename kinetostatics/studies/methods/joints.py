"""Other ways to the motion of the joints: differences, spectra, harmonic series; and the coupler as two masses."""

from dataclasses import replace

import numpy as np

from ...engines.engines import Kernels
from ...errors import NotGivenError, ParameterError
from ...mechanics.quantities import components
from ..series import assembled, closed_paths, harmonic_series, joints_of, positions
from ..simplifications import two_mass_coupler
from .engines import compiled_run
from .method import Method, require_one_design

STENCILS = {
    2: ((-1, 0, 1), (-0.5, 0.0, 0.5), (1.0, -2.0, 1.0)),
    4: ((-2, -1, 0, 1, 2), (1 / 12, -2 / 3, 0.0, 2 / 3, -1 / 12), (-1 / 12, 4 / 3, -5 / 2, 4 / 3, -1 / 12)),
}
"""By order: offsets in steps, weights of the first and of the second derivative (Fornberg 1988)."""


def _differences(order):
    offsets, first, second = (np.array(row) for row in STENCILS[order])

    def prepare(solution, quantity, step):
        require_one_design(solution)

        def way(mechanism, angle):
            position = positions(mechanism, angle + step * offsets[:, None])
            return assembled(
                mechanism,
                angle,
                joints_of(
                    mechanism,
                    position[:, :, offsets.size // 2],
                    np.tensordot(first / step, position, (0, 2)),
                    np.tensordot(second / step**2, position, (0, 2)),
                ),
            )

        return _approximated(lambda: components(replace(solution, engine=Kernels(way)), quantity))

    return prepare


def _spectral(solution, quantity, samples):
    """Joint positions sampled over the turn, differentiated and interpolated to the crank angles by FFT."""
    require_one_design(solution)
    angle = solution.crank_angle
    if not _is_even_turn(angle):
        raise NotGivenError("spectral differentiation needs crank angles evenly over one turn, its end excluded")
    if samples > angle.size:
        raise NotGivenError(f"{samples} samples are more than the {angle.size} crank angles asked for")
    sampled = np.linspace(0.0, 2 * np.pi, samples, endpoint=False)
    closed_paths(solution.mechanism, sampled)
    harmonic = 1j * np.arange((samples + 1) // 2)
    onward = np.exp(harmonic * angle[0])

    def way(mechanism, angle):
        spectrum = np.fft.rfft(positions(mechanism, sampled))[..., : harmonic.size] * (onward * (angle.size / samples))
        parts = (np.fft.irfft(spectrum * harmonic**k, n=angle.size) for k in range(3))
        return assembled(mechanism, angle, joints_of(mechanism, *parts))

    return _approximated(lambda: components(replace(solution, engine=Kernels(way)), quantity))


def _approximated(run):
    """The same function, which cannot give what loads have no value for where a coarse motion takes the slider."""

    def approximated():
        try:
            return run()
        except ParameterError as why:
            raise NotGivenError(f"the motion found is too coarse: {why}") from why

    return approximated


def _is_even_turn(angle):
    turn = np.linspace(0.0, 2 * np.pi, np.size(angle), endpoint=False)
    return np.ndim(angle) == 1 and np.allclose(angle - angle[0], turn, atol=1e-9)


def _series(solution, order):
    """The solution with its kinematics as a truncated series."""
    require_one_design(solution)
    return replace(solution, engine=Kernels(harmonic_series(solution, order)))


def _two_mass(solution, setting):
    """The solution with its couplers as two masses each."""
    mechanism = two_mass_coupler(solution.mechanism)
    if mechanism is None:
        raise NotGivenError("there is no coupler mass to share out between its joints")
    return replace(solution, mechanism=mechanism)


def _eager(model):
    """Method that computes a simpler model by NumPy."""

    def prepare(solution, quantity, setting):
        simpler = model(solution, setting)
        return _approximated(lambda: components(replace(simpler), quantity))

    return prepare


def _compiled(model):
    """Method that computes a simpler model by a compiled loop, its fastest."""
    return lambda solution, quantity, setting: _approximated(compiled_run(model(solution, setting), quantity))


HARMONICS = (1, 2, 4, 6)
METHODS = (
    Method("differences, 2nd order", _differences(2), "step [rad]", (1e-1, 3e-2, 1e-2, 1e-3, 1e-4, 1e-5)),
    Method("differences, 4th order", _differences(4), "step [rad]", (3e-1, 1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-4)),
    Method("spectral differentiation", _spectral, "samples", (8, 12, 16, 24, 32, 48, 64, 128)),
    Method("harmonic series", _eager(_series), "harmonics", HARMONICS),
    Method("harmonic series, compiled", _compiled(_series), "harmonics", HARMONICS),
    Method("two-mass coupler", _eager(_two_mass)),
    Method("two-mass coupler, compiled", _compiled(_two_mass)),
)

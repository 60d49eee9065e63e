"""Motion found in other ways: joints by any method, links and forces as in the library; harmonic series among them."""

from functools import partial

import numpy as np

from ..errors import NotGivenError
from ..machine.crank import ray
from ..machine.group import FRAME
from ..machine.kinematic_state import Placement
from ..machine.links import Joint
from ..numbers.planar import turned

SERIES_SAMPLES = 512
"""Positions over the turn from which the coefficients of harmonic series are found."""


def assembled(mechanism, angle, joints) -> Placement:
    """Placement of a mechanism whose moving joints are known, by name, with their derivatives."""
    placement = mechanism.crank.place(angle)
    for group in mechanism.groups:
        if not group.follows:
            raise NotGivenError(f"{type(group).__name__} has no `follow`, to be placed at joints known in another way")
        group.follow(placement, joints)
    return placement


def moving(mechanism):
    """Names of the joints that groups place and that move; the crank pin is known exactly."""
    return [name for group in mechanism.groups for name, point in group.joints.items() if point.link != FRAME]


def positions(mechanism, angle):
    """Positions of the moving joints, (joints, 2, ...)."""
    names, shape = moving(mechanism), np.shape(angle)
    joints = mechanism.place(angle).joints
    found = [[np.broadcast_to(part, shape) for part in joints[name].position] for name in names]
    return np.array(found, dtype=float).reshape(len(names), 2, *shape)


def closed_paths(mechanism, angle):
    """The same over a whole turn; refused where no joint moves but the crank pin, and where one cannot be found."""
    found = positions(mechanism, angle)
    if not found.size:
        what = "moves no joint but the crank pin" if mechanism.groups else "is a crank alone"
        raise NotGivenError(f"{mechanism.name} {what}: it has no joint whose path is to be found as a series")
    if mechanism.turns > 1:
        raise NotGivenError(f"{mechanism.name} takes {mechanism.turns} turns to repeat, a Fourier series one")
    if not np.all(np.isfinite(found)):
        raise NotGivenError(f"{mechanism.name} does not close all around the turn, which a Fourier series needs")
    return found


def joints_of(mechanism, position, first, second):
    return {
        name: Joint(tuple(position[k]), tuple(first[k]), tuple(second[k])) for k, name in enumerate(moving(mechanism))
    }


def harmonic_series(solution, order):
    """Way to a placement from Fourier series of the joints' paths, cut off after a harmonic of the crank angle.

    Of the plain crank-slider these are the series of engine theory (Biezeno and Grammel, *Technische Dynamik*), with
    coefficients to all powers of crank over coupler length.
    """
    mechanism = solution.mechanism
    path = closed_paths(mechanism, np.linspace(0.0, 2 * np.pi, SERIES_SAMPLES, endpoint=False))
    spectrum = 2.0 * np.fft.rfft(path)[..., : order + 1] / SERIES_SAMPLES
    spectrum[..., 0] /= 2.0
    spectrum[abs(spectrum) < 1e-14 * abs(spectrum).max()] = 0.0
    return partial(_by_series, order=order, series=dict(zip(moving(mechanism), spectrum.tolist(), strict=True)))


def _by_series(mechanism, angle, order, series):
    turns = list(_multiples(ray(angle), order))
    joints = {
        name: Joint(*(tuple(_summed(row, turns, k) for row in rows) for k in range(3))) for name, rows in series.items()
    }
    return assembled(mechanism, angle, joints)


def _multiples(ray, order):
    """Unit vectors at 1, 2 ... times the crank angle."""
    multiple = ray
    for _ in range(order):
        yield multiple
        multiple = turned(multiple, ray)


def _summed(coefficients, turns, derivative):
    """Derivative of the real part of the series, sum of a conj(turn), over its harmonics; absent terms left out."""
    total = coefficients[0].real if derivative == 0 else 0.0
    for k, (coefficient, (cosine, sine)) in enumerate(zip(coefficients[1:], turns, strict=True), 1):
        factor = coefficient * (1j * k) ** derivative
        for part, function in ((factor.real, cosine), (-factor.imag, sine)):
            if part != 0.0:
                total = total + part * function
    return total

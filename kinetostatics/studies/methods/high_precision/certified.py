"""Certified references: quantities confirmed by two independent paths, and periodic running to many digits.

The two paths share no formula: the library's kernels on intervals (`enclosures`), and mpmath with independent formulas
(`independent`). `exact_speed` solves periodic running by collocation at Chebyshev points between the kinks of the
loads, with arb numbers of `WORKING_BITS` bits. Newton's iteration is on the energy U, dU/dphi = motor torque - load
torque. The number of points rises until the speed changes by less than `SPEED_TOLERANCE`.
"""

from dataclasses import replace

import numpy as np
from numpy.polynomial.chebyshev import chebint

from ....errors import KinetostaticsError, NotGivenError
from ....mechanics import energy_contact
from ....mechanics.jamming import with_passes
from ....mechanics.quantities import largest_term
from ....numbers.parameter_tree import replace_unchecked
from .enclosures import Enclosure, enclosure, magnitude, on_arb, place_text, require_library
from .independent import independent, working_digits


def certified(solution, quantity, digits=30, checks=8) -> Enclosure:
    """Enclosure of a quantity, confirmed by the independent path.

    Parameters
    ----------
    solution : Solution
        Solution of one design.
    quantity : str
        As for `quantities.components`.
    digits : int
        Radius and disagreement are at most 10^-digits of the largest value.
    checks : int
        Number of crank angles, evenly chosen, at which the two paths are compared.

    Returns
    -------
    Enclosure

    Raises
    ------
    KinetostaticsError
        The paths disagree.
    NotGivenError
        A load or cam is computed in double precision only, or a crank angle is at a limit position.
    MissingLibraryError
        python-flint or mpmath is not installed.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> found = ks.precision.certified(s, "O", checks=2)
    >>> found.agreement < 1e-30
    True
    """
    more = with_passes(solution, solution.friction.passes + 1) if solution.friction else solution
    found = enclosure(more, quantity, digits)
    mp = require_library("mpmath").mp
    count = len(found.middle[0])
    indices = np.unique(np.arange(checks) * count // checks)
    unit = found.largest or largest_term(solution, quantity) or 1.0
    agreement = 0.0
    with mp.workdps(working_digits(digits)):
        for index, *other in zip(indices, *independent(solution, quantity, indices, digits), strict=True):
            own = [mp.mpf(part[index]) for part in found.exact]
            gap = mp.norm([a - b for a, b in zip(own, other, strict=True)]) / unit
            if not gap <= mp.mpf(10) ** -digits:
                ours, theirs = (", ".join(mp.nstr(part, digits + 3) for part in parts) for parts in (own, other))
                raise KinetostaticsError(
                    f"{place_text(solution, index)}: {quantity} is {ours} by the library's kernels but {theirs} by the "
                    f"independent path; they differ by {mp.nstr(gap, 3)} of the largest value, more than 1e-{digits}"
                )
            agreement = max(agreement, float(gap))
    return replace(found, agreement=agreement)


def relative_errors(found, reference: Enclosure):
    """Errors of computed components at each crank angle, relative to the largest value of the reference.

    An error is the magnitude of the exact difference: double minus unrounded reference.

    Parameters
    ----------
    found : tuple of arrays (N,)
        Components as of `quantities.components`, or exact ones of another `Enclosure`; NaN and infinity are unchanged.
    reference : Enclosure

    Returns
    -------
    array (N,)

    Raises
    ------
    MissingLibraryError
        python-flint is not installed.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> reference = ks.precision.enclosure(s, "O")
    >>> bool(ks.precision.relative_errors(ks.precision.components(s, "O"), reference).max() < 1e-15)
    True
    """
    flint = require_library("flint")
    difference = np.frompyfunc(lambda value, exact: float(flint.arb(value) - exact), 2, 1)
    with flint.ctx.workprec(reference.bits):
        pairs = zip(found, reference.exact, strict=True)
        parts = [np.asarray(difference(values, exact), dtype=float) for values, exact in pairs]
    errors = magnitude(parts)
    return errors / reference.largest if reference.largest else np.where(errors > 0, np.inf, errors)


WORKING_BITS, SPEED_TOLERANCE = 300, 1e-22
MIN_PIECES = 8
"""Equal pieces of a period, further divided at kinks."""
MIN_PIECE_POINTS, MAX_PIECE_POINTS = 24, 96
"""Collocation points of a piece, first and largest number."""


def exact_speed(driven, angles):
    """Crank speeds, rad/s, of periodic running of a `DrivenMachine` at crank angles in (0, period), as nearest doubles.

    `NotGivenError`: loads depend on the speed, or are computed in double precision only.
    """
    if driven.by_speed:
        raise NotGivenError("exact running is for loads that do not depend on the speed")
    flint = require_library("flint")
    with flint.ctx.workprec(WORKING_BITS):
        found = None
        for points in range(MIN_PIECE_POINTS, MAX_PIECE_POINTS + 1, 8):
            before, found = found, _collocate(flint, driven, angles, points)
            if before and max(abs(one / two - 1) for one, two in zip(found, before, strict=True)) < SPEED_TOLERANCE:
                return np.array([float(speed) for speed in found])
    raise NotGivenError(f"{driven.scene.mechanism.name}: running is not resolved by {MAX_PIECE_POINTS} points a piece")


def _collocate(flint, driven, angles, points):
    """Speeds at crank angles, arb numbers, with a number of collocation points in each piece.

    Unknowns are the energies at the points and, last, at the start of each piece. Newton's corrections are found in
    double precision, from residuals to all bits.
    """
    motor, way = driven.motor, driven.direction
    edges = np.unique(np.concatenate([np.linspace(0.0, driven.period, MIN_PIECES + 1), driven.kinks]))
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    nodes = middle[:, None] - half[:, None] * np.cos(np.pi * (np.arange(points) + 0.5) / points)
    pieces = [_CollocationPiece(flint, *piece) for piece in zip(edges[:-1], edges[1:], nodes, strict=True)]
    integrals = [piece.integrals([*row, high]) for piece, row, high in zip(pieces, nodes, edges[1:], strict=True)]
    inertia, load = (part.reshape(nodes.shape) for part in _inertia_and_load(flint.arb, driven, nodes.ravel()))

    def torque(energy, inertia, load):
        """dU/dphi and its derivative by U."""
        speed = way * (2 * energy / inertia).sqrt()
        return motor.torque_at_crank(speed) - load, float(motor.slope_at_crank(speed) / (inertia * speed))

    guess = float(motor.field_speed or motor.top / 2.0) / abs(motor.transmission)
    energies = np.full((len(pieces), points + 1), max(inertia[0], key=float) * guess**2 / 2)
    for _ in range(40):
        torques, slopes = np.frompyfunc(torque, 3, 2)(energies[:, :-1], inertia, load)
        ahead = np.concatenate([energies[:, :-1], np.roll(energies[:, -1:], -1, axis=0)], axis=1)
        gained = np.array([matrix @ row for matrix, row in zip(integrals, torques, strict=True)])
        change = _newton_correction(integrals, slopes, energies[:, -1:] + gained - ahead)
        energies = np.frompyfunc(lambda value, more: (value + more).mid(), 2, 1)(energies, change)
        if np.abs(change).max() < 1e-40 * float(energies.max()):
            break
    torques, _ = np.frompyfunc(torque, 3, 2)(energies[:, :-1], inertia, load)
    own, _ = _inertia_and_load(flint.arb, driven, np.asarray(angles, dtype=float))
    places = np.searchsorted(edges, angles, side="right") - 1
    found = [
        energies[k, -1] + pieces[k].integrals([angle])[0] @ torques[k] for k, angle in zip(places, angles, strict=True)
    ]
    return [(way * (2 * energy / one).sqrt()).mid() for energy, one in zip(found, own, strict=True)]


def _newton_correction(integrals, slopes, residual):
    """Change of the energies that makes their residual vanish to first order."""
    pieces, size = residual.shape
    jacobian = np.zeros((pieces, size, pieces, size))
    for k, matrix in enumerate(integrals):
        jacobian[k, :, k, :-1] = (matrix * slopes[k]).astype(float) - np.eye(size, size - 1)
        jacobian[k, :, k, -1] = 1.0
        jacobian[k, -1, (k + 1) % pieces, -1] -= 1.0
    change = np.linalg.solve(jacobian.reshape(residual.size, -1), -residual.astype(float).ravel())
    return change.reshape(residual.shape)


class _CollocationPiece:
    """Collocation points of a piece; values between them are those of a polynomial."""

    def __init__(self, flint, low, high, nodes):
        self.flint, self.middle, self.half = flint, (flint.arb(low) + high) / 2, (flint.arb(high) - low) / 2
        integrated = chebint(np.vectorize(flint.arb)(np.eye(len(nodes))), lbnd=-1)
        self.weights = self.half * flint.arb_mat(integrated.tolist()) * self._polynomials(nodes, len(nodes)).inv()

    def _polynomials(self, angles, count):
        """Chebyshev polynomials of the piece at angles, a row for each angle."""
        places = [(float(angle) - self.middle) / self.half for angle in angles]
        return self.flint.arb_mat([[place.chebyshev_t(k) for k in range(count)] for place in places])

    def integrals(self, angles):
        """Weights, (angles, points), of the values at the points in the integral from the start to each angle."""
        return np.array((self._polynomials(angles, self.weights.nrows()) * self.weights).tolist(), dtype=object)


def _inertia_and_load(arb, driven, angle):
    """Inertia at the crank, kg m2, and load torque, N m, at crank angles, arrays (N,) of arb numbers."""
    scene = replace_unchecked(driven.scene, crank_speed=1.0, crank_acceleration=0.0)
    run = on_arb(arb, scene.unsolved(angle))
    inertia, load = energy_contact.reduced_inertia(run), energy_contact.load_torque(run)
    middle = np.frompyfunc(lambda value: arb(value).mid(), 1, 1)
    shape = np.zeros(angle.shape)
    links, asked = (middle(shape if part is None else part + shape) for part in (inertia, load))
    return links + arb(driven.flywheel), asked

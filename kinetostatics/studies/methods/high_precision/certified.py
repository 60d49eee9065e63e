"""Certified references: quantities confirmed by two independent paths, and periodic running to many digits.

The two paths share no formula: the library's kernels on intervals (`enclosures`), and mpmath with formulas of its own
(`independent`). `exact_speed` solves periodic running by collocation at Chebyshev points between the kinks of the
loads, with arb numbers of `WORKING_BITS` bits; Newton's iteration is on the energy U, dU/dphi = motor torque - load
torque. The number of points rises until the speed changes by less than `SPEED_TOLERANCE`.
"""

import itertools
from dataclasses import replace

import numpy as np

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
        Of one design.
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
        A load or cam is computed in double precision only, or a crank angle lies at a limit position.
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
        Components as of `quantities.components`, or exact ones of another `Enclosure`; NaN and infinity stay.
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

    def difference(value, exact):
        if isinstance(value, flint.arb):
            return float(value - exact)
        return float(flint.arb(float(value)) - exact) if np.isfinite(value) else abs(float(value))

    with flint.ctx.workprec(reference.bits):
        parts = [
            np.array([difference(*pair) for pair in zip(np.broadcast_to(values, exact.shape), exact, strict=True)])
            for values, exact in zip(found, reference.exact, strict=True)
        ]
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
    """Speeds at crank angles, arb numbers, with a number of points in each piece."""
    arb = flint.arb
    edges = np.unique(np.concatenate([np.linspace(0.0, driven.period, MIN_PIECES + 1), driven.kinks]))
    pieces = [_CollocationPiece(flint, driven, low, high, points) for low, high in itertools.pairwise(edges)]
    motor, way = driven.motor, driven.direction
    start = max(pieces[0].inertia, key=float)
    guess = float(motor.field_speed or motor.top / 2.0) / abs(motor.transmission)
    energies = [[start * guess**2 / 2] * points for _ in pieces]
    for _ in range(40):
        steps = [piece.step(values, motor, way) for piece, values in zip(pieces, energies, strict=True)]
        ends, added = arb(1), arb(0)
        for _, _, growth, gained in steps:
            ends, added = ends * growth, added * growth + gained
        left, change = added / (1 - ends), arb(0)
        for number, (homogeneous, particular, growth, gained) in enumerate(steps):
            new = [left * one + two for one, two in zip(homogeneous, particular, strict=True)]
            changes = (abs(a / b - 1).mid() for a, b in zip(new, energies[number], strict=True))
            change = max([change, *changes], key=float)
            energies[number] = [value.mid() for value in new]
            left = (left * growth + gained).mid()
        if float(change) < 1e-40:
            break
    places = zip(np.searchsorted(edges, angles, side="right") - 1, angles, strict=True)
    return [pieces[place].speed(energies[place], float(angle), driven) for place, angle in places]


class _CollocationPiece:
    """Collocation points of a piece, inertia and load torque there, and the matrix that integrates from its start."""

    def __init__(self, flint, driven, low, high, points):
        self.flint, self.low, self.high = flint, flint.arb(low), flint.arb(high)
        angle = 0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.pi * (np.arange(points) + 0.5) / points)
        self.inertia, self.load = _inertia_and_load(flint.arb, driven, angle)
        basis = flint.arb_mat([self._basis(flint.arb(float(one)), points) for one in angle])
        integrals = flint.arb_mat([self._integrals(flint.arb(float(one)), points) for one in angle])
        self.inverse = basis.inv()
        self.integral = integrals * self.inverse
        self.whole = flint.arb_mat([self._integrals(self.high, points)]) * self.inverse

    def _basis(self, angle, points):
        """Chebyshev polynomials at an angle."""
        x = (2 * angle - self.low - self.high) / (self.high - self.low)
        return [x.chebyshev_t(k) for k in range(points)]

    def _integrals(self, angle, points):
        """Integrals of the Chebyshev polynomials from the start of the piece."""
        half = (self.high - self.low) / 2

        def primitive(at):
            values = self._basis(at, points + 1)
            yield values[1]
            yield values[1] * values[1] / 2
            for k in range(2, points):
                yield values[k + 1] / (2 * (k + 1)) - values[k - 1] / (2 * (k - 1))

        return [half * (end - begin) for end, begin in zip(primitive(angle), primitive(self.low), strict=True)]

    def step(self, energies, motor, way):
        """Newton's linear equation u' = a u + g: solutions from 1 without g and from 0 with it, and their ends."""
        flint, count = self.flint, len(energies)
        slopes, rests = [], []
        for value, inertia, load in zip(energies, self.inertia, self.load, strict=True):
            speed = way * (2 * value / inertia).sqrt()
            slope = motor.slope_at_crank(speed) / (inertia * speed)
            slopes.append(slope)
            rests.append(motor.torque_at_crank(speed) - load - slope * value)
        places = range(count)
        matrix = flint.arb_mat([[(i == j) - self.integral[i, j] * slopes[j] for j in places] for i in places])
        right = self.integral * flint.arb_mat([[rest] for rest in rests])
        found = matrix.solve(flint.arb_mat([[1, right[i, 0]] for i in range(count)]))
        homogeneous = [found[i, 0].mid() for i in range(count)]
        particular = [found[i, 1].mid() for i in range(count)]
        growth = 1 + sum(self.whole[0, j] * slopes[j] * homogeneous[j] for j in range(count))
        gained = sum(self.whole[0, j] * (slopes[j] * particular[j] + rests[j]) for j in range(count))
        return homogeneous, particular, growth.mid(), gained.mid()

    def speed(self, energies, angle, driven):
        """Crank speed at a crank angle in the piece."""
        flint, count = self.flint, len(energies)
        series = self.inverse * flint.arb_mat([[value] for value in energies])
        basis = self._basis(flint.arb(angle), count)
        value = sum(basis[k] * series[k, 0] for k in range(count))
        inertia = _inertia_and_load(flint.arb, driven, np.array([angle]))[0][0]
        return (driven.direction * (2 * value / inertia).sqrt()).mid()


def _inertia_and_load(arb, driven, angle):
    """Inertia at the crank, kg m2, and load torque, N m, at crank angles, lists of arb numbers."""
    scene = replace_unchecked(driven.scene, crank_speed=1.0, crank_acceleration=0.0)
    run = on_arb(arb, scene.unsolved(angle))
    inertia, load = energy_contact.reduced_inertia(run), energy_contact.load_torque(run)
    links = [arb(0)] * angle.size if inertia is None else [arb(value).mid() for value in inertia]
    asked = np.zeros(angle.size) if load is None else np.broadcast_to(load, angle.shape)
    return [value + arb(driven.flywheel) for value in links], [arb(value).mid() for value in asked]

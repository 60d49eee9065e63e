"""Periodic running at many digits: what methods for it are measured against.

The library's kernels on arb numbers give inertia and load torque at Chebyshev points between the kinks of the loads;
Newton's iteration on the energy U with dU/dphi = motor torque - load torque by collocation there, at `BITS` bits. The
number of points is raised until the result stands still to `DIGITS`.
"""

import itertools

import numpy as np

from ....errors import NotGivenError
from ....mechanics import energy_contact
from ....numbers.parameter_tree import with_fields
from .enclosures import library, on_arb

BITS, DIGITS = 300, 1e-22
PIECES = 8
"""Pieces of a period, besides those between kinks."""
POINTS, MOST = 24, 96
"""Points of a piece, at first and at last."""


def exact_speed(driven, angles):
    """Crank speeds in periodic running at crank angles in (0, period), rad/s, rounded to the nearest double.

    Parameters
    ----------
    driven : Driven
        Scene, motor and flywheel; loads must not depend on the speed.
    angles : array (N,)

    Raises
    ------
    NotGivenError
        Loads depend on the speed, or are computed in double precision only.
    MissingLibraryError
        python-flint is not installed.
    """
    if driven.by_speed:
        raise NotGivenError("exact running is for loads that do not depend on the speed")
    flint = library("flint")
    with flint.ctx.workprec(BITS):
        before, points = None, POINTS
        while points <= MOST:
            found = _collocated(flint, driven, angles, points)
            if before is not None and max(abs(one / two - 1) for one, two in zip(found, before, strict=True)) < DIGITS:
                return np.array([float(speed) for speed in found])
            before, points = found, points + 8
    raise NotGivenError(f"{driven.scene.mechanism.name}: running is not resolved by {MOST} points a piece")


def _collocated(flint, driven, angles, points):
    """Speeds at crank angles, arb numbers, by so many points in each piece."""
    arb = flint.arb
    edges = np.unique(np.concatenate([np.linspace(0.0, driven.period, PIECES + 1), driven.kinks]))
    pieces = [_Piece(flint, driven, low, high, points) for low, high in itertools.pairwise(edges)]
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
            change = max(
                [change, *(abs(a / b - 1).mid() for a, b in zip(new, energies[number], strict=True))], key=float
            )
            energies[number] = [value.mid() for value in new]
            left = (left * growth + gained).mid()
        if float(change) < 1e-40:
            break
    places = np.searchsorted(edges, angles, side="right") - 1
    return [
        pieces[place].speed(energies[place], float(angle), driven) for place, angle in zip(places, angles, strict=True)
    ]


class _Piece:
    """Points of a piece as doubles, inertia and load torque there, and the matrix that integrates from its start."""

    def __init__(self, flint, driven, low, high, points):
        self.flint, self.low, self.high = flint, flint.arb(low), flint.arb(high)
        angle = 0.5 * (low + high) - 0.5 * (high - low) * np.cos(np.pi * (np.arange(points) + 0.5) / points)
        self.inertia, self.load = _kernels(flint.arb, driven, angle)
        basis = flint.arb_mat([self._basis(flint.arb(float(one)), points) for one in angle])
        integrals = flint.arb_mat([self._integrals(flint.arb(float(one)), points) for one in angle])
        self.inverse = basis.inv()
        self.integral = integrals * self.inverse
        self.whole = flint.arb_mat([self._integrals(self.high, points)]) * self.inverse

    def _place(self, angle):
        return (2 * angle - self.low - self.high) / (self.high - self.low)

    def _basis(self, angle, points):
        x, found = self._place(angle), [self.flint.arb(1)]
        found.append(x)
        while len(found) < points:
            found.append(2 * x * found[-1] - found[-2])
        return found[:points]

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
        """Newton's linear equation u' = a u + g: its solutions from 1 without g, and from 0 with it, and their ends."""
        flint, count = self.flint, len(energies)
        slopes, rests = [], []
        for value, inertia, load in zip(energies, self.inertia, self.load, strict=True):
            speed = way * (2 * value / inertia).sqrt()
            slope = motor.slope_at_crank(speed) / (inertia * speed)
            slopes.append(slope)
            rests.append(motor.torque_at_crank(speed) - load - slope * value)
        matrix = flint.arb_mat(
            [[(i == j) - self.integral[i, j] * slopes[j] for j in range(count)] for i in range(count)]
        )
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
        inertia = _kernels(flint.arb, driven, np.array([angle]))[0][0]
        return (driven.direction * (2 * value / inertia).sqrt()).mid()


def _kernels(arb, driven, angle):
    """Inertia at the crank and load torque at crank angles, lists of arb numbers."""
    scene = with_fields(driven.scene, crank_speed=1.0, crank_acceleration=0.0)
    run = on_arb(arb, scene.unsolved(angle))
    inertia, load = energy_contact.reduced_inertia(run), energy_contact.load_torque(run)
    links = [arb(0)] * angle.size if inertia is None else [arb(value).mid() for value in inertia]
    asked = np.zeros(angle.size) if load is None else np.broadcast_to(load, angle.shape)
    return [value + arb(driven.flywheel) for value in links], [arb(value).mid() for value in asked]

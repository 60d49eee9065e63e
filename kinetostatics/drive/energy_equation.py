"""Kinetic energy of a machine over the crank angle, periodic or from a start, exact to rounding.

The energy U = (Jf + J(phi)) omega^2 / 2 obeys dU/dphi = motor torque - load torque, which needs no derivative of J and
is smooth between the kinks. Newton's method linearises this to u' = a u + g, with a = d(net torque)/dU, and solves it
by its integrating factor in Chebyshev series; about four steps reach rounding.
"""

import math
from functools import partial, reduce
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from ..cycle.piecewise import MAX_HALVINGS, MAX_PIECES, TAIL
from .resolution import MAX_ROUNDS, split_at_kinks, weights

MAX_GROWTH_EXPONENT = 4.0
"""Largest integral of a over a piece; a larger one costs digits."""
SPEED_ROUNDING = 1e-14
"""Rounding of the speed, relative; the motor's slope turns it into rounding of the torque."""
MAX_NEWTON_STEPS = 40
MAX_STEPS_FROM_START = 12
"""Newton steps of a motion from a start; after a failure the next attempt has half the angle."""
EPSILON = float(np.finfo(float).eps)
STEPS_BELOW_ZERO = 2
"""Number of steps from a start after which an energy below 0 counts as a standstill."""
MIN_STEP_SHARE = 0.3
"""Share of a step from a start that keeps the energy above 0; with less it counts as a standstill at once."""
ENERGY_TOLERANCE = 1e-14
MAX_NEAR_CHANGE = 1e-2
"""Relative change of the energy in a step after which the derivatives are kept."""


class StandstillError(Exception):
    """The energy falls to 0 about at a crank angle, rad."""

    def __init__(self, angle):
        super().__init__(f"the motion stops at crank angle {angle:.9g} rad")
        self.angle = float(angle)


class Linear(NamedTuple):
    """A machine at the points of pieces: its state, total inertia, speed, net torque and a = d(net torque)/dU.

    `motion` is that of `DrivenMachine.motion_with_friction`.
    """

    state: Any
    inertia: np.ndarray
    speed: np.ndarray
    net: np.ndarray
    growth: np.ndarray
    motion: Any = None


def linearise(driven, pieces, energy, near=None) -> Linear:
    """Torques of a machine with given energies at the points of pieces, linearised; `near` is that at near energies."""
    angle = pieces.angle
    inertia = driven.inertia(angle)
    speed = driven.direction * np.sqrt(2.0 * energy / inertia)
    state = driven.at(angle, speed, near and near.motion)
    motion = driven.motion_with_friction
    if near is None:
        outputs = driven.motor_slope(speed) - driven.torque_by_speed(angle, speed, state.torque)
        growth = outputs / (inertia * speed)
        growth = pieces.smoothed(growth) if driven.smooth_by_speed else growth
    else:
        growth = near.growth
    return Linear(state, inertia, speed, driven.motor_torque(speed) - state.torque, growth, motion)


def solve_energy(driven, pieces, energy, start=None, near=None):
    """Energy at the points near a guess, energy at the far end, and the `Linear`; None without convergence.

    `start` is the energy where the motion enters the pieces; without it running is periodic, and stable. `near` is the
    `Linear` of near energies at the points. `StandstillError` if a motion from a start stops.
    """
    before = math.inf
    for step in range(MAX_NEWTON_STEPS if start is None else MAX_STEPS_FROM_START):
        linear = linearise(driven, pieces, energy, near)
        solution = _linear_solution(pieces, linear.growth, linear.net - linear.growth * energy, start, driven.direction)
        if solution is None:
            return None
        found, far = solution
        change, factor = found - energy, 1.0
        if not found.min() > 0.0:
            falling = change < 0.0
            factor = 0.7 * float(np.min(energy[falling] / -change[falling]))
            if start is not None and (step >= STEPS_BELOW_ZERO or factor < MIN_STEP_SHARE):
                raise StandstillError(pieces.angle[found <= 0.0][0 if driven.direction > 0.0 else -1])
            if factor < 1e-6:
                return None
        energy = energy + factor * change
        size = float(np.abs(change).max() / np.abs(energy).max())
        slow = size >= 0.1 * before
        if factor == 1.0 and (size < ENERGY_TOLERANCE or (near is None and size < 1e-10 and slow)):
            if start is not None and not far > 0.0:
                raise StandstillError(pieces.edges[-1 if driven.direction > 0.0 else 0])
            stable = start is not None or driven.direction * pieces.whole_integral(linear.growth) < 0.0
            return (energy, far, linear) if stable else None
        near = linear if size < MAX_NEAR_CHANGE and not slow else None
        before = size
    return None


def _linear_solution(pieces, growth, rest, start, direction):
    """Solution of u' = growth u + rest and its value at the far end; None where it overflows or is not unique.

    It begins with `start` at the end where the motion enters, or is periodic.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        raised = pieces.integral_in_piece(growth)
        gathered = pieces.integral_in_piece(rest * np.exp(-raised))
        ends = np.exp(pieces.piece_integrals(growth))
        added = ends * pieces.piece_integrals(rest * np.exp(-raised))
    if not (np.isfinite(ends).all() and np.isfinite(added).all()):
        return None
    chain = list(zip(ends.tolist(), added.tolist(), strict=True))
    whole = pieces.whole_integral(growth)
    if start is None and not abs(whole) > 1e-15:
        return None
    if direction > 0.0 if start is not None else whole < 0.0:
        values = _chain(chain, lambda value, piece: value * piece[0] + piece[1], start, whole)
        starts = values[:-1]
    else:  # backward, where errors decay or the motion goes
        values = _chain(chain[::-1], lambda value, piece: (value - piece[1]) / piece[0], start, -whole)
        starts = values[:0:-1]
    return np.exp(raised) * (np.array(starts)[:, None] + gathered), values[-1]


def _chain(chain, step, start, exponent):
    """Values before, between and after linear steps from `start`; None: periodic, with the product exp(exponent)."""
    if start is None:
        start = reduce(step, chain, 0.0) / -math.expm1(exponent)
    return list(accumulate(chain, step, initial=start))


def resolve_energy(driven, pieces, found, kinks, again):
    """Pieces split at kinks of friction and halved until all series are exact; with the last solution, and the kinks.

    Parameters
    ----------
    found : tuple
        Result of `solve_energy` on the pieces.
    kinks : array
        Crank angles of kinks of friction among the edges, which move.
    again : function
        From finer pieces, a guess of the energy, a function of pieces, and a `Linear` of near energies, to pieces and
        a solution; or to None, which ends the search.
    """

    def rows(pieces, found):
        return driven.kink_rows(pieces.angle, found[2].speed)

    def solve(finer, old, found):
        energy, _, linear = found

        def on(values, pieces):
            return old.evaluate(old.series(values), pieces.angle)

        motion = linear.motion and [on(values, finer) for values in linear.motion]
        return again(finer, partial(on, energy), linear._replace(growth=on(linear.growth, finer), motion=motion))

    return refine(driven, pieces, found, kinks, rows, partial(_unresolved, driven), solve)


def refine(driven, pieces, found, kinks, rows, unresolved, solve):
    """Pieces split at kinks of friction and then halved, the last solution on them, and the kinks; or None.

    Parameters
    ----------
    found : tuple
        Solution on the pieces.
    kinks : array
        Crank angles of kinks of friction among the edges, which move.
    rows, unresolved : functions
        From pieces and a solution to `kink_rows`, and to a mask of the pieces to halve.
    solve : function
        From finer pieces, the pieces before and their solution to pieces and their solution; or to None.
    """
    for step in range(MAX_ROUNDS + MAX_HALVINGS):
        moved = split_at_kinks(driven, pieces, rows(pieces, found) if step < MAX_ROUNDS else [], kinks)
        if moved is not None:
            finer, kinks = moved
        else:
            marked = unresolved(pieces, found)
            if not marked.any() or len(pieces.half) > MAX_PIECES:
                break
            finer = pieces.split(marked)
        solved = solve(finer, pieces, found)
        if solved is None:
            return None
        pieces, found = solved
    return pieces, found, kinks


def _unresolved(driven, pieces, found):
    """Mask of the pieces whose series are not resolved and that can be halved."""
    energy, _, (state, inertia, speed, net, growth, _) = found
    wide = np.abs(pieces.piece_integrals(growth)) > MAX_GROWTH_EXPONENT
    rounding = max(SPEED_ROUNDING * np.abs(driven.motor_slope(speed) * speed).max(), EPSILON * energy.max())
    floor = max(10.0 * TAIL * max(np.abs(state.torque).max(), np.abs(net + state.torque).max()), rounding)
    rough = pieces.tails(net) * weights(pieces) > floor
    tails = [pieces.tail(part) > TAIL for part in (energy, inertia)]
    tails += [pieces.tail(part) > 10.0 * TAIL for part in (speed, 1.0 / speed)]
    return (np.any([wide, rough, *tails], axis=0)) & pieces.can_split

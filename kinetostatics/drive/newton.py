"""Newton's iteration on the energy of periodic running.

The state is U = (Jf + J(phi)) omega^2 / 2 as a function of the crank angle: dU/dphi = motor torque - load torque, with
no derivative of J. Each step is a linear equation u' = a u + g that is solved by its integrating factor in Chebyshev
series between the kinks; it converges to rounding in about four steps.
"""

import math

import numpy as np

from .pieces import MOST_PIECES, TAIL, Pieces

STIFF = 4.0
"""Integral of a over a piece, at most: more takes digits."""
ROUNDED = 1e-14
"""Relative change of speed that is rounding, for what a motor's torque makes of it."""
STEPS = 40
HALVED = 3
"""How often all pieces are halved where the iteration does not settle, as that of stiff motors on wide ones."""
CONVERGED = 1e-14


def interpolated(pieces, energy):
    """Energy as a function of other pieces."""
    series = pieces.series(energy)
    return lambda finer: pieces.evaluate(series, finer.angle)


def settled(driven, pieces, guess):
    """Pieces and energy of periodic running near a guess, a function of pieces, halved while that helps; or None."""
    for halving in range(HALVED + 1):
        if halving:
            pieces = pieces.split(pieces.can_split)
        pieces = _yielding(driven, pieces, guess)
        energy = _newton(driven, pieces, guess(pieces))
        if energy is not None:
            return pieces, energy
    return None


def _yielding(driven, pieces, guess):
    """Pieces divided where the motor is stiff, as near a guess."""
    _, _, _, growth = looked_at(driven, pieces, guess(pieces))
    parts = np.ceil(np.fmin(np.abs(pieces.whole(growth)) / STIFF, MOST_PIECES + 1.0)).astype(int)
    if parts.max() <= 1 or parts.sum() > MOST_PIECES:
        return pieces
    spans = zip(pieces.edges[:-1], pieces.edges[1:], parts, strict=True)
    edges = [np.linspace(low, high, max(count, 1), endpoint=False) for low, high, count in spans]
    return Pieces(np.concatenate([*edges, pieces.edges[-1:]]), pieces.count)


def unresolved(driven, pieces, energy):
    """Which pieces have series that are not done, and can be halved."""
    state, inertia, speed, growth = looked_at(driven, pieces, energy)
    drive = driven.motor_torque(speed)
    wide = np.abs(pieces.whole(growth)) > STIFF
    rounding = ROUNDED * np.abs(driven.motor.slope_at_crank(speed) * speed).max()
    floor = max(10.0 * TAIL * max(np.abs(state.torque).max(), np.abs(drive).max()), rounding)
    rough = np.abs(pieces.series(drive - state.torque)[-3:]).max(axis=0) > floor
    tails = [pieces.tail(part) > TAIL for part in (energy, inertia)]
    tails.append(pieces.tail(speed) > 10.0 * TAIL)
    return (np.any([wide, rough, *tails], axis=0)) & pieces.can_split


def looked_at(driven, pieces, energy, state=None):
    """State, inertia, speed, and derivative of the net torque by U, at the points of pieces."""
    angle = pieces.angle
    if driven.by_speed:
        inertia = driven.inertia(angle)
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
        state = driven.at(angle, speed)
    else:
        state = state or driven.at(angle)
        inertia = driven.flywheel + state.inertia
        speed = driven.direction * np.sqrt(2.0 * energy / inertia)
    by_speed = driven.motor.slope_at_crank(speed) - driven.torque_by_speed(angle, speed, state.torque)
    growth = by_speed / (inertia * speed)
    return state, inertia, speed, pieces.smoothed(growth) if driven.smooth_by_speed else growth


def _newton(driven, pieces, energy):
    """Energy U of periodic running near a guess; None if the iteration does not settle on stable running."""
    state, before = None, math.inf
    for _ in range(STEPS):
        state, _, speed, growth = looked_at(driven, pieces, energy, state)
        net = driven.motor_torque(speed) - state.torque
        found = _periodic(pieces, growth, net - growth * energy)
        if found is None:
            return None
        change, factor = found - energy, 1.0
        if not found.min() > 0.0:
            falling = change < 0.0
            factor = 0.7 * float(np.min(energy[falling] / -change[falling]))
            if factor < 1e-6:
                return None
        energy = energy + factor * change
        size = float(np.abs(change).max() / np.abs(energy).max())
        if factor == 1.0 and (size < CONVERGED or (size < 1e-10 and size >= 0.1 * before)):
            stable = driven.direction * pieces.total(growth) < 0.0
            return energy if stable else None
        before = size
    return None


def _periodic(pieces, growth, rest):
    """Periodic solution of u' = growth u + rest; None where it grows over the period, or neither grows nor fades."""
    with np.errstate(over="ignore", invalid="ignore"):
        raised = pieces.integral(growth)
        gathered = pieces.integral(rest * np.exp(-raised))
        ends = np.exp(pieces.whole(growth))
        added = ends * pieces.whole(rest * np.exp(-raised))
    if not (np.isfinite(ends).all() and np.isfinite(added).all()):
        return None
    whole = pieces.total(growth)
    if not abs(whole) > 1e-15:
        return None
    chain = list(zip(ends.tolist(), added.tolist(), strict=True))
    if whole < 0.0:
        value = 0.0
        for end, part in chain:
            value = value * end + part
        left, value = [], value / -math.expm1(whole)
        for end, part in chain:
            left.append(value)
            value = value * end + part
    else:  # the way in which differences fade
        value = 0.0
        for end, part in reversed(chain):
            value = (value - part) / end
        left, value = [], value / -math.expm1(-whole)
        for end, part in reversed(chain):
            value = (value - part) / end
            left.insert(0, value)
    return np.exp(raised) * (np.array(left)[:, None] + gathered)

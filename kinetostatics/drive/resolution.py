"""Pieces of a turn in which a machine's inertia and load torque are Chebyshev series to rounding."""

import itertools
import math

import numpy as np

from ..errors import DriveError
from ..machine.loads import TURN
from .bends import NONE, parted
from .pieces import LEVELS, MOST_PIECES, TAIL, Pieces

POINTS, FEW_POINTS, MANY = 24, 12, 60
"""Points of a piece, and those where there are so many pieces."""
WIDEST = TURN / 6
ROUNDS = 8
"""How often kinks of friction are looked for anew, at most."""
JUMP = 1e-9
"""Difference of values, relative to the largest, from both sides of an edge that is a jump."""
UNRESOLVED = 1e-6
"""Share of a torque in pieces that are not done with which no running can be trusted."""
VANISHING = 1e-10
"""Smallest inertia, relative to the largest, with which there is a speed."""


def resolved(driven, speed):
    """Pieces in which inertia and torque at a speed are series that are done."""
    return resolved_with_bends(driven, speed)[0]


def resolved_with_bends(driven, speed):
    """The same, and crank angles of bends of friction among their edges."""
    edges = _edges(np.concatenate([[0.0], driven.kinks, [driven.period]]))
    pieces, bends = _bent(driven, Pieces(edges, FEW_POINTS if len(edges) > MANY else POINTS), speed)
    pieces = _refined(driven, pieces, speed)
    width = 2.0 * pieces.half[:, 0]
    if np.any(width < 1e-6 * driven.period) or len(width) > MOST_PIECES:
        _require_resolved(driven, pieces, _state_at(driven, pieces.angle, speed).torque)
        jumps = 0.5 * (pieces.edges[:-1] + pieces.edges[1:])[~pieces.can_split]
        edges = _edges(np.unique(np.concatenate([[0.0], driven.kinks, bends, jumps, [driven.period]])))
        again = _refined(driven, Pieces(edges, pieces.count), speed)
        pieces = again if len(again.half) < len(pieces.half) else pieces
    return _with_jumps(driven, pieces, speed), bends


def _bent(driven, pieces, speed):
    """Pieces parted where friction at a speed has kinks, and the crank angles of these."""
    bends = NONE
    for _ in range(ROUNDS):
        found = parted(driven, pieces, driven.forces_at(pieces.angle, np.full(pieces.angle.shape, speed), 0.0), bends)
        if found is None:
            break
        pieces, bends = found
    return pieces, bends


def _with_jumps(driven, pieces, speed):
    """Pieces with further edges where the load torque jumps between an edge and the points beside it."""
    torque = _state_at(driven, pieces.angle, speed).torque
    both = pieces.with_ends(torque)
    starts, ends = both[:, 0], both[:, -1]
    starts = np.append(starts[1:], starts[0])
    jumping = np.flatnonzero(np.abs(ends - starts) > JUMP * np.abs(torque).max())
    known = np.isin(np.mod(pieces.edges[1:], driven.period), driven.jumps)
    jumping = jumping[~known[jumping]]
    found = []
    for piece in jumping:
        low = pieces.angle[piece, -1]
        high = pieces.angle[(piece + 1) % len(ends), 0] + (driven.period if piece + 1 == len(ends) else 0.0)
        while high - low > 1e-15 * driven.period:
            inner = np.linspace(low, high, 34)[1:-1]
            if not (inner[0] > low and inner[-1] < high):
                break
            values = _state_at(driven, np.mod(inner, driven.period), speed).torque
            after = np.abs(values - starts[piece]) < np.abs(values - ends[piece])
            first = int(np.argmax(after)) if after.any() else after.size
            bounds = np.concatenate([[low], inner, [high]])
            low, high = bounds[first], bounds[first + 1]
        found.append(high % driven.period)
    edges = np.unique(np.concatenate([pieces.edges, found]))
    return Pieces(edges, pieces.count) if found else pieces


def _state_at(driven, angle, speed):
    return driven.at_constant_speed(angle, np.full(angle.shape, speed) if driven.by_speed else None)


def _refined(driven, pieces, speed):
    for _ in range(LEVELS):
        state = _state_at(driven, pieces.angle, speed)
        marked = ((pieces.tail(state.inertia) > TAIL) | (pieces.tail(state.torque) > TAIL)) & pieces.can_split
        if not marked.any() or len(marked) > MOST_PIECES:
            break
        pieces = pieces.split(marked)
    return pieces


def _edges(breaks):
    """Edges at breaks, and between them where they are far apart."""
    parts = [np.linspace(a, b, math.ceil((b - a) / WIDEST - 1e-9) + 1)[:-1] for a, b in itertools.pairwise(breaks)]
    return np.concatenate([*parts, breaks[-1:]])


def _require_resolved(driven, pieces, torque):
    """Refuse a load torque that pieces do not resolve, as one that grows without bound."""
    size = np.abs(pieces.whole(np.abs(torque)))
    lost = pieces.half[:, 0] * np.abs(pieces.series(torque)[-3:]).max(axis=0)
    if lost.sum() > UNRESOLVED * size.sum():
        worst = int(np.argmax(lost))
        angle = float(pieces.edges[worst : worst + 2].mean())
        raise DriveError(
            f"{driven.scene.mechanism.name}: the torque of the loads cannot be resolved near crank angle "
            f"{math.degrees(angle):.6g} deg, where it reaches {np.abs(torque[worst]).max():.3g} N m: it grows without "
            "bound there, or changes too wildly; give loads that stay finite",
            crank_angle=angle,
        )


def require_inertia(driven, pieces):
    """Refuse a machine whose inertia vanishes somewhere, so that it has no speed there."""
    inertia = driven.inertia(pieces.angle)
    least, angle = pieces.largest(-inertia)
    if not -least > VANISHING * inertia.max():
        raise DriveError(
            f"{driven.scene.mechanism.name}: all inertia vanishes at crank angle {math.degrees(angle):.6g} deg "
            f"({max(-least, 0.0):.3g} kg m2, {inertia.max():.3g} at most), so there is no speed there; give a "
            "flywheel, or the crank or the rotor of the motor its inertia",
            crank_angle=angle,
        )

"""Pieces of a turn on which inertia and load torque of a machine are Chebyshev series exact to rounding.

Kinks of friction depend on speed and acceleration: solve, locate kinks, split the pieces there (`split_at_kinks`),
repeat until they stop moving. An error d of an edge changes the result by about d squared.
"""

import math
import warnings

import numpy as np

from ..cycle.load_functions import check_resolution, undeclared_functions
from ..cycle.means import TERM_ROUNDING
from ..cycle.piecewise import TAIL, Pieces, edges_between, point_count
from ..errors import DriveError, HintWarning
from ..machine.loads import TURN
from ..numbers.parameter_tree import replace_unchecked

MAX_WIDTH = TURN / 6
MAX_ROUNDS = 8
"""Rounds of locating kinks of friction."""
KINK_TOLERANCE = 1e-8
"""Negligible shift of an edge, relative to the period: its square is rounding."""
MIN_EDGE_DISTANCE = 1e-6
"""Distance of edges from a new one, relative to the period, below which they are removed."""
MIN_RESOLVED_WIDTH = 1e-6
"""Width of a piece, relative to the period, below which a torque may be without bound."""
MAX_UNRESOLVED = 1e-6
"""Largest share of a torque in unresolved pieces."""
MIN_INERTIA_RATIO = 1e-10
"""Smallest inertia, relative to the largest, at which a speed exists."""
MIN_PAST, MAX_PAST = 3, 4
"""Number of periods that predict the next ones."""
MAX_PERIODS = 8
"""Number of periods solved together."""
MAX_PREDICTED_CHANGE = 0.1
"""Relative change of the energy over these."""
MAX_PREDICTED_PIECES = 2000
MAX_ADDED_EDGES = 6
"""Largest number of edges besides those of the first period; with more a period begins with the first edges again."""
NO_ANGLES = np.empty(0)


def plain_pieces(driven, speed):
    """Pieces of the period between the kinks of loads at a speed."""
    driven.locate_kinks(speed)
    # a load function that depends on the speed may jump elsewhere at another one
    moves = driven.loads_by_speed and undeclared_functions(driven.scene.loads)
    edges = np.concatenate([[0.0], driven.kinks, [driven.period]])
    edges = edges_between(edges, 4.0 * driven.scene.resolution if moves else MAX_WIDTH)
    return Pieces(edges, point_count(edges))


def resolve_and_hint(driven, speed):
    """`resolved`, with a hint at load functions without `kinks` that change between their samples."""
    found = resolved(driven, speed)
    for text in check_resolution(driven.scene, driven.functions, driven.scene.resolution).hints:
        warnings.warn(HintWarning(driven.scene.mechanism.name, text), stacklevel=3)
    return found


def resolved(driven, speed):
    """Pieces with resolved series of inertia and torque at a speed, and the crank angles of kinks of friction."""
    pieces, kinks = plain_pieces(driven, speed), NO_ANGLES
    for _ in range(MAX_ROUNDS):
        rows = driven.kink_rows(pieces.angle, np.full(pieces.angle.shape, speed), np.zeros(pieces.angle.shape))
        split = split_at_kinks(driven, pieces, rows, kinks)
        if split is None:
            break
        pieces, kinks = split

    def evaluate(angle, _=None):
        state = driven.at_acceleration(angle, np.full(angle.shape, speed) if driven.by_speed else None, 0.0)
        return np.array([state.torque, state.inertia])

    running = replace_unchecked(driven.scene, crank_speed=speed).unsolved(pieces.angle.ravel())
    floor = TERM_ROUNDING * np.max(running.largest_torque_term)

    def rough(pieces, _, values):
        torque, inertia = values[..., 1:-1]
        level = np.maximum(TAIL * np.abs(torque).max(), floor)
        return (pieces.tails(torque) * weights(pieces) > level) | (pieces.tail(inertia) > TAIL)

    pieces, values, unresolved = pieces.resolved(evaluate(pieces.check_angles), evaluate, rough)
    if unresolved.any() or np.any(2.0 * pieces.half < MIN_RESOLVED_WIDTH * driven.period):
        _require_resolved(driven, pieces, values[0, :, 1:-1])
    return pieces, kinks


def split_at_kinks(driven, pieces, rows, before=NO_ANGLES):
    """Pieces split where rows change their signs, and these crank angles; None if all of them are edges already.

    `rows` are functions given at the points; edges at the angles `before`, found earlier, are removed.
    """
    if not rows:
        return None
    period, (first, last) = driven.period, pieces.edges[[0, -1]]
    angle = np.column_stack([pieces.edges[:-1], pieces.angle, pieces.edges[1:]]).ravel()
    zeros = []
    for value in (pieces.with_ends(row).ravel() for row in rows):  # at an edge the value appears twice
        at = np.flatnonzero((np.signbit(value[:-1]) != np.signbit(value[1:])) & (value[:-1] != value[1:]))
        found = angle[at] + (angle[at + 1] - angle[at]) * value[at] / (value[at] - value[at + 1])
        zeros.append(found[np.diff(found, prepend=-np.inf) > MIN_EDGE_DISTANCE * min(last - first, period)])
    turns = period * np.arange(math.floor(first / period), math.ceil(last / period))
    fixed = np.add.outer(turns, np.append(0.0, driven.kinks)).ravel()
    fixed = np.concatenate([[first], fixed[(fixed > first) & (fixed < last)], [last]])
    kinks = np.concatenate(zeros)
    kinks = kinks[_distance(kinks, fixed) > KINK_TOLERANCE * period]
    gap = np.abs(kinks[:, None] - pieces.edges)
    known = gap.min(axis=1) <= KINK_TOLERANCE * period
    if np.all(known):
        return None
    kinks = np.where(known, pieces.edges[gap.argmin(axis=1)], kinks)
    other = np.setdiff1d(pieces.edges, before)
    other = other[_distance(other, kinks) > MIN_EDGE_DISTANCE * min(last - first, period)]
    return Pieces(np.unique(np.concatenate([fixed, other, kinks])), pieces.count), np.unique(kinks)


def _distance(angles, others):
    """Distance of each angle to the nearest of others; infinite where there are none."""
    return np.abs(angles[:, None] - others).min(axis=1, initial=np.inf)


def weights(pieces):
    """Weights of the errors of a torque: a narrow piece adds little to the energy, and its angles are rounded."""
    return np.minimum(2.0 * pieces.half[:, 0], 1.0)


def _require_resolved(driven, pieces, torque):
    """Refuse a load torque that the pieces do not resolve: it grows without bound."""
    size = np.abs(pieces.piece_integrals(np.abs(torque)))
    lost = pieces.half[:, 0] * pieces.tails(torque)
    if lost.sum() > MAX_UNRESOLVED * size.sum():
        worst = int(np.argmax(lost))
        angle = float(pieces.edges[worst : worst + 2].mean())
        raise DriveError(
            f"{driven.scene.mechanism.name}: the torque of the loads cannot be resolved near crank angle "
            f"{math.degrees(angle):.6g} deg, where it reaches {np.abs(torque[worst]).max():.3g} N m. It grows without "
            "bound there, or changes too fast; give loads that stay finite",
            crank_angle=angle,
        )


def require_inertia(driven, pieces):
    """Refuse a machine whose inertia vanishes somewhere: it has no speed there."""
    inertia = driven.inertia(pieces.angle)
    least, angle = pieces.largest(-inertia)
    if not -least > MIN_INERTIA_RATIO * inertia.max():
        raise DriveError(
            f"{driven.scene.mechanism.name}: all inertia vanishes at crank angle {math.degrees(angle):.6g} deg "
            f"({max(-least, 0.0):.3g} kg m2, {inertia.max():.3g} at most), so there is no speed there. Give a "
            "flywheel, or the crank or the rotor of the motor its inertia",
            crank_angle=angle,
        )


class PastPeriods:
    """Pieces of the period, and the energy and kinks of the last whole periods, which predict those of the next ones.

    `past` has, for each period in order, its pieces, the series of the energy, and the kinks of friction.
    """

    def __init__(self, driven, pieces, kinks):
        self.driven, self.first, self.pieces, self.kinks = driven, pieces, pieces, kinks
        self.past: list[tuple] = []
        self.change = math.inf

    @property
    def count(self):
        """Points of a piece."""
        return self.first.count

    def periods_ahead(self, energy, reach):
        """Whole periods within a crank angle that can be predicted: a power of 2."""
        if len(self.past) < MIN_PAST:
            return 1
        most = min(MAX_PERIODS, reach / self.driven.period, MAX_PREDICTED_PIECES / self.pieces.edges.size)
        if self.change:
            most = min(most, MAX_PREDICTED_CHANGE * energy / self.change)
        return 2 ** int(math.log2(max(most, 1.0)))

    def edges_ahead(self, periods):
        """Edges of the next periods, and the kinks of friction among them."""
        kept, angles, kinks = np.setdiff1d(self.pieces.edges, self.kinks), [], []
        same = [own for *_, own in self.past if own.size == self.kinks.size]
        for number in range(1, periods + 1):
            own = self.kinks
            if len(same) == len(self.past) > 1:
                own = weights_ahead(len(same), number) @ np.array(same)
            shift = self.driven.direction * (number - 1) * self.driven.period
            own = own[(own > 0.0) & (own < self.driven.period)]
            kinks.append(own + shift)
            angles += [kept + shift, own + shift]
        return np.unique(np.concatenate(angles)), np.concatenate(kinks)

    def energy_ahead(self, pieces, energy):
        """Energy at the points of pieces of the next periods, by a polynomial in their number; at first one energy."""
        period, found = self.driven.period, np.zeros(pieces.angle.shape)
        turns = np.floor(pieces.middle / period)
        ahead = np.abs(turns - turns[0 if self.driven.direction > 0.0 else -1]) + 1.0
        angle = np.clip(pieces.angle - turns[:, None] * period, 0.0, period)
        for weight, (part, series, _) in zip(weights_ahead(len(self.past), ahead), self.past, strict=True):
            found += weight[:, None] * part.evaluate(series, angle)
        return found if found.min() > 0.0 else np.full(found.shape, energy)

    def keep(self, pieces, kinks, energy, change):
        """Keep whole periods, and the change of the energy in one."""
        period, self.change = self.driven.period, change
        turns, series = np.floor(pieces.middle / period), pieces.series(energy)
        for turn in np.unique(turns)[:: int(self.driven.direction)]:
            own = np.flatnonzero(turns == turn)
            part = Pieces(pieces.edges[own[0] : own[-1] + 2] - turn * period, pieces.count)
            inside = kinks - turn * period
            self.past.append((part, series[:, own], np.sort(inside[(inside > 0.0) & (inside < period)])))
        self.past = self.past[-MAX_PAST:]
        part, _, self.kinks = self.past[-1]
        self.pieces = part if part.edges.size <= self.first.edges.size + MAX_ADDED_EDGES else self.first


def weights_ahead(count, number):
    """Weights of `count` even values, in rows, in the extrapolation by `number` places, by a polynomial."""
    places = np.arange(1.0 - count, 1.0)
    others = (places[places != own] for own in places)
    rows = [
        np.prod(np.subtract.outer(number, other) / (own - other), axis=-1)
        for own, other in zip(places, others, strict=True)
    ]
    return np.array(rows)

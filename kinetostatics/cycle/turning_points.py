"""Turning points of a quantity: where the slope of its pieces changes its sign, evaluated by the mechanism itself."""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ..numbers.brackets import find_minima
from .kinks import ANGLE_TOLERANCE
from .limit_positions import runs
from .piecewise import JUMP_OFFSET, rolled, rule

JUMP_TOLERANCE = 1e-9
"""Largest difference of the values on both sides of an edge, relative to the largest value, without a jump."""
LIMIT_TOLERANCE = 1e-4
"""Largest negligible difference of the limits on both sides of a limit position, relative to the quantity's size."""
MIN_LEVEL_WIDTH = 0.05
"""Crank angle, rad, over which values equal to rounding form a level stretch, as in a dwell."""
NEAR_END = 0.97
"""Distance from the middle of a piece, relative to half its width, above which crank angles are polished."""
HALVINGS = 48
"""Bisections that find an end of a level stretch."""


class Path(NamedTuple):
    """Successive values of a quantity, monotonic between them, and their rounding.

    Periodic; open from one limit to the next if the period is 0.
    """

    angle: np.ndarray
    value: np.ndarray
    floor: np.ndarray
    period: float


def paths(turn, pieces, values, rough, function, floor, size, cuts, scale):
    """Yield the `Path` of each unbroken run of pieces; a run ends at gaps, limit positions and lost digits.

    Parameters
    ----------
    turn : Turn
    pieces : Pieces
    values : array (1 or 2, pieces, points + 2)
        Values of the quantity, its square or its components, at `Pieces.check_angles`; NaN without correct digits.
    rough : array (pieces,) of bool
        Pieces that are not resolved.
    function : function
        From a solution to the values of the quantity over its crank angles.
    floor : array (pieces,)
        Rounding of the quantity on each piece.
    size : float
        Size of the quantity.
    cuts : array
        Limit positions at which it has no value.
    scale : float
        Rounding of the values over that of the quantity.
    """
    known = np.isfinite(values[..., 1:-1]).all(axis=(0, 2))
    angle, owner = _candidates(pieces, values, known & ~rough, known, floor * scale)
    if (rough & known).any():
        more, its = _rough_candidates(turn, pieces, values, rough & known, function)
        order = np.lexsort((np.append(angle, more), np.append(owner, its)))
        angle, owner = np.append(angle, more)[order], np.append(owner, its)[order]
    middle = 0.5 * (pieces.edges[owner] + pieces.edges[owner + 1])
    near_end = np.abs(angle - middle) > NEAR_END * pieces.half[owner, 0]
    near_end &= ~np.isin(pieces.edges, np.append(turn.kinks, turn.period))[owner + (angle > middle)]
    if near_end.any():
        angle[near_end] = _polished(turn, function, angle[near_end], floor[owner[near_end]])
    value = turn.evaluate(function, angle) if angle.size else angle
    cut = np.zeros(known.size, dtype=bool)  # pieces that start at a limit position without a value
    for limit in cuts:
        cut |= np.abs(np.mod(pieces.edges[:-1] - limit + 1.0, turn.period) - 1.0) < 0.1 * ANGLE_TOLERANCE
    if known.all() and not cut.any():
        yield Path(angle, value, floor[owner], turn.period)
        return
    groups = [part for run in runs(known) for part in np.split(run, np.flatnonzero(cut[run][1:]) + 1)]
    limits = np.concatenate([turn.limits + shift for shift in (-turn.period, 0.0, turn.period)])
    for run, earlier, later in zip(groups, groups[-1:] + groups[:-1], groups[1:] + groups[:1], strict=True):
        start, stop = pieces.edges[run[0]], pieces.edges[run[-1] + 1]
        stop += turn.period * (stop <= start)
        before = start - (start - pieces.edges[earlier[-1] + 1]) % turn.period
        after = stop + (pieces.edges[later[0]] - stop) % turn.period
        left = limits[(limits >= before - ANGLE_TOLERANCE) & (limits <= start + ANGLE_TOLERANCE)][-1:]
        right = limits[(limits <= after + ANGLE_TOLERANCE) & (limits >= stop - ANGLE_TOLERANCE)][:1]
        if left.size and np.array_equal(left, right):  # only rounding beside a limit position
            continue
        own = np.isin(owner, run)
        here = start + np.mod(angle[own] - start, turn.period)
        inside = (here > start + ANGLE_TOLERANCE) & (here < stop - ANGLE_TOLERANCE)
        ends = []
        for place, side, piece in ((left, 1, run[0]), (right, -1, run[-1])):
            end = place if place.size else pieces.angle[piece, [-(side < 0)]]
            there = turn.limit(function, end[0], side, size) if place.size else turn.evaluate(function, end)[0]
            ends.append((end + (turn.period if end[0] < start - ANGLE_TOLERANCE else 0.0), [there], floor[[piece]]))
        order = np.argsort(here[inside], kind="stable")
        middle = (part[inside][order] for part in (here, value[own], floor[owner[own]]))
        joined = [np.concatenate(parts) for parts in zip(ends[0], middle, ends[1], strict=True)]
        known_values = ~np.isnan(joined[1])
        angle_here, value_here, floor_here = (part[known_values] for part in joined)
        yield Path(angle_here, value_here, floor_here, 0.0)


def _polished(turn, function, angle, floor):
    """Zeros of the slope of series around these crank angles; near the end of a piece its slope has few digits."""
    own, half = rule(9), 0.02
    values = turn.evaluate(function, (angle[:, None] + half * own.points).ravel()).reshape(angle.size, -1)
    series = own.series @ values.T
    first = own.derived @ series
    with np.errstate(divide="ignore", invalid="ignore"):
        place = -(chebyshev.chebval(0.0, first) / chebyshev.chebval(0.0, own.derived @ first))
        smooth = (np.abs(series[-2:]).max(axis=0) <= floor) & (np.abs(place) < 1e-3)
    return np.where(smooth, angle + half * np.where(smooth, place, 0.0), angle)


def _rough_candidates(turn, pieces, values, rough, function):
    """Candidates on unresolved pieces, by minimisation around points higher or lower than their neighbours."""
    angle, value = pieces.check_angles.ravel(), (values[0] if len(values) == 1 else np.hypot(*values)).ravel()
    rises, falls = ((value > rolled(value, k)).astype(int) - (value < rolled(value, k)) for k in (1, -1))
    side = rises + falls  # of two equal points each has one
    top = np.flatnonzero((rises * falls >= 0) & (side != 0) & np.repeat(rough, pieces.count + 2))
    if not top.size:
        return np.empty(0), top
    sign, around = -np.sign(side[top]), np.stack([top - 1, top, top + 1])
    brackets = angle[around % angle.size] + turn.period * (around // angle.size)
    found = find_minima(lambda at, place: sign[place] * turn.evaluate(function, at), brackets, relative=0.0, tiny=0.0)
    return np.where(np.isnan(found), angle[top], found), top // (pieces.count + 2)


def _candidates(pieces, values, resolved, known, level):
    """Crank angles at which a quantity may turn, rising, and the piece of each; both sides of jumps."""
    with np.errstate(invalid="ignore"):
        inner, owner, turns = pieces.turning(np.where(known[:, None], values[..., 1:-1], 0.0), level)
        gaps = np.abs(rolled(values[..., -1], 1) - values[..., 0]).max(axis=0)
        gaps = gaps > JUMP_TOLERANCE * np.nanmax(np.abs(values), initial=0.0)
    narrow = ~pieces.can_split
    jump = gaps | narrow | rolled(narrow, 1)  # at the start of each piece
    smooth = resolved[owner] & ~narrow[owner]
    first = turns & known & ~jump
    after = jump & known & ~narrow
    before = rolled(jump, -1) & known & ~narrow
    pieces_of = [owner[smooth], *map(np.flatnonzero, (first, after, before))]
    edges = pieces.edges
    angles = [inner[smooth], edges[:-1][first], edges[:-1][after] + JUMP_OFFSET, edges[1:][before] - JUMP_OFFSET]
    angle, owner = np.concatenate(angles), np.concatenate(pieces_of)
    order = np.lexsort((angle, owner))
    return angle[order], owner[order]


def turning_points(path):
    """Indices of the extrema of a path, and whether each is a maximum, both (K,).

    The ends of an open path are extrema too. Rises and falls within the rounding are removed, the smallest first.
    """
    _, value, floor, period = path
    count = value.size
    direction = np.sign(rolled(value, -1) - value)
    direction[-1:] = direction[-1:] if period else 0.0
    moving = np.flatnonzero(direction)
    following = np.append(moving[1:], moving[:1] + count)
    turning = direction[moving] * direction[following % count] == -1
    turning[-1:] &= period > 0
    before, after = moving[turning], following[turning]
    places, maximum = (before + after + 1) // 2 % count, direction[before] > 0
    if not period:
        places = np.concatenate([[0], places, [count - 1]])
        maximum = np.concatenate([direction[moving[:1]] < 0, maximum, direction[moving[-1:]] > 0])
        maximum = maximum if moving.size else np.array([True, False])
    while maximum.size > 2 - bool(period) and (not period or np.all(maximum != rolled(maximum, 1))):
        height, rounding = value[places], floor[places]
        change = np.abs(rolled(height, -1) - height) / np.maximum(rounding, rolled(rounding, -1))
        least = int(np.argmin(change[: None if period else -1]))
        if change[least] > 1:
            break
        pair = [least, (least + 1) % maximum.size]
        if not period and (least == 0 or least == maximum.size - 2):  # the end stays, as an extremum of the other kind
            end = pair.pop(-1 if least else 0)
            maximum[end] = ~maximum[end]
        kept = np.delete(np.arange(maximum.size), pair)
        places, maximum = places[kept], maximum[kept]
    return places, maximum


def level_stretches(path, places):
    """Yield indices of extrema in level stretches, each with the ends of the stretch and the angles beyond them."""
    angle, value, floor, period = path
    count = value.size
    after = np.abs(rolled(value, -1) - value) <= floor
    for number in np.flatnonzero((after | rolled(after, 1))[places]):
        middle = int(places[number])
        ends = []
        for step in (-1, 1):
            place, last = middle, middle + step * (count - 1)
            while place != last and abs(value[place % count] - value[middle]) <= floor[middle]:
                place += step
                if not (period or 0 <= place < count):
                    break
            ends.append([angle[at % count] + period * (at // count) for at in (place - step, place)])
        (first, before), (last, after) = ends
        if (
            last - first > MIN_LEVEL_WIDTH
            and first - period < before < first
            and last < after < last + (period or after)
        ):
            yield number, (first, last), (before, after)


def extrema_of(turn, function, found, size):
    """Angle, value and kind of the extrema on paths, in order of angle; a level stretch counts once, at its middle."""
    columns = [(np.empty(0), np.empty(0), np.empty(0, dtype=bool), np.empty(0, dtype=bool))]
    for path in found:
        places, maximum = turning_points(path)
        angle, value = path.angle[places], path.value[places]
        for number, inside, outside in level_stretches(path, places):
            inside, outside = np.array(inside), np.array(outside)
            for _ in range(HALVINGS):
                half = 0.5 * (inside + outside)
                level = np.abs(turn.evaluate(function, half) - value[number]) <= path.floor[places[number]]
                inside, outside = np.where(level, half, inside), np.where(level, outside, half)
            angle[number] = inside.mean()
            value[number] = turn.evaluate(function, angle[number : number + 1])[0]
        end = np.zeros(places.size, dtype=bool)
        if not path.period:
            end[[0, -1]] = True
        wrapped = np.mod(angle, turn.period)
        last = np.flatnonzero((wrapped > turn.period - ANGLE_TOLERANCE) & ~end)
        if last.size:  # 0, unless the value jumps there
            same = np.abs(turn.evaluate(function, np.array([JUMP_OFFSET]))[0] - value[last]) <= path.floor[places[last]]
            wrapped[last[same]] = 0.0
        columns.append((wrapped, value, maximum, end))
    angle, value, maximum, end = (np.concatenate(parts) for parts in zip(*columns, strict=True))
    order = np.argsort(angle, kind="stable")
    angle, value, maximum, end = angle[order], value[order], maximum[order], end[order]
    # two ends of paths at one angle with one value: a level pair counts once, a smooth passage not at all
    same = (np.abs(angle - rolled(angle, -1)) <= ANGLE_TOLERANCE) & end & rolled(end, -1)
    alike = (value == rolled(value, -1)) | (np.abs(value - rolled(value, -1)) <= LIMIT_TOLERANCE * size)
    pair = same & alike & (np.arange(angle.size) < angle.size - 1)
    kept = ~(rolled(pair, 1) | (pair & (maximum != rolled(maximum, -1))))
    return angle[kept], value[kept], maximum[kept]

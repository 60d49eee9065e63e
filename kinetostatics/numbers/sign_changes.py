"""Sign changes of functions of an angle over a period, many at once, of one design or of many."""

import math
from typing import Any, NamedTuple

import numpy as np

from .brackets import find_roots

SAMPLE_OFFSET = 1e-3
"""First sample, rad: no sample is at a dead centre."""
MAX_VERTEX = 0.1
"""Height of a parabola's vertex, relative to its second difference, below which the vertex is evaluated too."""


class SignChanges(NamedTuple):
    """Index `row` of the function and `angle` of each sign change, rad, (..., K); NaN pads rows of designs with fewer.

    The functions have `values`, (functions, ..., N), at the `samples`, (1, N), the last a period after the first.
    """

    row: Any
    angle: Any
    samples: Any
    values: Any


def sign_changes(function, period, samples):
    """Sign changes of functions over a period, a `SignChanges`.

    ``function(angles)`` takes angles (1 or designs, N) and returns a sequence of arrays that broadcast with them, one
    for each function. `samples` are rising angles over the period, or their number. Between two of them each function
    changes its sign once at most, or twice where its size has a minimum.
    """
    start = SAMPLE_OFFSET + np.linspace(0.0, period, samples, endpoint=False) if np.ndim(samples) == 0 else samples
    angle = np.append(start, start[0] + period)[None]
    values = np.stack(np.broadcast_arrays(*(np.atleast_2d(row) for row in function(angle)), angle))[:-1]
    count, *designs, number = values.shape
    flat = math.prod(designs), number

    def evaluate(at):
        at = at.reshape(*designs, at.shape[-1])
        with np.errstate(all="ignore"):
            found = function(at)
        rows = np.stack([np.broadcast_arrays(np.atleast_2d(row), at)[0] for row in found])
        return rows.reshape(count, flat[0], at.shape[-1])

    low, high, row = _brackets(evaluate, values.reshape(count, *flat), angle)
    found = np.full(low.shape, np.nan)
    if low.size:
        design, place = np.nonzero(~np.isnan(low))
        lows, highs, rows = (part[design, place] for part in (low, high, row))

        def own(angle, asked):
            return _values_at(evaluate, flat[0], design[asked], rows[asked], angle)

        first, root = own(lows, np.arange(lows.size)), find_roots(own, lows, highs)
        found[design, place] = np.mod(np.where(np.isnan(root), np.where(first == 0.0, lows, highs), root), period)
    row, found = (part.reshape(*designs, part.shape[-1]) for part in (row, found))
    return SignChanges(row, found, angle, values)


def pad_rows(design, count, *values):
    """Values listed design by design as arrays (count, K), K the most of one design; NaN pads the rows."""
    number = np.bincount(design, minlength=count)
    rows = np.full((len(values), count, number.max(initial=0)), np.nan)
    rows[:, design, np.arange(design.size) - (np.cumsum(number) - number)[design]] = values
    return rows


def _values_at(evaluate, designs, design, row, angle):
    """Values of functions, by their number `row`, of designs at angles, all (K,)."""
    order = np.argsort(design, kind="stable")
    at, own = pad_rows(design[order], designs, angle[order], row[order])
    known = ~np.isnan(at)
    values = evaluate(np.where(known, at, SAMPLE_OFFSET))
    found = np.empty(angle.size)
    found[order] = np.take_along_axis(values, np.nan_to_num(own).astype(int)[None], axis=0)[0][known]
    return found


def _brackets(evaluate, values, angle):
    """Angles before and after each sign change, and the index of the function, (designs, K).

    `values` are (functions, designs, N). Where the parabola through three samples of one sign has its vertex near zero,
    the function is also evaluated at the vertex, because it may change its sign twice.
    """
    sign = np.signbit(values)
    row, design, place = np.nonzero((sign[..., :-1] != sign[..., 1:]) & ~np.isnan(np.diff(values)))
    brackets = [(design, angle[0, place], angle[0, place + 1], row)]
    before, here, after = (np.abs(part) for part in (values[..., :-2], values[..., 1:-1], values[..., 2:]))
    alike = (sign[..., :-2] == sign[..., 1:-1]) & (sign[..., 1:-1] == sign[..., 2:])
    left, right = np.diff(angle[0])[:-1], np.diff(angle[0])[1:]
    curve = ((after - here) / right - (here - before) / left) / (left + right)
    slope = (here - before) / left + curve * left
    with np.errstate(invalid="ignore", divide="ignore"):
        shift = -0.5 * slope / curve
        near = alike & (here <= before) & (here <= after) & (curve > 0.0)
        near &= here + 0.5 * slope * shift < MAX_VERTEX * 0.5 * curve * (left + right) ** 2
    row, design, place = np.nonzero(near)
    if place.size:
        place = place + 1
        vertex = angle[0, place] + shift[near]
        own = _values_at(evaluate, values.shape[1], design, row, vertex)
        beyond = np.signbit(own) != sign[row, design, place]
        row, design, place, vertex = (part[beyond] for part in (row, design, place, vertex))
        brackets += [(design, angle[0, place - 1], vertex, row), (design, vertex, angle[0, place + 1], row)]
    design, low, high, row = (np.concatenate(parts) for parts in zip(*brackets, strict=True))
    order = np.lexsort((low, row, design))
    return pad_rows(design[order], values.shape[1], low[order], high[order], row[order])

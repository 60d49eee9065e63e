"""Where functions of the crank angle change their signs over a period: all places, of many designs each its own."""

import numpy as np

from ..machine.loads import pad_rows
from ..numbers.brackets import find_roots

ASIDE = 1e-3
"""Crank angle from 0, rad, so that no sample meets a dead centre."""
NEARLY = 0.1
"""How near to zero, in bends of the parabola through three samples, one is looked at between them."""


def sign_changes(function, period, samples):
    """Which of some functions change their signs, and the crank angles: (designs, K), NaN where a design has fewer.

    Parameters
    ----------
    function : function
        From crank angles (1 or designs, N) to a sequence of arrays that broadcast with them: one for each function.
    period : float
    samples : int
        Crank angles over the period between which each changes its sign once at most, or twice where it turns about.
    """

    def signs(angle):
        with np.errstate(all="ignore"):
            found = function(angle)
        return np.stack([np.broadcast_arrays(np.atleast_2d(row), angle)[0] for row in found])

    angle = (ASIDE + np.linspace(0.0, period, samples + 1))[None]
    found = function(angle)
    if not len(found):
        return np.empty((1, 0)), np.empty((1, 0))
    values = np.stack(np.broadcast_arrays(*(np.atleast_2d(row) for row in found), angle)[:-1])
    low, high, row = _brackets(signs, values, angle)
    if not low.size:
        return row, low
    known = np.nan_to_num(row).astype(int)

    def own(angle, asked):
        everywhere = low.copy()
        everywhere.flat[asked] = angle
        return np.take_along_axis(signs(everywhere), known[None], axis=0)[0].flat[asked]

    root = find_roots(own, low, high)
    first = own(low.ravel(), np.arange(low.size)).reshape(low.shape)
    ends = np.where(first == 0.0, low, high)
    return row, np.mod(np.where(np.isnan(root), ends, root), period)


def _brackets(signs, values, angle):
    """Crank angles before and after each change, and of which function, (designs, K), from values (functions, designs,
    N).
    """
    changed = (np.signbit(values[..., :-1]) != np.signbit(values[..., 1:])) & ~np.isnan(np.diff(values))
    row, design, place = np.nonzero(changed)
    found = [(design, angle[0, place], angle[0, place + 1], row)]
    row, design, place, vertex = _turning(values, angle)
    if vertex.size:
        at, known, order = pad_rows(design, values.shape[1], vertex, row, np.arange(vertex.size))
        there = signs(np.where(np.isnan(at), angle[0, 0], at))
        there = np.take_along_axis(there, np.nan_to_num(known).astype(int)[None], axis=0)[0]
        own = np.empty(vertex.size)
        own[order[~np.isnan(order)].astype(int)] = there[~np.isnan(order)]
        beyond = np.signbit(own) != np.signbit(values[row, design, place])
        row, design, place, vertex = (part[beyond] for part in (row, design, place, vertex))
        found += [(design, angle[0, place - 1], vertex, row), (design, vertex, angle[0, place + 1], row)]
    design, low, high, row = (np.concatenate(parts) for parts in zip(*found, strict=True))
    order = np.lexsort((low, row, design))
    return pad_rows(design[order], values.shape[1], low[order], high[order], row[order])


def _turning(values, angle):
    """Where functions turn about just before zero, or may do so beyond it: which, designs, samples, crank angles."""
    before, here, after = (np.abs(part) for part in (values[..., :-2], values[..., 1:-1], values[..., 2:]))
    sign = np.signbit(values)
    alike = (sign[..., :-2] == sign[..., 1:-1]) & (sign[..., 1:-1] == sign[..., 2:])
    bend = before - 2.0 * here + after
    with np.errstate(invalid="ignore", divide="ignore"):
        least = here - (before - after) ** 2 / (8.0 * bend)
        near = alike & (here <= before) & (here <= after) & (bend > 0.0) & (least < NEARLY * bend)
    row, design, place = np.nonzero(near)
    step = 0.5 * (before - after)[near] / bend[near]
    return row, design, place + 1, angle[0, place + 1] + step * (angle[0, 1] - angle[0, 0])

"""Where sliders stand still, and where they pass given places: crank angles, for each of many designs."""

import numpy as np

from .period import TURN

SAMPLES = 720
"""Crank angles a turn between which a slider turns back once at most."""
ASIDE = 1e-3
"""Crank angle from 0, rad, so that no sample meets a dead centre."""
CLOSE = 1e-13
"""Step of a crank angle, rad, that is the last."""
MOST = 60
"""Steps after which a bracket cannot be halved any more."""


def crossings(motion, slider, levels):
    """Crank angles at which a slider stands still, (designs, E), and passes levels, (designs, K), until it all repeats.

    NaN stands where a design has fewer than another, or does not close. Between two stops a slider passes each level
    once, so those are found first, and none is missed however near to a stop.

    Parameters
    ----------
    motion : Motion
        Whatever its crank angles.
    slider : str
    levels : array (R,)
        Coordinates along its guide, rising.
    """
    turns = motion.mechanism.turns

    def travel(angle):
        return motion.mechanism.place(angle).travels[slider]

    with np.errstate(invalid="ignore", divide="ignore"):
        grid = (ASIDE + np.linspace(0.0, TURN * turns, SAMPLES * turns + 1))[None]
        rate = np.broadcast_arrays(*np.atleast_2d(travel(grid).first, grid))[0]
        closes = ~np.isnan(rate)
        turning = (np.signbit(rate[:, :-1]) != np.signbit(rate[:, 1:])) & closes[:, :-1] & closes[:, 1:]
        design, place = np.nonzero(turning)
        low, high = in_rows(design, len(rate), grid[0, place], grid[0, place + 1])

        def rates(angle):
            at = travel(angle)
            return at.first, at.second

        stops = _roots(rates, low, high, np.zeros_like(low))
        knots = np.sort(np.column_stack([np.broadcast_to(grid, rate.shape), stops]), axis=1)
        passed = _roots(*_passing(travel, levels, knots))
    return np.mod(stops, TURN * turns), np.mod(passed, TURN * turns)


def _passing(travel, levels, knots):
    """Coordinate and rate as a function, between which of some angles it passes a level, and the levels."""

    def places(angle):
        at = travel(angle)
        return at.position, at.first

    there = np.broadcast_to(places(knots)[0], knots.shape)
    above = np.searchsorted(levels, there)
    before, after = above[:, :-1], above[:, 1:]
    closes = ~np.isnan(there)
    many = np.abs(after - before) * (closes[:, :-1] & closes[:, 1:])
    design, place = np.nonzero(many)
    number = many[design, place]
    first = np.repeat(np.minimum(before, after)[design, place] + number - np.cumsum(number), number)
    level = levels[first + np.arange(number.sum())]
    design, place = np.repeat(design, number), np.repeat(place, number)
    return places, *in_rows(design, len(knots), knots[design, place], knots[design, place + 1], level)


def in_rows(design, count, *values):
    """Values of designs, which stand one after the other, as arrays (designs, most of one), NaN where one has fewer."""
    number = np.bincount(design, minlength=count)
    rows = np.full((len(values), count, number.max(initial=0)), np.nan)
    rows[:, design, np.arange(design.size) - (np.cumsum(number) - number)[design]] = values
    return rows


def _roots(function, low, high, level):
    """Where a function, given with its slope, is at a level, between angles on both sides: by Newton's method.

    A step that leaves the bracket gives way to halving.
    """
    if not low.size:
        return low
    rising = function(high)[0] > function(low)[0]  # an end may be at the level
    angle, moving = 0.5 * (low + high), np.ones(low.shape, dtype=bool)
    for _ in range(MOST):
        value, slope = function(angle)
        beyond = (value > level) == rising
        low, high = np.where(beyond, low, angle), np.where(beyond, angle, high)
        step = angle - (value - level) / slope
        following = np.where((low <= step) & (step <= high), step, 0.5 * (low + high))
        far = np.abs(following - angle) > CLOSE
        angle = np.where(moving, following, angle)  # no root hangs on how many steps others take
        moving &= far
        if not moving.any():
            break
    return angle

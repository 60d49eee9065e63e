"""Pieces of a table: checks of its rows, look-up, kinks, crossings, and rounding errors of its values.

A table is linear between its rows: piece k gives y_k + (x - x_k) (y_k+1 - y_k) / (x_k+1 - x_k). It has a kink at each
row, but rows that follow a smooth curve within `KINK_TOLERANCE` count as none. A table over the travel of a slider has
its kinks where the slider passes a row, and may jump where the slider turns back.

x is the crank angle, rad, or the travel, m; y is in the unit of the load, N or N m.
"""

import math
import re
from bisect import bisect_left
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...numbers import checks
from ...numbers.arithmetic import TURN, UNIT_ROUNDOFF
from ...numbers.brackets import find_roots
from ...numbers.sign_changes import SAMPLE_OFFSET, pad_rows, sign_changes

MAX_TURNS = 100
"""Largest number of turns in a period."""

# Periods


class WholeTurns:
    """Rule of a period: 2 pi or a whole multiple of it, rad; the value is rounded to one."""

    def quick(self, value):
        return value if value is TURN else checks.UNDECIDED

    def check(self, value, field=""):
        try:
            value = checks.to_plain(value, "rad")
        except checks.DimensionError as fault:
            return value, f"{field} {fault}"
        number = isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300
        turns = value / TURN if number else 0.0
        if round(turns) >= 1 and abs(turns - round(turns)) < 1e-9 * turns:
            many = f"{field} must be at most {MAX_TURNS} turns, got {round(turns):.6g}"
            return round(turns) * TURN, many if round(turns) > MAX_TURNS else None
        return value, f"{field} must be 2 pi or a whole multiple of it, got {checks.shown(value)}"


def period_of(loads, turns=1):
    """Common period of all loads, rad: a multiple of `turns` turns."""
    return TURN * math.lcm(turns, *(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))


# Rows

TRAVEL_TOLERANCE = 1e-9
"""Rounding by which a slider may leave a table over travel, relative to the table's length."""
RETURN_STROKE_WORDS = re.compile("back|return", re.IGNORECASE)
"""Words by which the heading of a column means the stroke back."""


def order_problem(x, over):
    """Problem of rows that neither rise nor fall throughout, as a sentence, or None."""
    falls = x.size > 1 and x[-1] < x[0]
    wrong = np.diff(x) >= 0 if falls else np.diff(x) <= 0
    if not np.any(wrong):
        return None
    row = int(np.argmax(wrong)) + 1
    here, before = (f"{part:.9g} m" if over == "travel" else _degrees(part) for part in (x[row], x[row - 1]))
    what, remedy = ("angles", "for a jump give two angles close together")
    if over == "travel":
        what, remedy = "travel", "give the stroke back as back=..., in a file as a third column"
        if x[row] == x[row - 1]:
            remedy = "for a jump give two travels close together"
    return f"{what} must {'fall' if falls else 'rise'}, but {here} follows {before} in row {row + 1}; {remedy}"


def unread_column_problem(names, value, over):
    """Problem of a column of a file that looks like a stroke back, or a second value, but is not read; or None."""
    read = {f"{value}_back"} if over == "travel" else set()
    read.update(f"{name}_back" for name in names if name != value)
    beside = f"{value}_" if over == "travel" else f"{value}_back"
    for name in names:
        if (RETURN_STROKE_WORDS.search(name) or name.startswith(beside)) and name not in read:
            back = f"the stroke back is headed {value}_back"
            wanted = back if over == "travel" else "a stroke back stands over travel"
            return f"column {name!r} would not be read: {wanted}; rename it, or leave it out"
    return None


def repeats_first_row(angle, period):
    """Whether the last row repeats the first one a period later, to rounding."""
    return abs(angle[-1] - angle[0] - period) < min(0.1 * np.median(np.diff(angle)), 0.005)


def angle_problem(angle, value, period):
    """Problem of the rows of a table over the angle, in rising order, as a sentence, or None."""
    if angle.size < 3:
        return f"at least 3 rows are needed, got {angle.size}; one that does not change is no table"
    step, span = np.diff(angle), angle[-1] - angle[0]
    if repeats_first_row(angle, period):
        if abs(value[-1] - value[0]) <= 1e-9 * np.max(np.abs(value)):
            return None
        return (
            f"the value must end as it began, a period of {_degrees(period)} before, but is {value[0]:.9g} at "
            f"{_degrees(angle[0])} and {value[-1]:.9g} at {_degrees(angle[-1])}; leave one of these rows out"
        )
    if span > period:
        turns = math.ceil(span / TURN - 1e-9)
        remedy = f'if it repeats after {turns} turns, give period = "{360 * turns} deg" ({2 * turns} pi in Python)'
        if turns > 8:
            remedy = "are they degrees under a heading of rad?"
        return f"the angles span {_degrees(span)}, more than the period of {_degrees(period)}; {remedy}"
    rest = period - span
    if rest > 1.5 * step.max():
        return (
            f"rows are missing: they end at {_degrees(angle[-1])}, {_degrees(rest)} before the next begins at "
            f"{_degrees(angle[0] + period)} (period {_degrees(period)}). If the values run straight between them, "
            f"repeat the first row at {_degrees(angle[0] + period)}. Are the angles in the unit of their heading?"
        )
    wide = (step > max(5 * float(np.median(step)), math.radians(20.0))) & (np.diff(value) != 0)
    if np.any(wide):
        row = int(np.argmax(wide))
        return (
            f"rows are missing between {_degrees(angle[row])} and {_degrees(angle[row + 1])}; if the value runs "
            "straight between them add a row halfway"
        )
    return None


def _degrees(angle):
    return f"{math.degrees(angle):.9g} deg"


def unit_of(values):
    """Unit of values that are pint quantities, "N" or "N*m"; "" of plain numbers."""
    for unit in ("N", "N*m"):
        try:
            return "" if checks.to_plain(values, unit) is values else unit
        except checks.DimensionError:
            continue
    return ""


# Look-up


def piece_index(xp, x, place):
    """Number of the piece that each place lies in; the first or last piece beyond the rows."""
    return xp.clip(xp.searchsorted(xp.asarray(x), place, side="right") - 1, 0, x.size - 2)


def piece_lines(xp, x, strokes, piece, back=None):
    """Start, value there and slope of pieces, of the first stroke, or of the second where `back` is true."""
    place = piece if back is None else piece + (x.size - 1) * back
    values = np.concatenate([y[:-1] for y in strokes])
    slopes = np.concatenate([np.diff(y) / np.diff(x) for y in strokes])
    return tuple(xp.asarray(part)[at] for part, at in ((x, piece), (values, place), (slopes, place)))


# Kinks

KINK_TOLERANCE = 1e-5
"""Distance of a table from a smooth curve below which it has no kink, relative to its largest value."""
SMOOTH_DEGREE = 5
"""Degree of the polynomials that count as smooth: lower than that of the polynomials of reductions over a turn."""
SMOOTH_STRETCHES = 32
"""Number of polynomials in half a turn, or in a table over travel, of a smooth curve."""
CHEBYSHEV_POINTS = chebyshev.chebpts1(32)
"""Places on a stretch, from -1 to 1, at which the polynomial is fitted."""
CHEBYSHEV_FIT = np.linalg.pinv(chebyshev.chebvander(CHEBYSHEV_POINTS, SMOOTH_DEGREE))
"""Matrix that gives the coefficients of the polynomial from values at these places."""


@lru_cache(maxsize=32)
def kink_rows(table, tolerance=KINK_TOLERANCE):
    """Rows at which a table kinks by more than `tolerance` times its largest value, (K,); over travel inner rows."""
    room = tolerance * abs(table.largest)
    if table.over == "angle":
        # around the largest value, with a period before and behind
        x, y, period, count = table.x, table.y, table.period, table.x.size
        order = (np.arange(count) + int(np.argmax(np.abs(y)))) % count
        around = x[order] + period * (order < order[0])
        curve = Curve(np.concatenate([around - period, around, around + period]), [np.tile(y[order], 3)], room)
        ends = [count, *curve.stretch_ends(count, 2 * count)]
        return order[curve.kinks(ends, 0.5 * TURN / SMOOTH_STRETCHES) - count]
    curve = Curve(table.x, table.strokes, room)
    return curve.kinks(curve.stretch_ends(0, table.x.size - 1), (table.x[-1] - table.x[0]) / SMOOTH_STRETCHES)


class Curve(NamedTuple):
    """Rows of one or two strokes, and the distance from a smooth curve at which they kink."""

    x: Any
    strokes: Any
    room: float

    def stretch_ends(self, first, last):
        """Rows between two others that part the curve into smooth stretches, each as long as possible."""

        def breaks(end):
            return not self._is_smooth(self.x[row], self.x[end])

        found, row = [], first
        while row < last:
            count = 2
            while row + count <= last and not breaks(row + count):
                count *= 2
            ends = range(row + count // 2 + 1, min(row + count, last + 1))
            row = ends.start - 1 + bisect_left(ends, True, key=breaks)
            found.append(row)
        return found[:-1]

    def kinks(self, rows, reach):
        """Rows at which the curve kinks: it is not smooth from `reach` before the row to `reach` behind it."""
        x = self.x
        found = [row for row in rows if not self._is_smooth(max(x[0], x[row] - reach), min(x[row] + reach, x[-1]))]
        return np.array(found, dtype=int)

    def _is_smooth(self, low, high):
        """Whether a polynomial approximates every stroke between two places, at the rows and between them."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        some = slice(np.searchsorted(self.x, low), np.searchsorted(self.x, high, side="right"))
        places = np.concatenate([CHEBYSHEV_POINTS, (self.x[some] - middle) / half])
        for y in self.strokes:
            values = np.interp(middle + half * CHEBYSHEV_POINTS, self.x, y)
            found = chebyshev.chebval(places, CHEBYSHEV_FIT @ values)
            if np.abs(found - np.concatenate([values, y[some]])).max() > self.room:
                return False
        return True


# Stops and crossings of a slider

STOP_SAMPLES = 720
"""Crank angles a turn between which a slider stops at most once."""


def stops_and_crossings(motion, slider, levels, origin=0.0, unit=1.0):
    """Crank angles at which a slider stops, (designs, E), and passes levels, (designs, K), in its period, rad.

    `levels` are coordinates along its guide, rising, m, or in units of `unit` from an `origin` (numbers, or arrays
    (designs, 1)); the crank angles of `motion` have no effect. Rows end with NaN where a design has fewer than another.
    Between two stops a slider passes each level once, so stops come first and no crossing near a stop is missed.
    """
    turns = motion.mechanism.turns
    period = TURN * turns

    def travel(angle):
        return motion.mechanism.place(angle).travels[slider]

    def height(angle):
        return (travel(angle).position - origin) / unit

    with np.errstate(invalid="ignore", divide="ignore"):
        _, stops, grid, (rate,) = turning_points(lambda angle: travel(angle).first, turns)
        ahead = stops + period * (stops < SAMPLE_OFFSET)  # within the grid
        knots = np.sort(np.column_stack([np.broadcast_to(grid, rate.shape), ahead]), axis=1)

        # each crossing by the levels between the coordinates at both knots
        knots, there = np.broadcast_arrays(knots, height(knots))
        above = np.searchsorted(levels, there)
        before, after = above[:, :-1], above[:, 1:]
        many = np.abs(after - before) * ~np.isnan(np.diff(there))
        design, place = np.nonzero(many)
        number = many[design, place]
        first = np.repeat(np.minimum(before, after)[design, place] + number - np.cumsum(number), number)
        level = levels[first + np.arange(number.sum())]
        design, place = np.repeat(design, number), np.repeat(place, number)
        low, high, level = pad_rows(design, len(knots), knots[design, place], knots[design, place + 1], level)
        passed = _roots(lambda angle: height(angle) - level, low, high)
    return stops, np.mod(passed, period)


def turning_points(rate, turns):
    """Sign changes of a rate by the crank angle over the period of `turns` turns, `SignChanges`."""
    return sign_changes(lambda angle: [rate(angle)], TURN * turns, STOP_SAMPLES * turns)


def _roots(function, low, high):
    """Angles between `low` and `high`, (designs, K), at which a function of angles is 0; NaN where both are."""

    def values(angle, places):
        everywhere = low.copy()
        everywhere.flat[places] = angle
        return function(everywhere).flat[places]

    if not low.size:
        return low
    root = find_roots(values, low, high, 1e-13)
    return np.where(np.isnan(root), low, root)  # an end that is zero within rounding


# Rounding errors

DEAD_CENTRE_ERROR = 1e-12
"""Largest error of the crank angle of a dead centre, rad."""
BOUND_FACTOR = 1.0 + 1e-9
"""Factor of a bound that covers products of roundings."""
MIN_BOUND = 2.0**-1000
"""Error that covers the underflow of a product or quotient."""


def rounding_bound(table, motion):
    """Bound on the error of values of a table over the angle at its exact angles, (..., N), N or N m.

    A slope has three roundings, the rise along it two more, the sum one; in other turns a row moves by rounding.
    """
    x, (y,) = table.closed()
    rise = np.abs(np.diff(y))
    slope = rise / np.diff(x)
    own = np.where(rise == 0.0, 0.0, 5.0 * rise + np.maximum(np.abs(y[1:]), np.abs(y[:-1])))
    if x[0] != 0.0:
        own[-1] += 2.0 * abs(x[-1]) * slope[-1]
    angle = np.asarray(table.place(motion))
    turned = np.floor((angle - x[0]) / table.period) * table.period
    place = angle - turned
    row = piece_index(np, x, place)
    bound = (BOUND_FACTOR * UNIT_ROUNDOFF * own + MIN_BOUND)[row]
    on = turned != 0.0
    if on.any():
        reach = np.abs(angle[on]) + np.abs(turned[on]) + abs(x[0]) + table.period
        near = _row_distance(x, place[on]) <= 4.0 * UNIT_ROUNDOFF * reach
        moved = 3.0 * slope[row[on]] + np.where(near, 8.0 * slope.max(), 0.0)
        bound[on] += (BOUND_FACTOR * UNIT_ROUNDOFF) * moved * reach
    return bound


def _row_distance(x, place):
    """Distance of each place from the nearest row."""
    row = np.clip(np.searchsorted(x, place), 1, x.size - 1)
    return np.minimum(np.abs(place - x[row - 1]), np.abs(place - x[row]))


def kink_bounds(table, motion):
    """Bounds of kinks and jumps of a table near each place, for error bounds (see `engines.record`).

    The table is over travel, or over the angle from a dead centre, and then without jumps.

    Returns
    -------
    change : array (..., N)
        Change of the slope at a row nearer than `near`, N/m or N m/m; else 0.
    jump : array (..., N)
        Jump of the value between both strokes where the rate is less than `near`, N or N m; else 0.
    near : float
        m, of the rate m/rad.
    distance : array (..., N)
        Distance of the nearest row, m or rad.
    """
    near = 1e-6 * float(table.x[-1] - table.x[0])
    place = np.asarray(table.place(motion), dtype=float)
    if table.over == "angle":
        x, (y,) = table.closed()
        distance = _row_distance(x, place - np.floor((place - x[0]) / table.period) * table.period)
        change = np.where(distance <= near, 2.0 * np.max(np.abs(np.diff(y) / np.diff(x))), 0.0)
        return change, 0.0, near, np.maximum(distance - DEAD_CENTRE_ERROR, 0.0)
    rate = table.rate(motion)
    steepest = np.max(np.abs(np.diff(table.strokes) / np.diff(table.x)))
    distance, jump = _row_distance(table.x, place), 0.0
    if table.back is not None:
        x, y = table.x, table.y - table.back
        jump = np.max(np.abs(y))
        if np.min(np.diff(x)) >= 2.0 * near:  # no more than one row is so near
            row = np.clip(np.searchsorted(x, place - near), 0, x.size - 1)
            beside = np.where(np.abs(x[row] - place) <= 2.0 * near, y[row], 0.0)
            ends = (np.interp(end, x, y) for end in (place - near, place + near))
            jump = np.abs([beside, *ends]).max(axis=0) + 8 * UNIT_ROUNDOFF * jump
    change = np.where(distance <= near, 2.0 * steepest, 0.0)
    return change, np.where(np.abs(rate) <= near, jump, 0.0), near, distance

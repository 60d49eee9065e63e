"""Periods of loads: whole turns of the crank.

Rows of a table: what is wrong with them, how they are read, and what is wrong with what is read from them.

Rows at which a table bends, or jumps, and does not just run as a smooth curve does that fine rows are read off.

Where sliders stand still, and where they pass given places: crank angles, for each of many designs.

What bounds need to know of a table: its own rounding, and its kinks and jumps.
"""

import math
import re
from bisect import bisect_left
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.arithmetic import UNIT_ROUNDOFF, namespace

TURN = 2 * math.pi
MAX_TURNS = 100
"""Turns after which loads must repeat, all together."""


class WholeTurns:
    """Rule of a period: 2 pi or a whole multiple of it, but for rounding, which is taken away."""

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
    """Crank angle after which all loads repeat, rad: the turns that their periods have in common, or so many."""
    return TURN * math.lcm(turns, *(max(1, round(getattr(item, "period", TURN) / TURN)) for item in loads))


TRAVEL_TOLERANCE = 1e-9
"""Share of a table over travel by which a slider may go beyond it: rounding."""
RETURN_STROKE_WORDS = re.compile("back|return", re.IGNORECASE)
"""What a heading has that is meant for a stroke back."""


def order_problem(x, over):
    """What is wrong with the order of rows as they are given, rising or falling, or None."""
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


def travel_problem(x):
    """What is wrong with coordinates of a table over travel in order, or None."""
    return None if x.size > 1 else "at least 2 rows are needed, got 1; a value that does not change is no table"


def unread_column_problem(names, value, over):
    """Why a column of a file whose heading looks like a stroke back, or a value beside it, is not read; or None."""
    read = {f"{value}_back"} if over == "travel" else set()
    read.update(f"{name}_back" for name in names if name != value)
    beside = f"{value}_" if over == "travel" else f"{value}_back"
    for name in names:
        if (RETURN_STROKE_WORDS.search(name) or name.startswith(beside)) and name not in read:
            back = f"the stroke back is headed {value}_back"
            wanted = back if over == "travel" else "a stroke back stands over travel"
            return f"column {name!r} would not be read: {wanted}; rename it, or leave it out"
    return None


def lookup_arrays(place, returning):
    """The library that looks values up, places and strokes: NumPy, unless they have no values yet, as under JAX."""
    try:
        return np, np.asarray(place, dtype=float), returning if returning is None else np.asarray(returning)
    except (TypeError, ValueError):
        return next(xp for xp in map(namespace, (place, returning)) if xp is not np), place, returning


def piece_index(xp, x, place):
    """Which piece between rows each place lies in; the first or last beyond."""
    return xp.clip(xp.searchsorted(xp.asarray(x), place, side="right") - 1, 0, x.size - 2)


def piece_lines(xp, x, strokes, piece, back=None):
    """Start, value there and slope of some pieces, of the first or, where told, the second of two strokes."""
    place = piece if back is None else piece + (x.size - 1) * back
    values = np.concatenate([y[:-1] for y in strokes])
    slopes = np.concatenate([np.diff(y) / np.diff(x) for y in strokes])
    return tuple(xp.asarray(part)[at] for part, at in ((x, piece), (values, place), (slopes, place)))


def is_outside(x, place):
    """Whether places lie beyond the rows."""
    room = TRAVEL_TOLERANCE * (x[-1] - x[0])
    return (place < x[0] - room) | (place > x[-1] + room)


def require_inside(x, place, motion):
    """Raise an error where a slider goes beyond the rows."""
    out = is_outside(x, place)
    if out.any():
        angle = np.degrees(np.broadcast_to(motion.crank_angle, out.shape)[out])
        raise ParameterError(
            f"table over travel: the slider goes from {np.nanmin(place):.9g} to {np.nanmax(place):.9g} m, but the "
            f"table from {x[0]:.9g} to {x[-1]:.9g} m; beyond it at {angle.size} crank angles, the first "
            f"{angle[0]:.6g} deg; travel is the coordinate of the pin along the guide (solution.slider_position)",
            out.any(axis=-1) if out.ndim > 1 else None,
        )


def repeats_first_row(angle, period):
    """Whether the last row stands at the angle of the first, a period later, but for rounding."""
    return abs(angle[-1] - angle[0] - period) < min(0.1 * np.median(np.diff(angle)), 0.005)


def angle_problem(angle, value, period):
    """What is wrong with rows of a table in order, or None."""
    if angle.size < 3:
        return f"at least 3 rows are needed, got {angle.size}; one that does not change is no table"
    step, span = np.diff(angle), angle[-1] - angle[0]
    if repeats_first_row(angle, period):
        unequal = abs(value[-1] - value[0]) > 1e-9 * np.max(np.abs(value))
        return (
            f"the value must end as it began, a period of {_degrees(period)} before, but is {value[0]:.9g} at "
            f"{_degrees(angle[0])} and {value[-1]:.9g} at {_degrees(angle[-1])}; leave one of these rows out"
            if unequal
            else None
        )
    if span > period:
        turns = math.ceil(span / TURN - 1e-9)
        remedy = f'if it repeats after {turns} turns, give period = "{360 * turns} deg" ({2 * turns} pi in Python)'
        if turns > 8:
            remedy = "are they degrees under a heading of rad?"
        return f"the angles span {_degrees(span)}, more than the period of {_degrees(period)}; {remedy}"
    return _missing(angle, value, period, step)


def _missing(angle, value, period, step):
    """What is wrong with the distances between rows, or None."""
    rest = period - (angle[-1] - angle[0])
    if rest > 1.5 * step.max():
        return (
            f"rows are missing: they end at {_degrees(angle[-1])}, {_degrees(rest)} before the next begins at "
            f"{_degrees(angle[0] + period)} (period {_degrees(period)}); if the values run straight between them "
            f"repeat the first row at {_degrees(angle[0] + period)}; are the angles in the unit of their heading?"
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
    """Unit of values that are quantities, "" of plain numbers."""
    for unit in ("N", "N*m"):
        try:
            return "" if checks.to_plain(values, unit) is values else unit
        except checks.DimensionError:
            continue
    return ""


KINK_TOLERANCE = 1e-5
"""Share of the largest value by which a table may be off a polynomial and bend nothing that one would see."""
SMOOTH_DEGREE = 5
"""Of these polynomials: less than those have that reductions take."""
SMOOTH_STRETCHES = 32
"""Stretches in half a turn, or in a table over travel, on which a smooth curve is such a polynomial."""
CHEBYSHEV_POINTS = chebyshev.chebpts1(32)
"""Places on a stretch, from -1 to 1, of which the polynomial is made: so that it swings nowhere, however rows lie."""
CHEBYSHEV_FIT = np.linalg.pinv(chebyshev.chebvander(CHEBYSHEV_POINTS, SMOOTH_DEGREE))
"""Coefficients of the polynomial from values at these."""


@lru_cache(maxsize=32)
def kink_rows(table, straight=KINK_TOLERANCE):
    """Rows at which a table bends by more than a share of its largest value; over the travel inner ones."""
    room = straight * abs(table.largest)
    if table.over == "angle":
        return _around(table.x, table.y, table.period, room)
    curve = Curve(table.x, table.strokes, room)
    return curve.sharp(curve.joints(0, table.x.size - 1), (table.x[-1] - table.x[0]) / SMOOTH_STRETCHES)


def largest_ignored_kink(table, straight=KINK_TOLERANCE):
    """Share of its largest value by which a table bends at the rows that count as straight, one by one."""
    x, strokes = table.x, table.strokes
    if table.over == "angle":
        x, strokes = (
            np.concatenate([x[-1:] - table.period, x, x[:1] + table.period]),
            [np.concatenate([y[-1:], y, y[:1]]) for y in strokes],
        )
    share = (x[1:-1] - x[:-2]) / (x[2:] - x[:-2])
    off = np.abs([y[1:-1] - y[:-2] - share * (y[2:] - y[:-2]) for y in strokes]).max(axis=0)
    inner = off if table.over == "angle" else np.pad(off, 1)
    return float(np.delete(inner, kink_rows(table, straight)).max(initial=0.0) / (abs(table.largest) or 1.0))


def _around(angle, value, period, room):
    """Of all rows, as they repeat after a period."""
    count = angle.size
    order = (np.arange(count) + int(np.argmax(np.abs(value)))) % count
    around = angle[order] + period * (order < order[0])
    curve = Curve(np.concatenate([around - period, around, around + period]), [np.tile(value[order], 3)], room)
    joints = [count, *curve.joints(count, 2 * count)]
    return order[curve.sharp(joints, 0.5 * TURN / SMOOTH_STRETCHES) - count]


class Curve(NamedTuple):
    """Rows of one or two strokes, and how far they may be off what is smooth."""

    x: Any
    strokes: Any
    room: float

    def joints(self, first, last):
        """Rows between two others at which one longest smooth stretch ends, and the next begins."""
        found, row = [], first
        while (row := self._reached(row, last)) < last:
            found.append(row)
        return found

    def _reached(self, row, last):
        """Up to which row the curve is smooth from one on."""

        def breaks(end):
            return not self._is_smooth(self.x[row], self.x[end])

        count = 2
        while row + count <= last and not breaks(row + count):
            count *= 2
        ends = range(row + count // 2 + 1, min(row + count, last + 1))
        return ends.start - 1 + bisect_left(ends, True, key=breaks)

    def sharp(self, rows, reach):
        """Those rows around which no stretch is smooth that reaches so far."""
        x = self.x
        found = [row for row in rows if not self._is_smooth(max(x[0], x[row] - reach), min(x[row] + reach, x[-1]))]
        return np.array(found, dtype=int)

    def _is_smooth(self, low, high):
        """Whether a polynomial is near all strokes between two places, at rows and besides."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        some = slice(np.searchsorted(self.x, low), np.searchsorted(self.x, high, side="right"))
        places = np.concatenate([CHEBYSHEV_POINTS, (self.x[some] - middle) / half])
        for y in self.strokes:
            values = np.interp(middle + half * CHEBYSHEV_POINTS, self.x, y)
            found = chebyshev.chebval(places, CHEBYSHEV_FIT @ values)
            if np.abs(found - np.concatenate([values, y[some]])).max() > self.room:
                return False
        return True


STOP_SAMPLES = 720
"""Crank angles a turn between which a slider turns back once at most."""
SAMPLE_OFFSET = 1e-3
"""Crank angle from 0, rad, so that no sample meets a dead centre."""
MIN_STEP = 1e-13
"""Step of a crank angle, rad, that is the last."""
MAX_STEPS = 60
"""Steps after which a bracket cannot be halved any more."""


def stops_and_crossings(motion, slider, levels):
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
        grid = (SAMPLE_OFFSET + np.linspace(0.0, TURN * turns, STOP_SAMPLES * turns + 1))[None]
        rate = np.broadcast_arrays(*np.atleast_2d(travel(grid).first, grid))[0]
        closes = ~np.isnan(rate)
        turning = (np.signbit(rate[:, :-1]) != np.signbit(rate[:, 1:])) & closes[:, :-1] & closes[:, 1:]
        design, place = np.nonzero(turning)
        low, high = pad_rows(design, len(rate), grid[0, place], grid[0, place + 1])

        def rates(angle):
            at = travel(angle)
            return at.first, at.second

        stops = _roots(rates, low, high, np.zeros_like(low))
        knots = np.sort(np.column_stack([np.broadcast_to(grid, rate.shape), stops]), axis=1)
        passed = _roots(*_crossing_brackets(travel, levels, knots))
    return np.mod(stops, TURN * turns), np.mod(passed, TURN * turns)


def _crossing_brackets(travel, levels, knots):
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
    return places, *pad_rows(design, len(knots), knots[design, place], knots[design, place + 1], level)


def pad_rows(design, count, *values):
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
    for _ in range(MAX_STEPS):
        value, slope = function(angle)
        beyond = (value > level) == rising
        low, high = np.where(beyond, low, angle), np.where(beyond, angle, high)
        step = angle - (value - level) / slope
        following = np.where((low <= step) & (step <= high), step, 0.5 * (low + high))
        far = np.abs(following - angle) > MIN_STEP
        angle = np.where(moving, following, angle)  # no root hangs on how many steps others take
        moving &= far
        if not moving.any():
            break
    return angle


BOUND_FACTOR = 1.0 + 1e-9
"""What a bound is enlarged by for products of roundings."""
MIN_BOUND = 2.0**-1000
"""More than what a product or quotient too small for a double loses."""


def rounding_bound(table, motion):
    """Bound on the error of values read by crank angle, N or N m.

    A slope has three roundings, the rise along it two more, the sum with the row's value one; a level piece has none.
    Each piece is taken as if all of it were risen. The end of the last one is rounded as well, and a turn more or less
    moves every row, so that another piece may be read where one is near.
    """
    x, slope, own = _piece_errors(table)
    angle = np.asarray(motion.crank_angle)
    turned = np.floor((angle - x[0]) / table.period) * table.period
    place = angle - turned
    row = piece_index(np, x, place)
    bound = own[row]
    on = turned != 0.0
    if not on.any():
        return bound
    reach = np.abs(angle[on]) + np.abs(turned[on]) + abs(x[0]) + table.period
    near = _row_distance(x, place[on]) <= 4.0 * UNIT_ROUNDOFF * reach
    moved = np.zeros_like(bound)
    moved[on] = (BOUND_FACTOR * UNIT_ROUNDOFF) * (3.0 * slope[row[on]] + np.where(near, 8.0 * slope.max(), 0.0)) * reach
    return bound + moved


@lru_cache(maxsize=64)
def _piece_errors(table):
    """Ends of the pieces of a table by angle; of each its slope and the error of values in the first turn."""
    x, y = np.append(table.x, table.x[0] + table.period), np.append(table.y, table.y[0])
    rise = np.abs(np.diff(y))
    slope = rise / np.diff(x)
    own = np.where(rise == 0.0, 0.0, 5.0 * rise + np.maximum(np.abs(y[1:]), np.abs(y[:-1])))
    if x[0] != 0.0:
        own[-1] += 2.0 * abs(x[-1]) * slope[-1]
    return x, slope, BOUND_FACTOR * UNIT_ROUNDOFF * own + MIN_BOUND


def _steepest(x, y):
    return float(np.max(np.abs(np.diff(y) / np.diff(x))))


def _row_distance(x, place):
    """Of each place from the row that is nearest."""
    row = np.clip(np.searchsorted(x, place), 1, x.size - 1)
    return np.minimum(np.abs(place - x[row - 1]), np.abs(place - x[row]))


def kink_bounds(table, motion):
    """Over travel, what bounds need to know of its kinks and jumps (see `engines.record`).

    By how much the slope may change at the row beside each place, N/m or N m/m, how far the value may jump there, how
    near, m or m a radian, a row or the end of a stroke must be for it not to be zero, and how far, m, the row is.
    """
    near = 1e-6 * float(table.x[-1] - table.x[0])
    place, rate = np.asarray(table.place(motion), dtype=float), table.rate(motion)
    sides = [table.y] if table.back is None else [table.y, table.back]
    change, distance = 2.0 * max(_steepest(table.x, side) for side in sides), _row_distance(table.x, place)
    jump = 0.0 if table.back is None else _largest_within(table.x, table.y - table.back, place, near)
    standing = np.abs(rate) <= near
    return np.where(distance <= near, change, 0.0), np.where(standing, jump, 0.0), near, distance


def _largest_within(x, y, place, near):
    """Bound on the magnitude of a polygon so near to each place."""
    largest = np.max(np.abs(y))
    if np.min(np.diff(x)) < 2.0 * near:  # more than one row may be so near
        return largest
    row = np.clip(np.searchsorted(x, place - near), 0, x.size - 1)
    beside = np.where(np.abs(x[row] - place) <= 2.0 * near, np.abs(y[row]), 0.0)
    ends = [np.abs(np.interp(end, x, y)) for end in (place - near, place + near)]
    return np.maximum(beside, np.maximum(*ends)) + 8 * UNIT_ROUNDOFF * largest

"""Rows of a table: what is wrong with them, how they are read, and what is wrong with what is read from them."""

import math
import re

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.arithmetic import namespace
from .period import TURN

BEYOND = 1e-9
"""Share of a table over travel by which a slider may go beyond it: rounding."""
BACKWARDS = re.compile("back|return", re.IGNORECASE)
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


def unread_problem(names, value, over):
    """Why a column of a file whose heading looks like a stroke back, or a value beside it, is not read; or None."""
    read = {f"{value}_back"} if over == "travel" else set()
    read.update(f"{name}_back" for name in names if name != value)
    beside = f"{value}_" if over == "travel" else f"{value}_back"
    for name in names:
        if (BACKWARDS.search(name) or name.startswith(beside)) and name not in read:
            back = f"the stroke back is headed {value}_back"
            wanted = back if over == "travel" else "a stroke back stands over travel"
            return f"column {name!r} would not be read: {wanted}; rename it, or leave it out"
    return None


def looked_at(place, returning):
    """The library that looks values up, places and strokes: NumPy, unless they have no values yet, as under JAX."""
    try:
        return np, np.asarray(place, dtype=float), returning if returning is None else np.asarray(returning)
    except (TypeError, ValueError):
        return next(xp for xp in map(namespace, (place, returning)) if xp is not np), place, returning


def piece(xp, x, place):
    """Which piece between rows each place lies in; the first or last beyond."""
    return xp.clip(xp.searchsorted(xp.asarray(x), place, side="right") - 1, 0, x.size - 2)


def pieces(xp, x, strokes, piece, back=None):
    """Start, value there and slope of some pieces, of the first or, where told, the second of two strokes."""
    place = piece if back is None else piece + (x.size - 1) * back
    values = np.concatenate([y[:-1] for y in strokes])
    slopes = np.concatenate([np.diff(y) / np.diff(x) for y in strokes])
    return tuple(xp.asarray(part)[at] for part, at in ((x, piece), (values, place), (slopes, place)))


def outside(x, place):
    """Whether places lie beyond the rows."""
    room = BEYOND * (x[-1] - x[0])
    return (place < x[0] - room) | (place > x[-1] + room)


def require_inside(x, place, motion):
    """Raise an error where a slider goes beyond the rows."""
    out = outside(x, place)
    if out.any():
        angle = np.degrees(np.broadcast_to(motion.crank_angle, out.shape)[out])
        raise ParameterError(
            f"table over travel: the slider goes from {np.nanmin(place):.9g} to {np.nanmax(place):.9g} m, but the "
            f"table from {x[0]:.9g} to {x[-1]:.9g} m; beyond it at {angle.size} crank angles, the first "
            f"{angle[0]:.6g} deg; travel is the coordinate of the pin along the guide (solution.slider_position)",
            out.any(axis=-1) if out.ndim > 1 else None,
        )


def closes(angle, period):
    """Whether the last row stands at the angle of the first, a period later, but for rounding."""
    return abs(angle[-1] - angle[0] - period) < min(0.1 * np.median(np.diff(angle)), 0.005)


def problem(angle, value, period):
    """What is wrong with rows of a table in order, or None."""
    if angle.size < 3:
        return f"at least 3 rows are needed, got {angle.size}; one that does not change is no table"
    step, span = np.diff(angle), angle[-1] - angle[0]
    if closes(angle, period):
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
            return "" if checks.plain(values, unit) is values else unit
        except checks.DimensionError:
            continue
    return ""

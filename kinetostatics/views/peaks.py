"""Crank angles that a curve must not miss: extremes between those solved, kinks, and both sides of jumps.

Crank angles without a value, shaded and named, and axes that what grows without bound beside them does not set.
"""

from typing import NamedTuple

import numpy as np

from ..errors import KinetostaticsError
from ..results.extremes import extrema
from ..results.rounding import PLACED
from ..solution.drive_and_loads import over_the_angles
from .canvas import in_order, in_sight

AT = 1e-12
"""Distance from a kink, rad, within which samples of the turn stand at it or at a side of a jump."""


def with_peaks(named, *quantities):
    """Solutions by label with more crank angles: those of extremes of quantities, and of kinks of tables and friction.

    All have those of all, so that curves that cover each other still do. A solution stays as it is where there is
    nothing between its crank angles, or these do not rise.

    Parameters
    ----------
    named : mapping of label to Solution
        Each of one design.
    quantities : str or function
        As for `extremes`; vectors by their magnitude.
    """
    more = np.concatenate([np.empty(0), *(_of(solution, item) for solution in named.values() for item in quantities)])
    return {name: _with_angles(solution, np.unique(more)) for name, solution in named.items()}


def _of(solution, quantity):
    """Crank angles in a period that a curve of a quantity must not miss; none where its extremes cannot be told."""
    if not _is_known_between(solution):
        return np.empty(0)
    try:
        found = extrema(solution, quantity)
    except KinetostaticsError:  # a force that does not repeat, for one, can still be drawn where it is solved
        return np.empty(0)
    return between(solution, found.angle[np.isfinite(found.value)])


def between(solution, extremes):
    """Crank angles of extremes where the solution has none, and of kinks and both sides of jumps, rising."""
    there = np.abs(extremes[:, None] - np.mod(solution.crank_angle, solution.period)).min(axis=1) < PLACED
    return np.unique(np.concatenate([extremes[~there], _corners(solution.sampled)]))


def _corners(turn):
    """Samples of a turn at kinks and at both sides of jumps."""
    if not turn.kinks.size:
        return turn.kinks
    kinks = np.concatenate([turn.kinks[-1:] - turn.period, turn.kinks, turn.kinks[:1] + turn.period])
    behind = np.searchsorted(kinks, turn.angle).clip(1, kinks.size - 1)
    distance = np.minimum(turn.angle - kinks[behind - 1], kinks[behind] - turn.angle)
    return turn.angle[distance < AT]


def _is_known_between(solution):
    angle = solution.crank_angle
    return np.ndim(angle) == 1 and not over_the_angles(solution) and angle.size > 1 and bool(np.all(np.diff(angle) > 0))


def _with_angles(solution, more):
    """The solution with such crank angles of its period besides its own, as far as these go round."""
    if not more.size or not _is_known_between(solution):
        return solution
    own, period = solution.crank_angle, solution.period
    span = own[-1] - own[0]
    turns = np.round((span + np.max(np.diff(own))) / period)
    whole = abs(span + np.max(np.diff(own)) - turns * period) < 1e-9 * period
    end = own[0] + (turns * period if whole else span)
    again = period * np.arange(np.floor(own[0] / period), np.floor(end / period) + 1.0)
    more = np.ravel(np.mod(more, period) + again[:, None])
    return solution.at(np.union1d(own, more[(more > own[0]) & (more < end)]))


SHADE = {"color": "0.9", "lw": 0.0, "zorder": 0.5}
WORDS = {"color": "0.35", "fontsize": "x-small"}
LEAST = 0.01
"""Breadth of a gap, beside that of the axes, down to which its name stands in it."""


def shaded(ax, named, curves, counted):
    """Shade where curves (2, N) of solutions have no value, and say why."""
    found: dict[tuple[float, float, str], list[str]] = {}
    for name, solution in named.items():
        _, closed = in_order(solution, solution.closed, counted)
        for start, end, rows in _runs(*curves[name]):
            found.setdefault((start, end, _why(closed[rows].astype(bool), solution)), []).append(name)
    low, high = ax.get_xlim()
    for (start, end, why), names in found.items():
        ax.axvspan(start, end, **SHADE)
        if end - start > LEAST * (high - low):
            text = why if len(names) == len(named) else f"{', '.join(names)}: {why}"
            place = {"transform": ax.get_xaxis_transform(), "rotation": 90, "ha": "center", "va": "bottom"}
            ax.text(0.5 * (start + end), 0.08, text, clip_on=True, **place, **WORDS)
    ax.set_xlim(low, high)


def _runs(angle, value):
    """Runs of rows without a value: from the last angle before that has one to the next behind, and the rows."""
    missing = np.flatnonzero(np.isnan(value))
    for rows in np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1):
        if rows.size:
            yield float(angle[max(rows[0] - 1, 0)]), float(angle[min(rows[-1] + 1, len(angle) - 1)]), rows


def _why(closed, solution):
    if not closed.all():
        return "cannot be assembled"
    return "jams" if solution.friction else "no value"


def framed(ax, arrays, unit):
    """Limit the axis to what is ordinary of values (N,), as they are drawn, if some grow far beyond it."""
    sight = in_sight(arrays)
    if np.isfinite(sight):
        values = np.concatenate(arrays)
        seen = np.clip(values[np.isfinite(values)], -sight, sight)
        low, high = seen.min(), seen.max()
        room = ax.margins()[1] * (high - low)
        ax.set_ylim(low - room, high + room)
        noted(ax, [f"beyond the frame: {size(arrays, unit)}"])


def size(arrays, unit):
    """Up to what size values (N,) go, in words."""
    largest = float(np.nanmax(np.abs(np.concatenate(arrays))))
    return f"up to {largest:.3g} {unit}" if np.isfinite(largest) else "without bound"


def noted(ax, lines):
    """Write lines into the corner of the axes."""
    box = {"boxstyle": "square,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7}
    ax.text(0.01, 0.01, "\n".join(lines), transform=ax.transAxes, va="bottom", bbox=box, **WORDS)


class End(NamedTuple):
    """Where a curve ends that is closed but for gaps, and for what is beyond the frame.

    Attributes
    ----------
    row : int
    angle : float
        Direction in which it goes on, degrees.
    why : str
        What it ends for; "" where it goes on beyond the frame.
    """

    row: int
    angle: float
    why: str


def ends(solution, curve, drawn):
    """Each `End` of a curve (2, N) of a solution over its period, of which some is drawn and the rest is NaN."""
    there, missing = np.isfinite(drawn).all(axis=0), np.isnan(curve).any(axis=0)
    for step in (1, -1):
        for row in np.flatnonzero(there & ~np.roll(there, -step)).tolist():
            before, behind = (row - step) % there.size, (row + step) % there.size
            x, y = drawn[:, row] - (drawn[:, before] if there[before] else 0.0)
            why = _why(solution.closed[[behind]], solution) if missing[behind] else ""
            yield End(row, float(np.degrees(np.arctan2(y, x))), why)


def marked(ax, found, points, color):
    """Mark ends of a curve (2, N): a cross where it stops, a head of an arrow where it goes on."""
    for end in found:
        style = {"marker": "x", "ms": 6, "mew": 1.5} if end.why else {"marker": (3, 0, end.angle - 90.0), "ms": 8}
        ax.plot(*points[:, end.row], ls="", color=color, zorder=4, **style)

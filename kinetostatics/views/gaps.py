"""Crank angles without a value, shaded and named, and axes that what grows without bound beside them does not set."""

import numpy as np

from .canvas import in_order, in_sight

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
        beyond(ax, arrays, unit)


def beyond(ax, arrays, unit):
    """Say up to what size values (N,) go that lie beyond the axes."""
    largest = float(np.nanmax(np.abs(np.concatenate(arrays))))
    size = f"up to {largest:.3g} {unit}" if np.isfinite(largest) else "without bound"
    box = {"boxstyle": "square,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7}
    ax.text(0.01, 0.01, f"beyond the frame: {size}", transform=ax.transAxes, va="bottom", bbox=box, **WORDS)

"""Signs of drawings as points to be joined: springs, dampers, arrows, blocks, hatches; NaN lifts the pen.

Points are arrays (2, K, N): K corners of a sign in each of N poses; places and unit vectors are (2, N).

How each kind of stroke of a shape is drawn.
"""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.path import Path

from .canvas import ACCENT, INK, LOAD, STEEL

UP = (np.nan, np.nan)
SPRING = (
    (0.0, 0.0),
    (0.15, 0.0),
    *((0.15 + 0.7 * (turn + 0.5) / 10, (-1.0) ** turn) for turn in range(10)),
    (0.85, 0.0),
    (1.0, 0.0),
)
DAMPER = (
    *((0.0, 0.0), (0.5, 0.0), UP, (0.5, -0.7), (0.5, 0.7), UP),
    *((0.35, 1.0), (0.65, 1.0), (0.65, -1.0), (0.35, -1.0), UP, (0.65, 0.0), (1.0, 0.0)),
)
LINE = ((0.0, 0.0), (1.0, 0.0))
ARROW = (*LINE, (0.7, 0.5), (1.0, 0.0), (0.7, -0.5))
_HALF, _BENT = np.linspace(-2.4, 1.4, 24), np.linspace(0.0, 4.5 * np.pi, 60)
COUPLE = np.array([*np.transpose([np.cos(_HALF), np.sin(_HALF)]), (0.42, 0.72), (0.17, 0.985), (0.32, 1.3)])
SPIRAL = np.transpose([_BENT * np.cos(_BENT), _BENT * np.sin(_BENT)]) / _BENT[-1]
RING = np.transpose([np.cos(np.linspace(0, 2 * np.pi, 33)), np.sin(np.linspace(0, 2 * np.pi, 33))])
RECTANGLE = np.array([(-1.0, -0.6), (1.0, -0.6), (1.0, 0.6), (-1.0, 0.6)])

_quarters = [Path.wedge(0, 90), Path.wedge(180, 270)]
MASS_CENTRE_PATH = Path.make_compound_path(*_quarters)
"""Dark quarters of the sign of a mass centre, as a marker."""
_ticks = np.arange(-0.8, 1.01, 0.4)
PIVOT = Path.make_compound_path(
    Path([(0, 0), (-0.7, -1.0), (0.7, -1.0), (0, 0)]),
    Path([(-1.0, -1.0), (1.0, -1.0)]),
    *(Path([(x, -1.0), (x - 0.3, -1.4)]) for x in _ticks),
)
"""A fixed pivot on hatched ground, as a marker with the pivot at its middle."""


def left(direction):
    """Vectors a quarter turn counter-clockwise from those given."""
    return np.array([-direction[1], direction[0]])


def placed(shape, origin, direction, size=1.0, sense=1.0):
    """A shape (K, 2) in axes with origin and direction (2, N), as points (2, K, N); mirrored where the sense is -1."""
    along, across = size * np.asarray(shape, dtype=float).T[..., None]
    return origin[:, None] + direction[:, None] * along + left(direction)[:, None] * (sense * across)


def spanned(shape, start, end, width):
    """A shape (K, 2) from start to end, across which it has a width."""
    apart = end - start
    length = np.hypot(*apart)
    direction = apart / np.where(length > 0, length, 1.0)
    along, across = np.asarray(shape, dtype=float).T[..., None]
    return start[:, None] + apart[:, None] * along + left(direction)[:, None] * width * across


def hatched(start, end, width):
    """A straight line from start to end (2,), hatched on its right."""
    length = np.hypot(*(end - start))
    direction = (end - start) / (length or 1.0)
    ticks = np.arange(0.5 * width, length, width)
    foot = start[:, None] + direction[:, None] * ticks
    tip = foot - width * (left(direction) + 0.6 * direction)[:, None]
    strokes = np.stack([foot, tip, np.full_like(foot, np.nan)], axis=-1).reshape(2, -1)
    return np.column_stack([start, end, UP, strokes])


LINES: dict[str, dict[str, Any]] = {
    "bar": {"color": STEEL, "lw": 2.5, "solid_capstyle": "round", "zorder": 2},
    "slotted": {"color": STEEL, "lw": 7, "solid_capstyle": "round", "zorder": 2},
    "slot": {"color": "white", "lw": 3.5, "solid_capstyle": "round", "zorder": 2.1},
    "spring": {"color": INK, "lw": 1, "zorder": 2.5},
    "damper": {"color": INK, "lw": 1, "zorder": 2.5},
    "outline": {"color": ACCENT, "lw": 0.9, "ls": "-.", "zorder": 1.6},
    "line": {"color": INK, "lw": 0.8, "ls": "--", "zorder": 2.5},
    "force": {"color": LOAD, "lw": 1.5, "zorder": 5},
}
"""How each kind of stroke is drawn as a line."""
PLATES: dict[str, dict[str, Any]] = {
    "counterweight": {"fc": "0.75", "ec": "0.5", "lw": 0.8, "zorder": 1.5},
    "plate": {"fc": "lightsteelblue", "ec": STEEL, "lw": 1.5, "zorder": 1.8},
    "block": {"fc": STEEL, "ec": "none", "zorder": 3},
    "roller": {"fc": "none", "ec": INK, "lw": 1.0, "zorder": 3.2},
}
"""How each kind of stroke is drawn as a filled shape."""


def artist(ax, stroke, shade):
    """What a stroke is drawn by, still empty."""
    if stroke.kind in PLATES:
        return ax.add_patch(Polygon(np.full((3, 2), np.nan), alpha=shade, **PLATES[stroke.kind]))
    return ax.add_line(Line2D([], [], alpha=shade, **LINES[stroke.kind]))


def put(drawn, points):
    """Give what a stroke is drawn by its points (2, K)."""
    if isinstance(drawn, Line2D):
        drawn.set_data(points)
    else:
        drawn.set_xy(points.T)

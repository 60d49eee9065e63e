"""How each kind of stroke of a shape is drawn."""

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from .canvas import ACCENT, INK, LOAD, STEEL

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

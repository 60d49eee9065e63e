"""Texts of a figure that lie on each other."""

import numpy as np
from matplotlib.text import Text

SLACK = 1.0
"""Pixels by which boxes of texts may overlap: boxes are a little larger than their letters."""


def overlaps(figure):
    """Pairs of texts whose boxes overlap in a drawn figure, without slanted ones."""
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    away = {text for ax in figure.axes if ax.name != "polar" for text in _out_of_sight(ax, renderer)}
    shown = [
        item
        for item in figure.findobj(Text)
        if item.get_visible() and item.get_text().strip() and item not in away and item.get_rotation() % 90.0 == 0.0
    ]
    boxes = np.array([item.get_window_extent(renderer).extents for item in shown])
    shared = np.minimum(boxes[:, None, 2:], boxes[:, 2:]) - np.maximum(boxes[:, None, :2], boxes[:, :2])
    pairs = np.argwhere(np.triu((shared > SLACK).all(axis=-1), 1))
    return [(shown[one].get_text(), shown[two].get_text()) for one, two in pairs]


def _out_of_sight(ax, renderer):
    """Texts that are not drawn: numbers of ticks beyond the ends of their axis, and all of an axis that is off."""
    if not ax.axison:
        for axis in (ax.xaxis, ax.yaxis):
            yield from (axis.label, *axis.get_ticklabels(which="both"))
        return
    for axis, start, end in (("x", ax.bbox.x0, ax.bbox.x1), ("y", ax.bbox.y0, ax.bbox.y1)):
        for text in getattr(ax, f"{axis}axis").get_ticklabels(which="both"):
            box = text.get_window_extent(renderer)
            low, high = getattr(box, f"{axis}0"), getattr(box, f"{axis}1")
            if not start - 3.0 <= 0.5 * (low + high) <= end + 3.0:
                yield text

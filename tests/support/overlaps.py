"""Texts of a figure that lie on each other."""

from itertools import combinations

from matplotlib.text import Text

SLACK = 1.0
"""Pixels by which boxes of texts may overlap: boxes are a little larger than their letters."""


def overlaps(figure):
    """Pairs of texts whose boxes overlap in a drawn figure, without slanted ones."""
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    away = {text for ax in figure.axes if ax.name != "polar" for text in _out_of_sight(ax, renderer)}
    shown = [item for item in figure.findobj(Text) if item.get_visible() and item.get_text().strip()]
    boxes = [
        (item.get_text(), item.get_window_extent(renderer))
        for item in shown
        if item not in away and item.get_rotation() % 90.0 == 0.0
    ]
    return [(one, two) for (one, box), (two, other) in combinations(boxes, 2) if _overlap(box, other)]


def _overlap(box, other):
    width = min(box.x1, other.x1) - max(box.x0, other.x0)
    return width > SLACK and min(box.y1, other.y1) - max(box.y0, other.y0) > SLACK


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

"""Labels that keep clear of each other and of what is drawn, placed anew whenever a figure is drawn."""

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.transforms import Bbox, IdentityTransform

DIRECTIONS = np.exp(0.25j * np.pi * np.array([1, 3, -1, -3, 0, 2, 4, -2]))
"""Ways from a point to its label, the first of them preferred."""
DISTANCES = (6.0, 11.0, 17.0, 26.0, 38.0)
"""Between a point and the nearest side of its label, points of print."""
LED = 14.0
"""Distance from which on a line leads from the label to its point."""
ON_LABEL, ON_POINT, ON_CURVE, OUTSIDE = 20.0, 4.0, 1.5, 10.0
"""What it costs a label to lie there; a farther place costs up to 1."""
ROUNDS = 3
"""How often each label is placed: first beside those before it, then beside all others."""


class Labels(Artist):
    """Places annotations clear of each other: it is drawn before them, and draws the lines that lead to far ones."""

    def __init__(self):
        super().__init__()
        self.set_zorder(-1)
        self.set_in_layout(False)
        self.texts = []

    def draw(self, renderer):
        """Move each label to the best place left."""
        ax: Any = self.axes
        lines, scale = ax.lines, renderer.points_to_pixels(1.0)
        paths = [(_in_pixels(line), False) for line in lines] + [(_in_pixels(patch), True) for patch in ax.patches]
        marks = [box for line in lines if isinstance(line.get_marker(), Path) for box in _boxes(line, scale)]
        shown = [text for text in self.texts if np.isfinite(text.xy).all()]
        points = ax.transData.transform([text.xy for text in shown]) if shown else ()
        frees = []  # the places of each label, and what each costs beside all that is not a label
        for text, point in zip(shown, points, strict=True):
            size = text.get_window_extent(renderer)
            places = list(_places(point, size.width, size.height, scale))
            frees.append((places, STEPS + [self._cost(box, points, marks, paths) for _, box, _ in places]))
        chosen: list[tuple] = []
        for place in list(range(len(shown))) * ROUNDS:
            others = chosen[:place] + chosen[place + 1 :]
            places, costs = frees[place]
            costs = costs + [_met(box, leader, others) for _, box, leader in places]
            chosen[place : place + 1] = [places[int(np.argmin(costs))]]
        for text, (offset, _, leader) in zip(shown, chosen, strict=True):
            text.set_position(offset / scale)
            if leader is not None:
                Line2D(*leader.vertices.T, color="0.5", lw=0.5, transform=IdentityTransform()).draw(renderer)

    def _cost(self, box, points, marks, paths):
        frame: Any = self.axes
        outside = not (frame.bbox.contains(box.x0, box.y0) and frame.bbox.contains(box.x1, box.y1))
        return (
            ON_POINT * sum(box.contains(*point) for point in points)
            + ON_POINT * sum(bool(Bbox.intersection(box, mark)) for mark in marks)
            + ON_CURVE * sum(path.intersects_bbox(box, filled=filled) for path, filled in paths)
            + OUTSIDE * outside
        )


def _met(box, leader, others):
    """What it costs a label that it, or the line that leads to it, meets other labels and lines that lead to them."""
    met = [Bbox.intersection(box, other) is not None for _, other, _ in others]
    for _, other, line in others:
        if line is not None:
            met.append(line.intersects_bbox(box, filled=False))
        if leader is not None:
            met.append(leader.intersects_bbox(other, filled=False))
            met.append(line is not None and leader.intersects_path(line, filled=False))
    return ON_LABEL * sum(map(bool, met))


def _leader(point, box):
    """A line from a point to the nearest place of its label, in pixels."""
    return Path([point, np.clip(point, (box.x0, box.y0), (box.x1, box.y1))])


def _in_pixels(item):
    return item.get_transform().transform_path(item.get_path())


def _boxes(line, scale):
    """Boxes of markers that have a shape of their own, in pixels."""
    corners = line.get_marker().get_extents().get_points()
    corners = corners * 0.5 * scale * line.get_markersize() / np.abs(line.get_marker().vertices).max()
    return [Bbox(corners + point) for point in _in_pixels(line).vertices]


STEPS = np.linspace(0.0, 1.0, len(DISTANCES) * len(DIRECTIONS))


def _places(point, width, height, scale):
    """Offset of the label's lower left corner from the point, its box, and a line to it if it is far, in pixels."""
    for distance in DISTANCES:
        for way in DIRECTIONS:
            x = distance * scale * way.real + 0.5 * width * (np.sign(round(way.real, 9)) - 1.0)
            y = distance * scale * way.imag + 0.5 * height * (np.sign(round(way.imag, 9)) - 1.0)
            box = Bbox.from_bounds(point[0] + x, point[1] + y, width, height)
            yield np.array([x, y]), box, _leader(point, box) if distance > LED else None


def label(ax, text, point, **style):
    """Annotation at a point that keeps clear of the others and of what is drawn on the axes."""
    keeper = next((item for item in ax.artists if isinstance(item, Labels)), None)
    if keeper is None:
        keeper = ax.add_artist(Labels())
    options = {"textcoords": "offset points", "fontsize": "x-small", "ha": "left", "va": "bottom"}
    made = ax.annotate(text, np.asarray(point, dtype=float), xytext=(6, 6), **options | style)
    keeper.texts.append(made)
    return made

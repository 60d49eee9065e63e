"""Labels that avoid each other and all drawn objects; every drawing of a figure places them again."""

from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.lines import Line2D
from matplotlib.path import Path
from matplotlib.transforms import Bbox, IdentityTransform

DIRECTIONS = np.exp(0.25j * np.pi * np.array([1, 3, -1, -3, 0, 2, 4, -2]))
"""Directions from a point to its label, in order of preference."""
DISTANCES = (6.0, 11.0, 17.0, 26.0, 38.0, 54.0, 76.0)
"""Distances between a point and the nearest side of its label, in typographic points."""
LEADER_DISTANCE = 14.0
"""Distance from which on a leader line connects label and point."""
ON_LABEL, ON_POINT, ON_CURVE, OUTSIDE, NEAR_POINT = 20.0, 4.0, 1.5, 10.0, 3.0
"""Costs of a label on another label, a point, a curve, outside the axes, and near another point than its own.

Each farther place costs 1/40.
"""
CLEARANCE = 3.0
"""Distance that a label keeps from the frame of the axes and from points of others, in typographic points."""
GROUND = {"boxstyle": "square,pad=0.05", "fc": "white", "ec": "none", "alpha": 0.65}
"""Ground of a label, so that it can be read on a line."""
PLACEMENT_ROUNDS = 3
"""Rounds of placement: in the first, labels avoid earlier ones, then all others."""


class Labels(Artist):
    """Artist that places annotations without overlap before they are drawn, and draws their leader lines."""

    def __init__(self):
        super().__init__()
        self.set_zorder(-1)
        self.set_in_layout(False)
        self.texts = []

    def draw(self, renderer):
        """Move each label to its best place."""
        ax: Any = self.axes
        lines, scale = ax.lines, renderer.points_to_pixels(1.0)
        filled = [(line, False) for line in lines] + [(patch, True) for patch in ax.patches]
        paths = [(path, _extents(path), full) for item, full in filled if len((path := _in_pixels(item)).vertices)]
        marks = [NO_BOX]  # boxes of markers with path shapes, (N, 4)
        for line in lines:
            if isinstance(shape := line.get_marker(), Path):
                corners = shape.get_extents().get_points()
                corners = corners * 0.5 * scale * line.get_markersize() / np.abs(shape.vertices).max()
                marks.append((corners + _in_pixels(line).vertices[:, None]).reshape(-1, 4))
        shown = [text for text in self.texts if np.isfinite(text.xy).all()]
        points = ax.transData.transform([text.xy for text in shown]) if shown else ()
        wide = CLEARANCE * scale * np.array([-1.0, -1.0, 1.0, 1.0])
        frees = []  # the places of each label, and their costs without other labels
        for text, point in zip(shown, points, strict=True):
            size = text.get_window_extent(renderer)
            places = _Places.around(point, size.width, size.height, scale)
            boxes = places.boxes
            outside = ~_contain(np.array([ax.bbox.extents]), (boxes + wide).reshape(-1, 2)).reshape(-1, 2).all(axis=1)
            others = [other for other in points if not np.allclose(other, point)]
            costs = (
                ON_POINT * _contain(boxes, np.array(points)).sum(axis=1)
                + ON_POINT * _overlap(boxes, np.concatenate(marks)).sum(axis=1)
                + ON_CURVE * sum((places.crossed(*path) for path in paths), np.zeros(len(boxes)))
                + NEAR_POINT * _contain(boxes + wide, np.reshape(others, (-1, 2))).any(axis=1)
                + OUTSIDE * outside
            )
            frees.append((places, DISTANCE_COSTS + costs))
        chosen: list[tuple] = []
        for place in list(range(len(shown))) * PLACEMENT_ROUNDS:
            others = chosen[:place] + chosen[place + 1 :]
            places, costs = frees[place]
            best = int(np.argmin(costs + places.met(others)))
            chosen[place : place + 1] = [(places.offsets[best], places.boxes[best], places.leaders[best])]
        for text, (offset, _, leader) in zip(shown, chosen, strict=True):
            text.set_position(offset / scale)
            if leader is not None:
                Line2D(*leader.vertices.T, color="0.5", lw=0.5, transform=IdentityTransform()).draw(renderer)


NO_BOX = np.empty((0, 4))


def _overlap(boxes, others):
    """Whether boxes, rows (x0, y0, x1, y1), overlap others, (boxes, others)."""
    low, high = np.maximum(boxes[:, None, :2], others[:, :2]), np.minimum(boxes[:, None, 2:], others[:, 2:])
    return (low <= high).all(axis=-1)


def _contain(boxes, points):
    """Whether boxes contain points, (boxes, points)."""
    return _overlap(boxes, np.hstack([points, points]))


def _extents(path):
    """Box (4,) around all vertices of a path; NaN without one."""
    vertices = path.vertices[np.isfinite(path.vertices).all(axis=1)]
    return np.concatenate([vertices.min(axis=0), vertices.max(axis=0)]) if len(vertices) else np.full(4, np.nan)


def _in_pixels(item):
    return item.get_transform().transform_path(item.get_path())


DISTANCE_COSTS = np.arange(len(DISTANCES) * len(DIRECTIONS)) / 40.0


class _Places(NamedTuple):
    """Possible places of a label, in pixels.

    `offsets` (P, 2) lead from the point to the lower left corner of the `boxes` (P, 4). A label far away has a leader
    from the point to its nearest side; `reaches` (P, 4) are the boxes of the leaders.
    """

    offsets: np.ndarray
    boxes: np.ndarray
    leaders: list
    reaches: np.ndarray

    @classmethod
    def around(cls, point, width, height, scale):
        """Places around a point for a label of some size."""
        distance, way = np.repeat(DISTANCES, len(DIRECTIONS)), np.tile(DIRECTIONS, len(DISTANCES))
        x = distance * scale * way.real + 0.5 * width * (np.sign(way.real.round(9)) - 1.0)
        y = distance * scale * way.imag + 0.5 * height * (np.sign(way.imag.round(9)) - 1.0)
        offsets = np.column_stack([x, y])
        boxes = np.hstack([point + offsets, point + offsets + [width, height]])
        leaders = [
            Path([point, np.clip(point, box[:2], box[2:])]) if far else None
            for far, box in zip(distance > LEADER_DISTANCE, boxes, strict=True)
        ]
        reaches = np.array([np.full(4, np.nan) if leader is None else _extents(leader) for leader in leaders])
        return cls(offsets, boxes, leaders, reaches)

    def crossed(self, path, extents, filled):
        """Whether a path meets the box of each place, (P,); only boxes within its extents are tested exactly."""
        count = _overlap(self.boxes, extents[None])[:, 0].astype(int)
        for place in np.flatnonzero(count):
            count[place] = path.intersects_bbox(Bbox.from_extents(self.boxes[place]), filled=filled)
        return count

    def met(self, others):
        """Costs of each place for overlap with other labels and their leaders, (P,)."""
        others_boxes = np.array([box for _, box, _ in others]).reshape(-1, 4)
        count = 2 * _overlap(self.boxes, others_boxes).sum(axis=1)  # worse than a leader that is crossed
        for _, other, line in others:
            for place in np.flatnonzero(_overlap(self.reaches, other[None])[:, 0]):
                count[place] += self.leaders[place].intersects_bbox(Bbox.from_extents(other), filled=False)
            if line is not None:
                extents = _extents(line)
                count += self.crossed(line, extents, False)
                for place in np.flatnonzero(_overlap(self.reaches, extents[None])[:, 0]):
                    count[place] += self.leaders[place].intersects_path(line, filled=False)
        return ON_LABEL * count


def label(ax, text, point, **style):
    """Annotation at a point that avoids other labels and everything drawn on the axes."""
    keeper = next((item for item in ax.artists if isinstance(item, Labels)), None)
    if keeper is None:
        keeper = ax.add_artist(Labels())
    options = {"textcoords": "offset points", "fontsize": "x-small", "ha": "left", "va": "bottom", "bbox": GROUND}
    made = ax.annotate(text, np.asarray(point, dtype=float), xytext=(6, 6), **options | style)
    keeper.texts.append(made)
    return made

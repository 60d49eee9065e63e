"""Drawings of machines as data for the page: strokes that move as rigid bodies, joints, mass centres, arrows.

Arrays are base64 of little-endian numbers. A stroke has the points of its first pose; if it moves, also place and angle
in each pose; if it changes shape, as springs do, all its points.
"""

import base64
from typing import Any

import numpy as np

from ...machine.group import FRAME
from ...mechanics.quantities import magnitude
from .. import strokes
from ..canvas import close_curve, grouped
from ..strokes import UNCLIPPED_SHARE, Shape, Stroke, moving_surfaces, working_curves

ARROW_REACH = 0.3
"""Length of the longest arrow, over the largest extent of the joints."""
MAX_ARROW = 1.2 * ARROW_REACH
"""Length limit of an arrow where a reaction grows without bound."""
LIKE_SIZE = 0.4
"""Size of a machine, over that of the largest in the frame, below which it has a frame of its own."""
RIGID_TOLERANCE = 1e-5
"""Invisible deviation from a rigid body, over the largest extent of the joints."""
FILLED_KINDS = ("counterweight", "plate", "block", "ground")
"""Kinds of strokes that are closed and filled."""


def to_base64(values, kind="<f4"):
    """Numbers as base64."""
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii")


def movements(machines):
    """Drawings of machines by name, and the largest torque; machines of like size have one frame and force scale."""
    shapes = {name: Shape(machine.solution) for name, machine in machines.items()}
    solutions = [machine.solution for machine in machines.values()]
    forces = {
        name: max((_largest(shape.turn, joint) for joint in shape.turn.reactions), default=0.0)
        for name, shape in shapes.items()
    }
    torque = max(float(np.nanmax(np.abs(solution.balancing_torque), initial=0.0)) for solution in solutions)
    frames: dict[str, dict[str, Any]] = {}
    drawings = {}
    for names in _of_like_size(shapes):
        size = max(shapes[name].size for name in names)
        force = max(forces[name] for name in names)
        scale, boxes = ARROW_REACH * size / force if force else 0.0, []
        for name in names:
            drawings[name] = _drawing(name, shapes[name], scale, MAX_ARROW * size, boxes)
        corners = np.concatenate(boxes, axis=1)
        low, high = np.nanmin(corners, axis=1), np.nanmax(corners, axis=1)
        frame = {"box": [*map(float, low), *map(float, high)], "scale": scale, "longest": MAX_ARROW * size}
        frames |= dict.fromkeys(names, frame)
    return {"drawings": [drawings[name] | frames[name] for name in shapes], "torque": torque}


def _of_like_size(shapes):
    """Names of shapes in lists, the largest first; each is larger than `LIKE_SIZE` times the first of its list."""
    by_size = sorted(shapes, key=lambda name: -shapes[name].size)
    return grouped(by_size, lambda first, other: shapes[other].size > LIKE_SIZE * shapes[first].size)


def _largest(solution, joint):
    """Largest magnitude of a reaction; a quantile if it grows without bound."""
    size = magnitude(solution.reaction(joint))
    size = size[np.isfinite(size)]
    if not size.size:
        return 0.0
    return float(np.quantile(size, UNCLIPPED_SHARE) if solution.mechanism.grows(joint) else size.max())


def _drawing(name, shape, scale, longest, boxes):
    solution = shape.turn
    made = solution.mechanism
    strokes = [*_fixed_strokes(shape), *shape.counterweights(solution), *shape.strokes(solution)]
    strokes += [*shape.ties(solution, solution.loads), *moving_surfaces(solution, solution)]
    strokes += shape.signs(solution.loads, solution)
    boxes += [np.reshape(stroke.points, (2, -1)) for stroke in strokes]
    outputs = made.outputs
    arrows = {joint: outputs[joint].at or joint for joint in solution.reactions}
    places = {joint: solution.position(joint) for joint in dict.fromkeys([*made.joints, *arrows.values()])}
    for joint, at in arrows.items():
        vector = scale * solution.reaction(joint)
        length = magnitude(vector)
        with np.errstate(invalid="ignore", divide="ignore"):
            shown = np.minimum(1.0, longest / np.where(length > 0, length, 1.0))
        boxes.append(places[at] + vector * shown)
    return {
        "name": name,
        "kind": made.name,
        "strokes": [_stroke_data(stroke, shape.size) for stroke in strokes],
        "joints": {joint: to_base64(place.T) for joint, place in places.items()},
        "moving": [joint for joint, point in made.joints.items() if point.link != FRAME],
        "named": list(made.joints),
        "masses": [to_base64(solution.position(link).T) for link in shape.heavy],
        "arrows": arrows,
        "centre": next(iter(made.joints)),
    }


def _fixed_strokes(shape):
    """Fixed strokes: ground under pivots, guides, paths of joints on curves, circles of cranks."""
    mechanism, turn, unit = shape.mechanism, shape.turn, shape.unit

    def still(kind, points):
        return Stroke(kind, np.asarray(points, dtype=float)[..., None])

    for joint in mechanism.curves:
        yield still("curve", close_curve(turn.position(joint)))
    for body, points in working_curves(turn):
        if body == FRAME:
            yield still("surface", points)
    for bar in mechanism.crank.bars:
        yield still("circle", close_curve(turn.position(bar.end)))
    for rail in shape.rails():
        yield still("rail", rail)
    for point in shape.grounds(turn.loads):
        foot = np.array([[0.0, -0.7, 0.7], [0.0, -1.0, -1.0]]) * unit
        yield still("ground", point[:, None] + foot)
        ends = point[:, None] + unit * np.array([[1.0, -1.0], [-1.0, -1.0]])
        yield still("rail", strokes.hatched_line(ends[:, 1], ends[:, 0], 0.4 * unit))


def _stroke_data(stroke, size):
    """A stroke as data for the page."""
    points = np.asarray(stroke.points, dtype=float)
    sent = {"kind": stroke.kind, "filled": stroke.kind in FILLED_KINDS, "points": to_base64(points[..., 0].T)}
    if points.shape[2] == 1 or _same(points, points[..., :1], size):
        return sent
    # the best-fit shift and angle of a rigid body, from the first pose to each
    middles = np.nanmean(points, axis=1)
    first, others = points[..., 0] - middles[:, :1], points - middles[:, None]
    cross = np.nansum(first[0][:, None] * others[1] - first[1][:, None] * others[0], axis=0)
    dot = np.nansum(first[0][:, None] * others[0] + first[1][:, None] * others[1], axis=0)
    angle = np.arctan2(cross, dot)
    shift = middles - _rotate(middles[:, :1], angle)
    if _same(points, _rotate(points[..., :1], angle) + shift[:, None], size):
        return sent | {"poses": to_base64(np.stack([*shift, angle]).T)}
    return sent | {"shapes": to_base64(points.transpose(2, 1, 0))}


def _same(points, others, size):
    gaps = np.isnan(points)
    if (gaps != np.isnan(np.broadcast_to(others, points.shape))).any():
        return False
    return bool(np.max(np.abs(points - others), where=~gaps, initial=0.0) < RIGID_TOLERANCE * size)


def _rotate(points, angle):
    (x, y), cosine, sine = points, np.cos(angle), np.sin(angle)
    return np.stack([cosine * x - sine * y, sine * x + cosine * y])

"""Drawings of machines as data for a page: strokes that move as rigid bodies, joints, mass centres, arrows.

Arrays are of single precision. A stroke has `points` (K, 2). One that moves has `poses` (N, 3) as well, x, y and angle
of its axes. One that changes shape, as a spring, has `shapes` (N, K, 2), its points in each pose.
"""

from typing import Any

import numpy as np

from ..machine.group import FRAME
from ..mechanics.quantities import magnitude
from ..numbers.formatting import pretty_unit
from .canvas import close_curve, display_unit, grouped
from .strokes import UNCLIPPED_SHARE, RigidStroke, Shape, Stroke, hatched_line, moving_surfaces, working_curves

ARROW_REACH = 0.3
"""Length of the longest arrow, over the largest extent of the joints."""
MAX_ARROW = 1.2 * ARROW_REACH
"""Length limit of an arrow where a reaction grows without bound."""
LIKE_SIZE = 0.4
"""Size of a machine, over that of the largest in the frame, below which it has a frame of its own."""
STILL_TOLERANCE = 1e-5
"""Invisible motion, over the largest extent of the joints."""
FILLED_KINDS = ("counterweight", "plate", "block", "ground")
"""Kinds of strokes that are closed and filled."""
MAX_BOX_POINTS = 2000
"""Points of a stroke that the box of a drawing is found from."""


def drawing_of(shape):
    """Drawing of a `Shape` in a frame of its own; `movements` describes it."""
    return _framed({"": shape})[""]


def turning_sense(scene):
    """Sense in which the crank plays, 1 or -1."""
    return -1 if np.any(np.asarray(scene.crank_speed) < 0) else 1


def one_pose(drawing, index):
    """A drawing without all poses but one, whose index it has as `pose`."""
    chosen = slice(index, index + 1)
    strokes = [
        stroke | {key: stroke[key][chosen] for key in ("poses", "shapes") if key in stroke}
        for stroke in drawing["strokes"]
    ]
    places = {key: {name: part[chosen] for name, part in drawing[key].items()} for key in ("joints", "forces")}
    masses = [place[chosen] for place in drawing["masses"]]
    return drawing | places | {"strokes": strokes, "masses": masses, "torque": drawing["torque"][chosen], "pose": index}


def movements(machines):
    """Drawings of machines by name; machines of like size have one frame and force scale.

    A drawing has `strokes`, places of `joints` and `masses` (N, 2), `forces` of reactions (N, 2) and `torque` (N,).
    `arrows` names the joint of each reaction. The frame has the `box` (left, low, right, high), m, the `scale` of
    arrows, m/N, the length of the `longest`, the `largest_torque`, and the `force_unit` with its factor.
    """
    shapes = {name: Shape(machine.solution) for name, machine in machines.items()}
    by_size = sorted(shapes, key=lambda name: -shapes[name].size)
    drawings: dict[str, dict[str, Any]] = {}
    for names in grouped(by_size, lambda first, other: shapes[other].size > LIKE_SIZE * shapes[first].size):
        drawings |= _framed({name: shapes[name] for name in names})
    torque = max(drawing["largest_torque"] for drawing in drawings.values())
    return [drawings[name] | {"largest_torque": torque} for name in shapes]


def _framed(shapes):
    """Drawings of machines in one frame."""
    size = max(shape.size for shape in shapes.values())
    reactions = {name: {joint: s.turn.reaction(joint) for joint in s.turn.reactions} for name, s in shapes.items()}
    mechanisms = {name: shape.turn.mechanism for name, shape in shapes.items()}
    forces = [
        _largest(vector, mechanisms[name].grows(joint))
        for name, vectors in reactions.items()
        for joint, vector in vectors.items()
    ]
    force, torques = max(forces, default=0.0), {name: shape.turn.balancing_torque for name, shape in shapes.items()}
    factor, unit = display_unit("N", [magnitude(vector) for found in reactions.values() for vector in found.values()])
    frame: dict[str, Any] = {
        "scale": ARROW_REACH * size / force if force else 0.0,
        "longest": MAX_ARROW * size,
        "largest_torque": max(float(np.nanmax(np.abs(torque), initial=0.0)) for torque in torques.values()),
        "force_unit": {"factor": factor, "unit": pretty_unit(unit)},
    }
    boxes: list[np.ndarray] = []
    drawings = {
        name: _drawing(name, shape, reactions[name], torques[name], frame, boxes) for name, shape in shapes.items()
    }
    corners = np.concatenate(boxes, axis=1)
    frame["box"] = np.concatenate([np.nanmin(corners, axis=1), np.nanmax(corners, axis=1)]).tolist()
    return {name: drawing | frame for name, drawing in drawings.items()}


def _largest(vector, grows):
    """Largest magnitude of a reaction; a quantile if it grows without bound."""
    size = magnitude(vector)
    size = size[np.isfinite(size)]
    if not size.size:
        return 0.0
    return float(np.quantile(size, UNCLIPPED_SHARE) if grows else size.max())


def _drawing(name, shape, reactions, torque, frame, boxes):
    solution = shape.turn
    made = solution.mechanism
    strokes = [*_fixed_strokes(shape), *shape.counterweights(solution), *shape.strokes(solution)]
    strokes += [*shape.ties(solution, solution.loads), *moving_surfaces(solution, solution)]
    strokes += shape.symbols(solution.loads, solution)
    boxes += [_corners(stroke) for stroke in strokes]
    outputs = made.outputs
    arrows = {joint: outputs[joint].at or joint for joint in reactions}
    places = {joint: solution.position(joint) for joint in dict.fromkeys([*made.joints, *arrows.values()])}
    for joint, at in arrows.items():
        vector = frame["scale"] * reactions[joint]
        length = magnitude(vector)
        with np.errstate(invalid="ignore", divide="ignore"):
            shown = np.minimum(1.0, frame["longest"] / np.where(length > 0, length, 1.0))
        boxes.append(places[at] + vector * shown)
    return {
        "name": name,
        "kind": made.name,
        "strokes": [_stroke_data(stroke, shape.size) for stroke in strokes],
        "joints": {joint: _single(place.T) for joint, place in places.items()},
        "moving": [joint for joint, point in made.joints.items() if point.link != FRAME],
        "named": list(made.joints),
        "masses": [_single(solution.position(link).T) for link in shape.heavy],
        "arrows": arrows,
        "forces": {joint: _single(vector.T) for joint, vector in reactions.items()},
        "torque": _single(torque),
        "centre": next(iter(made.joints)),
    }


def _single(values):
    """Numbers of single precision; infinity where they are too large."""
    with np.errstate(over="ignore"):
        return np.asarray(values, dtype=np.float32)


def _corners(stroke):
    """Points (2, M) of a stroke in enough of its poses for the box of a drawing."""
    if isinstance(stroke, RigidStroke):
        step = 1 + stroke.own.shape[1] * stroke.origin.shape[1] // MAX_BOX_POINTS
        stroke = stroke._replace(origin=stroke.origin[:, ::step], direction=stroke.direction[:, ::step])
    return np.reshape(stroke.points, (2, -1))


def _fixed_strokes(shape):
    """Fixed strokes: ground under pivots, guides, paths of joints on curves, circles of cranks."""
    mechanism, turn, half = shape.mechanism, shape.turn, shape.half_block

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
        foot = np.array([[0.0, -0.7, 0.7], [0.0, -1.0, -1.0]]) * half
        yield still("ground", point[:, None] + foot)
        ends = point[:, None] + half * np.array([[1.0, -1.0], [-1.0, -1.0]])
        yield still("rail", hatched_line(ends[:, 1], ends[:, 0], 0.4 * half))


def _stroke_data(stroke, size):
    """A stroke as data for the page."""
    sent = {"kind": stroke.kind, "filled": stroke.kind in FILLED_KINDS}
    if isinstance(stroke, RigidStroke):
        angle = np.broadcast_to(np.arctan2(stroke.direction[1], stroke.direction[0]), stroke.origin.shape[1:])
        return sent | {"points": _single(stroke.own.T), "poses": _single(np.stack([*stroke.origin, angle], axis=-1))}
    points = np.asarray(stroke.points, dtype=float)
    sent["points"] = _single(points[..., 0].T)
    if points.shape[2] > 1 and np.nanmax(np.ptp(points, axis=2)) > STILL_TOLERANCE * size:
        sent["shapes"] = _single(points.transpose(2, 1, 0))
    return sent

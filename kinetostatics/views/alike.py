"""Machines that look alike: which move so, and what of counterweights and loads each has of its own."""

from typing import Any

import numpy as np

from .shape import Shape, posed, whole_turn


def moves_alike(solution, other):
    """Whether two machines look the same in every pose, but for counterweights and loads."""
    made, twin = solution.mechanism, other.mechanism
    if (list(made.joints), list(made.links)) != (list(twin.joints), list(twin.links)):
        return False
    both = [Shape(posed(item, np.linspace(0.0, 360.0 * made.turns, 25))) for item in (solution, other)]
    here, there = ([stroke.points for stroke in shape.strokes(shape.turn)] for shape in both)
    reach = 1e-6 * both[0].size
    return len(here) == len(there) and all(
        one.shape == two.shape and np.allclose(one, two, rtol=0.0, atol=reach, equal_nan=True)
        for one, two in zip(here, there, strict=True)
    )


def loads_drawn(solution, angle):
    """Signs of the loads of a machine in a pose, as strokes."""
    return list(Shape(whole_turn(solution)).signs(solution.loads, posed(solution, angle)))


def own_strokes(named, angle):
    """Counterweights and signs of loads in a pose, each stroke with the labels of those that have it, in order."""
    found: list[tuple[Any, list[str]]] = []
    for name, solution in named.items():
        weights = Shape(whole_turn(solution)).counterweights(posed(solution, angle))
        for stroke in (*weights, *loads_drawn(solution, angle)):
            same = (owners for other, owners in found if _same(stroke, other))
            owners = next(same, None)
            if owners is None:
                found.append((stroke, [name]))
            elif name not in owners:
                owners.append(name)
    return found


def _same(stroke, other):
    """Whether two strokes are the same to the eye."""
    if stroke.kind != other.kind or stroke.points.shape != other.points.shape:
        return False
    return np.allclose(stroke.points, other.points, rtol=1e-6, equal_nan=True)

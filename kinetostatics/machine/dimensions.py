"""Dimensions of a part: what its lengths and angles measure on a drawing.

A part or load declares them in `dimensions`, a table by the steps to a number: field names and indices, as in
`numbers.paths`.
Points are joint names, places on a link ("coupler", along, across), or fixed points (x, y).
"""

from typing import Any, NamedTuple

X_AXIS, Y_AXIS = (1.0, 0.0), (0.0, 1.0)
ORIGIN = (0.0, 0.0)


class Span(NamedTuple):
    """Distance between two points, along a unit vector if one is given."""

    start: Any
    end: Any
    along: Any = None


class Angle(NamedTuple):
    """Angle at a point, counter-clockwise from a direction (unit vector)."""

    at: Any
    start: Any = X_AXIS


class Radius(NamedTuple):
    """Radius of a circle about a point."""

    centre: Any


def of_fixed_point(field, point):
    """Dimensions of the coordinates (x, y) from O in a field."""
    return {(field, 0): Span(ORIGIN, point, X_AXIS), (field, 1): Span(ORIGIN, point, Y_AXIS)}


def of_point_on_link(field, place, end=None, first=0):
    """Dimensions of the coordinates in a field, from its item `first`, of a place (link, along, across), or joint."""
    link, along, _ = place
    foot = (link, along, 0.0)
    return {(field, first): Span((link, 0.0, 0.0), foot), (field, first + 1): Span(foot, end or place)}


def of_place(field, place):
    """Dimensions of the numbers of a point in a field; a joint has none."""
    if isinstance(place, str):
        return {}
    return of_point_on_link(field, place, first=1) if isinstance(place[0], str) else of_fixed_point(field, place)


def within(field, dimensions):
    """Dimensions of the part in a field."""
    return {(field, *steps): dimension for steps, dimension in dimensions.items()}

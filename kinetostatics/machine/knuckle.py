"""Knuckles: rockers on whose pin a slider hangs that moves along a line through their pivot, as the ram of a toggle press.

What a straightening knuckle passes on goes with how far its pin is from the guide, which of the rocker's direction p is
known no better than to a rounding of 1. With the guide along one axis and a coupler of direction q that reaches along
the other one, its component there is what lengths leave, with b, h, g and A as for the group,

    h p = (+-b - g) + A -+ b (1 - |q|),    b (1 - |q|) = b q_aside^2 / (1 + |q|)

of which no part is large where the crank is short. It is less good where the coupler leans, or is much longer than the
rocker; only such are taken that always reach to one side of the guide.
"""

import numpy as np

from ..numbers import checks
from ..numbers.leaves import Axis, with_fields
from ..numbers.planar import cross
from .elongation import shortfall

BESIDE = 2.0**-5
"""Share of the rocker's length up to which its pivot counts as on the guide."""
REACH, LONGEST = 0.25, 2.0
"""Least share of its length that the coupler reaches along the axis, and how many times the rocker's it is at most."""
AXES = {"+x": (0, 1.0), "-x": (0, -1.0), "+y": (1, 1.0), "-y": (1, -1.0)}
"""Axis along which a coupler reaches, and its way, by what a group calls them."""


def told(groups, throws):
    """Groups of a chain, those that may be knuckles as they are among the others."""
    return tuple([_told(group, groups, throws) if hasattr(group, "knuckle") else group for group in groups])


def _told(group, groups, throws):
    guides = [guide for other in groups if group.pin in other.hangs_on for guide in other.guides.values()]
    kinds = (_kind(group, guide, throws[group.on]) for guide in guides if group.on in throws)
    knuckle = next(filter(None, kinds), "")
    return group if knuckle == group.knuckle else with_fields(group, knuckle=knuckle)


def _kind(group, guide, throw):
    """What the knuckle of a group is called for a guide of a slider on its pin, in all designs together; "" for none."""
    direction = guide.direction if guide.exact is None else guide.exact
    given = *group.pivot, group.coupler_length, group.rocker_length, guide.guide_offset, *throw.at
    if not (guide.is_level or type(direction) is Axis) or not all(map(checks.known, given)):
        return ""
    axis = 0 if direction[0] == 0.0 else 1
    pivot, b, h, a = group.pivot, group.coupler_length, group.rocker_length, throw.polar[0]
    beside = abs(cross(direction, pivot) - guide.guide_offset) <= BESIDE * h
    reached = (abs(pivot[axis]) >= a + h + REACH * b) & (b <= LONGEST * h) & beside
    for name, (along, way) in AXES.items():
        if along == axis and np.all(reached & (way * pivot[axis] > 0.0)):
            return name
    return ""


def straightened(direction, coupler, joint, coupler_length, rocker_length, pivot, knuckle):
    """Direction of the rocker of a knuckle, one component by those of the coupler and its joint (kernel)."""
    axis, way = AXES[knuckle]
    short = shortfall(coupler_length, coupler[1 - axis], way * coupler[axis])
    whole = (way * coupler_length - pivot[axis]) + joint.position[axis]
    part = (whole - way * short) / rocker_length
    return (part, direction[1]) if axis == 0 else (direction[0], part)

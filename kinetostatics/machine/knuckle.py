"""Knuckles: a rocker, and on its pin a slider that moves along a line through its pivot, as the ram of a toggle press.

What a knuckle passes on as it straightens goes with the distance of its pin from that line, which of the directions of
links is known to a rounding of their lengths. With the line along one axis, and for the other one the coordinates g of
the pivot and A of the inner joint, and the component q of the coupler's direction, b being its length and e the other
component, it is what lengths leave of each other,

    b q - g + A = (+-b - g) + A - b e^2 / (+-1 + q)

by the sign of q. Where the coupler may lean much, or is much longer than the rocker, that is no nearer, and not used.
Designs together must all allow it, so what one has may change in its last bits with those beside it.
"""

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.parameter_tree import FLOATS
from ..numbers.planar import cross

BESIDE = 2.0**-5
"""Share of the rocker's length by which its pivot may be off the line."""
REACH, LONGEST = 0.25, 2.0
"""Least share of its length that the coupler reaches along the axis, and how many times the rocker's it is at most."""
AXES = ("x", "y")
TERMS = {
    "straight": ("j", "what the pin would be off the line on which the slider moves were the coupler across it"),
}
"""What hand calculations call lines of the kernels, and what they are."""


def axis_of(rocker, groups, throws):
    """Axis, "x" or "y", across the line of what hangs on the pin of a rocker, if that is a knuckle; "" else."""
    throw = throws.get(rocker.on)
    if throw is None:
        return ""
    guides = (guide for other in groups if rocker.pin in other.hangs_on for guide in other.guides.values())
    return next(filter(None, (_axis_reached(rocker, guide, throw) for guide in guides)), "")


def _axis_reached(group, guide, throw):
    """Axis along which the coupler reaches across a guide that is the other one's, through the pivot; "" for others."""
    b, h = group.coupler_length, group.rocker_length
    given = b, h, *group.pivot, guide.guide_offset, *throw.at
    are_known = FLOATS.issuperset(map(type, given)) or all(map(checks.known, given))
    if not (are_known and guide.is_along_an_axis):
        return ""
    axis = 1 if guide.direction[0] else 0
    off, away = cross(guide.direction, group.pivot) - guide.guide_offset, abs(group.pivot[axis])
    reached = (abs(off) <= BESIDE * h) & (away - throw.polar[0] - h >= REACH * b) & (b <= LONGEST * h)
    return AXES[axis] if np.all(reached) else ""


def straightened(direction, coupler, joint, coupler_length, rocker_length, pivot, knuckle):
    """Direction of the rocker, its component along the axis `knuckle` by way of the coupler (kernel)."""
    axis = AXES.index(knuckle)
    along, lean = coupler[axis], coupler[1 - axis]
    way = sign(along)
    straight = (way * coupler_length - pivot[axis]) + joint.position[axis]
    part = (straight - coupler_length * lean * lean / (way + along)) / rocker_length
    return (direction[0], part) if axis else (part, direction[1])

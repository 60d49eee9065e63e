"""States of a group's links compared with those of joints, guides and slots: what rigid links must have in common.

A link's state gives the position, velocity and acceleration of each of its points. Where the group declares that a
joint is a point of the link, both must agree.
"""

from typing import NamedTuple

import numpy as np

from ..machine.group import FRAME
from ..machine.links import PointMotion, Sliding, Turning, arm
from ..numbers.planar import cross, dot, number_or_zero, rotate, rotate_back, subtract_vectors, vector_or_zero

STATE_NAMES = ("position", "velocity", "acceleration")


class Comparison(NamedTuple):
    """Two values that must agree, and a size below which neither counts."""

    found: object
    expected: object
    unit: float


def link_comparisons(group, placement, size):
    """By what is compared, a `Pair`: numbers, or vectors by component."""
    return {
        **_points(group, placement, size),
        **_fixed_joints(group, placement, size),
        **_guides(group, placement, size),
        **_slots(group, placement, size),
        **_slidings(group, placement, size),
        **_courses(group, placement, size),
    }


def _points(group, placement, size):
    """Joints that are points of links, by position, velocity and acceleration."""
    found = {}
    for name, (link, along, across) in group.joints.items():
        joint = placement.joints[name]
        if link == FRAME:
            for what, part, fixed in zip(STATE_NAMES, joint, ((along, across), (0.0, 0.0), (0.0, 0.0)), strict=True):
                found[f"{what} of {name} as a point of the frame"] = Comparison(vector_or_zero(part), fixed, size)
            continue
        motion = placement.links[link]
        spot = PointMotion(motion.joint, arm(motion.direction, along, across), motion)
        for what, part, by_link in zip(STATE_NAMES, joint, _states(spot), strict=True):
            found[f"{what} of {name} as a point of {link}"] = Comparison(
                vector_or_zero(by_link), vector_or_zero(part), size
            )
    return found


def _fixed_joints(group, placement, size):
    """Joints that a link keeps at one place in its own axes: the end of a bar at its length, other pins anywhere."""
    places = {(pair.link, pair.joint): None for pair in _declared(group, "pairs").values() if type(pair) is Turning}
    for bar in group.bars:
        places |= {(bar.link, bar.start): (0.0, 0.0), (bar.link, bar.end): (bar.length, 0.0)}
    found = {}
    for (link, name), place in places.items():
        if link not in group.links:
            continue
        motion, joint = placement.links[link], placement.joints[name]
        to_joint = subtract_vectors(joint.position, motion.joint.position)
        seen = rotate_back(to_joint, motion.direction)
        expected = tuple(np.mean(part) for part in seen) if place is None else place
        found[f"place of {name} in the axes of {link}"] = Comparison(seen, expected, size)
        _, first, second = _states(PointMotion(motion.joint, to_joint, motion))
        found[f"velocity of {name} by {link}"] = Comparison(vector_or_zero(first), vector_or_zero(joint.first), size)
        found[f"acceleration of {name} by {link}"] = Comparison(
            vector_or_zero(second), vector_or_zero(joint.second), size
        )
    return found


def _guides(group, placement, size):
    """Sliders: the pin on the guide, the direction of the guide, and the travel as the pin's coordinate along it."""
    found = {}
    for link, guide in _declared(group, "guides").items():
        motion, direction = placement.links[link], guide.direction
        position = motion.joint.position
        found[f"distance of {link} from its guide"] = Comparison(cross(direction, position), guide.guide_offset, size)
        found[f"direction of {link} along its guide"] = Comparison(motion.direction, direction, 1.0)
        travel = placement.travels.get(link)
        for what, claimed, part in zip(STATE_NAMES, travel, motion.joint, strict=True) if travel else ():
            found[f"{what} of the travel of {link}"] = Comparison(
                number_or_zero(claimed), dot(direction, vector_or_zero(part)), size
            )
    return found


def _slots(group, placement, size):
    """Joints that slide in the slot of a link: on the line of the slot."""
    found = {}
    for slot in _declared(group, "slots"):
        motion = placement.links[slot.link]
        axis = rotate((np.cos(slot.angle), np.sin(slot.angle)), motion.direction)
        away = subtract_vectors(placement.joints[slot.joint].position, motion.joint.position)
        found[f"distance of {slot.joint} from the slot of {slot.link}"] = Comparison(
            cross(axis, away), slot.offset, size
        )
        if slot.rod:
            aside = cross(axis, placement.links[slot.rod].direction)
            found[f"direction of {slot.rod} along {slot.link}"] = Comparison(aside, 0.0, 1.0)
    return found


def _slidings(group, placement, size):
    """Rates of sliding pairs, on which the sense of friction depends, as velocities of one link against the other."""
    found = {}
    for name, pair in _declared(group, "pairs").items():
        if type(pair) is not Sliding:
            continue
        slide, joint = group.sliding(name, placement), placement.joints[pair.joint]
        direction = (1.0, 0.0) if slide.direction is None else slide.direction
        first = subtract_vectors(_velocity(placement, pair.link, joint), _velocity(placement, pair.against, joint))
        found[f"rate of sliding of {name}"] = Comparison(
            number_or_zero(slide.rate), dot(direction, vector_or_zero(first)), size
        )
        if pair.against != FRAME:
            away = subtract_vectors(joint.position, placement.links[pair.against].joint.position)
            found[f"moment of sliding of {name}"] = Comparison(
                number_or_zero(slide.moment), cross(away, direction), size
            )
    return found


def _courses(group, placement, size):
    """Centre and radius of a joint that swings about a fixed place."""
    found = {}
    for name in group.joints:
        swing = placement.course(name).swing
        if swing is not None:
            parts = (*swing.centre, swing.radius)
            found[f"centre and radius of the swing of {name}"] = Comparison(parts, tuple(map(np.mean, parts)), size)
    return found


def _declared(group, name):
    """What a group declares; a group that is not derived from `Group` may lack it."""
    return getattr(group, name, {})


def _states(spot):
    return spot.position, spot.first, spot.second


def _velocity(placement, link, joint):
    """Velocity of the point of a link that is at a joint."""
    if link == FRAME:
        return None
    motion = placement.links[link]
    return PointMotion(motion.joint, subtract_vectors(joint.position, motion.joint.position), motion).first

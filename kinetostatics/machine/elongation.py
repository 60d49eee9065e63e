"""Where a slider is along its guide less a position, and how it departs from the motion of a pin of the crank.

Kernels without the rounding of its coordinate, and what a group has of them: a length reaches along a line that it
leans from less l (1 - cos) = l sin^2 / (1 + cos), which is small beside it near a dead centre, as is what is left of
the lengths themselves.
"""

from typing import Any

from ..numbers.arithmetic import sign
from ..numbers.planar import minus, unturned

TERMS = {
    "elongation.cosine": ("c", "cosine of the angle from the guide to what swings the inner joint"),
    "elongation.sine": ("s", "sine of that angle"),
    "elongation.turning": ("j", "place of the inner joint along the guide where that angle is 0 or half a turn"),
    "_from.short": ("f", "by how much the coupler's reach along the guide falls short of its length"),
    "departure.departing": ("b", "second derivative of the inner joint along the guide plus its place there"),
}
"""What hand calculations call lines of the kernels, and what they are."""


def shortfall(length, sine, cosine):
    """By how much a length falls short of itself along a line, by its angle to that."""
    return length * sine * sine / (1.0 + cosine)


def elongation(placement, joint, direction, reach, short):
    """Coordinate of a joint along a direction plus a reach, which falls short, from there.

    The joint itself is so far from a fixed place if a link swings it about that, this way or the other.
    """
    swing = placement.course(joint).swing
    if swing is None:
        return unturned(placement.joints[joint].position, direction)[0] + (reach - short)
    cosine, sine = unturned(swing.direction, direction)
    way = sign(cosine)
    turning = unturned(swing.centre, direction)[0] + way * swing.radius
    return turning + reach - (way * shortfall(swing.radius, sine, abs(cosine)) + short)


def across(swing, guide):
    """From a joint that swings about a fixed place across to a guide: all by the swing if that place is on it."""
    apart = minus(guide.offset, unturned(swing.centre, guide.direction)[1])
    return minus(apart, swing.radius * unturned(swing.direction, guide.direction)[1])


def departure(placement, drawn_in, joint, direction, reach, short):
    """Second derivative of that coordinate plus itself; None where both are large.

    What of both is the joint's cancels if that is a pin of the crank, and is known of a roller on a cam; `drawn_in` is
    what the second derivative of the reach takes.
    """
    course = placement.course(joint)
    if course.throw is not None:
        return reach - short - drawn_in
    if course.departure is None:
        return None
    departing = unturned(course.departure, direction)[0]
    return departing - drawn_in + (reach - short)


def outward(placement, joint, direction, reach, short):
    """That coordinate, m, or its opposite where the joint is on the other side of O, as a length and what is more.

    The length is that by which the joint goes round O, which no crank angle changes; None where no group tells it. Near
    a dead centre what is more is small beside it, and has no rounding of the whole.
    """
    orbit = placement.course(joint).orbit
    if orbit is None:
        return None
    length, farther = orbit
    cosine, sine = unturned(placement.ray, direction)
    size = abs(cosine)
    return length, farther * size - shortfall(length, sine, size) + sign(cosine) * (reach - short)


class Reaching:
    """What a group has whose slider a coupler reaches: with `on`, `coupler_length`, `guide`, `side` and `passage`.

    The slider's name is in `_slider`, and of its details in a placement `sine`, `cosine` and `drawn_in` are asked for.
    """

    def elongation(self: Any, placement, free_position):
        """Coordinate of the pin along the guide less a free position, m, without the rounding of the coordinate."""
        if self.passage:
            return placement.travels[self._slider].position - free_position
        return elongation(placement, *self._from(free_position, placement))

    def departure(self: Any, placement, position):
        """Second derivative of that coordinate plus its elongation from a position, m; None where both are large."""
        drawn_in = placement.details[self._slider].drawn_in
        if self.passage or drawn_in is None:
            return None
        return departure(placement, drawn_in, *self._from(position, placement))

    def outward(self, placement, position):
        """That elongation, or its opposite, as a length of the design and some more, m; None if it is not known so."""
        return outward(placement, *self._from(position, placement))

    def _from(self: Any, position, placement):
        """What reaches from a position on, as `elongation` takes it."""
        motion, length, side = placement.details[self._slider], self.coupler_length, self.side
        short = side * shortfall(length, motion.sine, side * motion.cosine)
        return self.on, self.guide.line.direction, side * length - position, short

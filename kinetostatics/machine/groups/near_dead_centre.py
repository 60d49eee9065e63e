"""Four-bar on a pin of the crank: kernel in the crank angle psi from the direction O -> O2.

With S = sin^2(psi/2) and C = cos^2(psi/2), quarters of the squared distances of the crank ray from that direction and
from its opposite, so that neither loses a digit where it is small, the sine of the transmission angle is for a crank a,
coupler b, rocker h and ground d the root of two factors, with e from A to O2 (Heron),

    2 b h far  = (b+h)^2 - e^2 = ((b+h)^2 - (d-a)^2) C + ((b+h)^2 - (d+a)^2) S
    2 b h near = e^2 - (b-h)^2 = ((d-a)^2 - (b-h)^2) C + ((d+a)^2 - (b-h)^2) S

All that stands in brackets are products of sums of given lengths, each rounded as if once: where a factor vanishes, at
a limit position or change point, its error is no more than what one rounding of the crank angle makes. A length that is
a root itself, of an inclined pivot or a pin beside the crank ray, goes with what rounding took off it. So are rates,

    theta' = 1/2 - (d^2 - a^2) / (2 e^2) -+ (1 -+ (b^2 - h^2) / e^2) R,    R = a d sin(psi) / (2 b h sine)

with the upper signs for the coupler, the lower ones for the rocker, and their slopes, in which R' is

    a d / (2 b h sine^3) (((d-a)^2 - (b-h)^2) C far - ((b+h)^2 - (d+a)^2) S near) / (2 b h)

Where a slider is along its guide less a position, and how it departs from the motion of a pin of the crank.

Kernels without the rounding of its coordinate, and what a group has of them: a length reaches along a line that it
leans from less l (1 - cos) = l sin^2 / (1 + cos), which is small beside it near a dead centre, as is what is left of
the lengths themselves.

Knuckles: a rocker, and on its pin a slider that moves along a line through its pivot, as the ram of a toggle press.

What a knuckle passes on as it straightens goes with the distance of its pin from that line, which of the directions of
links is known to a rounding of their lengths. With the line along one axis, and for the other one the coordinates g of
the pivot and A of the inner joint, and the component q of the coupler's direction, b being its length and e the other
component, it is what lengths leave of each other,

    b q - g + A = (+-b - g) + A - b e^2 / (+-1 + q)

by the sign of q. Where the coupler may lean much, or is much longer than the rocker, that is no nearer, and not used.
Designs together must all allow it, so what one has may change in its last bits with those beside it.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import (
    NEGLIGIBLE_LENGTH,
    RELATIVE_OFFSET,
    clamped_sqrt,
    compensated_sum,
    guarded_divisor,
    offset_from_zero,
    sign,
)
from ...numbers.parameter_tree import FLOATS
from ...numbers.planar import (
    cross,
    length,
    length_with_error,
    minus,
    number_or_zero,
    plus,
    product,
    quotient,
    rotate,
    rotate_back,
    subtract_vectors,
)
from ..links import present

MIN_ROOT = 2.0**-100
"""Roots of closure, sines and cosines, that are not divided by less."""
CLOSE_SHARE = 2.0**-5
"""Share of the longest length up to which a length differs little from what others leave it."""
TERMS = {
    "ground": ("g", "from O to the pivot"),
    "turn": ("s", "sine of the crank angle from the direction of the pivot, times g if that is inclined"),
    "near_by": ("m", "square of the distance of the crank ray from that direction, both as long"),
    "far_off": ("n", "square of the distance of the crank ray from the opposite of that, both as long"),
    "d": ("d", "from the inner joint to the pivot"),
    "square": ("D", "square of that distance"),
    "near": ("N", "factor that is smallest where the crank points to the pivot"),
    "far": ("F", "factor that is smallest where the crank points away from the pivot"),
    "sine": ("sigma", "sine of the transmission angle"),
    "place.share": ("xi", "share of d by which the pin lies along it beyond the middle"),
    "slid.near_by": ("m", "square of the distance of the crank ray from the left normal of the guide"),
    "slid.near": ("N", "factor that is smallest where the crank points along the right normal of the guide"),
    "slid.far": ("F", "factor that is smallest where the crank points along the left normal of the guide"),
    "slid.far_off": ("n", "square of the distance of the crank ray from the right normal of the guide"),
    "inverse": ("i", "one over what rates and forces are divided by"),
    "rate": ("z", "rate at which the links turn besides d"),
    "bend": ("z'", "derivative by phi of that"),
    "turning": ("q", "half less the rate of d"),
    "elongation.cosine": ("c", "cosine of the angle from the guide to what swings the inner joint"),
    "elongation.sine": ("s", "sine of that angle"),
    "elongation.turning": ("j", "place of the inner joint along the guide where that angle is 0 or half a turn"),
    "_from.short": ("f", "by how much the coupler's reach along the guide falls short of its length"),
    "departure.departing": ("b", "second derivative of the inner joint along the guide plus its place there"),
    "straight": ("j", "what the pin would be off the line on which the slider moves were the coupler across it"),
}
"""What hand calculations call lines of the kernels, and what they are."""


class PivotFromPin(NamedTuple):
    """The line from a pin of the crank to a pivot.

    Attributes
    ----------
    radius, ground : float or array
        From O to the pin and to the pivot.
    slack, rest : float or array or None
        What rounding took off these.
    gap : float or array
        By how much the pivot is farther from O than the pin.
    turn : array
        Sine of the crank angle from the direction of the pivot, in units of `reach`.
    near_by, far_off : array
        Squared distances of the crank ray from that direction and from its opposite, in units of the square of `reach`.
    reach : float or array
    d : vector
        From the pin to the pivot.
    square : array
        Square of that distance.
    """

    radius: Any
    slack: Any
    ground: Any
    rest: Any
    gap: Any
    turn: Any
    near_by: Any
    far_off: Any
    reach: Any
    d: Any
    square: Any


def direction_and_length(start):
    """Direction of a vector that may vanish: by its components, none of whose digits is lost, and their length.

    Along an axis it is a sign, of length 1.
    """
    x, y = map(present, start)
    if y is None:
        return (_sign(number_or_zero(x)), None), 1.0
    if x is None:
        return (None, _sign(y)), 1.0
    start = offset_from_zero(x, NEGLIGIBLE_LENGTH), y
    return start, length(start)


def _sign(part):
    return sign(offset_from_zero(part, NEGLIGIBLE_LENGTH))


def squared_distances(ray, direction, reach):
    """Cross product of a direction, of some length, with a ray, and squared distances of its tip from the ray's.

    The ray is taken as long as the direction, and pointing ahead and backward. A distance that is small has only what
    the cross product is off, whatever the rest loses.
    """
    (x, y), (cosine, sine) = direction, ray
    along, across = plus(product(x, cosine), product(y, sine)), minus(product(x, sine), product(y, cosine))
    aside, less, more = across * across, along - reach, along + reach
    return across, less * less + aside, more * more + aside


def pivot_from_pin(placement, on, pivot, is_close):
    """The pivot as a pin of the crank sees it, which may come close to it (kernel)."""
    throw, (ground, rest), (direction, size) = (
        placement.course(on).throw,
        length_with_error(pivot),
        direction_and_length(pivot),
    )
    a, slack = throw.radius_and_rest
    start, reach = (direction, size) if throw.ahead else direction_and_length(rotate_back(pivot, throw.at))
    turn, near_by, far_off = squared_distances(placement.ray, start, reach)
    gap, unit = (
        offset_from_zero(compensated_sum(ground, rest, -a, minus(None, slack)), NEGLIGIBLE_LENGTH),
        reach * reach,
    )
    if is_close:
        along, across = gap + 0.5 * a / unit * near_by, a / reach * turn
        x, y = (quotient(part, size) for part in direction)
        d = plus(product(x, along), product(y, across)), minus(product(y, along), product(x, across))
        near_by = a / ground * (turn * turn) + near_by * (gap / ground + 0.25 * a / (ground * unit) * near_by)
        square = along * along + across * across
    else:
        d = subtract_vectors(pivot, placement.joints[on].position)
        square = gap * gap + a * ground / unit * near_by
    return PivotFromPin(a, slack, ground, rest, gap, turn, near_by, far_off, reach, d, square)


def place(placement, on, coupler_length, rocker_length, pivot, assembly, is_close):
    """Direction, ratio and slope of coupler and of rocker, and what follows in `RockerMotion`, for a pin (kernel)."""
    b, h = coupler_length, rocker_length
    gap, both, product = b - h, b + h, 2.0 * b * h
    line = pivot_from_pin(placement, on, pivot, is_close)
    (a, slack, ground, rest), near_by, far_off = line[:4], line.near_by, line.far_off
    (less, short), unit = (minus(None, rest), minus(None, slack)), 4.0 * product * line.reach * line.reach
    near_c = compensated_sum(ground, h, -a, -b, rest, short) * compensated_sum(ground, b, -a, -h, rest, short)
    near_c = (
        offset_from_zero(near_c, RELATIVE_OFFSET * NEGLIGIBLE_LENGTH * NEGLIGIBLE_LENGTH) / unit
    )  # where A meets the pivot
    near_s = compensated_sum(ground, a, h, -b, rest, slack) * compensated_sum(ground, a, b, -h, rest, slack) / unit
    far_c = compensated_sum(a, b, h, -ground, less, slack) * compensated_sum(ground, b, h, -a, rest, short) / unit
    far_s = compensated_sum(b, h, -ground, -a, less, short) * (both + ground + a) / unit
    near = near_c * far_off + near_s * near_by
    far = far_c * far_off + far_s * near_by
    closure = far * near
    size = clamped_sqrt(closure, 1.0)
    sine, divided = assembly * size, assembly * guarded_divisor(size, MIN_ROOT)

    d, square, over = line.d, line.square, 1.0 / line.square
    share, aside = 0.5 * gap * both * over, assembly * b * h * size * over
    along, back, across = 0.5 + share, share - 0.5, (aside * d[0], aside * d[1])
    q = ((along * d[0] - across[1]) / b, (along * d[1] + across[0]) / b)
    p = ((back * d[0] - across[1]) / h, (back * d[1] + across[0]) / h)

    inverse, sweep = 1.0 / divided, 2.0 * a * ground
    rate = sweep / (product * line.reach) * line.turn * inverse
    bend = sweep / product * (near_c * far_off * far - far_s * near_by * near) * (inverse * inverse * inverse)
    turning = 0.5 * line.gap * (ground + a) * over
    change = sweep / line.reach * line.turn * over * (turning - share * rate)
    ratio, slope = 0.5 - turning + back * rate, change + back * bend
    coupler, rocker = (q, ratio, slope), (p, ratio + rate, slope + bend)
    return coupler, rocker, sine, (b * b + h * h - square) / product, divided, closure


def slid(placement, on, coupler_length, guide, assembly):
    """Reach of a coupler along the guide, its rate and the slope of that, what to divide by, and closure (kernel).

    With y the sine of the crank angle from the guide, an offset e and a coupler l on a crank r the factors of closure
    are l - e + r y and l + e - r y over l, parted by (1 + y) / 2 and (1 - y) / 2.
    """
    throw = placement.course(on).throw
    (r, ahead), slack = throw.polar, throw.radius_and_rest[1]
    length, offset, short = coupler_length, number_or_zero(guide.offset), minus(None, slack)
    x, y = rotate_back(placement.ray if ahead is None else rotate(placement.ray, ahead), guide.direction)
    aside, less, more = x * x, 1.0 - y, 1.0 + y
    near_by, far_off = less * less + aside, more * more + aside
    unit = 4.0 * length
    low, high = (compensated_sum(length, side, -r, short) / unit for side in (-offset, offset))
    low, high = low * near_by, high * far_off
    near = low + compensated_sum(length, -offset, r, slack) / unit * far_off
    far = high + compensated_sum(length, offset, r, slack) / unit * near_by
    closure = near * far
    size = clamped_sqrt(closure, 1.0)
    divided = assembly * guarded_divisor(size, MIN_ROOT)
    inverse, share = 1.0 / divided, r / length
    bend = share * (high * near - low * far) * (inverse * inverse * inverse)
    return assembly * length * size, -share * x * inverse, bend, divided, closure


def slotted(placement, on, pivot, offset, assembly):
    """Direction of a slotted lever, its ratio and the slope of that, reach, what to divide by, and closure (kernel)."""
    line, o = pivot_from_pin(placement, on, pivot, True), number_or_zero(offset)
    (a, slack, ground, rest), near_by, far_off = line[:4], line.near_by, line.far_off
    d, square, over = line.d, line.square, 1.0 / line.square
    short, unit, swept = minus(None, slack), 4.0 * line.reach * line.reach, a * ground / line.reach * line.turn
    near_c = compensated_sum(ground, -a, -o, rest, short) * compensated_sum(ground, -a, o, rest, short) / unit
    near_s = compensated_sum(ground, a, -o, rest, slack) * compensated_sum(ground, a, o, rest, slack) / unit
    near = near_c * far_off + near_s * near_by
    size = clamped_sqrt(near, square)
    reach, divided = assembly * size, assembly * guarded_divisor(size, MIN_ROOT * ground)
    along, across = reach * over, o * over
    direction = (-along * d[0] - across * d[1], across * d[0] - along * d[1])
    inverse = 1.0 / divided
    rate = swept * inverse
    bend = a * ground * (near_c * far_off - near_by / unit * near) * (inverse * inverse * inverse)
    turning, change = 0.5 * line.gap * (ground + a) * over, 2.0 * swept * over
    ratio = 0.5 - turning + across * rate
    slope = change * (turning - across * rate) + across * bend
    return direction, ratio, slope, reach, divided, near / (square + a * a)


def passes_near_pivot(throw, offset, pivot):
    """Whether a pin comes close to a pivot, or to where a slot passes it at an offset, in any design.

    It chooses formulas that keep all digits there, for all designs together: one has the last bits of its batch.
    """
    x, y = pivot
    if type(x) is type(y) is float:
        return has_small_clearance(throw, offset, math.hypot(x, y))
    return all(map(checks.has_known_values, pivot)) and has_small_clearance(throw, offset, np.hypot(x, y))


def has_small_clearance(throw, offset, length):
    """Whether the difference of a length, more or less an offset, and the radius of a pin is small, in any design."""
    radius = throw.at[0] if throw.ahead else None
    if type(radius) is type(offset) is type(length) is float:
        unit = CLOSE_SHARE * (length + radius)
        return abs(abs(length + offset) - radius) < unit or abs(abs(length - offset) - radius) < unit
    if not all(map(checks.has_known_values, (*throw.at, offset, length))):
        return False
    radius, offset, length = map(np.asarray, (throw.polar[0], offset, length))
    far, near = abs(length + offset) - radius, abs(length - offset) - radius
    unit = CLOSE_SHARE * (length + radius)
    return bool(np.any((abs(far) < unit) | (abs(near) < unit)))


def shortfall(length, sine, cosine):
    """By how much a length falls short of itself along a line, by its angle to that."""
    return length * sine * sine / (1.0 + cosine)


def elongation(placement, joint, direction, reach, short):
    """Coordinate of a joint along a direction plus a reach, which falls short, from there.

    The joint itself is so far from a fixed place if a link swings it about that, this way or the other.
    """
    swing = placement.course(joint).swing
    if swing is None:
        return rotate_back(placement.joints[joint].position, direction)[0] + (reach - short)
    cosine, sine = rotate_back(swing.direction, direction)
    way = sign(cosine)
    turning = rotate_back(swing.centre, direction)[0] + way * swing.radius
    return turning + reach - (way * shortfall(swing.radius, sine, abs(cosine)) + short)


def across(swing, guide):
    """From a joint that swings about a fixed place across to a guide: all by the swing if that place is on it."""
    apart = minus(guide.offset, rotate_back(swing.centre, guide.direction)[1])
    return minus(apart, swing.radius * rotate_back(swing.direction, guide.direction)[1])


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
    departing = rotate_back(course.departure, direction)[0]
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
    cosine, sine = rotate_back(placement.ray, direction)
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


MAX_PIVOT_OFFSET = 2.0**-5
"""Share of the rocker's length by which its pivot may be off the line."""
MIN_COUPLER_REACH, MAX_COUPLER_RATIO = 0.25, 2.0
"""Least share of its length that the coupler reaches along the axis, and how many times the rocker's it is at most."""
AXES = ("x", "y")


def toggle_axis(rocker, groups, throws):
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
    are_known = FLOATS.issuperset(map(type, given)) or all(map(checks.has_known_values, given))
    if not (are_known and guide.is_along_an_axis):
        return ""
    axis = 1 if guide.direction[0] else 0
    off, away = cross(guide.direction, group.pivot) - guide.guide_offset, abs(group.pivot[axis])
    reached = (
        (abs(off) <= MAX_PIVOT_OFFSET * h)
        & (away - throw.polar[0] - h >= MIN_COUPLER_REACH * b)
        & (b <= MAX_COUPLER_RATIO * h)
    )
    return AXES[axis] if np.all(reached) else ""


def straighten_rocker(direction, coupler, joint, coupler_length, rocker_length, pivot, knuckle):
    """Direction of the rocker, its component along the axis `knuckle` by way of the coupler (kernel)."""
    axis = AXES.index(knuckle)
    along, lean = coupler[axis], coupler[1 - axis]
    way = sign(along)
    straight = (way * coupler_length - pivot[axis]) + joint.position[axis]
    part = (straight - coupler_length * lean * lean / (way + along)) / rocker_length
    return (direction[0], part) if axis else (part, direction[1])

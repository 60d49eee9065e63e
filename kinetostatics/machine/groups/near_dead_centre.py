"""Kernels for groups on a pin of the crank that save digits near a limit position or dead centre.

*Four-bar.* Let S = sin^2(psi/2), C = cos^2(psi/2), with psi the crank angle from O -> O2, crank a, coupler b, rocker h
and ground d. The sine of the transmission angle is the root of two factors, with e from A to O2 (Heron),

    2 b h far    = (b+h)^2 - e^2 = ((b+h)^2 - (d-a)^2) C + ((b+h)^2 - (d+a)^2) S
    2 b h near   = e^2 - (b-h)^2 = ((d-a)^2 - (b-h)^2) C + ((d+a)^2 - (b-h)^2) S

C and S are quarters of squared distances of the crank ray, so a small one keeps its digits. Brackets are products of
sums of given lengths, each rounded once: near a zero the error is that of one rounding of the crank angle. A length
that is a root itself comes with the remainder of its rounding. Rates and their slopes have the same factors,

    theta' = 1/2 - (d^2 - a^2) / (2 e^2) -+ (1 -+ (b^2 - h^2) / e^2) R,    R = a d sin(psi) / (2 b h sine)
    R' = a d / (2 b h sine^3) (((d-a)^2 - (b-h)^2) C far - ((b+h)^2 - (d+a)^2) S near) / (2 b h)

with the upper signs for the coupler, the lower ones for the rocker.

*Elongation.* A length l inclined to a line reaches l less l (1 - cos) = l sin^2 / (1 + cos), small near a dead
centre. So the coordinate of a slider less a position loses no digits there.

*Toggle.* A rocker with a slider on its pin that moves along a line through its pivot, as the ram of a toggle press. The
distance of the pin from that line decides the force. Let the line be along one axis, g and A the coordinates of the
pivot and the inner joint on the other axis. The coupler has the length b and the direction (q, e). Then

    b q - g + A = (+-b - g) + A - b e^2 / (+-1 + q)

by the sign of q. It is used where the coupler is inclined little and is not much longer than the rocker. The designs of
a batch use the same formulas, so a design may change in its last bits with its batch.
"""

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
from ...numbers.parameter_tree import FLOATS, Axis
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
"""Least root of closure, sine and cosine, by which rates and forces are divided."""
NEGLIGIBLE_AREA = RELATIVE_OFFSET * NEGLIGIBLE_LENGTH * NEGLIGIBLE_LENGTH
"""Product of two differences of lengths, m2, that changes no digit of the others."""
CLOSE_SHARE = 2.0**-5
"""Clearance below which a pin is close to a limit position, over the sum of length and crank radius."""
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
    "inverse": ("i", "reciprocal of the divisor of rates and forces"),
    "rate": ("z", "rate of the links relative to d"),
    "bend": ("z'", "derivative by phi of that"),
    "turning": ("q", "half less the rate of d"),
    "elongation.cosine": ("c", "cosine of the angle from the guide to what swings the inner joint"),
    "elongation.sine": ("s", "sine of that angle"),
    "elongation.turning": ("j", "place of the inner joint along the guide where that angle is 0 or half a turn"),
    "departure.departing": ("b", "second derivative of the inner joint along the guide plus its place there"),
    "straight": ("j", "distance of the pin from the slider's line if the coupler were across it"),
}


class PivotFromPin(NamedTuple):
    """Line `d` from a pin of the crank to a pivot, and its squared length.

    `radius` and `ground` go from O to pin and pivot; `slack` and `rest` are their rounding errors, `gap` is their
    difference. The direction of the pivot is a vector of length `reach`. `turn` is its cross product with the crank
    ray, `near_by` and `far_off` are squared distances of its tip and its opposite from the ray's tip.
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
    """Direction of a vector that may vanish, as its components, and its length; along an axis a sign, of length 1."""
    x, y = map(present, start)
    if x is None and y is not None:
        return (None, sign(offset_from_zero(y, NEGLIGIBLE_LENGTH))), 1.0
    x = offset_from_zero(number_or_zero(x), NEGLIGIBLE_LENGTH)
    return ((sign(x), None), 1.0) if y is None else ((x, y), length((x, y)))


def squared_distances(ray, direction, reach):
    """Cross product of a direction of length `reach` with a ray, and squared distances of its tip from the ray's tips.

    The ray is as long as the direction, ahead and backward. A small distance has the error of the cross product alone.
    """
    (x, y), (cosine, sine) = direction, ray
    along, across = plus(product(x, cosine), product(y, sine)), minus(product(x, sine), product(y, cosine))
    aside, less, more = across * across, along - reach, along + reach
    return across, less * less + aside, more * more + aside


def pivot_from_pin(placement, on, pivot, is_close):
    """Line from a pin of the crank to a pivot, which may be close (kernel)."""
    throw, (ground, rest) = placement.course(on).throw, length_with_error(pivot)
    direction, size = direction_and_length(pivot)
    a, slack = throw.radius_and_rest
    start, reach = (direction, size) if throw.ahead else direction_and_length(rotate_back(pivot, throw.at))
    turn, near_by, far_off = squared_distances(placement.ray, start, reach)
    gap = offset_from_zero(compensated_sum(ground, rest, -a, minus(None, slack)), NEGLIGIBLE_LENGTH)
    unit = reach * reach
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
    """Direction, ratio and slope of coupler and rocker, then the last fields of `RockerMotion`, for a pin (kernel)."""
    b, h = coupler_length, rocker_length
    gap, both, product = b - h, b + h, 2.0 * b * h
    line = pivot_from_pin(placement, on, pivot, is_close)
    (a, slack, ground, rest), near_by, far_off = line[:4], line.near_by, line.far_off
    (less, short), unit = (minus(None, rest), minus(None, slack)), 4.0 * product * line.reach * line.reach
    near_c = compensated_sum(ground, h, -a, -b, rest, short) * compensated_sum(ground, b, -a, -h, rest, short)
    near_c = offset_from_zero(near_c, NEGLIGIBLE_AREA) / unit  # it vanishes where A meets the pivot
    near_s = compensated_sum(ground, a, h, -b, rest, slack) * compensated_sum(ground, a, b, -h, rest, slack) / unit
    far_c = compensated_sum(a, b, h, -ground, less, slack) * compensated_sum(ground, b, h, -a, rest, short) / unit
    far_s = compensated_sum(b, h, -ground, -a, less, short) * (both + ground + a) / unit
    near = near_c * far_off + near_s * near_by
    far = far_c * far_off + far_s * near_by
    closure = far * near
    size = clamped_sqrt(closure, 1.0)
    sine, divided = assembly * size, assembly * guarded_divisor(size, MIN_ROOT)

    d, over = line.d, 1.0 / line.square
    share, aside = 0.5 * gap * both * over, b * h * sine * over
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
    return coupler, rocker, (divided, None), closure


def slid(placement, on, coupler_length, guide, assembly):
    """Reach of a coupler along the guide, its rate and the slope of that, divisor, and closure (kernel).

    Let y be the sine of the crank angle from the guide, e the offset, l the coupler and r the crank. The factors of
    closure are l - e + r y and l + e - r y over l, with the weights (1 + y) / 2 and (1 - y) / 2.
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
    return assembly * length * size, -share * x * inverse, bend, (divided, None), closure


def slotted(placement, on, pivot, offset, assembly):
    """Direction of a slotted lever, its ratio and the slope of that, reach, divisor, and closure (kernel)."""
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
    return direction, ratio, slope, reach, (divided, None), near / (square + a * a)


def has_small_clearance(throw, offset, size):
    """Whether a length or pivot distance, plus or minus an offset, is nearly the radius of a pin of the crank.

    In any design of a batch.
    """
    numbers = (*throw.at, offset, *(size if isinstance(size, tuple) else (size,)))
    plain = FLOATS.issuperset(map(type, numbers))  # most mechanisms: made in half the time
    if not plain and not all(map(checks.has_known_values, numbers)):
        return False
    radius, away = throw.polar[0], length(size) if isinstance(size, tuple) else size
    unit = CLOSE_SHARE * (away + radius)
    found = (abs(abs(away + offset) - radius) < unit) | (abs(abs(away - offset) - radius) < unit)
    return bool(found if plain else np.any(found))


def shortfall(length, sine, cosine):
    """Length less its projection on a line, from sine and cosine of the angle between them."""
    return length * sine * sine / (1.0 + cosine)


def elongation(placement, joint, direction, reach, short):
    """Coordinate along a direction of a joint plus `reach - short`; a joint that a link swings, by its elongation."""
    swing = placement.course(joint).swing
    if swing is None:
        return rotate_back(placement.joints[joint].position, direction)[0] + (reach - short)
    cosine, sine = rotate_back(swing.direction, direction)
    way = sign(cosine)
    turning = rotate_back(swing.centre, direction)[0] + way * swing.radius
    return turning + reach - (way * shortfall(swing.radius, sine, abs(cosine)) + short)


def across(swing, guide):
    """Distance from a swinging joint across to a guide, without cancellation if the centre is on the guide."""
    apart = minus(guide.offset, rotate_back(swing.centre, guide.direction)[1])
    return minus(apart, swing.radius * rotate_back(swing.direction, guide.direction)[1])


def departure(placement, drawn_in, joint, direction, reach, short):
    """Second derivative of `elongation`'s coordinate plus the coordinate; None where both are large.

    The share of the joint is 0 for a pin of the crank, and known for a roller on a cam; the reach loses `drawn_in` in
    its second derivative.
    """
    course = placement.course(joint)
    if course.throw is not None:
        return reach - short - drawn_in
    if course.departure is None:
        return None
    departing = rotate_back(course.departure, direction)[0]
    return departing - drawn_in + (reach - short)


def outward(placement, joint, direction, reach, short):
    """That coordinate, or its opposite if the joint is on the other side of O, as a constant length and a rest; m.

    The length is the mean radius of the joint's orbit about O; None without one. Near a dead centre the rest is small
    and free of the rounding of the whole.
    """
    orbit = placement.course(joint).orbit
    if orbit is None:
        return None
    length, farther = orbit
    cosine, sine = rotate_back(placement.ray, direction)
    size = abs(cosine)
    return length, farther * size - shortfall(length, sine, size) + sign(cosine) * (reach - short)


MAX_PIVOT_OFFSET = 2.0**-5
"""Largest distance of the pivot from the line of the slider, over the rocker's length, in a toggle."""
MIN_COUPLER_REACH, MAX_COUPLER_RATIO = 0.25, 2.0
"""Least reach of the coupler along the axis over its length, and its largest length over the rocker's, in a toggle."""
AXES = ("x", "y")


def toggle_axis(group, guide, throw):
    """Axis, "x" or "y", across a guide that runs through the rocker's pivot along the other axis; "" for others.

    There the rocker makes a toggle with a slider on its pin.
    """
    b, h = group.coupler_length, group.rocker_length
    given = b, h, *group.pivot, guide.guide_offset, *throw.at
    if not all(map(checks.has_known_values, given)) or not (guide.is_level or type(guide.exact) is Axis):
        return ""
    axis = 1 if guide.direction[0] else 0
    off, away = cross(guide.direction, group.pivot) - guide.guide_offset, abs(group.pivot[axis])
    reached = (
        (abs(off) <= MAX_PIVOT_OFFSET * h)
        & (away - throw.polar[0] - h >= MIN_COUPLER_REACH * b)
        & (b <= MAX_COUPLER_RATIO * h)
    )
    return AXES[axis] if np.all(reached) else ""


def straighten_rocker(direction, coupler, joint, coupler_length, rocker_length, pivot, toggle):
    """Direction of the rocker, whose component along the axis `toggle` follows from the coupler (kernel)."""
    axis = AXES.index(toggle)
    along, lean = coupler[axis], coupler[1 - axis]
    way = sign(along)
    straight = (way * coupler_length - pivot[axis]) + joint.position[axis]
    part = (straight - coupler_length * lean * lean / (way + along)) / rocker_length
    return (direction[0], part) if axis else (part, direction[1])

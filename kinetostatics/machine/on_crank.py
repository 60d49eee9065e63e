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
"""

import math
from typing import Any, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import APART, UNSEEN, apart, divisor, root, sign, total
from ..numbers.planar import (
    length,
    length_and_rest,
    minus,
    number,
    plus,
    product,
    quotient,
    subtracted,
    turned,
    unturned,
)
from .links import present

SMALLEST = 2.0**-100
"""Roots of closure, sines and cosines, that are not divided by less."""
CLOSE = 2.0**-5
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
}
"""What hand calculations call lines of the kernels, and what they are."""


class Seen(NamedTuple):
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


def directed(start):
    """Direction of a vector that may vanish: by its components, none of whose digits is lost, and their length.

    Along an axis it is a sign, of length 1.
    """
    x, y = map(present, start)
    if y is None:
        return (_sign(number(x)), None), 1.0
    if x is None:
        return (None, _sign(y)), 1.0
    start = apart(x, UNSEEN), y
    return start, length(start)


def _sign(part):
    return sign(apart(part, UNSEEN))


def spread(ray, direction, reach):
    """Cross product of a direction, of some length, with a ray, and squared distances of its tip from the ray's.

    The ray is taken as long as the direction, and pointing ahead and backward. A distance that is small has only what
    the cross product is off, whatever the rest loses.
    """
    (x, y), (cosine, sine) = direction, ray
    along, across = plus(product(x, cosine), product(y, sine)), minus(product(x, sine), product(y, cosine))
    aside, less, more = across * across, along - reach, along + reach
    return across, less * less + aside, more * more + aside


def seen(placement, on, pivot, is_close):
    """The pivot as a pin of the crank sees it, which may come close to it (kernel)."""
    throw, (ground, rest), (direction, size) = placement.course(on).throw, length_and_rest(pivot), directed(pivot)
    a, slack = throw.radius_and_rest
    start, reach = (direction, size) if throw.ahead else directed(unturned(pivot, throw.at))
    turn, near_by, far_off = spread(placement.ray, start, reach)
    gap, unit = apart(total(ground, rest, -a, minus(None, slack)), UNSEEN), reach * reach
    if is_close:
        along, across = gap + 0.5 * a / unit * near_by, a / reach * turn
        x, y = (quotient(part, size) for part in direction)
        d = plus(product(x, along), product(y, across)), minus(product(y, along), product(x, across))
        near_by = a / ground * (turn * turn) + near_by * (gap / ground + 0.25 * a / (ground * unit) * near_by)
        square = along * along + across * across
    else:
        d = subtracted(pivot, placement.joints[on].position)
        square = gap * gap + a * ground / unit * near_by
    return Seen(a, slack, ground, rest, gap, turn, near_by, far_off, reach, d, square)


def place(placement, on, coupler_length, rocker_length, pivot, assembly, is_close):
    """Direction, ratio and slope of coupler and of rocker, and what follows in `RockerMotion`, for a pin (kernel)."""
    b, h = coupler_length, rocker_length
    gap, both, product = b - h, b + h, 2.0 * b * h
    line = seen(placement, on, pivot, is_close)
    (a, slack, ground, rest), near_by, far_off = line[:4], line.near_by, line.far_off
    (less, short), unit = (minus(None, rest), minus(None, slack)), 4.0 * product * line.reach * line.reach
    near_c = total(ground, h, -a, -b, rest, short) * total(ground, b, -a, -h, rest, short)
    near_c = apart(near_c, APART * UNSEEN * UNSEEN) / unit  # where A meets the pivot
    near_s = total(ground, a, h, -b, rest, slack) * total(ground, a, b, -h, rest, slack) / unit
    far_c = total(a, b, h, -ground, less, slack) * total(ground, b, h, -a, rest, short) / unit
    far_s = total(b, h, -ground, -a, less, short) * (both + ground + a) / unit
    near = near_c * far_off + near_s * near_by
    far = far_c * far_off + far_s * near_by
    closure = far * near
    size = root(closure, 1.0)
    sine, divided = assembly * size, assembly * divisor(size, SMALLEST)

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
    length, offset, short = coupler_length, number(guide.offset), minus(None, slack)
    x, y = unturned(placement.ray if ahead is None else turned(placement.ray, ahead), guide.direction)
    aside, less, more = x * x, 1.0 - y, 1.0 + y
    near_by, far_off = less * less + aside, more * more + aside
    unit = 4.0 * length
    low, high = (total(length, side, -r, short) / unit for side in (-offset, offset))
    low, high = low * near_by, high * far_off
    near = low + total(length, -offset, r, slack) / unit * far_off
    far = high + total(length, offset, r, slack) / unit * near_by
    closure = near * far
    size = root(closure, 1.0)
    divided = assembly * divisor(size, SMALLEST)
    inverse, share = 1.0 / divided, r / length
    bend = share * (high * near - low * far) * (inverse * inverse * inverse)
    return assembly * length * size, -share * x * inverse, bend, divided, closure


def slotted(placement, on, pivot, offset, assembly):
    """Direction of a slotted lever, its ratio and the slope of that, reach, what to divide by, and closure (kernel)."""
    line, o = seen(placement, on, pivot, True), number(offset)
    (a, slack, ground, rest), near_by, far_off = line[:4], line.near_by, line.far_off
    d, square, over = line.d, line.square, 1.0 / line.square
    short, unit, swept = minus(None, slack), 4.0 * line.reach * line.reach, a * ground / line.reach * line.turn
    near_c = total(ground, -a, -o, rest, short) * total(ground, -a, o, rest, short) / unit
    near_s = total(ground, a, -o, rest, slack) * total(ground, a, o, rest, slack) / unit
    near = near_c * far_off + near_s * near_by
    size = root(near, square)
    reach, divided = assembly * size, assembly * divisor(size, SMALLEST * ground)
    along, across = reach * over, o * over
    direction = (-along * d[0] - across * d[1], across * d[0] - along * d[1])
    inverse = 1.0 / divided
    rate = swept * inverse
    bend = a * ground * (near_c * far_off - near_by / unit * near) * (inverse * inverse * inverse)
    turning, change = 0.5 * line.gap * (ground + a) * over, 2.0 * swept * over
    ratio = 0.5 - turning + across * rate
    slope = change * (turning - across * rate) + across * bend
    return direction, ratio, slope, reach, divided, near / (square + a * a)


def is_near(throw, offset, pivot):
    """Whether a pin comes close to a pivot, or to where a slot passes it at an offset, in any design.

    It chooses formulas that keep all digits there, for all designs together: one has the last bits of its batch.
    """
    x, y = pivot
    if type(x) is type(y) is float:
        return is_small(throw, offset, math.hypot(x, y))
    return all(map(checks.known, pivot)) and is_small(throw, offset, np.hypot(x, y))


def is_small(throw, offset, length):
    """Whether the difference of a length, more or less an offset, and the radius of a pin is small, in any design."""
    radius = throw.at[0] if throw.ahead else None
    if type(radius) is type(offset) is type(length) is float:
        unit = CLOSE * (length + radius)
        return abs(abs(length + offset) - radius) < unit or abs(abs(length - offset) - radius) < unit
    if not all(map(checks.known, (*throw.at, offset, length))):
        return False
    radius, offset, length = map(np.asarray, (throw.polar[0], offset, length))
    far, near = abs(length + offset) - radius, abs(length - offset) - radius
    unit = CLOSE * (length + radius)
    return bool(np.any((abs(far) < unit) | (abs(near) < unit)))

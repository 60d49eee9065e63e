"""Four-bar on a pin of the crank: kernel in the crank angle psi from the direction O -> O2.

With S = sin^2(psi/2) and C = cos^2(psi/2), quarters of the squared distances of the crank ray from that direction and
from its opposite, so that neither loses a digit where it is small, the sine of the transmission angle is for a crank a,
coupler b, rocker h and ground d the root of two factors, with e from A to O2 (Heron),

    2 b h far  = (b+h)^2 - e^2 = ((b+h)^2 - (d-a)^2) C + ((b+h)^2 - (d+a)^2) S
    2 b h near = e^2 - (b-h)^2 = ((d-a)^2 - (b-h)^2) C + ((d+a)^2 - (b-h)^2) S

All that stands in brackets are products of sums of given lengths, each rounded as if once: where a factor vanishes, at
a limit position or change point, its error is no more than what one rounding of the crank angle makes. So are rates,

    theta' = 1/2 - (d^2 - a^2) / (2 e^2) -+ (1 -+ (b^2 - h^2) / e^2) R,    R = a d sin(psi) / (2 b h sine)

with the upper signs for the coupler, the lower ones for the rocker, and their slopes, in which R' is

    a d / (2 b h sine^3) (((d-a)^2 - (b-h)^2) C far - ((b+h)^2 - (d+a)^2) S near) / (2 b h)
"""

from typing import Any, NamedTuple

import numpy as np

from ..numbers import checks
from ..numbers.elementary import apart, divisor, root, total
from ..numbers.planar import cross, dot, length, number, turned, unturned
from .links import present

SMALLEST = 2.0**-100
"""Roots of closure, sines and cosines, that are not divided by less."""
CLOSE = 2.0**-5
"""Share of the longest length up to which a length differs little from what others leave it."""
UNSEEN = 2.0**-400
"""Distance, m, that gives nothing a direction, and changes no digit of another."""
TERMS = {
    "ground": ("g", "from O to the pivot"),
    "turn": ("s", "sine of the crank angle from the direction of the pivot"),
    "near_by": ("m", "square of the distance of the crank ray from that direction"),
    "far_off": ("n", "square of the distance of the crank ray from the opposite of that"),
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
    ground : float or array
        From O to the pivot.
    turn : array
        Sine of the crank angle from that direction.
    near_by, far_off : array
        Squared distances of the crank ray from that direction and from its opposite.
    d : vector
        From the pin to the pivot.
    square : array
        Square of that distance.
    """

    ground: Any
    turn: Any
    near_by: Any
    far_off: Any
    d: Any
    square: Any


def seen(placement, on, pivot):
    """The pivot as a pin of the crank sees it (kernel)."""
    a, ahead = placement.throws[on].polar
    (x, y), ray = pivot, placement.ray
    if present(y) is None and ahead is None:
        ground, way = abs(x), (x + UNSEEN) / abs(x + UNSEEN)
        turn, aside = way * ray[1], ray[1] * ray[1]
        less, more = ray[0] - way, ray[0] + way
        near_by, far_off = less * less + aside, more * more + aside
        along, across = apart(ground - a + 0.5 * a * near_by, 2.0**90 * UNSEEN), a * turn
        return Seen(ground, turn, near_by, far_off, (way * along, -way * across), along * along + across * across)
    ground, start = length(pivot) if present(x) is not None else abs(y), (x + UNSEEN, y)
    size = length(start)
    start = unturned((start[0] / size, start[1] / size), ahead)
    less, more = (ray[0] - start[0], ray[1] - start[1]), (ray[0] + start[0], ray[1] + start[1])
    inner = placement.joints[on].position
    d = (apart(x - inner[0], 2.0**90 * UNSEEN), y - inner[1])
    return Seen(ground, cross(start, ray), dot(less, less), dot(more, more), d, dot(d, d))


def place(placement, on, coupler_length, rocker_length, pivot, assembly):
    """Direction, ratio and slope of coupler and of rocker, and what follows in `RockerMotion`, for a pin (kernel)."""
    a, b, h = placement.throws[on].polar[0], coupler_length, rocker_length
    gap, both, product = b - h, b + h, 2.0 * b * h
    ground, turn, near_by, far_off, d, square = seen(placement, on, pivot)
    unit = 4.0 * product
    near_c = total(ground, h, -a, -b) * total(ground, b, -a, -h) / unit
    near_s = total(ground, a, h, -b) * total(ground, a, b, -h) / unit
    far_c = total(a, b, h, -ground) * total(ground, b, h, -a) / unit
    far_s = total(b, h, -ground, -a) * (both + ground + a) / unit
    near = apart(near_c * far_off + near_s * near_by, 2.0**90 * UNSEEN * UNSEEN / product)  # where A meets the pivot
    far = far_c * far_off + far_s * near_by
    closure = far * near
    size = root(closure, 1.0)
    sine, divided = assembly * size, assembly * divisor(size, SMALLEST)

    over = 1.0 / square
    share, aside = 0.5 * gap * both * over, sine * over
    toward, back = 0.5 + share, share - 0.5
    along, across = toward / b, h * aside
    q = (along * d[0] - across * d[1], along * d[1] + across * d[0])
    along, across = back / h, b * aside
    p = (along * d[0] - across * d[1], along * d[1] + across * d[0])

    inverse, sweep = 1.0 / divided, 2.0 * a * ground
    rate = sweep / product * turn * inverse
    bend = sweep / product * (near_c * far_off * far - far_s * near_by * near) * (inverse * inverse * inverse)
    turning = 0.5 * (ground - a) * (ground + a) * over
    mean, slope = 0.5 - turning, sweep * turn * over * (turning - share * rate)
    coupler = q, mean + back * rate, slope + back * bend
    rocker = p, mean + toward * rate, slope + toward * bend
    return coupler, rocker, sine, (b * b + h * h - square) / product, divided, closure


def slid(placement, on, coupler_length, guide, assembly):
    """Reach of a coupler along the guide, its rate and the slope of that, what to divide by, and closure (kernel).

    With y the sine of the crank angle from the guide, an offset e and a coupler l on a crank r the factors of closure
    are l - e + r y and l + e - r y over l, parted by (1 + y) / 2 and (1 - y) / 2.
    """
    r, ahead = placement.throws[on].polar
    length, offset = coupler_length, number(guide.offset)
    x, y = unturned(placement.ray if ahead is None else turned(placement.ray, ahead), guide.direction)
    aside, less, more = x * x, 1.0 - y, 1.0 + y
    near_by, far_off = less * less + aside, more * more + aside
    unit = 4.0 * length
    low, high = total(length, -offset, -r) / unit * near_by, total(length, offset, -r) / unit * far_off
    near = low + total(length, -offset, r) / unit * far_off
    far = high + total(length, offset, r) / unit * near_by
    closure = near * far
    size = root(closure, 1.0)
    divided = assembly * divisor(size, SMALLEST)
    inverse, share = 1.0 / divided, r / length
    bend = share * (high * near - low * far) * (inverse * inverse * inverse)
    return assembly * length * size, -share * x * inverse, bend, divided, closure


def slotted(placement, on, pivot, offset, assembly):
    """Direction of a slotted lever, its ratio and the slope of that, reach, what to divide by, and closure (kernel)."""
    a = placement.throws[on].polar[0]
    ground, turn, near_by, far_off, d, square = seen(placement, on, pivot)
    o, over, swept = number(offset), 1.0 / square, a * ground * turn
    near_c = 0.25 * total(ground, -a, -o) * total(ground, -a, o)
    near_s = 0.25 * total(ground, a, -o) * total(ground, a, o)
    near = near_c * far_off + near_s * near_by
    size = root(near, square)
    reach, divided = assembly * size, assembly * divisor(size, SMALLEST * ground)
    along, across = reach * over, o * over
    direction = (-along * d[0] - across * d[1], across * d[0] - along * d[1])
    inverse = 1.0 / divided
    rate = swept * inverse
    bend = a * ground * (near_c * far_off - 0.25 * near_by * near) * (inverse * inverse * inverse)
    turning, change = 0.5 * (ground - a) * (ground + a) * over, 2.0 * swept * over
    ratio = 0.5 - turning + across * rate
    slope = change * (turning - across * rate) + across * bend
    return direction, ratio, slope, reach, divided, near / (square + a * a)


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

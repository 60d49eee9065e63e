"""Change points, where all links of a linkage lie in one line: their kinds, and kernels that are smooth through them.

Crank a, coupler b, rocker h and ground d of a four-bar; psi, the crank angle from the direction O -> O2, is never
reduced to one turn. With A -> O2 of length e, four times the area of the triangle A B O2 is the root of
((b+h)^2 - e^2) (e^2 - (b-h)^2), and

    e^2 = (d+a)^2 - 4 a d cos^2(psi/2) = (d-a)^2 + 4 a d sin^2(psi/2)

so that one factor is a whole square where a + d = b + h ("far": A is farthest from O2), the other where
|d - a| = |b - h| ("near"). Its root with its sign, cos(psi/2) or sin(psi/2), is smooth through the change point, and is
divided out of the rates. Where both hold the linkage is a parallelogram or a kite, whose other branch is its mirror
image in the line A O2; where a = d and b = h A meets O2 ("meeting"), and sin(psi/2) is divided out of e as well.

All vectors are taken in the frame that turns half as fast as the crank, in which A -> O2 is
((d-a) cos(psi/2), -(d+a) sin(psi/2)).

A slotted lever with its slot at offset o left of O2 carries A at s = +-2 sqrt(a d) sin(psi/2) along it where
|d - a| = |o|, with its sign through the change point; where a = d and o = 0 A meets O2, and the lever keeps to the left
normal of that frame.

A four-bar whose crank is the rocker of another one is the same in the angle theta of that rocker; its rates follow by
the chain rule. At the half turns the joint goes on by whole turns: theta is a multiple of phi and a remainder within
half a turn, whose half has a positive cosine.
"""

import math
from typing import Any, NamedTuple

from ...numbers.arithmetic import clamped_sqrt, compensated_sum, cos, guarded_divisor, offset_from_zero, sin, sqrt
from ...numbers.planar import (
    cross,
    dot,
    left,
    length_with_error,
    minus,
    plus,
    product,
    rotate,
    rotate_back,
    scale_vector,
    subtract_vectors,
)
from ..links import present

SIDES: dict[Any, int] = {"open": 1, "crossed": -1}
"""Words for an assembly that passes change points, and its side without change points."""
FAR, NEAR, MEETING, PARALLEL, KITE, RHOMBUS = "far", "near", "meeting", "parallel", "kite", "rhombus"
BOTH = "both"
"""Slider group with a coupler as long as the crank, on a guide through O."""
OPPOSITE = "opposite"
"""Mirror image of a slotted lever of the kind "near"."""
TWO_TURN_KINDS = (FAR, NEAR, MEETING, OPPOSITE)
"""Kinds whose branch closes after two turns."""


def parse_passage(passage):
    """Kind, and quadrant of the direction from which the crank angle is halved."""
    kind, facing, *_ = passage.split(" ")
    return kind, int(facing)


class Carrier(NamedTuple):
    """Rocker `link` that carries a group. Its angle is `turns` of the crank's and within half a turn of `degrees`."""

    turns: int
    degrees: int
    link: str


def parse_carrier(passage):
    """`Carrier` of a group on a rocker; None on a pin of the crank."""
    found = passage.split(" ", 4)[2:]
    return Carrier(int(found[0]), int(found[1]), found[2]) if found else None


MIN_ROOT = 2.0**-27
"""Least root of a margin by which rates are divided."""
MIN_DISTANCE = 2.0**-984
"""Distance from a change point in place of 0; it does not change other distances."""
TERMS = {
    "cosine": ("c", "cosine of half the crank angle from the line to the pivot, or of a quarter"),
    "sine": ("s", "sine of that"),
    "height": ("w", "root of the closure"),
    "square": ("D", "square of the distance of the joint from the pivot, or of the reach"),
    "turning": ("q", "rate of the line from the joint to the pivot, or of the links mirrored in it"),
    "rate": ("z", "rate of the links besides"),
}


class _Half(NamedTuple):
    """Half of the crank angle from O -> O2 as a unit vector, and the frame that it has turned: another unit vector."""

    cosine: Any
    sine: Any
    frame: Any


class _Turning(NamedTuple):
    """Joint that turns about a fixed place, from which the pivot stands at `pivot`.

    Its distance from that place is `radius` plus the rounding error `slack`. `start` is the unit vector to it at angle
    0 (None: +x), `ray` the one at its angle, in axes with +x along `start`. Of a rocker the angle is `angle` and a
    remainder; `remainder` is the unit vector at half of that.
    """

    radius: Any
    slack: Any
    start: Any
    ray: Any
    pivot: Any
    angle: Any
    remainder: Any = None

    @property
    def half(self):
        """Unit vector at half the angle."""
        ahead = _half_ray(self.angle)
        return ahead if self.remainder is None else rotate(self.remainder, ahead)


def _half_ray(angle):
    half = 0.5 * angle
    return cos(half), sin(half)


def _turning(placement, on, pivot, carrier):
    """The joint `on`, a pin of the crank or of a rocker, as a `_Turning`."""
    if carrier is None:
        throw = placement.course(on).throw
        (radius, start), slack = throw.polar, throw.radius_and_rest[1]
        return _Turning(radius, slack, start, placement.ray, pivot, placement.angle)
    centre, radius, ray = placement.course(on).swing
    angle = carrier.turns * placement.angle + math.radians(carrier.degrees)
    x, y = rotate_back(ray, (cos(angle), sin(angle)))
    size = sqrt(2.0 + 2.0 * x)
    pivot = subtract_vectors(pivot, centre)
    return _Turning(radius, None, None, ray, pivot, angle, ((1.0 + x) / size, y / size))


def _by_crank(link, carrier):
    """Direction, ratio and slope by the crank angle, from those by the angle of the carrier."""
    direction, ratio, slope = link
    bend = product(product(carrier.ratio, carrier.ratio), slope)
    return direction, product(ratio, carrier.ratio), plus(bend, product(ratio, carrier.ratio_slope))


def _half(ray, pivot, ground, facing):
    start = _start(pivot, ground, facing)
    cosine, sine = rotate_back(ray, start)
    return _Half(cosine, sine, rotate(ray, start))


def _start(pivot, ground, facing):
    """Unit vector at half the angle of O -> O2; None: at zero."""
    x, y = pivot
    if not facing and present(y) is None:
        return None
    reach = ground - x if facing else ground + x
    size = sqrt(2.0 * ground * reach)
    return (facing * y / size, facing * reach / size) if facing else (reach / size, y / size)


def place(placement, on, coupler_length, rocker_length, pivot, passage, side):
    """Direction, ratio and slope of coupler and rocker, then the last fields of `RockerMotion`, for a pin (kernel).

    The pin is one of the crank, or of a rocker. The branch is open (+1) or crossed (-1). `closure` leaves out the
    change points. The sine of the transmission angle is a factor times a distance, which vanishes only there;
    `divisor` is the pair of both.
    """
    carrier = parse_carrier(passage)
    turning = _turning(placement, on, pivot, carrier)
    a, slack, direction, ray, pivot, *_ = turning
    (d, rest), pivot = length_with_error(pivot), rotate_back(pivot, direction)
    b, h = coupler_length, rocker_length
    less, short = minus(None, rest), minus(None, slack)
    m = compensated_sum(d, -a, rest, short)
    kind, facing = parse_passage(passage)
    if kind in TWO_TURN_KINDS:
        half = _half(turning.half, pivot, d, facing)
        if kind == FAR:
            constant = compensated_sum(d, h, -a, -b, rest, short) * compensated_sum(d, b, -a, -h, rest, short)
        else:
            constant = compensated_sum(b, h, -d, -a, less, short) * (b + h + d + a)
        lengths = a, b, h, d, constant
        found = _meeting(half, *lengths, side) if kind == MEETING else _single(half, kind, *lengths, m, side)
    elif side > 0 and kind != KITE:
        # a parallelogram: the coupler keeps the direction of the ground, the rocker that of the crank
        along = (pivot[0] / d, pivot[1] / d)
        found = (along, None, None), (ray, 1.0, None), 1.0, 1.0, cross(along, ray)
    elif side < 0 and kind != PARALLEL:
        # a folded kite: B stays on O, the coupler on the crank, the rocker on the ground
        back = (-pivot[0] / d, -pivot[1] / d)
        crank = subtract_vectors(None, ray), 1.0, None
        found = crank, (back, None, None), 1.0, 1.0, cross(back, ray)
    else:
        found = _mirrored(_half(turning.half, pivot, d, facing), kind, a, d, m, side)
    coupler, rocker, *rest = found
    last = (rest[1], offset_from_zero(rest[2], MIN_DISTANCE)), rest[0]
    if carrier is not None:
        by_carrier = scale_vector(a, left(ray)), coupler[1], rocker[1]
        coupler, rocker = (_by_crank(link, placement.links[carrier.link]) for link in (coupler, rocker))
        return coupler, rocker, *last, by_carrier
    coupler, rocker = ((rotate(link[0], direction), *link[1:]) for link in (coupler, rocker))
    return coupler, rocker, *last


def slid(placement, on, coupler_length, guide, passage, side):
    """Reach of a coupler along the guide, rate of the coupler and its slope, divisor, and closure (kernel).

    With psi from the right normal of the guide the coupler is perpendicular to it where cos(psi/2) ("far") or
    sin(psi/2) ("near") vanishes. The divisor is a factor and the distance from the change points.
    """
    kind, facing = parse_passage(passage)
    throw = placement.course(on).throw
    (a, direction), slack = throw.polar, throw.radius_and_rest[1]
    b, e = coupler_length, guide.offset
    x, y = rotate_back((1.0, 0.0) if guide.direction is None else guide.direction, direction)
    if kind == BOTH:
        along = dot((x, y), placement.ray)
        ratio = -1.0 if side > 0 else 1.0
        return side * a * along, ratio, None, (float(side), offset_from_zero(along, MIN_DISTANCE)), 1.0
    half = _half(_half_ray(placement.angle), (y, -x), 1.0, facing)
    constant = compensated_sum(b, e if kind == NEAR else minus(None, e), -a, minus(None, slack))
    height, closure, rate, bend, factor, passed = _swung(kind, half, 0.5 * a, 2.0 * b, constant, side)
    reach = side * sqrt(2.0 * a) * passed * height
    return reach, -2.0 * rate, -2.0 * bend, (factor, offset_from_zero(passed, MIN_DISTANCE)), closure


def slotted(placement, on, pivot, offset, passage, side):
    """Direction of a slotted lever, its ratio and the slope of that, reach, divisor, and closure (kernel).

    The slot points to the block (+1) or away from it (-1) in the half turn behind O -> O2. The divisor is the reach, as
    a factor and the distance from the change point.

    With the pivot at the distance d the rates have another divisor, (a+d)/2 +- sqrt(a d) cos(psi/2). It is a sum of
    squares by a quarter of the angle. It is small where A passes close by the pivot.
    """
    kind, facing = parse_passage(passage)
    a, ahead = placement.course(on).throw.polar
    d, pivot = length_with_error(pivot)[0], rotate_back(pivot, ahead)
    half = _half(_half_ray(placement.angle), pivot, d, facing)
    if kind == MEETING:
        direction, lag, slope, factor, closure = (0.0, float(side)), None, None, 2.0 * side * a, 1.0
    else:
        way, mean, middle = 1.0 if kind == NEAR else -1.0, 0.5 * (a + d), sqrt(a * d)
        quarter = 0.25 * placement.angle
        ray, start = (cos(quarter), sin(quarter)), _start(pivot, d, facing)
        cosine, sine = rotate_back(ray, start and _start(start, 1.0, 0))
        passed = cosine if way * side > 0 else sine
        square, least = 2.0 * passed * passed, 0.25 * offset * offset / (mean + middle)
        near = least + middle * square
        direction = (0.5 * offset * half.sine / near, side * (mean * square - least) / near)
        lag = 0.25 * way * offset / near
        slope = -0.5 * way * side * middle * half.sine / near * lag
        factor, closure = 2.0 * side * middle, near / (a + d)
    divided = factor, offset_from_zero(half.sine, MIN_DISTANCE)
    return rotate(rotate(direction, half.frame), ahead), minus(0.5, lag), slope, factor * half.sine, divided, closure


def divide(parts, divisor):
    """Components of a force over a factor and the distance from a change point, if there is one (kernel).

    Each is divided by itself: at the change point one that vanishes stays 0, the others are infinite.
    """
    factor, distance = divisor
    return tuple(part / factor if distance is None else part / factor / distance for part in parts)


def _mirrored(half, kind, a, d, m, side):
    """Antiparallelogram or open kite: the folded kite, or the parallelogram, mirrored in the line A O2."""
    cosine, sine, frame = half
    n = d + a
    x, y = m * cosine, n * sine
    square = x * x + y * y
    mirror = ((x * x - y * y) / square, -2.0 * x * y / square)
    ground, crank = rotate(rotate(mirror, (cosine, sine)), frame), rotate(rotate(mirror, (cosine, -sine)), frame)
    turning = -m * n / square
    slope = -4.0 * a * d * sine * cosine / square * turning
    as_ground, as_crank = (1.0 + turning, slope), (turning, slope)
    if kind == PARALLEL:
        coupler, rocker = (ground, *as_ground), (crank, *as_crank)
    else:
        coupler, rocker = (subtract_vectors(None, crank), *as_crank), (subtract_vectors(None, ground), *as_ground)
    return coupler, rocker, square / (n * n), 2.0 * side, sine * cosine


def _swung(kind, half, spread, size, constant, side):
    """Root of the factor that is not a square, constant + 4 spread (sine or cosine)^2, and its derived values.

    These are the closure, the rate at which the links turn besides A -> O2, its slope, and `factor` and `distance` of
    its divisor. The spread of a four-bar is a d, of a slider, whose pivot is far away, a / 2.
    """
    cosine, sine, _ = half
    passed, other = (cosine, sine) if kind == FAR else (sine, cosine)
    square = constant + 4.0 * spread * other * other
    height = clamped_sqrt(square, size)
    divided = guarded_divisor(height, MIN_ROOT * sqrt(size))
    reach = sqrt(spread)
    rate = side * reach * other / divided
    bend = 0.5 * side * reach * constant / (divided * divided * divided) * passed
    return height, square / size, rate, bend if kind == FAR else -bend, side * reach / (0.25 * size) * divided, passed


def _single(half, kind, a, b, h, d, constant, m, side):
    """One change point, with A clear of O2."""
    cosine, sine, frame = half
    n, gap, both = d + a, b - h, b + h
    height, closure, rate, bend, factor, passed = _swung(kind, half, a * d, 4.0 * b * h, constant, side)
    x, y = m * cosine, n * sine
    square = x * x + y * y
    if kind == NEAR:  # with A almost on O2 links turn fast
        closure = closure * square / (n * n)
    share = gap * both / square
    aside = 2.0 * side * sqrt(a * d) * passed * height / square
    reach = ((1.0 + share) * x + aside * y, aside * x - (1.0 + share) * y)
    arm = ((share - 1.0) * x + aside * y, aside * x - (share - 1.0) * y)
    turning, change = -0.5 * m * n / square, 4.0 * a * d * sine * cosine / square
    lost = change * share * rate
    coupler = (
        rotate((reach[0] / (2.0 * b), reach[1] / (2.0 * b)), frame),
        0.5 + turning - (1.0 - share) * rate,
        -change * turning - (1.0 - share) * bend - lost,
    )
    rocker = (
        rotate((arm[0] / (2.0 * h), arm[1] / (2.0 * h)), frame),
        0.5 + turning + (1.0 + share) * rate,
        -change * turning + (1.0 + share) * bend - lost,
    )
    return coupler, rocker, closure, factor, passed


def _meeting(half, a, b, h, d, constant, side):
    """Deltoid of equal crank and ground: A meets O2, but B goes on."""
    height, closure, rate, bend, factor, passed = _swung(NEAR, half, a * d, 4.0 * b * h, constant, side)
    x, y = side * height, (d + a) * half.sine
    coupler = rotate((x / (2.0 * b), -y / (2.0 * b)), half.frame), 0.5 - rate, -bend
    rocker = rotate((x / (2.0 * h), y / (2.0 * h)), half.frame), 0.5 + rate, bend
    return coupler, rocker, closure, factor, passed

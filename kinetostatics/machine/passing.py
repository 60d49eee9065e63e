"""Groups on branches that pass their change points: kernels in half angles, smooth through those points.

Which change points there are, and the notation, is told in `change_points`.
"""

from typing import Any, NamedTuple

from ..numbers.arithmetic import apart, cos, divisor, root, sin, sqrt, total
from ..numbers.planar import added, cross, dot, length_and_rest, minus, number, stretched, subtracted, turned, unturned
from .change_points import BOTH, FAR, KITE, MEETING, NEAR, PARALLEL, TWICE, parted
from .links import Joint, LinkMotion, present, tip

SMALLEST = 2.0**-27
"""Root of a margin that is not divided by less."""
UNSEEN = 2.0**-984
"""Distance that makes the smallest number there is of a zero, and changes no other."""
TERMS = {
    "cosine": ("c", "cosine of half the crank angle from the line to the pivot, or of a quarter"),
    "sine": ("s", "sine of that"),
    "height": ("w", "root of the closure"),
    "square": ("D", "square of the distance of the joint from the pivot, or of the reach"),
    "turning": ("q", "rate of the line from the joint to the pivot, or of what is mirrored in it"),
    "rate": ("z", "rate of the links besides"),
}
"""What hand calculations call lines of the kernels, and what they are."""


class PassedMotion(NamedTuple):
    """A rocker group placed on a branch through its change points; `closure` leaves these out.

    The sine of the transmission angle is `factor` times `distance`, which vanishes at the change points alone.
    """

    coupler: LinkMotion
    rocker: LinkMotion
    pin: Joint
    closure: Any
    factor: Any
    distance: Any


# How a linkage passes its change points: a text, which belongs to its structure


class _Half(NamedTuple):
    """Half of the crank angle from O -> O2 as a unit vector, and the frame that it has turned: another unit vector."""

    cosine: Any
    sine: Any
    frame: Any


def _half(angle, pivot, ground, facing):
    half = 0.5 * angle
    ray, start = (cos(half), sin(half)), _start(pivot, ground, facing)
    cosine, sine = unturned(ray, start)
    return _Half(cosine, sine, turned(ray, start))


def _start(pivot, ground, facing):
    """Unit vector at half the angle of O -> O2; None: at zero."""
    x, y = pivot
    if not facing and present(y) is None:
        return None
    reach = ground - x if facing else ground + x
    size = sqrt(2.0 * ground * reach)
    return (facing * y / size, facing * reach / size) if facing else (reach / size, y / size)


def _quarter(angle, pivot, ground, facing):
    """A quarter of the crank angle from O -> O2 as a unit vector."""
    quarter = 0.25 * angle
    ray, start = (cos(quarter), sin(quarter)), _start(pivot, ground, facing)
    return unturned(ray, start and _start(start, 1.0, 0))


def place(placement, on, coupler_length, rocker_length, pivot, passage, side):
    """Coupler and rocker for the pin `on` of the crank, on the branch that is open (+1) or crossed (-1) (kernel)."""
    throw, (d, rest) = placement.course(on).throw, length_and_rest(pivot)
    (a, direction), slack = throw.polar, throw.radius_and_rest[1]
    b, h, fixed, pivot = coupler_length, rocker_length, pivot, unturned(pivot, direction)
    less, short = minus(None, rest), minus(None, slack)
    m = total(d, -a, rest, short)
    kind, facing = parted(passage)
    if kind in TWICE:
        half = _half(placement.angle, pivot, d, facing)
        if kind == FAR:
            constant = total(d, h, -a, -b, rest, short) * total(d, b, -a, -h, rest, short)
        else:
            constant = total(b, h, -d, -a, less, short) * (b + h + d + a)
        lengths = a, b, h, d, constant
        found = _meeting(half, *lengths, side) if kind == MEETING else _single(half, kind, *lengths, m, side)
    elif side > 0 and kind != KITE:
        found = _translated(placement.ray, pivot, d)
    elif side < 0 and kind != PARALLEL:
        found = _folded(placement.ray, pivot, d)
    else:
        found = _mirrored(_half(placement.angle, pivot, d, facing), kind, a, d, m, side)
    coupler, rocker, *rest = found
    coupler, rocker = ((turned(link[0], direction), *link[1:]) for link in (coupler, rocker))
    return _placed(placement.joints[on], fixed, h, coupler, rocker, *rest)


def _placed(joint, pivot, rocker_length, coupler, rocker, closure, factor, distance):
    """Joint B and both links, from direction, ratio and its slope of each."""
    return PassedMotion(
        LinkMotion(joint, *coupler),
        LinkMotion(Joint(pivot, None, None), *rocker),
        tip(pivot, rocker_length, *rocker),
        closure,
        factor,
        apart(distance, UNSEEN),
    )


def slid(placement, on, coupler_length, guide, passage, side):
    """Reach of a coupler along the guide, rate of the coupler and its slope, what to divide by, and closure (kernel).

    With psi from the right normal of the guide the coupler stands at right angles to it where cos(psi/2) ("far") or
    sin(psi/2) ("near") vanishes. What to divide by is a factor and the distance from the change points.
    """
    kind, facing = parted(passage)
    throw = placement.course(on).throw
    (a, direction), slack = throw.polar, throw.radius_and_rest[1]
    b, e = coupler_length, number(guide.offset)
    x, y = unturned((1.0, 0.0) if guide.direction is None else guide.direction, direction)
    if kind == BOTH:
        along = dot((x, y), placement.ray)
        ratio = -1.0 if side > 0 else 1.0
        return side * a * along, ratio, None, (float(side), apart(along, UNSEEN)), 1.0
    half = _half(placement.angle, (y, -x), 1.0, facing)
    constant = total(b, e if kind == NEAR else -e, -a, minus(None, slack))
    passed, other = (half.cosine, half.sine) if kind == FAR else (half.sine, half.cosine)
    square, size = constant + 2.0 * a * other * other, 2.0 * b
    height = root(square, size)
    divided = divisor(height, SMALLEST * sqrt(size))
    reach = side * sqrt(2.0 * a)
    bend = 0.5 * reach * constant / (divided * divided * divided) * passed
    return (
        reach * passed * height,
        -reach * other / divided,
        -bend if kind == FAR else bend,
        (reach / b * divided, apart(passed, UNSEEN)),
        square / size,
    )


def slotted(placement, on, pivot, offset, passage, side):
    """Direction of a slotted lever, its ratio and the slope of that, reach, what to divide by, and closure (kernel).

    The slot points to the block (+1) or away from it (-1) in the half turn behind O -> O2. What to divide by is the
    reach: a factor and the distance from the change point.

    With the pivot at the distance d the rates have one more divisor, (a+d)/2 +- sqrt(a d) cos(psi/2), a sum of squares
    by a quarter of the angle: it is small where A passes close by the pivot.
    """
    kind, facing = parted(passage)
    a, ahead = placement.course(on).throw.polar
    d, pivot = length_and_rest(pivot)[0], unturned(pivot, ahead)
    half = _half(placement.angle, pivot, d, facing)
    if kind == MEETING:
        direction, lag, slope, factor, closure = (0.0, float(side)), None, None, 2.0 * side * a, 1.0
    else:
        way, mean, middle = 1.0 if kind == NEAR else -1.0, 0.5 * (a + d), sqrt(a * d)
        cosine, sine = _quarter(placement.angle, pivot, d, facing)
        passed = cosine if way * side > 0 else sine
        square, least = 2.0 * passed * passed, 0.25 * offset * offset / (mean + middle)
        near = least + middle * square
        direction = (0.5 * offset * half.sine / near, side * (mean * square - least) / near)
        lag = 0.25 * way * offset / near
        slope = -0.5 * way * side * middle * half.sine / near * lag
        factor, closure = 2.0 * side * middle, near / (a + d)
    divided = factor, apart(half.sine, UNSEEN)
    return turned(turned(direction, half.frame), ahead), minus(0.5, lag), slope, factor * half.sine, divided, closure


def grown(parts, divisor):
    """Components of a force over a factor and the distance from a change point (kernel).

    Each by itself: there the whole is infinite, but a component that vanishes stays zero.
    """
    factor, distance = divisor
    return tuple(part / factor / distance for part in parts)


def _translated(ray, pivot, ground):
    """Parallelogram: the coupler keeps the direction of the ground, the rocker that of the crank."""
    along = (pivot[0] / ground, pivot[1] / ground)
    return (along, None, None), (ray, 1.0, None), 1.0, 1.0, cross(along, ray)


def _folded(ray, pivot, ground):
    """Folded kite: B stays on O, the coupler on the crank, the rocker on the ground."""
    back = (-pivot[0] / ground, -pivot[1] / ground)
    return ((-ray[0], -ray[1]), 1.0, None), (back, None, None), 1.0, 1.0, cross(back, ray)


def _mirrored(half, kind, a, d, m, side):
    """Antiparallelogram or open kite: the folded kite, or the parallelogram, mirrored in the line A O2."""
    cosine, sine, frame = half
    n = d + a
    x, y = m * cosine, n * sine
    square = x * x + y * y
    mirror = ((x * x - y * y) / square, -2.0 * x * y / square)
    ground, crank = turned(turned(mirror, (cosine, sine)), frame), turned(turned(mirror, (cosine, -sine)), frame)
    turning = -m * n / square
    slope = -4.0 * a * d * sine * cosine / square * turning
    as_ground, as_crank = (1.0 + turning, slope), (turning, slope)
    if kind == PARALLEL:
        coupler, rocker = (ground, *as_ground), (crank, *as_crank)
    else:
        coupler, rocker = (subtracted(None, crank), *as_crank), (subtracted(None, ground), *as_ground)
    return coupler, rocker, square / (n * n), 2.0 * side, sine * cosine


def _swung(kind, half, a, d, size, constant, side):
    """Root of the factor that is no whole square, and what follows from it.

    That is the closure, the rate at which the links turn besides A -> O2, its slope, and `factor` and `distance` of
    `PassedMotion`.
    """
    cosine, sine, _ = half
    passed, other = (cosine, sine) if kind == FAR else (sine, cosine)
    square = constant + 4.0 * a * d * other * other
    height = root(square, size)
    divided = divisor(height, SMALLEST * sqrt(size))
    reach = sqrt(a * d)
    rate = side * reach * other / divided
    bend = 0.5 * side * reach * constant / (divided * divided * divided) * passed
    return height, square / size, rate, bend if kind == FAR else -bend, side * reach / (0.25 * size) * divided, passed


def _single(half, kind, a, b, h, d, constant, m, side):
    """One change point, with A clear of O2."""
    cosine, sine, frame = half
    n, gap, both = d + a, b - h, b + h
    height, closure, rate, bend, factor, passed = _swung(kind, half, a, d, 4.0 * b * h, constant, side)
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
        turned((reach[0] / (2.0 * b), reach[1] / (2.0 * b)), frame),
        0.5 + turning - (1.0 - share) * rate,
        -change * turning - (1.0 - share) * bend - lost,
    )
    rocker = (
        turned((arm[0] / (2.0 * h), arm[1] / (2.0 * h)), frame),
        0.5 + turning + (1.0 + share) * rate,
        -change * turning + (1.0 + share) * bend - lost,
    )
    return coupler, rocker, closure, factor, passed


def _meeting(half, a, b, h, d, constant, side):
    """Deltoid of equal crank and ground: A meets O2, but B goes on."""
    height, closure, rate, bend, factor, passed = _swung(NEAR, half, a, d, 4.0 * b * h, constant, side)
    x, y = side * height, (d + a) * half.sine
    coupler = turned((x / (2.0 * b), -y / (2.0 * b)), half.frame), 0.5 - rate, -bend
    rocker = turned((x / (2.0 * h), y / (2.0 * h)), half.frame), 0.5 + rate, bend
    return coupler, rocker, closure, factor, passed


def pin_force(motion, coupler_length, rocker_length, coupler_load, rocker_load):
    """Force of the coupler on the rocker, by moments of both (kernel); infinite at a change point.

    Their sum is divided as a whole, so that what does not grow there is not lost in what does.
    """
    q, p = motion.coupler.direction, motion.rocker.direction
    along = rocker_load.moment, coupler_load.moment
    parts = (
        stretched(None if moment is None else moment / length, direction)
        for moment, length, direction in zip(along, (rocker_length, coupler_length), (q, p), strict=True)
    )
    whole = added(*parts)
    if whole is None:
        return (0.0, 0.0)
    return grown(whole, (motion.factor, motion.distance))

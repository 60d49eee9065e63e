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

from ..numbers.elementary import apart, divisor, root, total
from ..numbers.planar import cross, dot, length, unturned
from .links import present

SMALLEST = 2.0**-53
"""Sine of the transmission angle that is not divided by less."""
UNSEEN = 2.0**-400
"""Distance, m, that gives nothing a direction, and changes no digit of another."""
TERMS = {
    "near_by": ("s", "square of the distance of the crank ray from the direction of the pivot"),
    "far_off": ("c", "square of the distance of the crank ray from the opposite of that"),
    "turn": ("sin psi", "sine of the crank angle from that direction"),
    "near": ("N", "part of the squared sine that vanishes where A is nearest to the pivot"),
    "far": ("F", "part of the squared sine that vanishes where A is farthest from the pivot"),
    "d": ("d", "from the inner joint to the pivot"),
    "square": ("D", "square of that distance"),
    "share": ("xi", "by which the pin lies along it beyond its middle"),
    "size": ("sigma", "sine of the transmission angle, not below zero"),
    "divided": ("sigma", "sine of the transmission angle"),
    "cosine": ("kappa", "cosine of the transmission angle"),
    "rate": ("z", "rate at which the triangle of both links opens"),
    "bend": ("z'", "derivative by phi of that"),
    "turning": ("q", "rate of the line from the joint to the pivot, less a half"),
}
"""What hand calculations call lines of the kernels, and what they are."""


def place(placement, on, coupler_length, rocker_length, pivot, assembly):
    """Direction, ratio and slope of coupler and of rocker, and what follows in `RockerMotion`, for a pin (kernel)."""
    a, ahead = placement.throws[on].polar
    b, h, (x, y) = coupler_length, rocker_length, pivot
    gap, both, product = b - h, b + h, 2.0 * b * h
    if present(y) is None and ahead is None:
        ground, way = abs(x), (x + UNSEEN) / abs(x + UNSEEN)
        turn, near_by, far_off = _seen(placement.ray, (way, None))
        along, across = apart(ground - a + 0.5 * a * near_by, 2.0**90 * UNSEEN), a * turn
        square = along * along + across * across
        d = (way * along, -way * across)
    else:
        ground, start = length(pivot), unturned((x + UNSEEN, y), ahead)
        turn, near_by, far_off = _seen(placement.ray, (start[0] / ground, start[1] / ground))
        inner = placement.joints[on].position
        d = (apart(x - inner[0], both), y - inner[1])
        square = dot(d, d)

    unit = 4.0 * product
    near_c = total(ground, h, -a, -b) * total(ground, b, -a, -h) / unit
    near_s = total(ground, a, h, -b) * total(ground, a, b, -h) / unit
    far_c = total(a, b, h, -ground) * total(ground, b, h, -a) / unit
    far_s = total(b, h, -ground, -a) * (both + ground + a) / unit
    near, far = near_c * far_off + near_s * near_by, far_c * far_off + far_s * near_by
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


def _seen(ray, start):
    """Sine of the crank angle from a direction, and squared distances of the ray from that and from its opposite."""
    x, y = ray
    if start[1] is None:
        square = y * y
        near, far = x - start[0], x + start[0]
        return start[0] * y, near * near + square, far * far + square
    near, far = (x - start[0], y - start[1]), (x + start[0], y + start[1])
    return cross(start, ray), dot(near, near), dot(far, far)

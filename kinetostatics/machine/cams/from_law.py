"""Cam that makes a slider follow a law of the whole turn: its one coupler length, and its radius free of cancellation.

In the axes of the guide let phi be the crank angle from its direction, x(phi) the law and e the offset. B = (x, e) is d
= x sin(phi) - e cos(phi) off the crank ray, and A on the ray at the coupler's length L from B:

    r = x cos(phi) + e sin(phi) - w,   w^2 = (L - d) (L + d)

B is ahead of A at phi = 0 and past it half a turn on, so w must change its sign. It does so smoothly only at a double
zero, at phi1 with d = max d = L and at phi2 with d = min d = -L. With h1 = phi - phi1 and h2 = phi - phi2

    L - d = h1^2 q1,   L + d = h2^2 q2,   q1 = - integral over s from 0 to 1 of (1 - s) d''(phi1 + s h1)

whose derivatives follow from d''' alone: q' = - integral of (1 - s) s d''', h q'' = integral of (3 s^2 - 2 s) d'''. So
nothing cancels at the singular angles, and w is as smooth around them as the law. Both L are equal for one phase of a
law only; otherwise `from_law` raises an error that gives this phase.
"""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property
from ..laws.law import TURN, breakpoints_of, law_problem
from .cam import Cam

SEARCH_ANGLES = np.linspace(-np.pi, np.pi, 2881)
"""Crank angles from the guide among which the largest and smallest d are sought, rad."""
SINGULAR_REACH = 0.5
"""Distance from a singular angle, rad, within which L -+ d come from quadrature; beyond it they keep their digits."""
PANEL_EDGES = np.linspace(-SINGULAR_REACH, SINGULAR_REACH, 5)
MIN_DISTANCE = 1e-60
"""Distance from a singular angle, rad, below which its limits hold."""
GAUSS_POINTS, GAUSS_WEIGHTS = (
    part / 2 + by for part, by in zip(np.polynomial.legendre.leggauss(10), (0.5, 0.0), strict=True)
)


class SingularPosition(NamedTuple):
    """Singular position, the coupler across the ray: crank angle from the guide, rad, and size of d there, m."""

    angle: float
    length: float


def ray_distance(law, offset, phi):
    """Distance of the slider from the crank ray, d = x sin(phi) - e cos(phi), and three derivatives by phi, m."""
    x, v, a, j = law(phi)
    s, c = np.sin(phi), np.cos(phi)
    return (
        x * s - offset * c,
        v * s + x * c + offset * s,
        (a - x) * s + 2.0 * v * c + offset * c,
        (j - 3.0 * v) * s + (3.0 * a - x) * c - offset * s,
    )


@dataclass(frozen=True, eq=False)
class LawCam(Cam):
    """Cam that makes the slider follow a law of the whole turn; made by `from_law`.

    Attributes
    ----------
    law : Law
    coupler_length : float
        The length with which the cam is smooth, m.
    guide_angle, guide_offset : float
        rad and m.
    far, near : Turning
        Positions with the coupler across the ray: in the half turn left of the guide, and right of it.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.from_law(ks.laws.cosine(0.3, 2.0))
    >>> type(cam).__name__, round(cam.coupler_length, 8)
    ('LawCam', 2.02190518)
    """

    law: Any
    coupler_length: float
    guide_angle: float
    guide_offset: float
    far: SingularPosition
    near: SingularPosition

    TABULATED = True
    RULES = checks.Rules("cam from a law")  # none of its numbers is a parameter

    @property
    def singular_angles(self):
        """Crank angles from +x at which the coupler is across the crank ray, rad."""
        return tuple((self.guide_angle + turning.angle) % TURN for turning in (self.far, self.near))

    @cached_property
    def knots(self):
        return tuple(knot._replace(angle=knot.angle + self.guide_angle) for knot in breakpoints_of(self.law))

    @property
    def force_error(self):
        """Expected largest error of a force, relative to its largest value; None unless the law is from a table."""
        return getattr(self.law, "force_error", None)

    @property
    def lengths(self):
        """Lengths that define the pitch curve, m."""
        return (self.coupler_length, float(np.max(np.abs(self.law(SEARCH_ANGLES)[0]))))

    @cached_property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O on a grid of an eighth of a degree, m."""
        return float(np.min(self.radius(SEARCH_ANGLES)[0]))

    def polar(self, angle, ray):
        shape = np.shape(angle)
        phi = np.mod(np.atleast_1d(np.asarray(angle, dtype=float)) - self.guide_angle + np.pi, TURN) - np.pi
        x, v, a, _ = self.law(phi)
        s, c = np.sin(phi), np.cos(phi)
        e = self.guide_offset
        along = x * c + e * s, (v + e) * c - x * s, (a - x) * c - (2.0 * v + e) * s
        # the signed reach w and two derivatives: from d, and near a singular angle from q
        d, first, second, _ = ray_distance(self.law, self.guide_offset, phi)
        square = (self.far.length - d) * (self.near.length + d)
        sign = np.where((phi < self.far.angle) & (phi > self.near.angle), 1.0, -1.0)
        with np.errstate(all="ignore"):  # values at the singular angles are replaced below
            w = sign * np.sqrt(np.maximum(square, 0.0))
            slope = -d * first / w
            found = [w, slope, -(first * first + d * second + slope * slope) / w]
        for turning, side in ((self.far, 1.0), (self.near, -1.0)):
            h = np.mod(phi - turning.angle + np.pi, TURN) - np.pi
            here = np.abs(h) < SINGULAR_REACH
            if np.any(here):
                around = self._near_singular(turning, side, h[here], d[here], first[here], second[here])
                for part, value in zip(found, around, strict=True):
                    part[here] = value
        return tuple((part - reach).reshape(shape) for part, reach in zip(along, found, strict=True))

    def _near_singular(self, turning, side, h, d, first, second):
        """Reach w and two derivatives at distances h from a singular angle; `side` is the sign of d there.

        w = -side h sqrt(q p), p = L + side d, with q, q' and h q'' from moments of d'' and d''' over the distance.
        """
        edges, sums = self._moments[turning]
        ahead = np.minimum(np.searchsorted(edges, h, side="right"), edges.size) - 1
        start = np.where(h < 0.0, np.searchsorted(edges, h), ahead)
        whole, bent, sloped, curved = sums[:, start] + self._moments_between(turning, edges[start], h)
        middle = np.abs(h) < MIN_DISTANCE
        span = np.where(middle, 1.0, h)
        q = -side * (span * whole - bent) / span**2
        slope = -side * (span * sloped - curved) / span**3
        bend = -side * (3.0 * curved - 2.0 * span * sloped) / span**3  # h q''
        if np.any(middle):
            _, _, second_here, third_here = ray_distance(self.law, self.guide_offset, np.array(turning.angle))
            limits = -side * second_here / 2, -side * third_here / 6, 0.0
            q, slope, bend = (np.where(middle, *pair) for pair in zip(limits, (q, slope, bend), strict=True))
        p = self.coupler_length + side * d
        root = np.sqrt(q * p)
        product = slope * p + q * side * first  # (q p)'
        root_slope = product / (2.0 * root)
        # h (q p)'' = h q'' p + 2 h q' p' + h q p''
        twice = bend * p + 2.0 * h * slope * side * first + h * q * side * second
        root_bend = twice / (2.0 * root) - h * root_slope * root_slope / root
        return -side * h * root, -side * (root + h * root_slope), -side * (2.0 * root_slope + root_bend)

    @cached_property
    def _moments(self):
        """By singular position: edges of panels around it, among them knots of the law, and moments up to each edge."""
        found = {}
        for turning in (self.far, self.near):
            knots = np.mod(np.array(getattr(self.law, "knots", ())) - turning.angle + np.pi, TURN) - np.pi
            edges = np.unique(np.concatenate([PANEL_EDGES, knots[np.abs(knots) < SINGULAR_REACH]]))
            each = self._moments_between(turning, edges[:-1], edges[1:])
            sums = np.concatenate([np.zeros((4, 1)), np.cumsum(each, axis=-1)], axis=-1)
            found[turning] = edges, sums - sums[:, [np.searchsorted(edges, 0.0)]]
        return found

    def _moments_between(self, turning, start, stop):
        """Integrals of d'', u d'', u d''' and u^2 d''' from `start` to `stop`, distances u from a singular angle."""
        width = (stop - start)[..., None]
        u = start[..., None] + width * GAUSS_POINTS
        _, _, second, third = ray_distance(self.law, self.guide_offset, turning.angle + u)
        second, third = second * GAUSS_WEIGHTS * width, third * GAUSS_WEIGHTS * width
        return np.sum([second, u * second, u * third, u * u * third], axis=-1)


LENGTH_TOLERANCE = 1e-10
"""Largest relative difference of the two coupler lengths."""


def from_law(law, coupler_length=None, guide_angle=0.0, guide_offset=0.0):
    """Cam that makes the slider of a cam-balanced crank-slider follow a law exactly, of assembly +1.

    Parameters
    ----------
    law : Law
        Coordinate of the slider along the guide from the foot of O, m, by the crank angle from the guide's direction.
        It is from `laws`, or a function that gives position and three derivatives.
    coupler_length : float, optional
        m; by default computed. A smooth cam exists for one length only.
    guide_angle : float
        Direction of the guide from +x, rad.
    guide_offset : float
        Signed distance of the guide from O along its left normal, m.

    Returns
    -------
    LawCam
        It runs in every engine; as for sampled cams its radii are computed before the loop.

    Raises
    ------
    ParameterError
        No smooth cam makes this law, because the coupler would need two lengths: the message gives both, their crank
        angles, and the phase of the law that makes them equal. Or the given coupler has another length, or the cam
        passes through O or the slider behind the roller.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.from_law(ks.laws.cosine(0.3, 2.0))
    >>> round(cam.coupler_length, 10)
    2.0219051769
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length)
    >>> round(float(ks.solve(saw, 1.0, crank_speed=30.0).slider_position), 9)  # 2 + 0.3 cos(1)
    2.162090692
    """
    values = checks.single_numbers(
        "from_law",
        law_problem(law),
        guide_angle=(guide_angle, "rad", {}),
        guide_offset=(guide_offset, "m", {}),
        coupler_length=(1.0 if coupler_length is None else coupler_length, "m", {"low": 0.0, "strict": True}),
    )
    offset = values["guide_offset"]
    far, near = singular_positions(law, offset)
    if abs(far.length - near.length) > LENGTH_TOLERANCE * far.length:
        raise ParameterError(_two_lengths_message(law, offset, far, near))
    length = (far.length + near.length) / 2
    if coupler_length is not None and abs(values["coupler_length"] - length) > 1e-9 * length:
        raise ParameterError(
            f"from_law: a smooth cam makes this law with a coupler of {length:.10g} m only, where it is across the ray "
            f"at {_degrees(far)} and {_degrees(near)} deg from the guide. Got {values['coupler_length']:.10g} m; leave "
            "coupler_length out to have it computed"
        )
    cam = LawCam(law, length, values["guide_angle"], offset, far, near)
    checks.require("from_law", *_cam_problems(cam))
    return cam


def singular_positions(law, offset):
    """Singular positions with the largest and with the smallest d."""
    from scipy.optimize import brentq

    def slope(angle):
        return float(ray_distance(law, offset, np.array(angle))[1])

    grid = np.unique(np.concatenate([SEARCH_ANGLES, np.mod(np.array(getattr(law, "knots", ())) + np.pi, TURN) - np.pi]))
    values, found = ray_distance(law, offset, grid)[0], []
    for side in (1.0, -1.0):
        place = int(np.argmax(side * values))
        angle, low, high = grid[place], grid[place - 1], grid[(place + 1) % grid.size]
        low, high = (low - TURN if low > angle else low), (high + TURN if high < angle else high)
        if slope(low) * slope(high) < 0:
            angle = brentq(slope, low, high, xtol=1e-15, rtol=1e-15)
        found.append(SingularPosition(float(angle), float(side * ray_distance(law, offset, np.array(angle))[0])))
    return found


def _two_lengths_message(law, offset, far, near):
    """Sentence on the two lengths, with the smallest phase up to an eighth of a turn that makes them one."""
    from scipy.optimize import brentq

    def excess(phase):
        one, other = singular_positions(lambda phi: law(phi - phase), offset)
        return one.length - other.length

    start, remedy = excess(0.0), "no phase of the law repairs it"
    for phase in np.outer(np.pi / 4 * 2.0 ** np.arange(-8, 1), (1.0, -1.0)).flat:
        if start * excess(phase) <= 0:
            phase = brentq(excess, *sorted((0.0, phase)), xtol=1e-16, rtol=1e-15)
            shifted = f"law.shifted({phase!r})" if hasattr(law, "shifted") else f"lambda phi: law(phi - {phase!r})"
            remedy = f"the law later by {np.degrees(phase):.4g} deg needs one only: {shifted}"
            break
    return (
        f"from_law: no smooth cam makes this law. The coupler would have to be {far.length:.10g} m long at "
        f"{_degrees(far)} deg from the guide, and {near.length:.10g} m at {_degrees(near)} deg, where it is across the "
        f"ray; {remedy}"
    )


def _degrees(turning):
    return f"{np.degrees(turning.angle) % 360:.6g}"


def _cam_problems(cam):
    """Problems of a law that leads the pitch curve through O or the slider behind the roller, as sentences."""
    radius = cam.radius(SEARCH_ANGLES + cam.guide_angle)[0]
    position = cam.law(SEARCH_ANGLES)[0]
    ahead = np.array(position - radius * np.cos(SEARCH_ANGLES))
    worst, nearest = int(np.argmin(radius)), int(np.argmin(ahead))

    def at(place):
        return f"at {np.degrees(SEARCH_ANGLES[place]) % 360:.4g} deg from the guide"

    if not np.all(np.isfinite(radius)):
        yield f"the law has no cam {at(np.argmax(~np.isfinite(radius)))}"
    elif radius[worst] <= 0:
        # the slider must be farthest where the crank is along the guide
        farthest = SEARCH_ANGLES[int(np.argmax(position))]
        if np.ptp(position) == 0.0:
            remedy = "the law must have a stroke"
        elif np.cos(farthest) > 0.0:
            remedy = "move the law farther from O"
        else:
            remedy = (
                f"the slider must be farthest near 0 deg from the guide, but is so at "
                f"{np.degrees(farthest) % 360:.4g}: take law.shifted({-float(farthest)!r})"
            )
        yield f"the pitch curve must go around O, but its radius falls to {radius[worst]:.6g} m {at(worst)}; {remedy}"
    elif ahead[nearest] <= 0:
        yield (
            f"the slider must stay ahead of the roller along the guide, but is {-ahead[nearest]:.6g} m behind it "
            f"{at(nearest)}; move the law farther from O, or turn the guide"
        )

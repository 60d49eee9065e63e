"""Fixed cams: the circle and the cosine law in closed form; `ks.cams` offers all its other public names here too.

A cam is the pitch curve of the roller centre in polar form about O: r(phi) and two derivatives, m. Closed forms and
splines are smooth and keep their digits all round the turn.
"""

from dataclasses import dataclass, field
from typing import Annotated, Any, ClassVar

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import compensated_sum, namespace, sqrt
from ...numbers.lazy import cached_property
from ...numbers.planar import length_with_error, minus
from ..crank import ray as ray_at
from ..dimensions import Radius, of_fixed_point
from ..groups.near_dead_centre import CLOSE_SHARE, direction_and_length, squared_distances
from .cam import Cam, Harmonic
from .from_law import LawCam, from_law
from .profile import Profile
from .sampled import Sampled

__all__ = ["Cam", "Circle", "CosineLaw", "Harmonic", "LawCam", "Profile", "Sampled", "from_law"]
TERMS = {
    "along": ("u", "centre of the circle along the ray"),
    "across": ("v", "centre of the circle across the ray, to the left"),
    "root": ("w", "root of the pitch curve"),
    "singular": ("c0", "cosine of the singular angle"),
    "excess": ("d", "that root less the coordinate of the slider"),
    "share": ("f", "amplitude times the cosine of the singular angle"),
}


@dataclass(frozen=True, eq=False, init=False)
class Circle(checks.Checked, Cam):
    """Circular pitch curve around O.

    Where O lies close to the circle, other formulas keep all digits. A batch uses them if O is close in any design, so
    the last bits of a design may depend on the others.

    Parameters
    ----------
    radius : float or array
        Radius of the circle of roller centres, m.
    centre : (x, y)
        Centre relative to O, m; O lies inside the circle.

    Raises
    ------
    ParameterError
        A value is not finite, the radius not positive, or O outside the circle.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Circle(0.3, centre=(-0.0219, 0.0))
    >>> radius, slope, bend = cam.radius(0.0)  # r, dr/dphi and d2r/dphi2, m
    >>> round(float(radius), 6), round(float(cam.pressure_angle(1.5707963)), 4)
    (0.2781, 0.0731)
    """

    pitch_radius: Annotated[Any, checks.Number("m", "radius", low=0.0, strict=True)]
    centre: Annotated[Any, checks.Pair("m")]
    is_close: bool = field(default=False, init=False, repr=False)

    ELEMENTWISE = True
    PATHS: ClassVar = {"pitch_radius": "radius"}

    def __init__(self, radius, centre=(0.0, 0.0)):
        vars(self).update(pitch_radius=radius, centre=centre)
        self.__post_init__()

    def __post_init__(self):
        self.RULES.admit(self)
        least = self.smallest_radius
        is_close = checks.has_known_values(least) and bool(np.any(least < CLOSE_SHARE * self.pitch_radius))
        vars(self).update(is_close=is_close)  # O lies close to the circle, in any design

    def _outside_problems(self):
        """Problem of designs with O outside the circle, or on it."""
        (x, y), radius = self.centre, self.pitch_radius
        distance = sqrt(x * x + y * y)
        if checks.has_known_values(distance - radius) and np.any(outside := distance >= radius):
            yield checks.Problem(
                f"O must lie inside the pitch circle, but its centre is {np.max(distance):.6g} m from O and its radius "
                f"{np.min(radius):.6g} m; bring the centre nearer or enlarge the radius",
                outside,
            )

    RULES = checks.Rules("circle cam", _outside_problems)

    @property
    def lengths(self):
        """Lengths that define the pitch curve, m."""
        return (self.pitch_radius, *self.centre)

    @property
    def dimensions(self):
        """What its numbers measure on a drawing, by their steps."""
        return {("pitch_radius",): Radius(self.centre), **of_fixed_point("centre", self.centre)}

    @property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O, m."""
        x, y = self.centre
        return self.pitch_radius - sqrt(x * x + y * y)

    def polar(self, angle, ray):
        x, y = self.centre
        along = x * ray[0] + y * ray[1]
        across = y * ray[0] - x * ray[1]
        if self.is_close:
            return self._polar_near_circle(along, across, ray)
        root = sqrt((self.pitch_radius - across) * (self.pitch_radius + across))
        r = along + root
        lean = across / root
        slope = lean * r
        return r, slope, lean * slope - along * (1.0 + lean * lean) * r / root

    def _polar_near_circle(self, along, across, ray):
        """The same with O close to the circle, without differences of nearly equal lengths.

        All follow from the smallest radius and positive terms; r (root - along) is the product of the smallest and
        largest radius.
        """
        (x, y), radius = self.centre, self.pitch_radius
        (away, rest), (direction, reach) = length_with_error(self.centre), direction_and_length((y, -x))
        least, share = compensated_sum(radius, -away, minus(None, rest)), 0.5 * away / (reach * reach)
        _, near_by, far_off = squared_distances(ray, direction, reach)
        root = sqrt((least + share * near_by) * (least + share * far_off))
        r = along + root
        return r, across / root * r, radius * radius * least * (radius + away) / (root * root * root) - r


@dataclass(frozen=True, eq=False)
class CosineLaw(checks.Checked, Cam):
    """Cam that gives the slider the exact motion x_B = mean + amplitude cos(phi) along a guide through O.

    A is on the ray at the distance of the coupler length L from B. So r = x_B cos(phi) - w, where w is the signed root
    of L^2 - x_B^2 sin(phi)^2. The two branches of the root join smoothly for one length only, L = max of x_B sin(phi),
    reached at the singular angle phi*. Then the radicand has the double zero cos(phi) = cos(phi*) and, divided by it,
    is a quadratic: with c = cos(phi), c* = cos(phi*), amplitude a, mean b

        w = (c - c*) sqrt(a^2 c^2 + p c + q),   p = 2 a (b + a c*),   q = b^2 - a^2 + 2 c* p - c*^2 a^2

    The difference of x_B cos(phi) and w, both much larger than r, cancels out in closed form: with b c* = a - 2 a c*^2

        r = c* root - c d,   d = root - x_B = g + a c*
        g = (a^2 (2 + c* c - 3 c*^2) - a c* root) / (root + x_B)

    where g loses at most one bit. The derivatives by c follow with k = a / root and w = k (c - c*):

        dr/dc = (w - 1) g,   d2r/dc2 = k g (2 - w (2 - g / root))

    (law: Ukrainian study of sawframe 2R63; factored forms: ours).

    Parameters
    ----------
    amplitude : float or array
        Half the stroke, m.
    mean : float or array
        Distance of mid-stroke from O, m; larger than the amplitude.
    guide_angle : float
        Direction of the guide from +x, rad.

    Raises
    ------
    ParameterError
        A value is not finite or positive, or the pitch curve does not go around O.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.CosineLaw(amplitude=0.3, mean=2.0)
    >>> round(float(cam.coupler_length), 8)  # the one with which a smooth cam exists
    2.02190518
    >>> saw = ks.cam_crank_slider(cam, cam.coupler_length, slider=ks.Link(600))
    >>> round(float(ks.solve(saw, 1.0, crank_speed=33.5).slider_position), 9)  # 2 + 0.3 cos(1)
    2.162090692
    """

    amplitude: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    mean: Annotated[Any, checks.Number("m", low=0.0, strict=True)]
    guide_angle: Annotated[Any, checks.Number("rad")] = 0.0

    ELEMENTWISE = True

    def _origin_problems(self):
        """Problem of designs whose slider would run over O."""
        mean, amplitude = self.mean, self.amplitude
        if checks.has_known_values(mean - amplitude) and np.any(over := mean <= amplitude):
            got = f"got mean {mean} m and amplitude {amplitude} m"
            yield checks.Problem(f"mean must exceed the amplitude, or the slider would run over O; {got}", over)

    RULES = checks.Rules("cosine-law cam", _origin_problems)

    @cached_property
    def _cosine(self):
        """c*, the positive root of 2 a c^2 + b c - a = 0, free of cancellation."""
        a, b = self.amplitude, self.mean
        return 2.0 * a / (b + sqrt(b * b + 8.0 * a * a))

    @cached_property
    def _quadratic(self):
        a, b, c = self.amplitude, self.mean, self._cosine
        p = 2.0 * a * (b + a * c)
        return a * a, p, (b - a) * (b + a) + 2.0 * c * p - (c * a) ** 2

    @property
    def lengths(self):
        """Lengths that define the pitch curve, m."""
        return (self.amplitude, self.mean)

    @property
    def smallest_radius(self):
        """Lower bound of the radius, m: 0.70 amplitudes, reached as the mean approaches the amplitude."""
        return 0.7 * self.amplitude

    @property
    def singular_angle(self):
        """Crank angle from the guide direction at which the coupler is perpendicular to the ray, rad."""
        return namespace(self._cosine).acos(self._cosine)

    @property
    def coupler_length(self):
        """The only coupler length for which the cam is smooth, m."""
        c = self._cosine
        return (self.mean + self.amplitude * c) * sqrt((1.0 - c) * (1.0 + c))

    def polar(self, angle, ray):
        ux, uy = ray_at(self.guide_angle)
        c, s = ray[0] * ux + ray[1] * uy, ray[1] * ux - ray[0] * uy
        a, b = self.amplitude, self.mean
        square, p, q = self._quadratic
        root = sqrt((square * c + p) * c + q)
        singular = self._cosine
        share = a * singular
        above = square * singular * c + square * (2.0 - 3.0 * singular * singular) - share * root
        g = above / (root + b + a * c)
        excess, k = g + share, a / root
        w = k * (c - singular)
        by_c = (w - 1.0) * g
        by_c_twice = k * g * (2.0 - w * (2.0 - g / root))
        return singular * root - c * excess, -s * by_c, s * s * by_c_twice - c * by_c


def __dir__():
    return __all__

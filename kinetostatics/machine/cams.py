"""Fixed cams, described by the pitch curve of the roller centre in polar form about O.

Every cam gives r(phi) with its first two derivatives, the pressure angle (between the cam normal and the crank ray)
and the curvature radius of the pitch curve. Each r is a smooth closed form or spline; none loses digits anywhere on
the turn.
"""

import math
import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from ..numbers.elementary import namespace, sqrt
from .crank import ray as ray_at

NOISE_IN_SECOND_DERIVATIVE = 16.0
"""Largest error of r'' that noise of 1 makes at points 1 apart: a standard deviation of 4.8, exceeded 3.3 times."""
LEFT_BY_BALANCING = 7.0
"""How many times inertia forces exceed what springs or counterweights leave of them."""


class Cam:
    """What follows from r, r', r'' for every cam. A cam is one method: ``polar(angle, ray) -> r, r', r''``."""

    def polar(self, angle, ray):
        raise TypeError(f"{type(self).__name__} must define polar(angle, ray)")

    def radius(self, phi):
        """Radius of the pitch curve and its derivatives.

        Parameters
        ----------
        phi : array
            Crank angle, rad.

        Returns
        -------
        r, r', r'' : tuple of arrays
            In m, m/rad, m/rad2.
        """
        phi = _array(phi)
        return self.polar(phi, ray_at(phi))

    def pressure_angle(self, phi):
        """Angle between the cam normal and the crank ray, atan(r'/r), rad; positive where the radius grows."""
        r, slope, _ = self.radius(phi)
        return namespace(r).atan(slope / r)

    def curvature_radius(self, phi):
        """Signed radius of curvature of the pitch curve, m; negative where it is hollow.

        (r^2 + r'^2)^(3/2) / (r^2 + 2 r'^2 - r r''), for a polar curve.
        """
        r, slope, second = self.radius(phi)
        square = r * r + slope * slope
        return square * sqrt(square) / (square + slope * slope - r * second)


def _array(phi):
    return np.asarray(phi, dtype=float) if isinstance(phi, int | float | list | tuple) else phi


@dataclass(frozen=True, eq=False, init=False)
class Circle(Cam):
    """Circular pitch curve around O.

    Parameters
    ----------
    radius : float or array
        Radius of the circle on which the roller centre runs, m.
    centre : (x, y)
        Centre relative to O, m; O lies inside.

    Raises
    ------
    ParameterError
        A value is not finite, the radius not positive, or O outside the circle.
    """

    pitch_radius: Any
    centre: Any

    ELEMENTWISE = True
    PATHS: ClassVar = {"pitch_radius": "radius"}

    def __init__(self, radius, centre=(0.0, 0.0)):
        object.__setattr__(self, "pitch_radius", radius)
        object.__setattr__(self, "centre", centre)
        self.RULES.admit(self)

    def _around_origin(self):
        """Say where O lies outside the circle, or on it."""
        (x, y), radius = self.centre, self.pitch_radius
        distance = sqrt(x * x + y * y)
        if checks.known(distance - radius) and np.any(distance >= radius):
            text = (
                f"O must lie inside the pitch circle, but its centre is {np.max(distance):.6g} m from O and its radius "
                f"{np.min(radius):.6g} m; bring the centre nearer or enlarge the radius"
            )
            yield checks.Problem(text, distance >= radius)

    RULES = checks.Rules(
        "circle cam",
        _around_origin,
        pitch_radius=checks.Number("m", "radius", low=0.0, strict=True),
        centre=checks.Pair("m"),
    )

    @property
    def lengths(self):
        """What the pitch curve is made of, m."""
        return (self.pitch_radius, *self.centre)

    @property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O, m."""
        x, y = self.centre
        return self.pitch_radius - sqrt(x * x + y * y)

    def polar(self, angle, ray):
        x, y = self.centre
        along = x * ray[0] + y * ray[1]
        across = y * ray[0] - x * ray[1]
        root = sqrt((self.pitch_radius - across) * (self.pitch_radius + across))
        r = along + root
        lean = across / root
        slope = lean * r
        return r, slope, lean * slope - along * (1.0 + lean * lean) * r / root


@dataclass(frozen=True, eq=False)
class CosineLaw(checks.Checked, Cam):
    """Cam that moves the slider exactly by x_B = mean + amplitude cos(phi) along a guide through O.

    A lies on the ray at the distance of the coupler length L from B, so r = x_B cos(phi) - w, where w is the signed
    root of L^2 - x_B^2 sin(phi)^2. The two branches of the root join smoothly for one length only, L = max of
    x_B sin(phi), reached at the singular angle phi*. Then the radicand has the double zero cos(phi) = cos(phi*) and,
    divided by it, is a quadratic: with c = cos(phi), c* = cos(phi*), amplitude a, mean b

        w = (c - c*) sqrt(a^2 c^2 + p c + q),   p = 2 a (b + a c*),   q = b^2 - a^2 + 2 c* p - c*^2 a^2

    Nor do x_B cos(phi) and w, both much larger than r, have to be subtracted: with b c* = a - 2 a c*^2

        r = c* root - c d,   d = root - x_B = a^2 (2 c* c + 3 - 5 c*^2) / (root + x_B)

    in which nothing cancels. So do the derivatives by c, with g = d - a c*, k = a / root and w = k (c - c*):

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
    """

    amplitude: Any
    mean: Any
    guide_angle: Any = 0.0

    ELEMENTWISE = True

    def _clear_of_origin(self):
        """Say where the slider would run over O."""
        mean, amplitude = self.mean, self.amplitude
        if checks.known(mean - amplitude) and np.any(mean <= amplitude):
            text = (
                f"mean must exceed the amplitude, or the slider would run over O; got mean {mean} m and amplitude "
                f"{amplitude} m"
            )
            yield checks.Problem(text, mean <= amplitude)

    RULES = checks.Rules(
        "cosine-law cam",
        _clear_of_origin,
        amplitude=checks.Number("m", low=0.0, strict=True),
        mean=checks.Number("m", low=0.0, strict=True),
        guide_angle=checks.Number("rad"),
    )

    @cached_property
    def _cosine(self):
        """c* by the root of 2 a c^2 + b c - a = 0 that does not cancel."""
        a, b = self.amplitude, self.mean
        return 2.0 * a / (b + sqrt(b * b + 8.0 * a * a))

    @cached_property
    def _quadratic(self):
        a, b, c = self.amplitude, self.mean, self._cosine
        p = 2.0 * a * (b + a * c)
        return a * a, p, (b - a) * (b + a) + 2.0 * c * p - (c * a) ** 2

    @property
    def lengths(self):
        """What the pitch curve is made of, m."""
        return (self.amplitude, self.mean)

    @property
    def smallest_radius(self):
        """A bound of the distance of the roller centre from O, m: 0.70 amplitudes, where the mean is as small as it."""
        return 0.7 * self.amplitude

    @property
    def singular_angle(self):
        """Crank angle from the guide direction at which the coupler is perpendicular to the ray, rad."""
        return namespace(self._cosine).acos(self._cosine)

    @property
    def coupler_length(self):
        """The one coupler length for which the law can be met, m."""
        c = self._cosine
        return (self.mean + self.amplitude * c) * sqrt((1.0 - c) * (1.0 + c))

    def polar(self, angle, ray):
        ux, uy = ray_at(self.guide_angle)
        c, s = ray[0] * ux + ray[1] * uy, ray[1] * ux - ray[0] * uy
        a, b = self.amplitude, self.mean
        square, p, q = self._quadratic
        root = sqrt((square * c + p) * c + q)
        singular = self._cosine
        excess = square * (2.0 * singular * c + 3.0 - 5.0 * singular * singular) / (root + b + a * c)
        g, k = excess - a * singular, a / root
        w = k * (c - singular)
        by_c = (w - 1.0) * g
        by_c_twice = k * g * (2.0 - w * (2.0 - g / root))
        return singular * root - c * excess, -s * by_c, s * s * by_c_twice - c * by_c


@dataclass(frozen=True, eq=False, init=False)
class Sampled(Cam):
    """Cam from a table of angles and radii, by a periodic quintic spline through the points.

    The spline has four continuous derivatives, so accelerations and forces are smooth.

    Parameters
    ----------
    angle : array (N,)
        Rad, rising, within one turn, end excluded; need not be evenly spaced.
    radius : array (N,)
        Radii of the pitch curve, m.

    Raises
    ------
    ParameterError
        Fewer than 8 points, angles not rising or more than one turn, a radius not positive or not finite.

    Warns
    -----
    UserWarning
        The table is too coarse or too noisy: `force_error` is a hundredth or more.
    """

    angle: Any
    samples: Any

    TABULATED = True

    def __init__(self, angle, radius):
        checks.require("sampled cam", checks.table("angle", angle), checks.table("radius", radius))
        angle, samples = (np.array(values, dtype=float) for values in (angle, radius))
        checks.require(
            "sampled cam",
            None if angle.ndim == 1 and angle.shape == samples.shape else "angle and radius must be 1-D, of one length",
            None if samples.min(initial=np.inf) > 0 else f"radius must be greater than 0, got {samples.min():g}",
            None if angle.size >= 8 else f"at least 8 points are needed, got {angle.size}",
        )
        step = np.diff(angle)
        if np.any(step <= 0):
            row = int(np.argmax(step <= 0)) + 1
            raise ParameterError(
                f"sampled cam: angles must rise, but row {row + 1} ({angle[row]:.6g} rad) follows {angle[row - 1]:.6g}"
            )
        if angle[-1] - angle[0] >= 2 * np.pi * (1 - 1e-12):
            raise ParameterError(
                "sampled cam: angles must stay within one turn, end excluded; they span "
                f"{angle[-1] - angle[0]:.9g} rad (2 pi = 6.28318531); leave the repeated last point out"
            )
        gap = max(step.max(), angle[0] + 2 * np.pi - angle[-1])
        if gap > np.pi / 4:
            raise ParameterError(
                f"sampled cam: the table must cover the turn, but leaves a gap of {np.degrees(gap):.4g} deg between "
                "neighbouring angles (45 at most)"
            )
        for name, values in (("angle", angle), ("samples", samples)):
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        self._warn_if_uncertain()

    @classmethod
    def from_csv(cls, path):
        """Read a table with two columns headed like ``angle [deg], radius [mm]``; any unit of angle and length."""
        from ..numbers.files import read_columns

        return cls(*read_columns(path, {"angle": "rad", "radius": "m"}))

    @property
    def lengths(self):
        """What the pitch curve is made of, m: its largest radius."""
        return (self.samples.max(),)

    @property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O in the table, m."""
        return self.samples.min()

    @cached_property
    def _splines(self):
        spline = _periodic_spline(self.angle, self.samples)
        return spline, spline.derivative(), spline.derivative(2)

    def polar(self, angle, ray):
        return tuple(spline(angle) for spline in self._splines)

    @cached_property
    def noise(self):
        """Standard deviation of the radii about a smooth curve, m; of radii rounded to a step, 0.29 of it.

        From what each radius differs by from the polynomial through its neighbours, for the number of neighbours that
        explains the table best.
        """
        return min(_roughness(self.angle, self.samples, reach) for reach in range(2, 7) if 2 * reach < self.angle.size)

    @cached_property
    def second_derivative_error(self):
        """Expected largest error of r'' over the turn, m/rad2, from noise and coarseness of the table.

        Half of the points tell r'' too, and worse: by the noise that shows in the spline through all of them, and by
        2^4 times its truncation. So their difference bounds both, and a twelfth of it the truncation (a fifteenth, and
        something for coarse tables); where it is more than `noise` can cause, the rest is truncation.
        """
        nodes = np.append(self.angle, self.angle[0] + 2 * np.pi)
        places = np.append(nodes[:-1], nodes[:-1] + np.diff(nodes) / 2)
        coarse = _periodic_spline(self.angle[::2], self.samples[::2]).derivative(2)
        difference = float(np.max(np.abs(self._splines[2](places) - coarse(places))))
        caused = NOISE_IN_SECOND_DERIVATIVE * self.noise / np.diff(nodes).min() ** 2
        return min(difference, caused + difference / 12)

    @cached_property
    def force_error(self):
        """Expected largest error of a force, relative to its largest value, from noise and coarseness of the table.

        The error of the acceleration of the roller centre, relative to its largest value over the turn at even speed,
        is that of inertia forces. Springs or counterweights that balance them leave a fraction, but the error whole:
        the figure is for a machine in which they leave a seventh, and on the safe side for others.
        """
        r, slope, second = (spline(self.angle) for spline in self._splines)
        error = self.second_derivative_error
        scale = max(np.max(np.hypot(second - r, 2 * slope)) - error, np.max(r))
        return LEFT_BY_BALANCING * error / float(scale)

    def _warn_if_uncertain(self):
        if self.force_error >= 0.01:
            warnings.warn(
                f"sampled cam: {self.angle.size} points are too coarse or too noisy: r'' is uncertain by up to "
                f"{self.second_derivative_error:.2g} m (the radii scatter by {self.noise:.2g} m about a smooth curve), "
                f"and forces by up to {self.force_error:.1%} where inertia is balanced; measure more exactly, write "
                "more digits or smooth the table",
                stacklevel=3,
            )


def _roughness(angle, radius, reach):
    """Root mean square of what each radius differs by from the polynomial through `reach` neighbours on both sides.

    In units of one radius: what independent noise of that size in every radius would give.
    """
    size = angle.size
    steps = [step for step in range(-reach, reach + 1) if step]
    places = {step: np.arange(size) + step for step in steps}
    ahead = {step: angle[place % size] + 2 * np.pi * (place // size) - angle for step, place in places.items()}
    rest, gain = radius.copy(), np.ones(size)
    for step in steps:
        weight = math.prod(ahead[other] / (ahead[other] - ahead[step]) for other in steps if other != step)
        rest -= weight * radius[places[step] % size]
        gain += weight * weight
    return float(np.sqrt(np.mean(rest * rest / gain)))


def _periodic_spline(angle, radius):
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(
        np.append(angle, angle[0] + 2 * np.pi), np.append(radius, radius[0]), k=5, bc_type="periodic"
    )

"""Cams: radius, pressure angle and curvature of the pitch curve; and the cam whose radius is a Fourier series.

With r(phi) the radius of the pitch curve, the pressure angle is atan(r' / r), and the curvature
(r^2 + 2 r'^2 - r r'') / (r^2 + r'^2)^(3/2). Lengths in m, derivatives by the crank angle phi in rad.
"""

from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import Annotated, Any

import numpy as np

from ...numbers import checks
from ...numbers.arithmetic import atan
from ...numbers.planar import minus, plus, polar_curvature, product, rotate, rotate_back
from ..crank import ray as ray_at
from ..links import present


class Cam:
    """Base of all cams. A cam is one method: ``polar(angle, ray) -> r, r', r''``.

    Examples
    --------
    Your own cam: r = 0.3 m + 5 mm cos(2 phi).

    >>> import kinetostatics as ks
    >>> class Oval(ks.cams.Cam):
    ...     def polar(self, angle, ray):
    ...         cosine, sine = ray[0] ** 2 - ray[1] ** 2, 2.0 * ray[0] * ray[1]
    ...         return 0.3 + 0.005 * cosine, -0.01 * sine, -0.02 * cosine
    >>> cam = Oval()
    >>> round(float(cam.curvature_radius(0.0)), 6), round(cam.base_radius(0.5), 6)  # m
    (0.286231, 0.013975)
    """

    knots: Any = ()
    """Crank angles at which the second derivative of the radius kinks or jumps, each a `Breakpoint`."""
    flat: Any = False
    """Whether its follower has a flat face instead of a roller."""

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
        phi = checks.to_plain_named("cam", "crank angle", phi, "rad")
        phi = np.asarray(phi, dtype=float) if isinstance(phi, int | float | list | tuple) else phi
        return self.polar(phi, ray_at(phi))

    def pressure_angle(self, phi):
        """Pressure angle atan(r'/r) between cam normal and crank ray, rad; positive where the radius grows."""
        r, slope, _ = self.radius(phi)
        return atan(slope / r)

    def curvature_radius(self, phi):
        """Signed radius of curvature of the pitch curve, m; negative where the curve is hollow."""
        return 1.0 / polar_curvature(*self.radius(phi))

    def profile(self, roller_radius, angle, side="disk"):
        """Working curve for a roller.

        Parameters
        ----------
        roller_radius : float
            m; None for the cam of a flat face, which touches the pitch curve itself.
        angle : int or array
            Crank angles, rad; an int is their count over the turn.
        side : "disk" or "ring"
            A disk lies inside the pitch curve, and the roller runs around it; a ring lies outside.

        Returns
        -------
        Profile
            Roller centres, working curve, normals, pressure angle, curvature; ``.cutter_path(radius)`` of a cutter
            other than the roller, ``.exceeded(pressure_angle=..., curvature_radius=...)`` of limits.

        Raises
        ------
        ParameterError
            The roller undercuts the cam or cuts into another part of it, with the crank angles and the radius; the
            pitch curve does not go around O.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> made = ks.cams.Circle(0.2, (0.02, 0.0)).profile(0.03, 360)
        >>> round(float(made.curvature_radius[7]), 12)
        0.17
        """
        from .profile import profile

        return profile(self, roller_radius, angle, side)

    def base_radius(self, pressure_angle):
        """Smallest base circle radius, m, that keeps the pressure angle below a limit (rad) for the same rise.

        The result is min(r + c) with c = max(abs(r') / tan(pressure_angle) - r), for a follower on the crank
        ray. The mechanism with this cam has another stroke and another coupler length.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> import numpy as np
        >>> round(ks.cams.CosineLaw(0.3, 2.0).base_radius(np.radians(30.0)), 4)
        0.02
        """
        from .profile import POSITIVE, highest, lowest

        rule = {**POSITIVE, "high": np.pi / 2}
        largest = checks.single_numbers("base_radius", pressure_angle=(pressure_angle, "rad", rule))["pressure_angle"]

        def lacking(angle):
            r, slope, _ = self.radius(angle)
            return np.abs(slope) / np.tan(largest) - r

        return lowest(lambda angle: self.radius(angle)[0], self).value + highest(lacking, self).value

    def export(
        self, path, *, roller_radius=None, cutter_radius=None, points=3600, units="mm", side="disk", clockwise=False
    ):
        """Write the cam for the workshop; the suffix selects a 1:1 drawing (.svg), a table (.csv) or .dxf.

        Parameters
        ----------
        path : path
            The file is written whole or not at all.
        roller_radius : float
            m; None for the cam of a flat face.
        cutter_radius : float, optional
            Radius of a cutter other than the roller, m; its path is then written too.
        points : int
            Number of points, evenly over the crank angle from the zero mark.
        units : "mm", "cm", "m" or "in"
            Unit of lengths in the file.
        side : "disk" or "ring"
            As for `profile`.
        clockwise : bool
            Sense in which the roller goes around the cam, shown on drawings; crank angles count counter-clockwise
            either way.

        Raises
        ------
        ParameterError
            The roller undercuts the cam, or the cutter does not fit into a hollow of it.
        FileError
            The suffix is not supported, or the file cannot be written.
        MissingLibraryError
            .dxf needs ezdxf (extra `workshop`).

        Examples
        --------
        >>> import kinetostatics as ks
        >>> import tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "cam.csv"
        >>> ks.cams.CosineLaw(0.3, 2.0).export(path, roller_radius=0.05)
        >>> print(path.read_text().splitlines()[0])
        # cam for the workshop: disk, roller radius 50 mm, 3600 points
        """
        from .export import export

        export(self, path, roller_radius, cutter_radius, points, units, side, clockwise)


RADIUS_ANGLES = np.linspace(0.0, 2 * np.pi, 720, endpoint=False)
"""Crank angles at which the search for smallest radius and sharpest curvature samples the cam, rad."""


@dataclass(frozen=True, eq=False)
class Harmonic(checks.Checked, Cam):
    """Cam whose radius is a Fourier series of the crank angle from the guide.

    r = a0 + a1 cos(psi) + a2 cos(2 psi) + ... + b1 sin(psi) + b2 sin(2 psi) + ...,  psi = phi - guide_angle

    Zero harmonics cost no time; the parameter paths of the others are "cam.cosine.2", "cam.sine.1".

    Parameters
    ----------
    cosine : sequence of float or array
        a0, a1, a2, ... in m; the mean radius a0 is greater than 0.
    sine : sequence of float or array
        b1, b2, ... in m.
    guide_angle : float
        Direction from +x at which psi is zero, rad.

    Raises
    ------
    ParameterError
        A value is not finite, or the mean radius not positive; when a scene is solved: the radius falls to 0.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> cam = ks.cams.Harmonic(cosine=(0.3, 0.02), sine=(0.0, 0.005))
    >>> [round(float(part), 6) for part in cam.radius(0.0)]
    [0.32, 0.01, -0.02]
    """

    cosine: Annotated[Any, checks.Series("m", letter="a", first=checks.Number("m", low=0.0, strict=True))]
    sine: Annotated[Any, checks.Series("m", letter="b", start=1)] = ()
    guide_angle: Annotated[Any, checks.Number("rad")] = 0.0

    ELEMENTWISE = True
    RULES = checks.Rules("harmonic cam")

    @property
    def lengths(self):
        """Lengths that define the pitch curve, m."""
        return (*self.cosine, *self.sine)

    @property
    def smallest_radius(self):
        """Smallest distance of the roller centre from O at 120 crank angles, m."""
        angles = RADIUS_ANGLES[::6]
        return np.min(self.polar(angles, ray_at(angles))[0])

    def polar(self, angle, ray):
        mean, farther, slope, second = self.about_mean(angle, ray)
        return mean + farther, slope, second

    def about_mean(self, angle, ray):
        """Mean radius, r less the mean radius, r' and r'', m.

        Sines and cosines of the harmonics follow by recursion. The sums start at the highest harmonics, mostly the
        smallest, so that little is lost by rounding.
        """
        psi = ray if present(self.guide_angle) is None else rotate_back(ray, ray_at(self.guide_angle))
        mean, *even = self.cosine
        terms, wave = [], psi
        for order in range(1, 1 + max(len(even), len(self.sine))):
            a, b = (present(part[order - 1]) if order <= len(part) else None for part in (even, self.sine))
            if a is not None or b is not None:
                cosine, sine = wave
                term = plus(product(a, cosine), product(b, sine))
                slope = float(order) * minus(product(b, cosine), product(a, sine))
                terms.append((term, slope, float(-order * order) * term))
            wave = rotate(wave, psi)
        found = (reduce(add, reversed(parts)) for parts in zip(*terms, strict=True))
        return mean, *(found if terms else [0.0 * psi[0]] * 3)

"""What every cam has: pressure angle and curvature of the pitch curve, from its radius and derivatives."""

import numpy as np

from ..numbers import checks
from ..numbers.arithmetic import atan
from ..numbers.planar import polar_curvature
from .crank import ray as ray_at


class Cam:
    """What follows from r, r', r'' for every cam. A cam is one method: ``polar(angle, ray) -> r, r', r''``.

    Examples
    --------
    A cam of one's own: r = 0.3 m + 5 mm cos(2 phi).

    >>> import kinetostatics as ks
    >>> class Oval(ks.cams.Cam):
    ...     def polar(self, angle, ray):
    ...         cosine, sine = ray[0] ** 2 - ray[1] ** 2, 2.0 * ray[0] * ray[1]
    ...         return 0.3 + 0.005 * cosine, -0.01 * sine, -0.02 * cosine
    >>> cam = Oval()
    >>> round(float(cam.curvature_radius(0.0)), 6), round(cam.base_radius(0.5), 6)  # m
    (0.286231, 0.013975)
    """

    @property
    def knots(self) -> tuple:
        """Where its second derivative bends or jumps, each a `Knot`."""
        return ()

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
        return atan(slope / r)

    def curvature_radius(self, phi):
        """Signed radius of curvature of the pitch curve, m; negative where it is hollow."""
        return 1.0 / polar_curvature(*self.radius(phi))

    def profile(self, roller_radius, angle, side="disk"):
        """Working curve for a roller.

        Parameters
        ----------
        roller_radius : float
            m.
        angle : int or array
            Crank angles, rad; a whole number is a count of them over the turn.
        side : "disk" or "ring"
            Whether the cam lies inside the pitch curve, so that the roller runs around it, or outside.

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
        """Smallest base circle with which the same rise keeps to a largest pressure angle, rad; m.

        That of r + c, with c = max(abs(r') / tan(pressure_angle) - r): a follower on the crank ray. The mechanism of
        such a cam has another stroke and another coupler.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> import numpy as np
        >>> round(ks.cams.CosineLaw(0.3, 2.0).base_radius(np.radians(30.0)), 4)
        0.02
        """
        from .profile import base_radius

        return base_radius(self, pressure_angle)

    def export(self, path, *, roller_radius, cutter_radius=None, points=3600, units="mm", side="disk", clockwise=False):
        """Write the cam for the workshop: by the path's ending a drawing 1:1 (.svg), a table (.csv) or a .dxf.

        Parameters
        ----------
        path : path
            Its file is written whole or not at all.
        roller_radius : float
            m.
        cutter_radius : float, optional
            m; of a cutter other than the roller, whose path is then given too.
        points : int
            So many, evenly over the crank angle, from its zero mark on.
        units : "mm", "cm", "m" or "in"
            Of what is written.
        side : "disk" or "ring"
            As for `profile`.
        clockwise : bool
            The sense in which the roller goes around the cam, shown on drawings; crank angles are counted counter-
            clockwise all the same.

        Raises
        ------
        ParameterError
            The roller undercuts the cam, or the cutter does not fit into a hollow of it.
        FileError
            The ending is another, or the file cannot be written.
        MissingLibraryError
            A .dxf without ezdxf (extra `workshop`).

        Examples
        --------
        >>> import kinetostatics as ks
        >>> import tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "cam.csv"
        >>> ks.cams.CosineLaw(0.3, 2.0).export(path, roller_radius=0.05)
        >>> print(path.read_text().splitlines()[0])
        # cam for the workshop: disk, roller radius 50 mm, 3600 points
        """
        from .workshop import export

        export(self, path, roller_radius, cutter_radius, points, units, side, clockwise)


def _array(phi):
    phi = checks.converted("cam", "crank angle", phi, "rad")
    return np.asarray(phi, dtype=float) if isinstance(phi, int | float | list | tuple) else phi

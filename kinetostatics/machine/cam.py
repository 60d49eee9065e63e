"""What every cam has: pressure angle and curvature of the pitch curve, from its radius and derivatives."""

import numpy as np

from ..numbers.elementary import namespace, sqrt
from .crank import ray as ray_at


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

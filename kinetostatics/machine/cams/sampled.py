"""Cam from a table of angles and radii: an interpolating or smoothing spline, and the expected error of forces."""

import numpy as np

from ...errors import NotGivenError
from ...numbers import checks
from ...numbers.arithmetic import is_foreign_array
from ..laws.turn_table import TurnTable
from .cam import Cam


class Sampled(TurnTable, Cam):
    """Cam from a table of angles and radii, by a periodic quintic spline.

    The spline has four continuous derivatives, so accelerations and forces are smooth. It passes through every point;
    with a stated noise of the radii it is the smoothest spline (FITPACK's) that differs from them by that noise.

    Parameters
    ----------
    angle : array (N,)
        rad, rising, within one turn, end excluded; spacing may vary.
    radius : array (N,)
        Radii of the pitch curve, m.
    noise : float, optional
        Standard deviation of the radii, m; for radii rounded to a step, 0.29 of the step.

    Raises
    ------
    ParameterError
        Fewer than 8 points, angles not rising or beyond one turn, a radius not positive or not finite, noise smaller
        than any smooth curve through the radii allows.

    Warns
    -----
    UserWarning
        The table is too coarse or too noisy: `force_error` is 0.01 or more. Or the stated noise is more than three
        times the scatter of the radii, or less than a third.

    Examples
    --------
    Radii rounded to 1 um, read as they are and smoothed:

    >>> import warnings
    >>> import kinetostatics as ks
    >>> import numpy as np
    >>> angle = np.radians(np.arange(360))
    >>> radius = np.round(ks.cams.CosineLaw(0.3, 2.0).radius(angle)[0], 6)
    >>> with warnings.catch_warnings(action="ignore"):
    ...     rough = ks.cams.Sampled(angle, radius)
    >>> smooth = ks.cams.Sampled(angle, radius, noise=0.29e-6)
    >>> f"{rough.force_error:.0%}, {smooth.force_error:.2%}"
    '23%, 0.04%'
    """

    OWNER, VALUE, VALUES, SECOND, LOW = "sampled cam", "radius", "radii", "r''", 0.0
    TABULATED = True
    RULES = checks.Rules("sampled cam")  # no number of it is a parameter by itself

    def __init__(self, angle, radius, noise=None):
        super().__init__(angle, radius, noise)

    def __repr__(self):
        way = "through" if self.smoothing is None else f"smoothed by {self.smoothing:.3g} m from"
        return f"<Sampled cam {way} {self.angle.size} points, forces within {self.force_error:.2g} of the largest>"

    @classmethod
    def from_csv(cls, path, noise=None) -> "Sampled":
        """Read a table with two columns headed like ``angle [deg], radius [mm]``; any unit of angle and length.

        Parameters
        ----------
        path : str or path
            Comments at the top of the file begin with ``#``.
        noise : float, optional
            As for the cam itself, m.

        Raises
        ------
        CaseError
            The file cannot be read, or its rows make no table.

        Examples
        --------
        >>> import tempfile
        >>> from pathlib import Path
        >>> import numpy as np
        >>> import kinetostatics as ks
        >>> angle = np.arange(0.0, 360.0, 5.0)
        >>> radius = 300.0 - 20.0 * np.cos(np.radians(angle))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = Path(folder, "measured.csv")
        ...     np.savetxt(path, np.c_[angle, radius], header="angle [deg], radius [mm]", delimiter=",", comments="")
        ...     cam = ks.cams.Sampled.from_csv(path)
        >>> round(float(cam.radius(0.0)[0]), 9)  # m
        0.28
        """
        from ...numbers.files import read_columns

        angle, radius = read_columns(path, {"angle": "rad", "radius": "m"})
        return cls(angle, radius, noise)

    @property
    def samples(self):
        """Radii of the table, m: its `values`."""
        return self.values

    @property
    def lengths(self):
        """Length that defines the pitch curve, its largest radius, m."""
        return (self.values.max(),)

    @property
    def smallest_radius(self):
        """Smallest radius in the table, m."""
        return self.values.min()

    def polar(self, angle, ray):
        try:
            return tuple(spline(angle) for spline in self.splines[:3])
        except TypeError as error:
            if not is_foreign_array(angle):
                raise
            raise NotGivenError(
                "a sampled cam is read by a spline of SciPy's, which cannot take crank angles without values, as under "
                'jax.jit. The call ks.compile(scene, ..., engine="jax") reads it beforehand; or give a cam with a law'
            ) from error

    def _largest_acceleration(self):
        """Largest acceleration of the roller centre at constant speed, less its error, m/rad2; at least its radius."""
        r, slope, second = (spline(self.angle) for spline in self.splines[:3])
        largest = np.max(np.hypot(second - r, 2 * slope)) - self.second_derivative_error
        return max(largest, np.max(r))

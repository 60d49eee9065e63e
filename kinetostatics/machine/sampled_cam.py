"""A cam from a table: a spline through its points, and how far the table can be trusted."""

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..numbers import checks
from ..numbers.lazy import cached_property
from .cam import Cam

NOISE_IN_SECOND_DERIVATIVE = 16.0
"""Largest error of r'' that noise of 1 makes at points 1 apart: a standard deviation of 4.8, exceeded 3.3 times."""
LEFT_BY_BALANCING = 7.0
"""How many times inertia forces exceed what springs or counterweights leave of them."""


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
        """Read a table with two columns headed like ``angle [deg], radius [mm]``; any unit of angle and length.

        Before the heading there may be lines of comment that begin with ``#``.
        """
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

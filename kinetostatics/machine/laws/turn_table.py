"""Value over the turn from a table, by a periodic quintic spline, with the expected error of its second derivative.

The spline interpolates the points, or is the smoothest within their stated noise. The error follows from the scatter of
the points and the coarseness of the table.
"""

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property

NOISE_IN_SECOND_DERIVATIVE = 16.0
"""Largest error of r'' from noise 1 at points 1 apart: 3.3 times its standard deviation of 4.8."""
SPLINE_DEGREE = 5
BALANCING_RATIO = 7.0
"""Ratio of inertia forces to the rest that springs or counterweights leave."""
NOISE_TRIALS = 6
"""Number of tables with random noise of the same size that estimate the error of a smoothed table."""
MAX_NOISE_RATIO = 3.0
"""Largest ratio of the stated noise to the scatter of the table, or the reverse, without a warning."""


@dataclass(frozen=True, eq=False, init=False, repr=False)
class TurnTable:
    """Values at angles within a turn, base of cams and laws from tables. `smoothing` is the noise, None to interpolate.

    `OWNER`, `VALUE`, `VALUES` and `SECOND` are words of messages; the values must exceed `LOW`.
    """

    angle: np.ndarray
    values: np.ndarray
    smoothing: Any = None

    OWNER, VALUE, VALUES, SECOND, LOW = "table", "value", "values", "its second derivative", -math.inf

    def __init__(self, angle, values, noise=None):
        owner, name = self.OWNER, self.VALUE
        rules = {"angle": checks.Number("rad", table=True), name: checks.Number("m", table=True)}
        found = checks.check_values(owner, rules, {"angle": angle, name: values})
        angle, values = (np.array(part, dtype=float) for part in found.values())
        least = values.min(initial=np.inf)
        checks.require(
            owner,
            None if angle.ndim == 1 and angle.shape == values.shape else f"angle and {name} must be 1-D, of one length",
            None if least > self.LOW else f"{name} must be greater than {self.LOW:g}, got {least:g}",
            None if angle.size >= 8 else f"at least 8 points are needed, got {angle.size}",
        )
        checks.require(owner, _angle_problem(angle))
        if noise is not None:
            noise = checks.single_numbers(owner, noise=(noise, "m", {"low": 0.0, "strict": True}))["noise"]
        for part in (angle, values):
            part.setflags(write=False)
        vars(self).update(angle=angle, values=values, smoothing=noise)
        if noise is not None:
            self._test_noise()
        if self.force_error >= 0.01:
            remedy = ", or state their noise to have them smoothed" if noise is None else ""
            warnings.warn(
                f"{owner}: {angle.size} points are too coarse or too noisy. {self.SECOND} is uncertain by up to "
                f"{self.second_derivative_error:.2g} m (the {self.VALUES} scatter by {self.noise:.2g} m about a smooth "
                f"curve), and forces by up to {self.force_error:.1%} where inertia is balanced. Measure more exactly, "
                f"write more digits{remedy}",
                stacklevel=3,
            )

    def _test_noise(self):
        """Refuse a noise that no smooth curve keeps within; warn of one that differs from the scatter."""
        stated, scatter = self.smoothing, self.noise
        if self._fit(self.values) is None:
            raise ParameterError(
                f"{self.OWNER}: no smooth curve comes within a noise of {stated:.3g} m of the {self.VALUE} values, "
                f"which scatter by {scatter:.3g} m. State the noise that they have, or none to pass through every point"
            )
        if not scatter / MAX_NOISE_RATIO <= stated <= scatter * MAX_NOISE_RATIO:
            more = stated > scatter
            kept = "true features are smoothed away too" if more else "noise is left in the curve"
            warnings.warn(
                f"{self.OWNER}: the noise stated, {stated:.3g} m, is {'more' if more else 'less'} than the "
                f"{scatter:.3g} m by which the {self.VALUE} values scatter; {kept}",
                stacklevel=4,
            )

    @cached_property
    def splines(self):
        """The spline and its first three derivatives."""
        spline = _interpolate(self.angle, self.values) if self.smoothing is None else self._fit(self.values)
        return spline, *(spline.derivative(order) for order in (1, 2, 3))

    def _fit(self, values):
        """Smoothest spline within the stated noise of the values; None if there is none."""
        from scipy.interpolate import BSpline, splrep

        goal = values.size * self.smoothing**2
        (t, c, k), _, status, _ = splrep(
            *_periodic(self.angle, values), k=SPLINE_DEGREE, s=goal, per=True, full_output=1, quiet=1
        )
        return BSpline(t, c, k, extrapolate="periodic") if status <= 0 else None

    @cached_property
    def noise(self):
        """Standard deviation of the values from polynomials through neighbours, the least over their number."""
        angle, values, size, found = self.angle, self.values, self.angle.size, []
        for reach in range(2, min(7, (size + 1) // 2)):
            turns, place = np.divmod(np.arange(size) + np.delete(np.arange(-reach, reach + 1), reach)[:, None], size)
            ahead = angle[place] + 2 * np.pi * turns - angle
            others = [np.delete(ahead, step, axis=0) for step in range(2 * reach)]
            weights = np.array(
                [np.prod(other / (other - own), axis=0) for other, own in zip(others, ahead, strict=True)]
            )
            rest = np.subtract.reduce([values, *(weights * values[place])])
            gain = np.add.reduce([np.ones(size), *(weights * weights)])
            found.append(float(np.sqrt(np.mean(rest * rest / gain))))
        return min(found)

    @cached_property
    def second_derivative_error(self):
        """Expected largest error of the second derivative over the turn, from noise and coarseness of the table.

        The spline through every second point has 16 times the truncation error: a twelfth of the difference bounds it.
        """
        nodes, _ = _periodic(self.angle, self.values)
        places = np.append(nodes[:-1], nodes[:-1] + np.diff(nodes) / 2)
        second = self.splines[2](places)
        if self.smoothing is not None:
            random, smooth = np.random.default_rng(0), self.splines[0](self.angle)
            scatter = self.noise if self.smoothing * MAX_NOISE_RATIO < self.noise else self.smoothing
            tables = (smooth + random.normal(0.0, scatter, smooth.size) for _ in range(NOISE_TRIALS))
            fitted = [spline for spline in map(self._fit, tables) if spline is not None]
            errors = (float(np.max(np.abs(spline.derivative(2)(places) - second))) for spline in fitted)
            return 1.5 * max(errors, default=math.inf)
        coarse = _interpolate(self.angle[::2], self.values[::2]).derivative(2)
        difference = float(np.max(np.abs(second - coarse(places))))
        caused = NOISE_IN_SECOND_DERIVATIVE * self.noise / np.diff(nodes).min() ** 2
        return min(difference, caused + difference / 12)

    @cached_property
    def force_error(self):
        """Error of the acceleration, relative, times seven: balancing cancels inertia forces but not their error."""
        largest = self._largest_acceleration()
        return BALANCING_RATIO * self.second_derivative_error / float(largest) if largest > 0 else math.inf

    def _largest_acceleration(self):
        """Largest acceleration at constant speed, less its error, m/rad2."""
        return np.max(np.abs(self.splines[2](self.angle))) - self.second_derivative_error


def _angle_problem(angle):
    """Problem of the angles of a table, as a sentence, or None."""
    step, span = np.diff(angle), angle[-1] - angle[0]
    if np.any(step <= 0):
        row = int(np.argmax(step <= 0)) + 1
        return f"angles must rise, but row {row + 1} ({angle[row]:.6g} rad) follows {angle[row - 1]:.6g}"
    if span >= 2 * np.pi * (1 - 1e-12):
        return (
            f"angles must stay within one turn, end excluded; they span {span:.9g} rad (2 pi = 6.28318531); leave the "
            "repeated last point out"
        )
    gap = max(step.max(), angle[0] + 2 * np.pi - angle[-1])
    if gap > np.pi / 4:
        return (
            f"the table must cover the turn, but leaves a gap of {np.degrees(gap):.4g} deg between neighbouring angles "
            "(45 at most)"
        )
    return None


def _periodic(angle, values):
    """Angles and values with the first point repeated a turn later."""
    return np.append(angle, angle[0] + 2 * np.pi), np.append(values, values[0])


def _interpolate(angle, values):
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(*_periodic(angle, values), k=SPLINE_DEGREE, bc_type="periodic")

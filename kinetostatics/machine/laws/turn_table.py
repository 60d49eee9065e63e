"""A value over the turn from a table: a periodic quintic spline through its points, or as near as their noise allows.

A table says how far its second derivative can be trusted, from its own noise and coarseness.
"""

import math
import warnings
from dataclasses import dataclass

import numpy as np

from ...errors import ParameterError
from ...numbers import checks
from ...numbers.lazy import cached_property

NOISE_IN_SECOND_DERIVATIVE = 16.0
"""Largest error of r'' that noise of 1 makes at points 1 apart: a standard deviation of 4.8, exceeded 3.3 times."""
SPLINE_DEGREE = 5
BALANCING_RATIO = 7.0
"""How many times inertia forces exceed what springs or counterweights leave of them."""
NOISE_TRIALS = 6
"""Tables with other noise of the same size that tell how far a smoothed one can be trusted."""
MAX_NOISE_RATIO = 3.0
"""How many times the noise that a table shows may differ from the noise stated."""


@dataclass(frozen=True, eq=False)
class TurnTable:
    """Values at angles within a turn, made by `of`; `smoothing` is the noise stated, None: through every point."""

    angle: np.ndarray
    values: np.ndarray
    smoothing: float | None = None

    @classmethod
    def of(cls, owner, angle, values, name, smoothing=None, positive=False):
        """Table of values from outside; `name` is what errors call them.

        Raises
        ------
        ParameterError
            Fewer than 8 points, angles not rising or more than one turn, a gap, a value that is not finite.
        """
        rules = {"angle": checks.Number("rad", table=True), name: checks.Number("m", table=True)}
        found = checks.check_values(owner, rules, {"angle": angle, name: values})
        angle, values = (np.array(part, dtype=float) for part in found.values())
        low = values.min(initial=np.inf) if positive else np.inf
        checks.require(
            owner,
            None if angle.ndim == 1 and angle.shape == values.shape else f"angle and {name} must be 1-D, of one length",
            None if low > 0 else f"{name} must be greater than 0, got {low:g}",
            None if angle.size >= 8 else f"at least 8 points are needed, got {angle.size}",
        )
        step = np.diff(angle)
        if np.any(step <= 0):
            row = int(np.argmax(step <= 0)) + 1
            raise ParameterError(
                f"{owner}: angles must rise, but row {row + 1} ({angle[row]:.6g} rad) follows {angle[row - 1]:.6g}"
            )
        if angle[-1] - angle[0] >= 2 * np.pi * (1 - 1e-12):
            raise ParameterError(
                f"{owner}: angles must stay within one turn, end excluded; they span "
                f"{angle[-1] - angle[0]:.9g} rad (2 pi = 6.28318531); leave the repeated last point out"
            )
        gap = max(step.max(), angle[0] + 2 * np.pi - angle[-1])
        if gap > np.pi / 4:
            raise ParameterError(
                f"{owner}: the table must cover the turn, but leaves a gap of {np.degrees(gap):.4g} deg between "
                "neighbouring angles (45 at most)"
            )
        for part in (angle, values):
            part.setflags(write=False)
        if smoothing is not None:
            smoothing = checks.single_numbers(owner, noise=(smoothing, "m", {"low": 0.0, "strict": True}))["noise"]
        made = cls(angle, values, smoothing)
        made._check_noise(owner, name)
        return made

    def _check_noise(self, owner, name):
        """Refuse noise too small to be that of the table; warn of noise that is not what it shows."""
        if self.smoothing is None:
            return
        if self._fit(self.values) is None:
            raise ParameterError(
                f"{owner}: no smooth curve comes within a noise of {self.smoothing:.3g} m of the {name} values, which "
                f"scatter by {self.noise:.3g} m; state the noise that they have, or none to pass through every point"
            )
        if not self.noise / MAX_NOISE_RATIO <= self.smoothing <= self.noise * MAX_NOISE_RATIO:
            more = self.smoothing > self.noise
            warnings.warn(
                f"{owner}: the noise stated, {self.smoothing:.3g} m, is {'more' if more else 'less'} than the "
                f"{self.noise:.3g} m by which the {name} values scatter; "
                + ("what is no noise is smoothed away too" if more else "noise is left in the curve"),
                stacklevel=5,
            )

    @cached_property
    def splines(self):
        """The spline and its first three derivatives."""
        spline = _interpolate(self.angle, self.values) if self.smoothing is None else self._fit(self.values)
        return spline, *(spline.derivative(order) for order in (1, 2, 3))

    @property
    def _stated(self) -> float:
        return 0.0 if self.smoothing is None else self.smoothing

    def _fit(self, values):
        """Smoothest spline within the noise stated of the values; None where there is none."""
        from scipy.interpolate import BSpline, splrep

        goal = values.size * self._stated**2
        (t, c, k), _, status, _ = splrep(
            *_periodic(self.angle, values), k=SPLINE_DEGREE, s=goal, per=True, full_output=1, quiet=1
        )
        return BSpline(t, c, k, extrapolate="periodic") if status <= 0 else None

    @cached_property
    def noise(self):
        """Standard deviation of the values about a smooth curve; of values rounded to a step, 0.29 of it.

        From what each value differs by from the polynomial through its neighbours, for the number of neighbours that
        explains the table best.
        """
        return min(_roughness(self.angle, self.values, reach) for reach in range(2, 7) if 2 * reach < self.angle.size)

    @cached_property
    def second_derivative_error(self):
        """Expected largest error of the second derivative over the turn, from noise and coarseness of the table.

        Half of the points tell it too, and worse: by the noise that shows in the spline through all of them, and by
        2^4 times its truncation. So their difference bounds both, and a twelfth of it the truncation (a fifteenth, and
        something for coarse tables); where it is more than `noise` can cause, the rest is truncation. A smoothed table
        errs by what other noise of the same size makes of the smooth curve itself.
        """
        nodes, _ = _periodic(self.angle, self.values)
        places = np.append(nodes[:-1], nodes[:-1] + np.diff(nodes) / 2)
        second = self.splines[2](places)
        if self.smoothing is not None:
            return self._smoothing_error(places, second)
        coarse = _interpolate(self.angle[::2], self.values[::2]).derivative(2)
        difference = float(np.max(np.abs(second - coarse(places))))
        caused = NOISE_IN_SECOND_DERIVATIVE * self.noise / np.diff(nodes).min() ** 2
        return min(difference, caused + difference / 12)

    def force_error(self, largest):
        """Expected largest error of a force, relative to its largest value, from the `largest` acceleration by angle.

        The error of an acceleration, relative to the largest over the turn at even speed, is that of inertia forces.
        Springs or counterweights that balance them leave a fraction, but the error whole: the figure is for a machine
        in which they leave a seventh, and on the safe side for others.
        """
        return BALANCING_RATIO * self.second_derivative_error / float(largest) if largest > 0 else math.inf

    def warn_if_uncertain(self, owner, symbol, name, force_error):
        """Warn of a table that leaves forces uncertain by a hundredth or more."""
        if force_error >= 0.01:
            remedy = ", or state their noise to have them smoothed" if self.smoothing is None else ""
            warnings.warn(
                f"{owner}: {self.angle.size} points are too coarse or too noisy: {symbol} is uncertain by up to "
                f"{self.second_derivative_error:.2g} m (the {name} scatter by {self.noise:.2g} m about a smooth "
                f"curve), and forces by up to {force_error:.1%} where inertia is balanced; measure more exactly, "
                f"write more digits{remedy}",
                stacklevel=4,
            )

    def _smoothing_error(self, places, second):
        random, smooth = np.random.default_rng(0), self.splines[0](self.angle)
        scatter = self.noise if self._stated * MAX_NOISE_RATIO < self.noise else self._stated
        errors = []
        for _ in range(NOISE_TRIALS):
            fitted = self._fit(smooth + random.normal(0.0, scatter, smooth.size))
            if fitted is not None:
                errors.append(float(np.max(np.abs(fitted.derivative(2)(places) - second))))
        return 1.5 * max(errors, default=math.inf)


def _periodic(angle, values):
    """Angles and values with the first again behind the last."""
    return np.append(angle, angle[0] + 2 * np.pi), np.append(values, values[0])


def _roughness(angle, radius, reach):
    """Root mean square of what each value differs by from the polynomial through `reach` neighbours on both sides.

    In units of one value: what independent noise of that size in every value would give.
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


def _interpolate(angle, values):
    from scipy.interpolate import make_interp_spline

    return make_interp_spline(*_periodic(angle, values), k=SPLINE_DEGREE, bc_type="periodic")

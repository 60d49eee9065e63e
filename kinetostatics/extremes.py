"""True extrema of a result over the turn, found between samples by evaluating the mechanism itself."""

from dataclasses import dataclass

import numpy as np

from .errors import ParameterError
from .quantities import values

SAMPLES = 1440
"""Samples a turn in which extrema are bracketed; two extrema closer than a quarter degree may pass unseen."""
FLAT = 1e-13
"""Variation, relative to the largest value, below which a quantity is constant but for rounding."""
SAME = 1e-9
"""An extremum found this little before the end of the turn (rad) is the one at its start."""


@dataclass(frozen=True, eq=False)
class Extremes:
    """Extrema of one quantity over one turn, in order of crank angle.

    Attributes
    ----------
    quantity : str
    angle : array (K,)
        Crank angles in [0, 2 pi), rad.
    value : array (K,)
        Values of the quantity, SI.
    constant : float
        The value of a quantity that has no extremum because it does not change; NaN otherwise.
    """

    quantity: str
    angle: np.ndarray
    value: np.ndarray
    constant: float = np.nan

    @property
    def range(self):
        """Smallest and largest value over the turn; both are the constant if it has no extremum."""
        return (self.value.min(), self.value.max()) if len(self) else (self.constant, self.constant)

    @property
    def largest(self):
        """Value of largest magnitude over the turn, with its sign."""
        return max(self.range, key=abs)

    def __len__(self):
        return len(self.angle)

    def __repr__(self):
        rows = (f"{np.degrees(a):12.6f} deg  {v: .9g}" for a, v in zip(self.angle, self.value, strict=True))
        return "\n".join([f"{len(self)} extremes of {self.quantity}", *rows])


def extremes(solution, quantity):
    """All extrema of one quantity over the turn.

    Brackets come from samples a quarter of a degree apart; each extremum is then found by minimisation
    (scipy.optimize.elementwise) of the quantity evaluated by the mechanism itself. As a minimum fixes its place only
    to half the digits, the angle is last read from the slope of a Chebyshev fit through nearby evaluations, and kept
    if the value there is as good.

    Parameters
    ----------
    solution : Solution
        Of one design; its own crank angles do not matter.
    quantity : str or function
        A scalar attribute ("balancing_torque"), a joint (magnitude of its reaction), a vector attribute
        ("shaking_force": its magnitude), or a function of a solution that returns an array over its crank angles.

    Returns
    -------
    Extremes
        `.angle` and `.value` in order of angle; empty for a constant. Where the mechanism does not close, only extrema
        inside the closed intervals are reported.

    Raises
    ------
    QuantityError
        The solution has no such quantity.
    ParameterError
        The solution is a batch of designs, or depends on a table over its own crank angles.
    """

    def evaluate(angle):
        return values(solution.at(angle), quantity)

    grid = np.linspace(0.0, 2 * np.pi, SAMPLES + 1)[:-1]
    with np.errstate(invalid="ignore", divide="ignore"):
        samples = evaluate(grid)
        if samples.ndim != 1:
            raise ParameterError(
                f"extremes works on one design at a time, but {quantity!r} has shape {samples.shape}; solve a single "
                "design of the batch"
            )
        brackets, sign = _brackets(grid, samples)
        if not sign.size:
            return Extremes(str(quantity), np.empty(0), np.empty(0), float(np.fmax.reduce(samples)))
        angle = _polished(evaluate, _minimised(evaluate, brackets, sign), sign)
    angle = np.maximum(np.mod(angle + SAME, 2 * np.pi) - SAME, 0.0)
    order = np.argsort(angle)
    return Extremes(str(quantity), angle[order], evaluate(angle[order]))


def _brackets(grid, samples):
    """Three neighbouring angles around every extremum of the samples, and +1 for a minimum, -1 for a maximum."""
    finite = samples[np.isfinite(samples)]
    if not finite.size or np.ptp(finite) <= FLAT * np.max(np.abs(finite)):
        return np.empty((3, 0)), np.empty(0)
    step = grid[1] - grid[0]
    before, after = np.roll(samples, 1), np.roll(samples, -1)
    minimum = (samples < before) & (samples <= after)
    maximum = (samples > before) & (samples >= after)
    middle = grid[minimum | maximum]
    return np.array([middle - step, middle, middle + step]), np.where(minimum[minimum | maximum], 1.0, -1.0)


def _minimised(evaluate, brackets, sign):
    from scipy.optimize import elementwise

    found = elementwise.find_minimum(
        lambda angle, sign: sign * evaluate(angle),
        tuple(brackets),
        args=(sign,),
        tolerances={"xatol": 0.0, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
    )
    return np.where(np.isfinite(found.x), found.x, brackets[1])  # a bracket in rounding noise may not hold twice


def _polished(evaluate, angle, sign, half_width=0.01, degree=8):
    """Zero of the slope of a local Chebyshev fit, where its value is as good as the one it replaces."""
    from numpy.polynomial import chebyshev

    nodes = chebyshev.chebpts1(degree + 1)
    samples = evaluate((angle[:, None] + half_width * nodes).ravel()).reshape(angle.size, -1)
    series = chebyshev.chebfit(nodes, samples.T, degree)
    slope, bend = chebyshev.chebder(series), chebyshev.chebder(series, 2)
    place = np.zeros_like(angle)
    for _ in range(3):
        place -= _series(place, slope) / _series(place, bend)
    refined = np.where(np.abs(place) < 1e-3, angle + half_width * place, angle)
    rounding = 8 * np.finfo(float).eps * np.max(np.abs(samples), axis=1)
    return np.where(sign * evaluate(refined) <= sign * evaluate(angle) + rounding, refined, angle)


def _series(place, coefficients):
    """Value of each column's Chebyshev series at its own place."""
    from numpy.polynomial import chebyshev

    return chebyshev.chebval(place, coefficients, tensor=False)

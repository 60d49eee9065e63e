"""True extrema of a result over the turn, found between samples by evaluating the mechanism itself."""

from dataclasses import dataclass

import numpy as np

from . import checks
from .errors import ParameterError
from .quantities import scale, values

SAMPLES = 1440
"""Samples a turn in which extrema are bracketed; two extrema closer than a quarter degree may pass unseen."""
ROUNDING = 1e-13
"""Rise and fall, relative to the terms a quantity is made of, below which it is rounding and no extremum."""
SAME = 1e-9
"""An extremum found this little before the end of the turn (rad) is the one at its start."""
TURN = 2 * np.pi


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
    maximum : array (K,) of bool
        Whether each is a maximum.
    constant : float
        The value of a quantity that has no extremum because it does not change; NaN otherwise.
    """

    quantity: str
    angle: np.ndarray
    value: np.ndarray
    maximum: np.ndarray
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
    if the value there is as good. Where a load jumps, the extremum is that of the samples.

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
        `.angle` and `.value` in order of angle; empty for a constant, or what is constant but for rounding. Where the
        mechanism does not close, only extrema inside the closed intervals are reported.

    Raises
    ------
    QuantityError
        The solution has no such quantity.
    ParameterError
        The solution is a batch of designs, or depends on a table over its own crank angles.
    """
    checks.require("extremes", checks.solution("solution", solution), checks.quantity(quantity, function=True))

    def evaluate(angle):
        return values(solution.at(np.mod(angle, TURN)), quantity)

    grid = np.linspace(0.0, TURN, SAMPLES + 1)[:-1]
    with np.errstate(invalid="ignore", divide="ignore"):
        turn = solution.at(grid)
        samples = values(turn, quantity)
        if np.ndim(samples) != 1:
            raise ParameterError(
                f"extremes works on one design at a time, but {quantity!r} has shape {np.shape(samples)}; solve a "
                "single design of the batch"
            )
        floor = ROUNDING * max(scale(turn, quantity), float(np.fmax.reduce(np.abs(samples), initial=0.0)))
        steps, maximum = _turning_points(samples, floor)
        if not maximum.size:
            nothing = np.empty(0)
            return Extremes(str(quantity), nothing, nothing, nothing.astype(bool), float(np.fmax.reduce(samples)))
        sign = np.where(maximum, -1.0, 1.0)
        angle = _polished(evaluate, _minimised(evaluate, steps * (TURN / SAMPLES), sign), sign, floor)
    angle = np.maximum(np.mod(angle + SAME, TURN) - SAME, 0.0)
    order = np.argsort(angle)
    return Extremes(str(quantity), angle[order], evaluate(angle[order]), maximum[order])


def _turning_points(samples, floor):
    """Three steps of the grid around each extremum of periodic samples (3, K), and whether it is a maximum.

    The middle of a level stretch counts once. Rises and falls of no more than `floor` are taken out, least first.
    """
    direction = np.sign(np.roll(samples, -1) - samples)
    moving = np.flatnonzero(direction != 0)
    following = np.append(moving[1:], moving[:1] + samples.size)
    turning = direction[moving] * direction[following % samples.size] == -1
    before, after = moving[turning], following[turning]
    maximum = direction[before] > 0
    middle = (before + after + 1) // 2
    while middle.size and np.all(maximum != np.roll(maximum, 1)):
        height = samples[middle % samples.size]
        change = np.abs(np.roll(height, -1) - height)
        least = int(np.argmin(change))
        if change[least] > floor:
            break
        kept = np.delete(np.arange(middle.size), [least, (least + 1) % middle.size])
        before, after, middle, maximum = before[kept], after[kept], middle[kept], maximum[kept]
    return np.array([before, middle, after + 1], dtype=float), maximum


def _minimised(evaluate, brackets, sign):
    from scipy.optimize import elementwise

    found = elementwise.find_minimum(
        lambda angle, sign: sign * evaluate(angle),
        tuple(brackets),
        args=(sign,),
        tolerances={"xatol": 0.0, "xrtol": 0.0, "fatol": 0.0, "frtol": 0.0},
    )
    better = sign * evaluate(found.x) <= sign * evaluate(brackets[1])  # False where no bracket held, as at a jump
    return np.where(better, found.x, brackets[1])


def _polished(evaluate, angle, sign, floor, half_width=0.01, degree=8):
    """Zero of the slope of a local Chebyshev fit, where its value is as good as the one it replaces."""
    from numpy.polynomial import chebyshev

    nodes = chebyshev.chebpts1(degree + 1)
    samples = evaluate((angle[:, None] + half_width * nodes).ravel()).reshape(angle.size, -1)
    series = chebyshev.chebfit(nodes, np.nan_to_num(samples).T, degree)
    slope, bend = chebyshev.chebder(series), chebyshev.chebder(series, 2)
    place = np.zeros_like(angle)
    for _ in range(3):
        place -= _series(place, slope) / _series(place, bend)
    refined = np.where(np.abs(place) < 1e-3, angle + half_width * place, angle)
    return np.where(sign * evaluate(refined) <= sign * evaluate(angle) + 0.1 * floor, refined, angle)


def _series(place, coefficients):
    """Value of each column's Chebyshev series at its own place."""
    from numpy.polynomial import chebyshev

    return chebyshev.chebval(place, coefficients, tensor=False)

"""Counterweights that minimise a norm of the shaking force, by numerical search."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import magnitude
from ..results.extremes import extremes
from ..solution.solution import Solution
from .counterweights import Balanced, Counterweight, across_guide, along_guide, counterweight

PEAK_NORMS = ("largest", "along", "across")
"""Norms that are a largest value over the turn."""


@dataclass(frozen=True, eq=False)
class ShakingSearch:
    """Norm of the shaking force over unbalances of counterweights, relative to the largest static moment.

    Attributes
    ----------
    mechanism : Mechanism
    norm : str
    weights : (float, float)
        Of force and moment, 1/N and 1/(N m).
    counterweights : dict of link to Counterweight
    size : int
        Components of each unbalance: 2 if it may leave its link's line, else 1.
    turn : array
        Crank angles of the norm, rad.
    scale : float
        The largest static moment, kg m.
    reference : float
        The norm without counterweights, or 1.
    """

    mechanism: Any
    norm: str
    weights: tuple[float, float]
    counterweights: dict[str, Counterweight]
    size: int
    turn: Any
    scale: float
    reference: float = 1.0

    @classmethod
    def of(cls, mechanism, norm, weights, counterweights, size, turn):
        """The search for a mechanism, with its scale and reference."""
        scale = max(float(np.hypot(*pair)) for pair in principal_points(mechanism).static_moments.values())
        made = cls(mechanism, norm, weights, counterweights, size, turn, scale)
        return replace(made, reference=made.value(made.none) or 1.0)

    @property
    def none(self):
        """Unknowns without counterweights."""
        return np.zeros(self.size * len(self.counterweights))

    @property
    def starts(self):
        """Initial unknowns; one on each side where weights keep out of a hole."""
        kept_out = any(weight.keep_out for weight in self.counterweights.values())
        return (self.none - 0.5, self.none + 0.5) if kept_out else (self.none,)

    def balanced(self, unknowns):
        """The mechanism with counterweights of these unbalances."""
        result, unbalances = Balanced(self.mechanism, self.mechanism), (unknowns * self.scale).reshape(-1, self.size)
        for (name, weight), unbalance in zip(self.counterweights.items(), unbalances, strict=True):
            step = _add_within_limits(result.mechanism, name, np.append(unbalance, 0.0)[:2], weight)
            result = Balanced(self.mechanism, step.mechanism, {**result.counterweights, **step.counterweights})
        return result

    def solved(self, unknowns):
        """Solution of that mechanism at crank speed 1 rad/s."""
        return Solution(self.balanced(unknowns).mechanism, self.turn, 1.0, 0.0)

    def sizes(self, unknowns):
        """Sizes under the norm at each crank angle, relative to the reference."""
        return _force_sizes(self.solved(unknowns), self.norm) / self.reference

    def value(self, unknowns):
        """The norm."""
        if self.norm == "weighted":
            solved, (by_force, by_moment) = self.solved(unknowns), self.weights
            force, moment = by_force * magnitude(solved.shaking_force), by_moment * solved.shaking_moment
            return np.sqrt(np.mean(force * force + moment * moment))
        return (np.mean if self.norm == "mean" else np.max)(_force_sizes(self.solved(unknowns), self.norm))

    def objective(self, unknowns):
        """The norm relative to the reference."""
        return self.value(unknowns) / self.reference


def least_shaking(search) -> Balanced:
    """`Balanced` with the counterweights of the least norm."""
    best = min((_minimise_norm(search.objective, start) for start in search.starts), key=search.objective)
    if search.norm not in PEAK_NORMS:
        return search.balanced(best)
    sizes = partial(_force_sizes, norm=search.norm)
    for _ in range(8):  # peaks between the angles join them
        best = min(best, _minimise_peak(search.sizes, best), key=search.objective)
        peaks = extremes(search.solved(best), sizes)
        if peaks.range[1] <= search.value(best) + 1e-10 * search.reference:
            break
        search = replace(search, turn=np.append(search.turn, peaks.angle))
    return search.balanced(best)


def _minimise_norm(objective, start):
    """Minimiser by Nelder and Mead, restarted once."""
    from scipy.optimize import minimize

    options = {"xatol": 1e-10, "fatol": 1e-13, "maxiter": 2000}
    for _ in range(2):
        start = minimize(objective, start, method="Nelder-Mead", options=options, callback=_stop_at_zero).x
    return start


def _stop_at_zero(intermediate_result):
    if intermediate_result.fun < 1e-11:
        raise StopIteration


def _minimise_peak(sizes, start):
    """Minimiser of the largest of many sizes: of a level above all of them (SLSQP)."""
    from scipy.optimize import minimize

    found = minimize(
        lambda unknowns: unknowns[-1],
        np.append(start, np.max(sizes(start))),
        jac=lambda unknowns: np.append(np.zeros(start.size), 1.0),
        constraints={"type": "ineq", "fun": lambda unknowns: unknowns[-1] - sizes(unknowns[:-1])},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 200},
    )
    return found.x[:-1]


def _force_sizes(solution, norm):
    """Size of the shaking force, or of its component, at each crank angle, N."""
    if norm in ("along", "across"):
        return np.abs((along_guide if norm == "along" else across_guide)(solution))
    return magnitude(solution.shaking_force)


def _add_within_limits(mechanism, link, unbalance, weight):
    """`Balanced` with a counterweight of this unbalance, on either side, cut to its limits."""
    size = float(np.hypot(*unbalance))
    smallest, largest = weight.unbalances()
    kept = unbalance * (min(max(size, smallest), largest) / size) if size else np.array([-smallest, 0.0])
    sided = weight if weight.arm is None else replace(weight, arm=float(np.copysign(weight.arm, kept[0])))
    return counterweight(mechanism, link, kept, sided)

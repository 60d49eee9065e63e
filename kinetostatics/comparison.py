"""Dynamic coefficients: how much one mechanism's torque and forces exceed another's."""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from . import checks
from .errors import ParameterError, QuantityError
from .extremes import extremes
from .quantities import label, magnitude, unit
from .solution import Solution


@dataclass(frozen=True, eq=False)
class Comparison:
    """Dynamic coefficients of a reference mechanism against a balanced one; made by `compare`.

    Every ratio is reference / balanced: above 1 the balanced mechanism is better.
    """

    reference: Solution
    balanced: Solution
    names: tuple[str, str] = ("reference", "balanced")

    @cached_property
    def torque_extremes(self):
        """Extrema of the balancing torque of the reference, and the matching ones of the balanced mechanism, N m.

        To each extremum of the reference belongs the balanced one of the same kind (maximum or minimum) nearest in
        crank angle; NaN if there is none.
        """
        reference = extremes(self.reference, "balancing_torque")
        balanced = extremes(self.balanced, "balancing_torque")
        return reference, _matched(reference, balanced)

    @cached_property
    def torque_extremum_ratios(self):
        """Ratio of the torques at each torque extremum, in order of crank angle (K,)."""
        reference, matched = self.torque_extremes
        with np.errstate(divide="ignore"):
            return reference.value / matched

    @cached_property
    def mean_torques(self):
        """Mean absolute balancing torque of reference and balanced mechanism, integral over the turn, N m."""
        return mean_absolute_torque(self.reference), mean_absolute_torque(self.balanced)

    @property
    def mean_torque_ratio(self):
        """Ratio of the mean absolute balancing torques."""
        return _ratio(*self.mean_torques)

    def peak_reactions(self, joint):
        """Largest reaction at a joint in reference and balanced mechanism, N."""
        return _peak(self.reference, joint), _peak(self.balanced, joint)

    def peak_reaction_ratio(self, joint):
        """Ratio of the largest reactions at a joint."""
        return _ratio(*self.peak_reactions(joint))

    def cam_force_range(self):
        """Smallest and largest cam force of reference and balanced mechanism, N; NaN for one without a cam."""
        return tuple(_range(solution, "cam_force") for solution in (self.reference, self.balanced))

    def inertia_force_range(self, link="coupler"):
        """Smallest and largest inertia force of a link in reference and balanced mechanism, N."""

        def force(solution):
            return magnitude(solution.inertia_force(link))

        return tuple(_range(solution, force) for solution in (self.reference, self.balanced))

    def frame(self):
        """All coefficients as a pandas DataFrame: quantity, unit, its value in each mechanism, and the ratio."""
        import pandas as pd

        rows = [("mean |balancing torque|", "N m", *self.mean_torques, self.mean_torque_ratio)]
        reference, matched = self.torque_extremes
        for number, row in enumerate(zip(reference.value, matched, self.torque_extremum_ratios, strict=True), 1):
            rows.append((f"torque extremum {number}", "N m", *row))
        for joint in self.reference.reactions:
            if joint in self.balanced.reactions:
                row = *self.peak_reactions(joint), self.peak_reaction_ratio(joint)
                rows.append((f"largest {label(joint)}", "N", *row))
        for name in ("shaking_force", "shaking_moment"):
            peaks = [abs(extremes(solution, name).largest) for solution in (self.reference, self.balanced)]
            rows.append((f"largest {label(name)}", unit(name), *peaks, _ratio(*peaks)))
        for name, ranges in (
            ("coupler inertia force", self.inertia_force_range()),
            ("cam force", self.cam_force_range()),
        ):
            for which, of_each in zip(("smallest", "largest"), zip(*ranges, strict=True), strict=True):
                rows.append((f"{which} {name}", "N", *of_each, np.nan))
        rows.append(("power residual", "1", self.reference.power_residual, self.balanced.power_residual, np.nan))
        table = pd.DataFrame(rows, columns=["quantity", "unit", *self.names, "ratio"]).set_index("quantity")
        return table.dropna(how="all", subset=list(self.names))


def compare(reference, balanced):
    """Compare two solutions, by dynamic coefficients.

    Parameters
    ----------
    reference, balanced : Solution
        Of one design each; their own crank angles do not matter.

    Returns
    -------
    Comparison
        Ratios reference / balanced: `.torque_extremum_ratios`, `.mean_torque_ratio`, `.peak_reaction_ratio(joint)`,
        ranges of cam and inertia force, `.frame()`.
    """
    checks.require("compare", checks.solution("reference", reference), checks.solution("balanced", balanced))
    return Comparison(reference, balanced)


def mean_absolute_torque(solution):
    """Integral mean of the absolute balancing torque over the turn, N m.

    Adaptive quadrature (scipy.integrate.cubature) between the angles where the torque changes sign or jumps, as with a
    process force: on each of the pieces it is smooth.
    """
    from scipy.integrate import cubature
    from scipy.optimize import elementwise

    def torque(angle):
        return solution.at(angle).balancing_torque

    turn = 2 * np.pi
    grid = np.linspace(0.0, turn, 721)
    samples = torque(grid)
    if samples.ndim > 1:
        raise ParameterError("mean torque works on one design at a time; solve a single design of the batch")
    change = np.flatnonzero(samples[:-1] * samples[1:] < 0)
    kinks = elementwise.find_root(torque, (grid[change], grid[change + 1])).x if change.size else []
    floor = 1e-14 * turn * solution.at(grid).largest_torque_term
    edges = np.unique([0.0, *kinks, *_jumps(torque, grid, samples, floor), turn])
    pieces = [
        cubature(lambda angle: np.abs(torque(angle[:, 0])), [start], [end], rtol=1e-12, atol=floor)
        for start, end in pairwise(edges)
    ]
    if any(piece.status != "converged" for piece in pieces):
        raise ParameterError(
            "mean torque: the integral over the turn did not converge; does the mechanism close everywhere, and are "
            "the loads finite?"
        )
    return float(sum(piece.estimate for piece in pieces)) / turn


def _jumps(function, grid, samples, floor):
    """Angles on both sides of each jump, by bisection where a step of the grid rises far more than its neighbours."""
    rise = np.abs(np.diff(samples))
    around = np.maximum(np.append(rise[1:], 0.0), np.append(0.0, rise[:-1]))
    found = np.flatnonzero(rise > 4 * around + floor)
    if not found.size:
        return ()
    low, high, below, above = grid[found], grid[found + 1], samples[found], samples[found + 1]
    for _ in range(50):
        middle = (low + high) / 2
        value = function(middle)
        left = np.abs(value - below) <= np.abs(value - above)
        low, below = np.where(left, middle, low), np.where(left, value, below)
        high, above = np.where(left, high, middle), np.where(left, above, value)
    return (*low, *high)


def _matched(reference, balanced):
    distance = np.abs(np.exp(1j * reference.angle)[:, None] - np.exp(1j * balanced.angle))
    distance = np.where(reference.maximum[:, None] == balanced.maximum, distance, np.inf)
    if not distance.size:
        return np.full(len(reference), np.nan)
    nearest = np.argmin(distance, axis=1)
    return np.where(np.isfinite(distance.min(axis=1)), balanced.value[nearest], np.nan)


def _ratio(reference, balanced):
    """Ratio of two peaks; infinite where the balanced one is zero but for rounding."""
    if abs(balanced) <= 1e-12 * abs(reference):
        return np.inf
    return reference / balanced if balanced else np.nan


def _peak(solution, joint):
    return extremes(solution, joint).range[1]


def _range(solution, quantity):
    try:
        return extremes(solution, quantity).range
    except QuantityError:
        return np.nan, np.nan

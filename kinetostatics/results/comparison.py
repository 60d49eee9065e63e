"""Dynamic coefficients: how much one mechanism's torque and forces exceed another's."""

import warnings
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ..errors import ConditionWarning, ParameterError, QuantityError
from ..machine.loads import TURN
from ..mechanics.quantities import label_of, magnitude, unit_of
from ..numbers import checks
from ..numbers.elementary import UNIT
from .extremes import extrema, extremes, warning
from .turn import SAME, USABLE, require_single

ORDER = 8
"""Nodes of a panel of the quadrature."""
SPLIT = 0.4
"""Where a panel is parted: not in the middle, on both sides of which nodes lie alike, so that jumps there hide."""
CLOSE = 1e-14
"""Share of the integral, divided by the panels, that parting a panel may change for it to be done."""
PRECISE = 1e-9
"""Error of a mean, relative to it, from which a warning tells."""
SMALLEST = 1e-14
"""Panel, in periods, that is not parted any more."""
LARGEST = 2**17
"""Crank angles evaluated at a time."""
WORK = 2**17
"""Panels after which the quadrature stops."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Dynamic coefficients of a reference mechanism against a balanced one; made by `compare`.

    Every ratio is reference / balanced: above 1 the balanced mechanism is better.
    """

    reference: Any
    balanced: Any
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
                rows.append((f"largest {label_of(self.reference, joint)}", "N", *row))
        for name in ("shaking_force", "shaking_moment"):
            peaks = [abs(extremes(solution, name).largest) for solution in (self.reference, self.balanced)]
            label, unit = label_of(self.reference, name), unit_of(self.reference, name)
            rows.append((f"largest {label}", unit, *peaks, _ratio(*peaks)))
        couplers = (bar.link for bar in self.reference.mechanism.couplers)
        for name, ranges in (
            *((f"{link} inertia force", self.inertia_force_range(link)) for link in couplers),
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
    reference, balanced : Solution, or Running as `ks.drive.steady` returns it
        Of one design each; their own crank angles do not matter.

    Returns
    -------
    Comparison
        Ratios reference / balanced: `.torque_extremum_ratios`, `.mean_torque_ratio`, `.peak_reaction_ratio(joint)`,
        ranges of cam and inertia force, `.frame()`. Of machines in periodic running also what their drives take:
        see `drive.saving.DrivenComparison`.
    """
    reference, balanced = _solution(reference), _solution(balanced)
    checks.require("compare", checks.solution("reference", reference), checks.solution("balanced", balanced))
    kinds = {getattr(solution, "COMPARISON", Comparison) for solution in (reference, balanced)}
    return (kinds.pop() if len(kinds) == 1 else Comparison)(reference, balanced)


def _solution(given):
    """The solution of what `ks.drive.steady` returns; all else as it is."""
    return given.solution if hasattr(given, "energy_flow") else given


def mean_absolute_torque(solution):
    """Integral mean of the absolute balancing torque over the period of the solution, N m.

    By Gauss quadrature between changes of sign, on panels that are parted where the parts do not agree with the whole,
    which closes in on jumps, corners and narrow pulses of a load. The nodes of the first panels are a fiftieth of a
    degree apart at most where a load is a function; a pulse between them may pass unseen.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.

    Warns
    -----
    ConditionWarning
        The torque grows without bound at a limit position, so the mean is infinite; values around it that have no
        correct digit do not count; or the load is so uneven that fewer digits of the mean are right.
    """
    turn = _closed_turn(solution, "mean torque")
    peaks = extrema(solution, "balancing_torque")
    words = [warning(solution, [peaks])]
    mean = np.inf
    if not np.isinf(peaks.value).any():
        floor = 1e-14 * turn.at.at(turn.angle[turn.usable]).largest_torque_term
        mean, error = _mean_absolute(lambda angle: turn.at.at(turn.clear(angle)).balancing_torque, turn, floor)
        if error > PRECISE * mean + floor:
            words.append(f"mean torque: it is right to about {error:.2g} N m of {mean:.6g} only, so uneven is the load")
    for text in filter(None, words):
        warnings.warn(text, ConditionWarning, stacklevel=2)
    return mean


def energy_per_turn(solution):
    """Work of the balancing torque in a turn of the crank, J: what the loads take of the drive, negative if they give.

    The integral over the period of the solution, as of `mean_absolute_torque`, by its turns.

    Raises
    ------
    ParameterError
        The solution is a batch of designs, or does not close all round.
    """
    turn = _closed_turn(solution, "energy per turn")
    at = turn.at.at(turn.angle[turn.usable])
    lift = 2.0 * np.abs(at.balancing_torque).max()  # a torque of one sign has no corners where it changes
    floor = 1e-14 * at.largest_torque_term
    mean, _ = _mean_absolute(lambda angle: turn.at.at(turn.clear(angle)).balancing_torque + lift, turn, floor)
    return TURN * (mean - lift) * (-1.0 if np.any(np.asarray(at.crank_speed) < 0) else 1.0)


def _closed_turn(solution, owner):
    """Turn of a single design that closes all round."""
    require_single(solution, owner, "balancing_torque")
    turn = solution.sampled
    if turn.gaps:
        where = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g}" for start, stop in turn.gaps)
        raise ParameterError(f"{owner}: {solution.mechanism.name} does not close for crank angles {where} deg")
    return turn


def _mean_absolute(function, turn, floor):
    """Mean of the absolute value of a function of the crank angle, and about how much it may be wrong."""
    from scipy.optimize import elementwise

    nodes, weights = (part / 2 for part in np.polynomial.legendre.leggauss(ORDER))
    even = np.linspace(0.0, turn.period, turn.panels + 1)
    grid = np.unique(np.concatenate([even, turn.limits % turn.period, turn.kinks]))
    samples = function(grid)
    change = np.flatnonzero(samples[:-1] * samples[1:] < 0)
    kinks = elementwise.find_root(function, (grid[change], grid[change + 1])).x if change.size else []
    edges = np.unique(np.concatenate([grid, kinks]))

    def integrals(start, width):
        parts = []
        for some in np.array_split(np.arange(start.size), 1 + start.size * ORDER // LARGEST):
            angle = start[some, None] + width[some, None] * (0.5 + nodes)
            parts.append(np.abs(function(angle.ravel())).reshape(angle.shape) @ weights)
        return width * np.concatenate(parts)

    noise = np.abs(samples).max() * UNIT * np.fmin(turn.condition, USABLE) * (turn.limits.size > 0)
    start, width = edges[:-1], np.diff(edges)
    whole, total, wrong, room = integrals(start, width), 0.0, 0.0, WORK
    while start.size:
        left, right = SPLIT * width, (1.0 - SPLIT) * width
        both = integrals(np.concatenate([start, start + left]), np.concatenate([left, right])).reshape(2, -1)
        error = np.abs(both.sum(axis=0) - whole)
        room -= both.size
        size = np.abs(total) + np.abs(both).sum()
        rough = error > width * (floor + np.interp(start, turn.angle, noise)) + 1e-16 * size
        rough &= (left > SMALLEST * turn.period) & (error > CLOSE * size / start.size)
        if room < 0:
            rough[:] = False
        total += both[:, ~rough].sum()
        wrong += error[~rough].sum()
        start = np.concatenate([start[rough], start[rough] + left[rough]])
        width, whole = np.concatenate([left[rough], right[rough]]), both[:, rough].ravel()
    return float(total) / turn.period, float(wrong) / turn.period


def _matched(reference, balanced):
    distance = np.abs(np.exp(1j * reference.angle)[:, None] - np.exp(1j * balanced.angle))
    distance = distance + SAME * (_side(reference)[:, None] != _side(balanced))
    distance = np.where(reference.maximum[:, None] == balanced.maximum, distance, np.inf)
    if not distance.size:
        return np.full(len(reference), np.nan)
    nearest = np.argmin(distance, axis=1)
    return np.where(np.isfinite(distance.min(axis=1)), balanced.value[nearest], np.nan)


def _side(found):
    """Whether each extremum stands behind another at its crank angle: what a limit position is left with."""
    return np.diff(found.angle, prepend=-1.0) <= SAME


def _ratio(reference, balanced):
    """Ratio of two peaks; infinite where the balanced one is zero but for rounding, NaN if neither has a value."""
    if abs(balanced) > 1e-12 * abs(reference):
        return reference / balanced
    return np.inf if abs(reference) > 0 and np.isfinite(balanced) else np.nan


def _peak(solution, joint):
    return extremes(solution, joint).range[1]


def _range(solution, quantity):
    try:
        return extremes(solution, quantity).range
    except QuantityError:
        return np.nan, np.nan

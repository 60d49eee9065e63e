"""Dynamic coefficients: how much one mechanism's torque and forces exceed another's."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import QuantityError
from ..machine.loads import TURN
from ..mechanics.quantities import label_of, magnitude, unit_of
from ..numbers import checks
from ..numbers.lazy import cached_property
from .extremes import extremes
from .losses import lose
from .means import mean_absolute_torque, mean_absolute_torque_errors
from .rounding import without_rounding
from .turn import SAME

APART = TURN / 3
"""Crank angle from which on extrema are strangers, rad; those of a reversed torque are a quarter of a turn apart."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Dynamic coefficients of a reference mechanism against a balanced one; made by `compare`.

    Every ratio is reference / balanced: above 1 the balanced mechanism is better.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.load_case("sawframe_2r63").compare("plain", "cam-cosine")
    >>> found.torque_extremum_ratios.round(2)
    array([7.27, 6.11, 6.45, 7.62])
    >>> print(f"{found.peak_reaction_ratio('O'):.2f}")
    14.57
    """

    reference: Any
    balanced: Any
    names: tuple[str, str] = ("reference", "balanced")

    @cached_property
    def torque_extremes(self):
        """Extrema of the balancing torque of the reference, and the matching ones of the balanced mechanism, N m.

        To each extremum of the reference belongs one of the balanced mechanism of the same kind (maximum or minimum),
        each to one at most, so that they lie as near in crank angle as they can; NaN where none is left within a third
        of a turn. The two sides of a jump on a flank, as friction makes at dead centres, are none of them.
        """
        reference = _without_jumps(extremes(self.reference, "balancing_torque"))
        balanced = _without_jumps(extremes(self.balanced, "balancing_torque"))
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

    @cached_property
    def mean_torque_errors(self):
        """Errors of the mean torques of both, N m: `rounding`, which is proven, and about that of the `quadrature`."""
        return mean_absolute_torque_errors(self.reference), mean_absolute_torque_errors(self.balanced)

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

    @property
    def lost_powers(self):
        """Mean power lost in reference and balanced mechanism, W (`Solution.losses`)."""
        return self.reference.losses.total, self.balanced.losses.total

    @property
    def lost_power_ratio(self):
        """Ratio of the mean powers lost: what balancing saves of friction."""
        return _ratio(*self.lost_powers)

    def cam_force_range(self):
        """Smallest and largest cam force of reference and balanced mechanism, N; NaN for one without a cam."""
        return tuple(_range(solution, "cam_force") for solution in (self.reference, self.balanced))

    def inertia_force_range(self, link="coupler"):
        """Smallest and largest inertia force of a link in reference and balanced mechanism, N."""

        def force(solution):
            return magnitude(solution.inertia_force(link))

        return tuple(_range(solution, force) for solution in (self.reference, self.balanced))

    def frame(self):
        """All coefficients as a pandas DataFrame: quantity, unit, its value in each mechanism, and the ratio.

        What is rounding, beside the largest force or torque of its mechanism, stands as 0.
        """
        import pandas as pd

        torques = self._without_rounding("balancing_torque", self.mean_torques)
        rows = [("mean |balancing torque|", "N m", *torques, _ratio(*torques))]
        reference, matched = self.torque_extremes
        for number, row in enumerate(zip(reference.value, matched, self.torque_extremum_ratios, strict=True), 1):
            rows.append((f"torque extremum {number}", "N m", *row))
        rows += self._hidden_peak(reference.value, matched)
        rows += self._lost()
        for joint in self.reference.reactions:
            if joint in self.balanced.reactions:
                peaks = self._without_rounding(joint, self.peak_reactions(joint))
                rows.append((f"largest {label_of(self.reference, joint)}", "N", *peaks, _ratio(*peaks)))
        for name in ("shaking_force", "shaking_moment"):
            peaks = self._without_rounding(
                name, [abs(extremes(solution, name).largest) for solution in (self.reference, self.balanced)]
            )
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

    def _without_rounding(self, name, pair):
        """A quantity of both mechanisms, 0 where it is rounding."""
        both = zip((self.reference, self.balanced), pair, strict=True)
        return [float(without_rounding(solution, name, [value])[0]) for solution, value in both]

    def _hidden_peak(self, *shown):
        """A row of the largest torques, where one of them is none of the extrema shown beside each other."""
        both = self.reference, self.balanced
        paired = np.isfinite(shown).all(axis=0)
        peaks = [abs(extremes(solution, "balancing_torque").largest) for solution in both]
        if any(
            not np.isclose(np.abs(some[paired]), peak, rtol=1e-9).any() for some, peak in zip(shown, peaks, strict=True)
        ):
            peaks = self._without_rounding("balancing_torque", peaks)
            yield "largest |balancing torque|", "N m", *peaks, _ratio(*peaks)

    def _lost(self):
        """Rows of the power lost by joint, all together, and of the efficiency; none where no power is lost."""
        if not lose(self.reference, self.balanced):
            return
        both = self.reference.losses, self.balanced.losses
        for name in dict.fromkeys(name for losses in both for name in losses.lost):
            powers = [losses.lost.get(name, np.nan) for losses in both]
            yield f"mean power lost, {name}", "W", *powers, _ratio(*powers)
        yield "mean power lost", "W", *self.lost_powers, self.lost_power_ratio
        yield "efficiency", "1", *(losses.efficiency for losses in both), np.nan


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
        `.lost_power_ratio` with friction; ranges of cam and inertia force, `.frame()`. Of machines in periodic running
        also what their drives take: see `drive.saving.DrivenComparison`.

    Examples
    --------
    What does a counterweight on the crank buy, and where?

    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.15, 0.015), slider=ks.Link(5.0))
    >>> weight = ks.Counterweight(arm=-0.05)
    >>> balanced = ks.balancing.partial(mower, crank=weight).mechanism
    >>> found = ks.compare(*(ks.solve(item, 0.0, crank_speed=63.0) for item in (mower, balanced)))
    >>> print(f"{found.peak_reaction_ratio('O'):.2f} {found.mean_torque_ratio:.2f}")  # reference / balanced
    2.06 1.00
    """
    reference, balanced = _solution(reference), _solution(balanced)
    checks.require("compare", checks.solution("reference", reference), checks.solution("balanced", balanced))
    kinds = {getattr(solution, "COMPARISON", Comparison) for solution in (reference, balanced)}
    return (kinds.pop() if len(kinds) == 1 else Comparison)(reference, balanced)


def _solution(given):
    """The solution of what `ks.drive.steady` returns; all else as it is."""
    return given.solution if hasattr(given, "energy_flow") else given


def _matched(reference, balanced):
    """Value of the balanced extremum that belongs to each of the reference, NaN where there is none."""
    from scipy.optimize import linear_sum_assignment

    period, own = reference.solution.period, balanced.solution.period
    times = max(1, round(period / own))
    angle = np.ravel(balanced.angle + own * np.arange(times)[:, None])
    value, maximum, side = (np.tile(part, times) for part in (balanced.value, balanced.maximum, _side(balanced)))
    apart = np.abs((reference.angle[:, None] - angle + period / 2) % period - period / 2)
    apart = apart + SAME * (_side(reference)[:, None] != side)
    apart = np.where(reference.maximum[:, None] == maximum, np.minimum(apart, APART), APART)
    rows, columns = linear_sum_assignment(apart)
    near = apart[rows, columns] < APART
    found = np.full(len(reference), np.nan)
    found[rows[near]] = value[columns[near]]
    return found


def _without_jumps(found):
    """Extrema but those that are the two sides of a jump between the extrema before and behind it."""
    keep = np.ones(len(found), dtype=bool)
    for second in np.flatnonzero(_side(found)) if len(found) > 2 else ():
        sides = slice(second - 1, second + 1)
        low, high = sorted((found.value[second - 2], found.value[(second + 1) % len(found)]))
        if ((low < found.value[sides]) & (found.value[sides] < high)).all():
            keep[sides] = False
    return replace(found, angle=found.angle[keep], value=found.value[keep], maximum=found.maximum[keep])


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

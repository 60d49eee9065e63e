"""Dynamic coefficients: how much one mechanism's torque and forces exceed another's."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..errors import QuantityError
from ..mechanics.quantities import label_of, magnitude, of_scene, unit_of
from ..numbers import checks
from ..numbers.lazy import cached_property
from .extremes import extremes
from .losses import lose
from .means import mean_absolute_torque, mean_absolute_torque_errors
from .pairing import chosen, counted, of_partners, partners
from .rounding import MOST, Known, without_rounding

TORQUE = "balancing_torque"
EXTREMUM = "torque extremum"
"""What rows of the table are called that tell one, before its number."""
ENDS = {"smallest": np.argmin, "largest": np.argmax}


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
        reference, balanced = self._between_jumps
        return reference, of_partners(partners(reference, balanced), balanced.value)

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
        return tuple(extremes(solution, joint).range[1] for solution in self._both)

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
        return tuple(_range(solution, "cam_force") for solution in self._both)

    def inertia_force_range(self, link="coupler"):
        """Smallest and largest inertia force of a link in reference and balanced mechanism, N."""

        def force(solution):
            return magnitude(solution.inertia_force(link))

        return tuple(_range(solution, force) for solution in self._both)

    def frame(self):
        """All coefficients as a pandas DataFrame: quantity, unit, its value in each mechanism, and the ratio.

        What is rounding, within its proven bound or beside the largest force or torque of its mechanism, stands as 0.
        """
        return self._as_frame((row.label, row.unit, *row.pair, row.ratio) for row in self.rows)

    def error_bounds(self):
        """By how much the numbers of `frame` may be wrong by rounding, a pandas DataFrame of the same rows and columns.

        NaN where nothing is proven: of means, of what is no quantity of the solution, and where there is no
        `Solution.error_bound`.
        """
        return self._as_frame((row.label, row.unit, *row.bounds, row.bound_of_ratio) for row in self.rows)

    def _as_frame(self, rows):
        import pandas as pd

        return pd.DataFrame(list(rows), columns=["quantity", "unit", *self.names, "ratio"]).set_index("quantity")

    @cached_property
    def rows(self):
        """Rows of `frame`, a list: `label`, `unit`, the `pair` of values, `ratio` and bounds on the errors of each."""
        return [row for row in self._all_rows() if not np.isnan(row.pair).all()]

    def _all_rows(self):
        yield self._row("mean |balancing torque|", TORQUE, self.mean_torques)
        yield from self._torque_extrema()
        yield from self._lost()
        for name in (*self._shared, "shaking_force", "shaking_moment"):
            yield self._largest(f"largest {label_of(self.reference, name)}", name)
        for bar in self.reference.mechanism.couplers:
            for which, pair in zip(ENDS, zip(*self.inertia_force_range(bar.link), strict=True), strict=True):
                yield Row(f"{which} {bar.link} inertia force", "N", pair, np.nan)
        for which, find in ENDS.items():
            pair, errors = self._ends("cam_force", find)
            yield Row(f"{which} cam force", "N", pair, np.nan, errors)
        yield Row("power residual", "1", tuple(solution.power_residual for solution in self._both), np.nan)

    @property
    def _both(self):
        return self.reference, self.balanced

    @property
    def _shared(self):
        """Joints that both mechanisms have."""
        return [joint for joint in self.reference.reactions if joint in self.balanced.reactions]

    @cached_property
    def _torques(self):
        """Extremes of the torque of both mechanisms."""
        return [extremes(solution, TORQUE) for solution in self._both]

    @cached_property
    def _between_jumps(self):
        """The same but for those that are sides of a jump."""
        return [chosen(found, counted(found)) for found in self._torques]

    @cached_property
    def _known(self):
        """What is known of the extremes that rows tell of both mechanisms."""
        names = *self._shared, "shaking_force", "shaking_moment", "cam_force"
        both = zip(self._both, self._torques, strict=True)
        return [
            Known(at, {TORQUE: torque} | {name: extremes(at, name) for name in names if name in of_scene(at)})
            for at, torque in both
        ]

    def _ends(self, name, find):
        """The value that a function finds among the extremes of each mechanism, and bounds on their errors."""
        ends = [known.end(name, find) if name in known.found else (np.nan,) * 3 for known in self._known]
        values, _, errors = zip(*ends, strict=True)
        return values, errors

    def _row(self, label, name, values, errors=(np.nan, np.nan)):
        """A row of a quantity of both mechanisms, 0 where it is rounding."""
        each = zip(self._both, values, errors, strict=True)
        pair = tuple(float(without_rounding(solution, name, [value], error)[0]) for solution, value, error in each)
        return Row(label, unit_of(self.reference, name), pair, _ratio(*pair), errors)

    def _largest(self, label, name):
        """A row of the largest magnitudes of a quantity."""
        values, errors = self._ends(name, lambda values: np.argmax(np.abs(values)))
        return self._row(label, name, tuple(map(abs, values)), errors)

    def _torque_extrema(self):
        """Rows of the torque's extrema, and of the largest torques where one is none of those beside each other."""
        reference, matched = self.torque_extremes
        own, other = (known.errors(TORQUE)[counted(known.found[TORQUE])] for known in self._known)
        errors = zip(own, of_partners(partners(*self._between_jumps), other), strict=True)
        pairs = zip(reference.value, matched, strict=True)
        for number, (pair, error) in enumerate(zip(pairs, errors, strict=True), 1):
            yield self._row(f"{EXTREMUM} {number}", TORQUE, pair, error)
        paired = np.isfinite(matched)
        peaks = self._largest("largest |balancing torque|", TORQUE)
        for shown, peak in zip((reference.value, matched), peaks.pair, strict=True):
            if not np.isclose(np.abs(shown[paired]), peak, rtol=1e-9).any():
                yield peaks
                return

    def _lost(self):
        """Rows of the power lost by joint, all together, and of the efficiency; none where no power is lost."""
        if not lose(*self._both):
            return
        both = [solution.losses for solution in self._both]
        for name in dict.fromkeys(name for losses in both for name in losses.lost):
            powers = tuple(losses.lost.get(name, np.nan) for losses in both)
            yield Row(f"mean power lost, {name}", "W", powers, _ratio(*powers))
        yield Row("mean power lost", "W", self.lost_powers, self.lost_power_ratio)
        yield Row("efficiency", "1", tuple(losses.efficiency for losses in both), np.nan)


class Row(NamedTuple):
    """A row of the table: values in both mechanisms, bounds on their errors."""

    label: str
    unit: str
    pair: tuple[float, ...]
    ratio: float
    bounds: tuple[float, ...] = (np.nan, np.nan)

    @property
    def bound_of_ratio(self):
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.abs(self.ratio) * np.sum(np.divide(self.bounds, np.abs(self.pair))))


def left_out(rows):
    """Torque extrema that a table for people can do without, if they are many: all but each column's ends.

    `rows` are the values of the columns by label; labels are returned.
    """
    labels = [label for label in rows if label.startswith(EXTREMUM)]
    if len(labels) <= MOST:
        return []
    columns = np.array([rows[label] for label in labels], dtype=float).T
    ends = {find(column) for column in columns if not np.isnan(column).all() for find in (np.nanargmin, np.nanargmax)}
    return [label for place, label in enumerate(labels) if place not in ends]


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


def _ratio(reference, balanced):
    """Ratio of two peaks; infinite where the balanced one is zero but for rounding, NaN if neither has a value."""
    if abs(balanced) > 1e-12 * abs(reference):
        return reference / balanced
    return np.inf if abs(reference) > 0 and np.isfinite(balanced) else np.nan


def _range(solution, quantity):
    try:
        return extremes(solution, quantity).range
    except QuantityError:
        return np.nan, np.nan

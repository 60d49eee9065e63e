"""Dynamic coefficients: how much one mechanism's torque and forces exceed another's."""

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from ..errors import QuantityError
from ..machine.loads import TURN
from ..mechanics.quantities import label_of, magnitude, of_scene, unit_of
from ..numbers import checks
from ..numbers.lazy import cached_property
from ..numbers.output_units import output_units
from .extremes import extremes
from .kinks import ANGLE_TOLERANCE
from .load_functions import with_resolution
from .losses import lose
from .means import mean_absolute_torque, mean_absolute_torque_errors
from .rounding import MAX_LISTED, BoundedExtremes, without_rounding

TORQUE = "balancing_torque"
EXTREMUM = "torque extremum"
"""Label of a table's row, before its number."""
PARTNER_DISTANCE = TURN / 3
"""Largest difference in crank angle of extrema that are compared, rad; a reversed torque has them TURN / 4 apart."""
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

        Extrema of one kind (maximum or minimum) are matched one to one, as near in crank angle as possible; NaN where
        no partner exists within a third of a turn. The two sides of a jump on a flank, as friction causes at dead
        centres, do not count.
        """
        reference, balanced = self._torque_extrema
        return reference, np.append(balanced.value, np.nan)[_partners(reference, balanced)]

    @cached_property
    def torque_extremum_ratios(self):
        """Ratio of the torques at each torque extremum, in order of crank angle (K,)."""
        reference, matched = self.torque_extremes
        with np.errstate(divide="ignore"):
            return reference.value / matched

    @cached_property
    def mean_torques(self):
        """Mean magnitude of the balancing torque of reference and balanced mechanism, integral over the turn, N m.

        Not their `Solution.mean_torque`, where positive and negative torque cancel.
        """
        return mean_absolute_torque(self.reference), mean_absolute_torque(self.balanced)

    @cached_property
    def mean_torque_errors(self):
        """Errors of both mean torques, N m: proven bound on the `rounding`, estimate of that of the `quadrature`."""
        return mean_absolute_torque_errors(self.reference), mean_absolute_torque_errors(self.balanced)

    @property
    def mean_torque_ratio(self):
        """Ratio of the mean magnitudes of the balancing torque, `mean_torques`."""
        return ratio(*self.mean_torques)

    @property
    def mean_powers(self):
        """Mean power of the drive of reference and balanced mechanism, W (`Solution.mean_power`)."""
        return self.reference.mean_power, self.balanced.mean_power

    def peak_reactions(self, joint):
        """Largest reaction at a joint, or other force, such as "ground cam", in reference and balanced mechanism, N."""
        return tuple(extremes(solution, joint).range[1] for solution in self._both)

    def peak_reaction_ratio(self, joint):
        """Ratio of the largest reactions at a joint."""
        return ratio(*self.peak_reactions(joint))

    @property
    def lost_powers(self):
        """Mean power lost in reference and balanced mechanism, W (`Solution.losses`)."""
        return self.reference.losses.total, self.balanced.losses.total

    @property
    def lost_power_ratio(self):
        """Ratio of the mean powers lost."""
        return ratio(*self.lost_powers)

    def cam_force_range(self):
        """Smallest and largest cam force of reference and balanced mechanism, N; NaN for one without a cam."""
        return tuple(_range(solution, "cam_force") for solution in self._both)

    def inertia_force_range(self, link="coupler"):
        """Smallest and largest inertia force of a link in reference and balanced mechanism, N; NaN for one without it.

        Raises
        ------
        QuantityError
            Neither mechanism has the link.
        """
        links = tuple(dict.fromkeys(name for solution in self._both for name in solution.mechanism.links))
        if problem := checks.choice("inertia_force_range: link", link, links):
            raise QuantityError(problem)

        def force(solution):
            return magnitude(solution.inertia_force(link))

        return tuple(_range(solution, force) for solution in self._both)

    def frame(self, units=None):
        """All coefficients as a pandas DataFrame: quantity, unit, its value in each mechanism, and the ratio.

        Values within their proven bound, or within rounding of the largest force or torque, are 0. `units` is a
        dict of dimension to unit as of `in_units`.
        """
        table = self._as_frame((row.label, row.unit, *row.pair, row.ratio) for row in self.rows)
        return output_units(units, "frame").table(table)

    def error_bounds(self):
        """Proven bounds on the rounding errors of `frame`, a pandas DataFrame of the same rows and columns.

        NaN where nothing is proven: for means, numbers that are no quantity of the solution, and without
        `Solution.error_bound`.
        """
        return self._as_frame((row.label, row.unit, *row.bounds, row.bound_of_ratio) for row in self.rows)

    def _as_frame(self, rows):
        import pandas as pd

        columns = ["quantity", "unit", *self.names, "ratio"]
        return with_resolution(pd.DataFrame(list(rows), columns=columns).set_index("quantity"), *self._both)

    @cached_property
    def rows(self):
        """Rows of `frame`, a list: `label`, `unit`, the `pair` of values, `ratio` and bounds on the errors of each."""
        rows = [self._row("mean |balancing torque|", TORQUE, self.mean_torques)]
        signed = tuple(solution.mean_torque for solution in self._both)
        if any(signed):
            rows.append(Row("mean balancing torque", "N m", signed, ratio(*signed)))
            rows.append(Row("mean drive power", "W", self.mean_powers, ratio(*self.mean_powers)))
        rows += self._torque_rows()
        if lose(*self._both):
            both = [solution.losses for solution in self._both]
            for name in dict.fromkeys(name for losses in both for name in losses.lost):
                powers = tuple(losses.lost.get(name, np.nan) for losses in both)
                rows.append(Row(f"mean power lost, {name}", "W", powers, ratio(*powers)))
            rows.append(Row("mean power lost", "W", self.lost_powers, self.lost_power_ratio))
            rows.append(Row("efficiency", "1", tuple(losses.efficiency for losses in both), np.nan))
        for name in self._force_names:
            values, errors = self._ends(name, _largest)
            label = f"largest {label_of(self.reference, name)}"
            rows.append(self._row(label, name, tuple(map(abs, values)), errors))
        for bar in self.reference.mechanism.couplers:
            for which, pair in zip(ENDS, zip(*self.inertia_force_range(bar.link), strict=True), strict=True):
                rows.append(Row(f"{which} {bar.link} inertia force", "N", pair, np.nan))
        for which, find in ENDS.items():
            pair, errors = self._ends("cam_force", find)
            rows.append(Row(f"{which} cam force", "N", pair, np.nan, errors))
        rows.append(Row("power residual", "1", tuple(solution.power_residual for solution in self._both), np.nan))
        return [row for row in rows if not np.isnan(row.pair).all()]

    def _torque_rows(self):
        """Rows of the torque extrema, and of the largest torques if one of them is not an extremum."""
        reference, matched = self.torque_extremes
        own, other = (
            bounded.errors(TORQUE)[_are_outside_jumps(bounded.found[TORQUE])] for bounded in self._bounded_extremes
        )
        errors = zip(own, np.append(other, np.nan)[_partners(*self._torque_extrema)], strict=True)
        pairs = zip(reference.value, matched, strict=True)
        rows = [
            self._row(f"{EXTREMUM} {number}", TORQUE, pair, error)
            for number, (pair, error) in enumerate(zip(pairs, errors, strict=True), 1)
        ]
        paired = np.isfinite(matched)
        values, bounds = self._ends(TORQUE, _largest)
        peaks = self._row("largest |balancing torque|", TORQUE, tuple(map(abs, values)), bounds)
        for shown, peak in zip((reference.value, matched), peaks.pair, strict=True):
            if not np.isclose(np.abs(shown[paired]), peak, rtol=1e-9).any():
                return [*rows, peaks]
        return rows

    @property
    def _both(self):
        return self.reference, self.balanced

    @property
    def _force_names(self):
        """Joints that both mechanisms have, and shaking force and moment."""
        shared = [joint for joint in self.reference.reactions if joint in self.balanced.reactions]
        return [*shared, "shaking_force", "shaking_moment"]

    @cached_property
    def _torques(self):
        """Extremes of the torque of both mechanisms."""
        return [extremes(solution, TORQUE) for solution in self._both]

    @cached_property
    def _torque_extrema(self):
        """Extremes of the torque of both mechanisms, without the sides of jumps."""
        both = ((found, _are_outside_jumps(found)) for found in self._torques)
        return [
            replace(found, angle=found.angle[kept], value=found.value[kept], maximum=found.maximum[kept])
            for found, kept in both
        ]

    @cached_property
    def _bounded_extremes(self):
        """Extremes of all quantities in the rows, of both mechanisms."""
        names, both = (*self._force_names, "cam_force"), zip(self._both, self._torques, strict=True)
        return [
            BoundedExtremes(at, {TORQUE: torque} | {name: extremes(at, name) for name in names if name in of_scene(at)})
            for at, torque in both
        ]

    def _ends(self, name, find):
        """Values that `find` chooses from the extremes of each mechanism, and bounds on their errors."""
        unknown = (np.nan,) * 3
        both = self._bounded_extremes
        ends = [bounded.end(name, find) if name in bounded.found else unknown for bounded in both]
        values, _, errors = zip(*ends, strict=True)
        return values, errors

    def _row(self, label, name, values, errors=(np.nan, np.nan)):
        """Row of a quantity of both mechanisms, 0 where a value is rounding."""
        each = zip(self._both, values, errors, strict=True)
        pair = tuple(float(without_rounding(solution, name, [value], error)[0]) for solution, value, error in each)
        return Row(label, unit_of(self.reference, name), pair, ratio(*pair), errors)


class Row(NamedTuple):
    """Row of the table: values in both mechanisms, bounds on their errors."""

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
    """Labels of the torque extrema that a table omits if they are many: all but each column's smallest and largest.

    `rows` are the values of the columns by label.
    """
    labels = [label for label in rows if label.startswith(EXTREMUM)]
    if len(labels) <= MAX_LISTED:
        return []
    columns = np.array([rows[label] for label in labels], dtype=float).T
    ends = {find(column) for column in columns if not np.isnan(column).all() for find in (np.nanargmin, np.nanargmax)}
    return [label for place, label in enumerate(labels) if place not in ends]


def compare(reference, balanced):
    """Compare two solutions, by dynamic coefficients.

    Parameters
    ----------
    reference, balanced : Solution, or Running as `ks.drive.steady` returns it
        Each of one design; their own crank angles do not matter.

    Returns
    -------
    Comparison
        Ratios reference / balanced: `.torque_extremum_ratios`, `.mean_torque_ratio`, `.peak_reaction_ratio(joint)`,
        `.lost_power_ratio` with friction; ranges of cam and inertia force, `.frame()`. For machines in periodic running
        also figures of their drives: see `drive.savings.DrivenComparison`.

    Examples
    --------
    How much does a counterweight on the crank reduce, and where?

    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, coupler=ks.Link(2.0, 0.15, 0.015), slider=ks.Link(5.0))
    >>> weight = ks.Counterweight(arm=-0.05)
    >>> balanced = ks.balancing.partial(mower, crank=weight).mechanism
    >>> found = ks.compare(*(ks.solve(item, 0.0, crank_speed=63.0) for item in (mower, balanced)))
    >>> print(f"{found.peak_reaction_ratio('O'):.2f} {found.mean_torque_ratio:.2f}")  # reference / balanced
    2.06 1.00
    """
    reference, balanced = (
        given.solution if hasattr(given, "energy_flow") else given  # periodic running
        for given in (reference, balanced)
    )
    checks.require("compare", checks.solution("reference", reference), checks.solution("balanced", balanced))
    kinds = {getattr(solution, "COMPARISON", Comparison) for solution in (reference, balanced)}
    return (kinds.pop() if len(kinds) == 1 else Comparison)(reference, balanced)


def _largest(values):
    return np.argmax(np.abs(values))


def ratio(reference, balanced):
    """Ratio of two peaks; infinite where the balanced one is rounding, NaN if neither has a value."""
    if abs(balanced) > 1e-12 * abs(reference):
        return reference / balanced
    return np.inf if abs(reference) > 0 and np.isfinite(balanced) else np.nan


def _range(solution, quantity):
    try:
        return extremes(solution, quantity).range
    except QuantityError:
        return np.nan, np.nan


def _partners(reference, balanced):
    """Index of the balanced extremum that belongs to each of the reference (K,), -1 where there is none.

    Pairs are of one kind (maximum or minimum), one to one, with the least sum of distances in crank angle.
    """
    period, own = reference.solution.period, balanced.solution.period
    times = max(1, round(period / own))
    angle = np.ravel(balanced.angle + own * np.arange(times)[:, None])
    maximum, second = (np.tile(part, times) for part in (balanced.maximum, _are_second_sides(balanced)))
    distance = np.abs((reference.angle[:, None] - angle + period / 2) % period - period / 2)
    distance = distance + ANGLE_TOLERANCE * (_are_second_sides(reference)[:, None] != second)
    same_kind = reference.maximum[:, None] == maximum
    distance = np.where(same_kind, np.minimum(distance, PARTNER_DISTANCE), PARTNER_DISTANCE)
    rows = np.flatnonzero((distance < PARTNER_DISTANCE).any(axis=1))
    columns = distance[rows].argmin(axis=1) if rows.size else rows
    if np.unique(columns).size < columns.size:  # the nearest of two are the same
        from scipy.optimize import linear_sum_assignment

        rows, columns = linear_sum_assignment(distance)
        near = distance[rows, columns] < PARTNER_DISTANCE
        rows, columns = rows[near], columns[near]
    found = np.full(len(reference), -1)
    found[rows] = columns % max(len(balanced), 1)
    return found


def _are_outside_jumps(found):
    """Mask (K,) of the extrema that are not the two sides of a jump between the extrema before and after it."""
    keep = np.ones(len(found), dtype=bool)
    for second in np.flatnonzero(_are_second_sides(found)) if len(found) > 2 else ():
        sides = slice(second - 1, second + 1)
        low, high = sorted((found.value[second - 2], found.value[(second + 1) % len(found)]))
        if ((low < found.value[sides]) & (found.value[sides] < high)).all():
            keep[sides] = False
    return keep


def _are_second_sides(found):
    """Mask (K,) of the extrema that follow another one at the same crank angle: the value after a limit or jump."""
    return np.diff(found.angle, prepend=-1.0) <= ANGLE_TOLERANCE

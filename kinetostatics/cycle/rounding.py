"""Rounding of extremes: proven error bounds, and zeros for values within rounding of their bound or terms."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..engines.engines import NUMPY
from ..engines.error_bounds import of_magnitude
from ..errors import NotGivenError
from ..mechanics.quantities import largest_term, largest_term_in, of_scene, unit_of
from ..numbers.formatting import number
from ..numbers.lazy import cached_property

FLOOR = 1e-13
"""Size, relative to the largest term of a quantity, below which a value or a rise counts as rounding."""
PLACED = 1e-7
"""Crank angle, rad, below which the angle of an extremum counts as 0: values around it agree to all digits."""
AT_JUMP = 1e-6
"""Distance from a jump, rad, within which a bound may belong to the value on its other side."""
MAX_LISTED = 24
"""Largest number of extremes listed one by one; of more, as with a measured load, only the smallest and the largest."""
BOUND_OFFSET = 1e-4
"""Distance from a jump, rad, at which bounds belong to one side."""


class End(NamedTuple):
    """Smallest or largest value of a quantity, its crank angle, and a bound on its error; NaN if unknown."""

    value: float
    angle: float
    error: float


@dataclass(frozen=True, eq=False)
class BoundedExtremes:
    """Extremes of several quantities of a solution, with proven bounds on their rounding errors.

    Attributes
    ----------
    solution : Solution
    found : mapping of name to Extremes
    """

    solution: Any
    found: Mapping[str, Any]

    def errors(self, name):
        """Proven bounds on the rounding errors of a quantity's extrema, (K,); NaN where nothing is proven."""
        errors = self._bounds.get(name, np.full(len(self.found[name]), np.nan))
        return np.where(np.isfinite(errors), errors, np.nan)

    def end(self, name, find):
        """`End` at the index that `find` (`np.argmin`, `np.argmax`) returns for the values; or the constant.

        Of values that are equal to rounding it is the first.
        """
        item = self.found[name]
        if not len(item):
            return End(float(item.constant), np.nan, np.nan)
        level = np.abs(item.value - item.value[find(item.value)]) <= FLOOR * np.abs(item.value).max()
        place = int(np.argmax(level)) if level.any() else find(item.value)
        return End(*(float(part[place]) for part in (item.value, item.angle, self.errors(name))))

    @cached_property
    def _bounds(self):
        """Bounds by name, computed together and cached for all solutions of the same turn; empty if none exist.

        At a jump the bound is the larger one of both sides.
        """
        turn = self.solution.sampled
        known = {
            name: bounds
            for name, item in self.found.items()
            if len(item) and (bounds := turn.bounds.get((name, item.angle.tobytes()))) is not None
        }
        found = {name: item for name, item in self.found.items() if len(item) and name not in known}
        if not found:
            return known
        angle = np.unique(np.concatenate([item.angle for item in found.values()]))
        jumps = np.flatnonzero((np.abs(angle[:, None] - turn.kinks) < AT_JUMP).any(axis=1))
        beside = np.concatenate([angle[jumps] - BOUND_OFFSET, angle[jumps] + BOUND_OFFSET])
        at = turn.at.moved_to(np.append(angle, beside))
        engine = NUMPY if getattr(at.engine, "compiled", False) else at.engine  # no loop is compiled for a table
        try:
            values, errors = engine.with_bounds(at.dynamics, tuple(found))
        except NotGivenError:
            return known
        vectors = [name for name in found if of_scene(self.solution)[name].vector]
        errors = errors | {name: of_magnitude(values[name], errors[name]) for name in vectors}
        for name, item in found.items():
            own, sides = np.array(errors[name][: angle.size]), errors[name][angle.size :].reshape(2, -1)
            own[jumps] = np.fmax(*sides)
            known[name] = turn.bounds[name, item.angle.tobytes()] = own[np.searchsorted(angle, item.angle)]
        return known


def without_rounding(solution, name, values, bound=0.0):
    """Values of a quantity, 0 where they are within `bound`, or rounding relative to the largest term of the quantity.

    The parameters of a balanced machine are rounded, so a value that should be 0 may exceed its bound.
    """
    terms = np.append(np.abs(values), largest_term(solution, name))
    # a pressure is a root of a force
    floor = np.sqrt(FLOOR) if of_scene(solution)[name].kind == "contact" else FLOOR
    floor = floor * np.max(terms, where=np.isfinite(terms), initial=0.0)
    return zeroed(values, np.where(np.isfinite(bound), np.fmax(floor, bound), floor))


def extremes_text(extremes):
    """`Extremes` as text, with unit, in the digits certain by their error bounds."""
    solution, name, unit, gaps = extremes.solution, extremes.quantity, "", ""
    values, errors = extremes.value, np.full(len(extremes), np.nan)
    if solution is not None:
        errors = BoundedExtremes(solution, {name: extremes}).errors(name)
        values = without_rounding(solution, name, values, errors)
        own, gaps = unit_of(solution, name), solution.sampled.unclosed
        unit, gaps = f" {own}" if own != "1" else "", gaps and f"; it {gaps}"
    if not len(extremes):
        same = "no value" if np.isnan(extremes.constant) else f"{number(extremes.constant)}{unit} all over the period"
        return "\n".join(filter(None, [f"no extremes of {name}: {same}{gaps}", extremes.note]))
    known = zip(np.degrees(extremes.angle), values, errors, strict=True)
    rows = [f"{angle:12.6f} deg  {number(value, bound=error):>11}{unit}" for angle, value, error in known]
    lines = [f"{len(extremes)} extremes of {name}{gaps}", *rows]
    if len(rows) > MAX_LISTED:
        ends = sorted({int(np.argmin(extremes.value)), int(np.argmax(extremes.value))})
        more = f"the smallest and the largest; .angle and .value have {len(rows) - len(ends)} more between"
        lines = [*lines[:1], *(rows[place] for place in ends), more]
    return "\n".join(filter(None, [*lines, extremes.note]))


def zeroed(values, floor):
    """Values, 0 where their size is at most `floor`."""
    return np.where(np.abs(values) <= floor, 0.0, values)


def curve_values(solution, quantity, turn=None):
    """Values of a `Quantity` over the crank angles, (1 or 2, N), SI; those within rounding in the `turn` are 0.

    `turn` is a solution over the period, by default the same one.
    """
    floor = FLOOR * float(np.max(largest_term_in(solution if turn is None else turn, quantity.unit)))
    found = quantity.read(solution)
    parts = found if quantity.vector else (found,)
    return zeroed(np.stack([np.broadcast_to(part, solution.crank_angle.shape) for part in parts]), floor)

"""What of a table is rounding: values within their proven bounds, or small beside the largest term of their sum."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..engines.engines import NUMPY
from ..engines.error_bounds import of_magnitude
from ..errors import NotGivenError
from ..mechanics.quantities import largest_term, of_scene, unit_of
from ..numbers.formatting import number
from ..numbers.lazy import cached_property

FLOOR = 1e-13
"""Size, relative to the terms that a quantity is made of, below which it is rounding: neither a value nor a rise."""
PLACED = 1e-7
"""Crank angle, rad, below which the place of an extremum is 0: values about it agree to all digits."""
AT_JUMP = 1e-6
"""Distance from a jump, rad, within which a bound may be of what stands beyond it."""
MOST = 24
"""Extremes of a curve that are told one by one; of more, as a measured load makes, the smallest and the largest."""
BESIDE = 1e-4
"""Distance from a jump, rad, at which bounds are those of one side."""


class End(NamedTuple):
    """A value at an end of a quantity's range, its crank angle, and by how much it may be wrong; NaN if unknown."""

    value: float
    angle: float
    error: float


@dataclass(frozen=True, eq=False)
class Known:
    """Extremes of several quantities of a solution, and what is known of their rounding.

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
        """The extremum whose place a function finds among the values; of a constant that."""
        item = self.found[name]
        if not len(item):
            return End(float(item.constant), np.nan, np.nan)
        place = find(item.value)
        return End(*(float(part[place]) for part in (item.value, item.angle, self.errors(name))))

    @cached_property
    def _bounds(self):
        """By name, all computed together; none where none can be given.

        Of a value that is told from one side of a jump, the bound is that of the values beside.
        """
        found = {name: item for name, item in self.found.items() if len(item)}
        if not found:
            return {}
        angle = np.unique(np.concatenate([item.angle for item in found.values()]))
        jumps = np.flatnonzero((np.abs(angle[:, None] - self.solution.sampled.kinks) < AT_JUMP).any(axis=1))
        at = self.solution.at(np.concatenate([angle, angle[jumps] - BESIDE, angle[jumps] + BESIDE]))
        engine = NUMPY if getattr(at.engine, "compiled", False) else at.engine  # no loop is compiled for a table
        try:
            values, errors = engine.with_bounds(at.dynamics, tuple(found))
        except NotGivenError:
            return {}
        vectors = [name for name in found if of_scene(self.solution)[name].vector]
        errors = errors | {name: of_magnitude(values[name], errors[name]) for name in vectors}
        places = {name: np.searchsorted(angle, item.angle) for name, item in found.items()}
        return {name: _of_a_side(errors[name], angle.size, jumps)[place] for name, place in places.items()}


def _of_a_side(errors, count, jumps):
    """Bounds at so many crank angles; at jumps the larger of those beside, which stand behind the others."""
    own, sides = np.array(errors[:count]), errors[count:].reshape(2, -1)
    own[jumps] = np.fmax(*sides)
    return own


def without_rounding(solution, name, values, bound=0.0):
    """Values of a quantity, 0 where they are within a bound on their errors, or rounding of what it is a sum of.

    Numbers by which a machine is balanced are rounded themselves, so what is 0 by them may be more than its bound.
    """
    terms = np.append(np.abs(values), largest_term(solution, name))
    # a pressure is a root of a force
    floor = np.sqrt(FLOOR) if of_scene(solution)[name].kind == "contact" else FLOOR
    floor = floor * np.max(terms, where=np.isfinite(terms), initial=0.0)
    return zeroed(values, np.where(np.isfinite(bound), np.fmax(floor, bound), floor))


def known_values(extremes):
    """Values of extremes, rounding as 0, and bounds on their errors, NaN where nothing is proven."""
    solution, name = extremes.solution, extremes.quantity
    if solution is None:
        return extremes.value, np.full(len(extremes), np.nan)
    errors = Known(solution, {name: extremes}).errors(name)
    return without_rounding(solution, name, extremes.value, errors), errors


def told(extremes):
    """Extremes as text, with their unit and the digits that are known."""
    known = zip(np.degrees(extremes.angle), *known_values(extremes), strict=True)
    solution, unit, beside = extremes.solution, "", ""
    if solution is not None:
        own, gaps = unit_of(solution, extremes.quantity), solution.sampled.unclosed
        unit, beside = f" {own}" if own != "1" else "", gaps and f"; it {gaps}"
    if not len(extremes):
        same = "no value" if np.isnan(extremes.constant) else f"{number(extremes.constant)}{unit} all over the period"
        return f"no extremes of {extremes.quantity}: {same}{beside}"
    rows = [f"{angle:12.6f} deg  {number(value, bound=error):>11}{unit}" for angle, value, error in known]
    lines = [f"{len(extremes)} extremes of {extremes.quantity}{beside}", *rows]
    if len(rows) > MOST:
        ends = sorted({int(np.argmin(extremes.value)), int(np.argmax(extremes.value))})
        more = f"the smallest and the largest; .angle and .value have {len(rows) - len(ends)} more between"
        lines = [*lines[:1], *(rows[place] for place in ends), more]
    return "\n".join(lines)


def zeroed(values, floor):
    """Values, 0 where they are no larger than a floor."""
    return np.where(np.abs(values) <= floor, 0.0, values)

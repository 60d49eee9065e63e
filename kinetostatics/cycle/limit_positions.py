"""The period over which results are reduced: pieces, kinks, gaps, limit positions, and limits of a quantity there.

Rates and forces change faster and faster toward a limit position, so pieces get narrower there. Samples without a
correct digit are left out; the limits of the quantity from both sides replace them.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..machine.loads import TURN, refusals
from ..mechanics import assembly, energy_contact
from ..numbers import checks
from ..numbers.lazy import cached_property
from .kinks import ANGLE_TOLERANCE, FINE_SAMPLES, kinks_and_jumps
from .load_functions import repeating_problem
from .piecewise import JUMP_OFFSET, Pieces

MAX_WIDTH = TURN / 8
"""Width of a piece, rad."""
NEAR = 0.01
"""Closure margin below which pieces get narrower toward the limit position."""
MAX_CONDITION = 1e14
"""Condition above which a value has less than two correct digits and is left out."""
MAX_LIMIT_CONDITION = 1e12
"""Condition up to which values are used to extrapolate to a limit."""
EDGE_DISTANCES = 0.02 * 2.0 ** -np.arange(26)
"""Distances of added edges from a limit position, rad, on both sides."""
LIMIT_DISTANCES = 0.1 * 2.0 ** (-np.arange(120) / 3)
"""Distances of the samples for a limit from its limit position, rad; every third distance is half the previous one."""
MIN_GROWTH = 1.15
"""Growth of the change per halved distance above which a quantity grows without bound."""
MIN_ANGLE_STEP = 2.0**-50
"""Smallest change of a crank angle, rad."""


@dataclass(frozen=True, eq=False)
class Turn:
    """Pieces of the period of one design, and samples at their points; `Turn.of` returns them.

    Attributes
    ----------
    at : Solution
        At `angle`, rising: `Pieces.check_angles`, and the limit positions.
    pieces : Pieces
    gaps : tuple of (float, float)
        Crank angles between which the mechanism does not close.
    limits : array
        Crank angles at which a group is in a limit position, or nearly so, ends of gaps included.
    kinks : array
        Crank angles at which friction, a load or the law of a cam has a kink, or may jump.
    jumps : array
        The `kinks` that may be jumps.
    passed : array
        The change points among `limits` that the mechanism passes, where forces grow; empty unless `forces` is True.
    extrema : dict
        Extrema by quantity, cached.
    bounds : dict
        Bounds on the rounding errors of extrema by quantity and the bytes of their crank angles, cached.
    """

    at: Any
    pieces: Pieces
    gaps: tuple[tuple[float, float], ...]
    limits: np.ndarray
    kinks: np.ndarray
    jumps: np.ndarray
    passed: np.ndarray
    extrema: dict[str, Any] = field(default_factory=dict, init=False)
    bounds: dict[tuple[str, bytes], Any] = field(default_factory=dict, init=False)
    _beside_limits: dict[tuple[float, int], Any] = field(default_factory=dict, init=False)
    """Solutions close to limit positions, by the crank angle of the position and the side."""

    @classmethod
    def of(cls, solution, forces=False):
        """Turn of a solution, independent of its crank angles; `forces` adds the change points that it passes.

        Raises
        ------
        ParameterError
            The solution depends on a table over its own crank angles, or a load does not repeat after its period.
        """
        period = solution.period
        kinks, jumps = kinks_and_jumps(solution)
        gaps, limits, passed = _limit_positions(solution, forces)
        graded = np.ravel(limits[:, None] + np.concatenate([-EDGE_DISTANCES, [0.0], EDGE_DISTANCES]))
        pieces = Pieces.between(np.mod(np.concatenate([kinks, graded]), period)[None], period, MAX_WIDTH)
        angle = pieces.check_angles.ravel()
        first = solution.at(np.unique(np.concatenate([angle, limits])) if limits.size else angle)
        if problem := repeating_problem(solution):
            raise ParameterError(problem)
        checks.require("extremes", *refusals(first), *energy_contact.refusals(first))
        return cls(first, pieces, gaps, limits, kinks, jumps, passed)

    @cached_property
    def period(self):
        return self.at.period

    @cached_property
    def points(self):
        """Indices (pieces, points + 2) of the samples at `Pieces.check_angles`."""
        return np.searchsorted(self.angle, self.pieces.check_angles)

    @cached_property
    def even(self):
        """The solution at even crank angles, for the tests of friction."""
        return self.at.moved_to(np.linspace(0.0, self.period, round(FINE_SAMPLES * self.period / TURN), endpoint=False))

    @property
    def beside_kinks(self):
        """Crank angles of the kinks, and on both sides of jumps, rising, rad."""
        sides = np.mod(np.ravel(self.jumps[:, None] + [-JUMP_OFFSET, JUMP_OFFSET]), self.period)
        return np.unique(np.concatenate([self.kinks, sides]))

    @property
    def angle(self):
        return self.at.crank_angle

    @cached_property
    def condition(self):
        """Condition at each sample; 1 where no limit position is near."""
        return self._condition(self.at) if self.limits.size else np.ones(self.angle.size)

    def _condition(self, solution):
        if not self.passed.size:
            return solution.condition
        found = solution._condition_with_reactions
        distance = (solution.crank_angle[:, None] - self.passed + self.period / 2) % self.period - self.period / 2
        with np.errstate(divide="ignore"):  # forces grow as 1 / distance, also at 0, near which angles are exact
            return np.fmax(found, 1.0 / np.abs(distance).min(axis=-1))

    @cached_property
    def usable(self):
        """Whether rates and forces have correct digits, at each angle."""
        with np.errstate(invalid="ignore"):
            return self.condition < MAX_CONDITION

    @cached_property
    def lost(self):
        """Crank angles inside the closed intervals around which rates and forces have no correct digit, rad."""
        good = self.usable | np.isnan(self.condition)
        if good.all():
            return np.empty(0)
        places = []
        for run in runs(~good):
            low, high = self.angle[run[0]], self.angle[run[-1]]
            middle = [angle for angle in self.limits if (angle - low) % self.period <= (high - low) % self.period]
            if not any(_beside(angle, np.append(self.edges, self.passed)) for angle in middle):
                places.append(middle[0] if middle else self.angle[run[run.size // 2]])
        return np.array(places)

    @cached_property
    def edges(self):
        """Ends of the gaps, rad."""
        return np.mod(np.ravel(self.gaps), self.period)

    @property
    def unclosed(self):
        """Text of the gaps for messages, empty without gaps."""
        where = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g}" for start, stop in self.gaps)
        return where and f"does not close for crank angles {where} deg"

    def evaluate(self, function, angle):
        """Values of a function of a solution at any crank angles."""
        return function(self.at.moved_to(np.mod(angle, self.period)))

    def limit(self, function, angle, side, size=0.0):
        """Limit of a function of a solution at a limit position, from one side (+1: from greater crank angles).

        `size` is the size of the function elsewhere. Infinite if it grows without bound, NaN if no values with correct
        digits are near.
        """
        angle, distance = float(angle % self.period), LIMIT_DISTANCES
        if (angle, side) not in self._beside_limits:
            self._beside_limits[angle, side] = self.at.moved_to(np.mod(angle + side * distance, self.period))
        near = self._beside_limits[angle, side]
        values = np.asarray(function(near), dtype=float)
        with np.errstate(invalid="ignore"):
            condition = self._condition(near)
            trusted = np.isfinite(values) & (condition < MAX_LIMIT_CONDITION)
        count = trusted.size if trusted.all() else int(np.argmin(trusted))
        if count < 10:
            return np.nan
        values, distance = values[:count], distance[:count]
        size = max(size, np.abs(values).max())
        change = np.diff(values[(count - 1) % 3 :: 3])
        steps = np.abs(change[-3:])
        if steps[-1] > 1e-3 * size and np.all(steps[1:] > MIN_GROWTH * steps[:-1]):
            return np.copysign(np.inf, change[-1])
        edge = np.isclose(angle, self.edges, rtol=0, atol=ANGLE_TOLERANCE).any()
        place = np.sqrt(distance) if edge else distance  # at the end of a gap rates change with its root
        weight = 1.0 / (1e-10 + 1e-16 * condition[:count])
        fit = np.polynomial.Polynomial.fit(place, values, min(6, count - 3), domain=[0.0, place[0]], w=weight)(0.0)
        there = angle
        if edge:  # the last crank angle at which the mechanism closes to rounding, where positions lose no digits
            ends = angle - side * np.append(0.0, MIN_ANGLE_STEP * 2.0 ** np.arange(30))
            closed = self.evaluate(lambda at: at.dynamics.closed, ends)
            there = ends[np.flatnonzero(closed)[-1]] if closed.any() else angle
        direct = float(self.evaluate(function, np.array([there]))[0])
        if abs(direct - fit) <= 1e-3 * size and (edge or abs(direct - values[-1]) <= 2 * steps[-1]):
            return direct
        return float(np.clip(fit, *np.sort([values[-1] - 4 * change[-1], values[-1] + 4 * change[-1]])))

    def clear(self, angle):
        """Crank angles; those where rates and forces have no correct digit become the nearest usable sample."""
        if self.usable.all():
            return angle
        right = np.flatnonzero(self.usable)
        places = np.concatenate([self.angle[right[-1:]] - self.period, self.angle[right], self.angle[right[:1]]])
        places[-1] += self.period
        after = np.searchsorted(places, angle)
        low, high = places[after - 1], places[np.minimum(after, places.size - 1)]
        index = np.searchsorted(self.angle, angle)
        inside = ~self.usable[index % self.usable.size] | ~self.usable[index - 1]
        return np.where(inside, np.where(angle - low < high - angle, low, high), angle)


def _limit_positions(solution, forces):
    """Gaps, limit positions, and the change points passed among these, over the period of a solution."""
    mechanism, period = solution.mechanism, solution.period
    near, passed = assembly.limit_angles(mechanism, NEAR), np.array(mechanism.change_points if forces else ())
    if not (near.size or passed.size):
        return (), near, passed
    gaps = assembly.gap_intervals(mechanism) if near.size else ()
    own = TURN * mechanism.turns
    near = np.concatenate([near, *gaps])
    near = np.unique(np.mod(near + ANGLE_TOLERANCE, own) - ANGLE_TOLERANCE)
    near = near[np.diff(near, prepend=-1.0) > 2 * ANGLE_TOLERANCE]
    starts = own * np.arange(round(period / own))
    limits = np.ravel(near + starts[:, None])
    passed = np.ravel(passed + TURN * np.arange(round(period / TURN))[:, None])
    limits = np.sort(np.concatenate([limits[~_beside(limits, passed)], passed]))
    return tuple((a + start, b + start) for start in starts.tolist() for a, b in gaps), limits, passed


def _beside(angle, others):
    """Whether crank angles equal one of others within `ANGLE_TOLERANCE`."""
    return np.isclose(np.asarray(angle)[..., None], others, rtol=0, atol=ANGLE_TOLERANCE).any(axis=-1)


def runs(marked):
    """Indices of marked samples around the turn, one array for each unbroken run, from the first unmarked sample on."""
    order = np.roll(np.arange(marked.size), -int(np.argmin(marked)))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], marked[order].astype(int), [0]])))
    return [order[start:stop] for start, stop in zip(edges[::2], edges[1::2], strict=True)]


def require_single(solution, owner, name):
    """Raise `ParameterError` for a batch of designs."""
    *designs, _ = solution.moved_to(np.zeros(1)).shape
    if designs:
        raise ParameterError(
            f"{owner} works on one design at a time, but {name!r} has shape {(*designs, FINE_SAMPLES)}; solve a single "
            "design of the batch"
        )

"""The turn that results are reduced over: where it is sampled, and what has no correct digit there.

Near a limit position rates and forces change within a distance as small as they like, so samples grow denser there;
where nothing of them is right they are left out, and what the quantity tends to on both sides stands in their place.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..errors import ParameterError
from ..machine.loads import TURN, has_no_user_code, kink_sources, kinks_of, period_of, period_on, refusals
from ..mechanics import assembly, energy_contact
from ..mechanics.load_values import title_of, user_value
from ..numbers import checks
from ..numbers.lazy import cached_property
from .changes import sign_changes

SAMPLES = 1440
"""Samples a turn that bracket extrema, beside those at and between kinks: two nearer than these may pass unseen."""
FINER = 5
"""How many times as many there are where a load is a function, which may have narrow pulses."""
NEAR = 0.01
"""Closure margin below which samples grow denser: peaks there are narrower than a few degrees."""
USABLE = 1e14
"""Condition from which a value has less than two correct digits, and is left out."""
TRUSTED = 1e12
"""Condition up to which values tell what a quantity tends to."""
LADDER = 0.02 * 2.0 ** -np.arange(40)
"""Distances from a limit position, rad, at which samples are added on both sides."""
APPROACH = 0.1 * 2.0 ** (-np.arange(120) / 3)
"""Distances from a limit position, rad, by which it is approached; every third is half as far."""
GROWING = 1.15
"""How much more a quantity must change each time the distance is halved to grow without bound."""
BETWEEN = (2.0**-20, 0.5, 1.0 - 2.0**-20)
"""Shares of the way from one kink to the next at which samples stand: they tell how a curve leaves and nears each."""
BESIDE = (-(2.0**-44), 2.0**-44)
"""Distances from a jump, rad, at which samples stand on both sides of it."""
SAME = 1e-9
"""Crank angles this near, rad, are the same."""
LONGEST = 6
"""Periods after which a function is looked at that does not repeat after one."""
SMALLEST = 2.0**-50
"""Step of a crank angle that changes it, rad."""
ALIKE = 1e-6
"""Share of its largest value by which a force may differ after a period: rounding, at most."""


@dataclass(frozen=True, eq=False)
class Turn:
    """One design over its period, sampled; made by `Turn.of`.

    Attributes
    ----------
    at : Solution
        At `angle`, rising from 0, evenly but for the neighbourhood of limit positions.
    period : float
    gaps : tuple of (float, float)
        Crank angles between which the mechanism does not close.
    limits : array
        Crank angles at which a group stands in a limit position, or nearly so, ends of gaps among them.
    kinks : array
        Crank angles at which friction, a load or the law of a cam has a kink, or may jump.
    passed : array
        Those of `limits` that are change points passed, where forces grow; empty where no forces are asked for.
    jumps : array
        Those of `kinks` at which something may jump: samples stand on both sides, `BESIDE` them.
    """

    at: Any
    period: float
    gaps: tuple[tuple[float, float], ...]
    limits: np.ndarray
    kinks: np.ndarray
    passed: np.ndarray = field(default_factory=lambda: np.empty(0))
    jumps: np.ndarray = field(default_factory=lambda: np.empty(0))

    @classmethod
    def of(cls, solution, forces=False):
        """Turn of a solution, whatever its own crank angles; of its `forces` where it passes change points.

        Raises
        ------
        ParameterError
            The solution depends on a table over its own crank angles, or a load does not repeat after its period.
        """
        turns = round(solution.period / TURN)
        count = SAMPLES * turns * (1 if all(map(has_no_user_code, solution.loads)) else FINER)
        grid = np.linspace(0.0, solution.period, count, endpoint=False)
        kinks, jumps = _kinks(solution)
        if kinks.size:
            between = kinks[:, None] + np.diff(kinks, append=kinks[0] + solution.period)[:, None] * BETWEEN
            more = np.concatenate([kinks, between.ravel(), np.ravel(jumps[:, None] + BESIDE)])
            grid = np.unique(np.concatenate([grid, np.mod(more, solution.period)]))
        first = solution.at(grid)
        require_repeating(solution)
        checks.require("extremes", *refusals(first), *energy_contact.refusals(first))
        near = assembly.limit_angles(solution.mechanism, NEAR)
        gaps = assembly.gap_intervals(solution.mechanism) if near.size else ()
        own = TURN * solution.mechanism.turns
        near = np.concatenate([near, *gaps])
        near = np.unique(np.mod(near + SAME, own) - SAME)
        near = near[np.diff(near, prepend=-1.0) > 2 * SAME]
        limits = np.ravel(near + own * np.arange(round(solution.period / own))[:, None])
        passed = np.array(solution.mechanism.change_points if forces else ())
        passed = np.ravel(passed + TURN * np.arange(turns)[:, None])
        limits = np.sort(np.concatenate([limits[~_beside(limits, passed)], passed]))
        if not limits.size:
            return cls(first, solution.period, (), limits, kinks, jumps=jumps)
        dense = limits[:, None] + np.concatenate([-LADDER, [0.0], LADDER])
        angle = np.unique(np.concatenate([grid, np.mod(dense.ravel(), solution.period)]))
        starts = own * np.arange(round(solution.period / own))
        repeated = tuple((a + start, b + start) for start in starts.tolist() for a, b in gaps)
        return cls(solution.at(angle), solution.period, repeated, limits, kinks, passed, jumps)

    @property
    def angle(self):
        return self.at.crank_angle

    @cached_property
    def extrema(self):
        """Extrema by quantity, kept when they are first computed."""
        return {}

    @property
    def panels(self):
        """Number of panels from which a quadrature starts: two samples wide."""
        return round(self.period / np.diff(self.angle).max() / 2)

    @cached_property
    def condition(self):
        """Condition at each angle, not looked at where no limit position is near."""
        return self._condition(self.at) if self.limits.size else np.ones(self.angle.size)

    def _condition(self, solution):
        if not self.passed.size:
            return solution.condition
        found = solution._condition_with_reactions
        distance = (solution.crank_angle[:, None] - self.passed + self.period / 2) % self.period - self.period / 2
        with np.errstate(divide="ignore"):  # forces grow as one over it, also at 0, near which angles are exact
            return np.fmax(found, 1.0 / np.abs(distance).min(axis=-1))

    @cached_property
    def usable(self):
        """Whether rates and forces have correct digits, at each angle."""
        with np.errstate(invalid="ignore"):
            return self.condition < USABLE

    @cached_property
    def lost(self):
        """Crank angles inside the closed intervals around which rates and forces have no correct digit, rad."""
        good = self.usable | np.isnan(self.condition)
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
        """What is to be said of the gaps, if there are any."""
        where = ", ".join(f"{np.degrees(start):.6g} .. {np.degrees(stop):.6g}" for start, stop in self.gaps)
        return where and f"does not close for crank angles {where} deg"

    def evaluate(self, function, angle):
        """Values of a function of a solution at any crank angles."""
        return function(self.at.at(np.mod(angle, self.period)))

    def from_zero(self, angle, jumps):
        """Angles from 0 on, 0 where they are that but for rounding, unless what is looked at `jumps` from there."""
        found, whole = np.maximum(np.mod(angle + SAME, self.period) - SAME, 0.0), np.mod(angle, self.period)
        last = found < whole - SAME
        return np.where(last & jumps(found, whole), whole, found) if last.any() else found

    @cached_property
    def _approached(self):
        """Solutions beside limit positions, by the crank angle of these and the side."""
        return {}

    def limit(self, function, angle, side, size=0.0):
        """What a function of a solution tends to at a limit position from one side (+1: from greater crank angles).

        `size` is how large it is elsewhere. Infinite if it grows without bound, NaN if no correct digits are near
        enough to tell.
        """
        angle, distance = float(angle % self.period), APPROACH
        if (angle, side) not in self._approached:
            self._approached[angle, side] = self.at.at(np.mod(angle + side * distance, self.period))
        near = self._approached[angle, side]
        values = np.asarray(function(near), dtype=float)
        with np.errstate(invalid="ignore"):
            condition = self._condition(near)
            trusted = np.isfinite(values) & (condition < TRUSTED)
        count = trusted.size if trusted.all() else int(np.argmin(trusted))
        if count < 10:
            return np.nan
        values, distance = values[:count], distance[:count]
        size = max(size, np.abs(values).max())
        change = np.diff(values[(count - 1) % 3 :: 3])
        steps = np.abs(change[-3:])
        if steps[-1] > 1e-3 * size and np.all(steps[1:] > GROWING * steps[:-1]):
            return np.copysign(np.inf, change[-1])
        edge = np.isclose(angle, self.edges, rtol=0, atol=SAME).any()
        place = np.sqrt(distance) if edge else distance  # by the root of the distance rates change at the end of a gap
        weight = 1.0 / (1e-10 + 1e-16 * condition[:count])
        fit = np.polynomial.Polynomial.fit(place, values, min(6, count - 3), domain=[0.0, place[0]], w=weight)(0.0)
        there = self._outermost(angle, side) if edge else angle
        direct = float(self.evaluate(function, np.array([there]))[0])
        if abs(direct - fit) <= 1e-3 * size and (edge or abs(direct - values[-1]) <= 2 * steps[-1]):
            return direct
        return float(np.clip(fit, *np.sort([values[-1] - 4 * change[-1], values[-1] + 4 * change[-1]])))

    def _outermost(self, end, side):
        """Last crank angle at which the mechanism closes to rounding, where positions lose nothing."""
        angle = end - side * np.append(0.0, SMALLEST * 2.0 ** np.arange(30))
        closed = self.evaluate(lambda at: at.dynamics.closed, angle)
        return angle[np.flatnonzero(closed)[-1]] if closed.any() else end

    def clear(self, angle):
        """The crank angles, those where rates and forces have no correct digit moved to the nearest where they have."""
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


def _kinks(solution):
    """Crank angles of kinks and jumps of friction, of loads and of cams' laws, over the period."""
    rubbing = _friction_changes(solution)
    law = of_laws(solution, jumps=True)
    found: list[Any] = [(rubbing, rubbing), (law, law)]
    for part in kink_sources(solution.loads):
        again = beginnings(part, solution)[:, None]
        kinks, jumps = kinks_of(part, solution)
        found.append((np.ravel(np.concatenate([kinks, jumps]) + again), np.ravel(jumps + again)))
    return tuple(np.unique(np.concatenate(angles)) for angles in zip(*found, strict=True))


def beginnings(part, solution):
    """Crank angles at which what declares kinks begins anew over the period of a solution."""
    return np.arange(0.0, solution.period - SAME, period_on(part, solution.mechanism))


def of_laws(solution, jumps=False):
    """Crank angles over the period at which laws of cams bend or jump, or jump only."""
    found = [knot.angle for group in solution.mechanism.groups for knot in group.knots if knot.jumps or not jumps]
    again = np.arange(0.0, solution.period - SAME, TURN)[:, None]
    return np.ravel(np.mod(np.array(found, dtype=float), TURN) + again)


def _friction_changes(solution):
    """Crank angles at which friction jumps, as a rate changes its sign, or has a kink, as a force does."""
    if not solution.friction.acting:
        return np.empty(0)
    _, angles = sign_changes(lambda angle: solution.at(angle).dynamics.friction_signs, solution.period, SAMPLES)
    return np.unique(angles)


def _beside(angle, others):
    """Whether crank angles are among others, but for rounding."""
    return np.isclose(np.asarray(angle)[..., None], others, rtol=0, atol=SAME).any(axis=-1)


def runs(marked):
    """Places of samples around the turn that are marked, by runs without a break, the first after one that is not."""
    order = np.roll(np.arange(marked.size), -int(np.argmin(marked)))
    edges = np.flatnonzero(np.diff(np.concatenate([[0], marked[order].astype(int), [0]])))
    return [order[start:stop] for start, stop in zip(edges[::2], edges[1::2], strict=True)]


def require_single(solution, owner, name):
    """Raise `ParameterError` for a batch of designs."""
    *designs, _ = solution.at(np.zeros(1)).shape
    if designs:
        raise ParameterError(
            f"{owner} works on one design at a time, but {name!r} has shape {(*designs, SAMPLES)}; solve a single "
            "design of the batch"
        )


def require_repeating(solution):
    """Raise `ParameterError` if a load that is a function gives other forces after its period."""
    problem = repeating_problem(solution)
    if problem:
        raise ParameterError(problem)


def repeating_problem(solution):
    """What is wrong with the period of the loads that are functions of one design, or None."""
    for item in solution.loads:
        if has_no_user_code(item):
            continue
        period = period_of([item], solution.mechanism.turns)
        angle = np.linspace(0.0, period, round(SAMPLES * period / TURN), endpoint=False) + 1e-3

        def push(turns, item=item, angle=angle, period=period):
            return np.broadcast_to(user_value(item, solution.at(angle + turns * period)), angle.shape)

        first, other = push(0), push(1)
        if _alike(first, other):
            continue
        place = int(np.nanargmax(np.abs(other - first)))
        unit = getattr(item, "UNIT", "N")
        here, there = (f"{np.degrees(place):.6g} deg" for place in (angle[place], angle[place] + period))
        found = (
            f"{title_of(item)}: its function gives {first[place]:.6g} {unit} at crank angle {here}, "
            f"but {other[place]:.6g} {unit} at {there}"
        )
        turns = next((turns for turns in range(2, LONGEST + 1) if _alike(first, push(turns))), None)
        if turns is None:
            return (
                f"{found}; a force must repeat after its period of {period / TURN:.6g} turns: take its crank angle as "
                "np.mod(motion.crank_angle, period), or give the period it has"
            )
        whole = turns * period / TURN
        remedy = f"period={2 * whole:.6g}*pi"
        if "period" not in vars(item):
            remedy = f"a Table with {remedy}, or a function with an attribute {remedy}"
        return f"{found}, and repeats after {whole:.6g} turns only: give {remedy}"
    return None


def _alike(first, other):
    with np.errstate(invalid="ignore"):
        return not np.any(np.abs(first - other) > ALIKE * np.fmax.reduce(np.abs(first), initial=0.0))

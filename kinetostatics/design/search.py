"""Search for a design: a problem set up for SciPy's SLSQP, in variables scaled by singular values of the derivatives.

Mean magnitudes and squares are smooth. A limit of a largest value becomes a limit for each part of the period. To
minimise a largest value, an extra unknown bounds these parts. Scaling matters: some combinations of a cam's harmonics
change the torque a thousand times as much as others.
"""

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..cycle.reductions import Output
from . import measures
from .constraints import MEAN, Constraint
from .problem import cached_by_design

MAX_ROUNDS = 8
"""Rounds of a search; each rescales the variables."""
MAX_STEPS = 200
"""SLSQP steps of a round."""
FIRST_TOLERANCE, LATER_TOLERANCE = 1e-10, 1e-9
"""Relative change of the goal that ends the first round, and later rounds."""
GOAL_TOLERANCE = 1e-7
"""Relative change of the goal that ends a search."""
LIMIT_TOLERANCE = 1e-9
"""Excess over a limit, relative to its size, within which a limit counts as kept."""
MAX_RESTORING_STEPS, MAX_RESTORED_EXCESS = 5, 1e-4
"""Newton steps back to the limits, and the largest relative excess that they correct."""
MIN_SHARE = 1e-9
"""Smallest step toward a design that cannot be built, relative to its distance, in the search for one that can."""
INFEASIBLE_GOAL = 1e6
"""Goal of a design that cannot be built, in units of the start's goal."""


class Goal(NamedTuple):
    """To minimise: `sign` times an output, or a function of designs that returns value and derivatives."""

    output: Any
    sign: float = 1.0

    @property
    def roughness(self):
        """Insignificant relative change of the goal."""
        return getattr(self.output, "roughness", 0.0)


class SearchEnd(NamedTuple):
    """End of a search: numbers that vary, least value of the goal, excess over the worst limit relative to its size."""

    values: np.ndarray
    goal: float
    missed: float


def search_from(problem, goal, limits, start, rounds=MAX_ROUNDS) -> SearchEnd:
    """Local optimum from a start."""
    start = np.clip(start, problem.low, problem.high)
    start = within_tables(problem, [limit for limit in limits if limit.span is not None], start)
    best, tolerance = _round(problem, goal, limits, start), max(GOAL_TOLERANCE, goal.roughness)
    for _ in range(rounds - 1):
        found = _round(problem, goal, limits, best.values, LATER_TOLERANCE)
        before, best = best, better(best, found)
        if best is before or best.missed > max(LIMIT_TOLERANCE, 0.9 * before.missed):
            break
        if before.missed <= LIMIT_TOLERANCE and before.goal - best.goal <= tolerance * max(abs(best.goal), 1e-300):
            break
    return best


def better(one, other):
    """The better of two designs: first by limits, then by goal."""
    kept = max(one.missed, other.missed) <= LIMIT_TOLERANCE
    return min(one, other, key=lambda found: found.goal if kept else found.missed)


def _round(problem, goal, limits, start, change=FIRST_TOLERANCE):
    from scipy.optimize import minimize

    turned = _ScaledProblem(problem, goal, limits, start)
    if not np.isfinite(turned.unit):
        return SearchEnd(start, np.inf, np.inf)
    constraints: Any = [{"type": "ineq", "fun": turned.inside, "jac": lambda _: turned.walls}]
    for kind, equal in (("ineq", False), ("eq", True)):
        if turned.margins(turned.zero, equal)[0].size:
            margins = partial(turned.margins, equal=equal)
            constraints.append(
                {"type": kind, "fun": lambda x, of=margins: of(x)[0], "jac": lambda x, of=margins: of(x)[1]}
            )
    found = minimize(
        turned.goal,
        turned.zero,
        jac=True,
        constraints=constraints,
        method="SLSQP",
        callback=problem.stepped and (lambda unknowns: problem.stepped(turned.values(unknowns))),
        options={"maxiter": MAX_STEPS, "ftol": max(change, goal.roughness)},
    )
    values = restore_limits(problem, limits, np.clip(turned.values(found.x), problem.low, problem.high))
    reached, share = turned.reached(values), 1.0
    while not np.isfinite(reached) and share > MIN_SHARE:  # back toward the start, which can be built
        share *= 0.5
        reached = turned.reached(start + share * (values - start))
    values = start + share * (values - start) if share < 1.0 else values
    off = worst_excess(problem, limits, values) if np.isfinite(reached) else np.inf
    return SearchEnd(values, reached, off)


def within_tables(problem, limits, start):
    """Nearest design to a start that keeps sliders within load tables; the start if there is none."""
    from scipy.optimize import minimize

    reach = problem.high - problem.low

    def margins(steps):
        """Margins of the limits, in units of their sizes, and derivatives by the steps."""
        excess, slopes, _ = excesses_over(problem, limits, start + steps * reach)
        return np.nan_to_num(-excess, nan=-INFEASIBLE_GOAL), np.nan_to_num(-slopes.T * reach)

    still = np.zeros(start.size)
    if margins(still)[0].min(initial=0.0) >= -LIMIT_TOLERANCE:
        return start
    found = minimize(
        lambda steps: (steps @ steps, 2.0 * steps),
        still,
        jac=True,
        method="SLSQP",
        bounds=np.transpose([problem.low - start, problem.high - start] / reach),
        constraints={"type": "ineq", "fun": lambda steps: margins(steps)[0], "jac": lambda steps: margins(steps)[1]},
    )
    moved = np.clip(start + found.x * reach, problem.low, problem.high)
    return moved if margins((moved - start) / reach)[0].min() >= -LIMIT_TOLERANCE else start


def restore_limits(problem, limits, values):
    """Nearest design that keeps limits, by Newton's method from small excesses; the same design if that fails.

    SLSQP may stop slightly beyond limits if rounding hides the descent.
    """
    off = worst_excess(problem, limits, values)
    reach = problem.high - problem.low
    for _ in range(MAX_RESTORING_STEPS):
        if not LIMIT_TOLERANCE < off < MAX_RESTORED_EXCESS:
            break
        excess, slopes, equal = excesses_over(problem, limits, values)
        active = (excess > -LIMIT_TOLERANCE) | equal
        excess, slopes = excess[active], slopes.T[active]
        if not np.isfinite(slopes).all():
            break
        step = _restoring_step(excess, slopes, reach, problem.low - values, problem.high - values)
        moved = np.clip(values + step, problem.low, problem.high)
        left = worst_excess(problem, limits, moved)
        if not left < off:
            break
        values, off = moved, left
    return values


def _restoring_step(excess, slopes, reach, low, high):
    """Least change, in units of the reach, that removes the excess; variables at their bounds stay there."""
    free = np.ones(reach.size, dtype=bool)
    while True:
        step = np.where(free, -np.linalg.pinv(slopes * free * reach) @ excess * reach, 0.0)
        inside = (step >= low) & (step <= high)
        if inside.all():
            return step
        free &= inside


def worst_excess(problem, limits, values):
    """Excess over the worst limit relative to its size; infinite if the design cannot be built."""
    excess, _, equal = excesses_over(problem, limits, values)
    worst = np.where(equal, np.abs(excess), excess).max(initial=0.0)
    return float(worst) if np.isfinite(worst) else np.inf


def excesses_over(problem, limits, values):
    """Excesses over limits relative to their sizes (parts,), derivatives (n, parts), and mask of the equalities."""
    excesses, slopes = [np.empty(0)], [np.empty((values.size, 0))]
    for limit in limits:
        excess, changes = excess_over(problem, limit, values)
        excesses.append(excess / limit.scale)
        slopes.append(changes / limit.scale)
    equal = np.repeat([limit.relation == "=" for limit in limits], [excess.size for excess in excesses[1:]])
    return np.concatenate(excesses), np.hstack(slopes), equal.astype(bool)


def excess_over(problem, limit, values):
    """Excess of a design over a limit (parts,), not positive if it is kept, and derivatives (n, parts)."""
    output, sign, problem = limit.output, -1.0 if limit.relation == ">=" else 1.0, problem.duty(limit.duty)
    if limit.relation != "=" and is_peak(output, sign) and "" in problem.parts:
        found, slopes = measures.bounded(output.reduction, problem.curve(output, values))
        return found - sign * limit.value, slopes
    found, slopes = problem.output(output, values)
    return np.array([sign * (found - limit.value)]), sign * slopes[:, None]


class _ScaledProblem:
    """The problem in scaled variables around a start."""

    def __init__(self, problem, goal, limits, start):
        self.problem, self.start, self.goal_of, self.limits = problem, start, goal, limits
        pairs = [(part, problem.shares[name]) for name, part in problem.parts.items()]
        self.levels = pairs if is_peak(*goal) else []
        self.raised = len(self.levels)  # each peak is bounded by an extra unknown
        self._margins = cached_by_design(self._computed_margins, 1)
        first = self.reached(start)
        self.unit = abs(first) or 1.0
        count = start.size
        self.matrix = np.diag(problem.high - problem.low)
        if np.isfinite(first):
            self.matrix = self.matrix @ self._turn()
        self.zero = np.zeros(count + self.raised)
        for place, (part, _) in enumerate(self.levels, count):
            self.zero[place] = goal.sign * part.output(goal.output, start)[0] / self.unit
        self.walls = np.vstack([self.matrix, -self.matrix]) / np.tile(problem.high - problem.low, 2)[:, None]
        self.walls = np.hstack([self.walls, np.zeros((2 * count, self.raised))])

    def _turn(self):
        """Directions of the unit box, each scaled to change goal and limits by about their size, within the box."""
        # derivatives of limits and goal along the period, in units of their sizes
        rows, wanted = [], [(limit.duty, limit.output, limit.scale) for limit in self.limits]
        for duty, output, unit in (*wanted, (MEAN, self.goal_of.output, self.unit)):
            problem = self.problem.duty(duty)
            if not isinstance(output, Output):
                rows.append(problem.output(output, self.start)[1][None] / unit)
                continue
            for name, part in problem.parts.items():
                curve, size = part.curves(self.start)[output.quantity], unit
                if output.ratio:
                    size = np.sqrt(np.mean(curve.values**2)) or 1.0
                rows.append(problem.shares[name] * curve.slopes.T / (size * np.sqrt(curve.slopes.shape[1])))
        stacked = np.vstack(rows) * (self.problem.high - self.problem.low)
        if not np.isfinite(stacked).all():
            return np.eye(self.start.size)
        _, sizes, turns = np.linalg.svd(stacked, full_matrices=len(stacked) < self.start.size)
        lengths = np.ones(self.start.size)
        lengths[: sizes.size] = np.maximum(sizes, 1.0)
        return turns.T / lengths

    def values(self, unknowns):
        values = self.start + self.matrix @ unknowns[: self.start.size]
        return np.clip(values, self.problem.low, self.problem.high)

    def reached(self, values):
        """The goal of a design; infinite if it cannot be built."""
        output, sign = self.goal_of
        found = sign * self.problem.output(output, values)[0]
        return found if np.isfinite(found) else np.inf

    def goal(self, unknowns):
        """The goal in units of the start's, and its derivatives."""
        if self.raised:
            shares = np.append(np.zeros(self.start.size), [share for _, share in self.levels])
            return shares @ unknowns, shares
        output, sign = self.goal_of
        value, slopes = self.problem.output(output, self.values(unknowns))
        found = sign * value / self.unit
        return found if np.isfinite(found) else INFEASIBLE_GOAL, np.nan_to_num(sign * slopes @ self.matrix / self.unit)

    def inside(self, unknowns):
        """Margins of the bounds, in units of their range."""
        values, low, high = self.values(unknowns), self.problem.low, self.problem.high
        return np.concatenate([values - low, high - values]) / np.tile(high - low, 2)

    def margins(self, unknowns, equal):
        """Margins of equalities, or of the other limits, in units of their sizes; derivatives by the unknowns."""
        margins, rows, equalities = self._margins(unknowns)
        return margins[equalities == equal], rows[equalities == equal]

    def _computed_margins(self, unknowns):
        values = self.values(unknowns)
        excess, slopes, equal = excesses_over(self.problem, self.limits, values)
        counts = [excess.size]
        for (part, _), unknown in zip(self.levels, unknowns[self.start.size :], strict=True):  # each below its unknown
            output, sign = self.goal_of
            level = Constraint(output, "<=" if sign > 0 else ">=", sign * unknown * self.unit, self.unit)
            above, changes, _ = excesses_over(part, [level], values)
            counts.append(above.size)
            excess, slopes = np.append(excess, above), np.hstack([slopes, changes])
            equal = np.append(equal, np.zeros(above.size, dtype=bool))
        rows = -(self.matrix.T @ slopes).T
        rows = np.column_stack([rows, *np.repeat(np.eye(len(counts))[1:], counts, axis=1)])
        return np.nan_to_num(-excess, nan=-INFEASIBLE_GOAL), np.nan_to_num(rows), equal


def is_peak(output, sign):
    """Whether an output times a sign is a largest value over the period, which its parts bound one by one."""
    if not isinstance(output, Output) or output.ratio:
        return False
    return output.reduction in measures.SIDES and (sign > 0) == (output.reduction != "smallest")

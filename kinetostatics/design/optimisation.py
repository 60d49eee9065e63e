"""Optimisation of any machine under limits: goal and limits are texts, limits hold at exact extremes."""

from collections.abc import Mapping
from dataclasses import replace
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..cycle.reductions import Output, SolutionNumber
from ..errors import DesignError, KinetostaticsError, ParameterError
from ..mechanics.quantities import values as values_of
from ..numbers import checks
from .constraints import MEAN, Constraint, parse_constraints, parse_output
from .duties import DutyProblem, in_each, limits_of, read_duties
from .problem import SHARED_NUMBERS, Problem, progress_bar, scene_of, true_value, without_ratio
from .result import Found, active_prices
from .robust import sampled_output, spread_problem
from .search import LIMIT_TOLERANCE, Goal, SearchEnd, better, excess_over, search_from, worst_excess

ANGLES = 720
"""Crank angles over the period."""
MIN_ANGLES = 12
"""Fewest crank angles of a curve."""
MISSED = 1e3 * LIMIT_TOLERANCE
"""Excess over a limit, relative to its size, above which a search has missed the limit."""
MAX_TIGHTENINGS = 4
"""Largest number of times that limits are tightened until exact extremes keep them."""


def optimise(
    source,
    vary,
    minimise=None,
    limits=(),
    *,
    maximise=None,
    numbers=(),
    variant=None,
    reference=None,
    robust=None,
    begin=None,
    starts=1,
    seed=0,
    angles=ANGLES,
    engine="numpy",
    progress=False,
):
    """Best machine within bounds and limits.

    Derivatives are exact, from the recorded program; the optimiser is SciPy's SLSQP. Limits hold at exact extremes.

    Parameters
    ----------
    source : Case, Scene, variant or duties
        In a case, derived numbers follow the varied ones, as for `sweep`. Duties are a dict of name to (scene, share of
        the time) of one machine: ``{"idle": (scene, 0.2), "cut": (other, 0.8)}``. All duties share the varied numbers;
        the goal is the mean of the output over the duties, weighted by the shares.
    vary : dict of path to (low, high)
        Numbers in SI or texts with units: ``{"spring.stiffness": ("600 kN/m", "900 kN/m")}``.
    minimise, maximise : str
        One of the two: an output as in sweeps, "mean_absolute balancing_torque", "largest O", "largest
        contact_pressure", "swing balancing_torque", "ratio mean_absolute balancing_torque" ...
    limits : sequence of str
        "largest O <= 0.75 kN", "largest slider_position = 2.3 m", "ratio mean_absolute balancing_torque >= 50" ...
        Numbers of parts, "main_bearing.life_hours >= 20000 h" or `sizing.Part.limit`, have derivatives by central
        differences. With duties each limit holds in all, "cut: largest O <= 40 kN" in one, "mean: ..." for the weighted
        mean.
    numbers : sequence of SolutionNumber
        Functions of a solution named in goal and limits, such as the mains energy of a turn under a motor; their
        derivatives are central differences.
    variant, reference : str
        As for `sweep`. For a scene `reference` is a `Scene`, for duties one scene for all or a dict.
    robust : Spread, optional
        Goal: a quantile of the output over spreads of numbers.
    begin : dict of path to float, optional
        Start of the first search; by default the source.
    starts : int
        Number of searches: the first begins at the source, others within the bounds (scrambled Sobol).
    seed : int
    angles : int
        Crank angles over the period of the loads.
    engine : "numpy" or "compiled"
        "compiled" saves time in long studies; a loop with many parameters compiles slowly.
    progress : bool or function
        Whether a bar shows the steps of the search. A function is called after each step with the design there: its
        `.values` by path, its `.goal`, and `.missed`, the relative excess over the worst limit.

    Returns
    -------
    Found
        With duties its scenes are dicts by name.

    Raises
    ------
    ParameterError
        A text cannot be read, or names an unknown output.
    DesignError
        No design keeps the limits; the message describes the nearest.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63")
    >>> found = ks.design.optimise(
    ...     saw, {"spring.stiffness": ("600 kN/m", "900 kN/m"), "cam.centre.x": ("-30 mm", "-10 mm")},
    ...     maximise="ratio mean_absolute balancing_torque", variant="cam-circle",
    ... )
    >>> round(found.report().loc["ratio mean_absolute balancing_torque [1]", "after"])
    67

    A saw that idles for a fifth of the time and cuts for the rest:

    >>> spring = ks.Spring(600e3, free_position=2.0)
    >>> idle = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[spring])
    >>> cut = ks.Scene(idle.mechanism, 33.5, loads=[spring, ks.ProcessForce(10e3)])
    >>> duties, vary = {"idle": (idle, 0.2), "cut": (cut, 0.8)}, {"spring.free_position": (1.9, 2.1)}
    >>> found = ks.design.optimise(duties, vary, "rms balancing_torque", ["idle: largest O <= 60 kN"], angles=90)
    >>> round(found.values["spring.free_position"], 3), list(found.scene)
    (1.992, ['idle', 'cut'])
    """
    duties = read_duties(source, variant, reference)
    checks.require(
        "design", checks.count("angles", angles, size=checks.BYTES_PER_ANGLE), *search_problems(starts, seed)
    )
    parts = named_numbers(source, numbers)
    task, quantities = _duty_task(duties, minimise, maximise, limits, angles, parts)
    if "" in duties:
        (duty,) = duties.values()
        problem: Any = Problem(duty.source, vary, quantities[""], duty.reference, angles, engine)
    else:
        problem = DutyProblem(duties, vary, quantities, angles, engine)
    begins = _starting_designs(problem, starts, seed, begin)
    reported = (*task.outputs, *(limit.output for limit in problem.table_limits))
    return best_design(problem, task, begins, reported, robust, progress)


def named_numbers(source, numbers):
    """Parts to be sized and numbers by name, of a case, variant, or all duties."""
    several = isinstance(numbers, list | tuple)
    wrong = [item for item in numbers if not isinstance(item, SolutionNumber)] if several else [numbers]
    checks.require("design", *(f"numbers must be SolutionNumbers, got {checks.shown(item)}" for item in wrong))
    items = [pair[0] for pair in source.values()] if isinstance(source, Mapping) else [source]
    parts = {name: part for item in items for name, part in (getattr(item, "sizing", None) or {}).items()}
    return parts | {item.name: item for item in numbers}


def _duty_task(duties, minimise, maximise, limits, angles, parts):
    """Task of a search with the duty of each limit, and the quantities of each duty by name."""
    limited = {"": limits} if "" in duties else limits_of(limits, duties)

    def own_task(name, duty):
        scene = scene_of(duty.source)
        own, of_mean = (
            parse_task(scene, minimise, maximise, limited.get(key, ()), duty.reference, angles, parts=parts)
            for key in (name, MEAN)
        )
        means = tuple(replace(limit, duty=MEAN) for limit in of_mean.limits)
        return own._replace(limits=tuple(replace(limit, duty=name) for limit in own.limits)), means

    tasks = in_each(duties, own_task)
    task, means = next(iter(tasks.values()))
    outputs = {name: (*own.outputs, *(limit.output for limit in mean)) for name, (own, mean) in tasks.items()}
    quantities = {
        name: [item.quantity for item in items if isinstance(item, Output)] or ["balancing_torque"]
        for name, items in outputs.items()
    }
    return task._replace(limits=(*(limit for own, _ in tasks.values() for limit in own.limits), *means)), quantities


class Task(NamedTuple):
    """Task of a search: minimise `sign` times an output, named by `text`, under limits."""

    text: str
    output: Output | SolutionNumber
    sign: float
    limits: tuple[Constraint, ...]

    @property
    def outputs(self):
        """The outputs of goal and limits."""
        return self.output, *(limit.output for limit in self.limits)


class SearchStep(NamedTuple):
    """Design after a step of a search: numbers by path, output of the goal, excess over the worst limit.

    Numbers are SI; the excess is relative to the limit's size, at the crank angles of the search.
    """

    values: dict[str, float]
    goal: float
    missed: float


def _step(problem, goal, limits, values):
    """`SearchStep` of a design."""
    value, _ = problem.output(goal.output, values)
    return SearchStep(problem.numbers(values), float(value), worst_excess(problem, limits, values))


def parse_task(scene, minimise, maximise, limits, reference, angles, kept=(), parts=None) -> Task:
    """Task of a search from texts, with the limits `kept` first; an error without a needed reference or angles."""
    if (minimise is None) == (maximise is None):
        raise ParameterError('design: give either minimise or maximise, an output such as "largest O"')
    sign, text = (1.0, minimise) if maximise is None else (-1.0, maximise)
    limits = (*parse_constraints(kept, scene), *parse_constraints(limits, scene, parts))
    task = Task(text, parse_output(text, scene, parts), sign, limits)
    ratio = next((str(output) for output in task.outputs if output.ratio), None)
    if ratio is not None and reference is None:
        raise ParameterError(f"design: {ratio!r} needs a reference: a Scene, as reference=plain")
    orders = [output.order for output in task.outputs if isinstance(output, Output)]
    needed = max([MIN_ANGLES, *(2 * order + 1 for order in orders if order)])
    if angles < needed:
        raise ParameterError(f"design: angles must be at least {needed} for the given outputs, got {angles}")
    return task


def search_problems(starts, seed):
    """Sentences about a wrong number of starts or seed."""
    return checks.count("starts", starts), checks.seed("seed", seed)


def _starting_designs(problem, count, seed, begin=None):
    """Designs to start from: the source or `begin`, then a Sobol sequence within the bounds."""
    from scipy.stats import qmc

    spread = qmc.Sobol(problem.low.size, rng=seed).random(max(1, 2 ** int(np.ceil(np.log2(max(count - 1, 1))))))
    first = problem.start
    if begin is not None:
        if not isinstance(begin, Mapping):
            raise ParameterError(f"design: begin must be a dict of path to number, got {checks.shown(begin)}")
        wrong = [checks.choice("begin", path, problem.names) for path in begin]
        units = problem.units
        given: dict = {f"begin {path}": (value, units.get(path, ""), {}) for path, value in begin.items()}
        own = checks.single_numbers("design", *wrong, **given)
        first = np.array([own.get(f"begin {name}", value) for name, value in zip(problem.names, first, strict=True)])
    return [first, *(problem.low + spread[: count - 1] * (problem.high - problem.low))]


def _numbers_text(problem, values):
    """Numbers of a design by their paths, as a text."""
    return ", ".join(f"{name} = {value:.9g}" for name, value in problem.numbers(values).items())


def best_design(problem, task, begins, reported, robust, progress) -> Found:
    """Best of the searches from several designs for a task, or for the quantile of its output over a spread.

    Raises `DesignError` if no design keeps the limits at exact extremes.
    """
    text, output, sign, limits = task
    checks.require(
        "design",
        None if robust is None else spread_problem("robust", robust),
        None
        if robust is None or isinstance(output, Output)
        else f"{str(output)!r} is a number of a part, which has no quantile; use it as a limit",
    )
    goal = Goal(output if robust is None else sampled_output(problem, output, robust, sign), sign)
    searched, plain = _without_ratios(problem, goal, limits)
    # limits by tables over travel are added; for a robust goal they hold for each machine of the spread
    own = (*problem.table_limits, *(goal.output.within_tables() if robust is not None else ()))
    kept = (*limits, *own)
    reporter = (lambda values: progress(_step(problem, goal, kept, values))) if callable(progress) else progress
    with progress_bar(problem, begins, reporter) as numbered:
        ends = [search_from(problem, searched, (*plain, *own), start) for start in numbered]
        best = reduce(better, ends)
        if best.missed > MISSED:
            raise DesignError(_failure_text(problem, searched, kept, best, len(ends)), problem.numbers(best.values))
        best = _tighten_limits(problem, searched, (*plain, *own), best)
    goals = [searched.sign * end.goal if end.missed <= MISSED else np.inf for end in ends]
    if robust is None and searched.output.ratio != output.ratio:
        above = true_value(without_ratio(output), scene_of(problem.reference))
        goals = [above / end for end in goals]
    evaluations = problem.evaluations
    active, prices = active_prices(problem, goal, kept, best.values)
    of = "" if robust is None else f"{robust.quantile:g} quantile of "
    return Found(
        problem.scene(best.values),
        problem.numbers(best.values),
        scene_of(problem.source),
        problem.reference and scene_of(problem.reference),
        kept,
        f"{'least' if sign > 0 else 'greatest'} {of}{text}",
        tuple(dict.fromkeys(reported)),
        active,
        prices,
        evaluations,
        goals,
        spread=None if robust is None else (output, robust, sign),
        shares={} if "" in problem.shares else problem.shares,
    )


def _without_ratios(problem, goal, limits):
    """Goal and limits with ratios replaced by their denominators, if the reference does not vary."""
    if set(problem.names) & set(SHARED_NUMBERS):
        return goal, limits
    turned, found = {"<=": ">=", ">=": "<=", "=": "="}, []
    for limit in limits:
        output, part = limit.output, problem.duty(limit.duty)
        if isinstance(output, Output) and output.ratio and limit.value > 0 and limit.duty != MEAN:
            plain = without_ratio(output)
            value = true_value(plain, scene_of(part.reference)) / limit.value
            limit = replace(limit, output=plain, relation=turned[limit.relation], value=value)
        found.append(limit)
    if not isinstance(goal.output, Output) or not goal.output.ratio or "" not in problem.parts:
        return goal, tuple(found)
    return Goal(without_ratio(goal.output), -goal.sign), tuple(found)


def _failure_text(problem, goal, limits, best, count):
    """Sentence about the nearest design of failed searches, or the obstacle to any design."""
    tries = "the search" if count == 1 else f"any of {count} searches"
    if not np.isfinite(best.missed):
        numbers = _numbers_text(problem, best.values)
        obstacle = f"the one with {numbers} runs, but required outputs have no value"
        whose = ""
        try:
            for part in problem.parts.values():
                solution = part.scene(best.values).solve(problem.angles)
                for name in part.quantities:
                    values_of(solution, name)
            if callable(goal.output):
                spreads = ", ".join(goal.output.spread.spreads)
                whose = f", whose spread of {spreads} contains a machine that fails"
                goal.output.outputs(best.values)
        except KinetostaticsError as error:
            obstacle = f"with {numbers}{whose}: {error}"
        return (
            f"no design that can be built was found by {tries} ({obstacle}); change the bounds of "
            f"{', '.join(problem.names)}, or begin with a machine that runs"
        )
    reached = [
        f"{limit}, where it is {problem.duty(limit.duty).output(limit.output, best.values)[0]:.6g}"
        for limit in limits
        if worst_excess(problem, [limit], best.values) > MISSED
    ]
    at_bounds = [
        name
        for name, value, low, high in zip(problem.names, best.values, problem.low, problem.high, strict=True)
        if min(value - low, high - value) <= 1e-6 * (high - low)
    ]
    bounds = f"; at their bounds are {', '.join(at_bounds)}" if at_bounds else ""
    return f"no design that keeps all limits was found by {tries}; the nearest misses {'; '.join(reached)}{bounds}"


def _tighten_limits(problem, goal, limits, best) -> SearchEnd:
    """The design with limits kept at exact extremes: tighten them by the excess between samples, search again."""
    drawn, scales = list(limits), np.array([limit.scale for limit in limits])
    equal = np.array([limit.relation == "=" for limit in limits], dtype=bool)
    for left in reversed(range(MAX_TIGHTENINGS + 1)):
        over, failure = np.zeros(len(limits)), None
        for place, limit in enumerate(limits):
            try:
                over[place] = _true_excess_of(problem, limit, best.values)
            except KinetostaticsError as error:
                failure = error
        missed = np.where(equal, np.abs(over), over) / scales
        worst = missed.max(initial=0.0)
        if failure is None and worst <= LIMIT_TOLERANCE / 2:
            return best
        if not left or worst == 0.0:
            break
        for place in np.flatnonzero(missed > 0.0).tolist():
            side = -1.0 if drawn[place].relation == ">=" else 1.0
            drawn[place] = replace(drawn[place], value=drawn[place].value - side * 1.01 * over[place])
        best = search_from(problem, goal, drawn, best.values, rounds=2)
    if failure is None and worst <= LIMIT_TOLERANCE:
        return best
    why = f"limits hold there, but between them the excess is {worst:.2g} of the limit; give more angles"
    raise DesignError(
        f"the best design so far, {_numbers_text(problem, best.values)}, was found at {problem.angles} crank angles: "
        f"{why if failure is None else failure}",
        problem.numbers(best.values),
    )


def _true_excess_of(problem, limit, values):
    """Excess of a design over a limit at exact extremes, not positive if it is kept; for an equality the difference.

    For an output over a spread, or a ratio, it is the excess at the crank angles of the search.
    """
    if not isinstance(limit.output, Output) or limit.output.ratio:
        return excess_over(problem, limit, values)[0][0]
    whole = problem.duty(limit.duty)
    parts = whole.parts.items()
    mean = sum(whole.shares[name] * true_value(limit.output, part.scene(values)) for name, part in parts)
    return limit.value - mean if limit.relation == ">=" else mean - limit.value

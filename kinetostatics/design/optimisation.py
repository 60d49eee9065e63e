"""Optimisation of any machine under limits: goal and limits are texts, limits hold at true extremes."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..drive.flywheel_sizing import flywheel
from ..errors import DesignError, KinetostaticsError, ParameterError
from ..mechanics.quantities import values as values_of
from ..numbers import checks
from ..results.extremes import extrema
from .constraints import Constraint, parse_constraints, parse_output
from .problem import SHARED_NUMBERS, Problem, choose_design, progress_bar, scene_of, true_value, without_ratio
from .result import search_result
from .robust import SampledOutput, spread_problem
from .search import LIMIT_TOLERANCE, Goal, SearchEnd, best_end, excess_over, search_from, worst_excess

ANGLES = 720
"""Crank angles over the period."""
MIN_ANGLES = 12
"""Fewest crank angles of a curve."""
EXTREME_REDUCTIONS = ("largest", "smallest", "largest_absolute", "range")
"""Reductions checked at true extremes."""
MAX_TIGHTENINGS = 4
"""Tightenings of the limits until true extremes keep them."""


def optimise(
    source,
    vary,
    minimise=None,
    limits=(),
    *,
    maximise=None,
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

    Derivatives are exact, from the recorded program; the optimiser is SciPy's SLSQP. Limits hold at true extremes.

    Parameters
    ----------
    source : Case, Scene or variant
        In a case, derived numbers follow the varied ones, as for `sweep`.
    vary : dict of path to (low, high)
        Numbers in SI or texts with units: ``{"spring.stiffness": ("600 kN/m", "900 kN/m")}``.
    minimise, maximise : str
        One of the two: an output as sweeps have them, "mean_absolute balancing_torque", "largest O", "largest
        contact_pressure", "swing balancing_torque", "ratio mean_absolute balancing_torque" ...
    limits : sequence of str
        "largest O <= 0.75 kN", "largest slider_position = 2.3 m", "ratio mean_absolute balancing_torque >= 50" ...
    variant, reference : str
        As for `sweep`; of a scene `reference` is a `Scene`.
    robust : Spread, optional
        Makes a quantile of the output over spreads of numbers the goal.
    begin : dict of path to float, optional
        Start of the first search, in place of the source.
    starts : int
        Searches: the first begins at the source itself, others at designs within the bounds (scrambled Sobol).
    seed : int
    angles : int
        Crank angles over the period of the loads.
    engine : "numpy" or "compiled"
        A loop of many parameters compiles slowly and pays for long studies.
    progress : bool
        Show a bar that counts the steps of the search.

    Returns
    -------
    Found

    Raises
    ------
    ParameterError
        A text cannot be read, or names an output that the machine lacks.
    DesignError
        No design keeps the limits; the message names the nearest.

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
    """
    source, reference = choose_design(source, variant, reference)
    checks.require(
        "design", checks.count("angles", angles, size=checks.BYTES_PER_ANGLE), *search_problems(starts, seed)
    )
    sign, text = parse_goal(minimise, maximise)
    scene = scene_of(source)
    output, limits = parse_output(text, scene), parse_constraints(limits, scene)
    require_reference(reference, output, limits)
    asked = (output, *(limit.output for limit in limits))
    require_resolved(angles, asked)
    problem = Problem(source, vary, [item.quantity for item in asked], reference, angles, engine)
    goal, plain = without_ratios(problem, goal_of(problem, output, sign, robust), limits)
    begins = starting_designs(problem, starts, seed, begin)
    with progress_bar(problem, progress):
        best, kept, ends = best_within_limits(problem, goal, plain, begins, limits)
    return search_result(
        problem,
        goal if robust is not None else Goal(output, sign),
        kept,
        best,
        dict.fromkeys([*asked, *(limit.output for limit in problem.table_limits)]),
        goal_text(sign, text, robust),
        evaluations=problem.evaluations,
        starts=ends_as_ratios(problem, output, goal, ends),
    )


def parse_goal(minimise, maximise):
    if (minimise is None) == (maximise is None):
        raise ParameterError('design: give either minimise or maximise, an output such as "largest O"')
    return (1.0, minimise) if maximise is None else (-1.0, maximise)


def goal_text(sign, text, robust):
    """The goal in words."""
    of = "" if robust is None else f"{robust.quantile:g} quantile of "
    return f"{'least' if sign > 0 else 'greatest'} {of}{text}"


def goal_of(problem, output, sign, robust):
    """The `Goal`: an output, or a quantile of it over a spread."""
    checks.require("design", None if robust is None else spread_problem("robust", robust))
    return Goal(output if robust is None else SampledOutput(problem, output, robust, sign), sign)


def search_problems(starts, seed):
    """Sentences about a wrong number of starts or seed."""
    return checks.count("starts", starts), checks.seed("seed", seed)


def require_resolved(angles, outputs):
    """Refuse too few crank angles for the outputs."""
    orders = [int(item.reduction[9:]) for item in outputs if item.reduction.startswith("harmonic_")]
    needed = max([MIN_ANGLES, *(2 * order + 1 for order in orders)])
    checks.require(
        "design",
        None if angles >= needed else f"angles must be at least {needed} for the outputs asked for, got {angles}",
    )


def require_reference(reference, output, limits):
    ratios = [str(item) for item in (output, *(limit.output for limit in limits)) if item.ratio]
    checks.require(
        "design",
        f"{ratios[0]!r} needs a reference: a Scene, as reference=plain" if ratios and reference is None else None,
    )


def without_ratios(problem, goal, limits):
    """Goal and limits with ratios replaced by their denominators, where the reference does not vary."""
    if problem.reference is None or set(problem.names) & set(SHARED_NUMBERS):
        return goal, limits
    reference = scene_of(problem.reference)

    def plain(output):
        return replace(output, ratio=False)

    turned = {"<=": ">=", ">=": "<=", "=": "="}
    found = tuple(
        Constraint(
            plain(limit.output), turned[limit.relation], true_value(plain(limit.output), reference) / limit.value
        )
        if limit.output.ratio and limit.value > 0
        else limit
        for limit in limits
    )
    if callable(goal.output) or not goal.output.ratio:
        return goal, found
    return Goal(plain(goal.output), -goal.sign), found


def ends_as_ratios(problem, output, goal, ends):
    """Goals of the starts, as ratios where the search used their denominators."""
    if callable(goal.output) or goal.output.ratio == output.ratio:
        return ends
    above = true_value(without_ratio(output), scene_of(problem.reference))
    return [above / end for end in ends]


def starting_designs(problem, count, seed, begin=None):
    """Designs to start from: the source or `begin`, then a Sobol sequence within the bounds."""
    from scipy.stats import qmc

    spread = qmc.Sobol(problem.low.size, rng=seed).random(max(1, 2 ** int(np.ceil(np.log2(max(count - 1, 1))))))
    first = problem.start
    if begin is not None:
        if not isinstance(begin, Mapping):
            raise ParameterError(f"design: begin must be a dict of path to number, got {checks.shown(begin)}")
        wrong = [checks.choice("begin", path, problem.names) for path in begin]
        units = problem.source.units
        given: dict = {f"begin {path}": (value, units.get(path, ""), {}) for path, value in begin.items()}
        own = checks.single_numbers("design", *wrong, **given)
        first = np.array([own.get(f"begin {name}", value) for name, value in zip(problem.names, first, strict=True)])
    return [first, *(problem.low + spread[: count - 1] * (problem.high - problem.low))]


def best_within_limits(problem, goal, limits, starts, asked):
    """Best design that keeps the limits at true extremes; all limits as the user gave them; the goal of each end.

    Limits by tables over travel join them; of a robust goal they hold for each machine of the spread.
    """
    robust = goal.output.within_tables() if callable(goal.output) else ()
    own = *problem.table_limits, *robust
    best, ends = best_of_searches(problem, goal, (*limits, *own), starts, (*asked, *own))
    return tighten_limits(problem, goal, (*limits, *own), best), (*asked, *own), ends


def best_of_searches(problem, goal, limits, starts, named=None):
    """Best end of several searches, and the goal of each; errors name the limits `named`.

    Raises
    ------
    DesignError
        None keeps the limits.
    """
    ends = [search_from(problem, goal, limits, start) for start in starts]
    best = best_end(ends)
    if best.missed > 1e3 * LIMIT_TOLERANCE:
        nearest = dict(zip(problem.names, map(float, best.values), strict=True))
        raise DesignError(_failure_text(problem, goal, named or limits, best, len(ends)), nearest)
    return best, [goal.sign * end.goal if end.missed <= 1e3 * LIMIT_TOLERANCE else np.inf for end in ends]


def _failure_text(problem, goal, limits, best, count):
    tries = "the search" if count == 1 else f"any of {count} searches"
    if not np.isfinite(best.missed):
        return (
            f"no design that can be built was found by {tries} ({_obstacle_text(problem, goal, best.values)}); change "
            f"the bounds of {', '.join(problem.names)}, or begin with a machine that runs"
        )
    reached = []
    for limit in limits:
        if worst_excess(problem, [limit], best.values) > 1e3 * LIMIT_TOLERANCE:
            reached.append(f"{limit}, where it comes to {problem.output(limit.output, best.values)[0]:.6g}")
    at_bounds = [
        name
        for name, value, low, high in zip(problem.names, best.values, problem.low, problem.high, strict=True)
        if min(value - low, high - value) <= 1e-6 * (high - low)
    ]
    bounds = f"; at their bounds are {', '.join(at_bounds)}" if at_bounds else ""
    return f"no design that keeps all limits was found by {tries}; the nearest misses {'; '.join(reached)}{bounds}"


def _obstacle_text(problem, goal, values):
    """Sentence about a design that cannot be built."""
    own = _numbers_text(problem, values)
    try:
        solution = scene_of(problem.scene(values)).solve(problem.angles)
        for name in problem.quantities:
            values_of(solution, name)
    except KinetostaticsError as error:
        return f"with {own}: {error}"
    try:
        if callable(goal.output):
            goal.output.outputs(values)
    except KinetostaticsError as error:
        spreads = ", ".join(goal.output.spread.spreads)
        return f"with {own}, of which a machine within the spread of {spreads} fails: {error}"
    return f"the one with {own} runs, but outputs asked for have no value"


def _numbers_text(problem, values):
    """Numbers of a design by their paths, as a text."""
    return ", ".join(f"{name} = {value:.9g}" for name, value in zip(problem.names, values, strict=True))


def tighten_limits(problem, goal, limits, best) -> SearchEnd:
    """The design with limits kept at true extremes: tighten them by the excess between samples and search again."""
    drawn = list(limits)
    for left in reversed(range(MAX_TIGHTENINGS + 1)):
        over, failure = _true_excesses(problem, limits, best.values)
        if failure is None and all(
            part <= LIMIT_TOLERANCE * limit.scale / 2 for part, limit in zip(over, limits, strict=True)
        ):
            return best
        if not left or not any(part > 0 for part in over):
            break
        drawn = [
            limit if part <= 0 else replace(limit, value=limit.value - _excess_sign(limit, problem, best) * 1.01 * part)
            for limit, part in zip(drawn, over, strict=True)
        ]
        best = search_from(problem, goal, drawn, best.values, rounds=2)
    worst = max((part / limit.scale for part, limit in zip(over, limits, strict=True)), default=0.0)
    if failure is None and worst <= LIMIT_TOLERANCE:
        return best
    why = f"limits hold there, but are missed by {worst:.2g} of their size between; give more angles"
    raise DesignError(
        f"the best design so far, {_numbers_text(problem, best.values)}, was found at {problem.angles} crank angles: "
        f"{why if failure is None else failure}",
        dict(zip(problem.names, map(float, best.values), strict=True)),
    )


def _true_excesses(problem, limits, values):
    """Excesses of a design over limits at true extremes, and the error if one has no value, or None."""
    scene, over, failure = scene_of(problem.scene(values)), [], None
    for limit in limits:
        try:
            is_own = callable(limit.output)
            over.append(excess_over(problem, limit, values)[0][0] if is_own else true_excess(limit, scene))
        except KinetostaticsError as error:
            over.append(0.0)
            failure = error
    return over, failure


def _excess_sign(limit, problem, best):
    """+1 if a design exceeds a limit upward, -1 downward."""
    if limit.relation != "=":
        return 1.0 if limit.relation == "<=" else -1.0
    return np.sign(true_extreme(limit.output, scene_of(problem.scene(best.values))) - limit.value)


def true_excess(limit, scene):
    """Excess of a scene over a limit at true extremes; not positive if it is kept."""
    excess = true_extreme(limit.output, scene) - limit.value
    return abs(excess) if limit.relation == "=" else -excess if limit.relation == ">=" else excess


def true_extreme(output, scene):
    """Value of an output of a scene, with true extremes."""
    if (output.reduction, output.quantity, output.ratio) == ("swing", "balancing_torque", False) and scene.crank_speed:
        return flywheel(scene, 1.0).energy
    if output.ratio or output.reduction not in EXTREME_REDUCTIONS:
        return true_value(output, scene)
    low, high = extrema(scene.solve(12), output.quantity).range
    if output.reduction == "range":
        return high - low
    return {"largest": high, "smallest": low, "largest_absolute": max(high, -low)}[output.reduction]

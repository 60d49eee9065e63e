"""Static balancing by counterweights on links: full, partial, optimal, and what each costs.

A counterweight of mass m at the arm L adds its unbalance m L to the static moment m h of its link (`principal_points`).
Full balancing makes all static moments vanish; partial balancing, with one counterweight on the crank, sets the ratio

    (h1 / L_OA) / (h2 / L_AB)      1: no shaking force across the guide     0: nearly none along it
                                   1/2: least overall, by the mower study (Kotov 2024)
"""

from dataclasses import replace

import numpy as np

from ..errors import ParameterError
from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import magnitude
from ..numbers import checks
from ..results.extremes import extremes
from ..solution.solution import Solution
from .counterweights import Balanced, Counterweight, across_guide, along_guide, counterweight, guide_direction
from .shapes import crank_sliders, four_bar

__all__ = ["Balanced", "Counterweight", "counterweight", "full", "optimal", "partial"]

RATIOS = {"across": 1.0, "along": 0.0, "overall": 0.5}


def full(mechanism, *, crank, coupler=None, rocker=None):
    """Fully balanced mechanism: its common mass centre stands still.

    Parameters
    ----------
    mechanism : Mechanism
        Crank-slider (counterweights on crank and coupler) or four-bar (on crank and rocker).
    crank, coupler, rocker : Counterweight

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        A counterweight is missing or not needed, breaks its limits, or the mechanism cannot be balanced so.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.full(mower, crank=ks.Counterweight(arm=-0.05), coupler=ks.Counterweight(arm=-0.055))
    >>> s = ks.solve(found.mechanism, 1.0, crank_speed=62.8)
    >>> bool(abs(s.shaking_force).max() < 1e-9), round(found.added_mass, 1)  # N; kg is the price
    (True, 60.1)
    """
    given = {name: item for name, item in [("coupler", coupler), ("rocker", rocker)] if item is not None}
    _refuse(mechanism)
    bars, chains = four_bar(mechanism), crank_sliders(mechanism)
    if bars is None and not chains:
        raise ParameterError(f"full balancing is for crank-sliders and four-bars, not for a {mechanism.name}")
    outer, link = ("coupler", chains[0].coupler.link) if bars is None else ("rocker", bars.rocker.link)
    if set(given) != {outer}:
        raise ParameterError(
            f"full balancing of a {mechanism.name} takes a counterweight on crank and {outer}, got crank"
            f"{''.join(f' and {name}' for name in given) or ' only'}"
        )
    first = _set(mechanism, link, (0.0, 0.0), given[outer])
    second = _set(first.mechanism, _crank(mechanism), (0.0, 0.0), crank)
    return Balanced(mechanism, second.mechanism, {**second.counterweights, **first.counterweights})


def partial(mechanism, ratio="overall", *, crank):
    """Partially balanced crank-slider, by one counterweight on the crank.

    Parameters
    ----------
    mechanism : Mechanism
        Crank-slider.
    ratio : "across", "along", "overall" or float
        (h1 / L_OA) / (h2 / L_AB): 1, 0 or 1/2 by name.
    crank : Counterweight

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        The mechanism is no crank-slider or has no mass, the ratio is unknown, the condition cannot be reached by a
        counterweight on the crank, or the counterweight breaks its limits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.partial(mower, "across", crank=ks.Counterweight(arm=-0.02))
    >>> s = ks.solve(found.mechanism, 1.0, crank_speed=62.8)
    >>> abs(s.shaking_force).round(6)  # N: none across the guide
    array([414.187807,   0.      ])
    """
    value = _ratio(ratio)
    _refuse(mechanism)
    if not crank_sliders(mechanism):
        raise ParameterError(f"partial balancing by ratio is for crank-sliders, not for a {mechanism.name}")
    first, second, _ = crank_sliders(mechanism)[0]
    along, across = principal_points(mechanism).static_moments[second.link]
    if value == 1 and abs(across) > 1e-12 * abs(along):
        raise ParameterError(
            f"partial balancing: the {second.link}'s mass centre lies {mechanism.links[second.link].centre[1]:g} m off "
            f"the line {second.start}-{second.end}, so no counterweight on the crank takes the force across the guide "
            f"away; balance the {second.link} too"
        )
    return _set(mechanism, first.link, (value * first.length * along / second.length, 0.0), crank)


def _crank(mechanism):
    (name,) = mechanism.crank.links
    return name


NORMS = ("largest", "mean", "along", "across", "weighted")


def optimal(mechanism, norm="largest", *, phase=False, weights=(1.0, 0.0), angles=360, **counterweights):
    """Counterweights whose unbalances minimise a norm of the shaking force over the turn, at constant crank speed.

    Parameters
    ----------
    mechanism : Mechanism
    norm : "largest", "mean", "along", "across" or "weighted"
        Largest or mean magnitude of the shaking force, its largest component along or across the guide, or the root
        mean square of force and moment with the given weights.
    phase : bool
        Whether a counterweight may lie beside its link's line.
    weights : (force, moment)
        For "weighted": 1/N and 1/(N m). A counterweight on the crank alone does not change the shaking moment.
    angles : int
        Crank angles at which the norm is taken; for the largest of a force, its true extremes join them.
    **counterweights : Counterweight
        By link, as ``crank=Counterweight(arm=0.03)``; the side they lie on is found, the sign of the arm does not
        matter. Limits are kept.

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        An unknown norm, a link that does not exist, no counterweight at all, limits that cannot be kept, or forces
        along and across guides that are not parallel.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.optimal(mower, "mean", crank=ks.Counterweight(arm=0.035), angles=12)
    >>> before, after = (ks.Scene(item, 62.8).solve(12).shaking_force for item in (mower, found.mechanism))
    >>> print(f"{np.hypot(*after).mean() / np.hypot(*before).mean():.2f}")
    0.56
    """
    _refuse_massless(mechanism)
    checks.require(
        "optimal balancing",
        checks.choice("norm", norm, NORMS),
        checks.pair("weights", weights),
        *_search_problems(mechanism, counterweights),
    )
    if norm in ("along", "across"):
        guide_direction(mechanism)
    turn = np.linspace(0, 2 * np.pi * mechanism.turns, angles * mechanism.turns, endpoint=False)
    size = 2 if phase else 1

    def balanced(unknowns):
        result = Balanced(mechanism, mechanism)
        for (name, weight), unbalance in zip(counterweights.items(), unknowns.reshape(-1, size), strict=True):
            step = _added(result.mechanism, name, np.append(unbalance, 0.0)[:2], weight)
            result = Balanced(mechanism, step.mechanism, {**result.counterweights, **step.counterweights})
        return result

    def solved(unknowns):
        return Solution(balanced(unknowns * scale).mechanism, turn, 1.0, 0.0)

    def sizes(unknowns):
        return _sizes(solved(unknowns), norm)

    def value(unknowns):
        if norm == "weighted":
            return _weighted(solved(unknowns), weights)
        return (np.mean if norm == "mean" else np.max)(sizes(unknowns))

    def objective(unknowns):
        return value(unknowns) / reference

    scale = max(float(np.hypot(*pair)) for pair in principal_points(mechanism).static_moments.values())
    zero = np.zeros(size * len(counterweights))
    reference = value(zero) or 1.0
    kept_out = any(weight.keep_out for weight in counterweights.values())  # two sides of a hole to search
    starts = (zero - 0.5, zero + 0.5) if kept_out else (zero,)
    best = min((_searched(objective, start) for start in starts), key=objective)
    if norm not in ("largest", "along", "across"):
        return balanced(best * scale)
    for _ in range(8):  # what is largest between the angles joins them
        best = min(best, _levelled(lambda unknowns: sizes(unknowns) / reference, best), key=objective)
        peaks = extremes(solved(best), lambda solution: _sizes(solution, norm))
        if peaks.range[1] <= value(best) + 1e-10 * reference:
            break
        turn = np.append(turn, peaks.angle)
    return balanced(best * scale)


def _search_problems(mechanism, counterweights):
    """What is wrong with the counterweights to be found."""
    if not counterweights:
        yield "give at least one counterweight, such as crank=Counterweight(arm=0.03)"
    for name, weight in counterweights.items():
        yield checks.choice("link", name, tuple(mechanism.links))
        yield _weight_problem(name, weight)
        if getattr(weight, "whole_link", False):
            yield (
                f"{name}: optimal balancing adds counterweights to links; with the ratio or unbalance found, use "
                "partial or counterweight for a whole link"
            )


def _searched(objective, start):
    """Minimum by Nelder and Mead, begun anew where it stops."""
    from scipy.optimize import minimize

    options = {"xatol": 1e-10, "fatol": 1e-13, "maxiter": 2000}
    for _ in range(2):
        start = minimize(objective, start, method="Nelder-Mead", options=options, callback=_stop_at_zero).x
    return start


def _stop_at_zero(intermediate_result):
    if intermediate_result.fun < 1e-11:
        raise StopIteration


def _levelled(sizes, start):
    """Minimum of the largest of many sizes: of a level that none of them exceeds (SLSQP)."""
    from scipy.optimize import minimize

    found = minimize(
        lambda unknowns: unknowns[-1],
        np.append(start, np.max(sizes(start))),
        jac=lambda unknowns: np.append(np.zeros(start.size), 1.0),
        constraints={"type": "ineq", "fun": lambda unknowns: unknowns[-1] - sizes(unknowns[:-1])},
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 200},
    )
    return found.x[:-1]


def _sizes(solution, norm):
    """What the norm looks at, at each crank angle: the shaking force or a component of it."""
    if norm in ("along", "across"):
        return np.abs((along_guide if norm == "along" else across_guide)(solution))
    return magnitude(solution.shaking_force)


def _weighted(solution, weights):
    force, moment = weights[0] * magnitude(solution.shaking_force), weights[1] * solution.shaking_moment
    return np.sqrt(np.mean(force * force + moment * moment))


def _added(mechanism, link, unbalance, weight):
    """A counterweight of that unbalance, on whichever side, reduced to its limits."""
    size = float(np.hypot(*unbalance))
    smallest, largest = weight.unbalances()
    kept = unbalance * (min(max(size, smallest), largest) / size) if size else np.array([-smallest, 0.0])
    sided = weight if weight.arm is None else replace(weight, arm=float(np.copysign(weight.arm, kept[0])))
    return counterweight(mechanism, link, kept, sided)


def _weight_problem(name, weight):
    return None if isinstance(weight, Counterweight) else f"{name} must be a Counterweight, got {weight!r}"


def _set(mechanism, link, moment, weight):
    """Counterweight that gives a link this static moment."""
    checks.require("balancing", _weight_problem(link, weight))
    change = complex(*moment) - _static_moment(mechanism, link)
    own = mechanism.links[link]
    target = change + (complex(*own.centre) * own.mass if weight.whole_link else 0.0)
    return counterweight(mechanism, link, (target.real, target.imag), weight)


def _static_moment(mechanism, link):
    """Static moment of a link, along + i across.

    In a four-bar the coupler's vector is a sum of those of rocker, crank and frame, so its static moment passes to
    crank and rocker in proportion to their lengths (Berkof and Lowen 1969).
    """
    moments = {name: complex(*pair) for name, pair in principal_points(mechanism).static_moments.items()}
    bars = four_bar(mechanism)
    if bars is not None:
        share = moments[bars.coupler.link] / bars.coupler.length
        moments[bars.crank.link] -= share * bars.crank.length
        moments[bars.rocker.link] += share * bars.rocker.length
    return moments[link]


def _ratio(ratio):
    if isinstance(ratio, str):
        checks.require("partial balancing", checks.choice("ratio", ratio, tuple(RATIOS)))
        return RATIOS[ratio]
    checks.require("partial balancing", checks.finite("ratio", ratio))
    return float(ratio)


def _refuse(mechanism):
    """Refuse what full and partial balancing cannot do."""
    _refuse_massless(mechanism)
    if len(mechanism.groups) > 1 and mechanism.crank.length is not None:
        raise ParameterError(
            f"full and partial balancing are for a crank with one group; the {mechanism.name} has "
            f"{len(mechanism.groups)}: use `optimal` or `counterweight`"
        )
    if mechanism.crank.length is None:
        carried = principal_points(mechanism).carried
        pin = next(iter(mechanism.curves), "A")
        raise ParameterError(
            f"the pin {pin} of a {mechanism.name} runs at a varying distance from O with {carried.get(pin, 0.0):g} kg "
            "on it, so no counterweight on the crank balances it; use `optimal`, or a plain crank-slider"
        )


def _refuse_massless(mechanism):
    if mechanism.batch:
        raise ParameterError(f"balancing works on one design at a time, got a batch of shape {mechanism.batch}")
    if not np.any(principal_points(mechanism).mass):
        raise ParameterError(f"the {mechanism.name} has no mass: there is nothing to balance")


def __dir__():
    return __all__

"""Static balancing by counterweights on links: full, partial, optimal, with their effects.

A counterweight of mass m at the arm L adds its unbalance m L to the static moment m h of its link (`principal_points`).
Full balancing makes all static moments vanish; partial balancing, with one counterweight on the crank, sets the ratio

    (h1 / L_OA) / (h2 / L_AB)      1: no shaking force across the guide     0: nearly none along it
                                   1/2: least overall, by the mower study (Kotov 2024)

Two counterweights on the crank, in planes z1 and z2, cancel the rotating force and couple. With the rotating unbalances
u_i in the planes z_i, w1 + w2 = -sum of u_i and z1 w1 + z2 w2 = -sum of z_i u_i (`in_two_planes`).
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..cycle.extremes import extremes
from ..errors import ParameterError
from ..mechanics import assembly
from ..mechanics.principal_points import principal_points
from ..mechanics.quantities import magnitude
from ..numbers import checks
from ..solution.scene import mechanism_problem
from ..solution.solution import Solution
from .counterweights import (
    Balanced,
    Counterweight,
    across_guide,
    along_guide,
    counterweight,
    counterweight_on_either_side,
    guide_direction,
)
from .lanchester import WithShafts, shafts
from .linkage import crank_sliders, four_bar_shape

__all__ = [
    "Balanced",
    "Counterweight",
    "WithShafts",
    "counterweight",
    "full",
    "in_two_planes",
    "optimal",
    "pareto",
    "partial",
    "shafts",
]

NAMED_RATIOS = {"across": 1.0, "along": 0.0, "overall": 0.5}


def full(mechanism, *, crank, coupler=None, rocker=None):
    """Fully balanced mechanism: its common mass centre does not move.

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
        A counterweight is missing or not needed, breaks its limits, or the mechanism cannot be fully balanced.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.full(mower, crank=ks.Counterweight(arm=-0.05), coupler=ks.Counterweight(arm=-0.055))
    >>> s = ks.solve(found.mechanism, 1.0, crank_speed=62.8)
    >>> bool(abs(s.shaking_force).max() < 1e-9), round(found.added_mass, 1)  # N; kg is the price
    (True, 60.1)
    """
    given = {name: item for name, item in (("coupler", coupler), ("rocker", rocker)) if item is not None}
    _require_balanceable(mechanism)
    bars, chains = four_bar_shape(mechanism), crank_sliders(mechanism)
    if bars is None and not chains:
        raise ParameterError(f"full balancing is for crank-sliders and four-bars, not for a {mechanism.name}")
    outer, link = ("coupler", chains[0].coupler.link) if bars is None else ("rocker", bars.rocker.link)
    if set(given) != {outer}:
        raise ParameterError(
            f"full balancing of a {mechanism.name} needs a counterweight on crank and {outer}, got crank"
            f"{''.join(f' and {name}' for name in given) or ' only'}"
        )
    first = _set_static_moment(mechanism, link, (0.0, 0.0), given[outer])
    (crank_name,) = mechanism.crank.links
    second = _set_static_moment(first.mechanism, crank_name, (0.0, 0.0), crank)
    return Balanced(mechanism, second.mechanism, {**second.counterweights, **first.counterweights})


def partial(mechanism, ratio="overall", *, crank):
    """Partially balanced crank-slider, by one counterweight on the crank.

    Parameters
    ----------
    mechanism : Mechanism
        Crank-slider.
    ratio : "across", "along", "overall" or float
        (h1 / L_OA) / (h2 / L_AB), from 0 to 1: 1, 0 or 1/2 by name.
    crank : Counterweight

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        The mechanism is not a crank-slider or has no mass, or the ratio is unknown or not from 0 to 1. The condition
        cannot be reached by a counterweight on the crank, or the counterweight breaks its limits.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> found = ks.balancing.partial(mower, "across", crank=ks.Counterweight(arm=-0.02))
    >>> s = ks.solve(found.mechanism, 1.0, crank_speed=62.8)
    >>> abs(s.shaking_force).round(6)  # N: none across the guide
    array([414.187807,   0.      ])
    """
    if isinstance(ratio, str):
        checks.require("partial balancing", checks.choice("ratio", ratio, tuple(NAMED_RATIOS)))
        value = NAMED_RATIOS[ratio]
    else:
        value = checks.single_numbers("partial balancing", ratio=(ratio, "1", {}))["ratio"]
        checks.require("partial balancing", ratio_problem(value))
    _require_balanceable(mechanism)
    if not crank_sliders(mechanism):
        raise ParameterError(f"partial balancing by ratio is for crank-sliders, not for a {mechanism.name}")
    first, second, _ = crank_sliders(mechanism)[0]
    along, across = principal_points(mechanism).static_moments[second.link]
    if value == 1 and abs(across) > 1e-12 * abs(along):
        raise ParameterError(
            f"partial balancing: the {second.link}'s mass centre lies {mechanism.links[second.link].centre[1]:g} m off "
            f"the line {second.start}-{second.end}, so no counterweight on the crank cancels the force across the "
            f"guide; balance the {second.link} too"
        )
    return _set_static_moment(mechanism, first.link, (value * first.length * along / second.length, 0.0), crank)


WEIGHT_RULES = {
    "weights force": checks.Number("N**-1"),
    "weights moment": checks.Number("N**-1*m**-1"),
    "about": checks.Pair("m"),
}
GUIDE_FORCES = {"along": along_guide, "across": across_guide}
NORMS = ("largest", "mean", *GUIDE_FORCES, "weighted", "largest moment", "largest weighted")
MEAN_NORMS = ("mean", "weighted")
"""Norms other than a largest value over the turn."""
MAX_REFINEMENTS = 8
"""Number of times that exact peaks are added to the crank angles of a search."""
PEAK_TOLERANCE = 1e-10
"""Excess of an exact peak over the largest value at the crank angles, relative to the reference."""
LEVEL_TOLERANCE = 1e-6
"""Excess over the least moment at the end of a front, relative to the moment without counterweights."""
ZERO_NORM = 1e-11
"""Norm, relative to the reference, that is zero to rounding."""
FLAT_TOLERANCE = 1e-12
"""Negligible relative change of a norm by a counterweight."""


@dataclass(frozen=True, eq=False)
class _ShakingSearch:
    """Norm of shaking force and moment over unbalances in units of `scale`, the largest static moment of a link.

    `weights` are of force and moment, 1/N and 1/(N m). `about` is the point of the moment, m. `size` is 2 if an
    unbalance may be off its link's line, else 1. `turn` holds the crank angles, rad; `reference` is the norm without
    counterweights, or 1. The largest moment may not exceed `moment_limit` at crank speed 1 rad/s, N m.
    """

    mechanism: Any
    norm: str
    weights: tuple[float, float]
    about: tuple[float, float]
    counterweights: dict[str, Counterweight]
    size: int
    turn: Any
    scale: float
    reference: float = 1.0
    moment_limit: float = np.inf

    @property
    def none(self):
        """Unknowns without counterweights."""
        return np.zeros(self.size * len(self.counterweights))

    def balanced(self, unknowns):
        """The mechanism with counterweights of these unbalances, on either side and within their limits."""
        result, unbalances = Balanced(self.mechanism, self.mechanism), (unknowns * self.scale).reshape(-1, self.size)
        for (name, weight), part in zip(self.counterweights.items(), unbalances, strict=True):
            unbalance = np.append(part, 0.0)[:2]
            size = float(np.hypot(*unbalance))
            smallest, largest = weight.unbalances()
            kept = unbalance * (min(max(size, smallest), largest) / size) if size else np.array([-smallest, 0.0])
            step = counterweight_on_either_side(result.mechanism, name, kept, weight)
            result = Balanced(self.mechanism, step.mechanism, {**result.counterweights, **step.counterweights})
        return result

    def solved(self, unknowns):
        """Solution of the balanced mechanism at crank speed 1 rad/s."""
        return Solution(self.balanced(unknowns).mechanism, self.turn, 1.0, 0.0)

    def moments(self, solution):
        """Size of the shaking moment about the point at each crank angle, N m."""
        (x, y), (along_x, along_y) = self.about, solution.shaking_force
        return np.abs(solution.shaking_moment - (x * along_y - y * along_x))

    def values(self, solution):
        """Quantity of the norm at each crank angle, without sign."""
        if self.norm == "largest moment":
            return self.moments(solution)
        if self.norm in GUIDE_FORCES:
            return np.abs(GUIDE_FORCES[self.norm](solution))
        force = magnitude(solution.shaking_force)
        if self.norm not in ("weighted", "largest weighted"):
            return force
        return np.hypot(self.weights[0] * force, self.weights[1] * self.moments(solution))

    def sizes(self, unknowns):
        """Quantity of the norm at each crank angle, relative to the reference."""
        return self.values(self.solved(unknowns)) / self.reference

    def margins(self, unknowns):
        """Margins of the largest moment at each crank angle, relative to it."""
        return 1.0 - self.moments(self.solved(unknowns)) / self.moment_limit

    def objective(self, unknowns):
        """The norm relative to the reference."""
        sizes = self.sizes(unknowns)
        if self.norm == "weighted":
            return np.sqrt(np.mean(sizes * sizes))
        return np.mean(sizes) if self.norm == "mean" else np.max(sizes)

    def best(self):
        """Unknowns of the least norm over the turn."""
        # one start on each side if weights must stay outside a radius
        kept_out = any(weight.keep_out for weight in self.counterweights.values())
        starts = (self.none - 0.5, self.none + 0.5) if kept_out else (self.none,)
        best = min((_minimise_norm(self.objective, start) for start in starts), key=self.objective)
        return best if self.norm in MEAN_NORMS or self.objective(best) < ZERO_NORM else self.refined(best)

    def refined(self, best):
        """Unknowns of the least exact peak from a start; peaks between the crank angles are added to them."""
        search, limited = self, self.moment_limit < np.inf
        for _ in range(MAX_REFINEMENTS):
            found = _minimise_peak(search, best)
            best = found if limited else min(best, found, key=search.objective)
            solved = search.solved(best)
            peaks = [extremes(solved, search.values)]
            excess = [peaks[0].range[1] / search.reference - search.objective(best)]
            if limited:
                peaks.append(extremes(solved, search.moments))
                excess.append(peaks[1].range[1] / self.moment_limit - 1.0)
            if max(excess) <= PEAK_TOLERANCE:
                break
            search = replace(search, turn=np.concatenate([search.turn, *(peak.angle for peak in peaks)]))
        return best


def _minimise_norm(objective, start):
    """Minimiser by Nelder and Mead, restarted once."""
    from scipy.optimize import minimize

    def stop_at_zero(intermediate_result):
        if intermediate_result.fun < ZERO_NORM:
            raise StopIteration

    options = {"xatol": 1e-10, "fatol": 1e-13, "maxiter": 2000}
    for _ in range(2):
        start = minimize(objective, start, method="Nelder-Mead", options=options, callback=stop_at_zero).x
    return start


def _minimise_peak(search, start):
    """Minimiser of the largest size of a search: of a level above all sizes (SLSQP), under the limit of the moment."""
    from scipy.optimize import minimize

    margins = [lambda unknowns: unknowns[-1] - search.sizes(unknowns[:-1])]
    if search.moment_limit < np.inf:
        margins.append(lambda unknowns: search.margins(unknowns[:-1]))
    found = minimize(
        lambda unknowns: unknowns[-1],
        np.append(start, np.max(search.sizes(start))),
        jac=lambda unknowns: np.append(np.zeros(start.size), 1.0),
        constraints=[{"type": "ineq", "fun": margin} for margin in margins],
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 200},
    )
    return found.x[:-1]


def _search(mechanism, norm, phase, weights, about, angles, counterweights):
    """Checked search for counterweights under a norm."""
    _require_masses(mechanism)
    problems = [None if counterweights else "give at least one counterweight, such as crank=Counterweight(arm=0.03)"]
    for name, weight in counterweights.items():
        problems += [checks.choice("link", name, tuple(mechanism.links)), _weight_problem(name, weight)]
        if getattr(weight, "whole_link", False):
            problems.append(
                f"{name}: optimal balancing adds counterweights to links; to set a ratio or unbalance, use "
                "partial or counterweight for a whole link"
            )
    paired = isinstance(weights, list | tuple | np.ndarray) and getattr(weights, "ndim", 1) == 1 and len(weights) == 2
    found = checks.check_values(
        "optimal balancing",
        WEIGHT_RULES,
        dict(zip(WEIGHT_RULES, (*(weights if paired else (1.0, 0.0)), about), strict=True)),
        checks.choice("norm", norm, NORMS),
        None if paired else f"weights must be a pair (force, moment), got {checks.shown(weights)}",
        checks.count("angles", angles, size=checks.BYTES_PER_ANGLE),
        checks.truth("phase", phase),
        *problems,
    )
    if norm in GUIDE_FORCES:
        guide_direction(mechanism)
    assembly.require_turn(mechanism)
    turn = np.linspace(0, 2 * np.pi * mechanism.turns, angles * mechanism.turns, endpoint=False)
    scale = max(float(np.hypot(*pair)) for pair in principal_points(mechanism).static_moments.values())
    *pair, point = found.values()
    checks.require("optimal balancing", None if any(map(np.any, pair)) else "weights must not both be 0")
    search = _ShakingSearch(mechanism, norm, tuple(pair), point, counterweights, 2 if phase else 1, turn, scale)
    search = replace(search, reference=search.objective(search.none) or 1.0)
    trials = 0.5 * np.vstack([np.eye(search.none.size), -np.eye(search.none.size)])
    if norm == "largest moment" and all(abs(search.objective(trial) - 1.0) <= FLAT_TOLERANCE for trial in trials):
        raise ParameterError(
            f"optimal balancing: a counterweight on {', '.join(counterweights)} does not change the shaking moment "
            f"about ({point[0]:g}, {point[1]:g}) m; give one on another link, or another point"
        )
    return search


def optimal(
    mechanism, norm="largest", *, phase=False, weights=(1.0, 0.0), about=(0.0, 0.0), angles=360, **counterweights
):
    """Counterweights whose unbalances minimise a norm of shaking force or moment over the turn at constant crank speed.

    Parameters
    ----------
    mechanism : Mechanism
    norm : "largest", "mean", "along", "across", "weighted", "largest moment" or "largest weighted"
        Largest or mean magnitude of the shaking force; its largest component along or across the guide. Largest
        magnitude of the shaking moment; or root mean square or largest value of the weighted force and moment. The
        weighted value is the root of the sum of squares.
    phase : bool
        Whether a counterweight may be off its link's line.
    weights : (force, moment)
        For "weighted" and "largest weighted", in 1/N and 1/(N m). (0, 1) minimises the root mean square of the moment.
    about : (x, y)
        Point of the shaking moment, m; by default O. A counterweight on the crank does not change the moment about O.
    angles : int
        Number of crank angles of the norm; for a largest value, exact extremes are added to them.
    **counterweights : Counterweight
        By link, as ``crank=Counterweight(arm=0.03)``. The search finds the side, for either sign of the arm, and keeps
        the limits.

    Returns
    -------
    Balanced

    Raises
    ------
    ParameterError
        The norm or a link is unknown, there is no counterweight, or limits cannot be kept. Forces are required along
        and across guides that are not parallel, or no counterweight changes the moment.
    AssemblyError
        The mechanism does not close all round the turn, with the crank angles.

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
    search = _search(mechanism, norm, phase, weights, about, angles, counterweights)
    return search.balanced(search.best())


def pareto(mechanism, *, points=9, crank_speed=1.0, phase=False, about=(0.0, 0.0), angles=360, **counterweights):
    """Counterweights with the smallest shaking force for each limit of the shaking moment (largest values).

    Parameters
    ----------
    mechanism, phase, about, angles, counterweights
        As for `optimal`.
    points : int
        Number of designs on the front, at least 2, evenly spaced in the moment, from least force to least moment.
    crank_speed : float
        Crank speed for force and moment in the table, rad/s; the counterweights do not depend on it.

    Returns
    -------
    design.Front
        Its `designs` are `Balanced`.

    Raises
    ------
    ParameterError, AssemblyError
        As for `optimal`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> mower = ks.crank_slider(0.038, 0.3, crank=ks.Link(1.0, 0.019), coupler=ks.Link(2.0, 0.1), slider=ks.Link(5.0))
    >>> weight = ks.Counterweight(arm=0.05)
    >>> front = ks.balancing.pareto(mower, points=3, crank_speed=62.8, about=(0.2, 0.0), angles=24, crank=weight)
    >>> [type(design).__name__ for design in front.designs]
    ['Balanced', 'Balanced', 'Balanced']
    >>> bool((front.table["largest shaking_moment [N m]"].diff().dropna() < 0).all())
    True
    """
    import pandas as pd

    from .pareto_front import Front, points_problem

    given = crank_speed, "rad/s", {"unequal": 0.0}
    speed = checks.single_numbers("pareto", points_problem(points), crank_speed=given)["crank_speed"]
    force, moment = (
        _search(mechanism, norm, phase, (1.0, 0.0), about, angles, counterweights)
        for norm in ("largest", "largest moment")
    )

    def outputs(unknowns):
        solved = force.solved(unknowns)
        return [float(speed**2 * extremes(solved, item.values).range[1]) for item in (force, moment)]

    found = [force.best()]
    high, least = outputs(found[0])[1], outputs(moment.best())[1]
    for level in np.linspace(high, least + LEVEL_TOLERANCE * high, points)[1:]:
        found.append(replace(force, moment_limit=level / speed**2).refined(found[-1]))
    rows, designs = [], tuple(map(force.balanced, found))
    for item, design in zip(found, designs, strict=True):
        row = dict(zip(("largest shaking_force [N]", "largest shaking_moment [N m]"), outputs(item), strict=True))
        for link, (mass, (along, across)) in design.counterweights.items():
            row |= {f"{link} unbalance along [kg m]": mass * along, f"{link} unbalance across [kg m]": mass * across}
        rows.append(row)
    names = "largest shaking_force", "largest shaking_moment"
    return Front(names, pd.DataFrame(rows), designs, tuple(outputs(force.none)))


def _weight_problem(name, weight):
    return None if isinstance(weight, Counterweight) else f"{name} must be a Counterweight, got {weight!r}"


def in_two_planes(mechanism, *, left, right, reciprocating=0.0):
    """Mechanism with two counterweights on the crank that balance its rotating masses: their force and their couple.

    Rotating masses are the crank and each block on a crank pin. A coupler on a crank pin adds (1 - s/l) of its mass m,
    with its centre at s from the pin on the length l. A share of the reciprocating masses (sliders and the rest of
    their couplers) may be balanced too, at the cost of an equal force across the guide.

    Parameters
    ----------
    mechanism : Mechanism
        With planes of its groups.
    left, right : Counterweight
        Each has a `plane`, and a mass or an arm; here an arm is a distance without sign.
    reciprocating : float
        Share of the reciprocating masses, 0 to 1; 1/2 leaves the least first harmonic of one cylinder.

    Returns
    -------
    Balanced
        `in_planes` lists both counterweights, `counterweights` their sum.

    Raises
    ------
    ParameterError
        A counterweight has no plane, both have the same plane, or limits are broken. The share is not from 0 to 1. The
        mechanism has no mass, is a batch, or moves its pin at a varying distance from O.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Mechanism("pump", ks.Crank(0.05, ks.Link(2.0, 0.02)), (ks.SliderGroup(0.2, plane=0.1),))
    >>> left, right = (ks.Counterweight(arm=0.05, plane=z) for z in (-0.1, 0.3))
    >>> found = ks.balancing.in_two_planes(pump, left=left, right=right)
    >>> [(plane, round(mass, 6)) for plane, mass, _ in found.in_planes]  # the crank is in the plane 0
    [(-0.1, 0.6), (0.3, 0.2)]
    """
    owner = "balancing in two planes"
    share = checks.single_numbers(owner, reciprocating=(reciprocating, "1", {}))["reciprocating"]
    _require_masses(mechanism)
    given = {"left": left, "right": right}
    checks.require(owner, *(_weight_problem(name, weight) for name, weight in given.items()))
    checks.require(
        owner,
        None if 0.0 <= share <= 1.0 else f"reciprocating must lie between 0 and 1, got {share:g}",
        *(f"{name} needs a plane: Counterweight(..., plane=0.3)" for name, item in given.items() if item.plane is None),
        f"left and right have the same plane, {left.plane:g} m" if left.plane == right.plane is not None else None,
        "the pin of a cam roller moves at a varying distance from O" if mechanism.led_by_ground else None,
    )
    (crank,) = mechanism.crank.links
    pins = {name: complex(*point[1:]) for name, point in mechanism.joints.items() if point.link == crank}
    own, planes = mechanism.links[crank], mechanism.planes
    force = own.mass * complex(*own.centre)
    couple = planes[crank] * force + complex(*(own.couple_unbalance or (0.0, 0.0)))
    bars = {bar.link: bar for bar in mechanism.couplers}
    for name, link in mechanism.links.items():
        if (pin := mechanism.references[name]) not in pins or name == crank:
            continue
        bar = bars.get(name)
        away = complex(*link.centre) / bar.length if bar else 0.0
        unbalance = link.mass * (1.0 - away)
        if bar and (slider := mechanism.joints[bar.end].link) in mechanism.guides:
            unbalance += share * (link.mass * away.real + mechanism.links[slider].mass)
        force += unbalance * pins[pin]
        couple += planes[name] * unbalance * pins[pin]
    second = (left.plane * force - couple) / (right.plane - left.plane)
    changed, weights = mechanism, []
    for weight, needed in ((left, -force - second), (right, second)):
        made = counterweight_on_either_side(changed, crank, (needed.real, needed.imag), weight)
        weights.append((weight.plane, *made.counterweights[crank]))
        changed = made.mechanism
    mass = sum(weight for _, weight, _ in weights)
    place = tuple(-np.array([force.real, force.imag]) / mass) if mass else (0.0, 0.0)
    return Balanced(mechanism, changed, {crank: (mass, place)}, tuple(weights))


def _set_static_moment(mechanism, link, moment, weight):
    """`Balanced` with the counterweight that gives a link this static moment.

    In a four-bar the coupler's vector is a sum of rocker, crank and frame vectors. So its static moment passes to crank
    and rocker in proportion to their lengths (Berkof and Lowen 1969).
    """
    checks.require("balancing", _weight_problem(link, weight))
    moments = {name: complex(*pair) for name, pair in principal_points(mechanism).static_moments.items()}
    bars = four_bar_shape(mechanism)
    if bars is not None:
        share = moments[bars.coupler.link] / bars.coupler.length
        moments[bars.crank.link] -= share * bars.crank.length
        moments[bars.rocker.link] += share * bars.rocker.length
    own = mechanism.links[link]
    target = complex(*moment) - moments[link] + (complex(*own.centre) * own.mass if weight.whole_link else 0.0)
    return counterweight(mechanism, link, (target.real, target.imag), weight)


def ratio_problem(ratio):
    """Sentence about a ratio of partial balancing outside 0 to 1, or None."""
    if 0.0 <= ratio <= 1.0:
        return None
    return (
        f"ratio must be from 0 (nearly no force along the guide) to 1 (none across it), got {ratio:g}: beyond them "
        "the force is larger both along and across the guide"
    )


def _require_balanceable(mechanism):
    """Refuse mechanisms that full and partial balancing do not cover."""
    _require_masses(mechanism)
    if mechanism.crank.length is None:
        pin = next(iter(mechanism.curves), "A")
        carried = principal_points(mechanism).carried.get(pin, 0.0)
        raise ParameterError(
            f"the pin {pin} of a {mechanism.name} moves at a varying distance from O with {carried:g} kg on it, so no "
            "counterweight on the crank balances it. Use `optimal`, or a plain crank-slider"
        )
    if len(mechanism.groups) > 1:
        raise ParameterError(
            f"full and partial balancing are for a crank with one group; the {mechanism.name} has "
            f"{len(mechanism.groups)}: use `optimal` or `counterweight`"
        )


def _require_masses(mechanism):
    checks.require("balancing", mechanism_problem(mechanism))
    if mechanism.batch:
        raise ParameterError(f"balancing works on one design at a time, got a batch of shape {mechanism.batch}")
    if not np.any(principal_points(mechanism).mass):
        raise ParameterError(f"the {mechanism.name} has no mass to balance")


def __dir__():
    return __all__

"""How many times relative errors of lengths and crank angle are magnified in rates, reactions and torque.

The kernels run once on numbers that carry their derivatives along (forward differentiation). Each derivative is by the
logarithm of a length or of the crank angle, so the magnification of a quantity q at a crank angle is

    sum over lengths and crank angle p of |p dq/dp|, over the largest term of q

The largest term of a rate is that rate, of a reaction the largest load on a link, of the torque the largest torque that
one load alone would take; terms that pass through zero count as a tenth of what they are if speeds and accelerations
have their worst direction. Only as much of a term counts as is certain with rounded lengths: where no digit is left,
what was computed says nothing.
"""

import math
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..machine.links import arm, first_at, second_at, virtual_work
from ..numbers.elementary import UNIT
from ..numbers.planar import product, subtracted, vector
from .seeded import Seeded, number_of

SAFETY = 3.0
"""Factor that makes a bound of a magnification: other signs of errors, and rounding of the derivatives."""
CERTAIN = 4.0
"""Roundings of all lengths and the crank angle that a value is uncertain by."""
PASSING = 0.1
"""Share of its worst case that a term counts as where it passes through zero."""
BLOCK = 4096
"""Crank angles differentiated at a time."""


def condition(solution, points=None, reactions=None):
    """Bound of the magnification at each crank angle, NaN where the mechanism does not close.

    Parameters
    ----------
    solution : Solution
    points : array of int, optional
        Places in the flattened shape of the solution; all unless told.
    reactions : bool, optional
        Whether reactions count; unless told they do where no change points are passed, at which they grow without
        bound. They count over what they have grown to.

    Returns
    -------
    array (N,)
        Of the points; infinite where rounding of lengths or crank angle may keep the mechanism from closing.

    Raises
    ------
    NotGivenError
        A group of the user's own does more than arithmetic and comparisons.
    """
    points = np.arange(math.prod(solution.shape)) if points is None else np.asarray(points)
    reactions = not solution.mechanism.passes if reactions is None else reactions
    with np.errstate(all="ignore"):
        blocks = [_at(solution, points[start : start + BLOCK], reactions) for start in range(0, points.size, BLOCK)]
    return np.concatenate(blocks)


def _at(solution, points, reactions):
    try:
        seeded = Seeded(solution, points)
        return _magnified(seeded.solution, seeded.largest_pushes, points.size, reactions)
    except (TypeError, ValueError, AttributeError) as error:
        if points.size == 1:
            name = solution.mechanism.name
            raise NotGivenError(f"{name}: no condition, its kernels cannot be differentiated ({error})") from error
    return np.concatenate([_at(solution, points[number : number + 1], reactions) for number in range(points.size)])


class _Sized:
    """Magnitude of a number or vector, sum of the magnitudes of its changes, and how much of it is certain."""

    def __init__(self, part):
        parts = [number_of(one) for one in (part if isinstance(part, tuple) else (part,))]
        slopes = [np.zeros((1, 1)) if one.slopes is None else one.slopes for one in parts]
        self.size, changes = reduce(np.hypot, [abs(one.value) for one in parts]), np.abs(reduce(np.hypot, slopes))
        self.change = changes.sum(axis=0)
        self.certain = np.fmax(self.size - CERTAIN * UNIT * self.change, 0.0)


class _Terms(NamedTuple):
    """Sizes of a link's motion and loads if every direction is the worst: what they are terms of."""

    speed: Any
    acceleration: Any
    rate: Any
    rate_change: Any
    force: Any
    moment: Any
    length: Any


def _magnified(solution, largest_pushes, count, reactions):
    """Bound at the points of a solution with derivatives."""
    placement, links = solution.placement, _terms(solution)
    speed = reduce(np.maximum, (link.speed for link in links.values()))
    acceleration = reduce(np.maximum, (link.acceleration for link in links.values()))
    shares = [_share(group.closure(placement)) for group in solution.mechanism.groups]
    for joint in placement.joints.values():
        shares += [_over(joint.first, PASSING * speed), _over(joint.second, PASSING * acceleration)]
    for name, link in links.items():
        motion = placement.links[name]
        shares.append(_over(motion.ratio, PASSING * link.rate))
        shares.append(_over(motion.ratio_slope, PASSING * link.rate_change))
    shares += _of_forces(solution, links, largest_pushes, reactions)
    found = np.maximum(SAFETY * reduce(np.maximum, shares, np.zeros(count)), 1.0)
    positions = [number_of(part).value for joint in placement.joints.values() for part in joint.position]
    closed = np.isfinite(reduce(np.add, positions))
    return np.where(closed, np.where(np.isnan(found), np.inf, found), np.nan)


def _share(margin):
    """Infinite where rounding may open the mechanism, else 0."""
    found = _Sized(margin)
    return np.where((found.certain > 0.0) & (number_of(margin).value > 0.0), 0.0, np.inf)


def _over(part, terms):
    """Change of a quantity over its value, or its terms where they are larger; 0 where nothing changes."""
    if part is None:
        return 0.0
    found = _Sized(part)
    return _quotient(found.change, np.maximum(found.certain, terms))


def _quotient(change, size):
    return np.where(change == 0.0, 0.0, np.divide(change, size))


def _terms(solution):
    """Terms of every link by name."""
    placement, bodies = solution.placement, {name: link.body for name, link in solution.mechanism.links.items()}
    square, alpha = (abs(number_of(part).value) for part in solution.accelerating)
    gravity = 0.0 if solution.gravity is None else _Sized(solution.gravity).size
    found = {}
    for part in (solution.mechanism.crank, *solution.mechanism.groups):
        ends = [end for bar in part.bars for end in (bar.start, bar.end)] or (*part.hangs_on, *part.joints)
        joints = [placement.joints[name] for name in ends]
        lengths = {bar.link: number_of(bar.length).value for bar in part.bars}
        for name in part.links:
            link, body = placement.links[name], bodies[name]
            length = lengths.get(name, np.inf)  # what does not turn has none
            if name not in lengths and link.ratio is not None:  # a lever is as long as its block is far
                gaps = (_Sized(subtracted(joint.position, link.joint.position)).size for joint in joints)
                length = reduce(np.maximum, gaps, 0.0)
                length = np.where(length > 0.0, length, np.inf)
            to_centre = arm(link.direction, body.along, body.across)
            firsts = [first_at(link, to_centre), *(joint.first for joint in joints)]
            seconds = [second_at(link, to_centre), *(joint.second for joint in joints)]
            speed, acceleration = (
                reduce(np.maximum, (_Sized(vector(one)).certain for one in ones)) for ones in (firsts, seconds)
            )
            rate = np.maximum(_Sized(link.ratio).certain, speed / length)
            rate_change = np.maximum(rate * rate, acceleration / length)
            force = number_of(body.mass).value * (gravity + square * acceleration + alpha * speed)
            moment = number_of(body.inertia).value * (square * rate_change + alpha * rate)
            found[name] = _Terms(speed, acceleration, rate, rate_change, force, moment, length)
    return found


def _of_forces(solution, links, largest_pushes, reactions):
    """Magnification in reactions and torque; nothing without loads."""
    forces, torques = [0.0], [0.0]
    for name, wrench in solution.link_loads.items():
        link = links[name]
        forces += [PASSING * link.force, PASSING**2 * link.moment / link.length]
        torques.append(PASSING * (link.force * link.speed + link.moment * link.rate))
        forces.append(0.0 if wrench.force is None else _Sized(wrench.force).certain)
        torques.append(_Sized(virtual_work(solution.placement.links[name], wrench)).certain)
    for name, push in solution.pushes.items():
        work = product(push, solution._travel(name).first)
        size = np.maximum(_Sized(push).certain, PASSING * largest_pushes[name])
        forces.append(size)
        torques += [_Sized(work).certain, PASSING * size * links[name].speed]
    force, torque = reduce(np.maximum, forces), reduce(np.maximum, torques)
    found = solution.resolved
    of_torque = _quotient(_Sized(found.scalars["balancing_torque"]).change, torque)
    if not reactions:
        return [of_torque]
    outputs, grow = solution.mechanism.outputs, solution.mechanism.passes
    scalars = (found.scalars[name] for name, output in outputs.items() if output.unit == "N" and not output.vector)
    supports = [*found.reactions.values(), *scalars]
    sized = [_Sized(vector(part) if part is None else part) for part in supports]
    return [*(_quotient(one.change, np.fmax(force, one.size) if grow else force) for one in sized), of_torque]

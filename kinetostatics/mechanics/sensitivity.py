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
from dataclasses import dataclass, fields, replace
from functools import reduce
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..errors import NotGivenError
from ..machine.cams import Cam
from ..machine.crank import ray
from ..machine.group import Group
from ..machine.guide import Guide
from ..machine.links import Link, arm, first_at, second_at, virtual_work
from ..machine.loads import Load, ProcessForce, Table
from ..numbers.duals import Dual
from ..numbers.elementary import UNIT
from ..numbers.leaves import is_structural, mapped, with_fields
from ..numbers.planar import product, subtracted, vector
from .dynamics import Dynamics
from .pushes import amount, moving, pushed

SAFETY = 3.0
"""Factor that makes a bound of a magnification: other signs of errors, and rounding of the derivatives."""
CERTAIN = 4.0
"""Roundings of all lengths and the crank angle that a value is uncertain by."""
PASSING = 0.1
"""Share of its worst case that a term counts as where it passes through zero."""
BLOCK = 4096
"""Crank angles differentiated at a time."""
STEP = 1e-4
"""Step of the crank angle for the third derivative of a cam that takes plain numbers only, rad."""


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
        seeded = _Seeded(solution, points)
        return _magnified(seeded.solution, seeded.largest_pushes, points.size, reactions)
    except (TypeError, ValueError, AttributeError) as error:
        if points.size == 1:
            name = solution.mechanism.name
            raise NotGivenError(f"{name}: no condition, its kernels cannot be differentiated ({error})") from error
    return np.concatenate([_at(solution, points[number : number + 1], reactions) for number in range(points.size)])


class _Seeded:
    """`solution`: one at some points, with numbers that carry derivatives in place of its own."""

    def __init__(self, plain, points):
        self._plain, self._points, self._shape = plain, points, plain.shape or (1,)
        self._places = np.unravel_index(points, self._shape)
        lengths: list[Any] = []
        self._geometry(plain.mechanism, lengths.append)
        for item in plain.loads:
            mapped(_lengths(item), lengths.append)
        self._seeds, self._count = 0, len(lengths) + len(plain.loads) + 2
        self._angle = _array(self._seed(plain.crank_angle))
        mechanism = self._geometry(plain.mechanism, self._seed, {Group: self._group})
        speed, acceleration = mapped((plain.crank_speed, plain.crank_acceleration), self._constant)
        idle = Dynamics(mechanism, self._angle, speed, acceleration, (), mapped(plain.friction, self._constant))
        self.solution = replace(idle, loads=tuple(self._load(item, idle) for item in plain.loads))
        self.largest_pushes = {
            name: self._value(np.asarray(plain.largest(push))[..., None]) for name, push in plain.pushes.items()
        }

    def _geometry(self, item, number, special=None):
        """The item with its masses as they are, and other numbers in place of its lengths."""

        def link(own):
            mass, inertia = mapped((own.mass, own.inertia), self._constant)
            return with_fields(own, mass=mass, centre=mapped(own.centre, number), inertia=inertia)

        def guide(line):
            direction = (1.0, 0.0) if line.is_level else mapped(line.direction, self._constant)
            return with_fields(line, angle=None, guide_offset=mapped(line.guide_offset, number), exact=direction)

        return mapped(item, number, {Link: link, Guide: guide, **(special or {})})

    def _constant(self, value):
        return Dual(self._value(value)) if np.ndim(value) else value

    def _value(self, value):
        """Values at the points, one for all of a plain number."""
        if not np.ndim(value):
            return float(value)
        return np.broadcast_to(np.asarray(value, dtype=float), self._shape)[self._places]

    def _seed(self, value):
        value = self._value(value)
        return Dual(value, self._slopes(value))

    def _slopes(self, by_seed):
        """Derivatives by the next seed alone."""
        slopes = np.zeros((self._count, self._points.size))
        slopes[self._seeds] = by_seed
        self._seeds += 1
        return slopes

    def _group(self, group):
        parts = {
            field.name: self._geometry(getattr(group, field.name), self._seed)
            for field in fields(group)
            if not is_structural(field) and field.name != "cam"
        }
        if hasattr(group, "cam"):
            parts["cam"] = self._cam(group.cam)
        return with_fields(group, **parts)

    def _cam(self, cam):
        known, angle = self._seeds, self._plain.crank_angle
        plain = cam.polar(angle, ray(angle))
        try:
            copied = self._geometry(cam, self._seed)
            self._require_equal(copied.polar(self._angle, ray(self._angle)), plain)
        except Exception:  # whatever fails on numbers that are not plain
            self._seeds = known
            return _Values(self._tabled(cam, plain))
        return copied

    def _tabled(self, cam, plain):
        """Radius and derivatives of a cam that takes plain numbers only, by its size and by the crank angle."""
        angle = self._plain.crank_angle
        third = (
            (cam.polar(angle + STEP, ray(angle + STEP))[2] - cam.polar(angle - STEP, ray(angle - STEP))[2]) / 2 / STEP
        )
        values = [self._value(part) for part in (*plain, third)]
        by_angle, by_size = self._angle[0].slopes, self._slopes(1.0)
        return [_array(Dual(value, by_size * value + by_angle * slope)) for value, slope in pairwise(values)]

    def _load(self, item, idle):
        if not isinstance(item, Load):
            found = self._given(lambda: item.push(moving(idle)), pushed(item, self._plain))
            return ProcessForce(found, item.on)
        lengths = {name: mapped(part, self._seed) for name, part in _lengths(item)}
        copied = with_fields(mapped(item, self._constant), **lengths)
        if item.is_given:
            return copied
        return with_fields(copied, **{item.VALUE: self._value_of(item, idle)})

    def _value_of(self, item, idle):
        """What a table or function gives, with derivatives where it lets them through."""
        value = item.value_now
        if not isinstance(value, Table):
            return self._given(lambda: value(moving(idle)), amount(item, self._plain))
        pieces = [self._value(part) for part in value.pieces(self._plain)]
        return value.read(idle, [_array(Dual(part)) for part in pieces])

    def _given(self, compute, plain):
        """What a function of the user's computes, or its plain values where it takes plain numbers only."""
        known = self._seeds
        try:
            found = compute()
            self._require_equal([found], [plain])
        except Exception:  # whatever fails on numbers that are not plain
            self._seeds = known
            found = self._constant(plain)
        return _array(found) if isinstance(found, Dual) else found

    def _require_equal(self, parts, plain):
        for part, value in zip(parts, plain, strict=True):
            own = _number(part).value
            if not np.allclose(own, self._value(value), rtol=1e-6, atol=0.0, equal_nan=True):
                raise ValueError("another value than by plain numbers")


def _lengths(item):
    """Name and value of each field of a load that holds lengths."""
    return tuple((name, getattr(item, name)) for name in getattr(item, "LENGTHS", ()))


@dataclass(frozen=True, eq=False)
class _Values(Cam):
    """A cam whose radius and derivatives are handed in."""

    values: Any

    def polar(self, angle, ray):
        return self.values


def _array(value):
    """The form in which kernels take numbers that are not plain."""
    found = np.empty(1, dtype=object)
    found[0] = value
    return found


def _number(part):
    """The number in what a kernel gives; an absent one is zero."""
    part = np.ravel(part)[0] if isinstance(part, np.ndarray) else part
    return part if isinstance(part, Dual) else Dual(0.0 if part is None else float(part))


class _Sized:
    """Magnitude of a number or vector, sum of the magnitudes of its changes, and how much of it is certain."""

    def __init__(self, part):
        parts = [_number(one) for one in (part if isinstance(part, tuple) else (part,))]
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
    positions = [_number(part).value for joint in placement.joints.values() for part in joint.position]
    closed = np.isfinite(reduce(np.add, positions))
    return np.where(closed, np.where(np.isnan(found), np.inf, found), np.nan)


def _share(margin):
    """Infinite where rounding may open the mechanism, else 0."""
    found = _Sized(margin)
    return np.where((found.certain > 0.0) & (_number(margin).value > 0.0), 0.0, np.inf)


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
    square, alpha = (abs(_number(part).value) for part in solution.accelerating)
    gravity = 0.0 if solution.gravity is None else _Sized(solution.gravity).size
    found = {}
    for part in (solution.mechanism.crank, *solution.mechanism.groups):
        ends = [end for bar in part.bars for end in (bar.start, bar.end)] or (*part.hangs_on, *part.joints)
        joints = [placement.joints[name] for name in ends]
        lengths = {bar.link: _number(bar.length).value for bar in part.bars}
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
            force = _number(body.mass).value * (gravity + square * acceleration + alpha * speed)
            moment = _number(body.inertia).value * (square * rate_change + alpha * rate)
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

"""Condition: magnification of relative errors of lengths and crank angle in rates, reactions and torque.

The magnification of a quantity q at a crank angle is, by the exact derivatives of the recorded program,

    sum over lengths and crank angle p of |p dq/dp|, over the largest term of q

The largest term of a rate is the rate itself, of a reaction the largest load on a link, of the torque the largest
torque of a single load. A term that passes through zero counts as a tenth of its value for the worst direction of
speeds and accelerations. Only the part of a term that is certain with rounded lengths counts; where no digit is
certain, the computed value is meaningless.

A user's group may do more than arithmetic, so that it cannot be recorded. Then the derivatives are central
differences, accurate to about ten digits away from limit positions, with a `ConditionWarning`.
"""

import itertools
import math
import warnings
from functools import partial, reduce
from typing import Any, NamedTuple

import numpy as np

from ..engines.derivatives import Evaluation, tangents
from ..engines.graph import Node, needed
from ..engines.record import Recorder
from ..errors import ConditionWarning, NotGivenError
from ..machine.crank import ray
from ..machine.guide import Guide
from ..machine.links import Link, arm, first_at, second_at, virtual_work
from ..machine.loads import TURN, Load, value_of
from ..mechanics.assembly import HALF_DIGITS_CONDITION
from ..mechanics.dynamics import Dynamics
from ..numbers.arithmetic import SQUARE_TOLERANCE, UNIT_ROUNDOFF, is_foreign_array
from ..numbers.parameter_tree import Opaque, map_numbers, unflatten
from ..numbers.planar import product, subtract_vectors

MARGIN_FACTOR = 100.0
"""Upper limit of the condition times margin^2 / (proportion^2 times crank angle)."""
SAFETY_FACTOR = 3.0
"""Factor from a magnification to its bound: signs of errors may differ, and derivatives are rounded."""
UNCERTAIN_ROUNDINGS = 4.0
"""Number of roundings of all lengths and the crank angle in the uncertainty of a value."""
ZERO_SHARE = 0.1
"""Least value of a term that passes through zero, relative to its worst case."""
BLOCK_SIZE = 512
"""Number of crank angles differentiated at a time."""
THIRD_STEP = 1e-4
"""Step of the crank angle for the third derivative of a cam that is not recorded, rad."""
DIFFERENCE_STEP = 6e-6
"""Relative step of a length, and step of the crank angle in rad, for central differences."""


def condition(solution, points=None, reactions=None):
    """Bound of the magnification at each crank angle, (M,), NaN where the mechanism does not close.

    It is infinite where rounding of lengths or crank angle may keep the mechanism from closing. `points` (M,) are
    places in the flattened shape of the solution, a `Dynamics`; default all. By default `reactions` count where no
    change points are passed, because they grow without bound there; they are compared with the largest value that they
    have reached. Arrays of another library than NumPy raise a `NotGivenError`; a group that cannot be recorded causes a
    `ConditionWarning`.
    """
    points = np.arange(math.prod(solution.shape)) if points is None else np.asarray(points)
    reactions = not solution.mechanism.passes if reactions is None else reactions
    solution = _in_double_precision(solution)
    with np.errstate(all="ignore"):
        recorded = solution.kind.answer(_recorded)
        scene, sizes_at = _by_differences(solution) if recorded is None else recorded.of(solution)
        largest = {name: np.asarray(solution.largest(push))[..., None] for name, push in solution.pushes.items()}
        blocks = [np.empty(0)]
        for start in range(0, points.size, BLOCK_SIZE):
            places = points[start : start + BLOCK_SIZE]
            sizes = iter(sizes_at(places))
            pushes = {name: _at(places, solution, push) for name, push in largest.items()}
            found = _magnification(scene, lambda *_, sizes=sizes: next(sizes), pushes, reactions)
            blocks.append(np.broadcast_to(found, places.shape))
    return np.concatenate(blocks)


def _in_double_precision(solution):
    """The scene with NumPy arrays of doubles."""
    angle = solution.crank_angle
    if type(angle) is not np.ndarray or angle.dtype != float:
        scene = (solution.crank_speed, solution.crank_acceleration, solution.loads, solution.friction, solution.sense)
        mechanism, *others = map_numbers((solution.mechanism, *scene), lambda value: np.asarray(value, dtype=float)[()])
        try:
            solution = Dynamics(mechanism, np.asarray(angle, dtype=float), *others)
        except TypeError as error:
            raise _not_given(solution, error) from error
    if _holds_foreign_arrays(solution.apart[0]):
        raise _not_given(solution, "its numbers are arrays of another library than NumPy")
    return solution


def _holds_foreign_arrays(structure):
    if type(structure) is tuple:
        return any(map(_holds_foreign_arrays, structure))
    return isinstance(structure, Opaque) and is_foreign_array(structure.item)


def _not_given(solution, reason):
    return NotGivenError(f"{solution.mechanism.name}: no condition, its kernels cannot be differentiated ({reason})")


def _at(points, solution, value):
    """Values at some places of a solution, (M,); a plain number is unchanged."""
    value = np.asarray(value, dtype=float)
    return np.broadcast_to(value, solution.shape or (1,)).ravel()[points] if value.ndim else float(value)


# Quantities and their terms


class _Size:
    """Magnitude of a number or vector, sum of the magnitudes of its changes, and its certain part, (M,)."""

    def __init__(self, values, slopes):
        self.is_positive = np.asarray(values[0]) > 0.0
        self.size = reduce(np.hypot, map(np.abs, values))
        self.change = np.abs(reduce(np.hypot, map(np.atleast_2d, slopes))).sum(axis=0)
        self.certain = np.fmax(self.size - UNCERTAIN_ROUNDINGS * UNIT_ROUNDOFF * self.change, 0.0)


class _Terms(NamedTuple):
    """Sizes of a link's motion and loads if every direction is the worst."""

    speed: Any
    acceleration: Any
    rate: Any
    rate_change: Any
    force: Any
    moment: Any
    length: Any


def _parts(scene):
    """Terms of the magnification, each a tuple of components: numbers, arrays or nodes."""
    found: list[tuple] = []

    def listed(part, *arguments):
        part = part(*arguments) if callable(part) else part
        found.append(tuple(map(_component, part if isinstance(part, tuple) else (part,))))
        return _Size([1.0], [0.0])

    _magnification(scene, listed, dict.fromkeys(scene.pushes, 1.0), True)
    return found


def _component(part):
    """A number, array or node; 0 if absent."""
    return 0.0 if part is None else part[0] if getattr(part, "dtype", None) == np.dtype(object) else part


def _magnification(scene, size_of, largest_pushes, reactions):
    """Bound at some crank angles.

    ``size_of(part)`` or ``size_of(function, *arguments)`` gives the `_Size` of a part of the scene. It is called in the
    same order for all scenes of a structure, so that it may take the parts from a list.
    """
    placement, links = scene.placement, _terms(scene, size_of)
    speed = reduce(np.maximum, (link.speed for link in links.values()))
    acceleration = reduce(np.maximum, (link.acceleration for link in links.values()))
    shares, closed = [], True
    for group in scene.mechanism.groups:
        margin = size_of(group.closure, placement)
        shares.append(np.where((margin.certain > 0.0) & margin.is_positive, 0.0, np.inf))
    for joint in placement.joints.values():
        closed = closed & np.isfinite(size_of(joint.position).size)
        shares.append(_over(size_of(joint.first), ZERO_SHARE * speed))
        shares.append(_over(size_of(joint.second), ZERO_SHARE * acceleration))
    for name, link in links.items():
        motion = placement.links[name]
        shares.append(_over(size_of(motion.ratio), ZERO_SHARE * link.rate))
        shares.append(_over(size_of(motion.ratio_slope), ZERO_SHARE * link.rate_change))
    shares += _of_forces(scene, size_of, links, largest_pushes, reactions)
    found = np.maximum(SAFETY_FACTOR * reduce(np.maximum, shares), 1.0)
    return np.where(closed, np.where(np.isnan(found), np.inf, found), np.nan)


def _over(found, terms):
    """Change of a quantity over its value, or over its terms where these are larger; 0 without change."""
    return _quotient(found.change, np.maximum(found.certain, terms))


def _quotient(change, size):
    return np.where(change == 0.0, 0.0, np.divide(change, size))


def _terms(scene, size_of):
    """Terms of every link by name."""
    placement, bodies = scene.placement, {name: link.body for name, link in scene.mechanism.links.items()}
    square, alpha, gravity = (size_of(part).size for part in (*scene.accelerating, scene.gravity))
    found = {}
    for part in (scene.mechanism.crank, *scene.mechanism.groups):
        ends = [end for bar in part.bars for end in (bar.start, bar.end)] or (*part.hangs_on, *part.joints)
        joints = [placement.joints[name] for name in ends]
        lengths = {bar.link: size_of(bar.length).size for bar in part.bars}
        for name in part.links:
            link, body = placement.links[name], bodies[name]
            length = lengths.get(name, np.inf)  # a link that does not turn has no length
            if name not in lengths and link.ratio is not None:  # the length of a lever is the distance of its block
                gaps = [size_of(subtract_vectors, joint.position, link.joint.position).size for joint in joints]
                length = reduce(np.maximum, gaps, 0.0)
                length = np.where(length > 0.0, length, np.inf)
            firsts = [size_of(_of_centre, first_at, link, body), *(size_of(joint.first) for joint in joints)]
            seconds = [size_of(_of_centre, second_at, link, body), *(size_of(joint.second) for joint in joints)]
            speed, acceleration = (reduce(np.maximum, (one.certain for one in ones)) for ones in (firsts, seconds))
            rate = np.maximum(size_of(link.ratio).certain, speed / length)
            rate_change = np.maximum(rate * rate, acceleration / length)
            force = size_of(body.mass).size * (gravity + square * acceleration + alpha * speed)
            moment = size_of(body.inertia).size * (square * rate_change + alpha * rate)
            found[name] = _Terms(speed, acceleration, rate, rate_change, force, moment, length)
    return found


def _of_centre(derivative, link, body):
    """First or second derivative of a mass centre by the crank angle."""
    return derivative(link, arm(link.direction, body.along, body.across))


def _of_forces(scene, size_of, links, largest_pushes, reactions):
    """Magnification in torque and reactions; zero without loads."""
    forces, torques = [0.0], [0.0]
    for name, wrench in scene.link_loads.items():
        link = links[name]
        forces += [ZERO_SHARE * link.force, ZERO_SHARE**2 * link.moment / link.length, size_of(wrench.force).certain]
        torques.append(ZERO_SHARE * (link.force * link.speed + link.moment * link.rate))
        torques.append(size_of(virtual_work, scene.placement.links[name], wrench).certain)
    for name, push in scene.pushes.items():
        size = np.maximum(size_of(push).certain, ZERO_SHARE * largest_pushes[name])
        forces.append(size)
        torques.append(size_of(product, push, scene.placement.travels[name].first).certain)
        torques.append(ZERO_SHARE * size * links[name].speed)
    force, torque = reduce(np.maximum, forces), reduce(np.maximum, torques)
    found, outputs, grow = scene.resolved, scene.mechanism.outputs, scene.mechanism.passes
    shares = [_quotient(size_of(found.scalars["balancing_torque"]).change, torque)]
    if not reactions:
        return shares
    scalars = (found.scalars[name] for name, output in outputs.items() if output.unit == "N" and not output.vector)
    sizes = [size_of(part) for part in (*found.reactions.values(), *scalars)]
    return [*shares, *(_quotient(one.change, np.fmax(force, one.size) if grow else force) for one in sizes)]


# Derivatives by the logarithm of each length and of the crank angle


def _lengths(structure):
    """Places of the lengths among the leaves of a structure, and its loads with a number for each leaf."""
    places = itertools.count(1.0)  # from 1 on, for a zero is absent
    scene = unflatten(structure, places.__next__, lambda: None, lambda: None)
    found: list[float] = []
    special = {
        Link: lambda link: map_numbers(link.centre, found.append),
        Guide: lambda guide: map_numbers(guide.guide_offset, found.append),
    }
    map_numbers(scene.mechanism, found.append, special)
    for item in scene.loads:
        for name in item.LENGTHS if isinstance(item, Load) else ():
            map_numbers(getattr(item, name), found.append)
    return [int(place) - 1 for place in found], scene.loads


def _recorded(kind):
    """Parts of all scenes of a structure; None where a group of the user's own cannot be recorded."""
    try:
        return _Recorded(kind.structure)
    except (TypeError, ValueError, AttributeError):
        return None


class _Recorded:
    """Parts of the magnification of all scenes of a structure, and their derivatives along several directions.

    The directions are an axis of arrays: one for each length, for the crank angle, and for the size of each cam that
    takes plain numbers only.
    """

    def __init__(self, structure):
        recorder = Recorder(structure)
        self._scene, self._tables = recorder.recorded, recorder.tables
        self._parts = _parts(self._scene)
        lengths, loads = _lengths(structure)
        self._parameters, self._angle = recorder.parameters, recorder.angle[0]
        self._rows = {node.arguments[0]: node for node in recorder.graph if node.operation == "table"}
        new = partial(recorder.graph.parameter, len(recorder.parameters))
        slopes = {node: new() for node in (*(self._parameters[place] for place in lengths), self._angle)}
        turn = slopes[self._angle]
        self._directions: dict[Node, Node | None] = {slope: node for node, slope in slopes.items()}
        self._more: dict[Node, Any] = {}
        for table in self._tables:
            nodes = [self._rows[row] for row in table.rows]
            if isinstance(table.of, str) and table.of:  # a cam
                size, third = new(), new()
                self._directions[size] = None
                self._more[third] = partial(_third_derivative, table.of)
                slopes |= {node: size * node + turn * after for node, after in itertools.pairwise([*nodes, third])}
            elif isinstance(table.of, int) and getattr(value_of(loads[table.of]), "over", "") == "angle":
                slope = new()
                self._more[slope] = lambda motion, place=table.of: motion.loads[place].value_now.pieces(motion)[2]
                slopes[nodes[0]] = turn * slope
        self._single = dict.fromkeys(self._parts)
        outputs = [one for part in self._single for one in part]
        outputs += tangents(recorder.graph, outputs, slopes)
        self._evaluation = Evaluation(outputs)
        self._needed = {node.arguments[0] for node in needed(outputs) if node.operation == "table"}

    def of(self, solution):
        """Recorded scene, and the function that gives the sizes of the parts at some places of a solution."""
        leaves = solution.apart[1]
        rows = [row for table in self._tables for row in table.filled(solution, leaves, self._needed)]
        known = dict(zip(self._parameters, leaves.numbers, strict=True))
        known |= {self._rows[place]: row for place, row in enumerate(rows)}
        known |= {node: compute(solution) for node, compute in self._more.items()}
        known[self._angle] = np.atleast_1d(solution.crank_angle)

        def sizes_at(points):
            inputs = {node: _at(points, solution, value) for node, value in known.items()}
            for place, (node, changed) in enumerate(self._directions.items()):
                step = 1.0 if changed is None else inputs[changed]
                inputs[node] = np.zeros((len(self._directions), np.size(step)))
                inputs[node][place] = step
            found = self._evaluation(inputs)
            values, slopes = iter(found[: len(found) // 2]), iter(found[len(found) // 2 :])
            sizes = {part: _Size(*([next(each) for _ in part] for each in (values, slopes))) for part in self._single}
            return map(sizes.__getitem__, self._parts)

        return self._scene, sizes_at


def _third_derivative(name, solution):
    """Third derivative of a cam that takes plain numbers only, (..., N), m, by central differences."""
    groups = solution.mechanism.groups
    cam = next(group.cam for group in groups if f"cam{group.label}" == name and getattr(group, "cam", None) is not None)
    sides = solution.crank_angle + THIRD_STEP, solution.crank_angle - THIRD_STEP
    after, before = (cam.polar(angle, ray(angle))[2] for angle in sides)
    return (after - before) / (2.0 * THIRD_STEP)


def _by_differences(solution):
    """Scene, and function of sizes, as `_Recorded.of`, by central differences of the kernels on plain numbers."""
    warnings.warn(
        f"{solution.mechanism.name}: a group of it does more than arithmetic with sin, cos and sqrt of `arithmetic`, "
        "so its condition follows from differences instead of exact derivatives. It is rough near limit positions",
        ConditionWarning,
        stacklevel=4,
    )
    structure, leaves = solution.apart
    numbers, angle = leaves.numbers, solution.crank_angle

    def scene(place=None, step=0.0, turn=0.0):
        changed = [value * (1.0 + step) if own == place else value for own, value in enumerate(numbers)]
        return state_of(structure, leaves.with_numbers(changed), angle + turn)

    def slopes(step, **change):
        after, before = (_parts(scene(**{step: side}, **change)) for side in (DIFFERENCE_STEP, -DIFFERENCE_STEP))
        pairs = (zip(*pair, strict=True) for pair in zip(after, before, strict=True))
        return [[(one - other) / (2.0 * DIFFERENCE_STEP) for one, other in pair] for pair in pairs]

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        plain = scene()
        values = _parts(plain)
        by = [slopes("step", place=place) for place in _lengths(structure)[0]]
        by.append([[angle * one for one in part] for part in slopes("turn")])

    def sizes_at(points):
        def everywhere(value):
            return np.broadcast_to(_at(points, solution, value), points.shape)

        for part, *changes in zip(values, *by, strict=True):
            yield _Size(
                [everywhere(one) for one in part],
                [np.stack([everywhere(one) for one in ones]) for ones in zip(*changes, strict=True)],
            )

    return plain, sizes_at


def state_of(structure, leaves, angle):
    """`Dynamics` of a structure with other leaves at crank angles."""
    parts = (iter(part) for part in (leaves.numbers, leaves.tables, leaves.parts))
    mechanism, *others = unflatten(structure, *(part.__next__ for part in parts))
    return Dynamics(mechanism, angle, *others)


# Warnings


def is_surely_well_conditioned(solution, margins):
    """Whether the margins of closure suffice to show that no crank angle loses half of its digits.

    The margins of a user's group may be wrong, so they do not count.
    """
    least = 1.0 if solution.mechanism.trusted else 0.0
    for margin in margins:
        smallest = margin.min()
        if not smallest > 0.0:  # of each group: two negative ones have a positive product
            return False
        least *= min(smallest, 1.0)
    return least >= _sufficient_margin(solution, solution.farthest) or least >= _sufficient_margin(solution)


def _sufficient_margin(solution, farthest=None):
    """Product of all groups' margins above which the condition is below `HALF_DIGITS_CONDITION`.

    `farthest` may be a bound of the crank angles.
    """
    farthest = float(np.abs(np.asarray(solution.crank_angle)).max()) if farthest is None else farthest
    return solution.proportion * math.sqrt(MARGIN_FACTOR * max(1.0, farthest) / HALF_DIGITS_CONDITION)


def warn_of_lost_digits(solution, margins):
    """Warn of crank angles that lose half of their digits or more; `margins` are the closure of the groups.

    The condition is computed only where the margins are small. Numbers in other precision than double lose different
    digits and get no warning.
    """
    if not margins or any(not isinstance(margin, np.ndarray) or margin.dtype != float for margin in margins):
        return
    if is_surely_well_conditioned(solution, margins):
        return
    least = reduce(np.multiply, (np.minimum(margin, 1.0) for margin in margins))
    closed = reduce(np.minimum, margins) >= -SQUARE_TOLERANCE
    points = np.flatnonzero(np.broadcast_to(closed & (least < _sufficient_margin(solution)), solution.shape))
    found = condition(solution, points) if points.size else np.zeros(0)
    count = np.count_nonzero(found > HALF_DIGITS_CONDITION)
    if not count:
        return
    worst = int(np.argmax(found))
    angle = np.broadcast_to(solution.crank_angle, solution.shape).flat[points[worst]]
    cause = "it is near a limit position or change point: errors of its lengths, rounding among them, are"
    if found[worst] * TURN < HALF_DIGITS_CONDITION * abs(angle):
        cause = "it is many turns from 0 (angles within one turn would do): rounding of the crank angle is"
    kinks = (text for group in solution.mechanism.groups if (text := group.kink(solution.mechanism.throws)))
    warnings.warn(
        f"{solution.mechanism.name}: at crank angle {np.degrees(angle):.9g} deg {cause} "
        f"magnified {found[worst]:.3g} times, so rates and "
        f"forces have about {max(0.0, 16.0 - np.log10(found[worst])):.0f} correct digits there. {count} of "
        f"{math.prod(solution.shape)} crank angles lose half of their digits or more (solution.condition). For the "
        "given numbers often far more digits are correct, as solution.error_bound(quantity) proves"
        f"{''.join(f'; {text}' for text in kinks)}",
        ConditionWarning,
        stacklevel=4,
    )

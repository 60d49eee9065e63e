"""Test of a user's group, independent of its formulas: difference quotients, rigid links, and virtual work.

The test moves the joints to which the group is attached, from up to 24 positions at which the group can be assembled.
Both derivatives of its motion must agree with difference quotients. The motion of each link must agree with that of its
joints, guides and slots. The virtual work of all forces must be zero for any motion of a joint, as for every ideal
constraint. Errors are relative to the largest value, or to the size of the group if that is larger.
"""

from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from ..errors import ParameterError
from ..machine.crank import ORIGIN, ray
from ..machine.group import FRAME, MEMBERS
from ..machine.kinematic_state import Course, Placement, margin, place, require_positions
from ..machine.links import Joint, LinkMotion, PointMotion, Sliding, Turning, Wrench, arm, load, virtual_work
from ..machine.mechanism import output_problems
from ..numbers import checks
from ..numbers.planar import (
    add_vectors,
    cross,
    dot,
    length,
    number_or_zero,
    product,
    rotate,
    rotate_back,
    scale_vector,
    subtract_vectors,
    vector_or_zero,
    work,
)

STATE_NAMES = ("position", "velocity", "acceleration")
MAX_RELATIVE_ERROR = 1e-6
"""Largest relative error that passes; correct groups have about 1e-10, a wrong term gives about 1."""
ANGLE_STEP = 2.0**-8
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)
"""Weights of a central difference of the eighth order, with steps of `ANGLE_STEP` rad."""
MAX_PLACES = 24
_states = attrgetter("position", "first", "second")


@dataclass(frozen=True, repr=False)
class GroupReport:
    """Errors found by a check of a group.

    Attributes
    ----------
    group : str
    errors : dict of str to float
        Largest error by check, relative to the largest value.
    """

    group: str
    errors: dict[str, float]

    @property
    def problems(self):
        """Texts, one for each check that fails, with its error."""
        return tuple(f"{what}: off by {error:.2g} of its size" for what, error in self.errors.items() if _fails(error))

    @property
    def ok(self):
        """Whether all checks pass."""
        return not self.problems

    def __bool__(self):
        return self.ok

    def __repr__(self):
        count, wrong = len(self.errors), len(self.problems)
        verdict = f"{wrong} of {count} checks fail" if wrong else f"all {count} checks pass"
        rows = [
            f"  {'WRONG' if _fails(error) else 'right'}  {error:7.1e}  {what}" for what, error in self.errors.items()
        ]
        return "\n".join([f"<GroupReport: {self.group}, {verdict}>", *rows])


def _fails(error):
    return not error <= MAX_RELATIVE_ERROR


def check(group):
    """Test a group, especially your own: derivatives of its motion, forces and power.

    Parameters
    ----------
    group : SliderGroup, RockerGroup, CamRoller or similar
        A single design; `kinetostatics.machine.group` lists the members that a group of your own needs.

    Returns
    -------
    GroupReport
        True if all checks pass. Its text has a line for each check, `problems` a text for each one that fails.
        Reactions inside the group are not tested one by one, only the demands that result from them.

    Raises
    ------
    ParameterError
        A member is missing, `place` adds less than the group declares, or the group cannot be assembled near O. Or
        `closure` is not a number at each crank angle, or is not negative where `place` finds no position.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> report = ks.check(ks.RockerGroup(0.4, 0.3, (0.35, 0.1)))
    >>> report.ok
    True
    """
    _, problem = checks.HasMembers(MEMBERS, "a group").check(group, "group")
    checks.require("check", problem)
    if getattr(group, "passes", False):
        group = replace(group)  # as before `on_crank`: the test moves its joint freely, so there are no change points
    stage = _stage(group)
    errors: dict[str, float] = {}
    for compare in (_links_and_courses, _points, _fixed_joints, _guides, _slots, _slidings, _derivatives, _forces):
        for what, found, expected, unit in compare(stage, stage.place_joints()):
            errors[what] = max(errors.get(what, 0.0), _error(found, expected, unit))
    return GroupReport(type(group).__name__, errors)


def _error(found, expected, unit):
    """Relative error of the worst component: largest difference over the largest value, or over `unit` if larger.

    It is infinite if a value is not finite; None counts as zero.
    """
    errors = []
    for pair in zip(_components(found), _components(expected), strict=False):
        one, other = (np.asarray(number_or_zero(part), dtype=float) for part in pair)
        error = np.max(np.abs(one - other)) / max(np.max(np.abs(one)), np.max(np.abs(other)), unit)
        errors.append(float(error) if np.isfinite(error) else np.inf)
    return max(errors)


def _components(value):
    return value if isinstance(value, tuple) else (value, value)


class _Stage(NamedTuple):
    """A group, its shortest bar, m, and crank angles with positions (x, y) of the first joint that carries it."""

    group: Any
    size: float
    position: Any
    angle: Any

    @property
    def carrying_joints(self):
        """Joints to which the group is attached, except O."""
        return [name for name in getattr(self.group, "hangs_on", ("O",)) if name != "O"]

    @property
    def carriers(self):
        """Links of other groups to which the group fixes a joint."""
        return {point.link for point in self.group.joints.values()} - {FRAME, *self.group.links}

    def place_joints(self, turn=0.0, tangent=(0.5, 0.3), alone=""):
        """Placement with the crank turned by `turn`, rad; carrying joints, or only `alone`, leave along `tangent`."""
        angle = self.angle + turn
        direction = ray(angle)
        joints = {"O": ORIGIN}
        for order, name in enumerate(self.carrying_joints):
            joints[name] = self._joint(order, turn, tangent if alone in ("", name) else (0.0, 0.0))
        links = {"crank": LinkMotion(ORIGIN, direction, 1.0, None)}
        for name in self.carriers:
            turned_by = angle + 0.3 * turn + 0.4 * turn * turn
            links[name] = LinkMotion(self._joint(1, turn, tangent), ray(turned_by), 1.3 + 0.8 * turn, 0.8)
        placement = Placement(angle, direction, joints, links)
        for name in self.carrying_joints:
            departure = add_vectors(joints[name].second, joints[name].position)
            placement.courses[name] = Course(departure=departure)
        with np.errstate(all="ignore"):
            place(self.group, placement)
        return placement

    def _joint(self, order, turn, tangent):
        """Motion of a carrying joint on an ellipse: from `position` for the first one, from near O for others."""
        sine, cosine = np.sin(turn), np.cos(turn)
        tangent, bend = (rotate(part, ray(float(order))) for part in (tangent, (0.2, -0.4)))
        along, across = (self.size * np.array(part)[:, None] for part in (tangent, bend))
        still = 0.0 * self.angle
        place = self.position if order == 0 else (0.4 * order * self.size + still, -0.25 * order * self.size + still)
        position = np.array(place) + along * sine + across * (cosine - 1.0)
        first = along * cosine - across * sine + still
        return Joint(tuple(position), tuple(first), tuple(-along * sine - across * cosine + still))


def _stage(group):
    """The group at positions away from its limit positions, chosen evenly from a grid of 1200."""
    lengths = [float(np.max(bar.length)) for bar in group.bars] or [1.0]
    size, farthest = min(lengths), 30.0 * max(lengths)
    reach, direction = np.meshgrid(np.geomspace(0.02 * size, farthest, 40), 2 * np.pi * (np.arange(30) + 0.3) / 30)
    x, y = (reach * np.cos(direction)).ravel(), (reach * np.sin(direction)).ravel()
    whole = _Stage(group, size, (x, y), 2.4 * np.arange(x.size) % (2 * np.pi))
    if any(np.ndim(length) > 1 for length in group.lengths):
        raise ParameterError("check: give a group of one design, not a batch")
    with np.errstate(all="ignore"):
        placement = whole.place_joints()
        margins = margin(group, placement, whole.angle.shape)
    margins = np.broadcast_to(np.asarray(margins, dtype=float), x.shape)
    if not group.trusted:
        require_positions(group, placement, margins)
    closing = np.flatnonzero(margins > 0.1) if np.any(margins > 0.1) else np.flatnonzero(margins > 1e-3)
    if not closing.size:
        name = type(group).__name__
        raise ParameterError(
            f"check: {name} closes nowhere within {farthest:g} m of O, closure is at most {margins.max()}"
        )
    chosen = closing[np.linspace(0, closing.size - 1, min(MAX_PLACES, closing.size)).astype(int)]
    return whole._replace(position=(x[chosen], y[chosen]), angle=whole.angle[chosen])


# Comparisons: name of the check, two values that must agree, and a size below which differences do not count


def _links_and_courses(stage, placement):
    """Lengths of bars, unit vectors and reference joints of links, elongations of sliders, and courses of joints."""
    group, size = stage.group, stage.size
    for bar in group.bars:
        ends = (vector_or_zero(placement.joints[name].position) for name in (bar.end, bar.start))
        yield f"length of {bar.link}", length(subtract_vectors(*ends)), bar.length, size
    for name, joint in group.references.items():
        motion = placement.links[name]
        yield f"direction of {name}", length(motion.direction), 1.0, 1.0
        yield f"reference joint of {name}", motion.joint.position, placement.joints[joint].position, size
    for name, travel in placement.travels.items() if hasattr(group, "elongation") else ():
        free = 0.7 * size
        elongation = group.elongation(placement, free)
        yield f"elongation of {name}", elongation, travel.position - free, size
        departure = group.departure(placement, free) if hasattr(group, "departure") else None
        if departure is not None:
            yield f"departure of {name}", departure, travel.second + travel.position - free, size
        outward = group.outward(placement, free) if hasattr(group, "outward") else None
        if outward is not None:
            yield f"outward part of {name}", abs(sum(outward)), abs(elongation), size
    for name in group.joints:
        joint, course = placement.joints[name], placement.course(name)
        if course.orbit is not None:
            yield f"orbit of {name}", scale_vector(sum(course.orbit), placement.ray), joint.position, size
        if course.departure is not None:
            departure = add_vectors(vector_or_zero(joint.second), joint.position)
            yield f"departure of {name}", course.departure, departure, size
        if course.swing is not None:
            centre, radius, direction = course.swing.centre, course.swing.radius, course.swing.direction
            yield f"swing of {name}", add_vectors(centre, scale_vector(radius, direction)), joint.position, size
            parts = (*centre, radius)
            yield f"centre and radius of the swing of {name}", parts, tuple(map(np.mean, parts)), size


def _points(stage, placement):
    """Position and both derivatives of joints that are declared as points of links."""
    for name, (link, along, across) in stage.group.joints.items():
        owner, states = link, ((along, across), None, None)
        if link == FRAME:
            owner = "the frame"
        else:
            motion = placement.links[link]
            states = _states(PointMotion(motion.joint, arm(motion.direction, along, across), motion))
        for what, by_link, part in zip(STATE_NAMES, states, placement.joints[name], strict=True):
            yield f"{what} of {name} as a point of {owner}", by_link, part, stage.size


def _fixed_joints(stage, placement):
    """Joints at a fixed place in the axes of a link: the end of a bar at its length, other pins at any place."""
    group = stage.group
    fixed = {(pair.link, pair.joint): None for pair in _declared(group, "pairs").values() if type(pair) is Turning}
    for bar in group.bars:
        fixed |= {(bar.link, bar.start): (0.0, 0.0), (bar.link, bar.end): (bar.length, 0.0)}
    for (link, name), at in fixed.items():
        if link not in group.links:
            continue
        motion, joint = placement.links[link], placement.joints[name]
        to_joint = subtract_vectors(joint.position, motion.joint.position)
        seen = rotate_back(to_joint, motion.direction)
        expected = tuple(np.mean(part) for part in seen) if at is None else at
        yield f"place of {name} in the axes of {link}", seen, expected, stage.size
        _, first, second = _states(PointMotion(motion.joint, to_joint, motion))
        yield f"velocity of {name} by {link}", first, joint.first, stage.size
        yield f"acceleration of {name} by {link}", second, joint.second, stage.size


def _guides(stage, placement):
    """Sliders: distance of the pin from the guide, direction along the guide, and travel with both derivatives."""
    for link, guide in _declared(stage.group, "guides").items():
        motion, direction = placement.links[link], guide.direction
        yield (
            f"distance of {link} from its guide",
            cross(direction, motion.joint.position),
            guide.guide_offset,
            stage.size,
        )
        yield f"direction of {link} along its guide", motion.direction, direction, 1.0
        travel = placement.travels.get(link)
        for what, claimed, part in zip(STATE_NAMES, travel, motion.joint, strict=True) if travel else ():
            yield f"{what} of the travel of {link}", claimed, dot(direction, vector_or_zero(part)), stage.size


def _slots(stage, placement):
    """Joints that slide in the slot of a link: distance from its line, and direction of the rod."""
    for slot in _declared(stage.group, "slots"):
        motion = placement.links[slot.link]
        axis = rotate((np.cos(slot.angle), np.sin(slot.angle)), motion.direction)
        away = subtract_vectors(placement.joints[slot.joint].position, motion.joint.position)
        yield f"distance of {slot.joint} from the slot of {slot.link}", cross(axis, away), slot.offset, stage.size
        if slot.rod:
            aside = cross(axis, placement.links[slot.rod].direction)
            yield f"direction of {slot.rod} along {slot.link}", aside, 0.0, 1.0


def _slidings(stage, placement):
    """Sliding pairs: rate, which gives friction its direction, by the links' relative motion; moment of the force."""
    for name, pair in _declared(stage.group, "pairs").items():
        if type(pair) is not Sliding:
            continue
        slide, joint = stage.group.sliding(name, placement), placement.joints[pair.joint]
        direction = (1.0, 0.0) if slide.direction is None else slide.direction
        first = subtract_vectors(
            _first_derivative_at(placement, pair.link, joint), _first_derivative_at(placement, pair.against, joint)
        )
        yield f"rate of sliding of {name}", slide.rate, dot(direction, vector_or_zero(first)), stage.size
        if pair.against != FRAME:
            away = subtract_vectors(joint.position, placement.links[pair.against].joint.position)
            yield f"moment of sliding of {name}", slide.moment, cross(away, direction), stage.size


def _declared(group, name):
    """A table of a group; empty if a group that is not derived from `Group` lacks it."""
    return getattr(group, name, {})


def _first_derivative_at(placement, link, joint):
    """First derivative by the crank angle of the point of a link at a joint."""
    if link == FRAME:
        return None
    motion = placement.links[link]
    return PointMotion(motion.joint, subtract_vectors(joint.position, motion.joint.position), motion).first


def _derivatives(stage, placement):
    """Derivatives by the crank angle against difference quotients; and placing twice gives the same motion."""
    here, again = (_rates(stage, each) for each in (placement, stage.place_joints()))
    beside = {
        step: [_rates(stage, stage.place_joints(side * step * ANGLE_STEP)) for side in (1, -1)]
        for step in range(1, len(WEIGHTS) + 1)
    }
    for what, (value, claimed, unit) in here.items():
        yield "place called twice", again[what][0], value, unit
        slopes = ((ahead[what][0] - behind[what][0]) / ANGLE_STEP for ahead, behind in beside.values())
        yield what, claimed, sum(weight * slope for weight, slope in zip(WEIGHTS, slopes, strict=True)), unit


def _rates(stage, placement):
    """By name of a derivative: value, its derivative by the kernel, and a size below which errors do not count."""
    moving = placement.joints.keys() - {"O", *stage.carrying_joints}
    joints = {f"joint {name}": placement.joints[name] for name in moving}
    joints |= {f"travel of {name}": travel for name, travel in placement.travels.items()}
    joints |= {f"reference joint of {name}": placement.links[name].joint for name in stage.group.links}
    found = {}
    for name, joint in joints.items():
        found[f"first derivative of {name}"] = joint.position, joint.first, stage.size
        found[f"second derivative of {name}"] = joint.first, joint.second, stage.size
    for name in stage.group.links:
        motion = placement.links[name]
        (x, y), ratio = motion.direction, number_or_zero(motion.ratio)
        found[f"ratio of {name}"] = (x, y), (-ratio * y, ratio * x), 1.0
        found[f"ratio_slope of {name}"] = ratio, motion.ratio_slope, 1.0
    shape = np.shape(placement.angle)

    def array(value):
        return np.array([np.broadcast_to(number_or_zero(part), shape) for part in _components(value)])

    return {name: (array(value), array(claimed), unit) for name, (value, claimed, unit) in sorted(found.items())}


def _forces(stage, still):
    """Virtual work of any loads for motions of each joint, and of weight and inertia; the demands make it 0."""
    if not stage.group.links:
        return
    random = np.random.default_rng(0)

    def any_vector():
        return tuple(random.uniform(-1.0, 1.0, (2, stage.angle.size)))

    wrenches = {name: Wrench(any_vector(), stage.size * any_vector()[0]) for name in stage.group.links}
    pushes = {name: any_vector()[0] for name in still.travels}
    motions: dict[str, Any] = {
        f"{axis} of {name}" if len(stage.carrying_joints) > 1 else axis: {"tangent": tangent, "alone": name}
        for name in stage.carrying_joints
        for axis, tangent in (("x", (1.0, 0.0)), ("y", (0.0, 1.0)))
    }
    for name, tangent in (motions or {"the turn": {}}).items():
        yield f"work of the forces along {name}", *_work(stage, stage.place_joints(**tangent), wrenches, pushes)
    inertia = {
        name: load(still.links[name], link.body, 9.81 / stage.size, 2.0 / stage.size, (3.0, -9.3))
        for name, link in stage.group.links.items()
    }
    if any(wrench.force is not None or wrench.moment is not None for wrench in inertia.values()):
        yield "power of weight and inertia", *_work(stage, still, inertia, {})


def _work(stage, placement, wrenches, pushes):
    """Sum of all virtual work, the expected 0.0, and the size of its largest term."""
    resolved = stage.group.resolve(placement, wrenches, pushes)
    if not stage.group.trusted:
        checks.require("check", *output_problems(stage.group, resolved))
    parts = [virtual_work(placement.links[name], wrench) for name, wrench in wrenches.items()]
    parts += [product(push, placement.travels[name].first) for name, push in pushes.items()]
    for name, demand in resolved.demands.items():
        of_link = name in placement.links
        parts.append(
            virtual_work(placement.links[name], demand) if of_link else work(demand.force, placement.joints[name].first)
        )
    parts = [number_or_zero(part) for part in parts]
    return sum(parts), 0.0, max(np.max(np.abs(part)) for part in parts) or 1.0

"""Test of a user's group without its own formulas: differences of positions, rigid links, and virtual work.

The test moves the joints that the group is attached to, from many places in which the group closes. Velocities and
accelerations must agree with differences of positions. Each link's state must agree with those of its joints, guides
and slots. The forces on the joints must do the work of the loads for any motion of a joint (d'Alembert and Lagrange;
true for any ideal constraint). All errors are relative to the largest value.
"""

from dataclasses import dataclass, replace
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
"""Largest error that passes; right groups reach 1e-10, a wrong term gives about 1."""
ANGLE_STEP = 2.0**-8
WEIGHTS = (4 / 5, -1 / 5, 4 / 105, -1 / 280)
"""Of a central difference of the eighth order, with steps of `ANGLE_STEP` rad."""
MAX_PLACES = 24


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
        """A sentence for each check that fails."""
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
    """Test a group, above all a user's own: its derivatives, forces and power.

    Parameters
    ----------
    group : SliderGroup, RockerGroup, CamRoller or alike
        With the members that `kinetostatics.machine.group` lists; a single design.

    Returns
    -------
    GroupReport
        True if all is right; its text has a line for each check, `problems` a sentence for each that fails. Reactions
        inside the group are tested only as far as they add to the force on the joints it is attached to.

    Raises
    ------
    ParameterError
        A member is missing, `place` adds less than the group declares, `closure` is no number for each crank angle or
        not negative where `place` finds no position, or the group closes nowhere near its own size.

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
        group = replace(group)  # its joint is moved by hand, and on no crank it has no change points
    stage = _stage(group)
    errors = _of_shape(stage) | _of_links(stage) | _of_derivatives(stage) | _of_forces(stage)
    return GroupReport(type(group).__name__, errors)


class _Stage(NamedTuple):
    """A group, its shortest length, and crank angles and places (x, y) of its first carrying joint where it closes."""

    group: Any
    size: float
    position: Any
    angle: Any

    @property
    def carrying_joints(self):
        """Joints that it is attached to, but for O."""
        return [name for name in getattr(self.group, "hangs_on", ("O",)) if name != "O"]

    @property
    def carriers(self):
        """Links of other groups that it fixes a joint to."""
        return {point.link for point in self.group.joints.values()} - {FRAME, *self.group.links}

    def place_joints(self, turn=0.0, way=(0.5, 0.3), alone=""):
        """Placement with the crank turned further; each carrying joint, or one alone, moves on a curve along `way`."""
        angle = self.angle + turn
        direction = ray(angle)
        joints = {"O": ORIGIN}
        for order, name in enumerate(self.carrying_joints):
            joints[name] = self._joint(order, turn, way if alone in ("", name) else (0.0, 0.0))
        links = {"crank": LinkMotion(ORIGIN, direction, 1.0, None)}
        for name in self.carriers:
            turned_by = angle + 0.3 * turn + 0.4 * turn * turn
            links[name] = LinkMotion(self._joint(1, turn, way), ray(turned_by), 1.3 + 0.8 * turn, 0.8)
        placement = Placement(angle, direction, joints, links)
        for name in self.carrying_joints:
            departure = add_vectors(joints[name].second, joints[name].position)
            placement.courses[name] = Course(departure=departure)
        with np.errstate(all="ignore"):
            place(self.group, placement)
        return placement

    def _joint(self, order, turn, way):
        """One of the carrying joints: the first at the places, others near O."""
        sine, cosine = np.sin(turn), np.cos(turn)
        way, bend = (rotate(part, ray(float(order))) for part in (way, (0.2, -0.4)))
        along, across = (self.size * np.array(part)[:, None] for part in (way, bend))
        still = 0.0 * self.angle
        place = self.position if order == 0 else (0.4 * order * self.size + still, -0.25 * order * self.size + still)
        position = np.array(place) + along * sine + across * (cosine - 1.0)
        first = along * cosine - across * sine + still
        return Joint(tuple(position), tuple(first), tuple(-along * sine - across * cosine + still))


def _stage(group):
    """The group at places where it closes well, chosen evenly from many."""
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


def _of_shape(stage):
    """Errors of lengths of bars, unit vectors, reference joints, and what groups declare of travels and courses."""
    group, placement = stage.group, stage.place_joints()
    errors = {}
    for bar in group.bars:
        ends = (vector_or_zero(placement.joints[name].position) for name in (bar.end, bar.start))
        errors[f"length of {bar.link}"] = _error(length(subtract_vectors(*ends)), bar.length, stage.size)
    for name, joint in group.references.items():
        motion = placement.links[name]
        errors[f"direction of {name}"] = _error(length(motion.direction), 1.0, 1.0)
        pairs = zip(motion.joint.position, placement.joints[joint].position, strict=True)
        errors[f"reference joint of {name}"] = max(_error(*pair, stage.size) for pair in pairs)
    for name, travel in placement.travels.items() if hasattr(group, "elongation") else ():
        free = 0.7 * stage.size
        elongation = group.elongation(placement, free)
        errors[f"elongation of {name}"] = _error(elongation, travel.position - free, stage.size)
        departure = group.departure(placement, free) if hasattr(group, "departure") else None
        if departure is not None:
            errors[f"departure of {name}"] = _error(departure, travel.second + travel.position - free, stage.size)
        outward = group.outward(placement, free) if hasattr(group, "outward") else None
        if outward is not None:
            errors[f"outward part of {name}"] = _error(abs(sum(outward)), abs(elongation), stage.size)
    for name in group.joints:
        joint, course = placement.joints[name], placement.course(name)
        if course.orbit is not None:
            reached = scale_vector(sum(course.orbit), placement.ray)
            errors[f"orbit of {name}"] = _error(reached, joint.position, stage.size)
        if course.departure is not None:
            departure = add_vectors(vector_or_zero(joint.second), joint.position)
            errors[f"departure of {name}"] = _error(course.departure, departure, stage.size)
        if course.swing is not None:
            reached = add_vectors(course.swing.centre, scale_vector(course.swing.radius, course.swing.direction))
            errors[f"swing of {name}"] = _error(reached, joint.position, stage.size)
    return errors


def _of_derivatives(stage):
    """Errors of derivatives by crank angle against differences."""
    steps = range(1, len(WEIGHTS) + 1)
    beside = {k: _rates(stage.place_joints(k * ANGLE_STEP), stage) for step in steps for k in (step, -step)}
    here, again = (_rates(stage.place_joints(), stage) for _ in range(2))
    errors = {"place called twice": max(_error(again[what][0], values[0], values[2]) for what, values in here.items())}
    for what, (_, claimed, unit) in here.items():
        slope = sum(
            weight * (beside[step][what][0] - beside[-step][what][0]) / ANGLE_STEP
            for step, weight in zip(steps, WEIGHTS, strict=True)
        )
        errors[what] = _error(claimed, slope, unit)
    return errors


def _rates(placement, stage):
    """Value, claimed derivative, and a size below which neither counts, by name."""
    found = {}

    def add(name, joint):
        first, second = (0.0 if part is None else part for part in (joint.first, joint.second))
        found[f"first derivative of {name}"] = joint.position, first, stage.size
        found[f"second derivative of {name}"] = first, second, stage.size

    for name in placement.joints.keys() - {"O", *stage.carrying_joints}:
        add(f"joint {name}", placement.joints[name])
    for name, travel in placement.travels.items():
        add(f"travel of {name}", travel)
    for name in stage.group.links:
        motion = placement.links[name]
        add(f"reference joint of {name}", motion.joint)
        x, y = motion.direction
        ratio, slope = number_or_zero(motion.ratio), number_or_zero(motion.ratio_slope)
        found[f"ratio of {name}"] = (x, y), (-ratio * y, ratio * x), 1.0
        found[f"ratio_slope of {name}"] = ratio, slope, 1.0
    shape = np.shape(placement.angle)
    return {
        name: (*(np.array([np.broadcast_to(part, shape) for part in _parts(value)]) for value in values), unit)
        for name, (*values, unit) in sorted(found.items())
    }


def _parts(value):
    return value if isinstance(value, tuple) else (value, value)


def _of_forces(stage):
    """Errors of the forces, from their work and that of the loads on small motions of each joint."""
    if not stage.group.links:
        return {}
    random = np.random.default_rng(0)

    def any_vector():
        return tuple(random.uniform(-1.0, 1.0, (2, stage.angle.size)))

    still = stage.place_joints()
    wrenches = {name: Wrench(any_vector(), stage.size * any_vector()[0]) for name in stage.group.links}
    pushes = {name: any_vector()[0] for name in still.travels}
    ways: dict[str, Any] = {
        f"{axis} of {name}" if len(stage.carrying_joints) > 1 else axis: {"way": way, "alone": name}
        for name in stage.carrying_joints
        for axis, way in (("x", (1.0, 0.0)), ("y", (0.0, 1.0)))
    }
    errors = {
        f"work of the forces along {name}": _work_error(stage, stage.place_joints(**way), wrenches, pushes)
        for name, way in (ways or {"the turn": {}}).items()
    }
    inertia = {
        name: load(still.links[name], link.body, 9.81 / stage.size, 2.0 / stage.size, (3.0, -9.3))
        for name, link in stage.group.links.items()
    }
    if any(wrench.force is not None or wrench.moment is not None for wrench in inertia.values()):
        errors["power of weight and inertia"] = _work_error(stage, still, inertia, {})
    return errors


def _work_error(stage, placement, wrenches, pushes):
    """Sum of all work, relative to its largest part."""
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
    sizes = [np.max(np.abs(number_or_zero(part))) for part in parts]
    return _error(sum(number_or_zero(part) for part in parts), 0.0, max(sizes) or 1.0)


def _error(found, expected, unit):
    """Largest difference over the largest value, or over `unit` if larger; infinite if not finite."""
    found, expected = (np.asarray(values, dtype=float) for values in (found, expected))
    error = np.max(np.abs(found - expected)) / max(np.max(np.abs(found)), np.max(np.abs(expected)), unit)
    return float(error) if np.isfinite(error) else np.inf


# States of links against those of joints, guides and slots


class Comparison(NamedTuple):
    """Two values that must agree, and a size below which neither counts."""

    found: object
    expected: object
    unit: float


def _of_links(stage):
    """Errors of states of links against those of joints, guides and slots."""
    group, placement, size = stage.group, stage.place_joints(), stage.size
    parts = (_points, _fixed_joints, _guides, _slots, _slidings, _courses)
    return {
        what: max(_error(*both, unit) for both in zip(_parts(found), _parts(expected), strict=False))
        for part in parts
        for what, (found, expected, unit) in part(group, placement, size).items()
    }


def _points(group, placement, size):
    """Joints that are points of links, by position, velocity and acceleration."""
    found = {}
    for name, (link, along, across) in group.joints.items():
        joint = placement.joints[name]
        if link == FRAME:
            for what, part, fixed in zip(STATE_NAMES, joint, ((along, across), (0.0, 0.0), (0.0, 0.0)), strict=True):
                found[f"{what} of {name} as a point of the frame"] = Comparison(vector_or_zero(part), fixed, size)
            continue
        motion = placement.links[link]
        spot = PointMotion(motion.joint, arm(motion.direction, along, across), motion)
        for what, part, by_link in zip(STATE_NAMES, joint, _states(spot), strict=True):
            found[f"{what} of {name} as a point of {link}"] = Comparison(
                vector_or_zero(by_link), vector_or_zero(part), size
            )
    return found


def _fixed_joints(group, placement, size):
    """Joints that a link keeps at one place in its own axes: the end of a bar at its length, other pins anywhere."""
    fixed = {(pair.link, pair.joint): None for pair in _declared(group, "pairs").values() if type(pair) is Turning}
    for bar in group.bars:
        fixed |= {(bar.link, bar.start): (0.0, 0.0), (bar.link, bar.end): (bar.length, 0.0)}
    found = {}
    for (link, name), at in fixed.items():
        if link not in group.links:
            continue
        motion, joint = placement.links[link], placement.joints[name]
        to_joint = subtract_vectors(joint.position, motion.joint.position)
        seen = rotate_back(to_joint, motion.direction)
        expected = tuple(np.mean(part) for part in seen) if at is None else at
        found[f"place of {name} in the axes of {link}"] = Comparison(seen, expected, size)
        _, first, second = _states(PointMotion(motion.joint, to_joint, motion))
        found[f"velocity of {name} by {link}"] = Comparison(vector_or_zero(first), vector_or_zero(joint.first), size)
        found[f"acceleration of {name} by {link}"] = Comparison(
            vector_or_zero(second), vector_or_zero(joint.second), size
        )
    return found


def _guides(group, placement, size):
    """Sliders: the pin on the guide, the direction of the guide, and the travel along it."""
    found = {}
    for link, guide in _declared(group, "guides").items():
        motion, direction = placement.links[link], guide.direction
        position = motion.joint.position
        found[f"distance of {link} from its guide"] = Comparison(cross(direction, position), guide.guide_offset, size)
        found[f"direction of {link} along its guide"] = Comparison(motion.direction, direction, 1.0)
        travel = placement.travels.get(link)
        for what, claimed, part in zip(STATE_NAMES, travel, motion.joint, strict=True) if travel else ():
            found[f"{what} of the travel of {link}"] = Comparison(
                number_or_zero(claimed), dot(direction, vector_or_zero(part)), size
            )
    return found


def _slots(group, placement, size):
    """Joints that slide in the slot of a link: on the line of the slot."""
    found = {}
    for slot in _declared(group, "slots"):
        motion = placement.links[slot.link]
        axis = rotate((np.cos(slot.angle), np.sin(slot.angle)), motion.direction)
        away = subtract_vectors(placement.joints[slot.joint].position, motion.joint.position)
        found[f"distance of {slot.joint} from the slot of {slot.link}"] = Comparison(
            cross(axis, away), slot.offset, size
        )
        if slot.rod:
            aside = cross(axis, placement.links[slot.rod].direction)
            found[f"direction of {slot.rod} along {slot.link}"] = Comparison(aside, 0.0, 1.0)
    return found


def _slidings(group, placement, size):
    """Rates of sliding pairs, which give the sense of friction, as velocities of one link against the other."""
    found = {}
    for name, pair in _declared(group, "pairs").items():
        if type(pair) is not Sliding:
            continue
        slide, joint = group.sliding(name, placement), placement.joints[pair.joint]
        direction = (1.0, 0.0) if slide.direction is None else slide.direction
        first = subtract_vectors(_velocity(placement, pair.link, joint), _velocity(placement, pair.against, joint))
        found[f"rate of sliding of {name}"] = Comparison(
            number_or_zero(slide.rate), dot(direction, vector_or_zero(first)), size
        )
        if pair.against != FRAME:
            away = subtract_vectors(joint.position, placement.links[pair.against].joint.position)
            found[f"moment of sliding of {name}"] = Comparison(
                number_or_zero(slide.moment), cross(away, direction), size
            )
    return found


def _courses(group, placement, size):
    """Centre and radius of a joint that swings about a fixed place."""
    found = {}
    for name in group.joints:
        swing = placement.course(name).swing
        if swing is not None:
            parts = (*swing.centre, swing.radius)
            found[f"centre and radius of the swing of {name}"] = Comparison(parts, tuple(map(np.mean, parts)), size)
    return found


def _declared(group, name):
    """A declaration of a group; one not derived from `Group` may lack it."""
    return getattr(group, name, {})


def _states(spot):
    return spot.position, spot.first, spot.second


def _velocity(placement, link, joint):
    """Velocity of the point of a link that is at a joint."""
    if link == FRAME:
        return None
    motion = placement.links[link]
    return PointMotion(motion.joint, subtract_vectors(joint.position, motion.joint.position), motion).first

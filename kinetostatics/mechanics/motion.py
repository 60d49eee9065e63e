"""Motion of a mechanism at given crank angles: positions, velocities, accelerations of every joint and link.

Velocity and acceleration follow from the kinematic coefficients x' and x'' by the crank angle: v = omega x',
a = omega^2 x'' + alpha x'. If parts of the mechanism cannot be assembled, quantities are NaN. Motion is NaN where the
group or an inner one is open, forces also where an outer one is open. Quantities of the crank or of the whole mechanism
are NaN where any group is open.
"""

import math
from collections import defaultdict
from dataclasses import dataclass
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from ..errors import QuantityError
from ..machine.friction import NO_FRICTION, Frictions
from ..machine.group import FRAME, RATES, TRAVELS
from ..machine.kinematic_state import sense_of
from ..machine.links import Joint, PointMotion, acceleration_of, angular_acceleration, arm, present
from ..machine.loads import Gravity, has_no_user_code
from ..machine.loads.points import PLACE_RULE
from ..machine.mechanism import Mechanism
from ..numbers import checks, parameter_tree
from ..numbers.arithmetic import namespace, read_only, stack, stop_gradient
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import Leaves, broadcast_shape, flatten
from ..numbers.planar import add_vectors, number_or_zero, plus, product, scale_vector, vector_or_zero
from .quantities import of_mechanism


def required_groups(mechanism):
    """Groups that a quantity needs assembled, by its name; all groups unless it belongs to one."""
    groups = mechanism.groups
    inner: list[set[int]] = []  # places of each group and of the groups that carry it
    joints: dict[str, set[int]] = {}
    links: dict[str, set[int]] = {}
    for place, group in enumerate(groups):
        under = [joints.get(name, set()) for name in group.hangs_on]
        under += [links.get(point.link, set()) for point in group.joints.values()]
        own = {place}.union(*under)
        joints |= dict.fromkeys(group.joints, own)
        links |= dict.fromkeys(group.links, own)
        inner.append(own)
    found: defaultdict[str, tuple] = defaultdict(lambda: groups)
    for place, group in enumerate(groups):
        outer = set().union(*(own for own in inner if place in own))
        friction = [f"{name}{ending}" for name in group.pairs for ending in ("_friction", "_friction_loss")]
        rates = [f"{link}{ending}" for link in group.links for ending in RATES]
        travels = [f"{slider}{ending}" for slider in group.guides for ending in TRAVELS]
        for needed, names in (
            (outer, (*group.outputs, *group.contacts, *friction)),
            (inner[place], (*group.motions, *rates, *travels)),
        ):
            found.update(dict.fromkeys(names, tuple(groups[one] for one in needed)))
    return found


def coordinates(placement, groups):
    """Coordinates of the joints and directions of the links of groups, a list; NaN where a group is open."""
    joints = [placement.joints[name].position for group in groups for name in group.joints]
    directions = [placement.links[name].direction for group in groups for name in group.links]
    return [part for pair in (*joints, *directions) for part in pair]


def gap_mask(placement, groups):
    """0 where all groups are assembled, NaN elsewhere, (..., N); None if none of them moves."""
    total = reduce(plus, (part for part in coordinates(placement, groups) if hasattr(part, "shape")), None)
    if total is None or total.dtype == object:
        return None if total is None else 0.0 * stop_gradient(total)
    xp = namespace(total)
    return xp.where(xp.isfinite(total), xp.zeros_like(total), xp.full_like(total, xp.nan))


class SceneParts(NamedTuple):
    """Parts of a scene, in the order of its structure; absent parts at the end are left out."""

    mechanism: Any
    crank_speed: Any
    crank_acceleration: Any
    loads: Any
    friction: Any = NO_FRICTION
    sense: Any = None


def _has_no_user_code(kind):
    return all(map(has_no_user_code, kind.numbered.loads))


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of a mechanism; `solve` returns it.

    The last axis of arrays is the crank angle, batch axes of designs come before it, and the first axis of a vector is
    (x, y).

    Attributes
    ----------
    mechanism : Mechanism
    crank_angle : array (..., N)
        rad.
    crank_speed, crank_acceleration : float or array
        rad/s, rad/s2.
    loads : tuple
    friction : mapping of joint to friction
    sense : None, float or array
        Sense of rotation of the crank, +1 or -1; None takes the sign of its speed, at rest of its acceleration.
    """

    mechanism: Mechanism
    crank_angle: Any
    crank_speed: Any
    crank_acceleration: Any
    loads: tuple = ()
    friction: Frictions = NO_FRICTION
    sense: Any = None

    @cached_property
    def apart(self):
        """Structure of the scene, and its numbers as `Leaves`."""
        leaves = Leaves()
        scene: tuple[Any, ...] = self.mechanism, self.crank_speed, self.crank_acceleration, self.loads
        if self.sense is not None:
            scene = (*scene, self.friction, self.sense)
        elif self.friction.by_joint:
            scene = (*scene, self.friction)
        return (SceneParts, *flatten(scene, leaves)[1:]), leaves

    @cached_property
    def kind(self):
        """`Kind` of the scene: properties that all scenes of its structure share."""
        structure, leaves = self.apart
        return parameter_tree.structure_cache(structure) if leaves.lasting else parameter_tree.StructureCache(structure)

    @cached_property
    def gravity(self):
        """Acceleration (x, y) of gravity, m/s2; None without weight."""
        return reduce(add_vectors, (item.vector for item in self.loads if isinstance(item, Gravity)), None)

    @cached_property
    def loads_are_given(self):
        """Whether all loads consist of checked numbers, without code of the user's."""
        _, leaves = self.apart
        return self.kind.answer(_has_no_user_code) if leaves.lasting else all(map(has_no_user_code, self.loads))

    @property
    def proportion(self):
        """Sum of all lengths over the shortest length, the largest of a batch."""
        return self.mechanism.proportion

    @cached_property
    def shape(self):
        """Shape (..., N) of a scalar result: batch axes of designs and loads, then the crank angles."""
        _, leaves = self.apart
        if leaves.lasting:
            return leaves.shape(self.crank_angle.shape)
        return broadcast_shape(
            self.crank_angle.shape,
            self.mechanism,
            self.crank_speed,
            self.crank_acceleration,
            *self.loads,
            self.friction,
            self.sense,
        )

    @cached_property
    def farthest(self):
        """Upper bound of the sizes of the crank angles, rad; inf or NaN if they are unknown or not finite."""
        angle = self.crank_angle
        if not isinstance(angle, np.ndarray) or angle.dtype == object:
            return math.inf
        row = angle.ravel()
        return math.sqrt(row.dot(row))  # a quarter of the time of the largest size

    @cached_property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        return self.mechanism.place(self.crank_angle)

    def position(self, point):
        """Position of a point, (2, ..., N), m.

        The point is a joint ("O", "A", "B" ...), the mass centre of a link (its name), or a fixed point (x, y). A place
        on a link is ("coupler", along, across), in m from its reference joint.
        """
        return self.as_vector(self._point(point).position)

    def velocity(self, point):
        """Velocity of a point, given as for `position`, (2, ..., N), m/s."""
        return self.as_vector(scale_vector(self.crank_speed, self._point(point).first))

    def acceleration(self, point):
        """Acceleration of a point, given as for `position`, (2, ..., N), m/s2."""
        found = self._point(point)
        return self.as_vector(acceleration_of(found.first, found.second, *self.accelerating))

    def rate(self, link):
        """Angular velocity of a link, (..., N), rad/s."""
        found = self._look_up("link", link, self.placement.links)
        return self._scalar(self._with_gaps(product(self.crank_speed, found.ratio), link))

    def angular_acceleration(self, link):
        """Angular acceleration of a link, (..., N), rad/s2."""
        found = self._look_up("link", link, self.placement.links)
        rate = angular_acceleration(found.ratio, found.ratio_slope, *self.accelerating)
        return self._scalar(self._with_gaps(rate, link))

    def _with_gaps(self, rate, link):
        """The rate of a link, with NaN at gaps also for a link of constant rate."""
        if hasattr(self.placement.links[link].ratio, "shape"):
            return rate
        return plus(rate, gap_mask(self.placement, required_groups(self.mechanism)[link + RATES[0]]))

    def travel(self, slider=None):
        """Coordinate of a slider's pin along its guide (B . guide direction), (..., N), m.

        By default the only slider, or the one without a label.
        """
        return self._scalar(self._travel(slider).position)

    def travel_velocity(self, slider=None):
        """Velocity of a slider along its guide, (..., N), m/s."""
        return self._scalar(self.crank_speed * self._travel(slider).first)

    def travel_acceleration(self, slider=None):
        """Acceleration of a slider along its guide, (..., N), m/s2."""
        travel = self._travel(slider)
        square, alpha = self.accelerating
        return self._scalar(plus(square * travel.second, product(alpha, travel.first)))

    def elongation(self, free_position, slider=None):
        """Coordinate of a slider's pin along its guide less `free_position` (m), without cancellation, (..., N), m."""
        words = checks.not_a_number(free_position)
        if words is None and isinstance(free_position, list | tuple):
            words = "several; give an array"
        if words is None and isinstance(free_position, np.ndarray):
            words = f"of {free_position.dtype}" if free_position.dtype.kind not in "iufO" else None
            words = words or checks.broadcast_problem(free_position=free_position.shape, **{"crank angles": self.shape})
        if words:
            text = f"free_position must be a number, m, got {checks.shown(free_position)}, {words}"
            checks.require("elongation", text)
        slider = self._slider(slider)
        travel = self._travel(slider)
        group = next(group for group in self.mechanism.groups if slider in group.links)
        if not hasattr(group, "elongation"):
            return self._scalar(travel.position - free_position)
        return self._scalar(group.elongation(self.placement, free_position))

    slider_position = property(travel)
    slider_velocity = property(travel_velocity)
    slider_acceleration = property(travel_acceleration)

    def measure(self, name):
        """A declared motion quantity of a group, such as "pressure_angle", (..., N)."""
        for group in self.mechanism.groups:
            if isinstance(name, str) and name in group.motions:
                return self._scalar(group.motion(name, self.placement))
        known = of_mechanism(self.mechanism)
        if isinstance(name, str) and name in known:
            reading = f"solution{known[name].reading}"
            raise QuantityError(f"{self.mechanism.name}: {name!r} is not a quantity of motion; read it by {reading}")
        raise QuantityError(checks.choice(f"{self.mechanism.name}: quantity", name, tuple(known)))

    @property
    def closure(self):
        """Margin of each group, a tuple of (..., N): negative where it cannot be assembled, 0 at a limit position."""
        return tuple(map(self._scalar, self.mechanism.margins(self.placement, self.shape)))

    @property
    def crank_sense(self):
        """Sense of rotation of the crank: +1 counter-clockwise, -1 clockwise, float or array.

        `sense` if given, otherwise the sign of the crank speed, at rest of the crank acceleration; +1 where both are 0.
        """
        return sense_of(self.crank_speed, self.crank_acceleration) if self.sense is None else self.sense

    @cached_property
    def accelerating(self) -> tuple[Any, Any]:
        """Crank speed squared and crank acceleration (or None), the factors of the kinematic coefficients."""
        return self.crank_speed * self.crank_speed, present(self.crank_acceleration)

    def _travel(self, slider):
        return self._look_up("slider", self._slider(slider), self.placement.travels)

    def _slider(self, name):
        """Name of a slider; None: the only one, or the one without a label."""
        found = self.mechanism.slider if name is None else name
        if found is None:
            names = tuple(self.mechanism.guides)
            has = f"{len(names)} sliders, {', '.join(names)}" if names else "no slider"
            remedy = f'; choose one, as in travel("{names[0]}") or "{names[0]}_position"' if names else ""
            raise QuantityError(f"{self.mechanism.name} has {has}{remedy}")
        return found

    def _point(self, point):
        """Motion of a point given by the user, checked unless it is a name."""
        if isinstance(point, str):
            return self.spot(point)
        point, problem = PLACE_RULE.check(point, "point")
        checks.require(self.mechanism.name, problem)
        return self.spot(point)

    def spot(self, place) -> PointMotion:
        """Motion of a point: a joint or mass centre by name, a place on a link, or a fixed point."""
        joints, links = self.placement.joints, self.placement.links
        if isinstance(place, str):
            found = self._look_up("joint or link", place, {**joints, **links})
            if place in joints:
                return PointMotion(found)
            body = self.mechanism.links[place].body
            return PointMotion(found.joint, arm(found.direction, body.along, body.across), found)
        if not isinstance(place[0], str) or place[0] == FRAME:
            return PointMotion(Joint(tuple(place[-2:]), None, None))
        link = self._look_up("link", place[0], links)
        return PointMotion(link.joint, arm(link.direction, *map(present, place[1:])), link)

    def _look_up(self, kind, name, table):
        if not isinstance(name, str) or name not in table:
            several = "; use one at a time" if isinstance(name, list | tuple | set | np.ndarray) else ""
            raise QuantityError(f"{checks.choice(f'{self.mechanism.name}: {kind}', name, table)}{several}")
        return table[name]

    def as_vector(self, parts):
        """Components (x, y) as one array (2, ..., N); None is the zero vector."""
        x, y = vector_or_zero(parts)
        if not hasattr(x, "shape"):
            x = x + 0.0 * y  # a constant component is NaN where the other one is
        if not hasattr(y, "shape"):
            y = y + 0.0 * x
        return read_only(stack([self._full(x), self._full(y)]))

    def _scalar(self, part):
        return read_only(self._full(number_or_zero(part)))

    def _full(self, part):
        """A part broadcast to `shape`."""
        if getattr(part, "shape", None) == self.shape:
            return part
        xp = namespace(self.crank_angle)
        return xp.broadcast_to(part if hasattr(part, "shape") else xp.full_like(self.crank_angle, part), self.shape)

"""Free body of a link: every force and couple on it with its point; with inertia they are in equilibrium.

    sum F = 0        sum (r x F + C) = 0

Reactions are those that the groups resolve: a `Turning` pair gives a force at its joint, a `Sliding` pair one along the
left normal of its direction and a couple, a cam one along the normal of its curve, and friction acts in each. They act
on the `link` of the pair, and the other way round on what carries it. Inertia (d'Alembert: -m a at the mass centre and
-I alpha) and weight are those of `Dynamics`, loads their own wrenches.
"""

from typing import Any, NamedTuple

import numpy as np

from ..errors import QuantityError
from ..machine.group import CRANK, FRAME
from ..machine.links import Rolling, Turning
from ..machine.loads import Gravity
from ..machine.loads.points import point_on_link
from ..numbers import checks
from ..numbers.planar import add_vectors, cross, dot, left, length, minus, number_or_zero, scale_vector, vector_or_zero
from .friction import PairFriction
from .load_values import evaluate_load, numbered_titles, slider_push

REACTION, INERTIA, WEIGHT, LOAD, DRIVE = "reaction", "inertia", "weight", "load", "drive"
"""Kinds of actions on a link."""
NO_FRICTION = PairFriction(None, None)
MAX_IMBALANCE = 1e-6
"""Largest sum of the forces on a link with a user's own group, relative to the largest of them."""
ROUNDING = 1e-13
"""Couple that a load leaves beside its force at its point, relative to the moment of that, which is rounding."""


class Action(NamedTuple):
    """Force and couple on a link by one cause.

    Attributes
    ----------
    name : str
        "A", "guide", "inertia", "weight", title of a load, "balancing torque".
    kind : str
        "reaction", "inertia", "weight", "load" or "drive".
    point, force : array (2, ..., N)
        m, N.
    couple : array (..., N)
        Counter-clockwise, N m.
    """

    name: str
    kind: str
    point: Any
    force: Any
    couple: Any

    def moment(self, about=(0.0, 0.0)):
        """Moment about a point, (..., N), N m."""
        return cross((self.point[0] - about[0], self.point[1] - about[1]), self.force) + self.couple


def free_body(dynamics, link) -> tuple[Action, ...]:
    """All actions on a link of a scene at its crank angles; their forces and moments add up to zero.

    Raises
    ------
    QuantityError
        There is no such link; the message lists those there are.
    ParameterError
        A group of the user's own declares pairs whose forces do not balance a link.
    """
    links = dynamics.mechanism.links
    if not isinstance(link, str) or link not in links:
        raise QuantityError(checks.choice(f"{dynamics.mechanism.name}: link", link, tuple(links)))
    with np.errstate(all="ignore"):
        found = [*_reactions(dynamics, link), *_masses(dynamics, link), *_loads(dynamics, link)]
        if link == CRANK:
            found.append(("balancing torque", DRIVE, None, None, dynamics.resolved.scalars["balancing_torque"]))
        actions = tuple(
            Action(name, kind, dynamics.as_vector(point), dynamics.as_vector(force), dynamics._scalar(couple))
            for name, kind, point, force, couple in found
        )
    if not dynamics.mechanism.trusted:
        _require_balance(dynamics, link, actions)
    return actions


def _require_balance(dynamics, link, actions):
    """Refuse forces that are not in equilibrium, as of a group of the user's own that does not declare all pairs."""
    sums = [np.sum([item.force for item in actions], axis=0), np.sum([item.moment() for item in actions], axis=0)]
    sizes = [np.abs([item.force for item in actions]), np.abs([item.moment() for item in actions])]
    lost = [np.max(np.abs(part)) > MAX_IMBALANCE * np.max(size) for part, size in zip(sums, sizes, strict=True)]
    text = "its forces do not balance: a group of your own does not declare all its pairs with their forces"
    checks.require(f"free body of {link!r}", text if any(lost) else None)


# Reactions


def _reactions(dynamics, link):
    """Yield name, kind, point, force and couple of each reaction on a link."""
    for part in dynamics.mechanism.parts:
        for name, pair in part.pairs.items():
            if isinstance(pair, Rolling):
                continue
            against = pair.against or dynamics.mechanism.joints[pair.joint].link
            sign = {pair.link: 1.0, against: -1.0}.get(link)
            if sign is not None:
                act = _of_pin if isinstance(pair, Turning) else _of_slide
                yield from (_turned(sign, *found) for found in act(dynamics, part, name, pair))
        for led in getattr(part, "led", ()):
            sign = {led.link: 1.0, led.body: -1.0}.get(link)
            if sign is not None:
                yield _turned(sign, *_of_cam(dynamics, led))


def _turned(sign, name, point, force, couple):
    return name, REACTION, point, scale_vector(sign, force), None if couple is None else sign * couple


def _friction(dynamics, name):
    """Friction of a pair, `PairFriction`; it acts on the link of the pair with the opposite sign."""
    return dynamics.friction_by_joint.get(name, NO_FRICTION)


def _of_pin(dynamics, part, name, pair):
    force, friction = dynamics.resolved.reactions[name], _friction(dynamics, name)
    yield name, dynamics.placement.joints[pair.joint].position, force, minus(None, friction.amount)


def _of_slide(dynamics, part, name, pair):
    """Force across a straight pair and its couple, about the joint that the pair names; friction along it."""
    scalars, joints = dynamics.resolved.scalars, dynamics.placement.joints
    slide = part.sliding(name, dynamics.placement)
    direction = (1.0, 0.0) if slide.direction is None else slide.direction
    across = scale_vector(number_or_zero(scalars[pair.force]), left(direction))
    along = scale_vector(minus(None, _friction(dynamics, name).amount), direction)
    couple = number_or_zero(scalars[pair.couple])
    if pair.about in ("", pair.joint):
        yield name, joints[pair.joint].position, add_vectors(across, along), couple
        return
    yield name, joints[pair.about].position, across, couple
    if along is not None:
        yield f"friction {name}", joints[pair.joint].position, along, None


def _of_cam(dynamics, led):
    """Force of the curve of a cam on a roller centre or flat face, to the left normal of the curve."""
    placement = dynamics.placement
    joint, link = placement.joints[led.joint], placement.links[led.link]
    position, first = joint.position, vector_or_zero(joint.first)
    turning: Any = 0.0
    if led.body != FRAME:
        body = placement.links[led.body]
        turning = number_or_zero(body.ratio)
        apart = (position[0] - body.joint.position[0], position[1] - body.joint.position[1])
        carried = add_vectors(body.joint.first, scale_vector(turning, left(apart)))
        first = vector_or_zero(add_vectors(first, scale_vector(-1.0, carried)))
    force = number_or_zero(dynamics.resolved.scalars[led.force])
    name = led.force.replace("_force", "")
    if led.flat:
        away = dot(first, link.direction) / (turning - number_or_zero(link.ratio))
        at = add_vectors(position, scale_vector(-away, left(link.direction)))
        return name, at, scale_vector(force, link.direction), None
    tangent = scale_vector(1.0 / length(first), first)
    friction = _friction(dynamics, name)
    along = scale_vector(minus(None, friction.amount), tangent)
    return name, position, add_vectors(scale_vector(force, left(tangent)), along), minus(None, friction.couple)


# Inertia, weight and loads


def _masses(dynamics, link):
    """Yield inertia force and couple, and weight, of a link with mass, and those of springs on a slider."""
    body, centre = dynamics.mechanism.links[link].body, dynamics.spot(link).position
    force, couple = dynamics.inertia[link].force, None
    if body.inertia is not None:
        couple = minus(None, body.inertia * dynamics.angular_acceleration(link))
    if force is not None or couple is not None:
        yield "inertia", INERTIA, centre, force, couple
    if body.mass is not None and dynamics.gravity is not None:
        yield "weight", WEIGHT, centre, scale_vector(body.mass, dynamics.gravity), None
    for name, wrench in dynamics.spring_loads:
        if name == link:
            origin = dynamics.placement.links[link].joint.position
            yield "inertia and weight of springs", INERTIA, origin, wrench.force, None


def _loads(dynamics, link):
    """Yield force and couple of each load on a link, at the point that the load names."""
    loads = [item for item in dynamics.loads if not isinstance(item, Gravity)]
    origin = dynamics.placement.links[link].joint.position
    for title, item in zip(numbered_titles(loads), loads, strict=True):
        if hasattr(item, "push"):
            if item.on == link:
                direction = tuple(dynamics.mechanism.guides[link].direction)
                yield title, LOAD, origin, scale_vector(slider_push(item, dynamics), direction), None
            continue
        for name, wrench in evaluate_load(item, dynamics).wrenches(dynamics):
            if name == link and not (wrench.force is None and wrench.moment is None):
                yield (title, LOAD, *_at_its_point(dynamics, link, item, origin, wrench))


def _at_its_point(dynamics, link, item, origin, wrench):
    """Point, force and couple of a load with a wrench about the reference joint of a link."""
    if wrench.force is None:
        return dynamics.spot(link).position, None, wrench.moment
    places = [item.at] if hasattr(item, "at") else getattr(item, "between", ())
    at = next((place for place in places if point_on_link(dynamics.mechanism, place).link == link), None)
    point = origin if at is None else dynamics.spot(at).position
    apart, force = (point[0] - origin[0], point[1] - origin[1]), vector_or_zero(wrench.force)
    couple = np.asarray(number_or_zero(wrench.moment) - cross(apart, force))
    return point, force, np.where(np.abs(couple) <= ROUNDING * length(apart) * length(force), 0.0, couple)

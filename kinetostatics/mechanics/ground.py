"""Forces of each pair of links, friction included, and of the machine on its frame.

    turning pair     reaction at the joint; friction of the pin as a couple
    sliding pair     force along the left normal of its direction, friction along it, and a couple, at a joint
    teeth            reaction at the pitch point
    cam              force along the left normal of its curve, friction along the curve, at the contact

They act on the `link` of the pair, and oppositely on the other link. The pin friction of a roller turns it against a
force along the curve. So both forces of a cam pass through the contact, or ahead of it by the arm of rolling friction.
The sign of the force gives the side of the curve that the roller touches, at its radius from the centre. If the radius
is unknown, the contact is at the centre.

The frame takes the opposite forces of its pairs and, at the "motor", the opposite of the balancing torque. It also
carries the feet of springs and dampers, fixed points, couples, and process forces that it takes. By d'Alembert's
principle, with the inertia forces I, weights W and outside forces F on the links,

    sum of the forces on the frame = I + W + F,    and so for moments about any point.

I is the shaking force. It comes from the motion of the masses, the sum on the left from the reactions, so each tests
the other.
"""

from functools import reduce

from ..errors import QuantityError
from ..machine.group import FRAME
from ..machine.links import CamDriven, Meshing, Turning, present
from ..machine.supports import Support, places
from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.planar import add_vectors, dot, left, length, minus, moment, plus, product, scale_vector, vector_or_zero
from .load_values import evaluate_load


def pair_forces(state, name, joining) -> dict[str, Support]:
    """Forces of a pair on its link by name; two for a slide whose couple and friction refer to different joints."""
    pair = joining.pair
    if isinstance(pair, CamDriven):
        return {name: _of_cam(state, name, pair)}
    if isinstance(pair, Turning):
        point = state.placement.joints[pair.joint].position
        return {name: Support(state.reaction(name), point, _friction(state, name))}
    if isinstance(pair, Meshing):
        return {name: Support(state.reaction(name), scale_vector(2.0, state.placement.joints[pair.joint].position))}
    return _of_slide(state, name, joining)


def _friction(state, name):
    """Friction of a pair on its link; None if zero."""
    return state.friction_at(name) if name in state.friction.acting else None


def _of_slide(state, name, joining):
    """Forces of a straight pair; its couple is about the pair's reference joint. A guide has only the reaction."""
    pair, joints = joining.pair, state.placement.joints
    couple, about = state.scalar(pair.couple), joints[pair.about or pair.joint].position
    if name in joining.part.outputs:
        return {name: Support(state.reaction(name), about, couple)}
    direction = joining.part.sliding(name, state.placement).direction
    direction = (1.0, 0.0) if direction is None else direction
    across = scale_vector(state.scalar(pair.force), left(direction))
    along = scale_vector(_friction(state, name), direction)
    if along is None or pair.about in ("", pair.joint):
        return {name: Support(add_vectors(across, along), about, couple)}
    return {name: Support(across, about, couple), f"friction {name}": Support(along, joints[pair.joint].position)}


def _of_cam(state, name, led):
    """Force of a cam on a roller or flat face."""
    placement = state.placement
    position = placement.joints[led.joint].position
    force, first = state.scalar(led.force), vector_or_zero(placement.rate_from(led.joint, led.body))
    if led.flat:
        link = placement.links[led.link]
        turning = None if led.body == FRAME else placement.links[led.body].ratio
        away = dot(first, link.direction) / minus(turning, link.ratio)
        to_contact = scale_vector(-away, left(link.direction))
        return Support(scale_vector(force, link.direction), add_vectors(position, to_contact))
    tangent = scale_vector(1.0 / length(first), first)
    friction = state.friction.acting.get(name)
    radius = state.mechanism.rollers.get(led.joint) if friction is None else friction.roller_radius
    to_contact = scale_vector(product(radius, -sign(force)), left(tangent))
    along = _friction(state, name)
    if friction is not None and present(friction.rolling_arm) is not None:
        to_contact = add_vectors(to_contact, scale_vector(-friction.rolling_arm * sign(along), tangent))
    total = add_vectors(scale_vector(force, left(tangent)), scale_vector(along, tangent))
    return Support(total, add_vectors(position, to_contact))


def support(state, name) -> Support:
    """Force and couple on the frame at a place by name, of a `Dynamics` or solution; or `QuantityError`."""
    known = places(state)
    if not isinstance(name, str) or name not in known:
        raise QuantityError(checks.choice(f"{state.mechanism.name}: place on the frame", name, tuple(known)))
    pair, number, _ = known[name]
    if number is not None:
        return evaluate_load(state.loads[number], state).support(state)
    if pair is None:
        return Support(None, None, minus(None, state.balancing_torque))
    return pair_forces(state, name, pair)[name].opposite()


def undeclared(dynamics):
    """Largest force, N, and moment about O, N m, on the links beside declared pairs and motor: rounding, or a fault."""
    links, guides = dynamics.placement.links, dynamics.mechanism.guides
    acting = [(links[name].joint.position, *wrench) for name, wrench in dynamics.link_loads.items()]
    for name, push in dynamics.pushes.items():
        acting.append((links[name].joint.position, scale_vector(push, guides[name].direction), None))
    for name, place in places(dynamics).items():
        if place.load is None:
            force, point, couple = support(dynamics, name).opposite()
            acting.append((point, force, couple))
    force = dynamics.as_vector(reduce(add_vectors, (force for _, force, _ in acting), None))
    turning = reduce(plus, (plus(moment(point, force), couple) for point, force, couple in acting), None)
    return dynamics.largest(length(force)), dynamics.largest(turning)


def resultant(state):
    """Sum of the forces on the frame, (x, y); None without any."""
    return reduce(add_vectors, (support(state, name).force for name in places(state)), None)

"""Forces of the machine on its frame, at every place where the two push each other.

    turning pair     opposite of its reaction at the joint; friction of the pin as a couple
    sliding pair     opposite of its reaction, friction included, at the joint; couple of the guide
    rolling pair     along the common normal, which passes through the roller's centre; friction along the curve
    loads            feet of springs and dampers, fixed points, couples, process forces that the frame takes
    "motor"          opposite of the balancing torque, a couple

By d'Alembert's principle for the machine as a whole, with the inertia forces I, weights W and outside forces F on its
links,

    sum of the forces on the frame = I + W + F,    and so for moments about any point.

I is the shaking force. It comes from the motion of the masses, the sum on the left from the reactions, so each tests
the other.

A roller touches its curve on the side that the sign of the force says, at its radius from the centre. Where the radius
is not known the centre stands for the contact; without friction the force passes through both.
"""

from functools import reduce

from ..errors import QuantityError
from ..machine.links import Rolling, Sliding
from ..machine.supports import Support, joint_of, places
from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.planar import (
    add_vectors,
    left,
    length,
    minus,
    moment,
    plus,
    product,
    scale_vector,
    subtract_vectors,
)
from .load_values import evaluate_load


def support(state, name) -> Support:
    """Force and couple on the frame at a place by name; `state` is a `Dynamics` or a solution.

    Raises
    ------
    QuantityError
        There is no such place; the message lists those there are.
    """
    known = places(state)
    if not isinstance(name, str) or name not in known:
        raise QuantityError(checks.choice(f"{state.mechanism.name}: place on the frame", name, tuple(known)))
    pair, number, _ = known[name]
    if number is not None:
        return evaluate_load(state.loads[number], state).support(state)
    if pair is None:
        return Support(None, None, minus(None, state.balancing_torque))
    if isinstance(pair, Rolling):
        return _contact(state, name, pair)
    couple = state.scalar(pair.couple) if isinstance(pair, Sliding) else _friction(state, name)
    point = state.placement.joints[joint_of(pair)].position
    return Support(subtract_vectors(None, state.reaction(name)), point, minus(None, couple))


def _friction(state, name):
    """Friction of a pair on its moving link; None without."""
    return state.friction_at(name) if name in state.friction.acting else None


def _contact(state, name, pair):
    """Force of a roller on the curve that it runs on.

    The roller's pin friction turns it against a force along the curve, so both pass through the contact.
    """
    joint, friction = state.placement.joints[pair.joint], state.friction.acting.get(name)
    along = scale_vector(1.0 / length(joint.first), joint.first)
    outward, pressed = scale_vector(-1.0, left(along)), state.scalar(pair.force)
    force = subtract_vectors(scale_vector(pressed, outward), scale_vector(_friction(state, name), along))
    radius = state.mechanism.rollers.get(pair.joint) if friction is None else friction.roller_radius
    to_contact = scale_vector(product(radius, sign(pressed)), outward)
    return Support(force, add_vectors(joint.position, to_contact))


def undeclared(dynamics):
    """Largest force, N, and moment about O, N m, on the links that neither pairs with the frame nor the motor take.

    Rounding, unless a group of the user's own pushes the frame by more than the pairs that it declares.
    """
    links, guides = dynamics.placement.links, dynamics.mechanism.guides
    acting = [(links[name].joint.position, *wrench) for name, wrench in dynamics.link_loads.items()]
    for name, push in dynamics.pushes.items():
        acting.append((links[name].joint.position, scale_vector(push, guides[name].direction), None))
    for name, place in places(dynamics).items():
        if place.load is None:
            force, point, couple = support(dynamics, name)
            acting.append((point, subtract_vectors(None, force), minus(None, couple)))
    force = dynamics.as_vector(reduce(add_vectors, (force for _, force, _ in acting), None))
    turning = reduce(plus, (plus(moment(point, force), couple) for point, force, couple in acting), None)
    return dynamics.largest(length(force)), dynamics.largest(turning)


def resultant(state):
    """Sum of the forces on the frame, (x, y); None without any."""
    return reduce(add_vectors, (support(state, name).force for name in places(state)), None)

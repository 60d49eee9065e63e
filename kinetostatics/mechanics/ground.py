"""Forces of the machine on its frame, at every place of contact.

    pairs            opposite of their force on a link, with its couple: `pair_forces`
    loads            feet of springs and dampers, fixed points, couples, process forces that the frame takes
    "motor"          opposite of the balancing torque, a couple

By d'Alembert's principle for the machine as a whole, with the inertia forces I, weights W and outside forces F on its
links,

    sum of the forces on the frame = I + W + F,    and so for moments about any point.

I is the shaking force. It comes from the motion of the masses, the sum on the left from the reactions, so each tests
the other.
"""

from functools import reduce

from ..errors import QuantityError
from ..machine.supports import Support, places
from ..numbers import checks
from ..numbers.planar import add_vectors, length, minus, moment, plus, scale_vector
from .load_values import evaluate_load
from .pair_forces import pair_forces


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

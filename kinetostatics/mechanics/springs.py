"""Springs along guides together with the inertia of their sliders, which they may nearly balance.

With s the coordinate of a slider, e its elongation from where a spring of rate c is free, and m its mass, inertia and
spring give

    - m omega^2 s'' - c e = - m omega^2 (s'' + e) + (m omega^2 - c) e

and with several springs each takes its share of inertia so. A group that knows the departure s'' + e by itself leaves
nothing on the right that cancels where c is near m omega^2. Where it is not, no term is larger than inertia or springs
by more than elongations are larger than the stroke; at rest inertia is out of it.
"""

from functools import reduce

from ..machine.links import Wrench
from ..numbers.planar import added, minus, plus, product, stretched
from .pushes import pushed


def acting(dynamics):
    """Loads on links by name, and forces along guides by slider, that together with the former act on the groups.

    Of a slider with springs inertia along its guide is among the latter, where the departure of its motion is known.
    """
    loads, pushes = dynamics.link_loads, dynamics.pushes
    for slider in {item.on: None for item in dynamics.loads if _is_spring(item)}:
        found = _along(dynamics, slider)
        if found is not None:
            loads, pushes = loads | {slider: _without_inertia(dynamics, slider)}, pushes | {slider: found}
    return loads, pushes


def _along(dynamics, slider):
    """All that acts on a slider along its guide, with its inertia; None where that is known in no better way."""
    mass, travel = dynamics.mechanism.links[slider].body.mass, dynamics.placement.travels[slider]
    if mass is None:
        return None
    square, alpha = dynamics.accelerating
    items = [item for item in dynamics.loads if getattr(item, "on", None) == slider and hasattr(item, "push")]
    springs = [item for item in items if _is_spring(item)]
    departures = [dynamics.departure(item) for item in springs]
    if any(part is None for part in departures):
        return None
    share = mass * square
    if len(springs) > 1:
        share = share / len(springs)
    force = minus(None, product(product(mass, alpha), travel.first))
    for item, departure in zip(springs, departures, strict=True):
        force = minus(force, share * departure)
        force = force + (share - item.spring_rate(dynamics)) * dynamics.elongation(item.free_position, slider)
    others = (pushed(item, dynamics) for item in items if not _is_spring(item))
    return reduce(plus, others, force)


def _is_spring(item):
    """Whether a load's rate tells all its push: not where a kind derived from a spring pushes in another way."""
    telling = (vars(kind) for kind in type(item).__mro__ if {"push", "spring_rate"} & vars(kind).keys())
    return "spring_rate" in next(telling, ())


def _without_inertia(dynamics, slider):
    """Load on a slider without the force of its inertia."""
    weight = stretched(dynamics.mechanism.links[slider].body.mass, dynamics.gravity)
    applied = (wrench.force for name, wrench in dynamics.wrenches if name == slider)
    return Wrench(reduce(added, applied, weight), dynamics.link_loads[slider].moment)

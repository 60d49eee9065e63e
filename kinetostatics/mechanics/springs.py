"""Springs along guides together with the inertia of their sliders, which they may nearly balance.

With s the coordinate of a slider, e its elongation from where a spring of rate c is free, and m its mass, inertia and
spring give

    - m omega^2 s'' - c e = - c (s'' + e) + (c - m omega^2) s''

A group that knows the departure s'' + e by itself leaves nothing on the right that cancels where c is m omega^2.
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
    for slider in {item.on: None for item in dynamics.loads if hasattr(item, "spring_rate")}:
        found = _held(dynamics, slider)
        if found is not None:
            loads, pushes = loads | {slider: _without_inertia(dynamics, slider)}, pushes | {slider: found}
    return loads, pushes


def _held(dynamics, slider):
    """All that acts on a slider along its guide, with its inertia; None where that is known in no better way."""
    mass, travel = dynamics.mechanism.links[slider].body.mass, dynamics.placement.travels[slider]
    if mass is None:
        return None
    square, alpha = dynamics.accelerating
    force, rates = None, []
    for item in (item for item in dynamics.loads if getattr(item, "on", None) == slider and hasattr(item, "push")):
        if not hasattr(item, "spring_rate"):
            force = plus(force, pushed(item, dynamics))
            continue
        departure = dynamics.departure(item)
        if departure is None:
            return None
        rates.append(item.spring_rate(dynamics))
        force = minus(force, rates[-1] * departure)
    force = plus(force, (reduce(plus, rates) - mass * square) * travel.second)
    return minus(force, product(product(mass, alpha), travel.first))


def _without_inertia(dynamics, slider):
    """Load on a slider without the force of its inertia."""
    weight = stretched(dynamics.mechanism.links[slider].body.mass, dynamics.gravity)
    applied = (wrench.force for name, wrench in dynamics.wrenches if name == slider)
    return Wrench(reduce(added, applied, weight), dynamics.link_loads[slider].moment)

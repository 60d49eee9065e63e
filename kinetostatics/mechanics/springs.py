"""Springs along guides together with the inertia of their sliders, where the two nearly balance.

With s the coordinate of a slider, e its elongation from where a spring of rate c is free, and m its mass, inertia and
spring give

    - w s'' - c e = - h (s'' + e) - (w - h) s'' - (c - h) e,    w = m omega^2

for any h; several springs share w equally. A group that knows the departure s'' + e to full precision leaves no
cancellation on the right where c is near w, if h is near both. Their harmonic mean does so, or for springs that push
away too h = 2 w c / (w + |c|):

    w - h = w (w - c + |c| - c) / (w + |c|),    c - h = c (|c| - w) / (w + |c|)

These keep all digits of w - c, and no term exceeds three times inertia and spring force, whatever the elongation and
however near a limit position.

The force of a stiffening spring, c = k + q e^2, rounds several times where it is largest, and counts each rounding of e
three times. Where e, or its opposite, is a constant length l and a small part p, the force is that of a spring of
constant rate and a small rest: (k + q l^2) e + q p (2 l + p) e.
"""

from functools import reduce

from ..machine.links import Wrench
from ..numbers.parameter_tree import come_from_one_class
from ..numbers.planar import add_vectors, minus, plus, product, scale_vector
from .load_values import slider_push

MIN_RATE = 2.0**-120
"""Rate, N/m, that guards a divisor where there is neither spring nor inertia."""


def loads_on_groups(dynamics):
    """Loads by link, and forces along guides by slider, for the groups.

    For a slider with springs whose departure is known the latter include its inertia along the guide.
    """
    loads, pushes = dynamics.link_loads, dynamics.pushes
    for slider in {item.on: None for item in dynamics.loads if _is_spring(item)}:
        found = _total_push(dynamics, slider)
        if found is not None:
            loads, pushes = loads | {slider: _without_inertia(dynamics, slider)}, pushes | {slider: found}
    return loads, pushes


def _total_push(dynamics, slider):
    """Force along the guide of a slider with its inertia, N; None if a departure or the mass is not known."""
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
        has_parts = _is_spring(item, "parted_rate")
        rate, rest = item.parted_rate(dynamics) if has_parts else (item.spring_rate(dynamics), None)
        both, inertia, rate = _split_common(share, rate)
        elongation = dynamics.elongation(item.free_position, slider)
        force = minus(force, both * departure + (inertia * travel.second + rate * elongation))
        force = minus(force, product(rest, elongation))
    others = (slider_push(item, dynamics) for item in items if not _is_spring(item))
    return reduce(plus, others, force)


def _split_common(inertia, rate):
    """Common part of inertia w and rate c, and the rest of each: h, w - h and c - h, N/m."""
    size = inertia + abs(rate) + MIN_RATE
    w, c = inertia / size, rate / size
    return 2.0 * c * inertia, w * ((inertia - rate) + (abs(rate) - rate)), c * (abs(rate) - inertia)


def _is_spring(item, rate="spring_rate"):
    """Whether a load's rate gives its whole push; a subclass that overrides `push` alone makes the rate wrong."""
    return come_from_one_class(type(item), rate, "push", "spring_rate")


def _without_inertia(dynamics, slider):
    """Load on a slider without the force of its inertia."""
    weight = scale_vector(dynamics.mechanism.links[slider].body.mass, dynamics.gravity)
    applied = (wrench.force for name, wrench in dynamics.wrenches if name == slider)
    return Wrench(reduce(add_vectors, applied, weight), dynamics.link_loads[slider].moment)

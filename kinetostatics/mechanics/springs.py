"""Springs along guides together with the inertia of their sliders, which they may nearly balance.

With s the coordinate of a slider, e its elongation from where a spring of rate c is free, and m its mass, inertia and
spring give

    - w s'' - c e = - h (s'' + e) - (w - h) s'' - (c - h) e,    w = m omega^2

for any h, and with several springs each takes its share of w so. A group that knows the departure s'' + e by itself
leaves nothing on the right that cancels where c is near w, if h is near both. With their harmonic mean, or with
h = 2 w c / (w + |c|) for a spring that pushes away, too,

    w - h = w (w - c + |c| - c) / (w + |c|),    c - h = c (|c| - w) / (w + |c|)

lose no digit that w - c has, and no term is more than three times as large as inertia and spring are, be elongations as
long as they may, or s'' near a limit position.

The force of a spring that stiffens, c = k + q e^2, rounds several times where it is largest, and takes three roundings
for each of e. Where e, or its opposite, is known as a length l of the design and a part p that is small there, it is
that of a spring whose rate does not change and little more, (k + q l^2) e + q p (2 l + p) e.
"""

from functools import reduce

from ..machine.links import Wrench
from ..numbers.parameter_tree import come_from_one_class
from ..numbers.planar import add_vectors, minus, plus, product, scale_vector
from .load_values import slider_push

MIN_RATE = 2.0**-120
"""Rate, N/m, that counts as nothing: where there is neither spring nor inertia something is to be divided by."""


def loads_on_groups(dynamics):
    """Loads on links by name, and forces along guides by slider, that together with the former act on the groups.

    Of a slider with springs inertia along its guide is among the latter, where the departure of its motion is known.
    """
    loads, pushes = dynamics.link_loads, dynamics.pushes
    for slider in {item.on: None for item in dynamics.loads if _is_spring(item)}:
        found = _total_push(dynamics, slider)
        if found is not None:
            loads, pushes = loads | {slider: _without_inertia(dynamics, slider)}, pushes | {slider: found}
    return loads, pushes


def _total_push(dynamics, slider):
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
        rate, besides = _split_rate(item, dynamics)
        both, inertia, rate = _split_common(share, rate)
        elongation = dynamics.elongation(item.free_position, slider)
        force = minus(force, both * departure + (inertia * travel.second + rate * elongation))
        force = minus(force, product(besides, elongation))
    others = (slider_push(item, dynamics) for item in items if not _is_spring(item))
    return reduce(plus, others, force)


def _split_common(inertia, rate):
    """What inertia and the rate of a spring have in common, and what each has besides: h, w - h and c - h."""
    size = inertia + abs(rate) + MIN_RATE
    w, c = inertia / size, rate / size
    return 2.0 * c * inertia, w * ((inertia - rate) + (abs(rate) - rate)), c * (abs(rate) - inertia)


def _split_rate(item, dynamics):
    """Rate of a spring that no crank angle changes, if it tells of one, and what it has besides."""
    return item.parted_rate(dynamics) if _is_spring(item, "parted_rate") else (item.spring_rate(dynamics), None)


def _is_spring(item, rate="spring_rate"):
    """Whether a load's rate tells all its push: not where a kind derived from a spring pushes in another way."""
    return come_from_one_class(type(item), rate, "push", "spring_rate")


def _without_inertia(dynamics, slider):
    """Load on a slider without the force of its inertia."""
    weight = scale_vector(dynamics.mechanism.links[slider].body.mass, dynamics.gravity)
    applied = (wrench.force for name, wrench in dynamics.wrenches if name == slider)
    return Wrench(reduce(add_vectors, applied, weight), dynamics.link_loads[slider].moment)

"""Energies of a scene, and the inertia that the crank feels: sums over links of squares of kinematic coefficients.

With s the mass centre of a link and theta its angle, derivatives by the crank angle phi, the kinetic energy of all
links is J omega^2 / 2 with the reduced inertia

    J = sum m |s'|^2 + I theta'^2        dJ/dphi = 2 sum m s' . s'' + I theta' theta''

(Uicker, Pennock and Shigley, *Theory of Machines and Mechanisms*, on equivalent inertia; Eksergian's equation of motion
T = J alpha + J' omega^2 / 2 + load torque).
"""

from functools import reduce

from ..machine.group import FRAME
from ..machine.links import arm, first_at, second_at, virtual_work
from ..numbers.planar import minus, plus, product, work
from .pushes import pushed, settled


def reduced_inertia(motion):
    """Reduced inertia of all links, kg m2; None without any mass."""
    return _summed(_inertia(motion.placement.links[name], link.body) for name, link in motion.mechanism.links.items())


def reduced_inertia_slope(motion):
    """Its derivative by the crank angle, kg m2; None where it does not change."""
    slopes = (_slope(motion.placement.links[name], link.body) for name, link in motion.mechanism.links.items())
    return product(2.0, _summed(slopes))


def kinetic_energy(motion):
    """Kinetic energy of all links, J."""
    square, _ = motion.accelerating
    return product(0.5 * square, reduced_inertia(motion))


def potential_energy(motion):
    """Potential energy of the loads that have one, J."""
    return _summed(item.potential(motion) for item in motion.loads if hasattr(item, "potential"))


def load_torque(motion):
    """Torque on the crank that holds weight and loads, without any inertia, N m."""
    links = motion.placement.links
    weights = (
        product(link.body.mass, work(motion.gravity, first_at(links[name], _to_centre(links[name], link.body))))
        for name, link in motion.mechanism.links.items()
    )
    return minus(None, plus(_summed(weights), motion.load_work))


def work_of(item, motion):
    """Work of a load but weight per unit of crank angle, N m; None where it does none."""
    if hasattr(item, "push"):
        return product(pushed(item, motion), motion.placement.travels[item.on].first)
    wrenches = settled(item, motion).wrenches(motion)
    links = motion.placement.links
    return _summed(virtual_work(links[name], wrench) for name, wrench in wrenches if name != FRAME)


def _summed(parts):
    return reduce(plus, parts, None)


def _to_centre(motion, body):
    return arm(motion.direction, body.along, body.across)


def _inertia(motion, body):
    first = first_at(motion, _to_centre(motion, body))
    return plus(product(body.mass, work(first, first)), product(body.inertia, product(motion.ratio, motion.ratio)))


def _slope(motion, body):
    to_centre = _to_centre(motion, body)
    moving = work(first_at(motion, to_centre), second_at(motion, to_centre))
    return plus(product(body.mass, moving), product(body.inertia, product(motion.ratio, motion.ratio_slope)))

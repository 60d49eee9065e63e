"""Energies of a scene, the reduced inertia at the crank, and the Hertz pressure of line contacts.

Let s be the mass centre of a link and theta its angle, primes derivatives by the crank angle phi. The kinetic energy of
all links is J omega^2 / 2 with the reduced (equivalent) inertia

    J = sum m |s'|^2 + I theta'^2        dJ/dphi = 2 sum m s' . s'' + I theta' theta''

(Uicker, Pennock and Shigley, *Theory of Machines and Mechanisms*; Eksergian's equation of motion
T = J alpha + J' omega^2 / 2 + load torque). A third of the mass of springs moves with their slider
(`machine.loads.slider`). Contact pressures follow from the resolved forces; `refusals` names rollers that undercut the
side of the cam that carries them.
"""

from functools import reduce

import numpy as np

from ..errors import QuantityError
from ..machine.cams import roller
from ..machine.group import FRAME
from ..machine.links import arm, first_at, second_at, virtual_work
from ..machine.loads import balance_shafts, spring_masses
from ..numbers import checks
from ..numbers.arithmetic import sign
from ..numbers.planar import minus, number_or_zero, plus, product, work
from .load_values import evaluate_load, slider_push


def reduced_inertia(motion):
    """Equivalent inertia of links, springs and shafts at the crank, (..., N), kg m2: 2 energy over speed squared."""
    links = [
        _reduced_inertia_of_link(motion.placement.links[name], link.body)
        for name, link in motion.mechanism.links.items()
    ]
    springs = [product(mass, travel.first * travel.first) for mass, travel in _moving_springs(motion)]
    return _sum([*links, *springs, *(item.crank_inertia for item in balance_shafts(motion.loads))])


def reduced_inertia_slope(motion):
    """Derivative of the reduced inertia by the crank angle, (..., N), kg m2."""
    slopes = [
        _reduced_inertia_slope_of_link(motion.placement.links[name], link.body)
        for name, link in motion.mechanism.links.items()
    ]
    slopes += [product(mass, travel.first * travel.second) for mass, travel in _moving_springs(motion)]
    return product(2.0, _sum(slopes))


def _moving_springs(motion):
    """Pairs of the mass of springs that moves with their slider, and the slider's coordinate."""
    travels = motion.placement.travels
    return [(mass.moving, travels[name]) for name, mass in spring_masses(motion.loads).items()]


def kinetic_energy(motion):
    """Kinetic energy of links, springs and balance shafts, (..., N), J."""
    square, _ = motion.accelerating
    return product(0.5 * square, reduced_inertia(motion))


def potential_energy(motion):
    """Potential energy of weight and springs, (..., N), J; the energy of weight is 0 at the height of O.

    Loads without a potential, such as process forces and dampers, contribute nothing.
    """
    return _sum(item.potential(motion) for item in motion.loads if hasattr(item, "potential"))


def load_torque(motion):
    """Torque on the crank that balances weight and loads, without inertia, (..., N), N m.

    Dampers and other loads by speed act at the scene's crank speed.

    With reduced inertia J the balancing torque is J alpha + J' omega^2 / 2 + load torque.
    """
    links = motion.placement.links
    weights = [
        product(link.body.mass, work(motion.gravity, first_at(links[name], _centre_arm(links[name], link.body))))
        for name, link in motion.mechanism.links.items()
    ]
    for name, mass in spring_masses(motion.loads).items():
        weights.append(product(mass.shaking, work(motion.gravity, links[name].joint.first)))
    return minus(None, plus(_sum(weights), motion.load_work))


def work_of(item, motion):
    """Work of a load other than weight per unit of crank angle, N m; None if it does no work."""
    if hasattr(item, "push"):
        return product(slider_push(item, motion), motion.placement.travels[item.on].first)
    wrenches = evaluate_load(item, motion).wrenches(motion)
    links = motion.placement.links
    return _sum(virtual_work(links[name], wrench) for name, wrench in wrenches if name != FRAME)


def _sum(parts):
    return reduce(plus, parts, None)


def _centre_arm(motion, body):
    """Vector from the reference joint to the mass centre, m; None where they coincide."""
    return arm(motion.direction, body.along, body.across)


def _reduced_inertia_of_link(motion, body):
    """Reduced inertia of one link, kg m2."""
    first = first_at(motion, _centre_arm(motion, body))
    return plus(product(body.mass, work(first, first)), product(body.inertia, product(motion.ratio, motion.ratio)))


def _reduced_inertia_slope_of_link(motion, body):
    """Half the derivative of the reduced inertia of one link by the crank angle, kg m2."""
    to_centre = _centre_arm(motion, body)
    moving = work(first_at(motion, to_centre), second_at(motion, to_centre))
    return plus(product(body.mass, moving), product(body.inertia, product(motion.ratio, motion.ratio_slope)))


def pressure(dynamics, name):
    """Largest Hertz pressure of a contact by name, Pa; NaN where the relative radius is negative."""
    group = next((group for group in dynamics.mechanism.groups if name in group.contacts), None)
    if group is None:
        known = [own for group in dynamics.mechanism.groups for own in group.contacts]
        title = dynamics.mechanism.name
        raise QuantityError(
            checks.choice(f"{title}: contact", name, tuple(known))
            if known
            else f"{title} has no contact pressure {name!r}: give its cam a roller, as CamRoller(cam, "
            "roller=ks.Roller(radius, width, youngs_modulus, poissons_ratio))"
        )
    touch = group.contacts[name]
    force = number_or_zero(dynamics.resolved.scalars[touch.force])
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = group.relative_radius(name, dynamics.placement, sign(force))
        return roller.pressure(force, touch.body.width, touch.body.modulus, radius)


def refusals(solution):
    """List of problems, one for each roller that undercuts the side of the cam that carries it."""
    if not solution.kind.answer(_has_contacts):
        return []
    dynamics, found = solution.dynamics, []
    contacts = [(group, *each) for group in dynamics.mechanism.groups for each in group.contacts.items()]
    for group, name, touch in contacts:
        with np.errstate(all="ignore"):
            both = [np.asarray(group.relative_radius(name, dynamics.placement, side)) for side in (-1.0, 1.0)]
            if any(part.dtype != float for part in both) or not any(np.any(part <= 0.0) for part in both):
                continue
            room = np.where(dynamics.scalar(touch.force) > 0.0, both[1], both[0])
            cut = room <= 0.0
        if not cut.any():
            continue
        worst = np.unravel_index(np.argmin(np.where(cut, room, np.inf)), cut.shape)
        radius = float(np.broadcast_to(touch.body.radius, cut.shape)[worst])
        bend = radius / (1.0 - float(room[worst]) / radius)
        angle = np.degrees(np.broadcast_to(dynamics.crank_angle, cut.shape))
        text = (
            f"the roller, radius {radius:.6g} m, undercuts the side of its cam that carries it at {cut.sum()} crank "
            f"angles from {angle[cut].min():.6g} to {angle[cut].max():.6g} deg. At {angle[worst]:.6g} deg the pitch "
            f"curve bends with a radius of {bend:.6g} m; give a smaller roller or a larger cam"
        )
        found.append(checks.Problem(text, cut))
    return found


def _has_contacts(kind):
    return any(group.contacts for group in kind.numbered.mechanism.groups)

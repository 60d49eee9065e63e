"""Forces of a scene: loads on links, reactions, balancing torque, shaking force and moment, energies, friction losses.

`Dynamics` computes them by the kernels of the groups with any kind of numbers: floats, arrays, recorded numbers,
enclosures. It imports neither engines nor solutions. The balancing torque follows from the crank's equilibrium, and
again from the balance of powers: T = -sum of powers of all loads and inertia per unit of crank angle.

Springs along a guide and the inertia of their slider are resolved together, since the two nearly balance. With s the
coordinate of a slider, e its elongation from where a spring of rate c is free, and m its mass, they give

    - w s'' - c e = - h (s'' + e) - (w - h) s'' - (c - h) e,    w = m omega^2

for any h; several springs share w equally. A group that knows the departure s'' + e to full precision leaves no
cancellation on the right where c is near w, if h is near both. Their harmonic mean does so, or for springs that push
away too h = 2 w c / (w + |c|):

    w - h = w (w - c + |c| - c) / (w + |c|),    c - h = c (|c| - w) / (w + |c|)

These keep all digits of w - c, and no term exceeds three times inertia and spring force. The force of a stiffening
spring, c = k + q e^2, counts each rounding of e three times. Let e, or its opposite, be a constant length l and a small
part p. The force is then that of a constant rate and a small rest: (k + q l^2) e + q p (2 l + p) e.
"""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from typing import Any

import numpy as np

from ..machine.group import CRANK, FRAME
from ..machine.links import Wrench, acceleration_of, load, virtual_work
from ..machine.loads import balance_shafts, spring_masses
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import come_from_one_class
from ..numbers.planar import add_vectors, minus, moment, number_or_zero, plus, product, scale_vector, subtract_vectors
from . import energy_contact, ground, shaft
from .friction import FrictionSolver, larger, smaller
from .load_values import evaluate_load, slider_push
from .motion import Motion, coordinates
from .principal_points import principal_points

MAX_POWER_ERROR = 1e-6
"""Largest difference of both balancing torques with a user's own groups, relative to the largest torque term."""
MIN_RATE = 2.0**-120
"""Rate, N/m, that guards a divisor where there is neither spring nor inertia."""


def _reading(function):
    """Property of a scene, (..., N), from a function of it that gives a number, or None for 0."""
    return property(lambda self: self._scalar(function(self)), doc=function.__doc__)


@dataclass(frozen=True, eq=False)
class Dynamics(Motion):
    """Motion and forces of a scene at its crank angles, computed on first access.

    Attributes
    ----------
    placement_method : function, optional
        ``placement_method(mechanism, crank_angle)`` replaces the groups' closed forms for the placement, for example
        by harmonic series.
    """

    placement_method: Callable[[Any, Any], Any] | None = None

    @cached_property
    def placement(self):
        """Joints and links by name, as kinematic coefficients."""
        return (self.placement_method or type(self.mechanism).place)(self.mechanism, self.crank_angle)

    @cached_property
    def resolved(self):
        """All reactions and other forces, a `Resolved`."""
        with np.errstate(divide="ignore", invalid="ignore"):
            loads, along = self.acting
            found = self.mechanism.resolve(self.placement, loads, along, self.friction_solver)
        if not self.mechanism.trusted:
            torque = self._scalar(found.scalars["balancing_torque"])
            if isinstance(torque, np.ndarray) and torque.dtype == float:
                lost = self.largest(torque - self.balancing_torque_by_power)
                scale = np.maximum(self.largest_torque_term, self.largest(torque))
                if np.any(lost > MAX_POWER_ERROR * scale):
                    warnings.warn(
                        f"{self.mechanism.name}: the balancing torque from the forces differs from that of the power "
                        f"balance by up to {np.nanmax(lost):.3g} N m, for terms of {np.nanmax(scale):.3g} N m. A group "
                        "of your own places its links or resolves its forces wrongly, see ks.check(group)",
                        stacklevel=1,
                    )
        if self.mechanism.has_unbounded_reactions:  # reactions in the crank's equilibrium grow without bound
            friction = {} if self.friction_solver is None else self.friction_solver.found
            found.scalars["balancing_torque"] = self._torque_with(friction)
        return found

    @property
    def acting(self):
        """Loads by link and forces along guides by slider; with springs of known departure including inertia."""
        loads, pushes = self.link_loads, self.pushes
        for slider in {item.on: None for item in self.loads if _is_spring(item)}:
            found = self._total_push(slider)
            if found is not None:
                weight = scale_vector(self._slider_masses(slider)[1], self.gravity)
                applied = (wrench.force for name, wrench in self.wrenches if name == slider)
                wrench = Wrench(reduce(add_vectors, applied, weight), self.link_loads[slider].moment)
                loads, pushes = loads | {slider: wrench}, pushes | {slider: found}
        return loads, pushes

    def _total_push(self, slider):
        """Force along the guide of a slider with its inertia, N; None if a departure or the mass is unknown."""
        mass, travel = self._slider_masses(slider)[0], self.placement.travels[slider]
        if mass is None:
            return None
        square, alpha = self.accelerating
        items = [item for item in self.loads if getattr(item, "on", None) == slider and hasattr(item, "push")]
        springs = [item for item in items if _is_spring(item)]
        departures = [self.departure(item) for item in springs]
        if any(part is None for part in departures):
            return None
        share = mass * square
        if len(springs) > 1:
            share = share / len(springs)
        force = minus(None, product(product(mass, alpha), travel.first))
        for item, departure in zip(springs, departures, strict=True):
            has_parts = _is_spring(item, "parted_rate")
            rate, rest = item.parted_rate(self) if has_parts else (item.spring_rate(self), None)
            size = share + abs(rate) + MIN_RATE
            w, c = share / size, rate / size
            both = 2.0 * c * share  # h, then w - h and c - h
            inertia, rate = w * ((share - rate) + (abs(rate) - rate)), c * (abs(rate) - share)
            elongation = self.elongation(item.free_position, slider)
            force = minus(force, both * departure + (inertia * travel.second + rate * elongation))
            force = minus(force, product(rest, elongation))
        others = (slider_push(item, self) for item in items if not _is_spring(item))
        return reduce(plus, others, force)

    def _slider_masses(self, slider):
        """Masses of a slider with its springs, kg: mass in its equation of motion, and mass of its weight."""
        own, springs = self.mechanism.links[slider].body.mass, spring_masses(self.loads).get(slider)
        return (own, own) if springs is None else (plus(own, springs.moving), plus(own, springs.shaking))

    def departure(self, item):
        """Departure s'' + e of a slider from simple harmonic motion, e the elongation of a spring on it, m; or None."""
        return self._of_group("departure", item)

    def outward(self, item):
        """Elongation, without sign, as a constant length and a rest, m; None if the group does not give them."""
        return self._of_group("outward", item)

    def _of_group(self, what, item):
        group = next(group for group in self.mechanism.groups if item.on in group.links)
        return getattr(group, what)(self.placement, item.free_position) if hasattr(group, what) else None

    @cached_property
    def friction_solver(self):
        """Solver of the groups with friction; None without friction."""
        return FrictionSolver(self.mechanism, self.friction, self.crank_sense) if self.friction.by_joint else None

    @cached_property
    def friction_by_joint(self):
        """Friction by joint, each a `friction.PairFriction`, of the joints that have friction."""
        return self.friction_solver.found if self.friction_solver is not None and self.resolved else {}

    def _friction_list(self, name):
        """List of the solver by name, after the forces are resolved; empty without friction."""
        return getattr(self.friction_solver, name) if self.friction_by_joint else []

    @property
    def sign_functions(self):
        """List of rates and forces (..., N) at whose zeros friction jumps or a force has a kink."""
        forces = [self.scalar(name) for name in self.mechanism.sign_forces]
        return forces + [self._scalar(part) for part in (*self._friction_list("rates"), *self._friction_list("kinks"))]

    def friction_at(self, joint):
        """Friction on the moving link of a joint, (..., N): moment of a pin, N m, else force along the pair, N."""
        found = self.friction_by_joint.get(joint)
        return self._scalar(found and minus(None, found.amount))

    def friction_loss_at(self, joint):
        """Power lost by friction at a joint, (..., N), W."""
        found = self.friction_by_joint.get(joint)
        return self._scalar(found and product(self.crank_speed, found.work))

    @property
    def friction_loss(self):
        """Power lost by friction at all joints, (..., N), W, not negative."""
        return self._scalar(product(self.crank_speed, _work_of(self.friction_by_joint)))

    @property
    def friction_torque(self):
        """Torque on the crank from friction: its loss over the crank speed, (..., N), N m."""
        return self._scalar(_work_of(self.friction_by_joint))

    @property
    def friction_margin(self):
        """Margin from jamming, 1 without friction; if it is positive, exactly one state of forces exists.

        For a single guide or pin with friction it is exactly ``1 - |kappa|``; at 0 or less there is no state or there
        are two. For several joints of a group it is a bound for all loads and senses of motion. At 0 or less one state
        may still exist, but friction is NaN.
        """
        return self._scalar(reduce(smaller, self._friction_list("margins"), 1.0))

    @property
    def friction_residual(self):
        """Change of the forces by one more pass over friction, relative to the largest of a group, (..., N)."""
        return self._scalar(reduce(larger, self._friction_list("residuals"), 0.0))

    def reaction(self, joint, at=None):
        """Reaction at a joint, (2, ..., N), N; `at`: only of the main bearing "left" or "right".

        Its sign follows from its pair: it acts on the `link` of a `machine.links.Turning` or `Sliding`.
        `machine.group.Part.outputs` describes it, and the kernel `resolve` of the group follows it.
        """
        if at is not None:
            return self.as_vector(shaft.bearing_reaction(self, joint, at))
        return self.as_vector(self._look_up("reaction", joint, self.resolved.reactions))

    def scalar(self, name):
        """A force or moment by name, (..., N)."""
        scalars = self.resolved.scalars
        found = self._look_up("quantity", name, scalars)
        if self.friction.by_joint and not hasattr(found, "shape"):  # a constant is NaN too where friction jams
            found = found + 0.0 * scalars["balancing_torque"]
        return self._scalar(found)

    def pressure(self, name):
        """Hertz pressure of a contact by name, (..., N), Pa; NaN without contact."""
        return self._scalar(energy_contact.pressure(self, name))

    @property
    def balancing_torque(self):
        """Torque on the crank that keeps the prescribed motion, from the crank's equilibrium, N m.

        From the balance of powers if the mechanism passes change points, or a crank pin comes close to a pivot.
        """
        return self.scalar("balancing_torque")

    @property
    def balancing_torque_by_power(self):
        """Balancing torque from the balance of powers, without any reaction, (..., N), N m."""
        return self._scalar(self._torque_with(self.friction_by_joint))

    def _torque_with(self, friction):
        total = minus(reduce(plus, self.powers), _work_of(friction))
        return minus(None, total) if total is not None else 0.0

    @property
    def shaking_force(self):
        """Force of the inertia of all moving masses on the frame, (2, ..., N), N."""
        found = principal_points(self.mechanism, self.loads).shaking_force(self)
        for item in balance_shafts(self.loads):
            found = found + self.as_vector(item.shaking(self).force)
        return found

    @property
    def shaking_moment(self):
        """Moment about O of the inertia of all moving masses on the frame, (..., N), N m."""
        moments = [
            plus(moment(self.placement.links[name].joint.position, wrench.force), wrench.moment)
            for name, wrench in self.inertia.items()
        ]
        moments += [moment(self.placement.links[name].joint.position, force) for name, force in self.spring_inertia]
        for force, point, couple in (item.shaking(self) for item in balance_shafts(self.loads)):
            moments += [moment(point, force), couple]
        return self._scalar(reduce(plus, moments))

    @property
    def spring_inertia(self):
        """Pairs of a slider and the inertia force of its springs on the frame, N."""
        joints = [(name, mass, self.placement.links[name].joint) for name, mass in spring_masses(self.loads).items()]
        return [
            (name, scale_vector(-mass.shaking, acceleration_of(joint.first, joint.second, *self.accelerating)))
            for name, mass, joint in joints
        ]

    @property
    def rocking_moment(self):
        """Moment about x and y through O of the inertia of all moving masses on the frame, (2, ..., N), N m."""
        return self.as_vector(shaft.rocking_moment(self))

    def shaft_torque(self, group, drive="right"):
        """Torque in the crankshaft next to the throw of a group, by its first link, (..., N), N m."""
        return self._scalar(shaft.shaft_torque(self, group, drive))

    def ground_force(self, place=None):
        """Force of the machine on the frame at a place by name, (2, ..., N), N; None: the sum of all."""
        return self.as_vector(ground.resultant(self) if place is None else ground.support(self, place).force)

    reduced_inertia = _reading(energy_contact.reduced_inertia)
    reduced_inertia_slope = _reading(energy_contact.reduced_inertia_slope)
    kinetic_energy = _reading(energy_contact.kinetic_energy)
    potential_energy = _reading(energy_contact.potential_energy)
    load_torque = _reading(energy_contact.load_torque)

    def inertia_force(self, link):
        """Inertia force of one link, minus mass times acceleration of its mass centre, (2, ..., N), N."""
        return self.as_vector(self._look_up("link", link, self.inertia).force)

    @cached_property
    def largest_torque_term(self):
        """Largest torque of a single load, N m; the balancing torque is the sum of the torques of all loads."""
        return reduce(np.maximum, (self.largest(part) for part in self.powers), 0.0)

    @cached_property
    def largest_force_term(self):
        """Largest load on one link (weight, inertia or applied), N; a reaction is a sum of loads."""
        wrenches = [*self.mass_loads.values(), *(wrench for _, wrench in (*self.spring_loads, *self.wrenches))]
        forces = [part for wrench in wrenches if wrench.force is not None for part in wrench.force]
        return reduce(np.maximum, map(self.largest, [*forces, *self.pushes.values()]), 0.0)

    @cached_property
    def inertia(self):
        """Wrench of inertia by link."""
        return {name: self._mass_load(name, None) for name in self.mechanism.links}

    @cached_property
    def mass_loads(self):
        """Wrench of inertia and weight by link; on the crank also the inertia of balance shafts."""
        found = {name: self._mass_load(name, self.gravity) for name in self.mechanism.links}
        for item in balance_shafts(self.loads):
            torque = minus(None, product(item.crank_inertia, self.accelerating[1]))
            found[CRANK] = found[CRANK].plus(Wrench(None, torque))
        return found

    @cached_property
    def spring_loads(self):
        """Pairs of a slider and the wrench on it of inertia and weight of its springs: `machine.loads.slider`."""
        return [(name, self._spring_load(name, mass)) for name, mass in spring_masses(self.loads).items()]

    def _spring_load(self, slider, mass):
        joint, square, alpha = self.placement.links[slider].joint, *self.accelerating
        inertia = acceleration_of(joint.first, joint.second, mass.moving * square, product(mass.moving, alpha))
        return Wrench(subtract_vectors(scale_vector(mass.shaking, self.gravity), inertia), None)

    @cached_property
    def link_loads(self):
        """Wrench of inertia, weight and loads by link."""
        applied = [*self.spring_loads, *self.wrenches]
        if not applied:
            return self.mass_loads
        found = dict(self.mass_loads)
        for name, wrench in applied:
            found[name] = found[name].plus(wrench)
        return found

    def _mass_load(self, link, gravity):
        body = self.mechanism.links[link].body
        return load(self.placement.links[link], body, *self.accelerating, gravity)

    @cached_property
    def wrenches(self):
        """Pairs of a link and an applied wrench on it, without those on the frame."""
        places = [place for place, item in enumerate(self.loads) if hasattr(item, "wrenches")]
        return [pair for place in places for pair in self._wrenches_of(place)]

    def _wrenches_of(self, place):
        return [pair for pair in evaluate_load(self.loads[place], self).wrenches(self) if pair[0] != FRAME]

    @cached_property
    def pushes(self):
        """Applied force along its guide by slider, N."""
        pushes: dict[str, Any] = {}
        for place, item in enumerate(self.loads):
            if hasattr(item, "push"):
                pushes[item.on] = plus(pushes.get(item.on), self._push_of(place))
        return pushes

    def _push_of(self, place):
        return slider_push(self.loads[place], self)

    @cached_property
    def powers(self):
        """Power of each load and inertia over the crank speed, N m."""
        return self._works([*self.mass_loads.items(), *self.spring_loads, *self.wrenches])

    @property
    def load_work(self):
        """Work of all loads except weight per unit of crank angle, N m; None without loads."""
        return reduce(plus, self._works(self.wrenches), None)

    def _works(self, wrenches):
        """Work per unit of crank angle of each wrench on a link, and of each push along a guide, N m."""
        links = self.placement.links
        works = [virtual_work(links[name], wrench) for name, wrench in wrenches]
        return works + [product(push, self._travel(name).first) for name, push in self.pushes.items()]

    @cached_property
    def closed(self):
        """Whether the mechanism closes, (..., N) of bool."""
        parts = (np.asarray(part, dtype=float) for part in coordinates(self.placement, self.mechanism.parts))
        return np.isfinite(reduce(plus, parts))

    def largest(self, part):
        """Largest magnitude over the angles at which the mechanism closes, (...,); NaN if it closes at none."""
        size, closed = np.broadcast_arrays(np.abs(np.asarray(number_or_zero(part), dtype=float)), self.closed)
        if not size.ndim:
            return size if closed else size * np.nan
        return np.where(closed.any(axis=-1), np.max(np.where(closed, size, 0.0), axis=-1), np.nan)


def _is_spring(item, rate="spring_rate"):
    """Whether a load's rate gives its full push; a subclass that overrides `push` alone makes the rate wrong."""
    return come_from_one_class(type(item), rate, "push", "spring_rate")


def _work_of(friction):
    """Friction loss at all joints per unit of crank angle, N m; None without friction."""
    return reduce(plus, (found.work for found in friction.values()), None)

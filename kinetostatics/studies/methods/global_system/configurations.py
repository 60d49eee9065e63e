"""Configurations: constraint equations at given coordinates, their derivatives, and what loads do there."""

import numpy as np

from ....machine.loads import Gravity, Spring
from ....mechanics.load_values import pushed, settled
from ....numbers.lazy import cached_property
from ..acting import Acting
from ..method import NotGivenError
from .applied import gap
from .constraints import ACCELERATION, FORCE, RATE
from .friction import Rubbing

SETTLED = 1e-15
"""How much forces with friction may change the last time, relative to the largest."""


class Configuration:
    """A model at coordinates q (..., 3k), whether they meet its equations or not, and crank angle phi (...)."""

    def __init__(self, model, q, phi):
        self.model, self.q, self.phi = model, q, np.asarray(phi)[..., None]
        theta = q[..., 2 * model.size :]
        self.cosine, self.sine = np.cos(theta), np.sin(theta)

    @cached_property
    def residual(self):
        """C(q, phi)."""
        model = self.model
        terms = np.concatenate([self.q, self.cosine, self.sine, np.ones_like(self.phi), self.phi], axis=-1)
        residual = terms @ model.equations.T
        for item in model.slidings:
            residual[..., item.row] = self._in_slot(item, self.q).imag - item.offset
        if model.cam is not None:
            residual[..., model.contact] = self._contact[0]
        for item in model.followings:
            residual[..., item.row] = gap(self, item).distance
        return residual

    @cached_property
    def jacobian(self):
        """J(q)."""
        model, size = self.model, self.model.size
        jacobian = np.empty((*self.q.shape, 3 * size))
        jacobian[...] = model.linear
        jacobian[..., 2 * size :] += model.of_sine * self.cosine[..., None, :]
        jacobian[..., 2 * size :] -= model.of_cosine * self.sine[..., None, :]
        for item in model.slidings:
            slot, way = jacobian[..., item.row, :], self._way(item)
            slot[..., item.block], slot[..., item.slotted] = -way.imag, way.imag
            slot[..., size + item.block], slot[..., size + item.slotted] = way.real, -way.real
            slot[..., 2 * size + item.slotted] = -self._in_slot(item, self.q).real
        if model.cam is not None:
            cam, (_, normal, _) = jacobian[..., model.contact, :], self._contact
            cam[..., model.block], cam[..., size + model.block] = normal.real, normal.imag
        for item in model.followings:
            row, found = jacobian[..., item.row, :], gap(self, item)
            for place, sign, turn in ((item.link, 1.0, found.link_turn), (item.crank, -1.0, found.crank_turn)):
                row[..., place], row[..., size + place] = sign * found.normal.real, sign * found.normal.imag
                row[..., 2 * size + place] = turn
        return jacobian

    def gamma(self, rates):
        """What J qddot must be at constant crank speed: minus the terms of Cddot without qddot."""
        model = self.model
        square = rates[..., 2 * model.size :] ** 2
        gamma = (square * self.cosine) @ model.of_cosine.T + (square * self.sine) @ model.of_sine.T
        for item in model.slidings:
            turning, slides = rates[..., 2 * model.size + item.slotted], self._in_slot(item, rates)
            gamma[..., item.row] = turning * (2 * slides.real + turning * self._in_slot(item, self.q).imag)
        if model.cam is not None:
            gamma[..., model.contact] = self._contact[2] * np.abs(self._plane(rates)[..., model.block]) ** 2
        for item in model.followings:
            gamma[..., item.row] = -gap(self, item, rates).second
        return gamma

    def solve(self, right, transposed=False):
        """Solution of J or of its transpose."""
        matrix = np.swapaxes(self.jacobian, -1, -2) if transposed else self.jacobian
        try:
            return np.linalg.solve(matrix, right[..., None])[..., 0]
        except np.linalg.LinAlgError:
            if not self.model.mechanism.change_points:
                raise
            name = self.model.mechanism.name
            raise NotGivenError(f"{name} passes change points, where constraint equations are singular") from None

    def corrected(self):
        """Coordinates after one Newton iteration."""
        return self.q - self.solve(self.residual)

    def rates(self, speed):
        """Velocities qdot."""
        return self.solve(self.model.drive * np.ones_like(self.phi)) * np.asarray(speed)[..., None]

    def accelerations(self, rates, acceleration=0.0):
        """Accelerations qddot."""
        return self.solve(self.gamma(rates) + self.model.drive * np.asarray(acceleration)[..., None])

    def demand(self, rates, accelerations, solution):
        """M qddot - Q: forces and moments at the reference joints that reactions and drive must supply."""
        model, turned = self.model, self.cosine + 1j * self.sine
        turning, turning_up = rates[..., 2 * model.size :], accelerations[..., 2 * model.size :]
        arm = model.centre * turned
        gravity = sum(complex(*item.vector) for item in solution.loads if isinstance(item, Gravity))
        force = model.mass * (self._plane(accelerations) + arm * (1j * turning_up - turning * turning) - gravity)
        moment = model.inertia * turning_up + (arm.conj() * force).imag
        for item in solution.loads:
            if hasattr(item, "push"):
                link, along = model.names.index(item.on), model.guides[item.on]
                if isinstance(item, Spring):
                    elongation = (self._plane(self.q)[..., link] * along.conjugate()).real - item.free_position
                    push = -item.stiffness * elongation - item.cubic * elongation**3
                else:
                    push = pushed(item, solution)
                force[..., link] -= push * along
            elif not isinstance(item, Gravity):
                self._take(_Acting(self, rates).of(settled(item, solution)), force, moment)
        return np.concatenate([force.real, force.imag, moment], axis=-1)

    def _take(self, effects, force, moment):
        """Take effects, forces at points of links with couples, from forces and moments at the reference joints."""
        for name, applied, at, couple in effects:
            if name in self.model.names:
                link = self.model.names.index(name)
                force[..., link] -= applied
                moment[..., link] -= couple + (np.conj(at - self._plane(self.q)[..., link]) * applied).imag

    def forces(self, rates, demand, solution):
        """Reactions, complex, scalar forces and drive torque that supply a demand, and the friction they cause."""
        readings = {name: part for name, (order, part) in self.model.readings.items() if order == FORCE}

        def solve(effects):
            force, moment = np.zeros((2, *demand.shape[:-1], self.model.size), complex)
            self._take(effects, force, moment)
            more = np.concatenate([force.real, force.imag, moment.real], axis=-1)
            return self.solve(demand + more, transposed=True)

        def named(multipliers):
            parts = {name: part @ multipliers.T for name, part in readings.items()}
            return {name: part[0] if len(part) == 1 else part[0] + 1j * part[1] for name, part in parts.items()}

        rubbing = Rubbing(_Acting(self, rates), solution)
        found = named(rubbing.settled(solve, named, lambda multipliers: np.abs(multipliers).max(), SETTLED))
        return found | {name: found[name] + force for name, force in rubbing.along(found).items() if name in found}

    def _plane(self, part):
        """The x and y of all links as complex numbers."""
        return part[..., : self.model.size] + 1j * part[..., self.model.size : 2 * self.model.size]

    def _way(self, item):
        """Direction of a slot."""
        return item.way * (self.cosine[..., item.slotted] + 1j * self.sine[..., item.slotted])

    def _in_slot(self, item, part):
        """From the slotted link's joint to that in the slot, in coordinates q or rates, along (real) and across."""
        plane = self._plane(part)
        return (plane[..., item.block] - plane[..., item.slotted]) * self._way(item).conj()

    @cached_property
    def _contact(self):
        """How far the roller centre is inside the pitch curve, the inward unit normal and the curvature there."""
        centre = self._plane(self.q)[..., self.model.block]
        distance = np.abs(centre)
        ray = centre / distance
        radius, slope, second = self.model.cam.polar(np.angle(centre), (ray.real, ray.imag))
        lean = slope / distance
        unit = np.sqrt(1.0 + lean * lean)
        curvature = (unit * unit + lean * lean - second / distance) / (distance * unit**3)
        return (radius - distance) / unit, ray * (1j * lean - 1.0) / unit, curvature


class _Acting(Acting):
    """What loads do in a configuration that moves at `rates`."""

    expj, arg, where = (staticmethod(function) for function in (lambda angle: np.exp(1j * angle), np.angle, np.where))

    def __init__(self, configuration, rates):
        self.mechanism, self._at, self._rates = configuration.model.mechanism, configuration, rates

    def number(self, value):
        return value

    def value(self, item):
        return item.value_now

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        at, index = self._at, self._at.model.names.index(link)
        axis = at.cosine[..., index] + 1j * at.sine[..., index]
        spin = self._rates[..., 2 * at.model.size + index]
        return at._plane(at.q)[..., index], axis, at._plane(self._rates)[..., index], spin


def components(model, solution, quantity, q, rates=None):
    """Components of a quantity at positions q (N, 3k), with velocities qdot of their own or those they imply."""
    order, coefficients = model.readings[quantity]
    at = Configuration(model, q, solution.crank_angle)
    found = q
    if order >= RATE:
        found = rates = at.rates(solution.crank_speed) if rates is None else rates
    if order >= ACCELERATION:
        found = at.accelerations(rates, solution.crank_acceleration)
    if order >= FORCE:
        force = at.forces(rates, at.demand(rates, found, solution), solution)[quantity]
        return (force.real, force.imag) if np.iscomplexobj(force) else (force,)
    return tuple(coefficients @ found.T)

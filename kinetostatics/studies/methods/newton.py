"""Newton iteration on the constraint equations of the whole mechanism, and all its forces from one linear system.

Every moving link has three coordinates in q: x and y of its reference joint, and its angle theta. Joints, guides,
slot, cam and drive give as many constraint equations C(q, phi) = 0 with Jacobian J = dC/dq (Nikravesh, *Computer-Aided
Analysis of Mechanical Systems*; Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*):

    J qdot = -omega dC/dphi        J qddot = gamma - alpha dC/dphi        J^T lambda = M qddot - Q

Each equation is written so that its multiplier in lambda is a reaction, signed as in the library, or the drive torque.
"""

from functools import cached_property
from typing import Any

import numpy as np

from ...machine.cam_roller import CamRoller
from ...machine.loads import Gravity, Spring
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...mechanics.pushes import pushed, settled
from ...numbers.planar import left
from .acting import Acting
from .method import Method, NotGivenError, require_one_design

STEP = np.radians(15.0)
"""Step, at most, of the table of positions from which iterations start: 24 over a turn."""
STRIDES = 4
"""Steps of continuation from one position of the table to the next."""
CLOSED = 1e-9
"""Residual, relative to the largest coordinate, of a position that is found."""
POSITION, RATE, ACCELERATION, FORCE = range(4)


class Model:
    """Constraint equations and masses of a mechanism with k links, in coordinates q (..., 3k): all x, all y, all theta.

    Apart from those of slot and cam, which the configuration fills in, the equations are linear in the terms
    (q, cos theta, sin theta, 1, phi).

    Attributes
    ----------
    equations : array (3k, 5k + 2)
        Coefficients of these terms.
    readings : dict
        By quantity: what it is read from, POSITION q, RATE qdot, ACCELERATION qddot or FORCE lambda, and the
        coefficients (components, 3k) that make it.
    """

    def __init__(self, mechanism):
        self.mechanism = mechanism
        self.names = list(mechanism.links)
        self.size = len(self.names)
        self.equations: Any = []
        self.readings: dict[str, tuple[int, Any]] = {}
        self.guides: dict[str, complex] = {}
        self.cam = None
        *self._terms, (self._one, self._phi) = np.split(np.eye(5 * self.size + 2), np.arange(1, 6) * self.size)
        self._write()
        self.equations = np.array(self.equations)
        self.linear, self.of_cosine, self.of_sine, _ = np.split(self.equations, np.arange(3, 6) * self.size, axis=1)
        self.drive = -self.equations @ self._phi
        links = mechanism.links.values()
        self.mass, self.inertia = (np.array([getattr(link, name) for link in links]) for name in ("mass", "inertia"))
        self.centre = np.array([complex(*link.centre) for link in links])

    def _write(self):
        joints = {"O": 0.0 * self._point("crank"), "A": self._point("crank", self.mechanism.crank.length or 0.0)}
        self._add("O", *self._point("crank"))
        self._add("balancing_torque", self._theta("crank") - self._phi)
        for group in self.mechanism.groups:
            if isinstance(group, CamRoller):
                joints["A"] = self._point("block")
                self.cam, self.block, self.slot = group.cam, self.names.index("block"), len(self.equations)
                self._add("slot_force", 0.0 * self._one)
                self._add("cam_force", 0.0 * self._one)
                self._add("slot_moment", self._theta("block") - self._theta("crank"))
            elif isinstance(group, SliderGroup | RockerGroup):
                coupler, end = group.links
                joints[group.pin] = self._point(end, getattr(group, "rocker_length", 0.0))
                self._add(group.on + group.label, *(self._point(coupler) - joints[group.on]))
                self._add(group.pin, *(joints[group.pin] - self._point(coupler, group.coupler_length)))
                (self._add_guide if isinstance(group, SliderGroup) else self._add_pivot)(group, end, joints)
            else:
                raise NotGivenError(f"no constraint equations are written for {type(group).__name__}")
        for name in self.names:
            turning = self._theta(name)[None, : 3 * self.size]
            self.readings |= {f"{name}_rate": (RATE, turning), f"{name}_angular_acceleration": (ACCELERATION, turning)}

    def _add_pivot(self, group, rocker, joints):
        joints[group.pivot_name] = np.multiply.outer(group.pivot, self._one)
        self._add(group.pivot_name, *(self._point(rocker) - joints[group.pivot_name]))

    def _add_guide(self, group, slider, joints):
        guide, pin = group.guide, joints[group.pin]
        along, across = np.array(guide.direction), np.array(left(guide.direction))
        self.guides[slider] = complex(*along)
        force = self._add("guide_force" + group.label, across @ pin - guide.guide_offset * self._one)
        self._add("guide_moment" + group.label, self._theta(slider) - guide.guide_angle * self._one)
        self.readings["guide" + group.label] = (FORCE, across[:, None] * force)
        for name, order in {"position": POSITION, "velocity": RATE, "acceleration": ACCELERATION}.items():
            self.readings[f"{slider}_{name}"] = (order, (along @ pin)[None, : 3 * self.size])

    def _add(self, name, *equations):
        """Add equations; their multipliers are the components of the force or moment `name`."""
        start = len(self.equations)
        self.equations += equations
        found = np.eye(3 * self.size)[start : len(self.equations)]
        self.readings[name] = (FORCE, found)
        return found

    def _point(self, link, length=0.0):
        """Point of a link at a length along it, (2, terms)."""
        x, y, _, cosine, sine = (term[self.names.index(link)] for term in self._terms)
        return np.array([x + length * cosine, y + length * sine])

    def _theta(self, link):
        return self._terms[2][self.names.index(link)]

    def start(self, angle):
        """The library's position at one crank angle as coordinates, from which continuation starts."""
        links = self.mechanism.place(np.array(angle)).links
        x, y, ahead, aside = np.array([(*links[k].joint.position, *links[k].direction) for k in self.names], float).T
        theta = np.arctan2(aside, ahead)
        return np.concatenate([x, y, theta + 2 * np.pi * np.rint((angle - theta) / (2 * np.pi))])

    def components(self, solution, quantity, q, rates=None):
        """Components of a quantity at positions q (N, 3k), with velocities qdot of their own or those they imply."""
        order, coefficients = self.readings[quantity]
        at = Configuration(self, q, solution.crank_angle)
        found = q
        if order >= RATE:
            found = rates = at.rates(solution.crank_speed) if rates is None else rates
        if order >= ACCELERATION:
            found = at.accelerations(rates, solution.crank_acceleration)
        if order >= FORCE:
            found = at.solve(at.demand(rates, found, solution), transposed=True)
        return tuple(coefficients @ found.T)


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
        if model.cam is not None:
            residual[..., model.slot] = self._sliding.imag
            residual[..., model.slot + 1] = self._contact[0]
        return residual

    @cached_property
    def jacobian(self):
        """J(q)."""
        model, size = self.model, self.model.size
        jacobian = np.empty((*self.q.shape, 3 * size))
        jacobian[...] = model.linear
        jacobian[..., 2 * size :] += model.of_sine * self.cosine[..., None, :]
        jacobian[..., 2 * size :] -= model.of_cosine * self.sine[..., None, :]
        if model.cam is not None:
            slot, cam = jacobian[..., model.slot, :], jacobian[..., model.slot + 1, :]
            x, y, (_, normal, _) = model.block, size + model.block, self._contact
            slot[..., x], slot[..., 0] = -self.sine[..., 0], self.sine[..., 0]
            slot[..., y], slot[..., size] = self.cosine[..., 0], -self.cosine[..., 0]
            slot[..., 2 * size] = -self._sliding.real
            cam[..., x], cam[..., y] = normal.real, normal.imag
        return jacobian

    def gamma(self, rates):
        """What J qddot must be at constant crank speed: minus the terms of Cddot without qddot."""
        model = self.model
        square = rates[..., 2 * model.size :] ** 2
        gamma = (square * self.cosine) @ model.of_cosine.T + (square * self.sine) @ model.of_sine.T
        if model.cam is not None:
            crank = rates[..., 2 * model.size]
            gamma[..., model.slot] = crank * (2 * self._in_slot(rates).real + crank * self._sliding.imag)
            gamma[..., model.slot + 1] = self._contact[2] * np.abs(self._plane(rates)[..., model.block]) ** 2
        return gamma

    def solve(self, right, transposed=False):
        """Solution of J or of its transpose."""
        matrix = np.swapaxes(self.jacobian, -1, -2) if transposed else self.jacobian
        return np.linalg.solve(matrix, right[..., None])[..., 0]

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
                for name, applied, at, couple in _Acting(self, rates).of(settled(item, solution)):
                    if name in model.names:
                        link = model.names.index(name)
                        force[..., link] -= applied
                        moment[..., link] -= couple
                        lever = at - self._plane(self.q)[..., link]
                        moment[..., link] -= (np.conj(lever) * applied).imag
        return np.concatenate([force.real, force.imag, moment], axis=-1)

    def _plane(self, part):
        """The x and y of all links as complex numbers."""
        return part[..., : self.model.size] + 1j * part[..., self.model.size : 2 * self.model.size]

    def _in_slot(self, part):
        """From the crank's joint to the roller centre, in coordinates q or their rates, along (real) and across."""
        plane = self._plane(part)
        return (plane[..., self.model.block] - plane[..., 0]) * (self.cosine[..., 0] - 1j * self.sine[..., 0])

    @cached_property
    def _sliding(self):
        """Position of the roller centre in the slot: its imaginary part is the slot's equation."""
        return self._in_slot(self.q)

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


def modelled(solution, quantity):
    """Model of a solution's mechanism, which gives the quantity."""
    require_one_design(solution)
    model = Model(solution.mechanism)
    if quantity not in model.readings:
        raise NotGivenError(f"the constraint equations give no {quantity}, but {', '.join(model.readings)}")
    return model


def table(model, angle):
    """Crank angles that span those given, positions q there by continuation, and velocities dq / dphi."""
    first, last = np.min(angle), np.max(angle)
    phi, step = np.linspace(first, last, 1 + STRIDES * int(np.ceil((last - first) / STEP)), retstep=True)
    q, rows = model.start(first), []
    for turned in phi:
        at = Configuration(model, q, turned)
        for _ in range(4):
            at = Configuration(model, at.corrected(), turned)
        if not np.abs(at.residual).max() < CLOSED * max(1.0, np.abs(at.q).max()):
            raise NotGivenError(f"continuation finds no position of {model.mechanism.name} at {turned:.6g} rad")
        rows.append((at.q, at.rates(1.0)))
        q = at.q + step * rows[-1][1]
    return phi[::STRIDES], *map(np.array, zip(*rows[::STRIDES], strict=True))


def _prepare(solution, quantity, iterations):
    model, angle = modelled(solution, quantity), solution.crank_angle
    phi, position, slope = table(model, angle)
    between = 0.5 * (phi[1:] + phi[:-1])

    def run():
        nearest = np.searchsorted(between, angle)
        q = position[nearest] + slope[nearest] * (angle - phi[nearest])[:, None]
        for _ in range(iterations):
            q = Configuration(model, q, angle).corrected()
        return model.components(solution, quantity, q)

    return run


METHODS = (Method("Newton iteration, global system", _prepare, "iterations", (1, 2, 3, 4, 5, 6)),)

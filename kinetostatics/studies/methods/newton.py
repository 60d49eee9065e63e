"""Newton iteration on the constraint equations of the whole mechanism, and all its forces from one linear system.

Every moving link has three coordinates in q: x and y of its reference joint, and its angle theta. Joints, guides,
slot, cam and drive give as many constraint equations C(q, phi) = 0 with Jacobian J = dC/dq (Nikravesh, *Computer-Aided
Analysis of Mechanical Systems*; Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*):

    J qdot = -omega dC/dphi        J qddot = gamma - alpha dC/dphi        J^T lambda = M qddot - Q

Each equation is written so that its multiplier in lambda is a reaction, signed as in the library, or the drive torque.
"""

from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...machine.cam_roller import CamRoller
from ...machine.cylinder_group import CylinderGroup
from ...machine.dyad import Dyad
from ...machine.group import FRAME
from ...machine.lever_group import LeverGroup
from ...machine.loads import Gravity, Spring
from ...machine.pin import Pin
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.yoke_group import YokeGroup
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


class Sliding(NamedTuple):
    """Equation `row`: the reference joint of one link stays on a straight slot of another.

    The slot runs at the angle of `way`, a complex unit vector, to the direction of its link, at `offset` to the left of
    that link's reference joint.
    """

    row: int
    slotted: int
    block: int
    way: complex
    offset: float


class Model:
    """Constraint equations and masses of a mechanism with k links, in coordinates q (..., 3k): all x, all y, all theta.

    Apart from those of slots and cam, which the configuration fills in, the equations are linear in the terms
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
        self.slidings: list[Sliding] = []
        self._held: list[tuple[str, str | None, float]] = []
        *self._terms, (self._one, self._phi) = np.split(np.eye(5 * self.size + 2), np.arange(1, 6) * self.size)
        self._write()
        self.equations = np.array(self.equations)
        self.linear, self.of_cosine, self.of_sine, _ = np.split(self.equations, np.arange(3, 6) * self.size, axis=1)
        self.drive = -self.equations @ self._phi
        links = mechanism.links.values()
        self.mass, self.inertia = (np.array([getattr(link, name) for link in links]) for name in ("mass", "inertia"))
        self.centre = np.array([complex(*link.centre) for link in links])

    def _write(self):
        self._add("O", *self._point("crank"))
        self._add("balancing_torque", self._theta("crank") - self._phi)
        for group in self.mechanism.groups:
            kinds = [kind for kind in type(group).__mro__ if kind in self._writers]
            if not kinds:
                raise NotGivenError(f"no constraint equations are written for {type(group).__name__}")
            self._writers[kinds[0]](self, group)
        for name in self.names:
            turning = self._theta(name)[None, : 3 * self.size]
            self.readings |= {f"{name}_rate": (RATE, turning), f"{name}_angular_acceleration": (ACCELERATION, turning)}

    def _write_roller(self, group):
        self.cam, self.block = group.cam, self.names.index("block")
        self._slide("slot_force", "crank", "block")
        self.contact = len(self.equations)
        self._add("cam_force", 0.0 * self._one)
        self._turn("slot_moment", "block", "crank")

    def _write_slider(self, group):
        coupler, slider = group.links
        self._pin(group.on + group.label, coupler, group.on)
        self._add(group.pin, *(self._joint(group.pin) - self._point(coupler, group.coupler_length)))
        self._add_guide(group, slider)

    def _write_rocker(self, group):
        coupler, rocker = group.links
        self._pin(group.on + group.label, coupler, group.on)
        self._add(group.pin, *(self._joint(group.pin) - self._point(coupler, group.coupler_length)))
        self._pin(group.pivot_name, rocker, group.pivot_name)

    def _write_dyad(self, group):
        first, second = group.links
        for link, joint in zip(group.links, group.on, strict=True):
            self._pin(f"{link}_{joint}", link, joint)
        self._add(group.pin, *(self._point(second, group.length2) - self._point(first, group.length1)))

    def _write_lever(self, group):
        lever, block = group.links
        self._pin(group.on + group.label, block, group.on)
        self._pin(group.pivot_name, lever, group.pivot_name)
        self._slide("slot_force" + group.label, lever, block, offset=group.offset)
        self._turn("slot_moment" + group.label, block, lever)

    def _write_cylinder(self, group):
        rod, cylinder = group.links
        self._pin(group.on + group.label, rod, group.on)
        self._pin(group.pivot_name, cylinder, group.pivot_name)
        self._slide("cylinder_force" + group.label, rod, cylinder)
        self._turn("cylinder_moment" + group.label, rod, cylinder, np.pi)

    def _write_yoke(self, group):
        block, slider = group.links
        self._add_guide(group, slider)
        self._pin(group.on + group.label, block, group.on)
        self._slide("slot_force" + group.label, slider, block, np.exp(1j * group.slot_angle))
        self._turn("slot_moment" + group.label, block, slider, group.slot_angle)

    _writers: ClassVar[dict[type, Any]] = {
        CamRoller: _write_roller,
        SliderGroup: _write_slider,
        RockerGroup: _write_rocker,
        Dyad: _write_dyad,
        LeverGroup: _write_lever,
        CylinderGroup: _write_cylinder,
        YokeGroup: _write_yoke,
        Pin: lambda self, group: None,
    }

    def _joint(self, name):
        """Joint by name, (2, terms)."""
        point = self.mechanism.joints[name]
        if point.link == FRAME:
            return np.multiply.outer((point.along, point.across), self._one)
        return self._point(point.link, point.along, point.across)

    def _pin(self, name, link, joint):
        """Hold the reference joint of a link at a joint."""
        self._add(name, *(self._point(link) - self._joint(joint)))

    def _turn(self, name, link, other, ahead=0.0):
        """Keep a link at an angle from another."""
        self._held.append((link, other, ahead))
        self._add(name, self._theta(link) - self._theta(other) - ahead * self._one)

    def _slide(self, name, slotted, block, way=1.0, offset=0.0):
        """Keep the reference joint of a link on a slot of another."""
        places = self.names.index(slotted), self.names.index(block)
        self.slidings.append(Sliding(len(self.equations), *places, way, offset))
        self._add(name, 0.0 * self._one)

    def _add_guide(self, group, slider):
        guide, pin = group.guide, self._joint(group.pin)
        self._held.append((slider, None, guide.guide_angle))
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

    def _point(self, link, along=0.0, across=0.0):
        """Point of a link at so far along it and across it, to the left, (2, terms)."""
        x, y, _, cosine, sine = (term[self.names.index(link)] for term in self._terms)
        return np.array([x + along * cosine - across * sine, y + along * sine + across * cosine])

    def _theta(self, link):
        return self._terms[2][self.names.index(link)]

    def start(self, angle):
        """The library's position at one crank angle as coordinates, from which continuation starts."""
        links = self.mechanism.place(np.array(angle)).links
        x, y, ahead, aside = np.array([(*links[k].joint.position, *links[k].direction) for k in self.names], float).T
        theta = _nearest(np.arctan2(aside, ahead), angle)
        for link, other, ahead in self._held:
            place = self.names.index(link)
            wanted = ahead + (0.0 if other is None else theta[self.names.index(other)])
            theta[place] = _nearest(theta[place], wanted)
        return np.concatenate([x, y, theta])

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
        for item in model.slidings:
            residual[..., item.row] = self._in_slot(item, self.q).imag - item.offset
        if model.cam is not None:
            residual[..., model.contact] = self._contact[0]
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


def _nearest(angle, wanted):
    """The angle less or plus whole turns, next to another."""
    return angle + 2 * np.pi * np.rint((wanted - angle) / (2 * np.pi))


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

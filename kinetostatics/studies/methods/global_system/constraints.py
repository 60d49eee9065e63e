"""Constraint equations of a whole mechanism: motion from their derivatives, all forces from one linear system.

Every moving link has three coordinates in q: x and y of its reference joint, and its angle theta. Joints, guides,
slots, cams and the drive give the same number of equations C(q, phi) = 0. Their Jacobian is J = dC/dq (Nikravesh,
*Computer-Aided Analysis of Mechanical Systems*; Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*):

    J qdot = -omega dC/dphi        J qddot = gamma - alpha dC/dphi        J^T lambda = M qddot - Q

Each equation is signed so that its multiplier in lambda is a reaction as the library gives it, or the drive torque.
Slots and cams give nonlinear equations, each with its `terms`: the distance from a slot or pitch curve stays zero.
"""

from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ....errors import NotGivenError
from ....machine.followers.translating import FlatFollower
from ....machine.group import FRAME, RATES, TRAVELS
from ....machine.loads import Gravity
from ....numbers.lazy import cached_property
from ....numbers.planar import left
from ..structures import FrictionForces, LoadForces, cross, dot, structure

MAX_FOOT_ITERATIONS = 30


class CurvedTerms(NamedTuple):
    """A nonlinear equation at given coordinates: its value, derivatives by coordinates, and second derivative.

    `parts` are tuples of a link's number, derivatives by its x and y as a complex number, and derivative by its angle.
    `second` is the second derivative without accelerations, if velocities are given.
    """

    value: Any
    parts: Any
    second: Any


class ContactEquation(NamedTuple):
    """Equation `row`: the point of a link at `along` stays on a curve of another link, `base`, or of the frame (None).

    ``curve(place, turned)`` gives the curve's point nearest to a place and its two derivatives, complex numbers in the
    axes of the base, which is turned by an angle. The value is the distance to the left of the curve.
    """

    row: int
    base: int | None
    link: int
    along: Any
    curve: Any

    def terms(self, at, rates=None):
        origin, ray, drift, turning, turned = at.body(self.base, rates)
        joint, axis, moving, own, _ = at.body(self.link, rates)
        arm = self.along * axis * np.conj(ray)
        apart = (joint - origin) * np.conj(ray) + arm
        speed = (moving - drift) * np.conj(ray) + 1j * own * arm
        centre, first, second = self.curve(apart, turned)
        tangent = first / np.abs(first)
        normal = 1j * tangent
        curvature = -cross(first, second) / np.abs(first) ** 3
        rest = -(own**2) * arm - 2j * turning * speed - turning**2 * apart
        bending = curvature * dot(tangent, speed - 1j * turning * apart) ** 2
        out = normal * ray
        parts = [(self.link, out, dot(normal, 1j * arm))]
        if self.base is not None:
            parts.append((self.base, -out, dot(normal, -1j * apart)))
        return CurvedTerms(dot(normal, apart - centre), parts, dot(normal, rest) + bending)


def fixed_pitch_curve(cam, place, turned):
    """Pitch curve of a fixed cam, at the polar angle of the place."""
    ray = place / np.abs(place)
    radius, slope, second = cam.polar(np.angle(place), (ray.real, ray.imag))
    return radius * ray, (slope + 1j * radius) * ray, (second - radius + 2j * slope) * ray


def turning_pitch_curve(disk, place, turned):
    """Pitch curve of a cam on the crank, at the foot of the perpendicular from the place."""
    for _ in range(MAX_FOOT_ITERATIONS):
        centre, first, second = disk.curve(turned)
        off = place - centre
        turned = turned - dot(off, first) / (dot(off, second) - np.abs(first) ** 2)
    return disk.curve(turned)


class FlatFollowerEquation(NamedTuple):
    """Equation `row`: the flat face of a link at `along` touches a cam that turns with the crank."""

    row: int
    crank: int
    link: int
    along: Any
    group: Any

    def terms(self, at, rates=None):
        origin, _, drift, turning, turned = at.body(self.crank, rates)
        joint, axis, moving, own, angle = at.body(self.link, rates)
        height = (joint - origin) * np.conj(axis) + self.along
        aside = (moving - drift) * np.conj(axis) + 1j * own * self.along
        law = self.group.cam.law(turned - angle + self.group.guide.guide_angle)
        second = 2.0 * own * aside.imag - own**2 * height.real - law.acceleration * (turning - own) ** 2
        parts = (self.link, axis, height.imag + law.velocity), (self.crank, -axis, -law.velocity)
        return CurvedTerms(height.real - law.position, parts, second)


POSITION, RATE, ACCELERATION, FORCE = range(4)


class Model:
    """Constraint equations and masses of a mechanism with k links, in coordinates q (..., 3k): all x, all y, all theta.

    The equations are linear in the terms (q, cos theta, sin theta, 1, phi), except `curved`, of slots and cams.
    `equations` (3k, 5k + 2) are the coefficients of these terms. `readings` map a quantity to its source, POSITION q,
    RATE qdot, ACCELERATION qddot or FORCE lambda, and the coefficients (components, 3k) of the source.
    """

    def __init__(self, mechanism):
        self.mechanism = mechanism
        self.names = list(mechanism.links)
        self.size = len(self.names)
        self.equations: Any = []
        self.readings: dict[str, tuple[int, Any]] = {}
        self.guides: dict[str, complex] = {}
        self.curved: list[ContactEquation | FlatFollowerEquation] = []
        self._held: list[tuple[str, str | None, float]] = []
        *self._terms, (self._one, self._phi) = np.split(np.eye(5 * self.size + 2), np.arange(1, 6) * self.size)
        self._add("O", *self._point("crank"))
        self._add("balancing_torque", self._theta("crank") - self._phi)
        made, self.numbers = structure(mechanism)
        bars = {(end, link) for part in made.parts for _, end, link in part.bars}
        for part, group in zip(made.parts[1:], mechanism.groups, strict=True):
            for name, pin in part.pins:
                one, other = (self._on(link, pin.joint, bars) for link in (pin.link, pin.against))
                self._add(name, *(one - other))
            for name, pair in part.slides:
                if pair.against == FRAME:
                    self._guide(name, pair)
                else:
                    self._slot(pair, pair.link in part.rods)
            for cam in part.cams:
                self._cam(cam, group)
        for name in self.names:
            turning = self._theta(name)[None, : 3 * self.size]
            self.readings |= {name + ending: (order, turning) for order, ending in enumerate(RATES, RATE)}
        self.equations = np.array(self.equations)
        self.linear, self.of_cosine, self.of_sine, _ = np.split(self.equations, np.arange(3, 6) * self.size, axis=1)
        self.drive = -self.equations @ self._phi
        links = mechanism.links.values()
        self.mass, self.inertia = (np.array([getattr(link, name) for link in links]) for name in ("mass", "inertia"))
        self.centre = np.array([complex(*link.centre) for link in links])

    def _joint(self, name):
        """Joint by name, (2, terms)."""
        point = self.mechanism.joints[name]
        if point.link == FRAME:
            return np.multiply.outer((point.along, point.across), self._one)
        return self._point(point.link, point.along, point.across)

    def _on(self, link, joint, bars):
        """Joint as a point of a link, (2, terms)."""
        point = self.mechanism.joints[joint]
        if point.link == link or (joint, link) not in bars:
            return self._joint(joint) if self.mechanism.references.get(link) != joint else self._point(link)
        return self._point(link, self.numbers[f"{link}_length"])

    def _slot(self, item, is_rod):
        """Keep a link in the slot of another; a rod in reverse."""
        place = f"{item.against}_{item.joint}"
        offset, angle = self.numbers[f"{place}_offset"], self.numbers[f"{place}_angle"]
        ends = (item.link, item.against) if is_rod else (item.against, item.link)
        slotted, block = (self.names.index(name) for name in ends)
        way = np.exp(1j * angle)
        self._curve(
            item.force, ContactEquation, slotted, block, 0.0, lambda place, turned: (1j * way * offset, way, 0.0)
        )
        ahead = angle + (np.pi if is_rod else 0.0)
        self._held.append((item.link, item.against, ahead))
        self._add(item.couple, self._theta(item.link) - self._theta(item.against) - ahead * self._one)

    def _cam(self, cam, group):
        """Keep a link on a cam, fixed or turning with the crank."""
        link = self.names.index(cam.link)
        if cam.body == FRAME:
            self._curve(cam.force, ContactEquation, None, link, 0.0, partial(fixed_pitch_curve, group.cam))
            return
        crank, along = self.names.index(cam.body), self.numbers[f"{cam.joint}_along"]
        if isinstance(group, FlatFollower):
            self._curve(cam.force, FlatFollowerEquation, crank, link, along, group)
        else:
            self._curve(cam.force, ContactEquation, crank, link, along, partial(turning_pitch_curve, group.disk))

    def _curve(self, force, kind, *data):
        """Add a nonlinear equation, whose multiplier is a force."""
        self.curved.append(kind(len(self.equations), *data))
        self._add(force, 0.0 * self._one)

    def _guide(self, name, item):
        slider = item.link
        guide, pin = self.mechanism.guides[slider], self._joint(item.joint)
        self._held.append((slider, None, guide.guide_angle))
        along, across = np.array(guide.direction), np.array(left(guide.direction))
        self.guides[slider] = complex(*along)
        force = self._add(item.force, across @ pin - guide.guide_offset * self._one)
        self._add(item.couple, self._theta(slider) - guide.guide_angle * self._one)
        self.readings[name] = (FORCE, across[:, None] * force)
        for order, ending in enumerate(TRAVELS):
            self.readings[slider + ending] = (order, (along @ pin)[None, : 3 * self.size])

    def _add(self, name, *equations):
        """Add equations; their multipliers are the components of the force or moment `name`."""
        start = len(self.equations)
        self.equations += equations
        found = np.eye(3 * self.size)[start : len(self.equations)]
        self.readings[name] = (FORCE, found)
        return found

    def _point(self, link, along=0.0, across=0.0):
        """Point of a link, by distances along it and to its left, (2, terms)."""
        x, y, _, cosine, sine = (term[self.names.index(link)] for term in self._terms)
        return np.array([x + along * cosine - across * sine, y + along * sine + across * cosine])

    def _theta(self, link):
        return self._terms[2][self.names.index(link)]

    def start(self, angle):
        """Coordinates q of the library's position at one crank angle, to start continuation."""
        links = self.mechanism.place(np.array(angle)).links
        x, y, ahead, aside = np.array([(*links[k].joint.position, *links[k].direction) for k in self.names], float).T
        theta = _nearest_angle(np.arctan2(aside, ahead), angle)
        for link, other, ahead in self._held:
            place = self.names.index(link)
            wanted = ahead + (0.0 if other is None else theta[self.names.index(other)])
            theta[place] = _nearest_angle(theta[place], wanted)
        return np.concatenate([x, y, theta])


def _nearest_angle(angle, wanted):
    """The angle, shifted by whole turns to be nearest to another."""
    return angle + 2 * np.pi * np.rint((wanted - angle) / (2 * np.pi))


FRICTION_TOLERANCE = 1e-15
"""Largest last change of forces with friction, relative to the largest force."""


class Configuration:
    """A model at coordinates q (..., 3k), which need not satisfy its equations, and crank angles phi (...)."""

    def __init__(self, model, q, phi):
        self.model, self.q, self.phi = model, q, np.asarray(phi)[..., None]
        theta = q[..., 2 * model.size :]
        self.cosine, self.sine = np.cos(theta), np.sin(theta)
        self.axes = self.cosine + 1j * self.sine

    @cached_property
    def curved(self):
        return [(item.row, item.terms(self)) for item in self.model.curved]

    @cached_property
    def residual(self):
        """C(q, phi)."""
        model = self.model
        terms = np.concatenate([self.q, self.cosine, self.sine, np.ones_like(self.phi), self.phi], axis=-1)
        residual = terms @ model.equations.T
        for row, terms in self.curved:
            residual[..., row] = terms.value
        return residual

    @cached_property
    def jacobian(self):
        """J(q)."""
        model, size = self.model, self.model.size
        jacobian = np.empty((*self.q.shape, 3 * size))
        jacobian[...] = model.linear
        jacobian[..., 2 * size :] += model.of_sine * self.cosine[..., None, :]
        jacobian[..., 2 * size :] -= model.of_cosine * self.sine[..., None, :]
        for row, terms in self.curved:
            for link, normal, turn in terms.parts:
                jacobian[..., row, link], jacobian[..., row, size + link] = normal.real, normal.imag
                jacobian[..., row, 2 * size + link] = turn
        return jacobian

    def gamma(self, rates):
        """Right side of J qddot = gamma at constant crank speed: minus the terms of Cddot without qddot."""
        model = self.model
        square = rates[..., 2 * model.size :] ** 2
        gamma = (square * self.cosine) @ model.of_cosine.T + (square * self.sine) @ model.of_sine.T
        for item in model.curved:
            gamma[..., item.row] = -item.terms(self, rates).second
        return gamma

    def damped_gamma(self, rates, speed, damping):
        """Right side with Baumgarte's terms, by which the errors of positions and rates decay."""
        right = self.gamma(rates)
        if damping:
            right = right - 2.0 * damping * (self.jacobian @ rates - self.model.drive * speed)
            right = right - damping * damping * self.residual
        return right

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

    def newton_step(self):
        """Coordinates after one Newton iteration."""
        return self.q - self.solve(self.residual)

    def rates(self, speed):
        """Velocities qdot."""
        return self.solve(self.model.drive * np.ones_like(self.phi)) * np.asarray(speed)[..., None]

    def demand(self, rates, accelerations, solution):
        """M qddot - Q: forces and moments at the reference joints that reactions and drive must supply."""
        model = self.model
        turning, turning_up = rates[..., 2 * model.size :], accelerations[..., 2 * model.size :]
        arm = model.centre * self.axes
        gravity = sum(complex(*item.vector) for item in solution.loads if isinstance(item, Gravity))
        force = model.mass * (self.plane(accelerations) + arm * (1j * turning_up - turning * turning) - gravity)
        moment = model.inertia * turning_up + cross(arm, force)
        own = np.concatenate([force.real, force.imag, moment], axis=-1)
        return own - self._generalised(_LoadForces(self, rates, solution).effects())

    def _generalised(self, effects):
        """Forces and moments at the reference joints, (..., 3k), of effects of loads or friction."""
        joints = self.plane(self.q)
        force, moment = np.zeros_like(joints), np.zeros(joints.shape)
        for name, applied, at, couple in effects:
            if name in self.model.names:
                link = self.model.names.index(name)
                force[..., link] += applied
                moment[..., link] += couple + cross(at - joints[..., link], applied)
        return np.concatenate([force.real, force.imag, moment], axis=-1)

    def forces(self, rates, demand, solution):
        """Complex reactions, scalar forces and the drive torque that balance a demand, with friction."""
        readings = {name: part for name, (order, part) in self.model.readings.items() if order == FORCE}

        def solve(effects):
            return self.solve(demand - self._generalised(effects), transposed=True)

        def named(multipliers):
            parts = {name: part @ multipliers.T for name, part in readings.items()}
            return {name: part[0] if len(part) == 1 else part[0] + 1j * part[1] for name, part in parts.items()}

        friction = FrictionForces(_LoadForces(self, rates, solution))
        multipliers = friction.converge(solve, named, lambda found: np.abs(found).max(), FRICTION_TOLERANCE)
        found = named(multipliers)
        return found | {name: found[name] + force for name, force in friction.along(found).items() if name in found}

    def body(self, link, rates=None):
        """Joint, axis, velocity of the joint, angular velocity and angle of a link by number; None is the frame."""
        if link is None:
            return 0.0, 1.0, 0.0, 0.0, 0.0
        rates, place = np.zeros(3 * self.model.size) if rates is None else rates, 2 * self.model.size + link
        joint, moving = (self.plane(part)[..., link] for part in (self.q, rates))
        return joint, self.axes[..., link], moving, rates[..., place], self.q[..., place]

    def plane(self, part):
        """The x and y of all links as complex numbers."""
        return part[..., : self.model.size] + 1j * part[..., self.model.size : 2 * self.model.size]


class _LoadForces(LoadForces):
    """Loads in a configuration with velocities `rates`."""

    def __init__(self, configuration, rates, solution):
        self.mechanism, self.solution, self._at, self._rates = solution.mechanism, solution, configuration, rates

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        return self._at.body(self._at.model.names.index(link), self._rates)[:-1]


def components(model, solution, quantity, q, rates=None):
    """Components of a quantity at positions q (N, 3k), with given velocities, or those implied by the positions."""
    order, coefficients = model.readings[quantity]
    at = Configuration(model, q, solution.crank_angle)
    found = q
    if order >= RATE:
        found = rates = at.rates(solution.crank_speed) if rates is None else rates
    if order >= ACCELERATION:
        found = at.solve(at.gamma(rates) + model.drive * np.asarray(solution.crank_acceleration)[..., None])
    if order >= FORCE:
        force = at.forces(rates, at.demand(rates, found, solution), solution)[quantity]
        return (force.real, force.imag) if np.iscomplexobj(force) else (force,)
    return tuple(coefficients @ found.T)


def integrate(slopes, span, start, method, asked, rtol, atol):
    """States (components, N) at given times, by SciPy's integrators."""
    from scipy.integrate import solve_ivp

    found = solve_ivp(slopes, span, start, method, asked, rtol=rtol, atol=atol)
    if found.status < 0:
        raise NotGivenError(f"integration stops: {found.message}")
    return found.y

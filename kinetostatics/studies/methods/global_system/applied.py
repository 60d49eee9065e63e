"""What loads put on links besides their weight, as arguments of equations that were made without them.

Plain numbers, of springs too, are known once; tables and functions, which read the library's motion as a user's own
would read theirs, and loads at points are computed each time.

Constraint equations of followers on a cam that turns with the crank: the distance from its pitch curve is zero.

The roller centre p, seen from the crank, is at C = n . (p - c) outside the nearest point c of the pitch curve. The unit
normal n there is the derivative of C by p, and kappa t t^T, with the curvature of the curve, the second. A flat face
keeps the distance h(psi) from O, by the angle psi of the cam from the face's normal. Multipliers are contact forces.
"""

from typing import Any, NamedTuple

import numpy as np

from ....machine.followers.flat import FlatFollower
from ....machine.loads import Gravity, ProcessForce, Spring
from ....mechanics.load_values import pushed, settled
from ..acting import Acting

PARTS = "x", "y", "moment"


class Applied(Acting):
    """Loads of a solution. Called, it gives by name what depends on the motion; ``numbers`` are the others.

    Under a link's name with "_load_x", "_load_y", "_load_moment" are force and moment about its reference joint, under
    a slider's with "_push" the force along its guide, with "_stiffness", "_free" and "_cubic" the numbers of a spring.

    Parameters
    ----------
    solution : Solution
    result : function
        ``result(name)`` is a function that computes a result of the equations' own motion.
    """

    expj, arg, where = (staticmethod(function) for function in (lambda angle: np.exp(1j * angle), np.angle, np.where))

    def __init__(self, solution, result):
        self.solution, self.mechanism = solution, solution.mechanism
        links, sliders, loads = self.mechanism.links, self.mechanism.guides, solution.loads
        self.numbers: dict[str, Any] = {f"{link}_load_{part}": 0 for link in links for part in PARTS}
        self.numbers |= {f"{slider}_{part}": 0 for slider in sliders for part in ("push", "stiffness", "free", "cubic")}
        pushes = [item for item in loads if hasattr(item, "push")]
        self.springs, self.pushes = [], []
        for item in pushes:
            if isinstance(item, Spring):
                self.springs.append(item)
            elif isinstance(item, ProcessForce) and isinstance(item.force, int | float):
                self.numbers[f"{item.on}_push"] += item.force
            else:
                self.pushes.append(item)
        for item in {item.on: item for item in reversed(self.springs)}.values():
            parts = {"stiffness": item.stiffness, "free": item.free_position, "cubic": item.cubic}
            self.numbers |= {f"{item.on}_{part}": value for part, value in parts.items()}
            self.springs.remove(item)
        self.others = [item for item in loads if not hasattr(item, "push") and not isinstance(item, Gravity)]
        self.travels = {item.on: result(f"{item.on}_position") for item in self.springs}
        self.motions = {link: result(f"{link} in motion") for link in links} if self.others else {}
        self.fixed = self.numbers
        moving = self()
        self.numbers = {name: value for name, value in self.fixed.items() if name not in moving}

    def __call__(self):
        found: dict[str, Any] = {}

        def add(name, amount):
            found[name] = found.get(name, self.fixed[name]) + amount

        for item in self.springs:
            (travel,) = self.travels[item.on]()
            away = travel - item.free_position
            add(f"{item.on}_push", -item.stiffness * away - item.cubic * away**3)
        for item in self.pushes:
            add(f"{item.on}_push", pushed(item, self.solution))
        self.places = {link: run() for link, run in self.motions.items()}
        for item in self.others:
            for link, force, at, couple in self.of(settled(item, self.solution)):
                if link in self.places:
                    turning = couple + np.imag(np.conj(at - self.at(link)[0]) * force)
                    for part, amount in zip(PARTS, (np.real(force), np.imag(force), turning), strict=True):
                        add(f"{link}_load_{part}", amount)
        return found

    def number(self, value):
        return value

    def value(self, item):
        return item.value_now

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        x, y, cosine, sine, to_x, to_y, spin = self.places[link]
        return x + 1j * y, cosine + 1j * sine, to_x + 1j * to_y, spin


ITERATIONS = 30


class Following(NamedTuple):
    """Equation `row`: a point of a link, so far along it, stays on the cam of a group that is fixed to the crank."""

    row: int
    crank: int
    link: int
    along: Any
    group: Any


class Gap(NamedTuple):
    """A distance, its derivatives by the coordinates of link and crank, x and y as one, and its second terms."""

    distance: Any
    normal: Any
    link_turn: Any
    crank_turn: Any
    second: Any


def gap(at, item, rates=None):
    """How far a follower is off its cam in a configuration, and with velocities its acceleration by them alone."""
    k = at.model.size
    spins = [0.0 if rates is None else rates[..., 2 * k + place] for place in (item.crank, item.link)]
    ray, axis = (at.cosine[..., place] + 1j * at.sine[..., place] for place in (item.crank, item.link))
    plane = at._plane(at.q)
    arm = item.along * axis
    apart = plane[..., item.link] + arm - plane[..., item.crank]
    speed: Any = 0.0
    if rates is not None:
        moving = at._plane(rates)
        speed = moving[..., item.link] + 1j * spins[1] * arm - moving[..., item.crank]
    turned = at.q[..., 2 * k + item.crank]
    if isinstance(item.group, FlatFollower):
        return _of_face(item, turned - at.q[..., 2 * k + item.link], apart, speed, axis, spins)
    return _of_roller(item, turned, (apart, speed, arm), ray, spins)


def _of_face(item, psi, apart, speed, axis, spins):
    angle = psi + item.group.guide.guide_angle
    law = item.group.cam.law(angle)
    height, aside = apart * axis.conj(), speed * axis.conj()
    turning, face = spins
    second = 2.0 * face * np.imag(aside) - face**2 * height.real - law.acceleration * (turning - face) ** 2
    return Gap(height.real - law.position, axis, height.imag + law.velocity, -law.velocity, second)


def _of_roller(item, turned, moved, ray, spins):
    apart, speed, arm = (part * ray.conj() for part in moved)
    disk, phi = item.group.disk, turned
    for _ in range(ITERATIONS):
        centre, first, second = disk.curve(phi)
        off = apart - centre
        phi = phi - _dot(off, first) / (_dot(off, second) - np.abs(first) ** 2)
    centre, first, second = disk.curve(phi)
    tangent = first / np.abs(first)
    normal = 1j * tangent
    curvature = -(np.conj(first) * second).imag / np.abs(first) ** 3
    turning, own = spins
    passing = speed - 1j * turning * apart
    rest = -(own**2) * arm - 2j * turning * speed - turning**2 * apart
    return Gap(
        _dot(normal, apart - centre),
        normal * ray,
        _dot(normal, 1j * arm),
        _dot(normal, -1j * apart),
        _dot(normal, rest) + curvature * _dot(tangent, passing) ** 2,
    )


def _dot(a, b):
    return (np.conj(a) * b).real

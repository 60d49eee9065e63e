"""Motion with friction from Newton's equations of all bodies, by `solve_ivp`; nothing here is of the package.

Positions are series of second order in the crank angle; the equations of all bodies are solved at once for the crank
acceleration and all joint forces, with friction given, and friction is computed anew until nothing changes.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp


class Series(NamedTuple):
    """A value with its first and second derivative by the crank angle."""

    value: float
    first: float = 0.0
    second: float = 0.0

    __array_ufunc__ = None  # numbers of NumPy leave arithmetic to it

    def __add__(self, other):
        other = _series(other)
        return Series(self.value + other.value, self.first + other.first, self.second + other.second)

    def __mul__(self, other):
        a, b = self, _series(other)
        second = a.second * b.value + 2.0 * a.first * b.first + a.value * b.second
        return Series(a.value * b.value, a.first * b.value + a.value * b.first, second)

    __radd__, __rmul__ = __add__, __mul__

    def __sub__(self, other):
        return self + -1.0 * _series(other)

    def __rsub__(self, other):
        return -1.0 * self + other

    def power(self, exponent):
        """The same to a constant exponent."""
        v, n = self.value, exponent
        slope, bend = n * v ** (n - 1.0), n * (n - 1.0) * v ** (n - 2.0)
        return Series(v**n, slope * self.first, bend * self.first**2 + slope * self.second)


def _series(value):
    return value if isinstance(value, Series) else Series(value)


class Body(NamedTuple):
    """Mass, inertia about the mass centre, its place (x, y), and the unit direction of the body."""

    mass: float
    inertia: float
    centre: tuple
    direction: tuple


class Pin(NamedTuple):
    """A pin at a point with mu times radius; `against` None is the frame."""

    on: str
    against: str | None
    at: tuple
    lever: float = 0.0


class Slide(NamedTuple):
    """A sliding joint at a point of `on`, along a direction, with its coefficient and half length of the shoe."""

    on: str
    against: str | None
    at: tuple
    along: tuple
    mu: float = 0.0
    half: float | None = None


class Machine(NamedTuple):
    """Bodies, joints, forces (body, point, force), torques (body, torque), and inertia on the crank."""

    bodies: dict
    joints: list
    forces: list
    torques: list
    flywheel: float


def ray(angle):
    c, s = math.cos(angle), math.sin(angle)
    return Series(c, -s, -c), Series(s, c, -s)


def ratio(direction):
    """Angular velocity and acceleration of a direction by the crank angle."""
    c, s = direction
    return c.value * s.first - s.value * c.first, c.value * s.second - s.value * c.second


def forces(machine, speed):
    """Crank acceleration, and what friction takes, W, with the crank at a speed that is not 0."""
    names = list(machine.bodies)
    width = 1 + sum(2 for _ in machine.joints)
    matrix, right = np.zeros((3 * len(names), width)), np.zeros(3 * len(names))

    def put(column, body, at, force, couple=0.0, sign=1.0):
        """A force at a point and a couple on a body, as coefficients of an unknown, or on the right if None."""
        if body is None:
            return
        row, centre = 3 * names.index(body), machine.bodies[body].centre
        moment = couple
        if at is not None:
            moment += (at[0].value - centre[0].value) * force[1] - (at[1].value - centre[1].value) * force[0]
        for place, part in enumerate((*force, moment)):
            if column is None:
                right[row + place] -= sign * part
            else:
                matrix[row + place, column] += sign * part

    for number, (name, body) in enumerate(machine.bodies.items()):
        turn, bend = ratio(body.direction)
        inertia = body.inertia + (machine.flywheel if name == "crank" else 0.0)
        for place, (mass, part) in enumerate(((body.mass, body.centre[0]), (body.mass, body.centre[1]))):
            matrix[3 * number + place, 0] = -mass * part.first
            right[3 * number + place] = mass * part.second * speed**2
        matrix[3 * number + 2, 0], right[3 * number + 2] = -inertia * turn, inertia * bend * speed**2
    for body, at, force in machine.forces:
        put(None, body, at, force)
    for body, torque in machine.torques:
        put(None, body, None, (0.0, 0.0), torque)
    for number, joint in enumerate(machine.joints):
        column = 1 + 2 * number
        if isinstance(joint, Pin):
            pairs = (((1.0, 0.0), 0.0), ((0.0, 1.0), 0.0))
        else:
            x, y = (part.value for part in joint.along)
            pairs = (((-y, x), 0.0), ((0.0, 0.0), 1.0))
        for place, (force, couple) in enumerate(pairs):
            put(column + place, joint.on, joint.at, force, couple)
            put(column + place, joint.against, joint.at, force, couple, -1.0)
    frictionless, found = right.copy(), None
    for _ in range(200):
        before, found = found, np.linalg.solve(matrix, right)
        if before is not None and np.abs(found - before).max() <= 1e-14 * np.abs(found).max():
            break
        right[:] = frictionless
        loss = 0.0
        for number, joint in enumerate(machine.joints):
            first, second = found[1 + 2 * number : 3 + 2 * number]
            rate = speed * _rate(machine, joint)
            way = math.copysign(1.0, rate)
            if isinstance(joint, Pin):
                amount = joint.lever * math.hypot(first, second)
                force, couple = (0.0, 0.0), -way * amount
            else:
                size = abs(first) if joint.half is None else max(abs(first), abs(second) / joint.half)
                amount = joint.mu * size
                force, couple = tuple(-way * amount * part.value for part in joint.along), 0.0
            loss += amount * abs(rate)
            put(None, joint.on, joint.at, force, couple)
            put(None, joint.against, joint.at, force, couple, -1.0)
    return found[0], loss


def _rate(machine, joint):
    """How fast a joint turns or slides, by the crank angle."""
    own, other = (0.0 if name is None else ratio(machine.bodies[name].direction)[0] for name in joint[:2])
    if isinstance(joint, Pin):
        return own - other
    x, y = joint.along
    if joint.against is None:
        return joint.at[0].first * x.value + joint.at[1].first * y.value
    return joint.at[0].first * x.value + joint.at[1].first * y.value  # the lever turns about a point of its axis


def moved(machine_at, angle, speed, times):
    """Crank angle, speed, and energy lost by friction at times, while the crank does not stop."""

    def change(time, state):
        acceleration, loss = forces(machine_at(float(state[0]), float(state[1])), float(state[1]))
        return state[1], acceleration, loss

    found = solve_ivp(change, (0.0, times[-1]), (angle, speed, 0.0), "DOP853", t_eval=times, rtol=1e-11, atol=1e-11)
    return found.y


def crank_slider(radius, length, crank, coupler, slider, friction, push=None, offset=0.0, torque=None, flywheel=0.0):
    """A machine by crank angle and speed; links are (mass, along, inertia), `friction` by joint, gravity along -y.

    `push` is the force on the slider by its coordinate, `torque` that on the crank by its speed.
    """

    def at(angle, speed):
        c, s = ray(angle)
        pin = (radius * c, radius * s)
        across = (offset - pin[1]) * (1.0 / length)
        down = (1.0 - across * across).power(0.5)
        rod = (down, across)
        end = (pin[0] + length * down, Series(offset))
        still = (Series(1.0), Series(0.0))
        bodies = {
            "crank": _body(crank, (Series(0.0), Series(0.0)), (c, s)),
            "coupler": _body(coupler, pin, rod),
            "slider": _body(slider, end, still),
        }
        joints = [
            Pin("crank", None, (Series(0.0), Series(0.0)), friction.get("O", 0.0)),
            Pin("coupler", "crank", pin, friction.get("A", 0.0)),
            Pin("slider", "coupler", end, friction.get("B", 0.0)),
            Slide("slider", None, end, still, *friction.get("guide", (0.0, None))),
        ]
        loads = [(name, body.centre, (0.0, -9.81 * body.mass)) for name, body in bodies.items()]
        loads += [("slider", end, (push(end[0].value), 0.0))] if push else []
        return Machine(bodies, joints, loads, [("crank", torque(speed))] if torque else [], flywheel)

    return at


def slotted_lever(radius, pivot, crank, lever, friction, torque=0.0, flywheel=0.0):
    """The same of a lever whose slot holds a block without mass on the crank pin; `torque` acts on the lever."""

    def at(angle, speed):
        c, s = ray(angle)
        pin, foot = (radius * c, radius * s), (Series(pivot[0]), Series(pivot[1]))
        x, y = pin[0] - foot[0], pin[1] - foot[1]
        over = (x * x + y * y).power(-0.5)
        axis = (x * over, y * over)
        bodies = {
            "crank": _body(crank, (Series(0.0), Series(0.0)), (c, s)),
            "block": Body(0.0, 0.0, pin, axis),
            "lever": _body(lever, foot, axis),
        }
        joints = [
            Pin("crank", None, (Series(0.0), Series(0.0)), friction.get("O", 0.0)),
            Pin("block", "crank", pin, friction.get("A", 0.0)),
            Slide("block", "lever", pin, axis, *friction.get("slot", (0.0, None))),
            Pin("lever", None, foot, friction.get("pivot", 0.0)),
        ]
        loads = [(name, body.centre, (0.0, -9.81 * body.mass)) for name, body in bodies.items()]
        return Machine(bodies, joints, loads, [("lever", torque)], flywheel)

    return at


def _body(link, start, direction):
    mass, along, inertia = link
    return Body(
        mass, inertia, tuple(point + along * part for point, part in zip(start, direction, strict=True)), direction
    )

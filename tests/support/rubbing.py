"""Forces with friction from Newton's equations of all bodies, at 40 digits, with geometry of its own.

Points and directions are complex functions of the crank angle; velocities and accelerations are differences of them at
twice the digits. The unknowns of all joints are solved for together, friction given, and friction is found anew until
nothing changes. Nothing is shared with the library, nor with its kernels' order of solution.
"""

from dataclasses import dataclass, field

import mpmath as mp

DIGITS = 40
STEP = mp.mpf(10) ** -9


@dataclass
class Body:
    """A body by a point and a unit direction over the crank angle; centre as a complex number from that point."""

    point: object
    direction: object
    mass: object = 0
    centre: object = 0
    inertia: object = 0


@dataclass
class Pin:
    """Force on `on` from `against` (None: ground) at a point."""

    on: str
    against: object
    at: object
    rho: object = 0


@dataclass
class Slide:
    """Force across a direction, and a couple about a point, on `on` from `against`; friction along it at that point.

    `moving` is a point of `on` where the point does not move with it.
    """

    on: str
    against: object
    at: object
    direction: object
    mu: object = 0
    half_length: object = None
    moving: object = None


@dataclass
class Roller:
    """Force on the pin of `on` along the inward normal of the path of a point; the roller is a body of its own."""

    on: str
    at: object
    rho: object = 0
    radius: object = 1


@dataclass
class System:
    """All bodies; `applied` has forces by body: a complex force and the point it acts at, over the crank angle."""

    bodies: dict
    joints: dict
    speed: object
    acceleration: object = 0
    gravity: object = 0
    applied: list = field(default_factory=list)

    def solved(self, angle, times=4000):
        """Forces by joint (complex; of a slide force across, couple, friction), torque, and losses by joint."""
        with mp.workdps(DIGITS):
            return self._solved(mp.mpf(angle), times)

    def _solved(self, angle, times):
        at = _Pose(self, angle)
        found = at.inverse * mp.matrix(at.right)
        for _ in range(times):
            vector, known, loss = at.friction(found)
            new = at.inverse * (mp.matrix(at.right) - mp.matrix(vector))
            change = mp.norm(new - found, mp.inf)
            found = new
            if change <= mp.mpf(10) ** -34 * mp.norm(found, mp.inf):
                return at.forces(found), found[len(found) - 1], known, loss
        return None


def rates(function, angle):
    """First and second derivative of a function of the crank angle, by differences at twice the digits."""
    with mp.workdps(2 * DIGITS):
        h = STEP
        parts = [function(angle + k * h) for k in (-2, -1, 0, 1, 2)]
        first = (parts[0] - 8 * parts[1] + 8 * parts[3] - parts[4]) / (12 * h)
        second = (-parts[0] + 16 * parts[1] - 30 * parts[2] + 16 * parts[3] - parts[4]) / (12 * h * h)
        return first, second


class _Pose:
    """A system at one crank angle: three equations of each body, and the unknown forces of all joints in them.

    `layout` has by joint its first unknown, and of a slide or roller the direction and rate of the motion along it.
    """

    def __init__(self, system, angle):
        self.system, self.angle = system, angle
        self.rows = {name: 3 * number for number, name in enumerate(system.bodies)}
        self.place, self.turning = {}, {None: mp.mpf(0)}
        self.right = [part for name, body in system.bodies.items() for part in self._of_body(name, body)]
        self.layout, columns = {}, []
        for name, joint in system.joints.items():
            along, rate = self._along(joint)
            self.layout[name] = len(columns), along, rate
            columns += [self._put(joint, *unit) for unit in self._units(joint, along)]
        driving = [mp.mpf(0)] * len(self.right)
        driving[self.rows["crank"] + 2] = mp.mpf(1)
        self.inverse = mp.matrix([*columns, driving]).T ** -1

    def _of_body(self, name, body):
        """Inertia of a body less what is known of its loads: force, and moment about its mass centre."""
        omega, alpha = self.system.speed, self.system.acceleration
        d = body.direction(self.angle)
        first, second = rates(body.direction, self.angle)
        self.turning[name] = mp.im(first * mp.conj(d))
        turned = mp.im(second * mp.conj(d)) * omega**2 + mp.im(first * mp.conj(d)) * alpha
        centre = lambda phi: body.point(phi) + body.centre * body.direction(phi)  # noqa: E731
        first, second = rates(centre, self.angle)
        force = body.mass * (second * omega**2 + first * alpha) - body.mass * self.system.gravity
        moment = body.inertia * turned
        self.place[name] = centre(self.angle)
        for on, value, at in self.system.applied:
            if on == name:
                pushed = value(self.angle)
                force -= pushed
                moment -= mp.im(mp.conj(at(self.angle) - self.place[name]) * pushed)
        return mp.re(force), mp.im(force), moment

    def _along(self, joint):
        """Direction and rate of the motion along a joint; None of a pin."""
        if isinstance(joint, Pin):
            return None, None
        first, _ = rates(joint.at, self.angle)
        if isinstance(joint, Roller):
            return first / abs(first), abs(first)
        e = joint.direction(self.angle)
        moving, carried = joint.moving or joint.at, 0
        if joint.against is not None:  # velocity of the point of `against` that is there now
            body = self.system.bodies[joint.against]
            z, d = body.point(self.angle), body.direction(self.angle)
            zd, dd = (rates(part, self.angle)[0] for part in (body.point, body.direction))
            carried = zd + dd * ((moving(self.angle) - z) / d)
        return e, mp.re(mp.conj(e) * (rates(moving, self.angle)[0] - carried))

    def _units(self, joint, along):
        """What the unknowns of a joint are ones of: forces and couples."""
        if isinstance(joint, Pin):
            return (1, 0), (1j, 0)
        return ((1j * along, 0),) if isinstance(joint, Roller) else ((1j * along, 0), (0, 1))

    def _put(self, joint, force, couple=0, into=None):
        """A force and couple of a joint in the equations of both its bodies."""
        vector = [mp.mpf(0)] * len(self.right) if into is None else into
        for body, way in ((joint.on, 1), (getattr(joint, "against", None), -1)):
            if body is not None:
                row, given = self.rows[body], way * mp.mpc(force)
                vector[row] += mp.re(given)
                vector[row + 1] += mp.im(given)
                vector[row + 2] += mp.im(mp.conj(joint.at(self.angle) - self.place[body]) * given) + way * couple
        return vector

    def friction(self, found):
        """What friction puts on the equations, and what it and its loss are by joint."""
        vector, known, loss = [mp.mpf(0)] * len(self.right), {}, {}
        rub = {Pin: self._of_pin, Slide: self._of_slide, Roller: self._of_roller}
        for name, joint in self.system.joints.items():
            known[name], loss[name], force, couple = rub[type(joint)](joint, found, *self.layout[name])
            self._put(joint, force, couple, vector)
        return vector, known, loss

    @property
    def _begun(self):
        return self.system.speed or self.system.acceleration

    def _of_pin(self, joint, found, start, along, rate):
        relative = self.turning[joint.on] - self.turning[joint.against]
        moment = -joint.rho * mp.hypot(found[start], found[start + 1]) * mp.sign(relative * self._begun)
        return moment, -moment * relative * self.system.speed, 0, moment

    def _of_slide(self, joint, found, start, along, rate):
        press = abs(found[start])
        if joint.half_length is not None:
            press = max(press, abs(found[start + 1]) / joint.half_length)
        force = -joint.mu * press * mp.sign(rate * self._begun)
        return force, -force * rate * self.system.speed, force * along, 0

    def _of_roller(self, joint, found, start, along, rate):
        """Forces on the roller: K and Kt at the cam, P at its pin; moment of the pin against its rotation."""
        side = 1 if found[start] > 0 else -1  # the cam touches the roller outside, or inside
        relative = -side * rate / joint.radius - self.turning[joint.on]
        load = abs(found[start]) / mp.sqrt(1 - (joint.rho / joint.radius) ** 2)
        on_roller = -joint.rho * load * mp.sign(relative * self._begun)
        contact = -1j * along * side * joint.radius
        force = -on_roller / mp.im(mp.conj(contact) * along)
        return force, -on_roller * relative * self.system.speed, force * along, -on_roller

    def forces(self, found):
        """Forces by joint, of what was solved for."""
        starts = {name: start for name, (start, *_) in self.layout.items()}
        return {
            name: found[starts[name]]
            if isinstance(joint, Roller)
            else mp.mpc(found[starts[name]], found[starts[name] + 1])
            for name, joint in self.system.joints.items()
        }


def circle(a, ra, b, rb, side):
    """Meeting point of two circles to the left (+1) or right of a -> b."""
    d = b - a
    size = abs(d)
    along = (ra**2 - rb**2 + size**2) / (2 * size)
    return a + d / size * (along + 1j * side * mp.sqrt(ra**2 - along**2))

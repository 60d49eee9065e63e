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

    def _rate(self, function, angle):
        with mp.workdps(2 * DIGITS):
            h = STEP
            parts = [function(angle + k * h) for k in (-2, -1, 0, 1, 2)]
            first = (parts[0] - 8 * parts[1] + 8 * parts[3] - parts[4]) / (12 * h)
            second = (-parts[0] + 16 * parts[1] - 30 * parts[2] + 16 * parts[3] - parts[4]) / (12 * h * h)
            return first, second

    def _solved(self, angle, times):
        omega, alpha = self.speed, self.acceleration
        begun = omega or alpha
        self.place, self.turning, rows, right = {}, {None: mp.mpf(0)}, {}, []
        for number, (name, body) in enumerate(self.bodies.items()):
            rows[name] = 3 * number
            d = body.direction(angle)
            first, second = self._rate(body.direction, angle)
            self.turning[name] = mp.im(first * mp.conj(d))
            turned = mp.im(second * mp.conj(d)) * omega**2 + mp.im(first * mp.conj(d)) * alpha
            centre = lambda phi, body=body: body.point(phi) + body.centre * body.direction(phi)  # noqa: E731
            first, second = self._rate(centre, angle)
            force = body.mass * (second * omega**2 + first * alpha) - body.mass * self.gravity
            moment = body.inertia * turned
            self.place[name] = centre(angle)
            for on, value, at in self.applied:
                if on == name:
                    pushed = value(angle)
                    force -= pushed
                    moment -= mp.im(mp.conj(at(angle) - self.place[name]) * pushed)
            right += [mp.re(force), mp.im(force), moment]
        self.rows, columns = rows, []

        def add(vector, body, force, point, couple=0):
            if body is not None:
                row = rows[body]
                vector[row] += mp.re(force)
                vector[row + 1] += mp.im(force)
                vector[row + 2] += mp.im(mp.conj(point - self.place[body]) * force) + couple

        size = len(right)
        layout = {}
        for name, joint in self.joints.items():
            point = joint.at(angle)
            first, _ = self._rate(joint.at, angle)
            units: list = [(1, 0), (1j, 0)]
            if isinstance(joint, Roller):
                tangent = first / abs(first)
                units = [(1j * tangent, 0)]
                layout[name] = [len(columns), tangent, abs(first)]
            elif isinstance(joint, Slide):
                e = joint.direction(angle)
                moving, carried = joint.moving or joint.at, 0
                if joint.against is not None:  # velocity of the point of `against` that is there now
                    body = self.bodies[joint.against]
                    z, d = body.point(angle), body.direction(angle)
                    zd, dd = self._rate(body.point, angle)[0], self._rate(body.direction, angle)[0]
                    carried = zd + dd * ((moving(angle) - z) / d)
                sliding = mp.re(mp.conj(e) * (self._rate(moving, angle)[0] - carried))
                units = [(1j * e, 0), (0, 1)]
                layout[name] = [len(columns), e, sliding]
            else:
                layout[name] = [len(columns), None, None]
            for force, couple in units:
                vector = [mp.mpf(0)] * size
                add(vector, joint.on, force, point, couple)
                add(vector, getattr(joint, "against", None), -mp.mpc(force), point, -couple)
                columns.append(vector)
        driving = [mp.mpf(0)] * size
        driving[rows["crank"] + 2] = mp.mpf(1)
        columns.append(driving)
        inverse = mp.matrix(columns).T ** -1

        def friction(found):
            """What friction puts on the equations, and what it is by joint."""
            vector, known, loss = [mp.mpf(0)] * size, {}, {}
            for name, joint in self.joints.items():
                start, e, sliding = layout[name]
                against = getattr(joint, "against", None)
                point = joint.at(angle)
                if isinstance(joint, Pin):
                    relative = self.turning[joint.on] - self.turning[against]
                    size_of = mp.hypot(found[start], found[start + 1])
                    moment = -joint.rho * size_of * mp.sign(relative * begun)
                    add(vector, joint.on, 0, point, moment)
                    add(vector, against, 0, point, -moment)
                    known[name], loss[name] = moment, -moment * relative * omega
                elif isinstance(joint, Slide):
                    press = abs(found[start])
                    if joint.half_length is not None:
                        press = max(press, abs(found[start + 1]) / joint.half_length)
                    force = -joint.mu * press * mp.sign(sliding * begun)
                    add(vector, joint.on, force * e, point)
                    add(vector, against, -force * e, point)
                    known[name], loss[name] = force, -force * sliding * omega
                else:
                    pressed, tangent, speed = found[start], e, sliding
                    side = 1 if pressed > 0 else -1  # the cam touches the roller outside, or inside
                    spin = -side * speed / joint.radius
                    relative = spin - self.turning[joint.on]
                    # forces on the roller: K and Kt at the cam, P at its pin; moment of the pin against its rotation
                    share = joint.rho / joint.radius
                    load = abs(pressed) / mp.sqrt(1 - share**2)
                    on_roller = -joint.rho * load * mp.sign(relative * begun)
                    contact = -1j * tangent * side * joint.radius
                    along = -on_roller / mp.im(mp.conj(contact) * tangent)
                    add(vector, joint.on, along * tangent, point, -on_roller)
                    known[name], loss[name] = along, -on_roller * relative * omega
            return vector, known, loss

        found = inverse * mp.matrix(right)
        for _ in range(times):
            vector, known, loss = friction(found)
            new = inverse * (mp.matrix(right) - mp.matrix(vector))
            change = mp.norm(new - found, mp.inf)
            found = new
            if change <= mp.mpf(10) ** -34 * mp.norm(found, mp.inf):
                break
        else:
            return None
        forces = {}
        for name, joint in self.joints.items():
            start = layout[name][0]
            forces[name] = found[start] if isinstance(joint, Roller) else mp.mpc(found[start], found[start + 1])
        return forces, found[size - 1], known, loss


def circle(a, ra, b, rb, side):
    """Meeting point of two circles to the left (+1) or right of a -> b."""
    d = b - a
    size = abs(d)
    along = (ra**2 - rb**2 + size**2) / (2 * size)
    return a + d / size * (along + 1j * side * mp.sqrt(ra**2 - along**2))

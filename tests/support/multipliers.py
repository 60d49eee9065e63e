"""Forces with friction by virtual power and constraint multipliers, at 60 digits: a second full system of its own.

The coordinates are place and angle of every body. Joints are equations among them, with constants read off at another
crank angle; positions solve these, velocities and accelerations their derivatives. Multipliers are the forces of the
joints; friction puts on the coordinates what its virtual power says, that of a cam roller through its own turning,
and Newton's iteration finds all at once. With `rubbing.System` it shares but the drawn numbers.
"""

import mpmath as mp

from .rubbing import Pin, Roller

DIGITS = 60
BESIDE = mp.mpf("0.0625")
"""Crank angle, from the one looked at, at which constants are read off."""


class Jet:
    """A complex function of time: value, rate, and second rate with constant rates of all coordinates."""

    def __init__(self, value, first=0, second=0):
        self.parts = mp.mpc(value), mp.mpc(first), mp.mpc(second)

    def __add__(self, other):
        return Jet(*(a + b for a, b in zip(self.parts, _jet(other).parts, strict=True)))

    def __sub__(self, other):
        return self + _jet(other) * -1

    def __mul__(self, other):
        (a, da, dda), (b, db, ddb) = self.parts, _jet(other).parts
        return Jet(a * b, da * b + a * db, dda * b + 2 * da * db + a * ddb)

    def conjugate(self):
        """The conjugate, of real time."""
        return Jet(*map(mp.conj, self.parts))


def _jet(value):
    return value if isinstance(value, Jet) else Jet(value)


class Place:
    """A body at a state: its point and direction as jets."""

    def __init__(self, z, theta, speed=(0, 0, 0)):
        turned = mp.expj(theta)
        self.point = Jet(z, mp.mpc(speed[0], speed[1]))
        self.direction = Jet(turned, 1j * turned * speed[2], -turned * speed[2] ** 2)
        self.angle = Jet(theta, speed[2])

    def of(self, local):
        """A point of the body, by its own coordinates."""
        return self.point + self.direction * local


FRAME = Place(mp.mpc(0), mp.mpf(0))


class Multipliers:
    """The equations of a `rubbing_machines.Drawn` machine at a crank angle."""

    def __init__(self, drawn, angle):
        self.system, self.names = drawn.system, list(drawn.bodies)
        self.angle, other = mp.mpf(angle), mp.mpf(angle) + BESIDE
        self.joints = []
        at_other = {name: (body.point(other), mp.arg(body.direction(other))) for name, body in drawn.bodies.items()}
        places = {None: FRAME, **{name: Place(*state) for name, state in at_other.items()}}
        for name, joint in drawn.joints.items():
            on, against = places[joint.on], places[getattr(joint, "against", None)]

            def local(place, point):
                return (point - place.point.parts[0]) / place.direction.parts[0]

            at = joint.at(other)
            if isinstance(joint, Pin | Roller):
                self.joints.append((name, joint, local(on, at), local(against, at)))
            else:
                moving = (joint.moving or joint.at)(other)
                along = joint.direction(other) / against.direction.parts[0]
                base = local(against, moving)
                turned = mp.re((on.angle - against.angle).parts[0])
                self.joints.append((name, joint, local(on, moving), (along, base, turned)))
        self.centre = drawn.mechanism.groups[0].cam if "cam" in drawn.joints else None
        start = [
            part
            for body in drawn.bodies.values()
            for part in (*_pair(body.point(self.angle)), mp.arg(body.direction(self.angle)))
        ]
        self.q = self._assembled(mp.matrix(start))

    def places(self, q, speed=None):
        """All bodies at coordinates and their rates."""
        found = {None: FRAME}
        for number, name in enumerate(self.names):
            own = [0, 0, 0] if speed is None else [speed[3 * number + k] for k in range(3)]
            found[name] = Place(mp.mpc(q[3 * number], q[3 * number + 1]), q[3 * number + 2], own)
        return found

    def equations(self, places):
        """Constraints as jets, real; the driving one last."""
        rows = []
        for _, joint, on, other in self.joints:
            one = places[joint.on]
            if isinstance(joint, Pin):
                gap = one.of(on) - places[joint.against].of(other)
                rows += [gap, gap * -1j]
            elif isinstance(joint, Roller):
                arm = one.of(on) - mp.mpc(*map(float, self.centre.centre))
                rows.append((arm * arm.conjugate() - mp.mpf(self.centre.pitch_radius) ** 2) * 0.5)
            else:
                along, base, turned = other
                against = places[joint.against]
                across = (against.direction * along).conjugate() * (one.of(on) - against.of(base))
                rows += [across * -1j, _turns(one.angle - against.angle - turned)]
        rows.append(_turns(places["crank"].angle - self.angle))
        return rows

    def jacobian(self, q):
        """Derivatives of the equations by the coordinates."""
        size = len(q)
        matrix = mp.matrix(size, size)
        for column in range(size):
            rate = [mp.mpf(0)] * size
            rate[column] = mp.mpf(1)
            for row, equation in enumerate(self.equations(self.places(q, rate))):
                matrix[row, column] = mp.re(equation.parts[1])
        return matrix

    def _assembled(self, q):
        for _ in range(20):
            gap = mp.matrix([mp.re(row.parts[0]) for row in self.equations(self.places(q))])
            q = q - mp.lu_solve(self.jacobian(q), gap)
            if mp.norm(gap, mp.inf) < mp.mpf(10) ** -50:
                return q
        raise AssertionError("not assembled")

    def solved(self):
        """Forces by joint, torque, friction and losses by joint, as `rubbing.System.solved`."""
        matrix = self.jacobian(self.q)
        driving = mp.matrix([0] * (len(self.q) - 1) + [1])
        way = mp.lu_solve(matrix, driving)  # rates by that of the crank
        speed = way * self.system.speed
        curved = mp.matrix([mp.re(row.parts[2]) for row in self.equations(self.places(self.q, speed))])
        second = mp.lu_solve(matrix, driving * self.system.acceleration - curved)
        self.matrix, self.way, self.here = matrix, way, self.places(self.q, way)
        needed = mp.matrix(len(self.q), 1)
        for number, name in enumerate(self.names):
            body, place = self.system.bodies[name], self.places(self.q, speed)[name]
            arm = place.direction.parts[0] * body.centre
            z = mp.mpc(second[3 * number], second[3 * number + 1])
            centre = z + 1j * second[3 * number + 2] * arm + (place.direction * body.centre).parts[2]
            force = body.mass * (centre - self.system.gravity)
            moment = mp.im(mp.conj(arm) * force) + body.inertia * second[3 * number + 2]
            for on, value, at in self.system.applied:
                if on == name:
                    pushed = value(self.angle)
                    force -= pushed
                    moment -= mp.im(mp.conj(at(self.angle) - place.point.parts[0]) * pushed)
            needed[3 * number], needed[3 * number + 1], needed[3 * number + 2] = *_pair(force), moment
        found = mp.lu_solve(matrix.T, needed)
        for _ in range(60):
            rubbing, slopes, friction, loss = self._friction(found)
            gap = matrix.T * found + rubbing - needed
            change = mp.lu_solve(matrix.T + slopes, gap)
            found = found - change
            if mp.norm(change, mp.inf) <= mp.mpf(10) ** -50 * mp.norm(found, mp.inf):
                break
        else:
            return None
        return self._forces(found), found[len(found) - 1], friction, loss

    def _friction(self, found):
        """What friction puts on the coordinates, its derivatives by the multipliers, and by joint itself and loss."""
        size = len(found)
        begun = mp.sign(self.system.speed or self.system.acceleration)
        total, slopes, friction, loss, row = mp.matrix(size, 1), mp.matrix(size, size), {}, {}, 0
        for name, joint, on, other in self.joints:
            if isinstance(joint, Pin):
                parts = found[row], found[row + 1]
                load = mp.hypot(*parts)
                moved = self._turning(joint.on, joint.against)
                factor, by = joint.rho, [(row + k, part / load if load else 0) for k, part in enumerate(parts)]
                row += 2
            elif isinstance(joint, Roller):
                scale = abs(self._arm(on))
                share = joint.rho / joint.radius
                load = abs(found[row]) * scale / mp.sqrt(1 - share**2)
                pressed_inward = -found[row]  # the equation grows outward
                by = [(row, mp.sign(found[row]) * scale / mp.sqrt(1 - share**2))]
                tangent = 1j * self._arm(on) / scale  # counter-clockwise; the drawn cams are gone round so
                spin = -1 if pressed_inward > 0 else 1
                moved = self._moving(joint.on, on, tangent) * (spin / joint.radius) - self._turning(joint.on, None)
                factor, row = joint.rho, row + 1
            else:
                along, _, _ = other
                against = self.here[joint.against]
                e = against.direction.parts[0] * along
                across, couple, lever = self._carried(joint, on, e, found[row], found[row + 1])
                load, by = abs(across), [(row, mp.sign(across))]
                if joint.half_length is not None and abs(couple) / joint.half_length > load:
                    load, sign = abs(couple) / joint.half_length, mp.sign(couple) / joint.half_length
                    by = [(row, sign * lever), (row + 1, sign)]
                spot = joint.at(self.angle)
                moved = self._moving(joint.on, self._local(joint.on, spot), e)
                if joint.against is not None:
                    moved = moved - self._moving(joint.against, self._local(joint.against, spot), e)
                factor, row = joint.mu, row + 2
            rate = (moved.T * self.way)[0]
            amount = -factor * load * mp.sign(rate * begun)
            total += moved * amount
            for place, slope in by:
                slopes[:, place] = slopes[:, place] + moved * (-factor * slope * mp.sign(rate * begun))
            friction[name] = amount
            loss[name] = -amount * rate * self.system.speed
            if isinstance(joint, Roller):  # felt as a force along the path
                friction[name] = amount * spin / joint.radius
        return total, slopes, friction, loss

    def _arm(self, on):
        return self.here["block"].of(on).parts[0] - mp.mpc(*map(float, self.centre.centre))

    def _local(self, name, spot):
        return (spot - self.here[name].point.parts[0]) / self.here[name].direction.parts[0]

    def _turning(self, on, against):
        """Virtual rotation of a body against another, by coordinate."""
        found = mp.matrix(len(self.q), 1)
        found[3 * self.names.index(on) + 2] = mp.mpf(1)
        if against is not None:
            found[3 * self.names.index(against) + 2] = mp.mpf(-1)
        return found

    def _moving(self, on, local, direction):
        """Virtual displacement of a point of a body along a direction, by coordinate."""
        found, place = mp.matrix(len(self.q), 1), 3 * self.names.index(on)
        arm = self.here[on].direction.parts[0] * local
        found[place], found[place + 1] = _pair(direction)
        found[place + 2] = mp.re(mp.conj(direction) * 1j * arm)
        return found

    def _carried(self, joint, on, e, across, couple):
        """Force across a slide, couple about its point, and what a force of 1 adds to that."""
        moving = self.here[joint.on].of(on).parts[0]
        lever = mp.im(mp.conj(moving - joint.at(self.angle)) * 1j * e)
        return across, couple + lever * across, lever

    def _forces(self, found):
        forces, row = {}, 0
        for name, joint, on, other in self.joints:
            if isinstance(joint, Pin):
                forces[name], row = mp.mpc(found[row], found[row + 1]), row + 2
            elif isinstance(joint, Roller):
                forces[name], row = -found[row] * abs(self._arm(on)), row + 1
            else:
                e = self.here[joint.against].direction.parts[0] * other[0]
                across, couple, _ = self._carried(joint, on, e, found[row], found[row + 1])
                forces[name], row = mp.mpc(across, couple), row + 2
        return forces


def _pair(value):
    return mp.re(value), mp.im(value)


def _turns(angle):
    """An angle that may be off by whole turns, as a jet."""
    off = 2 * mp.pi * mp.nint(mp.re(angle.parts[0]) / (2 * mp.pi))
    return angle - off


def solved(drawn, angle):
    """Forces by joint (of a slide force across and couple), torque, friction and losses by joint."""
    with mp.workdps(DIGITS):
        return Multipliers(drawn, angle).solved()

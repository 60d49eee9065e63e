"""The independent reference of forces: Newton-Euler equations of all bodies at once, with friction; no package inside.

A planar vector is a complex number. Every body has a point and a unit direction over the crank angle; rates and
accelerations are difference quotients of these at three times the digits of the forces. One linear system of three
equations for each body, moments about its own mass centre, has the forces of all joints and the driving torque as
unknowns. Friction is repeated from these forces until nothing changes.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import mpmath as mp

DIGITS = 40
"""Of the forces, unless a system has its own; positions that are differenced have three times as many."""
FINE_DIGITS = 3 * DIGITS


@dataclass(frozen=True)
class Body:
    """Mass, mass centre (along, across) from the body's point, inertia about the mass centre."""

    mass: float = 0.0
    centre: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0


@dataclass
class Pin:
    """Force on `on` from `against` (None: ground) at a point; `rho` is the radius of the friction circle, m."""

    on: str
    against: Any
    at: Callable
    rho: Any = 0


@dataclass
class Slide:
    """Force across a direction, and a couple about a point, on `on` from `against`; friction along it at that point.

    `moving` is a point of `on`, where the point is not fixed to it.
    """

    on: str
    against: Any
    at: Callable
    direction: Callable
    mu: Any = 0
    half_length: Any = None
    moving: Any = None


@dataclass
class Roller:
    """Force on the pin of `on` along the left normal of the path of a point on `against`; the roller is a body.

    `arm` is that of rolling friction, m.
    """

    on: str
    at: Callable
    rho: Any = 0
    radius: Any = 1
    against: Any = None
    arm: Any = 0


@dataclass
class System:
    """Bodies, and by name their poses: point and direction as functions of the crank angle.

    `applied` has forces as body, complex force and point, the last two over the crank angle.
    """

    bodies: dict
    poses: dict
    joints: dict
    speed: Any
    acceleration: Any = 0
    gravity: Any = 0
    applied: list = field(default_factory=list)
    digits: int = DIGITS

    def forces(self, angle, times=4000):
        """Forces by joint (of a slide force across + i couple), torque, friction and losses by joint."""
        with mp.workdps(self.digits):
            return _State(self, angle).forces(times)

    def motion(self, angle):
        """Position, velocity and acceleration of joints, mass centres (by body) and angles (by (body, "angle"))."""
        with mp.workdps(self.digits):
            return _State(self, angle).motion

    def solve(self, angle):
        """Motion and forces at one crank angle by the names of a solution, as plain complex and real numbers."""
        with mp.workdps(self.digits):
            state = _State(self, angle)
            forces, torque, *_ = state.forces()
        found = {order: {k: _plain(v) for k, v in table.items()} for order, table in state.motion.items()}
        for name, force in forces.items():
            if isinstance(self.joints[name], Slide):
                found[f"{name}_force"], found[f"{name}_moment"] = float(force.real), float(force.imag)
            else:
                found[f"{name}_force" if isinstance(self.joints[name], Roller) else name] = _plain(force)
        at, second = found["position"], found["acceleration"]
        inertia = {name: -body.mass * second[name] for name, body in self.bodies.items()}
        moments = (
            _cross(at[name], inertia[name]) - own.inertia * second[name, "angle"] for name, own in self.bodies.items()
        )
        torques = dict.fromkeys(("balancing_torque", "balancing_torque_by_power"), float(torque))
        return found | torques | {"shaking_force": sum(inertia.values()), "shaking_moment": sum(moments)}


class _State:
    """A system at one crank angle: places, first and second derivatives of all points, and the equations of bodies.

    `layout` has by joint its first unknown, and of a slide or roller the direction and rate of the motion along it.
    """

    def __init__(self, system, angle):
        self.system = system
        self.value, self.first, self.second = differences(self._points, angle, system.digits)
        self.motion = self._motion()

    def _assemble(self):
        """The equations of all bodies: unknown forces of the joints and the torque, and what is known."""
        system = self.system
        self.turning = {None: mp.mpf(0), **{name: self.first[name, "angle"] for name in system.bodies}}
        self.rows = {name: 3 * number for number, name in enumerate(system.bodies)}
        self.right = [part for name, body in system.bodies.items() for part in self._inertia_less_loads(name, body)]
        self.layout, columns = {}, []
        for name, joint in system.joints.items():
            along, rate = self._sliding(name, joint)
            self.layout[name] = len(columns), along, rate
            columns += [self._put(name, joint, *unit) for unit in _units(joint, along)]
        driving = [mp.mpf(0)] * len(self.right)
        driving[self.rows["crank"] + 2] = mp.mpf(1)
        self.matrix = mp.matrix([*columns, driving]).T

    def _points(self, phi):
        """All points and directions that are differenced, and forces applied, at a crank angle."""
        table = {}
        for name, body in self.system.bodies.items():
            point, direction = (part(phi) for part in self.system.poses[name])
            table[name, "point"], table[name, "direction"] = point, direction
            table[name] = point + mp.mpc(*body.centre) * direction
        for name, joint in self.system.joints.items():
            table[name, "at"] = joint.at(phi)
            table[name, "moving"] = (getattr(joint, "moving", None) or joint.at)(phi)
            if isinstance(joint, Slide):
                table[name, "along"] = joint.direction(phi)
        for number, (_, force, at) in enumerate(self.system.applied):
            table[number, "force"], table[number, "at"] = force(phi), at(phi)
        return table

    def _motion(self):
        """Of joints, mass centres and angles by time."""
        for name in self.system.bodies:
            turned = mp.conj(self.value[name, "direction"])
            self.value[name, "angle"] = -mp.arg(turned)
            self.first[name, "angle"] = mp.im(self.first[name, "direction"] * turned)
            self.second[name, "angle"] = mp.im(self.second[name, "direction"] * turned)
        keys = {name: name for name in self.system.bodies} | {(n, "angle"): (n, "angle") for n in self.system.bodies}
        keys |= {name: (name, "at") for name, joint in self.system.joints.items() if isinstance(joint, Pin)}
        w, e = mp.mpf(self.system.speed), mp.mpf(self.system.acceleration)
        return {
            "position": {name: self.value[key] for name, key in keys.items()},
            "velocity": {name: self.first[key] * w for name, key in keys.items()},
            "acceleration": {name: self.second[key] * w**2 + self.first[key] * e for name, key in keys.items()},
        }

    def _inertia_less_loads(self, name, body):
        """Force, and moment about its mass centre, that the joints put on a body."""
        second = self.motion["acceleration"]
        force, moment = body.mass * (second[name] - self.system.gravity), body.inertia * second[name, "angle"]
        for number, (on, *_) in enumerate(self.system.applied):
            if on == name:
                pushed = self.value[number, "force"]
                force -= pushed
                moment -= _cross(self.value[number, "at"] - self.value[name], pushed)
        return mp.re(force), mp.im(force), moment

    def _sliding(self, name, joint):
        """Direction and rate of the motion along a joint; None of a pin."""
        if isinstance(joint, Pin):
            return None, None
        first, carried = self.first[name, "moving"], 0
        if joint.against is not None:  # velocity of the point of `against` that is there now
            z, d = (self.value[joint.against, part] for part in ("point", "direction"))
            zd, dd = (self.first[joint.against, part] for part in ("point", "direction"))
            carried = zd + dd * ((self.value[name, "moving"] - z) / d)
        if isinstance(joint, Roller):
            return (first - carried) / abs(first - carried), abs(first - carried)
        e = self.value[name, "along"]
        return e, mp.re(mp.conj(e) * (first - carried))

    def _put(self, name, joint, force, couple=0, into=None):
        """A force and couple of a joint in the equations of both its bodies."""
        vector = [mp.mpf(0)] * len(self.right) if into is None else into
        for body, sign in ((joint.on, 1), (joint.against, -1)):
            if body is not None:
                row, given = self.rows[body], sign * mp.mpc(force)
                vector[row] += mp.re(given)
                vector[row + 1] += mp.im(given)
                vector[row + 2] += _cross(self.value[name, "at"] - self.value[body], given) + sign * couple
        return vector

    def forces(self, times=4000):
        """Solve, and repeat with the friction of the forces found; None if that does not converge."""
        self._assemble()
        found = mp.lu_solve(self.matrix, mp.matrix(self.right))
        vector, friction, loss = self._friction(found)
        if any(vector):
            found = self._with_friction(found, self.matrix**-1, times)
            if found is None:
                return None
            _, friction, loss = self._friction(found)
        forces = {}
        for name, (start, *_) in self.layout.items():
            single = isinstance(self.system.joints[name], Roller)
            forces[name] = found[start] if single else mp.mpc(found[start], found[start + 1])
        return forces, found[len(found) - 1], friction, loss

    def _with_friction(self, found, inverse, times):
        for _ in range(times):
            before, found = found, inverse * (mp.matrix(self.right) - mp.matrix(self._friction(found)[0]))
            if mp.norm(found - before, mp.inf) <= mp.mpf(10) ** -34 * mp.norm(found, mp.inf):
                return found
        return None

    def _friction(self, found):
        """What friction puts on the equations; friction and loss by joint."""
        vector, known, loss = [mp.mpf(0)] * len(self.right), {}, {}
        rules = {Pin: self._of_pin, Slide: self._of_slide, Roller: self._of_roller}
        for name, joint in self.system.joints.items():
            known[name], loss[name], force, couple = rules[type(joint)](joint, found, *self.layout[name])
            self._put(name, joint, force, couple, vector)
        return vector, known, loss

    @property
    def _sense(self):
        return self.system.speed or self.system.acceleration

    def _of_pin(self, joint, found, start, along, rate):
        relative = self.turning[joint.on] - self.turning[joint.against]
        moment = -joint.rho * mp.hypot(found[start], found[start + 1]) * mp.sign(relative * self._sense)
        return moment, -moment * relative * self.system.speed, 0, moment

    def _of_slide(self, joint, found, start, along, rate):
        press = abs(found[start])
        if joint.half_length is not None:
            press = max(press, abs(found[start + 1]) / joint.half_length)
        force = -joint.mu * press * mp.sign(rate * self._sense)
        return force, -force * rate * self.system.speed, force * along, 0

    def _of_roller(self, joint, found, start, along, rate):
        """Normal and tangential force at the cam, and moments of pin and cam against the roller's rotation."""
        side = 1 if found[start] > 0 else -1  # the cam touches the roller outside, or inside
        rolling = -side * rate / joint.radius
        relative = rolling + self.turning[joint.against] - self.turning[joint.on]
        of_cam = -joint.arm * abs(found[start]) * mp.sign(rolling * self._sense)
        contact, force = -1j * along * side * joint.radius, mp.mpf(0)
        for _ in range(100):
            of_pin = -joint.rho * mp.hypot(found[start], force) * mp.sign(relative * self._sense)
            force = -(of_pin + of_cam) / mp.im(mp.conj(contact) * along)
        loss = -(of_pin * relative + of_cam * rolling) * self.system.speed
        return force, loss, force * along, -of_pin


def differences(function, angle, digits=DIGITS):
    """Value, first and second derivative of a table of functions of the crank angle, by five-point differences."""
    with mp.workdps(3 * digits):
        h = mp.mpf(10) ** (-digits // 2)
        far_back, back, here, ahead, far_ahead = (function(mp.mpf(angle) + k * h) for k in (-2, -1, 0, 1, 2))
        first = {k: (far_back[k] - 8 * back[k] + 8 * ahead[k] - far_ahead[k]) / (12 * h) for k in here}
        second = {
            k: (16 * (back[k] + ahead[k]) - far_back[k] - far_ahead[k] - 30 * here[k]) / (12 * h * h) for k in here
        }
        return here, first, second


def path(point, angle):
    """A point and its first and second derivatives by the crank angle, complex."""
    return tuple(complex(table["A"]) for table in differences(lambda phi: {"A": point(phi)}, angle))


def _units(joint, along):
    """What the unknowns of a joint are ones of: forces and couples."""
    if isinstance(joint, Pin):
        return (1, 0), (1j, 0)
    return ((1j * along, 0),) if isinstance(joint, Roller) else ((1j * along, 0), (0, 1))


def _cross(arm, force):
    return (arm.conjugate() * force).imag


def _plain(value):
    return complex(value) if isinstance(value, mp.mpc) else float(value)


# Crank-sliders


@dataclass(frozen=True)
class CrankSlider:
    """A crank-slider in motion under load, in plain numbers.

    `pin` gives the complex position of A at a crank angle; `has_cam` tells a roller on a cam from a pin on the crank;
    `push` is the force on the slider along the guide as a function of its coordinate there. `friction` has the radius
    of the friction circle by pin, and (coefficient, half length or None) of the guide.
    """

    pin: Callable[[Any], Any]
    has_cam: bool
    coupler_length: Any
    guide_angle: float = 0.0
    guide_offset: float = 0.0
    assembly: int = 1
    bodies: dict[str, Body] = field(default_factory=dict)
    speed: float = 0.0
    acceleration: float = 0.0
    gravity: tuple[float, float] = (0.0, 0.0)
    push: Callable[[Any], Any] = lambda coordinate: 0.0
    friction: dict[str, Any] = field(default_factory=dict)

    def solve(self, angle):
        """Motion and forces by name at one crank angle."""
        return self.system.solve(angle)

    @property
    def system(self):
        """All bodies and joints; the coupler's angle by the arc sine."""
        A, along = cache(self.pin), lambda phi: mp.expj(self.guide_angle)

        @cache
        def coupler(phi):
            lean = mp.asin((self.guide_offset - (A(phi) / along(phi)).imag) / self.coupler_length)
            return mp.expj(self.guide_angle + (lean if self.assembly > 0 else mp.pi - lean))

        B = lambda phi: A(phi) + self.coupler_length * coupler(phi)  # noqa: E731

        inner = "block" if self.has_cam else "crank"
        poses = {"crank": (_origin, mp.expj), "block": (A, mp.expj), "coupler": (A, coupler), "slider": (B, along)}
        joints = {"O": Pin("crank", None, _origin), "A": Pin("coupler", inner, A), "B": Pin("slider", "coupler", B)}
        for name, radius in self.friction.items():
            if name != "guide":
                joints[name].rho = radius
        joints["guide"] = Slide("slider", None, B, along, *self.friction.get("guide", ()))
        if self.has_cam:
            joints |= {"slot": Slide("block", "crank", A, mp.expj), "cam": Roller("block", A)}
        bodies = {name: self.bodies.get(name, Body()) for name in poses if name != "block" or self.has_cam}
        push = lambda phi: self.push((B(phi) / along(phi)).real) * along(phi)  # noqa: E731
        gravity = self.gravity[0] * mp.expj(self.gravity[1])
        applied = [("slider", push, B)]
        return System(bodies, poses, joints, self.speed, self.acceleration, gravity, applied)


def _origin(phi):
    return mp.mpc(0)


def pin_on_crank(length):
    """A at the end of a plain crank."""
    return lambda angle: length * mp.expj(angle)


def pin_on_circle(radius, centre):
    """A on the crank ray and on a circle: the sine rule in the triangle of O, centre and A."""
    centre = mp.mpc(*centre)

    def pin(angle):
        return centre + radius * mp.expj(angle - mp.asin((centre * mp.expj(-angle)).imag / radius))

    return pin


def pin_by_cosine_law(amplitude, mean, guide_angle=0.0):
    """A on the crank ray at the critical length from B = mean + amplitude cos: naive radicand, signed root."""
    with mp.workdps(FINE_DIGITS):
        turning, length = critical_cosine(amplitude, mean), critical_length(amplitude, mean)

    def pin(angle):
        cosine, sine = mp.cos(angle - guide_angle), mp.sin(angle - guide_angle)
        slider = mean + amplitude * cosine
        root = mp.sqrt(length**2 - slider**2 * sine**2)
        return (slider * cosine - mp.sign(cosine - turning) * root) * mp.expj(angle)

    return pin


def critical_cosine(amplitude, mean):
    """Cosine of the angle where mean + amplitude cos, times sin, is largest."""
    return (mp.sqrt(mp.mpf(mean) ** 2 + 8 * mp.mpf(amplitude) ** 2) - mean) / (4 * mp.mpf(amplitude))


def critical_length(amplitude, mean):
    """The largest value of (mean + amplitude cos) sin."""
    cosine = critical_cosine(amplitude, mean)
    return (mean + amplitude * cosine) * mp.sqrt(1 - cosine**2)


# Four-bars


def four_bar(bar, digits=DIGITS):
    """System of a `FourBar` of plain numbers; its assembly may be a function of the crank angle."""
    side = bar.assembly if callable(bar.assembly) else lambda phi: bar.assembly
    c, h, pivot = mp.mpf(bar.coupler), mp.mpf(bar.rocker), mp.mpmathify(bar.pivot)
    A = cache(lambda phi: bar.crank * mp.expj(phi))
    B = cache(lambda phi: circles_meet(A(phi), c, pivot, h, side(phi)))
    poses = {
        "crank": (_origin, mp.expj),
        "coupler": (A, lambda phi: (B(phi) - A(phi)) / c),
        "rocker": (lambda phi: pivot, lambda phi: (B(phi) - pivot) / h),
    }
    joints = {
        "O": Pin("crank", None, _origin),
        "A": Pin("coupler", "crank", A),
        "B": Pin("rocker", "coupler", B),
        "O2": Pin("rocker", None, poses["rocker"][0]),
    }
    gravity = bar.gravity[0] * mp.expj(bar.gravity[1])
    return System(bar.links, poses, joints, bar.speed, bar.acceleration, gravity, digits=digits)


def slotted_lever(distance, offset, side, bodies, speed, acceleration, gravity, digits=DIGITS):
    """System of a crank of 1 m and a lever about (distance, 0), its slot at an offset on a side by the crank angle."""
    toward = cache(lambda phi: mp.expj(phi) - distance)

    def direction(phi):
        along = side(phi) * mp.sqrt(abs(toward(phi)) ** 2 - mp.mpf(offset) ** 2)
        return toward(phi) / mp.mpc(along, offset)

    pivot = lambda phi: mp.mpc(distance)  # noqa: E731
    poses = {"crank": (_origin, mp.expj), "lever": (pivot, direction), "block": (mp.expj, direction)}
    joints = {
        "O": Pin("crank", None, _origin),
        "A": Pin("block", "crank", mp.expj),
        "O2": Pin("lever", None, pivot),
        "slot": Slide("block", "lever", mp.expj, direction),
    }
    return System(bodies, poses, joints, speed, acceleration, gravity, digits=digits)


def circles_meet(a, ra, b, rb, side):
    """Meeting point of two circles to the left (+1) or right of a -> b."""
    d = b - a
    size = abs(d)
    along = (ra**2 - rb**2 + size**2) / (2 * size)
    return a + d / size * (along + 1j * side * mp.sqrt(ra**2 - along**2))

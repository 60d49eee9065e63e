"""Independent reference: the full Newton-Euler system of all bodies at once, motion by differencing positions.

Nothing here is taken from the package. A planar vector is a complex number. Positions come from angles (asin, exp),
with 80 digits; velocities and accelerations are difference quotients of positions at neighbouring times, good to 40
digits; forces solve one linear system with three equations for every body, moments about its own mass centre.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import mpmath as mp
import numpy as np

DIGITS = 80
STEP = 1e-12


@dataclass(frozen=True)
class Body:
    """Mass, mass centre (along, across) from the link's reference joint, inertia about the mass centre."""

    mass: float = 0.0
    centre: tuple[float, float] = (0.0, 0.0)
    inertia: float = 0.0


@dataclass(frozen=True)
class Scene:
    """A mechanism in motion under load, in plain numbers.

    `pin` gives the complex position of A at a crank angle; `has_cam` tells a roller on a cam from a pin on the crank;
    `push` is the force on the slider along the guide as a function of its coordinate there.
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


def pin_on_crank(length):
    """A at the end of a plain crank."""
    return lambda angle: length * mp.expj(angle)


def pin_on_circle(radius, centre):
    """A on the crank ray and on a circle: the sine rule in the triangle of O, centre and A."""
    centre = mp.mpc(*centre)

    def pin(angle):
        return centre + radius * mp.expj(angle - mp.asin(_across(centre, angle) / radius))

    return pin


def pin_by_cosine_law(amplitude, mean, guide_angle=0.0):
    """A on the crank ray at the critical length from B = mean + amplitude cos: naive radicand, signed root."""
    with mp.workdps(DIGITS):
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


def _along(vector, angle):
    return (vector * mp.expj(-angle)).real


def _across(vector, angle):
    return (vector * mp.expj(-angle)).imag


def _poses(scene, angle):
    """Reference joint and direction angle of every link."""
    A = scene.pin(angle)
    lean = mp.asin((scene.guide_offset - _across(A, scene.guide_angle)) / scene.coupler_length)
    coupler = scene.guide_angle + (lean if scene.assembly > 0 else mp.pi - lean)
    B = A + scene.coupler_length * mp.expj(coupler)
    poses = {"crank": (mp.mpc(0), angle), "coupler": (A, coupler), "slider": (B, mp.mpf(scene.guide_angle))}
    return {**poses, "block": (A, angle)} if scene.has_cam else poses


def _points(scene, angle):
    """Joints, mass centres (by link name) and link angles, as one table of numbers."""
    poses = _poses(scene, angle)
    table = {"A": poses["coupler"][0], "B": poses["slider"][0]}
    for name, (joint, turned) in poses.items():
        table[name] = joint + mp.mpc(*scene.bodies.get(name, Body()).centre) * mp.expj(turned)
        table[name, "angle"] = turned
    return table


def _differenced(function):
    """Value, first and second derivative at 0 of a table of functions, by five-point differences."""
    step = mp.mpf(STEP)
    far_back, back, here, ahead, far_ahead = (function(k * step) for k in (-2, -1, 0, 1, 2))
    first = {k: (far_back[k] - 8 * back[k] + 8 * ahead[k] - far_ahead[k]) / (12 * step) for k in here}
    second = {k: (16 * (back[k] + ahead[k]) - far_back[k] - far_ahead[k] - 30 * here[k]) / (12 * step**2) for k in here}
    return here, first, second


def path(pin, angle):
    """The pin at a crank angle and its first and second derivatives by that angle, complex."""
    with mp.workdps(DIGITS):
        angle = mp.mpf(angle)
        return tuple(_plain(table["A"]) for table in _differenced(lambda turned: {"A": pin(angle + turned)}))


def solve(scene, angle):
    """Everything about the scene at one crank angle: complex vectors and numbers, by name."""
    with mp.workdps(DIGITS):
        angle = mp.mpf(angle)
        speed, acceleration = mp.mpf(scene.speed), mp.mpf(scene.acceleration)
        motion = _differenced(lambda t: _points(scene, angle + speed * t + acceleration * t**2 / 2))
        position, velocity, second = ({k: _plain(v) for k, v in table.items()} for table in motion)
        ray, along = _plain(mp.expj(angle)), _plain(mp.expj(scene.guide_angle))
        gravity = scene.gravity[0] * _plain(mp.expj(scene.gravity[1]))
        push = float(scene.push(_along(motion[0]["B"], scene.guide_angle))) * along
    tangent = path(scene.pin, angle)[1]
    inward = 1j * tangent / abs(tangent)

    names = [name for name in ("crank", "block", "coupler", "slider") if name in position]
    masses = {name: scene.bodies.get(name, Body()) for name in names}
    unknowns = _unknowns(scene.has_cam, position, ray, along, inward)
    matrix = np.zeros((3 * len(names), len(unknowns)))
    for column, (_, force, moment, at, on, by) in enumerate(unknowns):
        for body, sign in ((on, 1.0), (by, -1.0)):
            if body is not None:
                row = 3 * names.index(body)
                matrix[row : row + 3, column] = _wrench(sign * force, sign * moment, at - position[body])
    right = np.zeros(3 * len(names))
    for number, name in enumerate(names):
        inertia = masses[name].mass * (second[name] - gravity)
        right[3 * number : 3 * number + 3] = inertia.real, inertia.imag, masses[name].inertia * second[name, "angle"]
    slider = 3 * names.index("slider")
    right[slider : slider + 3] -= _wrench(push, 0.0, position["B"] - position["slider"])

    found = {"position": position, "velocity": velocity, "acceleration": second}
    for (name, force, *_), size in zip(unknowns, np.linalg.solve(matrix, right), strict=True):
        two_parts = name in ("O", "A", "B")
        found[name] = found.get(name, 0) + size * force if two_parts else size
    shaking = {name: -masses[name].mass * second[name] for name in names}
    found["shaking_force"] = sum(shaking.values())
    found["shaking_moment"] = sum(
        (np.conj(position[name]) * shaking[name]).imag - masses[name].inertia * second[name, "angle"] for name in names
    )
    return found


def _unknowns(has_cam, position, ray, along, inward):
    """Unit wrenches: name, force, moment, point, body it acts on, body it comes from (None: ground)."""
    A, B = position["A"], position["B"]
    inner = "block" if has_cam else "crank"
    unknowns = [
        *(("O", part, 0.0, 0.0, "crank", None) for part in (1.0, 1.0j)),
        *(("A", part, 0.0, A, "coupler", inner) for part in (1.0, 1.0j)),
        *(("B", part, 0.0, B, "slider", "coupler") for part in (1.0, 1.0j)),
        ("guide_force", 1j * along, 0.0, B, "slider", None),
        ("guide_moment", 0.0, 1.0, B, "slider", None),
        ("balancing_torque", 0.0, 1.0, 0.0, "crank", None),
    ]
    if has_cam:
        unknowns += [
            ("slot_force", 1j * ray, 0.0, A, "block", "crank"),
            ("slot_moment", 0.0, 1.0, A, "block", "crank"),
            ("cam_force", inward, 0.0, A, "block", None),
        ]
    return unknowns


def _wrench(force, moment, arm):
    force = complex(force)
    return force.real, force.imag, moment + (np.conj(arm) * force).imag


def _plain(value):
    return complex(value) if isinstance(value, mp.mpc) else float(value)

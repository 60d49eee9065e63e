"""A loaded four-bar in plain numbers, what the package gives for it, and an independent full system for the same.

The reference shares no formula with the package. A planar vector is a complex number; angles of coupler and rocker come
from the cosine rule with 50 digits, rates and accelerations from the Jacobian of the closed loop, forces from one
linear system with three equations for every body.
"""

import warnings
from dataclasses import dataclass, field

import mpmath as mp
import numpy as np

import kinetostatics as ks

from .machines import ANGLES, TORQUES, planar
from .newton_euler import Body

LINKS = {
    "crank": Body(3.0, (0.1, 0.04), 0.2),
    "coupler": Body(7.0, (0.4, -0.06), 0.9),
    "rocker": Body(5.0, (0.3, 0.08), 0.4),
}
FORCES = ("O", "A", "B", "O2")
TURN = np.linspace(0.0, 2 * np.pi, 721) + 0.001


@dataclass(frozen=True)
class FourBar:
    """A loaded four-bar in plain numbers, so that a law can change any of them; a crank-rocker unless told."""

    crank: float = 0.3
    coupler: float = 0.8
    rocker: float = 0.6
    pivot: complex = 0.7 + 0.4j
    assembly: int = 1
    links: dict = field(default_factory=lambda: dict(LINKS))
    gravity: tuple = (9.81, -1.2)
    speed: float = 12.0
    acceleration: float = -30.0

    def solve(self, angle=ANGLES, **motion):
        """Solution of the package at its own speed unless told."""
        mechanism = ks.four_bar(
            self.crank,
            self.coupler,
            self.rocker,
            rocker_pivot=(self.pivot.real, self.pivot.imag),
            assembly=self.assembly,
            **{name: ks.Link(link.mass, link.centre, link.inertia) for name, link in self.links.items()},
        )
        motion = {"crank_speed": self.speed, "crank_acceleration": self.acceleration} | motion
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ks.HintWarning)  # random inertias may look like slips
            return ks.solve(mechanism, angle, loads=ks.Gravity(*self.gravity), **motion)


def results(s):
    """All forces and moments by name; a vector as a complex number."""
    found = {name: planar(s.reaction(name)) for name in FORCES} | {"shaking_force": planar(s.shaking_force)}
    return found | {name: getattr(s, name) for name in (*TORQUES, "shaking_moment")}


def of_lengths(lengths, frame_angle=0.0, assembly=1):
    """Four-bar of the package with lengths of crank, coupler, rocker and frame."""
    *links, frame = lengths
    pivot = frame * np.exp(1j * frame_angle)
    return ks.four_bar(*links, rocker_pivot=(pivot.real, pivot.imag), assembly=assembly)


def swept(mechanism, angle=TURN):
    """Its solution over the turn, NaN where it does not close."""
    return ks.solve(mechanism, angle, crank_speed=1.0, on_gap="nan")


# Reference


def moved(bar, angle, speed=1, acceleration=0):
    """Joint, angle and their first and second derivatives by time of every link, with 50 digits."""
    with mp.workdps(50):
        c, h, pivot, angle = mp.mpf(bar.coupler), mp.mpf(bar.rocker), mp.mpmathify(bar.pivot), mp.mpf(angle)
        A = bar.crank * mp.expj(angle)
        to_pivot = pivot - A
        a = abs(to_pivot)
        opening = mp.acos((a * a + c * c - h * h) / (2 * a * c))
        coupler = c * mp.expj(mp.arg(to_pivot) + bar.assembly * opening)
        rocker = A + coupler - pivot

        def closed(right):
            """Rates that close the loop: turning coupler less turning rocker is a given vector."""
            matrix = mp.matrix([[-coupler.imag, rocker.imag], [coupler.real, -rocker.real]])
            return mp.lu_solve(matrix, mp.matrix([right.real, right.imag]))

        A1 = 1j * speed * A
        w = closed(-A1)
        A2 = (1j * acceleration - speed * speed) * A
        e = closed(w[0] ** 2 * coupler - w[1] ** 2 * rocker - A2)
        zero = mp.mpf(0)
        return {
            "crank": ((zero, zero, zero), (angle, mp.mpf(speed), mp.mpf(acceleration))),
            "coupler": ((A, A1, A2), (mp.arg(coupler), w[0], e[0])),
            "rocker": ((pivot, zero, zero), (mp.arg(rocker), w[1], e[1])),
            "B": A + coupler,
        }


def point(link, along, across=0):
    """Position, velocity and acceleration of a point of a link."""
    (joint, first, second), (angle, rate, slope) = link
    arm = mp.mpc(along, across) * mp.expj(angle)
    return [complex(part) for part in (joint + arm, first + 1j * rate * arm, second + (1j * slope - rate**2) * arm)]


def reference(bar, angle):
    """Motion and forces at one crank angle by name."""
    poses = moved(bar, angle, bar.speed, bar.acceleration)
    names = list(bar.links)
    points = {name: point(poses[name], *bar.links[name].centre) for name in names}
    points |= {"A": point(poses["coupler"], 0), "B": point(poses["coupler"], bar.coupler)}
    found = {
        order: {name: parts[k] for name, parts in points.items()}
        | {(name, "angle"): float(poses[name][1][k]) for name in names}
        for k, order in enumerate(("position", "velocity", "acceleration"))
    }
    at = {"O": 0.0, "A": points["A"][0], "B": points["B"][0], "O2": bar.pivot}
    on = {"O": ("crank", None), "A": ("coupler", "crank"), "B": ("rocker", "coupler"), "O2": ("rocker", None)}
    matrix, right = np.zeros((9, 9)), np.zeros(9)
    for k, joint in enumerate(FORCES):
        for link, sign in zip(on[joint], (1.0, -1.0), strict=True):
            for part, force in enumerate((1.0, 1.0j)) if link else ():
                row, arm = 3 * names.index(link), at[joint] - points[link][0]
                matrix[row : row + 3, 2 * k + part] = sign * np.array([force.real, force.imag, turning(arm, force)])
    matrix[2, 8] = 1.0
    gravity = bar.gravity[0] * np.exp(1j * bar.gravity[1])
    for k, name in enumerate(names):
        link, acceleration = bar.links[name], points[name][2]
        force = link.mass * (acceleration - gravity)
        right[3 * k : 3 * k + 3] = force.real, force.imag, link.inertia * found["acceleration"][name, "angle"]
    unknown = np.linalg.solve(matrix, right)
    shaking = {name: -bar.links[name].mass * points[name][2] for name in names}
    return found | {
        **{joint: complex(*unknown[2 * k : 2 * k + 2]) for k, joint in enumerate(FORCES)},
        **dict.fromkeys(TORQUES, unknown[8]),
        "shaking_force": sum(shaking.values()),
        "shaking_moment": sum(
            turning(points[name][0], shaking[name]) - bar.links[name].inertia * found["acceleration"][name, "angle"]
            for name in names
        ),
    }


def turning(arm, force):
    return (np.conj(arm) * force).imag

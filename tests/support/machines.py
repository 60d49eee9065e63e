"""A loaded mechanism in plain numbers, for tests of laws; what it gives, and comparisons to rounding."""

import warnings
from dataclasses import dataclass, field
from math import comb

import numpy as np
import pytest
from scipy.special import binom

import kinetostatics as ks

from .multibody import Body

CLOSE = 1e-13
"""Rounding of a well-conditioned chain of some hundred operations, relative to the largest value of a quantity."""
ANGLES = np.linspace(0.1, 6.2, 31)
KINDS = ("plain", "circle", "cosine law")
LINKS = {
    "crank": (3.0, (0.1, 0.04), 0.2),
    "block": (1.5, (0.02, -0.03), 0.05),
    "coupler": (7.0, (0.4, -0.06), 0.9),
    "slider": (11.0, (-0.05, 0.08), 0.3),
}
VECTORS = ("O", "A", "B", "guide", "shaking_force")
TURNING = ("guide_force", "guide_moment", "slot_force", "shaking_moment")
TORQUES = ("balancing_torque", "balancing_torque_by_power")


@dataclass(frozen=True)
class Machine:
    """A loaded mechanism in plain numbers, so that a law can change any of them; every link has mass everywhere."""

    kind: str
    size: float = 0.3
    mean: float = 0.9
    centre: tuple = (-0.05, 0.03)
    coupler_length: float = 0.8
    guide_angle: float = 0.4
    guide_offset: float = 0.07
    assembly: int = 1
    links: dict = field(default_factory=lambda: dict(LINKS))
    gravity: tuple = (9.81, -1.2)
    spring: tuple = (500.0, 0.8)
    process: float = 40.0
    speed: float = 12.0
    acceleration: float = -30.0

    @property
    def mechanism(self):
        """As the package makes it."""
        names = [name for name in self.links if name != "block" or self.kind != "plain"]
        links = {name: ks.Link(*self.links[name]) for name in names}
        guide = {"guide_angle": self.guide_angle, "guide_offset": self.guide_offset, "assembly": self.assembly}
        if self.kind == "plain":
            return ks.crank_slider(self.size, self.coupler_length, **guide, **links)
        if self.kind == "circle":
            return ks.cam_crank_slider(ks.cams.Circle(self.size, self.centre), self.coupler_length, **guide, **links)
        cam = ks.cams.CosineLaw(self.size, self.mean, self.guide_angle)
        return ks.cam_crank_slider(cam, cam.coupler_length, guide_angle=self.guide_angle, **links)

    @property
    def loads(self):
        """One of each kind."""
        return ks.Gravity(*self.gravity), ks.Spring(*self.spring), ks.ProcessForce(self.process)

    def solve(self, angle=ANGLES, loads=None, **motion):
        """Solution at its own speed and under its own loads unless told."""
        motion = {"crank_speed": self.speed, "crank_acceleration": self.acceleration} | motion
        return ks.solve(self.mechanism, angle, loads=self.loads if loads is None else loads, **motion)


every_kind = pytest.mark.parametrize("kind", KINDS)


def results(s):
    """All forces and moments by name; a vector as a complex number."""
    found = {name: planar(s.shaking_force if name == "shaking_force" else s.reaction(name)) for name in VECTORS}
    cam = ("cam_force",) if "cam-balanced" in s.mechanism.name else ()
    turning = [name for name in TURNING if cam or name != "slot_force"]
    return found | {name: getattr(s, name) for name in (*turning, *TORQUES, *cam)}


def motions(s):
    """Positions, velocities and accelerations of all joints and mass centres, complex."""
    points = ("A", "B", *s.mechanism.links)
    return {
        (order, point): planar(getattr(s, order)(point))
        for order in ("position", "velocity", "acceleration")
        for point in points
    }


def planar(vector):
    return vector[0] + 1j * vector[1]


def assert_equal(found, expected, tolerance=CLOSE):
    """Every quantity close relative to its own largest value; the message lists all that are not."""
    assert set(found) == set(expected)
    errors = {name: largest(found[name] - expected[name]) / largest(expected[name]) for name in expected}
    assert {name: float(error) for name, error in errors.items() if not error < tolerance} == {}


def largest(values):
    return np.max(np.abs(values))


def assert_close(found, expected, tolerance=CLOSE):
    assert largest(np.subtract(found, expected)) < tolerance * largest(expected)


def turning(arm, force):
    """Moment of a complex force at a complex arm."""
    return (np.conj(arm) * force).imag


# Four-bars


BARS = {
    "crank": Body(3.0, (0.1, 0.04), 0.2),
    "coupler": Body(7.0, (0.4, -0.06), 0.9),
    "rocker": Body(5.0, (0.3, 0.08), 0.4),
}
BAR_FORCES = ("O", "A", "B", "O2")
TURN = np.linspace(0.0, 2 * np.pi, 721) + 0.001


@dataclass(frozen=True)
class FourBar:
    """A loaded four-bar in plain numbers, so that a law can change any of them; a crank-rocker unless told."""

    crank: float = 0.3
    coupler: float = 0.8
    rocker: float = 0.6
    pivot: complex = 0.7 + 0.4j
    assembly: int = 1
    links: dict = field(default_factory=lambda: dict(BARS))
    gravity: tuple = (9.81, -1.2)
    speed: float = 12.0
    acceleration: float = -30.0

    def solve(self, angle=ANGLES, **motion):
        """Solution of the package, at its own speed unless another is given."""
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


def bar_results(s):
    """All forces and moments by name; a vector as a complex number."""
    found = {name: planar(s.reaction(name)) for name in BAR_FORCES} | {"shaking_force": planar(s.shaking_force)}
    return found | {name: getattr(s, name) for name in (*TORQUES, "shaking_moment")}


def four_bar_of(lengths, frame_angle=0.0, assembly=1):
    """Four-bar of the package with lengths of crank, coupler, rocker and frame."""
    *links, frame = lengths
    pivot = frame * np.exp(1j * frame_angle)
    return ks.four_bar(*links, rocker_pivot=(pivot.real, pivot.imag), assembly=assembly)


def swept(mechanism, angle=TURN):
    """Its solution over the turn, NaN where it does not close."""
    return ks.solve(mechanism, angle, crank_speed=1.0, on_gap="nan")


def second_harmonic(ratio):
    """A2 = lambda + lambda^3 / 4 + 15 lambda^5 / 128 + ... of the acceleration of a piston, lambda = crank / rod.

    From the binomial series of sqrt(1 - lambda^2 sin^2 phi) and the second cosine coefficients of its powers.
    """
    return sum(-8 * (-1) ** k * binom(0.5, k) * comb(2 * k, k - 1) / 4**k * ratio ** (2 * k - 1) for k in range(1, 40))

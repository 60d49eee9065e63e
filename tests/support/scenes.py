"""Scenes on every engine: mechanisms under all loads, what users bring of their own, and batches of designs."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

import kinetostatics as ks
from kinetostatics.machine.group import Group, Output, Resolved
from kinetostatics.machine.links import LinkMotion, Wrench

from .machines import FourBar


def six_bar(mass=3.0):
    """A four-bar whose rocker pin drives a slider: crank, coupler, rocker, second coupler, slider."""
    return ks.Mechanism(
        "six-bar",
        ks.Crank(0.1, ks.Link(1.0, 0.05, 0.01)),
        (
            ks.RockerGroup(0.4, 0.3, (0.35, 0.1), coupler=ks.Link(2.0, 0.2, 0.03), rocker=ks.Link(2.0, 0.1, 0.02)),
            ks.SliderGroup(0.5, on="B", pin="C", label="2", coupler=ks.Link(1.0, 0.2, 0.02), slider=ks.Link(mass)),
        ),
    )


SPEED = 320 * 2 * math.pi / 60
ANGLES = np.linspace(0, 2 * math.pi, 360, endpoint=False)


def scene(mechanism, *loads, acceleration=0.0):
    """A mechanism at the sawframe's speed under loads."""
    return ks.Scene(mechanism, SPEED, acceleration, loads)


LIGHT = {"coupler": ks.Link(150.0, 1.0, 20.5), "slider": ks.Link(600.0)}
HEAVY = {
    "crank": ks.Link(80.0, (0.1, 0.03), 2.0),
    "coupler": ks.Link(150.0, (0.9, -0.1), 20.5),
    "slider": ks.Link(600.0, (0.2, 0.05), 5.0),
}
BLOCK = ks.Link(30.0, (0.02, 0.01), 0.5)
COSINE = ks.cams.CosineLaw(0.3, 2.0)
BALANCING = ks.Spring.balancing(600.0, SPEED, 2.0)
SCENES = {
    "plain, weightless": scene(ks.crank_slider(0.3, 2.0, **LIGHT)),
    "plain": scene(ks.crank_slider(0.3, 2.0, **LIGHT), ks.Gravity()),
    "plain, everything": scene(
        ks.crank_slider(0.3, 2.0, guide_angle=0.3, guide_offset=0.1, assembly=-1, **HEAVY),
        ks.Gravity(),
        ks.Spring(1e4, -1.0),
        ks.ProcessForce(2500.0),
        acceleration=40.0,
    ),
    "circle cam": scene(
        ks.cam_crank_slider(ks.cams.Circle(0.3, (-0.0219, 0.0)), 2.0219, **LIGHT), ks.Gravity(), BALANCING
    ),
    "cosine cam": scene(ks.cam_crank_slider(COSINE, COSINE.coupler_length, **LIGHT), ks.Gravity(), BALANCING),
    "circle cam, everything": scene(
        ks.cam_crank_slider(
            ks.cams.Circle(0.3, (0.02, 0.01)), 2.0, guide_angle=0.3, guide_offset=0.1, block=BLOCK, **HEAVY
        ),
        ks.Gravity(),
        BALANCING,
        ks.ProcessForce(2500.0),
        acceleration=40.0,
    ),
    "four-bar": scene(FourBar(assembly=-1).solve().mechanism, ks.Gravity(9.81, -1.2), acceleration=40.0),
    "six-bar": scene(
        six_bar(),
        ks.Gravity(),
        ks.Spring(100.0, 0.5, on="slider2"),
        ks.ProcessForce(30.0, "slider2"),
        acceleration=40.0,
    ),
}


def solve(scene, angles, **options):
    given = {name: getattr(scene, name) for name in ("crank_speed", "crank_acceleration", "loads")}
    return ks.solve(scene.mechanism, angles, **given | options)


def everything(solution):
    """Names of all forces, moments, torques and rates, and of the motion of a slider."""
    links = [link + ending for link in solution.mechanism.links for ending in ("_rate", "_angular_acceleration")]
    slider = [f"slider_{order}" for order in ("position", "velocity", "acceleration")]
    cam = ["pressure_angle"] if "cam_force" in solution.scalars else []
    return (
        *solution.reactions,
        *solution.scalars,
        "balancing_torque_by_power",
        "shaking_force",
        "shaking_moment",
        *links,
        *(slider if "slider" in solution.mechanism.links else ()),
        *cam,
    )


@dataclass(frozen=True, eq=False)
class Wave(ks.cams.Cam):
    """A cam of the user's own, by operations that numbers can record."""

    mean: Any
    amplitude: Any

    def polar(self, angle, ray):
        """Waves around a circle."""
        return self.mean + self.amplitude * ray[0], -self.amplitude * ray[1], -self.amplitude * ray[0]


@dataclass(frozen=True, eq=False)
class Steps(ks.cams.Cam):
    """A cam of the user's own, by a function that takes plain numbers only."""

    radii: Any

    def polar(self, angle, ray):
        """Straight lines between the radii."""
        turn = np.linspace(0, 2 * np.pi, len(self.radii))
        return tuple(np.interp(angle, turn, np.roll(self.radii, shift), period=2 * np.pi) for shift in range(3))


@dataclass(frozen=True, eq=False)
class Pan(Group):
    """A group of the user's own: a link that hangs on the crank pin and does not turn."""

    pan: ks.Link
    closing: Any = 1.0
    on: str = "A"

    links = property(lambda self: {"pan": self.pan})
    references = property(lambda self: {"pan": self.on})
    joints = property(lambda self: {})
    outputs = property(lambda self: {"A pan": Output("N", True), "pan moment": Output("N m")})

    def place(self, placement):
        """Add the pan."""
        placement.links["pan"] = LinkMotion(placement.joints[self.on], (1.0, 0.0), None, None)

    def closure(self, placement):
        """Nothing can keep it from closing."""
        return self.closing + 0.0 * placement.joints[self.on].position[0]

    def requirement(self, placement):
        """Never asked for."""

    def resolve(self, placement, loads, along):
        """Force at the pin, and the moment that keeps the pan level."""
        x, y = loads["pan"].force
        moment = -loads["pan"].moment
        return Resolved({"A pan": (-x, -y)}, {"pan moment": moment}, {self.on: Wrench((-x, -y), None)})


def with_group(group):
    return scene(ks.Mechanism("crank with a pan", ks.Crank(0.3, ks.Link(2.0, 0.1)), (group,)), ks.Gravity())


TABLE = np.linspace(0, 2 * np.pi, 40, endpoint=False)
OWN = {
    "cam that can be recorded": (scene(ks.cam_crank_slider(Wave(0.3, 0.05), 2.0, **HEAVY), ks.Gravity()), 0),
    "cam of plain numbers": (scene(ks.cam_crank_slider(Steps(0.3 + 0.05 * np.cos(TABLE)), 2.0, **HEAVY)), 1),
    "sampled cam": (scene(ks.cam_crank_slider(ks.cams.Sampled(TABLE, 0.3 + 0.05 * np.cos(TABLE)), 2.0, **HEAVY)), 1),
    "group": (with_group(Pan(ks.Link(3.0, (0.05, -0.1), 0.2))), 0),
}
FORCES = {
    "constant": (2500.0, 0),
    "array over the crank angles": (1e3 * np.sin(ANGLES), 1),
    "function that can be recorded": (lambda motion: -40.0 * motion.slider_velocity * motion.slider_velocity, 0),
    "function of plain numbers": (lambda motion: np.where(motion.slider_velocity > 0, -2e3, 1e2), 1),
    "function that gives a table": (lambda motion: 1e3 * np.cos(ANGLES), 1),
    "function that looks at other angles": (lambda motion: 1e3 * motion.travel() / motion.travel().mean(axis=-1), 1),
    "function that looks for an angle": (lambda motion: 1e3 * (motion.crank_angle == ANGLES[3]), 1),
    "function that counts angles": (lambda motion: motion.travel() * np.arange(motion.crank_angle.size), 1),
}
SIZES = np.array([[0.2], [0.3], [0.37]])
SAMPLES = ANGLES[::12]
BATCHES = {
    "lengths, masses and force": lambda: ks.solve(
        ks.crank_slider(SIZES, 2.0, coupler=ks.Link(150.0 * SIZES, SIZES, 20.5), slider=ks.Link(600.0)),
        SAMPLES,
        crank_speed=SPEED,
        loads=[ks.Gravity(9.81, SIZES), ks.ProcessForce(1e4 * SIZES)],
    ),
    "two axes": lambda: ks.solve(
        ks.crank_slider(SIZES, np.array([1.5, 2.0])[:, None, None], **HEAVY), SAMPLES, crank_speed=SPEED
    ),
    "guide": lambda: ks.solve(
        ks.crank_slider(0.3, 2.0, guide_angle=SIZES - 0.2, guide_offset=0.1 * SIZES, **HEAVY),
        SAMPLES,
        crank_speed=SPEED,
    ),
    "pivot in a list": lambda: ks.solve(
        ks.four_bar(0.1, 1.0, 0.9, rocker_pivot=[0.7, SIZES], rocker=ks.Link(1.0)), SAMPLES, crank_speed=SPEED
    ),
    "cam": lambda: ks.solve(
        ks.cam_crank_slider(ks.cams.Circle(SIZES, (0.1 * SIZES, 0.01)), 2.0, **HEAVY), SAMPLES, crank_speed=SPEED
    ),
    "crank speed": lambda: solve(
        SCENES["plain, everything"], SAMPLES, crank_speed=100 * SIZES, crank_acceleration=SIZES
    ),
    "crank speed by angle": lambda: solve(
        SCENES["plain, everything"], SAMPLES, crank_speed=SPEED + SAMPLES, crank_acceleration=np.cos(SAMPLES)
    ),
    "crank speed by design and angle, other lengths": lambda: ks.solve(
        ks.crank_slider(SIZES[:2], 2.0, **HEAVY), SAMPLES, crank_speed=SPEED * SIZES[:, None] + SAMPLES
    ),
    "crank angles": lambda: solve(SCENES["plain, everything"], SAMPLES + SIZES),
    "crank angles, other lengths, sampled cam, table": lambda: ks.solve(
        ks.cam_crank_slider(ks.cams.Sampled(TABLE, 0.3 + 0.05 * np.cos(TABLE)), 2.0 + SIZES[:2], **HEAVY),
        SAMPLES + SIZES[:, None],
        crank_speed=SPEED,
        loads=ks.ProcessForce(1e3 * np.sin(SAMPLES)),
    ),
}


BATCH = ks.solve(ks.crank_slider(0.3, 2.0, slider=ks.Link(np.array([[1.0], [2.0]]))), 0.1, crank_speed=1.0)
"""Two designs."""
PASSING = ks.solve(
    ks.four_bar(0.1, 0.4, 0.1, rocker_pivot=(0.4, 0.0), assembly="open"),
    0.1,
    crank_speed=1.0,
    loads=ks.Torque(5.0, on="coupler"),
)
"""Forces grow without bound at the change points that it passes."""


class OneSided(Pan):
    """A group that looks at values: it is there on one side only."""

    def resolve(self, placement, loads, along):
        """Look at the side."""
        found = super().resolve(placement, loads, along)
        return found if placement.joints["A"].position[0].sum() > 0 else found._replace()

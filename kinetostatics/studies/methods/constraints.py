"""Constraint equations of a whole mechanism, from which follow its motion, and all its forces by one linear system.

Every moving link has three coordinates in q: x and y of its reference joint, and its angle theta. Joints, guides,
slot, cam and drive give as many constraint equations C(q, phi) = 0 with Jacobian J = dC/dq (Nikravesh, *Computer-Aided
Analysis of Mechanical Systems*; Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*):

    J qdot = -omega dC/dphi        J qddot = gamma - alpha dC/dphi        J^T lambda = M qddot - Q

Each equation is written so that its multiplier in lambda is a reaction, signed as in the library, or the drive torque.
"""

from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...machine.cam_roller import CamRoller
from ...machine.cylinder_group import CylinderGroup
from ...machine.dyad import Dyad
from ...machine.group import FRAME
from ...machine.guided_follower import GuidedFollower
from ...machine.lever_group import LeverGroup
from ...machine.pin import Pin
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.swinging_follower import SwingingFollower
from ...machine.yoke_group import YokeGroup
from ...numbers.planar import left
from .followers import Following
from .method import NotGivenError

POSITION, RATE, ACCELERATION, FORCE = range(4)


class Sliding(NamedTuple):
    """Equation `row`: the reference joint of one link stays on a straight slot of another.

    The slot runs at the angle of `way`, a complex unit vector, to the direction of its link, at `offset` to the left of
    that link's reference joint.
    """

    row: int
    slotted: int
    block: int
    way: complex
    offset: float


class Model:
    """Constraint equations and masses of a mechanism with k links, in coordinates q (..., 3k): all x, all y, all theta.

    Apart from those of slots and cam, which the configuration fills in, the equations are linear in the terms
    (q, cos theta, sin theta, 1, phi).

    Attributes
    ----------
    equations : array (3k, 5k + 2)
        Coefficients of these terms.
    readings : dict
        By quantity: what it is read from, POSITION q, RATE qdot, ACCELERATION qddot or FORCE lambda, and the
        coefficients (components, 3k) that make it.
    """

    def __init__(self, mechanism):
        self.mechanism = mechanism
        self.names = list(mechanism.links)
        self.size = len(self.names)
        self.equations: Any = []
        self.readings: dict[str, tuple[int, Any]] = {}
        self.guides: dict[str, complex] = {}
        self.cam = None
        self.slidings: list[Sliding] = []
        self.followings: list[Following] = []
        self._held: list[tuple[str, str | None, float]] = []
        *self._terms, (self._one, self._phi) = np.split(np.eye(5 * self.size + 2), np.arange(1, 6) * self.size)
        self._write()
        self.equations = np.array(self.equations)
        self.linear, self.of_cosine, self.of_sine, _ = np.split(self.equations, np.arange(3, 6) * self.size, axis=1)
        self.drive = -self.equations @ self._phi
        links = mechanism.links.values()
        self.mass, self.inertia = (np.array([getattr(link, name) for link in links]) for name in ("mass", "inertia"))
        self.centre = np.array([complex(*link.centre) for link in links])

    def _write(self):
        self._add("O", *self._point("crank"))
        self._add("balancing_torque", self._theta("crank") - self._phi)
        for group in self.mechanism.groups:
            kinds = [kind for kind in type(group).__mro__ if kind in self._writers]
            if not kinds:
                raise NotGivenError(f"no constraint equations are written for {type(group).__name__}")
            self._writers[kinds[0]](self, group)
        for name in self.names:
            turning = self._theta(name)[None, : 3 * self.size]
            self.readings |= {f"{name}_rate": (RATE, turning), f"{name}_angular_acceleration": (ACCELERATION, turning)}

    def _write_roller(self, group):
        self.cam, self.block = group.cam, self.names.index("block")
        self._slide("slot_force", "crank", "block")
        self.contact = len(self.equations)
        self._add("cam_force", 0.0 * self._one)
        self._turn("slot_moment", "block", "crank")

    def _write_slider(self, group):
        coupler, slider = group.links
        self._pin(group.on + group.label, coupler, group.on)
        self._add(group.pin, *(self._joint(group.pin) - self._point(coupler, group.coupler_length)))
        self._add_guide(group, slider)

    def _write_rocker(self, group):
        coupler, rocker = group.links
        self._pin(group.on + group.label, coupler, group.on)
        self._add(group.pin, *(self._joint(group.pin) - self._point(coupler, group.coupler_length)))
        self._pin(group.pivot_name, rocker, group.pivot_name)

    def _write_dyad(self, group):
        first, second = group.links
        for link, joint in zip(group.links, group.on, strict=True):
            self._pin(f"{link}_{joint}", link, joint)
        self._add(group.pin, *(self._point(second, group.length2) - self._point(first, group.length1)))

    def _write_lever(self, group):
        lever, block = group.links
        self._pin(group.on + group.label, block, group.on)
        self._pin(group.pivot_name, lever, group.pivot_name)
        self._slide("slot_force" + group.label, lever, block, offset=group.offset)
        self._turn("slot_moment" + group.label, block, lever)

    def _write_cylinder(self, group):
        rod, cylinder = group.links
        self._pin(group.on + group.label, rod, group.on)
        self._pin(group.pivot_name, cylinder, group.pivot_name)
        self._slide("cylinder_force" + group.label, rod, cylinder)
        self._turn("cylinder_moment" + group.label, rod, cylinder, np.pi)

    def _write_yoke(self, group):
        block, slider = group.links
        self._add_guide(group, slider)
        self._pin(group.on + group.label, block, group.on)
        self._slide("slot_force" + group.label, slider, block, np.exp(1j * group.slot_angle))
        self._turn("slot_moment" + group.label, block, slider, group.slot_angle)

    def _write_guided(self, group):
        (follower,) = group.links
        self._add_guide(group, follower)
        self._follow(group, follower, 0.0)

    def _write_swinging(self, group):
        (arm,) = group.links
        self._pin(group.pivot_name, arm, group.pivot_name)
        self._follow(group, arm, group.arm_length)

    def _follow(self, group, link, along):
        """Keep a point of a link on the cam of a group."""
        places = self.names.index("crank"), self.names.index(link)
        self.followings.append(Following(len(self.equations), *places, along, group))
        self._add("contact_force" + group.label, 0.0 * self._one)

    _writers: ClassVar[dict[type, Any]] = {
        CamRoller: _write_roller,
        SliderGroup: _write_slider,
        RockerGroup: _write_rocker,
        Dyad: _write_dyad,
        LeverGroup: _write_lever,
        CylinderGroup: _write_cylinder,
        YokeGroup: _write_yoke,
        GuidedFollower: _write_guided,
        SwingingFollower: _write_swinging,
        Pin: lambda self, group: None,
    }

    def _joint(self, name):
        """Joint by name, (2, terms)."""
        point = self.mechanism.joints[name]
        if point.link == FRAME:
            return np.multiply.outer((point.along, point.across), self._one)
        return self._point(point.link, point.along, point.across)

    def _pin(self, name, link, joint):
        """Hold the reference joint of a link at a joint."""
        self._add(name, *(self._point(link) - self._joint(joint)))

    def _turn(self, name, link, other, ahead=0.0):
        """Keep a link at an angle from another."""
        self._held.append((link, other, ahead))
        self._add(name, self._theta(link) - self._theta(other) - ahead * self._one)

    def _slide(self, name, slotted, block, way=1.0, offset=0.0):
        """Keep the reference joint of a link on a slot of another."""
        places = self.names.index(slotted), self.names.index(block)
        self.slidings.append(Sliding(len(self.equations), *places, way, offset))
        self._add(name, 0.0 * self._one)

    def _add_guide(self, group, slider):
        guide, pin = group.guide, self._joint(group.pin)
        self._held.append((slider, None, guide.guide_angle))
        along, across = np.array(guide.direction), np.array(left(guide.direction))
        self.guides[slider] = complex(*along)
        force = self._add("guide_force" + group.label, across @ pin - guide.guide_offset * self._one)
        self._add("guide_moment" + group.label, self._theta(slider) - guide.guide_angle * self._one)
        self.readings["guide" + group.label] = (FORCE, across[:, None] * force)
        for name, order in {"position": POSITION, "velocity": RATE, "acceleration": ACCELERATION}.items():
            self.readings[f"{slider}_{name}"] = (order, (along @ pin)[None, : 3 * self.size])

    def _add(self, name, *equations):
        """Add equations; their multipliers are the components of the force or moment `name`."""
        start = len(self.equations)
        self.equations += equations
        found = np.eye(3 * self.size)[start : len(self.equations)]
        self.readings[name] = (FORCE, found)
        return found

    def _point(self, link, along=0.0, across=0.0):
        """Point of a link at so far along it and across it, to the left, (2, terms)."""
        x, y, _, cosine, sine = (term[self.names.index(link)] for term in self._terms)
        return np.array([x + along * cosine - across * sine, y + along * sine + across * cosine])

    def _theta(self, link):
        return self._terms[2][self.names.index(link)]

    def start(self, angle):
        """The library's position at one crank angle as coordinates, from which continuation starts."""
        links = self.mechanism.place(np.array(angle)).links
        x, y, ahead, aside = np.array([(*links[k].joint.position, *links[k].direction) for k in self.names], float).T
        theta = _nearest(np.arctan2(aside, ahead), angle)
        for link, other, ahead in self._held:
            place = self.names.index(link)
            wanted = ahead + (0.0 if other is None else theta[self.names.index(other)])
            theta[place] = _nearest(theta[place], wanted)
        return np.concatenate([x, y, theta])


def _nearest(angle, wanted):
    """The angle less or plus whole turns, next to another."""
    return angle + 2 * np.pi * np.rint((wanted - angle) / (2 * np.pi))

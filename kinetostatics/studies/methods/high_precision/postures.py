"""Postures of the independent path: joints and links by angles in mpmath numbers, by formulas of their own."""

from typing import Any

import numpy as np

from ....errors import NotGivenError
from ....machine.cams.cam_roller import CamRoller
from ....machine.cams.cams import Circle, CosineLaw, Harmonic
from ....machine.crank import Pin
from ....machine.followers.follower import GuidedFollower
from ....machine.followers.swinging import SwingingFollower
from ....machine.group import FRAME
from ....machine.groups.change_points import FAR, MEETING, NEAR, OPPOSITE, SIDES, parted
from ....machine.groups.cylinder import CylinderGroup
from ....machine.groups.dyad import Dyad
from ....machine.groups.lever import LeverGroup
from ....machine.groups.rocker import RockerGroup
from ....machine.groups.slider import SliderGroup
from ....machine.groups.yoke import YokeGroup
from ....machine.laws.laws import Cosine


class Posture:
    """Where joints and links are; a planar vector is a complex number."""

    mp: Any
    mechanism: Any
    index: int

    def number(self, value):
        values = np.ravel(value)
        return self.mp.mpf(float(values[self.index if values.size > 1 else 0]))

    def vector(self, pair):
        return self.mp.mpc(*map(self.number, pair))

    def along(self, guide):
        """Unit vector of a guide: by its angle, which is given exactly, or by the direction that two points gave it."""
        if guide.exact is None:
            return self.mp.expj(self.number(guide.angle))
        direction = self.vector(guide.exact)
        return direction / abs(direction)

    def table(self, angle):
        """Joints, mass centres and directions of links at a crank angle."""
        ray = self.mp.expj(angle)
        self._angle = angle
        joints, links = {"O": self.mp.mpc(0)}, {"crank": ("O", ray)}
        if self.mechanism.crank.length is not None:
            joints["A"] = self.number(self.mechanism.crank.length) * ray
        for group in self.mechanism.groups:
            if isinstance(group, CamRoller):
                joints["A"], links["block"] = self.roller(group.cam, angle), ("A", ray)
            else:
                of_kind(ADD, group)(self, group, joints, links)
        found = {("joint", name): place for name, place in joints.items()}
        for name, (joint, direction) in links.items():
            found["centre", name] = joints[joint] + self.vector(self.mechanism.links[name].centre) * direction
            found["direction", name] = direction
        return found

    def side(self, group):
        """Side of a group, which changes at each change point that it passes."""
        side = SIDES.get(group.assembly, group.assembly)
        if not group.passes:
            return side
        (kind, _), slides = parted(group.passage), isinstance(group, SliderGroup)
        start = -1j * self.along(group.guide) if slides else self.vector(group.pivot)
        throw = self.mechanism.throws[group.on]
        psi = self._angle - self.mp.arg(start if throw.ahead else start / self.vector(throw.at))
        half = self.mp.sin(psi / 2)
        passed = {FAR: self.mp.cos(psi / 2), NEAR: half, MEETING: half, OPPOSITE: half}
        return side * self.mp.sign(passed.get(kind, self.mp.sin(psi)))

    def add_slider(self, group, joints, links):
        mp, side = self.mp, self.side(group)
        coupler, slider = group.links
        start, length = joints[group.on], self.number(group.coupler_length)
        along = self.along(group.guide)
        lean = mp.asin((self.number(group.guide.guide_offset) - cross(along, start)) / length)
        direction = mp.expj(mp.arg(along) + (lean if side > 0 else mp.pi - lean))
        joints[group.pin] = start + length * direction
        links[coupler], links[slider] = (group.on, direction), (group.pin, along)

    def add_rocker(self, group, joints, links):
        mp, side = self.mp, self.side(group)
        coupler, rocker = group.links
        start, pivot = joints[group.on], self.vector(group.pivot)
        c, h, a = self.number(group.coupler_length), self.number(group.rocker_length), abs(pivot - start)
        opening = mp.acos((a * a + c * c - h * h) / (2 * a * c))
        direction = mp.expj(mp.arg(pivot - start) + side * opening)
        joints[group.pin], joints[group.pivot_name] = start + c * direction, pivot
        links[coupler], links[rocker] = (group.on, direction), (group.pivot_name, (joints[group.pin] - pivot) / h)

    def add_dyad(self, group, joints, links):
        mp = self.mp
        first, second = (joints[name] for name in group.on)
        a, b, d = self.number(group.length1), self.number(group.length2), abs(second - first)
        opening = mp.acos((d * d + a * a - b * b) / (2 * d * a))
        direction = mp.expj(mp.arg(second - first) + group.assembly * opening)
        joints[group.pin] = first + a * direction
        directions = direction, (joints[group.pin] - second) / b
        links |= {link: part for link, *part in zip(group.links, group.on, directions, strict=True)}

    def add_pin(self, group, joints, links):
        joint, direction = ("O", 1) if group.on == FRAME else links[group.on]
        joints[group.name] = joints[joint] + self.vector(group.at) * direction

    def add_lever(self, group, joints, links):
        mp, side = self.mp, self.side(group)
        lever, block = group.links
        joints[group.pivot_name] = pivot = self.vector(group.pivot)
        to_pin = joints[group.on] - pivot
        lean = mp.asin(self.number(group.offset) / abs(to_pin))
        direction = mp.expj(mp.arg(to_pin) - (lean if side > 0 else mp.pi - lean))
        links[lever], links[block] = (group.pivot_name, direction), (group.on, direction)

    def add_cylinder(self, group, joints, links):
        rod, cylinder = group.links
        joints[group.pivot_name] = pivot = self.vector(group.pivot)
        direction = self.mp.expj(self.mp.arg(joints[group.on] - pivot))
        links[rod], links[cylinder] = (group.on, -direction), (group.pivot_name, direction)

    def add_yoke(self, group, joints, links):
        block, slider = group.links
        along = self.along(group.guide)
        way = along * self.mp.expj(self.number(group.slot_angle))
        foot = left(along) * self.number(group.guide.guide_offset)
        joints[group.pin] = foot + cross(joints[group.on] - foot, way) / cross(along, way) * along
        links[block], links[slider] = (group.on, way), (group.pin, along)

    def add_guided(self, group, joints, links):
        (follower,) = group.links
        joints[group.pin], direction = self.followed(group, self._angle)
        links[follower] = group.pin, direction

    def add_swinging(self, group, joints, links):
        (arm,) = group.links
        joints[group.pivot_name] = self.vector(group.pivot)
        joints[group.pin], direction = self.followed(group, self._angle)
        links[arm] = group.pivot_name, direction

    def followed(self, group, angle):
        """Roller centre, or middle of the face, and direction of a follower at a crank angle."""
        law = group.cam.law
        if not isinstance(law, Cosine):
            raise NotGivenError(f"there is no independent formula for a law {type(law).__name__}")
        mean, amplitude, phase = map(self.number, (law.mean, law.amplitude, law.phase))
        value = mean + amplitude * self.mp.cos(angle - phase)
        if isinstance(group, SwingingFollower):
            pivot = self.vector(group.pivot)
            direction = self.mp.expj(self.mp.arg(-pivot) - group.assembly * value)
            return pivot + self.number(group.arm_length) * direction, direction
        along = self.along(group.guide)
        return along * self.mp.mpc(value, self.number(group.guide.guide_offset)), along

    def roller(self, cam, angle):
        """Roller centre A on the crank ray."""
        mp = self.mp
        if isinstance(cam, Circle):  # sine rule in the triangle of O, centre and A
            centre, radius = self.vector(cam.centre), self.number(cam.pitch_radius)
            return centre + radius * mp.expj(angle - mp.asin(cross(mp.expj(angle), centre) / radius))
        if isinstance(cam, CosineLaw):  # at the critical length from B: radicand as it stands, root with a sign
            a, b = self.number(cam.amplitude), self.number(cam.mean)
            turning = mp.acos((mp.sqrt(b * b + 8 * a * a) - b) / (4 * a))
            length = (b + a * mp.cos(turning)) * mp.sin(turning)
            from_guide = angle - self.number(cam.guide_angle)
            slider = b + a * mp.cos(from_guide)
            root = mp.sqrt(length**2 - (slider * mp.sin(from_guide)) ** 2)
            side = mp.sign(mp.cos(from_guide) - mp.cos(turning))
            return (slider * mp.cos(from_guide) - side * root) * mp.expj(angle)
        if isinstance(cam, Harmonic):
            from_guide = angle - self.number(cam.guide_angle)
            cosine = mp.fsum(self.number(a) * mp.cos(k * from_guide) for k, a in enumerate(cam.cosine))
            sine = mp.fsum(self.number(b) * mp.sin(k * from_guide) for k, b in enumerate(cam.sine, 1))
            return (cosine + sine) * mp.expj(angle)
        raise NotGivenError(f"there is no independent formula for cam {type(cam).__name__}")


ADD: Any = {
    SliderGroup: Posture.add_slider,
    RockerGroup: Posture.add_rocker,
    Dyad: Posture.add_dyad,
    Pin: Posture.add_pin,
    LeverGroup: Posture.add_lever,
    CylinderGroup: Posture.add_cylinder,
    YokeGroup: Posture.add_yoke,
    GuidedFollower: Posture.add_guided,
    SwingingFollower: Posture.add_swinging,
}
"""How each kind of group is placed."""


def of_kind(table, group):
    """Entry of a table by kind of group."""
    for kind in type(group).__mro__:
        if kind in table:
            return table[kind]
    raise NotGivenError(f"there is no independent formula for a {type(group).__name__}")


def left(a):
    return a * 1j


def dot(a, b):
    return (a.conjugate() * b).real


def cross(a, b):
    return (a.conjugate() * b).imag

"""Check of the certified reference: mpmath numbers, independent formulas, all forces from one linear system.

It reads only joints and bodies of the mechanism. Positions follow from angles, velocities and accelerations from
difference quotients of positions, all forces from the Newton-Euler equations. A plane vector is a complex number.
"""

from collections.abc import Iterable
from functools import singledispatchmethod
from typing import Any

import numpy as np

from ....errors import NotGivenError
from ....machine.cams.cam_roller import CamRoller
from ....machine.cams.cams import Circle, CosineLaw, Harmonic
from ....machine.crank import Pin
from ....machine.followers.swinging import SwingingFollower
from ....machine.followers.translating import GuidedFollower
from ....machine.group import FRAME, TRAVELS
from ....machine.groups.change_points import FAR, MEETING, NEAR, OPPOSITE, SIDES, parse_carrier, parse_passage
from ....machine.groups.lever import CylinderGroup, LeverGroup
from ....machine.groups.rocker import Dyad, RockerGroup
from ....machine.groups.slider import SliderGroup
from ....machine.groups.yoke import YokeGroup
from ....machine.laws.laws import Cosine
from ....machine.loads import Gravity, has_no_user_code
from ....mechanics.quantities import RATES
from ....numbers import checks
from ..method import require_moving
from ..structures import FrictionForces, LoadForces, cross, dot
from .enclosures import on_arb, require_library, require_one_design


class Posture:
    """Positions of joints and directions of links at a crank angle, in mpmath numbers of one design.

    Attributes are the module `mp`, the `mechanism`, and the `index` of the crank angle in the solution.
    """

    mp: Any
    mechanism: Any
    index: int

    def number(self, value):
        values = np.ravel(value)
        return self.mp.mpf(float(values[self.index if values.size > 1 else 0]))

    def vector(self, pair):
        return self.mp.mpc(*map(self.number, pair))

    def along(self, guide):
        """Unit vector of a guide, from its angle or, for a guide through two points, from their difference."""
        if guide.exact is None:
            return self.mp.expj(self.number(guide.angle))
        direction = self.vector(guide.exact)
        return direction / abs(direction)

    def table(self, angle):
        """Positions at a crank angle: complex by kind and name, ("joint", "centre" or "direction", name), m or 1."""
        ray = self.mp.expj(angle)
        self._angle = angle
        joints, links = {"O": self.mp.mpc(0)}, {"crank": ("O", ray)}
        if self.mechanism.crank.length is not None:
            joints["A"] = self.number(self.mechanism.crank.length) * ray
        for group in self.mechanism.groups:
            self.place(group, joints, links)
        found = {("joint", name): place for name, place in joints.items()}
        for name, (joint, direction) in links.items():
            found["centre", name] = joints[joint] + self.vector(self.mechanism.links[name].centre) * direction
            found["direction", name] = direction
        return found

    def side(self, group, joints, links):
        """Assembly sign of a group, which changes at each change point that it passes."""
        side = SIDES.get(group.assembly, group.assembly)
        if not group.passes:
            return side
        (kind, _), slides = parse_passage(group.passage), isinstance(group, SliderGroup)
        start = -1j * self.along(group.guide) if slides else self.vector(group.pivot)
        if (carrier := parse_carrier(group.passage)) is None:
            throw = self.mechanism.throws[group.on]
            psi = self._angle - self.mp.arg(start if throw.ahead else start / self.vector(throw.at))
        else:
            joint, direction = links[carrier.link]
            turned = carrier.turns * self._angle + carrier.degrees * self.mp.pi / 180
            psi = turned + self.mp.arg(direction / self.mp.expj(turned)) - self.mp.arg(start - joints[joint])
        half = self.mp.sin(psi / 2)
        passed = {FAR: self.mp.cos(psi / 2), NEAR: half, MEETING: half, OPPOSITE: half}
        return side * self.mp.sign(passed.get(kind, self.mp.sin(psi)))

    @singledispatchmethod
    def place(self, group, joints, links):
        """Add joints and links of a group, by its kind."""
        raise NotGivenError(f"there is no independent formula for a {type(group).__name__}")

    @place.register
    def _(self, group: CamRoller, joints, links):
        joints["A"], links["block"] = self.roller(group.cam, self._angle), ("A", links["crank"][1])

    @place.register
    def _(self, group: SliderGroup, joints, links):
        mp, side = self.mp, self.side(group, joints, links)
        coupler, slider = group.links
        start, length = joints[group.on], self.number(group.coupler_length)
        along = self.along(group.guide)
        lean = mp.asin((self.number(group.guide.guide_offset) - cross(along, start)) / length)
        direction = mp.expj(mp.arg(along) + (lean if side > 0 else mp.pi - lean))
        joints[group.pin] = start + length * direction
        links[coupler], links[slider] = (group.on, direction), (group.pin, along)

    @place.register
    def _(self, group: RockerGroup | Dyad, joints, links):
        mp = self.mp
        if isinstance(group, RockerGroup):
            joints[group.pivot_name] = self.vector(group.pivot)
            lengths, ends = (group.coupler_length, group.rocker_length), (group.on, group.pivot_name)
        else:
            lengths, ends = (group.length1, group.length2), group.on
        (a, b), (first, second) = map(self.number, lengths), (joints[name] for name in ends)
        d = abs(second - first)
        opening = mp.acos((d * d + a * a - b * b) / (2 * d * a))
        direction = mp.expj(mp.arg(second - first) + self.side(group, joints, links) * opening)
        joints[group.pin] = first + a * direction
        directions = direction, (joints[group.pin] - second) / b
        links |= {link: part for link, *part in zip(group.links, ends, directions, strict=True)}

    @place.register
    def _(self, group: Pin, joints, links):
        joint, direction = ("O", 1) if group.on == FRAME else links[group.on]
        joints[group.name] = joints[joint] + self.vector(group.at) * direction

    @place.register
    def _(self, group: LeverGroup, joints, links):
        mp, side = self.mp, self.side(group, joints, links)
        lever, block = group.links
        joints[group.pivot_name] = pivot = self.vector(group.pivot)
        to_pin = joints[group.on] - pivot
        lean = mp.asin(self.number(group.offset) / abs(to_pin))
        direction = mp.expj(mp.arg(to_pin) - (lean if side > 0 else mp.pi - lean))
        links[lever], links[block] = (group.pivot_name, direction), (group.on, direction)

    @place.register
    def _(self, group: CylinderGroup, joints, links):
        rod, cylinder = group.links
        joints[group.pivot_name] = pivot = self.vector(group.pivot)
        direction = self.mp.expj(self.mp.arg(joints[group.on] - pivot))
        links[rod], links[cylinder] = (group.on, -direction), (group.pivot_name, direction)

    @place.register
    def _(self, group: YokeGroup, joints, links):
        block, slider = group.links
        along = self.along(group.guide)
        way = along * self.mp.expj(self.number(group.slot_angle))
        foot = left(along) * self.number(group.guide.guide_offset)
        joints[group.pin] = foot + cross(joints[group.on] - foot, way) / cross(along, way) * along
        links[block], links[slider] = (group.on, way), (group.pin, along)

    @place.register
    def _(self, group: GuidedFollower | SwingingFollower, joints, links):
        (follower,), law = group.links, group.cam.law
        if not isinstance(law, Cosine):
            raise NotGivenError(f"there is no independent formula for a law {type(law).__name__}")
        mean, amplitude, phase = map(self.number, (law.mean, law.amplitude, law.phase))
        value = mean + amplitude * self.mp.cos(self._angle - phase)
        if isinstance(group, SwingingFollower):
            joints[group.pivot_name] = pivot = self.vector(group.pivot)
            direction = self.mp.expj(self.mp.arg(-pivot) - group.assembly * value)
            joints[group.pin] = pivot + self.number(group.arm_length) * direction
            links[follower] = group.pivot_name, direction
        else:
            along = self.along(group.guide)
            joints[group.pin] = along * self.mp.mpc(value, self.number(group.guide.guide_offset))
            links[follower] = group.pin, along

    def roller(self, cam, angle):
        """Roller centre A on the crank ray."""
        mp = self.mp
        if isinstance(cam, Circle):  # sine rule in the triangle of O, centre and A
            centre, radius = self.vector(cam.centre), self.number(cam.pitch_radius)
            return centre + radius * mp.expj(angle - mp.asin(cross(mp.expj(angle), centre) / radius))
        if isinstance(cam, CosineLaw):  # its coupler length lets the two branches of the root join smoothly
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


def left(a):
    return a * 1j


def independent(solution, quantity, indices: Iterable[int], digits=30):
    """Components of a quantity at some of a solution's crank angles, a tuple of arrays (n,) of `mpmath.mpf`.

    `digits` are those of the result; the working precision is much higher, because derivatives are difference
    quotients. `NotGivenError` if a group or cam has no independent formulas, the quantity is unknown, or the iteration
    of friction does not converge.
    """
    mp = require_library("mpmath").mp
    require_one_design(solution)
    require_moving(solution)
    with mp.workdps(working_digits(digits)):
        found = [Machine(mp, solution, index, digits).components(quantity) for index in indices]
    return tuple(np.array(part, dtype=object) for part in zip(*found, strict=True))


def working_digits(digits):
    """Working digits: second differences with step 10^-(2 digits) lose 4 digits for each digit of the result."""
    return 6 * digits + 60


class Machine(Posture, LoadForces):
    """A mechanism at one crank angle in mpmath numbers.

    `position`, `velocity` and `acceleration` are tables by kind ("joint", "centre" of mass, "direction") and name.
    """

    def __init__(self, mp, solution, index, digits):
        self.mp, self.solution, self.index = mp, solution, index
        self.expj, self.arg = mp.expj, mp.arg
        self.parts = mp.mpc(1), mp.mpc(1j)
        self.mechanism = solution.mechanism
        self.angle = self.number(solution.crank_angle)
        self.step = h = mp.mpf(10) ** (-2 * digits)
        speed, slope = self.number(solution.crank_speed), self.number(solution.crank_acceleration)
        back, here, ahead = (self.table(self.angle + speed * t + slope * t**2 / 2) for t in (-h, mp.mpf(0), h))
        self.position = here
        self.velocity = {key: (ahead[key] - back[key]) / (2 * h) for key in here}
        self.acceleration = {key: (ahead[key] - 2 * here[key] + back[key]) / h**2 for key in here}

    def components(self, quantity):
        """Components of a quantity by name: (x, y) of a vector, a tuple of one number otherwise."""
        tables, here = (self.position, self.velocity, self.acceleration), self.position
        found = {
            slider + ending: dot(here["direction", slider], table["joint", self.mechanism.references[slider]])
            for slider in self.mechanism.guides
            for ending, table in zip(TRAVELS, tables, strict=True)
        }
        found |= {
            link + ending: cross(here["direction", link], table["direction", link])
            for link in self.mechanism.links
            for ending, table in zip(RATES, tables[1:], strict=True)
        }
        found = found if quantity in found else self.forces()
        if quantity not in found:
            raise NotGivenError(checks.choice("quantity of the independent path", quantity, tuple(found)))
        value = found[quantity]
        return (value.real, value.imag) if isinstance(value, self.mp.mpc) else (value,)

    # Forces, from the equations of all bodies at once

    def forces(self):
        """Forces by name: complex reactions, N, and scalar forces, N, and moments, N m."""
        mp, links, unknowns = self.mp, self.mechanism.links, self.unknowns()
        matrix = mp.matrix(3 * len(links), len(unknowns))
        for column, (_, force, moment, at, on, by) in enumerate(unknowns):
            self.enter(matrix, column, [(on, force, at, moment), (by, -force, at, -moment)])
        items = (item for item in self.solution.loads if isinstance(item, Gravity))
        pulls = (self.number(item.acceleration) * mp.expj(self.number(item.direction)) for item in items)
        gravity = sum(pulls, mp.mpc(0))
        acting, shaking = [*self.effects()], {}
        for name, link in links.items():
            mass, centre = self.number(link.mass), self.position["centre", name]
            turning = cross(self.position["direction", name], self.acceleration["direction", name])
            shaking[name] = -mass * self.acceleration["centre", name], -self.number(link.inertia) * turning
            acting.append((name, shaking[name][0] + mass * gravity, centre, shaking[name][1]))
        triangles, order = mp.LU_decomp(matrix)

        def solve(effects):
            self.enter(right := mp.matrix(3 * len(links), 1), 0, [*acting, *effects])
            return mp.U_solve(triangles, mp.L_solve(triangles, -right, order))

        def named(sizes):
            forces: dict[str, Any] = {}
            for (name, force, *_), size in zip(unknowns, sizes, strict=True):
                forces[name] = forces.get(name, 0) + size * force if name in self.solution.reactions else size
            return forces

        friction = FrictionForces(self)
        found = named(friction.converge(solve, named, lambda sizes: mp.norm(sizes, mp.inf), self.step))
        along = friction.along(found)
        for group in self.mechanism.groups:
            for name in group.guides:
                guide, across = "guide" + group.label, left(self.position["direction", name])
                found[guide] = found["guide_force" + group.label] * across + along.get(guide, 0)
        turning = (cross(self.position["centre", name], force) + moment for name, (force, moment) in shaking.items())
        return found | {
            "balancing_torque_by_power": found["balancing_torque"],
            "shaking_force": sum(force for force, _ in shaking.values()),
            "shaking_moment": sum(turning),
        }

    def enter(self, matrix, column, effects):
        """Add effects, (link, force, point, couple), to the three equations of their links; the frame has none.

        The third equation is that of moments about the mass centre.
        """
        rows = {name: 3 * place for place, name in enumerate(self.mechanism.links)}
        for link, force, at, couple in effects:
            if link in rows:
                row = rows[link]
                matrix[row, column] += self.mp.re(force)
                matrix[row + 1, column] += self.mp.im(force)
                matrix[row + 2, column] += couple + cross(at - self.position["centre", link], self.mp.mpc(force))

    def unknowns(self):
        """Unknowns, a list: name, unit force, unit moment, point, the link acted on, the acting link."""
        none = self.mp.mpc(0)
        at = {name: place for (kind, name), place in self.position.items() if kind == "joint"}
        found: list[tuple[Any, ...]] = [("balancing_torque", none, 1, at["O"], "crank", FRAME)]
        for part in self.declared[0].parts:
            for name, pin in part.pins:
                found += [(name, way, 0, at[pin.joint], pin.link, pin.against) for way in self.parts]
            for _, pair in part.slides:
                ends = at[pair.about], pair.link, pair.against
                found += [(pair.force, left(self.way(pair)), 0, *ends), (pair.couple, none, 1, *ends)]
            found += [(cam.force, *self.contact(cam, at[cam.joint]), cam.link, cam.body) for cam in part.cams]
        return found

    def contact(self, cam, at):
        """Unit contact force of a cam, zero moment, and its point, from the relative motion of the follower."""
        ahead, back = (self.table(self.angle + step)["joint", cam.joint] for step in (self.step, -self.step))
        turning = 0 if cam.body == FRAME else 1
        way = (ahead - back) / (2 * self.step) - turning * left(at)
        if not cam.flat:
            return left(way / abs(way)), 0, at
        axis = self.position["direction", cam.link]
        return axis, 0, at - dot(axis, way) * left(axis)

    def value(self, item):
        """Force or moment of a load, N or N m; tables and users' functions are evaluated on arb numbers."""
        if has_no_user_code(item):
            return self.number(item.value_now)
        flint = require_library("flint")
        with flint.ctx.workprec(int(3.33 * self.mp.dps)):
            values = np.ravel(on_arb(flint.arb, self.solution).loads[self.solution.loads.index(item)].value_now)
            return self.mp.mpf(values[self.index if values.size > 1 else 0])

    def where(self, condition, one, other):
        return one if condition else other

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        joint, axis = self.mechanism.references[link], self.position["direction", link]
        shift = self.velocity["joint", joint]
        return self.position["joint", joint], axis, shift, cross(axis, self.velocity["direction", link])

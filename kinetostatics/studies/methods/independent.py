"""The independent path of the certified reference: mpmath, other formulas, all forces from one linear system.

It knows of the mechanism only its joints and bodies: positions by angles, velocities and accelerations as difference
quotients of positions, all forces at once from the Newton-Euler equations.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...errors import NotGivenError
from ...machine.cam_roller import CamRoller
from ...machine.cams import Circle, CosineLaw
from ...machine.change_points import FAR, MEETING, NEAR, OPPOSITE, SIDES, parted
from ...machine.cylinder_group import CylinderGroup
from ...machine.dyad import Dyad
from ...machine.group import FRAME, TRAVELS
from ...machine.lever_group import LeverGroup
from ...machine.loads import Gravity, Load, ProcessForce, Spring
from ...machine.pin import Pin
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.yoke_group import YokeGroup
from ...mechanics.quantities import RATES
from ...numbers import checks
from .acting import Acting
from .enclosures import library, on_arb, require_one_design


def independent(solution, quantity, indices: Iterable[int], digits=30):
    """A quantity at some of the crank angles by mpmath and other formulas, all forces from one linear system.

    Parameters
    ----------
    solution : Solution
        Of one design; of the library's groups, `CamRoller` with `Circle` or `CosineLaw`.
    quantity : str
        Balancing torque, a reaction, force or moment, rate or angular acceleration of a link, motion of a slider,
        shaking force or moment; named as for `quantities.components`.
    indices : iterable of int
        Which of the solution's crank angles.
    digits : int
        Digits wanted; far more are carried, for derivatives are difference quotients.

    Returns
    -------
    tuple of arrays (n,) of `mpmath.mpf`
        Components of the quantity.

    Raises
    ------
    NotGivenError
        There are no such formulas for a group or cam, or no such quantity.
    MissingLibraryError
        mpmath is not installed.
    """
    mp = library("mpmath").mp
    require_one_design(solution)
    with mp.workdps(working_digits(digits)):
        found = [Machine(mp, solution, index, digits).components(quantity) for index in indices]
    return tuple(np.array(part, dtype=object) for part in zip(*found, strict=True))


def working_digits(digits):
    """Enough for second differences with a step of 10^-(2 digits), which lose 4 digits for each, even near a limit."""
    return 6 * digits + 60


class Machine(Acting):
    """A mechanism at one crank angle in mpmath numbers; a planar vector is a complex number.

    `position`, `velocity` and `acceleration` are tables by kind ("joint", "centre" of mass, "direction") and name.
    """

    def __init__(self, mp, solution, index, digits):
        self.mp, self.solution, self.index = mp, solution, index
        self.parts = mp.mpc(1), mp.mpc(1j)
        self.mechanism = solution.mechanism
        self.angle = self.number(solution.crank_angle)
        self.step = h = mp.mpf(10) ** (-2 * digits)
        speed, slope = self.number(solution.crank_speed), self.number(solution.crank_acceleration)
        back, here, ahead = (self.table(self.angle + speed * t + slope * t**2 / 2) for t in (-h, mp.mpf(0), h))
        self.position = here
        self.velocity = {key: (ahead[key] - back[key]) / (2 * h) for key in here}
        self.acceleration = {key: (ahead[key] - 2 * here[key] + back[key]) / h**2 for key in here}

    def number(self, value):
        values = np.ravel(value)
        return self.mp.mpf(float(values[self.index if values.size > 1 else 0]))

    def vector(self, pair):
        return self.mp.mpc(*map(self.number, pair))

    # Positions, by angles

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
                _of_kind(ADD, group)(self, group, joints, links)
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
        start = -1j * self.vector(group.guide.direction) if slides else self.vector(group.pivot)
        throw = self.mechanism.throws[group.on]
        psi = self._angle - self.mp.arg(start if throw.ahead else start / self.vector(throw.at))
        half = self.mp.sin(psi / 2)
        passed = {FAR: self.mp.cos(psi / 2), NEAR: half, MEETING: half, OPPOSITE: half}
        return side * self.mp.sign(passed.get(kind, self.mp.sin(psi)))

    def add_slider(self, group, joints, links):
        mp, side = self.mp, self.side(group)
        coupler, slider = group.links
        start, length = joints[group.on], self.number(group.coupler_length)
        along = self.vector(group.guide.direction)
        along /= abs(along)
        lean = mp.asin((self.number(group.guide.guide_offset) - _cross(along, start)) / length)
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
        along = self.vector(group.guide.direction)
        along /= abs(along)
        way = along * self.mp.expj(self.number(group.slot_angle))
        foot = _left(along) * self.number(group.guide.guide_offset)
        joints[group.pin] = foot + _cross(joints[group.on] - foot, way) / _cross(along, way) * along
        links[block], links[slider] = (group.on, way), (group.pin, along)

    def roller(self, cam, angle):
        """Roller centre A on the crank ray."""
        mp = self.mp
        if isinstance(cam, Circle):  # sine rule in the triangle of O, centre and A
            centre, radius = self.vector(cam.centre), self.number(cam.pitch_radius)
            return centre + radius * mp.expj(angle - mp.asin(_cross(mp.expj(angle), centre) / radius))
        if isinstance(cam, CosineLaw):  # at the critical length from B: radicand as it stands, root with a sign
            a, b = self.number(cam.amplitude), self.number(cam.mean)
            turning = mp.acos((mp.sqrt(b * b + 8 * a * a) - b) / (4 * a))
            length = (b + a * mp.cos(turning)) * mp.sin(turning)
            from_guide = angle - self.number(cam.guide_angle)
            slider = b + a * mp.cos(from_guide)
            root = mp.sqrt(length**2 - (slider * mp.sin(from_guide)) ** 2)
            side = mp.sign(mp.cos(from_guide) - mp.cos(turning))
            return (slider * mp.cos(from_guide) - side * root) * mp.expj(angle)
        raise NotGivenError(f"there is no independent formula for cam {type(cam).__name__}")

    def components(self, quantity):
        """Components of a quantity."""
        links = self.mechanism.links
        ending = next((ending for ending in RATES if quantity.endswith(ending)), "")
        link = quantity.removesuffix(ending)
        travel = next((ending for ending in TRAVELS if quantity.endswith(ending)), "")
        slider = quantity.removesuffix(travel)
        if travel and slider in self.mechanism.guides:
            table = (self.position, self.velocity, self.acceleration)[TRAVELS.index(travel)]
            pin = self.mechanism.references[slider]
            found = _dot(self.position["direction", slider], table["joint", pin])
        elif ending and link in links:
            table = self.velocity if ending == "_rate" else self.acceleration
            found = _cross(self.position["direction", link], table["direction", link])
        else:
            forces = self.forces()
            if quantity not in forces:
                raise NotGivenError(checks.choice("quantity of the independent path", quantity, tuple(forces)))
            found = forces[quantity]
        return (found.real, found.imag) if isinstance(found, self.mp.mpc) else (found,)

    # Forces, from the equations of all bodies at once

    def forces(self):
        """Reactions, complex, and scalar forces and moments by name."""
        mp, links, unknowns = self.mp, self.mechanism.links, self.unknowns()
        matrix, right = mp.matrix(3 * len(links), len(unknowns)), mp.matrix(3 * len(links), 1)
        for column, (_, force, moment, at, on, by) in enumerate(unknowns):
            self.enter(matrix, column, on, at, force, moment)
            self.enter(matrix, column, by, at, -force, -moment)
        shaking = {}
        for name, link in links.items():
            mass, at = self.number(link.mass), self.position["centre", name]
            turning = _cross(self.position["direction", name], self.acceleration["direction", name])
            shaking[name] = -mass * self.acceleration["centre", name], -self.number(link.inertia) * turning
            self.enter(right, 0, name, at, -shaking[name][0] - mass * self.gravity(), -shaking[name][1])
        for name in self.mechanism.guides:
            pin, along = self.position["joint", self.mechanism.references[name]], self.position["direction", name]
            self.enter(right, 0, name, pin, -self.push(name, _dot(along, pin)) * along, 0)
        for item in self.solution.loads:
            if not isinstance(item, Gravity | Spring | ProcessForce) and isinstance(item, Load):
                for name, force, at, couple in self.of(item):
                    if name in links:
                        self.enter(right, 0, name, self.position["centre", name] if force == 0 else at, -force, -couple)

        found: dict[str, Any] = {}
        for (name, force, *_), size in zip(unknowns, mp.lu_solve(matrix, right), strict=True):
            found[name] = found.get(name, 0) + size * force if name in self.solution.reactions else size
        for group in self.mechanism.groups:
            for name in group.guides:
                normal = _left(self.position["direction", name])
                found["guide" + group.label] = found["guide_force" + group.label] * normal
        turning = (_cross(self.position["centre", name], force) + moment for name, (force, moment) in shaking.items())
        return found | {
            "balancing_torque_by_power": found["balancing_torque"],
            "shaking_force": sum(force for force, _ in shaking.values()),
            "shaking_moment": sum(turning),
        }

    def enter(self, matrix, column, link, at, force, moment):
        """Add a wrench to the three equations of a link, of moments about its mass centre; None is the ground."""
        if link is not None:
            row = 3 * list(self.mechanism.links).index(link)
            matrix[row, column] += self.mp.re(force)
            matrix[row + 1, column] += self.mp.im(force)
            matrix[row + 2, column] += moment + _cross(at - self.position["centre", link], force)

    def unknowns(self):
        """Unit wrenches: name, force, moment, point, link it acts on, link it comes from (None: ground)."""
        none = self.mp.mpc(0)
        at = {name: place for (kind, name), place in self.position.items() if kind == "joint"}
        found: list[tuple[Any, ...]] = [("O", part, 0, at["O"], "crank", None) for part in self.parts]
        found.append(("balancing_torque", none, 1, at["O"], "crank", None))
        for group in self.mechanism.groups:
            found += _of_kind(UNKNOWN, group)(self, group, at)
        return found

    def held(self, name, joint, at, link):
        """Both parts of a reaction on a link at a joint, from what carries that."""
        carrier = self.mechanism.joints[joint].link
        return [(name, part, 0, at[joint], link, None if carrier == FRAME else carrier) for part in self.parts]

    def slid(self, kind, label, at, direction, link, other):
        """Force and moment of a sliding pair, on a link from another (None: ground), about a place."""
        yield kind + "_force" + label, _left(direction), 0, at, link, other
        yield kind + "_moment" + label, self.mp.mpc(0), 1, at, link, other

    def of_roller(self, group, at):
        ahead, back = (self.roller(group.cam, self.angle + step) for step in (self.step, -self.step))
        inward = _left((ahead - back) / abs(ahead - back))
        slot = self.slid("slot", "", at["A"], self.position["direction", "crank"], "block", "crank")
        return [*slot, ("cam_force", inward, 0, at["A"], "block", None)]

    def of_slider(self, group, at):
        coupler, slider = group.links
        guide = self.slid("guide", group.label, at[group.pin], self.position["direction", slider], slider, None)
        inner = self.held(group.on + group.label, group.on, at, coupler)
        return [*inner, *((group.pin, part, 0, at[group.pin], slider, coupler) for part in self.parts), *guide]

    def of_rocker(self, group, at):
        coupler, rocker = group.links
        inner = self.held(group.on + group.label, group.on, at, coupler)
        pivot = self.held(group.pivot_name, group.pivot_name, at, rocker)
        return [*inner, *((group.pin, part, 0, at[group.pin], rocker, coupler) for part in self.parts), *pivot]

    def of_dyad(self, group, at):
        first, second = group.links
        ends = [self.held(f"{link}_{on}", on, at, link) for link, on in zip(group.links, group.on, strict=True)]
        return [*ends[0], *ends[1], *((group.pin, part, 0, at[group.pin], second, first) for part in self.parts)]

    def of_lever(self, group, at):
        lever, block = group.links
        inner = self.held(group.on + group.label, group.on, at, block)
        pivot = self.held(group.pivot_name, group.pivot_name, at, lever)
        along = self.position["direction", lever]
        return [*inner, *pivot, *self.slid("slot", group.label, at[group.on], along, block, lever)]

    def of_cylinder(self, group, at):
        rod, cylinder = group.links
        inner = self.held(group.on + group.label, group.on, at, rod)
        pivot = self.held(group.pivot_name, group.pivot_name, at, cylinder)
        along = self.position["direction", cylinder]
        return [*inner, *pivot, *self.slid("cylinder", group.label, at[group.pivot_name], along, rod, cylinder)]

    def of_yoke(self, group, at):
        block, slider = group.links
        inner = self.held(group.on + group.label, group.on, at, block)
        ways = (self.position["direction", name] for name in group.links)
        slot = self.slid("slot", group.label, at[group.on], next(ways), block, slider)
        return [*inner, *slot, *self.slid("guide", group.label, at[group.pin], next(ways), slider, None)]

    def gravity(self):
        items = (item for item in self.solution.loads if isinstance(item, Gravity))
        pulls = (self.number(item.acceleration) * self.mp.expj(self.number(item.direction)) for item in items)
        return sum(pulls, self.mp.mpc(0))

    def push(self, slider, coordinate):
        """Force on a slider along its guide."""
        total = self.mp.mpf(0)
        for place, item in enumerate(self.solution.loads):
            if not hasattr(item, "push") or item.on != slider:
                continue
            if isinstance(item, Spring):
                elongation = coordinate - self.number(item.free_position)
                total -= self.number(item.stiffness) * elongation + self.number(item.cubic) * elongation**3
            elif isinstance(item, ProcessForce) and not callable(item.force):
                total += self.number(item.force)
            else:
                total += self.given(place)
        return total

    def value(self, item):
        """Force or moment of a load that may be a table or a function."""
        return self.given(self.solution.loads.index(item)) if callable(item.value_now) else self.number(item.value_now)

    def expj(self, angle):
        return self.mp.expj(angle)

    def arg(self, number):
        return self.mp.arg(number)

    def where(self, condition, one, other):
        return one if condition else other

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        joint, axis = self.mechanism.references[link], self.position["direction", link]
        shift = self.velocity["joint", joint]
        return self.position["joint", joint], axis, shift, _cross(axis, self.velocity["direction", link])

    def given(self, place):
        """Value of a load that is a function of the motion, which no formula but the user's own can give."""
        flint = library("flint")
        with flint.ctx.workprec(int(3.33 * self.mp.dps)):
            values = np.ravel(on_arb(flint.arb, self.solution).loads[place].value_now)
            return self.mp.mpf(values[self.index if values.size > 1 else 0])


ADD: Any = {
    SliderGroup: Machine.add_slider,
    RockerGroup: Machine.add_rocker,
    Dyad: Machine.add_dyad,
    Pin: Machine.add_pin,
    LeverGroup: Machine.add_lever,
    CylinderGroup: Machine.add_cylinder,
    YokeGroup: Machine.add_yoke,
}
"""How each kind of group is placed."""
UNKNOWN: Any = {
    CamRoller: Machine.of_roller,
    SliderGroup: Machine.of_slider,
    RockerGroup: Machine.of_rocker,
    Dyad: Machine.of_dyad,
    Pin: lambda machine, group, at: [],
    LeverGroup: Machine.of_lever,
    CylinderGroup: Machine.of_cylinder,
    YokeGroup: Machine.of_yoke,
}
"""What each kind of group adds to the unknown wrenches."""


def _of_kind(table, group):
    for kind in type(group).__mro__:
        if kind in table:
            return table[kind]
    raise NotGivenError(f"there is no independent formula for a {type(group).__name__}")


def _left(a):
    return a * 1j


def _dot(a, b):
    return (a.conjugate() * b).real


def _cross(a, b):
    return (a.conjugate() * b).imag

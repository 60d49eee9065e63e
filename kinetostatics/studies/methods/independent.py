"""The independent path of the certified reference: mpmath, other formulas, all forces from one linear system.

It knows of the mechanism only its joints and bodies: positions by angles, velocities and accelerations as difference
quotients of positions, all forces at once from the Newton-Euler equations.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ...errors import NotGivenError
from ...machine.cam_roller import CamRoller
from ...machine.cylinder_group import CylinderGroup
from ...machine.dyad import Dyad
from ...machine.flat_follower import FlatFollower
from ...machine.group import FRAME, TRAVELS
from ...machine.guided_follower import GuidedFollower
from ...machine.lever_group import LeverGroup
from ...machine.loads import Gravity, Load, ProcessForce, Spring
from ...machine.pin import Pin
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from ...machine.swinging_follower import SwingingFollower
from ...machine.yoke_group import YokeGroup
from ...mechanics.quantities import RATES
from ...numbers import checks
from .acting import Acting
from .enclosures import library, on_arb, require_one_design
from .method import require_frictionless
from .postures import Posture, cross, dot, left, of_kind


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
        There are no such formulas for a group or cam, or for friction, or no such quantity.
    MissingLibraryError
        mpmath is not installed.
    """
    mp = library("mpmath").mp
    require_one_design(solution)
    require_frictionless(solution)
    with mp.workdps(working_digits(digits)):
        found = [Machine(mp, solution, index, digits).components(quantity) for index in indices]
    return tuple(np.array(part, dtype=object) for part in zip(*found, strict=True))


def working_digits(digits):
    """Enough for second differences with a step of 10^-(2 digits), which lose 4 digits for each, even near a limit."""
    return 6 * digits + 60


class Machine(Posture, Acting):
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
            found = dot(self.position["direction", slider], table["joint", pin])
        elif ending and link in links:
            table = self.velocity if ending == "_rate" else self.acceleration
            found = cross(self.position["direction", link], table["direction", link])
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
            turning = cross(self.position["direction", name], self.acceleration["direction", name])
            shaking[name] = -mass * self.acceleration["centre", name], -self.number(link.inertia) * turning
            self.enter(right, 0, name, at, -shaking[name][0] - mass * self.gravity(), -shaking[name][1])
        for name in self.mechanism.guides:
            pin, along = self.position["joint", self.mechanism.references[name]], self.position["direction", name]
            self.enter(right, 0, name, pin, -self.push(name, dot(along, pin)) * along, 0)
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
                normal = left(self.position["direction", name])
                found["guide" + group.label] = found["guide_force" + group.label] * normal
        turning = (cross(self.position["centre", name], force) + moment for name, (force, moment) in shaking.items())
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
            matrix[row + 2, column] += moment + cross(at - self.position["centre", link], force)

    def unknowns(self):
        """Unit wrenches: name, force, moment, point, link it acts on, link it comes from (None: ground)."""
        none = self.mp.mpc(0)
        at = {name: place for (kind, name), place in self.position.items() if kind == "joint"}
        found: list[tuple[Any, ...]] = [("O", part, 0, at["O"], "crank", None) for part in self.parts]
        found.append(("balancing_torque", none, 1, at["O"], "crank", None))
        for group in self.mechanism.groups:
            found += of_kind(UNKNOWN, group)(self, group, at)
        return found

    def held(self, name, joint, at, link):
        """Both parts of a reaction on a link at a joint, from what carries that."""
        carrier = self.mechanism.joints[joint].link
        return [(name, part, 0, at[joint], link, None if carrier == FRAME else carrier) for part in self.parts]

    def slid(self, kind, label, at, direction, link, other):
        """Force and moment of a sliding pair, on a link from another (None: ground), about a place."""
        yield kind + "_force" + label, left(direction), 0, at, link, other
        yield kind + "_moment" + label, self.mp.mpc(0), 1, at, link, other

    def of_roller(self, group, at):
        ahead, back = (self.roller(group.cam, self.angle + step) for step in (self.step, -self.step))
        inward = left((ahead - back) / abs(ahead - back))
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

    def of_guided(self, group, at):
        (follower,) = group.links
        along = self.position["direction", follower]
        guide = self.slid("guide", group.label, at[group.pin], along, follower, None)
        if not isinstance(group, FlatFollower):
            return [*guide, self.pressed(group, at[group.pin], follower)]
        ahead, back = (dot(along, self.followed(group, self.angle + step)[0]) for step in (self.step, -self.step))
        touched = along * self.mp.mpc(dot(along, at[group.pin]), (back - ahead) / (2 * self.step))
        return [*guide, ("contact_force" + group.label, along, 0, touched, follower, "crank")]

    def of_swinging(self, group, at):
        (arm,) = group.links
        pivot = self.held(group.pivot_name, group.pivot_name, at, arm)
        return [*pivot, self.pressed(group, at[group.pin], arm)]

    def pressed(self, group, at, link):
        """Contact force of a roller, across its path on the cam, which it runs clockwise."""
        angles = self.angle + self.step, self.angle - self.step
        ahead, back = (self.followed(group, angle)[0] * self.mp.expj(-angle) for angle in angles)
        outward = left((ahead - back) / abs(ahead - back)) * self.mp.expj(self.angle)
        return "contact_force" + group.label, outward, 0, at, link, "crank"

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
        return self.position["joint", joint], axis, shift, cross(axis, self.velocity["direction", link])

    def given(self, place):
        """Value of a load that is a function of the motion, which no formula but the user's own can give."""
        flint = library("flint")
        with flint.ctx.workprec(int(3.33 * self.mp.dps)):
            values = np.ravel(on_arb(flint.arb, self.solution).loads[place].value_now)
            return self.mp.mpf(values[self.index if values.size > 1 else 0])


UNKNOWN: Any = {
    CamRoller: Machine.of_roller,
    SliderGroup: Machine.of_slider,
    RockerGroup: Machine.of_rocker,
    Dyad: Machine.of_dyad,
    Pin: lambda machine, group, at: [],
    LeverGroup: Machine.of_lever,
    CylinderGroup: Machine.of_cylinder,
    YokeGroup: Machine.of_yoke,
    GuidedFollower: Machine.of_guided,
    SwingingFollower: Machine.of_swinging,
}
"""What each kind of group adds to the unknown wrenches."""

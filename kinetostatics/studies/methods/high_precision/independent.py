"""The independent path of the certified reference: mpmath, other formulas, all forces from one linear system.

It knows of the mechanism only its joints and bodies: positions by angles, velocities and accelerations as difference
quotients of positions, all forces at once from the Newton-Euler equations.
"""

from collections.abc import Iterable
from typing import Any

import numpy as np

from ....errors import NotGivenError
from ....machine.group import FRAME, TRAVELS
from ....machine.loads import Gravity, Load, ProcessForce, Spring
from ....mechanics.quantities import RATES
from ....numbers import checks
from ..acting import Acting
from ..global_system.friction import Rubbing
from ..method import require_moving
from ..structures import structure
from .enclosures import library, on_arb, require_one_design
from .postures import Posture, cross, dot, left


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
        There are no such formulas for a group or cam, no such quantity, or friction does not settle.
    MissingLibraryError
        mpmath is not installed.
    """
    mp = library("mpmath").mp
    require_one_design(solution)
    require_moving(solution)
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
                self.apply(self.of(item), right)
        triangles, order = mp.LU_decomp(matrix)

        def solve(effects):
            self.apply(effects, given := right.copy())
            return mp.U_solve(triangles, mp.L_solve(triangles, given, order))

        def named(sizes):
            forces: dict[str, Any] = {}
            for (name, force, *_), size in zip(unknowns, sizes, strict=True):
                forces[name] = forces.get(name, 0) + size * force if name in self.solution.reactions else size
            return forces

        rubbing = Rubbing(self, self.solution)
        found = named(rubbing.settled(solve, named, lambda sizes: mp.norm(sizes, mp.inf), self.step))
        along = rubbing.along(found)
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

    def apply(self, effects, right):
        """Take effects, forces at points of links with couples, to the right side of the equations."""
        for link, force, at, couple in effects:
            if link in self.mechanism.links:
                self.enter(right, 0, link, self.position["centre", link] if force == 0 else at, -force, -couple)

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
        found: list[tuple[Any, ...]] = [("balancing_torque", none, 1, at["O"], "crank", None)]
        made, numbers = structure(self.mechanism)
        for part in made.parts:
            for pin in part.pinned:
                found += [(pin.name, way, 0, at[pin.joint], pin.link, grounded(pin.other)) for way in self.parts]
            for pair in part.slid:
                ends = at[pair.about], pair.link, grounded(pair.other)
                along = self.position["direction", pair.link]
                if pair.other != FRAME:
                    turned = self.mp.expj(self.number(numbers[f"{pair.other}_{pair.joint}_angle"]))
                    along = self.position["direction", pair.other] * turned
                found += [(pair.force, left(along), 0, *ends), (pair.couple, none, 1, *ends)]
            found += [(cam.force, *self.pressed(cam, at[cam.joint]), cam.link, grounded(cam.body)) for cam in part.cams]
        return found

    def pressed(self, cam, at):
        """Unit force of a cam on what it leads, without couple, and where it acts, by its way as seen from the cam."""
        ahead, back = (self.table(self.angle + step)["joint", cam.joint] for step in (self.step, -self.step))
        turning = 0 if cam.body == FRAME else 1
        way = (ahead - back) / (2 * self.step) - turning * left(at)
        if not cam.flat:
            return left(way / abs(way)), 0, at
        axis = self.position["direction", cam.link]
        return axis, 0, at - dot(axis, way) * left(axis)

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


def grounded(link):
    """The link, or None for the frame."""
    return None if link == FRAME else link

"""SymPy's Kane method, lambdified: the fastest alternative for an expert.

The crank angle is the only coordinate; directions of links and travels of sliders are closed forms of it (`motion`).
Each link has auxiliary speeds, so the equations contain the reactions (Kane and Levinson, *Dynamics: Theory and
Applications*, 1985: bringing noncontributing forces into evidence). `KanesMethod` derives the equations once for each
structure. `lambdify` compiles the requested quantities, with common subexpressions, once for each pattern of parameters
that are 0, 1 or -1. `AppliedLoads` computes tables, functions and loads at points as numbers before each call.
"""

from functools import cache
from itertools import chain, combinations
from typing import Any

import numpy as np
import sympy as sp
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from ....errors import NotGivenError
from ....machine.group import FRAME
from ....machine.loads import GasSpring, Gravity, ProcessForce, Spring
from ..method import Method, require_frictionless, require_one_design, with_numeric_side
from ..structures import LINK_NUMBERS, LoadForces, cam_numbers, cross, require_massless, structure
from .motion import PHI, SPEED, TORQUE, Motion, N, left, linear, planar, rate

MAX_EQUATIONS_TOGETHER = 3
"""Largest number of reaction equations solved together."""


class Equations(Motion):
    """Equations of one structure of mechanism: its motion, and forces by auxiliary speeds.

    `forces` are reactions and drive torque by name, in components; `results` these and motions.
    """

    def __init__(self, structure):
        super().__init__(structure)
        self.reactions: dict[str, tuple[Any, ...]] = {"balancing_torque": (TORQUE,)}
        self.speeds: list[Any] = []
        self.found: set[Any] = set()
        self.rigid: list[Any] = []
        self.frames: dict[str, Any] = {}
        self.loads: list[Any] = []
        for link, body in self.bodies.items():
            if link != FRAME:
                self._part(link, body)
        self.loads.append((self.frames["crank"], TORQUE * N.z))
        for part in self.structure.parts:
            for name, pin in part.pins:
                self._pin(name, pin)
            for name, pair in part.slides:
                self._slide(name, pair)
            for cam in part.cams:
                self._press(cam)
        outputs = {"balancing_torque", *(name for part in structure.parts for name in part.outputs)}
        self.forces = {name: parts for name, parts in self.reactions.items() if name in outputs}
        self.results = self.motions | self.forces | {"balancing_torque_by_power": (TORQUE,)}
        self._eliminate()

    def _part(self, link, body):
        """Give a link its auxiliary speeds, its weight and its applied loads."""
        own = dynamicsymbols([f"{link}_{name}" for name in ("to_x", "to_y", "spin")])
        body.shift = own[0] * body.ways[0] + own[1] * body.ways[1]
        if link == "crank":
            own.pop()
        else:
            body.spin = own[2]
        self.speeds += own
        mass, along, across, turning = sp.symbols([f"{link}_{part}" for part in LINK_NUMBERS])
        position = body.joint + along * body.axis + across * left(body.axis)
        centre, frame = Point(link), ReferenceFrame(link)
        centre.set_vel(N, position.dt(N).subs(PHI.diff(), SPEED) + body.at(position))
        frame.set_ang_vel(N, (body.turning * SPEED + body.spin) * N.z)
        self.frames[link] = frame
        self.rigid.append(RigidBody(link, centre, frame, mass, (inertia(N, 0, 0, turning), centre)))
        self.loads.append((centre, mass * planar(*sp.symbols("gravity_x gravity_y"))))
        x, y, moment = sp.symbols([f"{link}_load_{part}" for part in ("x", "y", "moment")])
        force = planar(x, y)
        if link in self.slides and self.slides[link].against == FRAME:
            names = "push", "stiffness", "free", "cubic"
            push, stiffness, free, cubic = sp.symbols([f"{link}_{name}" for name in names])
            deflection = self.travels[link] - free
            force += (push - stiffness * deflection - cubic * deflection**3) * body.frame.x
        reference = Point(f"{link} reference")
        reference.set_vel(N, body.joint.dt(N).subs(PHI.diff(), SPEED) + body.shift)
        self.loads += [(reference, force), (frame, moment * N.z)]

    def _unknown(self, name):
        symbol = sp.Symbol(name)
        self.found.add(symbol)
        return symbol

    def _push(self, link, position, force, couple=0):
        """Apply force and couple of a joint; they do work on auxiliary speeds only."""
        if link != FRAME:
            point, frame = Point("P"), ReferenceFrame("F")
            point.set_vel(N, self.bodies[link].at(position))
            self.loads.append((point, force))
            if couple != 0:
                frame.set_ang_vel(N, self.bodies[link].spin * N.z)
                self.loads.append((frame, couple * N.z))

    def _act(self, link, other, position, force, couple=0):
        self._push(link, position, force, couple)
        self._push(other, position, -force, -couple)

    def _pin(self, name, item):
        guided = [self.bodies[link].ways for link in (item.link, item.against) if self.bodies[link].ways[0] != N.x]
        ways = guided[0] if guided else (N.x, N.y)
        x, y = self._unknown(f"{name}_x"), self._unknown(f"{name}_y")
        force = x * ways[0] + y * ways[1]
        self.reactions[name] = (force & N.x, force & N.y)
        self._push(item.link, self._on(item.link, item.joint), force)
        self._push(item.against, self._on(item.against, item.joint), -force)

    def _slide(self, name, item):
        force, couple = self._unknown(item.force), self._unknown(item.couple)
        across = self.bodies[item.link].frame.y
        self.reactions |= {item.force: (force,), item.couple: (couple,)}
        self.reactions[name] = (force * across & N.x, force * across & N.y)
        self._act(item.link, item.against, self.places[item.about], force * across, couple)

    def _press(self, cam):
        """Apply the contact force of a cam, normal to the relative motion along its curve."""
        body, base, force = self.bodies[cam.link], self.bodies[cam.body], self._unknown(cam.force)
        joint = self.places[cam.joint]
        passing = rate(joint) - base.turning * left(joint - base.joint)
        self.reactions[cam.force] = (force,)
        if cam.flat:
            at = joint - (passing & body.axis) / (base.turning - body.turning) * left(body.axis)
            self._act(cam.link, cam.body, at, force * body.axis)
            return
        x, y = passing & body.frame.x, passing & body.frame.y
        normal = left(x * body.frame.x + y * body.frame.y) / sp.sqrt(x**2 + y**2)
        self._act(cam.link, cam.body, joint, force * normal)

    def _eliminate(self):
        """Solve Kane's equations in turn, in the smallest groups that determine further unknowns, as `steps`."""
        method = KanesMethod(N, [PHI], [SPEED], [PHI.diff() - SPEED], u_auxiliary=self.speeds)
        active, inertial = method.kanes_equations(self.rigid, self.loads)
        power, *equations = active + inertial
        self._solve([power], [TORQUE])
        left_over = [(equation, equation.free_symbols & self.found) for equation in equations]
        known: set[Any] = set()
        while known < self.found:
            open_ones = [(equation, wanted - known) for equation, wanted in left_over if wanted - known]
            sizes = range(1, MAX_EQUATIONS_TOGETHER + 1)
            for chosen in chain.from_iterable(combinations(open_ones, size) for size in sizes):
                wanted = set().union(*(names for _, names in chosen))
                if len(wanted) == len(chosen):
                    break
            else:
                raise NotGivenError("the reactions are not determined one group after another")
            self._solve([equation for equation, _ in chosen], sorted(wanted, key=str))
            known |= wanted

    def _solve(self, equations, wanted):
        """Solve linear equations by Cramer's rule."""
        rows = [linear(equation, *wanted) for equation in equations]
        matrix, right = sp.Matrix([row[:-1] for row in rows]), sp.Matrix([-row[-1] for row in rows])
        for column, name in enumerate(wanted):
            replaced = matrix.copy()
            replaced[:, column] = right
            self.steps[name] = replaced.det(method="berkowitz") / matrix.det(method="berkowitz")


LOAD_PARTS = "x", "y", "moment"


class AppliedLoads(LoadForces):
    """Loads of a solution besides gravity: constants in ``numbers``, values that depend on the motion by a call.

    Keys: a link's name with "_load_x", "_load_y", "_load_moment" for force and moment about its reference joint. Also a
    slider's name with "_push" for the force along its guide, and "_stiffness", "_free", "_cubic" for its spring.
    ``result(name)`` returns a function that computes a result of the equations' own motion.
    """

    def __init__(self, solution, result):
        self.solution, self.mechanism = solution, solution.mechanism
        links, sliders = self.mechanism.links, self.mechanism.guides
        self.numbers: dict[str, Any] = {f"{link}_load_{part}": 0 for link in links for part in LOAD_PARTS}
        self.numbers |= {f"{slider}_{part}": 0 for slider in sliders for part in ("push", "stiffness", "free", "cubic")}
        self.pushes, self.others, sprung = [], [], set()
        for item in solution.loads:
            if isinstance(item, Spring) and item.on not in sprung:
                require_massless(item)
                sprung.add(item.on)
                parts = {"stiffness": item.stiffness, "free": item.free_position, "cubic": item.cubic}
                self.numbers |= {f"{item.on}_{part}": value for part, value in parts.items()}
            elif isinstance(item, ProcessForce) and isinstance(item.force, int | float):
                self.numbers[f"{item.on}_push"] += item.force
            elif hasattr(item, "push"):
                self.pushes.append(item)
            elif not isinstance(item, Gravity):
                self.others.append(item)
        further = {item.on for item in self.pushes if isinstance(item, Spring | GasSpring)}
        self.travels = {slider: result(f"{slider}_position") for slider in further}
        self.motions = {link: result(f"{link} in motion") for link in links} if self.others else {}
        self.fixed = self.numbers
        moving = self()
        self.numbers = {name: value for name, value in self.fixed.items() if name not in moving}

    def __call__(self):
        found: dict[str, Any] = {}

        def add(name, amount):
            found[name] = found.get(name, self.fixed[name]) + amount

        for item in self.pushes:
            coordinate = self.travels[item.on]()[0] if isinstance(item, Spring | GasSpring) else None
            add(f"{item.on}_push", self.push(item, coordinate))
        self.places = {link: run() for link, run in self.motions.items()}
        for item in self.others:
            for link, force, at, couple in self.of(item):
                if link in self.places:
                    turning = couple + cross(at - self.at(link)[0], force)
                    for part, amount in zip(LOAD_PARTS, (np.real(force), np.imag(force), turning), strict=True):
                        add(f"{link}_load_{part}", amount)
        return found

    def at(self, link):
        """Reference joint, axis, velocity of the joint and angular velocity of a link."""
        x, y, cosine, sine, to_x, to_y, spin = self.places[link]
        return x + 1j * y, cosine + 1j * sine, to_x + 1j * to_y, spin


SUBSTITUTED_VALUES = 0, 1, -1
"""Parameter values that are substituted into the equations."""


equations_of = cache(Equations)
"""Equations of a structure, solved."""


@cache
def compiled_results(made, names, written):
    """Function for some results of a structure, and the names of its arguments.

    `written` are pairs of a parameter's name and its substituted value.
    """
    equations = equations_of(made)
    values = {sp.Symbol(name): sp.Integer(int(value)) for name, value in written}

    def final(expression):
        return expression.xreplace(equations.symbols).xreplace(values)

    results = [final(part) for name in names for part in equations.results[name]]
    steps = sorted_steps({symbol: final(step) for symbol, step in equations.steps.items()}, results)
    shared, reduced = sp.cse([*steps.values(), *results], list=False)
    results = reduced[len(steps) :]
    steps = sorted_steps(dict(shared) | dict(zip(steps, reduced, strict=False)), results)
    arguments = sorted({str(s) for part in (*steps.values(), *results) for s in part.free_symbols - steps.keys()})
    return sp.lambdify(arguments, results, cse=lambda parts: (list(steps.items()), parts)), arguments


def sorted_steps(steps, results):
    """The steps that results need, each after the steps that it needs."""
    ordered: dict = {}

    def take(expression):
        for symbol in sorted(expression.free_symbols & steps.keys() - ordered.keys(), key=str):
            take(steps[symbol])
            ordered[symbol] = steps[symbol]

    for result in results:
        take(result)
    return ordered


def structure_and_numbers(solution):
    """Structure of the mechanism, and its numbers by name; of the loads only gravity."""
    require_one_design(solution)
    require_frictionless(solution)
    mechanism = with_numeric_side(solution.mechanism)
    made, values = structure(mechanism)
    pulls = [item.vector for item in solution.loads if isinstance(item, Gravity)]
    gravity = [sum(parts) for parts in zip((0, 0), *pulls, strict=True)]
    values |= zip(("gravity_x", "gravity_y"), gravity, strict=True)
    values |= {name: getattr(solution, name) for name in ("crank_angle", "crank_speed", "crank_acceleration")}
    for group in mechanism.groups:
        values |= cam_numbers(group, solution.crank_angle)
    for side, link in equations_of(made).sides.items():
        a, b = function_of(made, (side,), values)()
        cosine, sine = solution.placement.links[link].direction
        values[side] = 1 if np.nansum(np.sign(a * sine - b * cosine)) >= 0 else -1
    return made, values


def function_of(made, names, values):
    """Function that returns results as a list of components (N,), by one call of a lambdified function.

    Numbers that change from call to call are its keyword arguments.
    """
    plain = {name: value for name, value in values.items() if isinstance(value, int | float)}
    function, arguments = compiled_results(
        made, names, tuple(item for item in plain.items() if item[1] in SUBSTITUTED_VALUES)
    )
    shape = np.shape(values["crank_angle"])
    fixed = [values.get(name) for name in arguments]

    def run(**moving):
        given = [moving.get(name, value) for name, value in zip(arguments, fixed, strict=True)] if moving else fixed
        with np.errstate(invalid="ignore", divide="ignore"):
            return [part if np.shape(part) == shape else np.full(shape, float(part)) for part in function(*given)]

    return run


def evaluation(solution, names):
    """Function without arguments that computes results by name, as a tuple of components."""
    made, values = structure_and_numbers(solution)
    unknown = [name for name in names if name not in equations_of(made).results]
    if unknown:
        raise NotGivenError(f"SymPy's Kane method is not set up to give {', '.join(unknown)}")
    applied = AppliedLoads(solution, lambda name: function_of(made, (name,), values))
    run = function_of(made, names, values | applied.numbers)
    return lambda: tuple(run(**applied()))


def all_forces(solution):
    """Function that computes all reactions and the torque, components by name, with one lambdified function."""
    forces = equations_of(structure_and_numbers(solution)[0]).forces
    run = evaluation(solution, tuple(forces))

    def named():
        parts = iter(run())
        return {name: tuple(next(parts) for _ in components) for name, components in forces.items()}

    return named


METHODS = (Method("SymPy Kane, lambdified", lambda solution, quantity, setting: evaluation(solution, (quantity,))),)

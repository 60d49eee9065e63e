"""SymPy's Kane method, lambdified: the fastest way an expert would otherwise take.

The crank angle is the only coordinate; directions of links and travels of sliders are closed forms of it. Auxiliary
speeds part each link from its neighbours, so that their equations hold the reactions there (Kane and Levinson,
*Dynamics: Theory and Applications*, 1985: bringing noncontributing forces into evidence); the drive torque needs none.
`KanesMethod` derives the equations in symbols from what the groups declare, once for each structure. What is asked for,
and only that, goes through `lambdify` with common subexpressions taken out, once for each pattern of parameters that
are 0, 1 or -1, which are written in; all others are arguments. Tables, functions and loads at points are the user's own
numbers, computed of the motion before.

Equations of a mechanism in symbols by SymPy's Kane method, made of what its groups declare (see `kane`).
"""

from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
import sympy as sp
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from ....machine.group import FRAME
from ....machine.loads import Gravity
from ..method import Method, NotGivenError, require_frictionless, require_one_design, with_numeric_side
from ..structures import LINK_NUMBERS, cam_numbers, structure
from .motion import PHI, SPEED, TORQUE, Motion, N, left, linear, planar, rate

MAX_EQUATIONS_TOGETHER = 3
"""Equations, at most, that are solved together."""


class Equations(Motion):
    """Equations of one structure of mechanism: its motion, and forces by auxiliary speeds.

    Attributes
    ----------
    forces : dict of str to tuple of expressions
        Results by name, in components.
    """

    @property
    def forces(self):
        told = {"balancing_torque", *(name for part in self.structure.parts for name in part.outputs)}
        return {name: parts for name, parts in self.reactions.items() if name in told}

    @property
    def results(self):
        return self.motions | self.forces | {"balancing_torque_by_power": (TORQUE,)}

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
            for pinned in part.pinned:
                self._pin(pinned)
            for slid in part.slid:
                self._slide(slid)
            for cam in part.cams:
                self._press(cam)

    def _part(self, link, body):
        """Give a link speeds of its own, its weight and what is applied to it."""
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
        if link in self.slid and self.slid[link].other == FRAME:
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
        """Force and couple of a joint: they move auxiliary speeds alone, for joints take no power."""
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

    def _pin(self, item):
        guided = [self.bodies[link].ways for link in (item.link, item.other) if self.bodies[link].ways[0] != N.x]
        ways = guided[0] if guided else (N.x, N.y)
        x, y = self._unknown(f"{item.name}_x"), self._unknown(f"{item.name}_y")
        force = x * ways[0] + y * ways[1]
        self.reactions[item.name] = (force & N.x, force & N.y)
        self._push(item.link, self._on(item.link, item.joint), force)
        self._push(item.other, self._on(item.other, item.joint), -force)

    def _slide(self, item):
        force, couple = self._unknown(item.force), self._unknown(item.couple)
        across = self.bodies[item.link].frame.y
        self.reactions |= {item.force: (force,), item.couple: (couple,)}
        if item.vector:
            self.reactions[item.vector] = (force * across & N.x, force * across & N.y)
        self._act(item.link, item.other, self.places[item.about], force * across, couple)

    def _press(self, cam):
        """Contact of a cam, by its way along the curve as seen from what the curve is fixed to."""
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

    def solved(self):
        """The same with the unknown forces among the steps."""
        method = KanesMethod(N, [PHI], [SPEED], [PHI.diff() - SPEED], u_auxiliary=self.speeds)
        active, inertial = method.kanes_equations(self.rigid, self.loads)
        power, *equations = active + inertial
        self._solve([power], [TORQUE])
        self._eliminate(equations)
        return self

    def _eliminate(self, equations):
        """Solve equations one by one where each holds one more unknown, else as few as possible together."""
        left_over = [(equation, equation.free_symbols & self.found) for equation in equations]
        known: set[Any] = set()
        while known < self.found:
            open_ones = [(equation, wanted - known) for equation, wanted in left_over if wanted - known]
            chosen = next(
                (
                    (group, wanted)
                    for size in range(1, MAX_EQUATIONS_TOGETHER + 1)
                    for group in combinations(open_ones, size)
                    if len(wanted := set().union(*(names for _, names in group))) == size
                ),
                None,
            )
            if chosen is None:
                raise NotGivenError("the reactions are not determined one group after another")
            self._solve([equation for equation, _ in chosen[0]], sorted(chosen[1], key=str))
            known |= chosen[1]

    def _solve(self, equations, wanted):
        """By Cramer's rule."""
        rows = [linear(equation, *wanted) for equation in equations]
        matrix, right = sp.Matrix([row[:-1] for row in rows]), sp.Matrix([-row[-1] for row in rows])
        for column, name in enumerate(wanted):
            replaced = matrix.copy()
            replaced[:, column] = right
            self.steps[name] = replaced.det(method="berkowitz") / matrix.det(method="berkowitz")


SUBSTITUTED_VALUES = 0, 1, -1
"""Numbers that are written into the equations."""


@cache
def equations_of(made):
    """Equations of a structure, solved."""
    return Equations(made).solved()


@cache
def compiled_results(made, names, written):
    """Function for some results of a structure, and the names of its arguments.

    `written` are pairs of a parameter's name and the value that is written in.
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
    """The steps that results take, each after those it takes itself."""
    ordered: dict = {}

    def take(expression):
        for symbol in sorted(expression.free_symbols & steps.keys() - ordered.keys(), key=str):
            take(steps[symbol])
            ordered[symbol] = steps[symbol]

    for result in results:
        take(result)
    return ordered


def structure_and_numbers(solution):
    """Structure of the mechanism, and its numbers by name, without those of loads but for gravity."""
    require_one_design(solution)
    require_frictionless(solution)
    mechanism = with_numeric_side(solution.mechanism)
    made, values = structure(mechanism)
    pulls = [item.vector for item in solution.loads if isinstance(item, Gravity)]
    gravity = [sum(parts) for parts in zip((0, 0), *pulls, strict=True)]
    values |= {
        "crank_angle": solution.crank_angle,
        "crank_speed": solution.crank_speed,
        "crank_acceleration": solution.crank_acceleration,
        "gravity_x": gravity[0],
        "gravity_y": gravity[1],
    }
    for group in mechanism.groups:
        values |= cam_numbers(group, solution.crank_angle)
    for side, link in equations_of(made).sides.items():
        a, b = function_of(made, (side,), values)()
        cosine, sine = solution.placement.links[link].direction
        values[side] = 1 if np.nansum(np.sign(a * sine - b * cosine)) >= 0 else -1
    return made, values


def function_of(made, names, values):
    """Function that computes results by name with one call of a lambdified function, as a list of components.

    It takes what is known only when it is called, by name.
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
    """Function without arguments that computes results by name, as a list of components."""
    made, values = structure_and_numbers(solution)
    unknown = [name for name in names if name not in equations_of(made).results]
    if unknown:
        raise NotGivenError(f"SymPy's Kane method is not set up to give {', '.join(unknown)}")
    applied = AppliedLoads(solution, lambda name: function_of(made, (name,), values))
    run = function_of(made, names, values | applied.numbers)
    return lambda: run(**applied())


def all_forces(solution):
    """Function that computes all reactions and the torque, components by name, with one lambdified function."""
    forces = equations_of(structure_and_numbers(solution)[0]).forces
    run = evaluation(solution, tuple(forces))

    def named():
        parts = iter(run())
        return {name: tuple(next(parts) for _ in components) for name, components in forces.items()}

    return named


def _prepare(solution, quantity, setting=None):
    run = evaluation(solution, (quantity,))
    return lambda: tuple(run())


METHODS = (Method("SymPy Kane, lambdified", _prepare),)

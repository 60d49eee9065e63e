"""Equations of a mechanism in symbols by SymPy's Kane method, made of what its groups declare (see `kane`).

The crank angle is the only coordinate. Angles of links and travels of sliders are functions of it: closed forms where
the closed loop of a group is met by one angle, one travel, or two angles, rates and accelerations from its derivatives.
"""

from itertools import combinations
from typing import Any

import sympy as sp
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

from ...machine.group import FRAME
from .kane_cams import CURVES
from .kane_symbols import ALPHA, ANGLE, N, OMEGA, PHI, SPEED, TORQUE, functions, left, planar, rate, slope
from .method import NotGivenError
from .structures import LINK

LARGEST = 3
"""Equations, at most, that are solved together."""


class Body:
    """A link: reference joint, direction, its turning by the crank angle, and auxiliary speeds of both.

    `ways` are the directions along which it is parted from its neighbours.
    """

    def __init__(self, joint, frame, axis, turning, ways):
        self.joint, self.frame, self.axis, self.turning, self.ways = joint, frame, axis, turning, ways
        self.shift, self.spin = 0 * N.x, 0

    def at(self, position):
        """Auxiliary velocity of its point at a position."""
        return self.shift + self.spin * left(position - self.joint)


class Equations:
    """Equations of one structure of mechanism.

    Attributes
    ----------
    steps : dict of Symbol to expression
        What results are computed from; a step may use others, in any order.
    motions, forces : dict of str to tuple of expressions
        Results by name, in components.
    symbols : dict of expression to Symbol
        What stands for time and crank angle, functions of them and their derivatives in steps and results.
    sides : dict of str to link
        Signs of roots, which belong to the assembly, and the links whose angles they choose. Of the two results of that
        name and the link's direction, a sin(theta) - b cos(theta) has the sign.
    """

    def __init__(self, structure):
        self.structure = structure
        self.steps, self.motions = {}, {}
        self.sides: dict[str, str] = {}
        self.forces: dict[str, tuple[Any, ...]] = {"balancing_torque": (TORQUE,)}
        self.symbols = {SPEED.diff(): ALPHA, SPEED: OMEGA, PHI.diff(): OMEGA, PHI: ANGLE}
        self.places: dict[str, Any] = {}
        self.bodies: dict[str, Body] = {FRAME: Body(0 * N.x, N, N.x, 0, (N.x, N.y))}
        self.owners = dict(item for part in structure.parts for item in part.joints)
        self.bars = {(end, link): link for part in structure.parts for _, end, link in part.bars}
        self.slid = {item.link: item for part in structure.parts for item in part.slid}
        self.led = {cam.link: cam for part in structure.parts for cam in part.cams}
        self.angles: dict[str, Any] = {}
        self.rays: dict[Any, Any] = {}
        self.travels: dict[str, Any] = {}
        for part in structure.parts:
            self._assemble(part)
        self._report()
        self._apply()

    @property
    def results(self):
        return self.motions | self.forces | {"balancing_torque_by_power": (TORQUE,)}

    def number(self, name):
        """Symbol of a length or angle; those that are zero are left out."""
        return sp.S.Zero if name in self.structure.zeros else sp.Symbol(name)

    # Where everything is

    def _assemble(self, part):
        for link, _ in part.links:
            self._point(link)
        for joint, _ in part.joints:
            self._place(joint)
        for link, joint in part.links:
            self.bodies[link].joint = self._place(joint)
        loops = [(*self._gaps(item), item.joint) for item in part.pinned]
        loops = [(gap, joint) for one, other, joint in loops if (gap := one - other) != 0]
        lines = [gap for item in part.slid if (gap := self._off(item)) is not None]
        self._close(part, loops, lines)

    def _point(self, link):
        """Direction of a link: of the crank, of what it slides along, or unknown."""
        if link in self.bodies:
            return self.bodies[link]
        ways: Any = (N.x, N.y)
        if link == "crank":
            frame, turning = self._frame(link, PHI), sp.S.One
        elif link in self.slid:
            frame, turning = self._slot(self.slid[link])
            if self.slid[link].other == FRAME:
                ways = frame.x, frame.y
        else:
            (theta,) = functions(f"theta_{link}")
            self.angles[link] = theta
            frame, turning = self._frame(link, theta), slope(theta)
            self.rays[theta] = frame.x
        axis = -frame.x if link in self.slid and self.slid[link].rod else frame.x
        self.bodies[link] = Body(None, frame, axis, turning, ways)
        return self.bodies[link]

    def _frame(self, name, angle, base=N, turning=None):
        frame = ReferenceFrame(name)
        frame.orient_axis(base, base.z, angle)
        frame.set_ang_vel(base, (slope(angle) if turning is None else turning) * PHI.diff() * N.z)
        return frame

    def _slot(self, item):
        """Frame along which a link slides, and its turning."""
        if item.other == FRAME:
            return self._frame(f"{item.link} guide", sp.Symbol(f"{item.link}_guide_angle"), turning=0), sp.S.Zero
        body = self._point(item.other)
        angle = self.number(f"{item.other}_{item.joint}_angle")
        return (self._frame(f"{item.link} slot", angle, body.frame, 0) if angle else body.frame), body.turning

    def _foot(self, item):
        """Point of the line of a pair that is nearest to the reference joint of what is slid on, or to O."""
        frame = self.bodies[item.link].frame
        if item.other == FRAME:
            return sp.Symbol(f"{item.link}_guide_offset") * frame.y
        return self.bodies[item.other].joint + self.number(f"{item.other}_{item.joint}_offset") * frame.y

    def _place(self, joint):
        """Position of a joint."""
        if joint not in self.places:
            link = self.owners[joint]
            body = self.bodies[link]
            if body.joint is not None:
                along, across = (self.number(f"{joint}_{part}") for part in ("along", "across"))
                self.places[joint] = body.joint + along * body.axis + across * left(body.axis)
            elif link in self.slid and self.slid[link].joint == joint:
                (travel,) = functions(f"travel_{link}")
                self.travels[link] = travel
                self.places[joint] = self._foot(self.slid[link]) + travel * body.frame.x
            else:
                reference = next(name for part in self.structure.parts for of, name in part.links if of == link)
                if reference == joint:
                    raise NotGivenError(f"nothing that is declared says where joint {joint} of the {link} is")
                body.joint = self._place(reference)
                return self._place(joint)
        return self.places[joint]

    def _on(self, link, joint):
        """Position of a joint as that of a point of a link."""
        if self.owners[joint] == link or link == FRAME or (joint, link) not in self.bars:
            return self.places[joint]
        body = self.bodies[link]
        return body.joint + self.number(f"{link}_length") * body.axis

    def _gaps(self, item):
        return self._on(item.link, item.joint), self._on(item.other, item.joint)

    def _off(self, item):
        """How far a joint is off the line that it slides along; None where it was placed on that."""
        if item.link in self.travels:
            return None
        body = self.bodies[item.link]
        return (self.places[item.joint] - self._foot(item)) & body.frame.y

    # Loops

    def _close(self, part, loops, lines):
        """Closed forms of the unknown functions of a group from its loops, and their derivatives."""
        links = [link for link, _ in part.links]
        for link in links:
            if link in self.led:
                self._lead(self.led[link])
        angles = [self.angles[link] for link in links if link in self.angles and link not in self.led]
        travels = [link for link in links if link in self.travels and link not in self.led]
        shape = len(angles), len(travels), len(loops), len(lines)
        if shape == (0, 0, 0, 0):
            return
        if shape == (1, 1, 1, 0):
            ((gap, _),), (link,) = loops, travels
            frame = self.bodies[link].frame
            self._turn(angles[0], gap & frame.y)
            self._travel(link, gap & frame.x)
        elif shape == (2, 0, 1, 0):
            self._triangle(*angles, loops[0][0])
        elif shape == (1, 0, 0, 1):
            self._turn(angles[0], lines[0])
        elif shape == (0, 1, 0, 1):
            self._travel(travels[0], lines[0])
        else:
            raise NotGivenError(f"the loops of {part.kind} have no closed form that is known")

    def _lead(self, cam):
        """Function that a cam gives."""
        curve, prefix = CURVES[cam.curve], f"{cam.link}_cam"
        if cam.link in self.travels:
            curve(self, self.travels[cam.link], prefix, cam.terms)
            return
        theta, (law,) = self.angles[cam.link], functions(f"law_{cam.link}")
        curve(self, law, prefix, cam.terms)
        start, sense = sp.symbols([f"{cam.link}_from", f"{cam.link}_sense"])
        self._turned(theta, sp.cos(start + sense * law), sp.sin(start + sense * law))
        self.derivatives(theta, sense * slope(law), sense * slope(law, 2))

    def _turned(self, theta, cosine, sine):
        for function, value in ((sp.cos, cosine), (sp.sin, sine)):
            self.symbols[function(theta)] = symbol = sp.Symbol(f"{function}_{theta.func}")
            self.steps[symbol] = value

    def _turn(self, theta, gap):
        """Angle that meets an equation linear in its cosine and sine."""
        self._meet(theta, gap)
        for order in (1, 2):
            self._derivative(theta, slope(gap, order), order)

    def _meet(self, theta, gap):
        a, b, rest = linear(gap, sp.cos(theta), sp.sin(theta))
        square = a**2 + b**2
        square = square if square.has(PHI) else sp.trigsimp(square)
        side = sp.Symbol(f"side_{theta.func}")
        root = side * sp.sqrt(square - rest**2)
        self.sides[str(side)] = next(link for link, angle in self.angles.items() if angle == theta)
        self.motions[str(side)] = (a, b)
        self._turned(theta, (-rest * a - root * b) / square, (-rest * b + root * a) / square)

    def _triangle(self, theta, psi, gap):
        """Two angles that close a triangle: gap = d + p e(theta) + q e(psi) = 0."""
        turned = [turn(angle) for angle in (theta, psi) for turn in (sp.cos, sp.sin)]
        (p, aside, q, askew, x), (*_, y) = (linear(gap & way, *turned) for way in (N.x, N.y))
        if aside != 0 or askew != 0:
            raise NotGivenError("links of a loop of two angles must have their joints on their lines")
        self._meet(theta, x * sp.cos(theta) + y * sp.sin(theta) + (x**2 + y**2 + p**2 - q**2) / (2 * p))
        self._turned(psi, -(x + p * sp.cos(theta)) / q, -(y + p * sp.sin(theta)) / q)
        moving = gap
        for order in (1, 2):
            moving = rate(moving)
            for angle, other in ((theta, psi), (psi, theta)):
                self._derivative(angle, moving & self.rays[other], order)

    def _travel(self, link, gap):
        """Travel that meets a linear equation."""
        travel = self.travels[link]
        steepness, rest = linear(gap, travel)
        self.symbols[travel] = symbol = sp.Symbol(f"{travel.func}_0")
        self.steps[symbol] = -rest / steepness
        for order in (1, 2):
            self._derivative(travel, slope(gap, order), order)

    def _derivative(self, function, equation, order):
        """Derivative of a function from an equation's derivative, which is linear in it."""
        steepness, rest = linear(equation, slope(function, order))
        self._name(function, order, -rest / steepness)

    def _name(self, function, order, value):
        self.symbols[slope(function, order)] = symbol = sp.Symbol(f"{function.func}_{order}")
        self.steps[symbol] = value

    def derivatives(self, function, first, second):
        """Give both derivatives of a function."""
        self._name(function, 1, first)
        self._name(function, 2, second)

    def define(self, function, value, first=None):
        """Give a function of the crank angle by its value and, if that is shorter, its derivative."""
        self.symbols[function] = symbol = sp.Symbol(f"{function.func}_0")
        self.steps[symbol] = value
        first = slope(value) if first is None else first
        self.derivatives(function, first, slope(first))

    # Results of motion

    def _report(self):
        for link, body in self.bodies.items():
            if link == FRAME:
                continue
            turning = body.turning
            self.motions[f"{link}_rate"] = (OMEGA * turning,)
            self.motions[f"{link}_angular_acceleration"] = (OMEGA**2 * slope(turning) + ALPHA * turning,)
            moving = OMEGA * rate(body.joint)
            parts = [vector & way for vector in (body.joint, body.axis, moving) for way in (N.x, N.y)]
            self.motions[f"{link} in motion"] = (*parts, OMEGA * turning)
        for link, item in self.slid.items():
            if item.other == FRAME:
                travel = self.travels[link]
                self.motions[f"{link}_position"] = (travel,)
                self.motions[f"{link}_velocity"] = (OMEGA * slope(travel),)
                self.motions[f"{link}_acceleration"] = (OMEGA**2 * slope(travel, 2) + ALPHA * slope(travel),)

    # Forces

    def _apply(self):
        """Bodies with auxiliary speeds, and all that acts on them."""
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
        mass, along, across, turning = sp.symbols([f"{link}_{part}" for part in LINK])
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
            push, stiffness, free, cubic = sp.symbols([f"{link}_{name}" for name in ("push", "stiffness", "free", "cubic")])
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
        self.forces[item.name] = (force & N.x, force & N.y)
        self._push(item.link, self._on(item.link, item.joint), force)
        self._push(item.other, self._on(item.other, item.joint), -force)

    def _slide(self, item):
        force, couple = self._unknown(item.force), self._unknown(item.couple)
        across = self.bodies[item.link].frame.y
        self.forces |= {item.force: (force,), item.couple: (couple,)}
        if item.vector:
            self.forces[item.vector] = (force * across & N.x, force * across & N.y)
        self._act(item.link, item.other, self.places[item.about], force * across, couple)

    def _press(self, cam):
        """Contact of a cam, by its way along the curve as seen from what the curve is fixed to."""
        body, base, force = self.bodies[cam.link], self.bodies[cam.body], self._unknown(cam.force)
        joint = self.places[cam.joint]
        passing = rate(joint) - base.turning * left(joint - base.joint)
        self.forces[cam.force] = (force,)
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
                    for size in range(1, LARGEST + 1)
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


def linear(expression, *unknowns):
    """Coefficients of what an expression is linear in, and the rest."""
    names = {unknown: sp.Dummy() for unknown in unknowns}
    named = expression.xreplace(names)
    return *(named.diff(name) for name in names.values()), named.xreplace(dict.fromkeys(names.values(), sp.S.Zero))

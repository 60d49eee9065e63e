"""Motion of a mechanism in symbols, from the declarations of its groups: closed forms of loops and cams.

The crank angle is the only coordinate. A loop has a closed form if it contains one angle, one travel, one of each, or
two angles; rates and accelerations are derivatives by the crank angle.
"""

from typing import Any

import sympy as sp
from sympy.physics.mechanics import ReferenceFrame, dynamicsymbols

from ....errors import NotGivenError
from ....machine.group import FRAME

PHI, SPEED = dynamicsymbols("phi speed")
ANGLE, OMEGA, ALPHA, TORQUE = sp.symbols("crank_angle crank_speed crank_acceleration balancing_torque")
N = ReferenceFrame("N")


def planar(x, y):
    return x * N.x + y * N.y


def left(vector):
    """Vector after a quarter turn counter-clockwise."""
    return N.z ^ vector


def unknown(name):
    """Function of the crank angle, still undefined."""
    return sp.Function(name)(PHI)


def slope(expression, order=1):
    """Derivative by the crank angle."""
    return sp.diff(expression, PHI, order) if order else expression


def rate(vector):
    """Derivative of a vector by the crank angle."""
    return vector.dt(N).subs(PHI.diff(), 1)


def linear(expression, *unknowns):
    """Coefficients of unknowns in an expression that is linear in them, and the rest."""
    names = {unknown: sp.Dummy() for unknown in unknowns}
    named = expression.xreplace(names)
    return *(named.diff(name) for name in names.values()), named.xreplace(dict.fromkeys(names.values(), sp.S.Zero))


def circle(equations, radius, prefix, terms):
    """Define the radius of a pitch circle with any centre."""
    root = unknown(f"root_{prefix}")
    x, y, size = sp.symbols([f"{prefix}_{name}" for name in ("x", "y", "radius")])
    square = size**2 - (y * sp.cos(PHI) - x * sp.sin(PHI)) ** 2
    equations.define(root, sp.sqrt(square), slope(square) / (2 * root))
    equations.define(radius, x * sp.cos(PHI) + y * sp.sin(PHI) + root)


def cosine_law(equations, radius, prefix, terms):
    """Define the radius by the sawframe study's cosine law, with a root that changes sign at the singular angle."""
    height, root = unknown(f"height_{prefix}"), unknown(f"root_{prefix}")
    names = "mean", "amplitude", "angle", "length", "singular"
    mean, amplitude, guide, length, singular = sp.symbols([f"{prefix}_{name}" for name in names])
    angle, side = PHI - guide, sp.Symbol(f"side_{prefix}")
    travel = mean + amplitude * sp.cos(angle)
    equations.steps[side] = sp.sign(sp.cos(angle) - singular)
    equations.define(height, travel * sp.sin(angle))
    equations.define(root, side * sp.sqrt(length**2 - height**2), -height * slope(height) / root)
    equations.define(radius, travel * sp.cos(angle) - root)


def harmonic(equations, radius, prefix, terms):
    """Define the radius as a sum of cosines and sines."""
    cosines, sines = terms
    angle = PHI - sp.Symbol(f"{prefix}_angle")
    parts = [sp.Symbol(f"{prefix}_cosine{k}") * sp.cos(k * angle) for k in range(cosines)]
    parts += [sp.Symbol(f"{prefix}_sine{k}") * sp.sin(k * angle) for k in range(1, sines + 1)]
    equations.define(radius, sp.Add(*parts))


def sampled(equations, function, prefix, terms):
    """Define a curve by its computed values and derivatives."""
    equations.define(function, *sp.symbols([f"{prefix}_{order}" for order in range(3)]))


CURVES = {"circle": circle, "cosine law": cosine_law, "harmonic": harmonic, "given": sampled}


class Body:
    """A link: reference joint, direction, derivative of its angle by the crank angle, and auxiliary speeds.

    `ways` are the directions of its auxiliary speeds.
    """

    def __init__(self, joint, frame, axis, turning, ways):
        self.joint, self.frame, self.axis, self.turning, self.ways = joint, frame, axis, turning, ways
        self.shift, self.spin = 0 * N.x, 0

    def at(self, position):
        """Auxiliary velocity of the link's point at a position."""
        return self.shift + self.spin * left(position - self.joint)


class Motion:
    """Motion of one structure of mechanism.

    `steps` are intermediate values by symbol, which may use one another in any order; `motions` are results by name, in
    components. In both, `symbols` replace the crank angle, its functions and their derivatives. `sides` are signs of
    roots, set by the assembly. Each chooses the angle theta of a link: the sign of a sin(theta) - b cos(theta), with
    a, b from the results of that name.
    """

    def __init__(self, structure):
        self.structure = structure
        self.steps, self.motions = {}, {}
        self.sides: dict[str, str] = {}
        self.symbols = {SPEED.diff(): ALPHA, SPEED: OMEGA, PHI.diff(): OMEGA, PHI: ANGLE}
        self.places: dict[str, Any] = {}
        self.bodies: dict[str, Body] = {FRAME: Body(0 * N.x, N, N.x, 0, (N.x, N.y))}
        self.owners = dict(item for part in structure.parts for item in part.joints)
        self.bars = {(end, link): link for part in structure.parts for _, end, link in part.bars}
        self.slides = {pair.link: pair for part in structure.parts for _, pair in part.slides}
        self.rods = {link for part in structure.parts for link in part.rods}
        self.led = {cam.link: part.curve for part in structure.parts for cam in part.cams}
        self.angles: dict[str, Any] = {}
        self.rays: dict[Any, Any] = {}
        self.travels: dict[str, Any] = {}
        for part in structure.parts:
            for link, _ in part.links:
                self._point(link)
            for joint, _ in part.joints:
                self._place(joint)
            for link, joint in part.links:
                self.bodies[link].joint = self._place(joint)
            self._close(part)
        self._report()

    def number(self, name):
        """Symbol of a length or angle, or 0 if it is zero."""
        return sp.S.Zero if name in self.structure.zeros else sp.Symbol(name)

    # Positions

    def _point(self, link):
        """Body of a link, with the direction of the crank, of its slot or guide, or an unknown angle."""
        if link in self.bodies:
            return self.bodies[link]
        ways: Any = (N.x, N.y)
        item = self.slides.get(link)
        if link == "crank":
            frame, turning = self._frame(link, PHI), sp.S.One
        elif item is None:
            self.angles[link] = theta = unknown(f"theta_{link}")
            frame, turning = self._frame(link, theta), slope(theta)
            self.rays[theta] = frame.x
        elif item.against == FRAME:
            frame, turning = self._frame(f"{link} guide", sp.Symbol(f"{link}_guide_angle"), turning=0), sp.S.Zero
            ways = frame.x, frame.y
        else:
            body = self._point(item.against)
            angle, turning = self.number(f"{item.against}_{item.joint}_angle"), body.turning
            frame = self._frame(f"{link} slot", angle, body.frame, 0) if angle else body.frame
        self.bodies[link] = Body(None, frame, -frame.x if link in self.rods else frame.x, turning, ways)
        return self.bodies[link]

    def _frame(self, name, angle, base=N, turning=None):
        frame = ReferenceFrame(name)
        frame.orient_axis(base, base.z, angle)
        frame.set_ang_vel(base, (slope(angle) if turning is None else turning) * PHI.diff() * N.z)
        return frame

    def _foot(self, item):
        """Foot of the perpendicular on the line of a pair, from the slotted link's reference joint or from O."""
        frame = self.bodies[item.link].frame
        if item.against == FRAME:
            return sp.Symbol(f"{item.link}_guide_offset") * frame.y
        return self.bodies[item.against].joint + self.number(f"{item.against}_{item.joint}_offset") * frame.y

    def _place(self, joint):
        """Position of a joint."""
        if joint not in self.places:
            link = self.owners[joint]
            body = self.bodies[link]
            if body.joint is not None:
                along, across = (self.number(f"{joint}_{part}") for part in ("along", "across"))
                position = body.joint + along * body.axis + across * left(body.axis)
                self.places[joint] = position.express(N) if link == "crank" else position
            elif link in self.slides and self.slides[link].joint == joint:
                self.travels[link] = travel = unknown(f"travel_{link}")
                self.places[joint] = self._foot(self.slides[link]) + travel * body.frame.x
            else:
                reference = next(name for part in self.structure.parts for of, name in part.links if of == link)
                if reference == joint:
                    raise NotGivenError(f"no declaration gives the position of joint {joint} of the {link}")
                body.joint = self._place(reference)
                return self._place(joint)
        return self.places[joint]

    def _on(self, link, joint):
        """Position of a joint as a point of a link."""
        if self.owners[joint] == link or link == FRAME or (joint, link) not in self.bars:
            return self.places[joint]
        body = self.bodies[link]
        return body.joint + self.number(f"{link}_length") * body.axis

    # Loops

    def _close(self, part):
        """Define the unknown functions of a group and their derivatives from its loops."""
        gaps = (self._on(pin.link, pin.joint) - self._on(pin.against, pin.joint) for _, pin in part.pins)
        loops = [gap for gap in gaps if gap != 0]
        lines = [
            (self.places[item.joint] - self._foot(item)) & self.bodies[item.link].frame.y
            for _, item in part.slides
            if item.link not in self.travels
        ]
        links = [link for link, _ in part.links]
        for link in links:
            if link in self.led:
                self._lead(link)
        angles = [self.angles[link] for link in links if link in self.angles and link not in self.led]
        travels = [link for link in links if link in self.travels and link not in self.led]
        shape = len(angles), len(travels), len(loops), len(lines)
        if shape == (0, 0, 0, 0):
            return
        if shape == (1, 1, 1, 0):
            (gap,), (link,) = loops, travels
            frame = self.bodies[link].frame
            self._turn(angles[0], gap & frame.y)
            self._travel(link, gap & frame.x)
        elif shape == (2, 0, 1, 0):
            self._triangle(*angles, *loops)
        elif shape == (1, 0, 0, 1):
            self._turn(*angles, *lines)
        elif shape == (0, 1, 0, 1):
            self._travel(*travels, *lines)
        else:
            raise NotGivenError(f"the loops of {part.kind} have no known closed form")

    def _lead(self, link):
        """Define the travel or angle of a link on a cam."""
        (kind, terms), prefix = self.led[link], f"{link}_cam"
        if link in self.travels:
            CURVES[kind](self, self.travels[link], prefix, terms)
            return
        theta, law = self.angles[link], unknown(f"law_{link}")
        CURVES[kind](self, law, prefix, terms)
        start, sense = sp.symbols([f"{link}_from", f"{link}_sense"])
        self._define_direction(theta, sp.cos(start + sense * law), sp.sin(start + sense * law))
        self.define(theta, None, sense * slope(law), sense * slope(law, 2))

    def _define_direction(self, theta, cosine, sine):
        for function, value in ((sp.cos, cosine), (sp.sin, sine)):
            self._set(function(theta), f"{function}_{theta.func}", value)

    def _turn(self, theta, gap):
        """Define an angle by an equation linear in its cosine and sine."""
        self._meet(theta, gap)
        for order in (1, 2):
            self._derivative(theta, slope(gap, order), order)

    def _meet(self, theta, gap):
        a, b, rest = linear(gap, sp.cos(theta), sp.sin(theta))
        square = a**2 + b**2
        square = square if square.has(PHI) else sp.trigsimp(square)
        side, off = sp.Symbol(f"side_{theta.func}"), sp.Symbol(f"off_{theta.func}")
        self.steps[off], rest = rest, off
        root = side * sp.sqrt(square - rest**2)
        self.sides[str(side)] = next(link for link, angle in self.angles.items() if angle == theta)
        self.motions[str(side)] = (a, b)
        self._define_direction(theta, (-rest * a - root * b) / square, (-rest * b + root * a) / square)

    def _triangle(self, theta, psi, gap):
        """Define two angles by a triangle: gap = d + p e(theta) + q e(psi) = 0."""
        turned = [turn(angle) for angle in (theta, psi) for turn in (sp.cos, sp.sin)]
        (p, aside, q, askew, x), (*_, y) = (linear(gap & way, *turned) for way in (N.x, N.y))
        if aside != 0 or askew != 0:
            raise NotGivenError("links of a loop of two angles must have their joints on their lines")
        self._meet(theta, x * sp.cos(theta) + y * sp.sin(theta) + (x**2 + y**2 + p**2 - q**2) / (2 * p))
        self._define_direction(psi, -(x + p * sp.cos(theta)) / q, -(y + p * sp.sin(theta)) / q)
        moving = gap
        for order in (1, 2):
            moving = rate(moving)
            for angle, other in ((theta, psi), (psi, theta)):
                self._derivative(angle, moving & self.rays[other], order)

    def _travel(self, link, gap):
        """Define a travel by a linear equation."""
        travel = self.travels[link]
        steepness, rest = linear(gap, travel)
        self._set(travel, f"{travel.func}_0", -rest / steepness)
        for order in (1, 2):
            self._derivative(travel, slope(gap, order), order)

    def _derivative(self, function, equation, order):
        """Define a derivative of a function by the derivative of an equation, linear in it."""
        steepness, rest = linear(equation, slope(function, order))
        self._set(slope(function, order), f"{function.func}_{order}", -rest / steepness)

    def _set(self, expression, name, value):
        """Add a step for an expression, with the name of its symbol."""
        self.symbols[expression] = symbol = sp.Symbol(name)
        self.steps[symbol] = value

    def define(self, function, value, first=None, second=None):
        """Define a function of the crank angle by its value and, where these are shorter, its derivatives."""
        first = slope(value) if first is None else first
        for order, part in enumerate((value, first, slope(first) if second is None else second)):
            if part is not None:
                self._set(slope(function, order), f"{function.func}_{order}", part)

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
        for link, item in self.slides.items():
            if item.against == FRAME:
                travel = self.travels[link]
                self.motions[f"{link}_position"] = (travel,)
                self.motions[f"{link}_velocity"] = (OMEGA * slope(travel),)
                self.motions[f"{link}_acceleration"] = (OMEGA**2 * slope(travel, 2) + ALPHA * slope(travel),)

"""Equations of each kind of mechanism in symbols, as SymPy's Kane method takes them (see `kane`)."""

from typing import Any

import sympy as sp
from sympy.physics.mechanics import KanesMethod, Point, ReferenceFrame, RigidBody, dynamicsymbols, inertia

PHI, SPEED = dynamicsymbols("phi speed")
ANGLE, OMEGA, ALPHA, TORQUE = sp.symbols("crank_angle crank_speed crank_acceleration balancing_torque")
N, CRANK = ReferenceFrame("N"), ReferenceFrame("crank")
CRANK.orient_axis(N, N.z, PHI)
CRANK.set_ang_vel(N, SPEED * N.z)
ORIGIN = 0 * N.x
LINK = "mass", "along", "across", "inertia"


def planar(x, y):
    return x * N.x + y * N.y


def left(vector):
    """Vector after a quarter turn counter-clockwise."""
    return N.z ^ vector


def functions(*names):
    """Unknown functions of the crank angle."""
    return [sp.Function(name)(PHI) for name in names]


def slope(expression, order=1):
    """Derivative by the crank angle."""
    return sp.diff(expression, PHI, order) if order else expression


class Equations:
    """Equations of one kind of mechanism, begun with its crank.

    Attributes
    ----------
    steps : dict of Symbol to expression
        What results are computed from; a step may use others, in any order.
    motions, forces : dict of str to tuple of expressions
        Results by name, in components.
    symbols : dict of expression to Symbol
        What stands for time and crank angle, functions of them and their derivatives in steps and results.
    unknowns : dict of speed to Symbol
        Unknown that the equation of each speed gives.
    alone : set of speeds
        Those in whose equations the other unknowns do no work, though SymPy does not see it.
    """

    def __init__(self):
        self.steps, self.motions = {}, {}
        self.forces: dict[str, tuple[Any, ...]] = {"balancing_torque": (TORQUE,)}
        self.symbols = {SPEED.diff(): ALPHA, SPEED: OMEGA, PHI.diff(): OMEGA, PHI: ANGLE}
        self.unknowns, self.alone = {SPEED: TORQUE}, {SPEED}
        self.bodies, self.loads = [], []
        self.shift, reaction = self.parting("O")
        crank = self.link("crank", CRANK.x, ORIGIN, 1, self.shift)
        self.push(ORIGIN, self.shift, reaction)
        self.loads.append((crank, TORQUE * N.z))

    @property
    def results(self):
        return self.motions | self.forces | {"balancing_torque_by_power": (TORQUE,)}

    def define(self, function, value, rate=None):
        """Give a function of the crank angle by its value and, if that is shorter, its derivative."""
        first = slope(value) if rate is None else rate
        for order, expression in enumerate((value, first, slope(first))):
            self.symbols[slope(function, order)] = symbol = sp.Symbol(f"{function.func}_{order}")
            self.steps[symbol] = expression

    def report(self, function, rate, acceleration):
        """Make results of a function's derivatives by time."""
        self.motions[rate] = (OMEGA * slope(function),)
        self.motions[acceleration] = (OMEGA**2 * slope(function, 2) + ALPHA * slope(function),)

    def auxiliary(self, unknown, alone=False):
        """Auxiliary speed, and the unknown that its equation gives."""
        speed, symbol = dynamicsymbols(f"speed_{unknown}"), sp.Symbol(unknown)
        self.unknowns[speed] = symbol
        self.alone |= {speed} if alone else set()
        return speed, symbol

    def parting(self, joint):
        """Auxiliary velocity of one link alone, and the reaction on it at its joint."""
        (to_x, x), (to_y, y) = self.auxiliary(f"{joint}_x"), self.auxiliary(f"{joint}_y")
        self.forces[joint] = (x, y)
        return planar(to_x, to_y), planar(x, y)

    def push(self, position, shift, force):
        """Force at a point that moves as its position does and, besides, with an auxiliary velocity."""
        point = Point("P")
        point.set_vel(N, position.dt(N).subs(PHI.diff(), SPEED) + shift)
        self.loads.append((point, force))
        return point

    def join(self, position, force, on, by):
        """Force on the link with one auxiliary velocity at a joint, and back on that with another."""
        self.push(position, on, force)
        self.push(position, by, -force)

    def link(self, name, axis, joint, ratio, shift, spin=0):
        """Body with its weight; its reference joint has the auxiliary velocity `shift`, itself the rate `spin`."""
        frame = ReferenceFrame(name)
        frame.set_ang_vel(N, (ratio * SPEED + spin) * N.z)
        mass, along, across, turning = sp.symbols([f"{name}_{part}" for part in LINK])
        arm = along * axis + across * left(axis)
        weight = mass * planar(*sp.symbols("gravity_x gravity_y"))
        centre = self.push(joint + arm, shift + spin * left(arm), weight)
        self.bodies.append(RigidBody(name, centre, frame, mass, (inertia(N, 0, 0, turning), centre)))
        return frame

    def solved(self):
        """The same with the unknowns among the steps."""
        speeds = list(self.unknowns)
        method = KanesMethod(N, [PHI], speeds[:1], [PHI.diff() - SPEED], u_auxiliary=speeds[1:])
        active, inertial = method.kanes_equations(self.bodies, self.loads)
        for (speed, unknown), equation in zip(self.unknowns.items(), active + inertial, strict=True):
            absent = self.unknowns.values() if speed in self.alone else [unknown]
            self.steps[unknown] = -equation.xreplace(dict.fromkeys(absent, sp.S.Zero)) / equation.diff(unknown)
        return self


def crank_pin():
    """Position of A, along fixed axes, so that coupler and slider share its components."""
    return (sp.Symbol("crank_length") * CRANK.x).express(N)


def add_slider(equations, A, bearer):
    """Coupler and slider on joint A of a link, which has there the auxiliary velocity `bearer`."""
    length, offset, assembly, guide = sp.symbols("coupler_length guide_offset assembly guide_angle")
    stiffness, free, process = sp.symbols("stiffness free_position process_force")
    theta, travel = functions("theta", "travel")
    along = planar(sp.cos(guide), sp.sin(guide))
    across = left(along)
    sine = (offset - (A & across)) / length
    for function, value in (sp.sin, sine), (sp.cos, assembly * sp.sqrt(1 - sp.sin(theta) ** 2)):
        equations.symbols[function(theta)] = symbol = sp.Symbol(f"{function}_theta")
        equations.steps[symbol] = value
    equations.define(theta, sp.asin(sine), slope(sine) / sp.cos(theta))
    equations.define(travel, (A & along) + length * sp.cos(theta))
    equations.report(theta, "coupler_rate", "coupler_angular_acceleration")
    equations.report(travel, "slider_velocity", "slider_acceleration")
    equations.motions["slider_position"] = (travel,)

    axis, B = sp.cos(theta) * along + sp.sin(theta) * across, travel * along + offset * across
    spin, normal = equations.auxiliary("guide_force", alone=True)
    tilt, moment = equations.auxiliary("guide_moment")
    coupler, at_A = equations.parting("A")
    slider, at_B = equations.parting("B")
    swept = spin * length * left(axis)  # coupler about A, with it the slider
    equations.link("coupler", axis, A, slope(theta), coupler, spin)
    frame = equations.link("slider", along, B, 0, slider + swept, tilt)
    equations.join(A, at_A, coupler, bearer)
    equations.join(B, at_B, slider + swept, coupler + swept)
    equations.push(B, slider + swept, (process - stiffness * (travel - free)) * along + normal * across)
    equations.loads.append((frame, moment * N.z))
    equations.forces["guide"] = (normal * across & N.x, normal * across & N.y)
    equations.forces |= {"guide_force": (normal,), "guide_moment": (moment,)}
    return equations


def crank_slider():
    equations = Equations()
    return add_slider(equations, crank_pin(), equations.shift)


def cam_crank_slider(law):
    equations = Equations()
    (radius,) = functions("radius")
    law(equations, radius)
    (outward, cam), (sideways, slot) = equations.auxiliary("cam_force"), equations.auxiliary("slot_force")
    block, A = outward * CRANK.x + sideways * CRANK.y, radius * CRANK.x
    inward = left(slope(radius) * CRANK.x + radius * CRANK.y) / sp.sqrt(slope(radius) ** 2 + radius**2)
    equations.link("block", CRANK.x, A, 1, block)
    equations.push(A, block, cam * inward + slot * CRANK.y)
    equations.push(ORIGIN, equations.shift, -slot * CRANK.y)  # its moment about O works in the crank's equation alone
    equations.forces |= {"cam_force": (cam,), "slot_force": (slot,)}
    return add_slider(equations, A.express(N), block)


def circle(equations, radius):
    """Radius of a pitch circle with any centre."""
    (root,) = functions("root")
    centre = planar(*sp.symbols("cam_x cam_y"))
    square = sp.Symbol("cam_radius") ** 2 - (centre & CRANK.y) ** 2
    equations.define(root, sp.sqrt(square), slope(square) / (2 * root))
    equations.define(radius, (centre & CRANK.x) + root)


def cosine_law(equations, radius):
    """Radius by the cosine law as the sawframe study has it, with a root that changes sign at the singular angle."""
    height, root = functions("height", "root")
    mean, amplitude, guide, length, singular = sp.symbols("mean amplitude cam_angle law_length singular_cosine")
    angle, side = PHI - guide, sp.Symbol("side")
    travel = mean + amplitude * sp.cos(angle)
    equations.steps[side] = sp.sign(sp.cos(angle) - singular)
    equations.define(height, travel * sp.sin(angle))
    equations.define(root, side * sp.sqrt(length**2 - height**2), -height * slope(height) / root)
    equations.define(radius, travel * sp.cos(angle) - root)


def four_bar():
    """Angles of coupler and rocker by atan2 and acos, their rates by the closed loop."""
    equations = Equations()
    crank, coupler, rocker, assembly = sp.symbols("crank_length coupler_length rocker_length assembly")
    theta, psi = functions("theta", "psi")
    A, pivot = crank_pin(), planar(*sp.symbols("pivot_x pivot_y"))
    q, p = (planar(sp.cos(angle), sp.sin(angle)) for angle in (theta, psi))
    x, y = (pivot - A) & N.x, (pivot - A) & N.y
    a = sp.sqrt(x**2 + y**2)

    def corner(near, far):
        return assembly * sp.acos((a**2 + near**2 - far**2) / (2 * a * near))

    rise, sine = crank * CRANK.y, left(q) & p
    equations.define(theta, sp.atan2(y, x) + corner(coupler, rocker), -(rise & p) / (coupler * sine))
    equations.define(psi, sp.atan2(-y, -x) - corner(rocker, coupler), -(rise & q) / (rocker * sine))
    equations.report(theta, "coupler_rate", "coupler_angular_acceleration")
    equations.report(psi, "rocker_rate", "rocker_angular_acceleration")

    spin, along_p = equations.auxiliary("B_along_rocker", alone=True)
    swing, along_q = equations.auxiliary("B_along_coupler", alone=True)
    of_coupler, at_A = equations.parting("A")
    of_rocker, at_pivot = equations.parting("O2")
    at_B = along_q * q + along_p * p
    equations.link("coupler", q, A, slope(theta), of_coupler, spin)
    equations.link("rocker", p, pivot, slope(psi), of_rocker, swing)
    equations.join(A, at_A, of_coupler, equations.shift)
    equations.join(A + coupler * q, at_B, of_rocker + swing * rocker * left(p), of_coupler + spin * coupler * left(q))
    equations.push(pivot, of_rocker, at_pivot)
    equations.forces["B"] = (at_B & N.x, at_B & N.y)
    return equations


KINDS = {
    "crank-slider": crank_slider,
    "circle": lambda: cam_crank_slider(circle),
    "cosine law": lambda: cam_crank_slider(cosine_law),
    "four-bar": four_bar,
}

"""Symbols and small operations that all equations of `kane` share."""

import sympy as sp
from sympy.physics.mechanics import ReferenceFrame, dynamicsymbols

PHI, SPEED = dynamicsymbols("phi speed")
ANGLE, OMEGA, ALPHA, TORQUE = sp.symbols("crank_angle crank_speed crank_acceleration balancing_torque")
N = ReferenceFrame("N")


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


def rate(vector):
    """Derivative of a vector by the crank angle."""
    return vector.dt(N).subs(PHI.diff(), 1)


def linear(expression, *unknowns):
    """Coefficients of what an expression is linear in, and the rest."""
    names = {unknown: sp.Dummy() for unknown in unknowns}
    named = expression.xreplace(names)
    return *(named.diff(name) for name in names.values()), named.xreplace(dict.fromkeys(names.values(), sp.S.Zero))

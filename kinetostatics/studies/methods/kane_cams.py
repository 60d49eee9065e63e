"""Curves of cams in symbols: what leads a link, as a function of the crank angle."""

import sympy as sp

from .kane_symbols import PHI, functions, slope


def circle(equations, radius, prefix, terms):
    """Radius of a pitch circle with any centre."""
    (root,) = functions(f"root_{prefix}")
    x, y, size = sp.symbols([f"{prefix}_{name}" for name in ("x", "y", "radius")])
    square = size**2 - (y * sp.cos(PHI) - x * sp.sin(PHI)) ** 2
    equations.define(root, sp.sqrt(square), slope(square) / (2 * root))
    equations.define(radius, x * sp.cos(PHI) + y * sp.sin(PHI) + root)


def cosine_law(equations, radius, prefix, terms):
    """Radius by the cosine law as the sawframe study has it, with a root that changes sign at the singular angle."""
    height, root = functions(f"height_{prefix}", f"root_{prefix}")
    names = "mean", "amplitude", "angle", "length", "singular"
    mean, amplitude, guide, length, singular = sp.symbols([f"{prefix}_{name}" for name in names])
    angle, side = PHI - guide, sp.Symbol(f"side_{prefix}")
    travel = mean + amplitude * sp.cos(angle)
    equations.steps[side] = sp.sign(sp.cos(angle) - singular)
    equations.define(height, travel * sp.sin(angle))
    equations.define(root, side * sp.sqrt(length**2 - height**2), -height * slope(height) / root)
    equations.define(radius, travel * sp.cos(angle) - root)


def harmonic(equations, radius, prefix, terms):
    """Sum of cosines and sines."""
    cosines, sines = terms
    angle = PHI - sp.Symbol(f"{prefix}_angle")
    parts = [sp.Symbol(f"{prefix}_cosine{k}") * sp.cos(k * angle) for k in range(cosines)]
    parts += [sp.Symbol(f"{prefix}_sine{k}") * sp.sin(k * angle) for k in range(1, sines + 1)]
    equations.define(radius, sp.Add(*parts))


def given(equations, function, prefix, terms):
    """Values and derivatives that a curve gives itself."""
    value, first, second = sp.symbols([f"{prefix}_{order}" for order in range(3)])
    equations.symbols[function] = symbol = sp.Symbol(f"{function.func}_0")
    equations.steps[symbol] = value
    equations.derivatives(function, first, second)


CURVES = {"circle": circle, "cosine law": cosine_law, "harmonic": harmonic, "given": given}

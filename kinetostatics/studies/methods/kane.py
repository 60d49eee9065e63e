"""SymPy's Kane method, lambdified: the fastest way an expert would otherwise take.

The crank angle is the only coordinate; directions of links and travels of sliders are closed forms of it. Auxiliary
speeds part each link from its neighbours, so that their equations hold the reactions there (Kane and Levinson,
*Dynamics: Theory and Applications*, 1985: bringing noncontributing forces into evidence); the drive torque needs none.
`KanesMethod` derives the equations in symbols from what the groups declare, once for each structure. What is asked for,
and only that, goes through `lambdify` with common subexpressions taken out, once for each pattern of parameters that
are 0, 1 or -1, which are written in; all others are arguments. Tables, functions and loads at points are the user's own
numbers, computed of the motion before.
"""

from functools import cache

import numpy as np
import sympy as sp

from ...machine.loads import Gravity
from .applied import Applied
from .kane_equations import Equations
from .method import Method, NotGivenError, on_a_side, require_frictionless, require_one_design
from .structures import leading, structure

WRITTEN = 0, 1, -1
"""Numbers that are written into the equations."""


@cache
def derived(made):
    """Equations of a structure, solved."""
    return Equations(made).solved()


@cache
def compiled(made, names, written):
    """Function for some results of a structure, and the names of its arguments.

    `written` are pairs of a parameter's name and the value that is written in.
    """
    equations = derived(made)
    values = {sp.Symbol(name): sp.Integer(int(value)) for name, value in written}

    def final(expression):
        return expression.xreplace(equations.symbols).xreplace(values)

    results = [final(part) for name in names for part in equations.results[name]]
    steps = in_order({symbol: final(step) for symbol, step in equations.steps.items()}, results)
    shared, reduced = sp.cse([*steps.values(), *results], list=False)
    results = reduced[len(steps) :]
    steps = in_order(dict(shared) | dict(zip(steps, reduced, strict=False)), results)
    arguments = sorted({str(s) for part in (*steps.values(), *results) for s in part.free_symbols - steps.keys()})
    return sp.lambdify(arguments, results, cse=lambda parts: (list(steps.items()), parts)), arguments


def in_order(steps, results):
    """The steps that results take, each after those it takes itself."""
    ordered: dict = {}

    def take(expression):
        for symbol in sorted(expression.free_symbols & steps.keys() - ordered.keys(), key=str):
            take(steps[symbol])
            ordered[symbol] = steps[symbol]

    for result in results:
        take(result)
    return ordered


def described(solution):
    """Structure of the mechanism, and its numbers by name, without those of loads but for gravity."""
    require_one_design(solution)
    require_frictionless(solution)
    mechanism = on_a_side(solution.mechanism)
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
        values |= leading(group, solution.crank_angle)
    for side, link in derived(made).sides.items():
        a, b = function_of(made, (side,), values)()
        cosine, sine = solution.placement.links[link].direction
        values[side] = 1 if np.nansum(np.sign(a * sine - b * cosine)) >= 0 else -1
    return made, values


def function_of(made, names, values):
    """Function that computes results by name with one call of a lambdified function, as a list of components.

    It takes what is known only when it is called, by name.
    """
    plain = {name: value for name, value in values.items() if isinstance(value, int | float)}
    function, arguments = compiled(made, names, tuple(item for item in plain.items() if item[1] in WRITTEN))
    shape = np.shape(values["crank_angle"])
    fixed = [values.get(name) for name in arguments]

    def run(**moving):
        given = [moving.get(name, value) for name, value in zip(arguments, fixed, strict=True)] if moving else fixed
        with np.errstate(invalid="ignore", divide="ignore"):
            return [part if np.shape(part) == shape else np.full(shape, float(part)) for part in function(*given)]

    return run


def evaluation(solution, names):
    """Function without arguments that computes results by name, as a list of components."""
    made, values = described(solution)
    unknown = [name for name in names if name not in derived(made).results]
    if unknown:
        raise NotGivenError(f"SymPy's Kane method is not set up to give {', '.join(unknown)}")
    applied = Applied(solution, lambda name: function_of(made, (name,), values))
    run = function_of(made, names, values | applied.numbers)
    return lambda: run(**applied())


def all_forces(solution):
    """Function that computes all reactions and the torque, components by name, with one lambdified function."""
    forces = derived(described(solution)[0]).forces
    run = evaluation(solution, tuple(forces))

    def named():
        parts = iter(run())
        return {name: tuple(next(parts) for _ in components) for name, components in forces.items()}

    return named


def _prepare(solution, quantity, setting=None):
    run = evaluation(solution, (quantity,))
    return lambda: tuple(run())


METHODS = (Method("SymPy Kane, lambdified", _prepare),)

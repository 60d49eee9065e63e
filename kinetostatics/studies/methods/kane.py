"""SymPy's Kane method, lambdified: the fastest way an expert would otherwise take.

The crank angle is the only coordinate; angles of links and the cam radius are closed forms of it. Auxiliary speeds
move links apart at a joint, so that their equations hold the reactions there (Kane and Levinson, *Dynamics: Theory and
Applications*, 1985: bringing noncontributing forces into evidence); they are chosen so that each gives one unknown.
`KanesMethod` derives the equations in symbols, once for each kind of mechanism. What is asked for, and only that, goes
through `lambdify` with common subexpressions taken out, once for each pattern of parameters that are 0, 1 or -1, which
are written in; all others are arguments.
"""

from functools import cache
from typing import Any

import numpy as np
import sympy as sp

from ...machine.cam_roller import CamRoller
from ...machine.cams import Circle, CosineLaw
from ...machine.loads import Gravity, ProcessForce, Spring
from ...machine.rocker_group import RockerGroup
from ...machine.slider_group import SliderGroup
from .kane_equations import KINDS, LINK
from .method import Method, NotGivenError, on_a_side, require_one_design


@cache
def derived(kind):
    return KINDS[kind]().solved()


@cache
def compiled(kind, names, written):
    """Function for some results of a kind of mechanism, and the names of its arguments.

    `written` are pairs of a parameter's name and the value that is written in.
    """
    equations = derived(kind)
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
    """Kind of the mechanism, and its parameters by name."""
    require_one_design(solution)
    mechanism = on_a_side(solution.mechanism)
    group: Any = mechanism.groups[-1] if mechanism.groups else None
    values = {
        "crank_angle": solution.crank_angle,
        "crank_speed": solution.crank_speed,
        "crank_acceleration": solution.crank_acceleration,
        "crank_length": mechanism.crank.length,
    }
    for name, link in mechanism.links.items():
        values |= zip((f"{name}_{part}" for part in LINK), (link.mass, *link.centre, link.inertia), strict=True)
    hung = [(type(item), getattr(item, "on", "O"), getattr(item, "pin", "A")) for item in mechanism.groups]
    if hung == [(RockerGroup, "A", "B")]:
        kind, own = "four-bar", {"rocker_length": group.rocker_length, **vector("pivot", group.pivot)}
    elif hung == [(SliderGroup, "A", "B")]:
        kind, own = "crank-slider", guided(group)
    elif hung == [(CamRoller, "O", "A"), (SliderGroup, "A", "B")]:
        kind, own = shaped(mechanism.groups[0].cam)
        own |= guided(group)
    else:
        raise NotGivenError(f"SymPy's Kane method is set up for crank-sliders and four-bars, not for {mechanism.name}")
    shared = {"coupler_length": group.coupler_length, "assembly": group.assembly}
    return kind, values | shared | own | loading(solution.loads)


def vector(name, parts):
    return dict(zip((f"{name}_x", f"{name}_y"), parts, strict=True))


def guided(group):
    return {"guide_angle": float(group.guide.guide_angle), "guide_offset": group.guide.guide_offset}


def shaped(cam):
    """Kind of mechanism that a cam makes, and the cam's parameters by name."""
    if isinstance(cam, Circle):
        return "circle", {"cam_radius": cam.pitch_radius, **vector("cam", cam.centre)}
    if not isinstance(cam, CosineLaw):
        raise NotGivenError(f"SymPy needs a closed form of the cam, which {type(cam).__name__} has not")
    a, b = cam.amplitude, cam.mean
    singular = (np.sqrt(b * b + 8 * a * a) - b) / (4 * a)
    length = (b + a * singular) * np.sqrt(1 - singular * singular)
    parts = {"amplitude": a, "mean": b, "cam_angle": cam.guide_angle}
    return "cosine law", parts | {"singular_cosine": singular, "law_length": length}


def loading(loads):
    """Gravity, spring and process force by name."""
    kinds: Any = (Gravity, Spring, ProcessForce)
    weights, springs, pushes = ([item for item in loads if isinstance(item, kind)] for kind in kinds)
    number = all(isinstance(item.force, int | float) for item in pushes)
    linear = len(springs) < 2 and all(isinstance(item.cubic, float) and item.cubic == 0 for item in springs)
    if len(weights) + len(springs) + len(pushes) < len(loads) or not linear or not number:
        raise NotGivenError(
            "SymPy's Kane method takes gravity, one spring without cubic term, and process forces that are numbers"
        )
    stiffness, free = (springs[0].stiffness, springs[0].free_position) if springs else (0, 0)
    pull = [sum(parts) for parts in zip((0, 0), *(item.vector for item in weights), strict=True)]
    push = sum(item.force for item in pushes)
    return {"stiffness": stiffness, "free_position": free, "process_force": push, **vector("gravity", pull)}


def evaluation(solution, names):
    """Function that computes results by name with one call of a lambdified function, as a list of components."""
    kind, values = described(solution)
    unknown = [name for name in names if name not in derived(kind).results]
    if unknown:
        raise NotGivenError(f"SymPy's Kane method is not set up to give {', '.join(unknown)} of a {kind}")
    plain = {name: value for name, value in values.items() if isinstance(value, int | float)}
    function, arguments = compiled(kind, names, tuple(item for item in plain.items() if item[1] in (0, 1, -1)))
    given, shape = [values[name] for name in arguments], solution.crank_angle.shape

    def run():
        with np.errstate(invalid="ignore", divide="ignore"):
            return [part if np.shape(part) == shape else np.full(shape, float(part)) for part in function(*given)]

    return run


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

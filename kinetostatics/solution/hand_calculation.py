"""The hand calculation of a quantity of a solution, from the kernels' own arithmetic recorded with names."""

import warnings
from dataclasses import replace

import numpy as np

from ..cycle.rounding import without_rounding
from ..engines.engines import NUMPY
from ..errors import HintWarning, NotGivenError, ParameterError, QuantityError
from ..explain.explanation import Explanation, Step
from ..explain.formats import LATEX, MATHML, TEXT, write_formula
from ..explain.named_recording import name_result, node_of, record_with_names
from ..explain.steps import lines
from ..machine import plausibility
from ..mechanics import quantities
from ..numbers import checks
from .parameters import crank_angles, leaf_by_path, of_design, tables_over_angles


def explain(solution, quantity, angle, design=None):
    """Hand calculation of a quantity of a solution; see `Solution.explain`."""
    found, inner = _quantity(solution, quantity)
    sized = inner != quantity
    state = _alone(solution, angle, design)
    numbered = {int(number): path for path, number in leaf_by_path(state.places, state.dynamics).items()}
    units = {path: place.rule.unit for path, place in state.places.items()}
    made, recorder = record_with_names(state.dynamics, numbered, units)
    nodes = list(map(node_of, name_result(made, inner, found, sized)))
    with np.errstate(all="ignore"):
        read = quantities.component_sizes if sized else quantities.components
        parts = np.array(read(state.dynamics, inner), dtype=float)
    try:
        bounds = state.error_bound(quantity)
    except NotGivenError:
        bounds = np.nan
    rounded = zip(nodes, without_rounding(state, inner, parts, bounds), strict=True)
    zeros, nodes = {node for node, part in rounded if part == 0.0}, [node for node in nodes if node is not None]
    steps = _steps(made.names, lines(made.names, nodes, recorder, state.dynamics), zeros) if nodes else {}
    results, angle = tuple(steps[node] for node in nodes), float(state.crank_angle)
    value = parts if found.vector and not sized else float(parts[0])
    label = f"|{found.label}|" if sized else found.label
    return Explanation(state.mechanism.name, quantity, label, angle, tuple(steps.values()), results, value, found.unit)


def _quantity(solution, name):
    """The quantity of a name (except those that only check the solution), and its name without bars."""
    known = {key: found for key, found in quantities.of_scene(solution).items() if found.kind != "check"}
    inner = quantities.without_bars(solution, name) if isinstance(name, str) else None
    if inner not in known:
        raise QuantityError(checks.choice(f"{solution.mechanism.name}: quantity", name, tuple(known)))
    return known[inner], inner


def _steps(names, found, zeros):
    """Steps by node, in order; nodes in `zeros` are shown as 0."""
    symbols = {node.index: symbol for node, symbol in names.symbols([line.node for line in found]).items()}
    values = {line.node.index: 0.0 if line.is_noise or line.node in zeros else line.value for line in found}
    steps = {}
    for line in found:
        symbol, value = symbols[line.node.index], values[line.node.index]
        ways = []
        for style in (TEXT, LATEX, MATHML):
            formula = write_formula(line.tree, style, symbols.__getitem__) if line.tree else ""
            numbers = write_formula(line.tree, style, values.__getitem__) if line.tree else ""
            ways.append((style.symbol(symbol), formula, numbers, style.number(value)))
        (spelled, formula, numbers, text), *rest = ways
        named = line.named
        parts = named.title, named.words, spelled, formula, numbers, line.value, line.unit, text
        steps[line.node] = Step(*parts, *rest)
    return steps


def _alone(solution, angle, design):
    """The solution of one design at one crank angle, with the checks of `solve`."""
    asked = crank_angles(angle, "explain")
    checks.require("explain", None if asked.size == 1 else f"give one crank angle, got {asked.size}")
    asked = float(asked.reshape(()))
    for hint in plausibility.single_angle_hints(asked):
        warnings.warn(HintWarning(solution.mechanism.name, hint), stacklevel=4)
    place = _design(solution.shape[:-1], design)
    index = _index(solution, asked, place)

    return replace(of_design(solution, place, index), crank_angle=np.array(asked), engine=NUMPY).check()


def _design(batch, design):
    """Index of the requested design, a tuple."""
    if design is None:
        if np.prod(batch, dtype=int) == 1:
            return (0,) * len(batch)
        raise ParameterError(f"explain: choose one of the designs of shape {batch}, as design=0")
    place = design if isinstance(design, tuple) else (design,)
    fits = len(place) == len(batch) and all(
        isinstance(one, int | np.integer) and -count <= one < count for one, count in zip(place, batch, strict=True)
    )
    checks.require("explain", None if fits else f"design {design!r} is not among the designs of shape {batch}")
    return place


def _index(solution, angle, place):
    """Index of the angle among the given crank angles; None unless drive or loads are tables over them."""
    if not tables_over_angles(solution):
        return None
    known = np.broadcast_to(solution.crank_angle, solution.shape)[place]
    fits = np.flatnonzero(known == angle)
    if not fits.size:
        solution.at(angle)  # raises, with the names of the tables
    return int(fits[0])

"""The hand calculation behind a quantity at one crank angle, step by step: formula, numbers, result.

Made by `explaining` from the kernels' own arithmetic.

Makes the hand calculation behind a quantity of a solution.

The steps are the kernels' own arithmetic, recorded with names (engines `told`, `lines`): none is written down twice.
"""

import warnings
from dataclasses import dataclass, replace
from math import degrees, hypot
from typing import Any, NamedTuple

import numpy as np

from ..engines.engines import NUMPY
from ..errors import HintWarning, NotGivenError, ParameterError, QuantityError
from ..explain import pages
from ..explain.formats import LATEX, MATHML, TEXT, format_number, write_formula
from ..explain.named_recording import name_result, node_of, record_with_names
from ..explain.steps import lines
from ..machine import plausibility
from ..mechanics import quantities
from ..mechanics.motion import SceneParts
from ..numbers import checks
from ..numbers.lazy import cached_property
from ..numbers.parameter_tree import map_numbers
from ..results.rounding import without_rounding
from .angles import crank_angles
from .checked import check_solution
from .drive_and_loads import tables_over_angles
from .parameters import leaf_by_path


class Step(NamedTuple):
    """A step of a hand calculation.

    Attributes
    ----------
    title : str
        What it belongs to: a link, a load, the forces on a part.
    words : str
        What the number is; what is given is called by its path.
    symbol : str
    formula, numbers : str
        In symbols of steps before, and with their values; "" of what is given.
    value : float
    unit : str
    shown : str
        The value as it is shown: to 6 digits, 0 where it is rounding.
    latex, mathml : tuple of str
        Symbol, formula, numbers and value with its unit.
    """

    title: str
    words: str
    symbol: str
    formula: str
    numbers: str
    value: float
    unit: str
    shown: str
    latex: tuple[str, ...]
    mathml: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Explanation:
    """A hand calculation; made by `Solution.explain`, shown by ``print``, as a page in notebooks.

    Attributes
    ----------
    mechanism, quantity, label : str
        Names, of the quantity also in words.
    angle : float
        Crank angle, rad.
    steps : tuple of Step
    results : tuple of Step
        Those of them that give the quantity, of a vector its components.
    value : float or array (2,)
        The quantity as the solution gives it, but for the last rounding.
    unit : str

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0).solve(4)
    >>> told = s.explain("balancing_torque", 0.5)
    >>> round(float(told.value), 6), told.unit
    (14.875291, 'N m')
    """

    mechanism: str
    quantity: str
    label: str
    angle: float
    steps: tuple[Step, ...]
    results: tuple[Step, ...]
    value: Any
    unit: str

    @property
    def title(self):
        """Mechanism, quantity and crank angle."""
        angle = f"{format_number(self.angle)} rad = {format_number(degrees(self.angle))} deg"
        return f"{self.mechanism}: {self.label} at crank angle {angle}"

    @property
    def conclusion(self):
        """The quantity and its value, of a vector the magnitude too."""
        values = [step.shown for step in self.results] or [format_number(float(part)) for part in np.ravel(self.value)]
        unit = "" if self.unit == "1" else f" {self.unit}"
        if np.ndim(self.value):
            size = format_number(hypot(*self.value))
            return f"{self.quantity} = ({', '.join(values)}){unit}, magnitude {size}{unit}"
        angle = f" = {format_number(degrees(self.value))} deg" if self.unit == "rad" else ""
        return f"{self.quantity} = {values[-1]}{unit}{angle}"

    @cached_property
    def text(self):
        """The calculation in lines of 80 characters."""
        return pages.text(self)

    @cached_property
    def latex(self):
        """The calculation for a LaTeX document with amsmath."""
        return pages.latex(self)

    @cached_property
    def html(self):
        """The calculation as a piece of HTML, formulas as MathML; it asks for nothing from elsewhere."""
        return pages.html(self)

    @property
    def page(self):
        """The same as a whole page of HTML."""
        return pages.whole_page(self)

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<Explanation: {self.title}, {len(self.steps)} steps; print it>"

    def _repr_html_(self):
        return self.html

    def _repr_latex_(self):
        return self.latex


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
    rounded = zip(nodes, _without_rounding(state, quantity, inner, parts), strict=True)
    zeros, nodes = {node for node, part in rounded if part == 0.0}, [node for node in nodes if node is not None]
    steps = _steps(made.names, lines(made.names, nodes, recorder, state.dynamics), zeros) if nodes else {}
    results, angle = tuple(steps[node] for node in nodes), float(state.crank_angle)
    value = parts if found.vector and not sized else float(parts[0])
    label = f"|{found.label}|" if sized else found.label
    return Explanation(state.mechanism.name, quantity, label, angle, tuple(steps.values()), results, value, found.unit)


def _quantity(solution, name):
    """The quantity of that name, if it is one of mechanics, and its name without the bars of a magnitude."""
    known = {key: found for key, found in quantities.of_scene(solution).items() if found.kind != "check"}
    inner = quantities.without_bars(solution, name) if isinstance(name, str) else None
    if inner not in known:
        raise QuantityError(checks.choice(f"{solution.mechanism.name}: quantity", name, tuple(known)))
    return known[inner], inner


def _without_rounding(state, quantity, inner, parts):
    """Components of a quantity or its magnitude, 0 where tables say so."""
    try:
        bounds = state.error_bound(quantity)
    except NotGivenError:
        bounds = np.nan
    return without_rounding(state, inner, parts, bounds)


def _steps(names, found, zeros):
    """Steps by node, in order; values of some nodes are known to be zero but for rounding."""
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
    """The solution of one design at one crank angle, checked as `solve` does."""
    asked = crank_angles(angle, "explain")
    checks.require("explain", None if asked.size == 1 else f"one crank angle is told at a time, got {asked.size}")
    asked = float(asked.reshape(()))
    for hint in plausibility.single_angle_hints(asked):
        warnings.warn(HintWarning(solution.mechanism.name, hint), stacklevel=4)
    batch = solution.shape[:-1]
    place = _design(batch, design)
    index = _index(solution, asked, place)

    def number(leaf):
        if not np.ndim(leaf):
            return float(leaf)
        if np.shape(leaf)[-1] == 1:
            return float(np.broadcast_to(leaf, (*batch, 1))[place][0])
        fits = index is not None and np.shape(leaf)[-1] == solution.shape[-1]
        return float(np.broadcast_to(leaf, solution.shape)[place][index]) if fits else leaf

    parts = {name: map_numbers(getattr(solution, name), number) for name in SceneParts._fields}
    return check_solution(replace(solution, **parts, crank_angle=np.array(asked), engine=NUMPY))


def _design(batch, design):
    """Place of the design that is meant."""
    if design is None:
        if np.prod(batch, dtype=int) == 1:
            return (0,) * len(batch)
        raise ParameterError(f"explain: one design is told at a time, of shape {batch}; say which, as design=0")
    place = design if isinstance(design, tuple) else (design,)
    fits = len(place) == len(batch) and all(
        isinstance(one, int | np.integer) and -count <= one < count for one, count in zip(place, batch, strict=True)
    )
    checks.require("explain", None if fits else f"there is no design {design!r} among those of shape {batch}")
    return place


def _index(solution, angle, place):
    """Which of the crank angles given is meant; None where nothing has a value for each."""
    if not tables_over_angles(solution):
        return None
    known = np.broadcast_to(solution.crank_angle, solution.shape)[place]
    fits = np.flatnonzero(known == angle)
    if not fits.size:
        solution.at(angle)  # says what is unknown between the crank angles
    return int(fits[0])

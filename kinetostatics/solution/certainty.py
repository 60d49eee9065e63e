"""How sure each value of a solution is: proven bounds on rounding, and uncertainty from uncertain inputs.

The uncertainty is of first order: sensitivities f_i, exact derivatives of the recorded program, times the standard
uncertainties u_i (JCGM 100:2008, section 5.1). A warning reports where the second order is not small beside it. Of
independent normal inputs the terms of second order, 1/2 sum f_ij d_i d_j, have the mean 1/2 sum f_ii u_i^2 and the
variance 1/2 sum f_ij^2 u_i^2 u_j^2 (JCGM 100:2008, 5.1.2, note); the second order counts as the root of their mean
square. All in the unit of the quantity.
"""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from itertools import count as numbers
from typing import Any, NamedTuple

import numpy as np

from ..engines.error_bounds import of_magnitude, where_known
from ..engines.jax_backend import Backend
from ..engines.program import program_of
from ..errors import ConditionWarning, ParameterError
from ..mechanics import quantities
from ..numbers import checks
from ..numbers.arithmetic import read_only
from .condition import state_of
from .parameters import (
    Parameters,
    keep_numbers,
    leaf_by_path,
    path_problem,
    paths_without_derivative,
    require_derivatives,
)

MAX_SECOND_ORDER_SHARE = 0.1
"""Largest second order that needs no warning, relative to the first."""
MEDIAN_SHARE = 0.01
"""Least first order to compare with, relative to its median over the crank angles: at some angles it vanishes."""
MAX_PAIRWISE_INPUTS = 3
"""Inputs up to which each product of two is computed without looking at their sums first."""


class LargeSecondOrder(NamedTuple):
    """Where the second order is not small beside the first: at how many values of how many, and at the worst of them.

    `paths` are the input, or the two inputs, with the largest second order there; the second order is NaN where the
    quantity has no value with these inputs moved.
    """

    values: int
    of: int
    angle: float
    paths: tuple[str, ...]
    first: float
    second: float

    def doubt(self, quantity, unit, inputs):
        """The `Doubt` that a warning reports."""
        moved, way = " and ".join(f"{path} {inputs[path]:.3g}" for path in self.paths), " or smaller"
        found = f"with {moved} larger{way if len(self.paths) == 1 else ''} there is no value"
        if np.isfinite(self.second):
            most = " and ".join(self.paths) + (" together" if len(self.paths) > 1 else "")
            found = f"the first makes {self.first:.2g} {unit}, the second {self.second:.2g}, most of it of {most}"
        where = f"at {np.degrees(self.angle):.9g} deg {found}; vary the inputs there, as ks.tolerances does"
        places = f"which says too little at {self.values} of {self.of} crank angles"
        return Doubt(quantity, places, where, self.second / self.first if self.first > 0.0 else np.inf)


class Doubt(NamedTuple):
    """Why the first-order uncertainty of a quantity is too small: a clause, where, and second order over first."""

    quantity: str
    what: str
    where: str
    share: float = np.inf


def doubt_text(doubts):
    """One sentence on the doubts about some quantities."""
    if len(doubts) == 1:
        (doubt,) = doubts
        return f"the uncertainty of {doubt.quantity} is of first order in the inputs, {doubt.what}: {doubt.where}"
    worst = max(doubts, key=lambda doubt: np.nan_to_num(doubt.share, nan=np.inf))
    *names, last = dict.fromkeys(doubt.quantity for doubt in doubts)
    return (
        f"the uncertainties of {', '.join(names)} and {last} are of first order in the inputs, and may be more; "
        f"that of {worst.quantity} most: {worst.where}"
    )


@lru_cache(maxsize=64)
def _codes(count):
    """Integers of few bits whose pairwise differences (exclusive or) are all distinct."""
    codes: list[int] = []
    known: set[int] = set()
    for code in numbers():
        if len(codes) == count:
            return codes
        differences = {code ^ other for other in codes}
        if known.isdisjoint(differences):
            codes.append(code)
            known |= differences


def find_second_order(change, angle, first, rounding) -> LargeSecondOrder | None:
    """Where the second order, by differences, is not small; None if nowhere.

    Of many inputs sums of all products of two are computed before each product, with signs so that no two products
    cancel in every sum.

    Parameters
    ----------
    change : function
        ``change(signs)`` gives the change of the values, (components, ..., N), with inputs by path larger, 1, or
        smaller, -1, by their uncertainty.
    angle, first, rounding
        As for `large_second_order`.
    """
    paths = tuple(first)
    with np.errstate(all="ignore"):
        alone = {sign: {path: change({path: sign}) for path in paths} for sign in (1.0, -1.0)}

        def products(signs):
            return change(signs) - sum(alone[sign][path] for path, sign in signs.items())

        squares = {(path,): 0.5 * (alone[1.0][path] + alone[-1.0][path]) for path in paths}
        if len(paths) > MAX_PAIRWISE_INPUTS:
            codes = dict(zip(paths, _codes(len(paths)), strict=True))
            bits = [0, *(1 << row for row in range(max(codes.values()).bit_length()))]
            signs = ({path: -1.0 if code & bit else 1.0 for path, code in codes.items()} for bit in bits)
            sums = {("all", str(row)): products(part) for row, part in enumerate(signs)}
            if large_second_order(angle, first, squares | sums, rounding) is None:
                return None
        pairs = {pair: products(dict.fromkeys(pair, 1.0)) for pair in combinations(paths, 2)}
        return large_second_order(angle, first, squares | pairs, rounding)


def large_second_order(angle, first, second, rounding) -> LargeSecondOrder | None:
    """Where the second order is not small beside the first order and rounding; None if nowhere.

    Parameters
    ----------
    angle : array (..., N)
    first : dict of path to array (components, ..., N)
    second : dict of tuple of paths to array (components, ..., N)
        1/2 f_ii u_i^2 by (path,), and f_ij u_i u_j by (path, other).
    rounding : array (components, ..., N)
        Bound on the rounding of values.
    """
    terms = np.array(list(second.values()))
    squares = np.array([len(paths) == 1 for paths in second])
    own, parts = _root_sum_square(np.array(list(first.values())), (0, 1)), _root_sum_square(terms, 1)
    parts[squares] *= np.sqrt(2.0)  # of its mean, squared, the variance of a square is twice that
    more = _root_sum_square(np.array([*parts, _root_sum_square(terms[squares].sum(axis=0))]))
    scale = np.fmax(own, MEDIAN_SHARE * np.nanmedian(own)) if np.isfinite(own).any() else own
    gap = np.isnan(more)
    too_much = gap | (more > MAX_SECOND_ORDER_SHARE * scale + 4.0 * len(second) * _root_sum_square(rounding))
    if not too_much.any():
        return None
    worst = int(np.argmax(np.where(too_much, np.where(gap, np.inf, more / scale), -1.0)))
    most = int(np.argmax(np.nan_to_num(parts.reshape(len(parts), -1)[:, worst], nan=np.inf)))
    at = float(np.broadcast_to(angle, more.shape).flat[worst])
    paths = list(second)[most]
    return LargeSecondOrder(
        int(too_much.sum()), too_much.size, at, paths, float(own.flat[worst]), float(more.flat[worst])
    )


def _root_sum_square(part: Any, axis: Any = 0):
    """Root of the sum of squares over axes."""
    return np.sqrt(np.sum(np.square(part), axis=axis))


def sensitivities(program, by, state, leaves, backend):
    """Derivatives by quantity and path, shaped as the quantities, NaN where these are; `by` has leaves by path."""
    rows = backend.run(program.by_parameters(tuple(by.values())), state, leaves)
    count = len(program.outputs)
    gaps, found = np.isnan(rows[:count]), rows[count:].reshape(count, len(by), *state.shape)
    if gaps.any():
        found = np.where(gaps[:, None], np.nan, found)
    return {
        quantity: dict(zip(by, np.moveaxis(part, -1 - len(state.shape), 0), strict=True))
        for quantity, part in program.recording.named(read_only(found)).items()
    }


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Uncertainty of a quantity at each crank angle, all in the unit and shape of the quantity.

    Attributes
    ----------
    inputs : dict of path to array
        Uncertainty from each input alone.
    rounding : array
        Proven bound on the rounding error.
    unit : str
        SI unit of all of them.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0)), 0.5, crank_speed=100.0)
    >>> found = s.uncertainty("balancing_torque", {"crank_length": 1e-5, "slider.mass": 0.01})
    >>> {path: round(float(share), 4) for path, share in found.inputs.items()}
    {'crank_length': 0.0069, 'slider.mass': 0.1488}
    """

    inputs: dict[str, Any]
    rounding: Any
    unit: str

    @property
    def tolerance(self):
        """Standard uncertainty from all inputs, independent of each other: the root of the sum of their squares."""
        parts = list(self.inputs.values())
        return np.sqrt(np.sum(np.square(parts), axis=0)) if parts else np.zeros_like(self.rounding)

    @property
    def total(self):
        """Tolerance plus rounding: a bound is no standard deviation, so both are added."""
        return self.tolerance + self.rounding

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.total, dtype)

    def __repr__(self):
        rows = {**self.inputs, "all inputs": self.tolerance, "rounding": self.rounding}
        with np.errstate(all="ignore"):
            lines = [f"{np.nanmax(values, initial=0.0):12.3g}  {name}" for name, values in rows.items()]
        return "\n".join([f"largest over the crank angles [{self.unit}]:", *lines])


class Certainty(Parameters):
    """Bounds and uncertainties of a solution's values."""

    crank_angle: Any
    dynamics: Any
    engine: Any
    mechanism: Any
    shape: Any

    def error_bound(self, quantity, tight=False):
        """Proven bound on the rounding error of each value of a quantity, by running error analysis.

        No value computed in exact arithmetic differs from the solution's by more. Numbers given to constructors, as
        floats, and crank angles are exact; all that is derived from them, as directions of guides and gravity, is
        bounded. A guide through two points counts as rounded once.

        Parameters
        ----------
        quantity : str
            "balancing_torque", a joint (its reaction), "slider_velocity" ...; ``"|O|"`` for the magnitude of a vector.
        tight : bool
            Whether it may take twice as long, and be up to ten times smaller.

        Returns
        -------
        array
            Shaped as the quantity, in its unit: of a vector for each component. Infinite where nothing can be proven
            (a divisor may vanish, a sign is not sure), NaN where there is no value. At a dead centre where a table over
            travel has another value on the way back, it is as large as that step.

        Raises
        ------
        QuantityError
            The mechanism has no such quantity; the message lists those it has.
        NotGivenError
            A group, load or cam does more than recorded arithmetic, so its own rounding is not known.

        Notes
        -----
        Higham, *Accuracy and Stability of Numerical Algorithms*, 2002, section 3.3.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        >>> s = ks.solve(pump, [0.5, 1.0], crank_speed=100.0)
        >>> bool((s.error_bound("balancing_torque") < 1e-13).all())
        True
        """
        checks.require("error_bound", checks.quantity(quantity), checks.truth("tight", tight))
        return self._values_and_bound(quantity, tight)[1]

    def uncertainty(self, quantity, inputs):
        """Uncertainty of each value of a quantity, from uncertain inputs and from rounding.

        To first order in the inputs, by exact derivatives (JCGM 100:2008, *Guide to the expression of uncertainty in
        measurement*, section 5.1); see `tolerances` for spreads of any size and kind. Near limit positions and
        toggles, which the inputs move, first order says too little, and a warning tells where.

        Parameters
        ----------
        quantity : str
            As for `error_bound`.
        inputs : mapping of path to float
            Standard uncertainties, SI, of numbers of the scene named as in case files: ``{"crank_length": 1e-5}``.

        Returns
        -------
        Uncertainty
            With `tolerance`, `rounding` and their sum, `total`, each shaped as the quantity; for NumPy's functions it
            is an array of its `total`. Printed, it shows the largest over the crank angles.

        Raises
        ------
        QuantityError, NotGivenError
            As for `error_bound`; derivatives too are of recorded arithmetic alone.
        ParameterError
            There is no such number, or an uncertainty is negative or not finite.

        Warns
        -----
        ConditionWarning
            At some crank angle the second order of the inputs, products of two included, is more than a tenth of the
            first and more than a thousandth of the first's median, or there is no value with an input larger or
            smaller by its uncertainty, or with two larger.

        Examples
        --------
        >>> import kinetostatics as ks
        >>> pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(mass=1.0))
        >>> s = ks.solve(pump, [0.5, 1.0], crank_speed=100.0)
        >>> s.uncertainty("balancing_torque", {"crank_length": 1e-5, "slider.mass": 0.01}).tolerance.round(4)
        array([0.1489, 0.1048])
        """
        found, doubt = self.with_doubt(quantity, inputs)
        if doubt is not None:
            warnings.warn(f"{self.mechanism.name}: {doubt_text([doubt])}", ConditionWarning, stacklevel=2)
        return found

    def with_doubt(self, quantity, inputs):
        """The same, and the `Doubt` that it is too small, or None."""
        named = isinstance(inputs, Mapping) and all(isinstance(path, str) for path in inputs)
        checks.require("uncertainty", None if named else f"inputs must map paths to numbers, got {inputs!r}")
        checks.require("uncertainty", *(path_problem(self, path) for path in inputs if path not in self.places))
        require_derivatives(
            "uncertainty", self.mechanism, inputs, paths_without_derivative(self.places, self.mechanism)
        )
        given = {path: (value, self.places[path].rule.unit, {"low": 0.0}) for path, value in inputs.items()}
        inputs = checks.single_numbers("uncertainty", **given)
        checks.require("uncertainty", checks.quantity(quantity))
        values, rounding = self._values_and_bound(quantity)
        name = quantities.without_bars(self, quantity)
        found, doubt = self._slopes(name, inputs, values, rounding) if inputs else ({}, None)
        if name != quantity:
            vector = quantities.components(self, name)
            found = {path: _magnitude_slope(vector, slope) for path, slope in found.items()}
        parts = {path: np.abs(slope) * inputs[path] for path, slope in found.items()}
        return Uncertainty(parts, rounding, quantities.unit_of(self, name)), doubt

    def _slopes(self, name, inputs, values, rounding):
        """Derivatives of a quantity by path, and the doubt where they change with the inputs."""
        state = keep_numbers(self, self.places, inputs).dynamics
        program, leaves = program_of(state, (name,))
        known = leaf_by_path(self.places, state)
        by = {path: known[path] for path in inputs}
        backend = Backend("compiled" if self.engine.compiled else "numpy")
        found = sensitivities(program, by, state, leaves, backend)[name]
        first = {path: np.reshape(found[path] * inputs[path], (-1, *self.shape)) for path in by}
        values, rounding = (np.reshape(part, (-1, *self.shape)) for part in (values, rounding))
        tabled = bool(program.recording.tables)  # rows of tables are read where the moved machine is

        def change(signs):
            moved = list(leaves.numbers)
            for path, sign in signs.items():
                moved[by[path]] = moved[by[path]] + sign * inputs[path]
            others = leaves.with_numbers(moved)
            placed = state_of(state.kind.structure, others, state.crank_angle) if tabled else state
            return np.where(np.isnan(values), 0.0, backend.run(program, placed, others) - values)

        try:
            beyond = find_second_order(change, self.crank_angle, first, rounding)
            doubt = None if beyond is None else beyond.doubt(name, quantities.unit_of(self, name), inputs)
        except ParameterError as why:  # a slider beyond its table, for one
            doubt = Doubt(name, "and may be more", f"with them moved, {why}")
        return found, doubt

    def _values_and_bound(self, quantity, tight=False):
        """Values of a quantity, of a vector its components, and a bound on the rounding of it or of its magnitude."""
        name = quantities.without_bars(self, quantity)
        values, bounds = (found[name] for found in self.engine.with_bounds(self.dynamics, (name,), tight))
        if name == quantity:
            return values, read_only(where_known(values, bounds))[()]
        return values, read_only(where_known(np.hypot(*values), of_magnitude(values, bounds)))[()]


def _magnitude_slope(vector, slope):
    """Derivative of the magnitude of a vector from that of the vector; where the vector is 0, its magnitude."""
    (x, y), size = vector, np.hypot(*vector)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(size > 0.0, (x * slope[0] + y * slope[1]) / size, np.hypot(*slope))[()]

"""Accuracy of each value of a solution: proven rounding bounds, and uncertainty from uncertain inputs.

The uncertainty is of first order: sensitivities f_i, exact derivatives of the recorded program, times the standard
uncertainties u_i (JCGM 100:2008, section 5.1). A warning names the angles where the second order is not small. With
independent normal deviations d_i of the inputs, the second-order terms are 1/2 sum f_ij d_i d_j. Their mean is 1/2 sum
f_ii u_i^2, their variance 1/2 sum f_ij^2 u_i^2 u_j^2 (JCGM 100:2008, 5.1.2, note). The second order is the root of
their mean square. All values are in the unit of the quantity.
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
"""Largest ratio of second to first order without a warning."""
MEDIAN_SHARE = 0.01
"""The first order counts as at least this share of its median over the crank angles."""
MAX_PAIRWISE_INPUTS = 3
"""Largest number of inputs whose pairs are all tried at once; with more, sums over all pairs are tried first."""


class LargeSecondOrder(NamedTuple):
    """Values with a second order that is not small: their number `values` of `total`, and the worst of them.

    `paths` are the one or two inputs with the largest second order there; the second order is NaN where the
    quantity has no value with these inputs changed.
    """

    values: int
    total: int
    angle: float
    paths: tuple[str, ...]
    first: float
    second: float

    def doubt(self, quantity, unit, inputs):
        """The `Doubt` that a warning reports."""
        moved, way = " and ".join(f"{path} {inputs[path]:.3g}" for path in self.paths), " or smaller"
        found = f"with {moved} larger{way if len(self.paths) == 1 else ''} the quantity has no value"
        if np.isfinite(self.second):
            most = " and ".join(self.paths) + (" together" if len(self.paths) > 1 else "")
            found = f"first order {self.first:.2g} {unit}, second order {self.second:.2g}, mostly from {most}"
        where = f"at {np.degrees(self.angle):.9g} deg {found}; vary the inputs there, as ks.tolerances does"
        places = f"which is not accurate at {self.values} of {self.total} crank angles"
        return Doubt(quantity, places, where, self.second / self.first if self.first > 0.0 else np.inf)


class Doubt(NamedTuple):
    """Reason why a first-order uncertainty is too small: a clause, the place, and second order over first order."""

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
        f"the uncertainties of {', '.join(names)} and {last} are of first order in the inputs, and may be larger; "
        f"the worst is {worst.quantity}: {worst.where}"
    )


@lru_cache(maxsize=64)
def _sign_codes(count):
    """Integers of few bits with distinct pairwise exclusive ors: no two pairs have equal signs in all sums."""
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
    """Places where the second order, by differences, is not small; None if it is small everywhere.

    ``change(signs)`` gives the change of the values, (components, ..., N); `signs` maps paths to 1 or -1, where the
    input is larger or smaller by its uncertainty. For many inputs, sums over all pairs are tried first, with several
    choices of signs, so that two pairs cannot cancel in all sums. The other arguments are those of
    `large_second_order`.
    """
    paths = tuple(first)
    with np.errstate(all="ignore"):
        alone = {sign: {path: change({path: sign}) for path in paths} for sign in (1.0, -1.0)}

        def products(signs):
            return change(signs) - sum(alone[sign][path] for path, sign in signs.items())

        squares = {(path,): 0.5 * (alone[1.0][path] + alone[-1.0][path]) for path in paths}
        if len(paths) > MAX_PAIRWISE_INPUTS:
            codes = dict(zip(paths, _sign_codes(len(paths)), strict=True))
            bits = [0, *(1 << row for row in range(max(codes.values()).bit_length()))]
            signs = ({path: -1.0 if code & bit else 1.0 for path, code in codes.items()} for bit in bits)
            sums = {("all", str(row)): products(part) for row, part in enumerate(signs)}
            if large_second_order(angle, first, squares | sums, rounding) is None:
                return None
        pairs = {pair: products(dict.fromkeys(pair, 1.0)) for pair in combinations(paths, 2)}
        return large_second_order(angle, first, squares | pairs, rounding)


def large_second_order(angle, first, second, rounding) -> LargeSecondOrder | None:
    """Places where the second order is not small relative to the first order and rounding; None if there are none.

    `first` has arrays (components, ..., N) by path. `second` has 1/2 f_ii u_i^2 by (path,) and f_ij u_i u_j by (path,
    other). Other keys of two are those of sums over all pairs. `rounding` is a bound on the rounding of values.
    """
    terms = np.array(list(second.values()))
    squares = np.array([len(paths) == 1 for paths in second])
    own, parts = _root_sum_square(np.array(list(first.values())), (0, 1)), _root_sum_square(terms, 1)
    parts[squares] *= np.sqrt(2.0)  # the variance of a squared normal deviation is twice its squared mean
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
    """Derivatives by quantity and path, NaN where a quantity is; `by` maps each path to the index of its number."""
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
        Uncertainty from each single input.
    rounding : array
        Proven bound on the rounding error.
    unit : str
        SI unit of all values.

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
        """Tolerance plus rounding; they are added because a bound is not a standard deviation."""
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

        Exact arithmetic gives values within this bound of the solution. Numbers given to constructors, as floats, and
        crank angles count as exact. Numbers derived from them, such as directions of guides and of gravity, have
        bounds. The direction of a guide through two points counts as one rounded operation.

        Parameters
        ----------
        quantity : str
            "balancing_torque", a joint (its reaction), "slider_velocity" ...; ``"|O|"`` for the magnitude of a vector.
        tight : bool
            True: the calculation takes up to twice as long, and the bound is up to ten times smaller.

        Returns
        -------
        array
            In the shape and unit of the quantity; vectors have a bound for each component. Infinite where nothing can
            be proven (a divisor may vanish, a sign is uncertain), NaN where there is no value. At a dead centre, where
            a table over travel changes to its values for the way back, the bound is as large as that change.

        Raises
        ------
        QuantityError
            The quantity is unknown; the message lists those of the mechanism.
        NotGivenError
            A group, load or cam does more than recorded arithmetic, so its rounding is unknown.

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

        The uncertainty is of first order in the inputs, by exact derivatives (JCGM 100:2008, *Guide to the expression
        of uncertainty in measurement*, section 5.1). `tolerances` handles spreads of any size and distribution. Near
        limit positions and toggles, which move with the inputs, first order is inaccurate; a warning gives the angle.

        Parameters
        ----------
        quantity : str
            As for `error_bound`.
        inputs : mapping of path to float
            Standard uncertainties, SI, of numbers of the scene by path, as in case files: ``{"crank_length": 1e-5}``.

        Returns
        -------
        Uncertainty
            With `tolerance`, `rounding` and their sum, `total`, each in the shape of the quantity. NumPy functions use
            `total`. ``print`` shows the largest values over the crank angles.

        Raises
        ------
        QuantityError, NotGivenError
            As for `error_bound`; derivatives also need recorded arithmetic.
        ParameterError
            A path is unknown, or an uncertainty is negative or not finite.

        Warns
        -----
        ConditionWarning
            At some crank angle the second order of the inputs (products included) exceeds 0.1 of the first order, and
            0.001 of the median of the first order. Or the quantity has no value with one or two inputs changed by their
            uncertainty.

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
        """The uncertainty, and a `Doubt` if the uncertainty is too small, else None."""
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
            doubt = Doubt(name, "and may be larger", f"with changed inputs, {why}")
        return found, doubt

    def _values_and_bound(self, quantity, tight=False):
        """Values of a quantity (components of a vector), and a bound on the rounding of it or of its magnitude."""
        name = quantities.without_bars(self, quantity)
        values, bounds = (found[name] for found in self.engine.with_bounds(self.dynamics, (name,), tight))
        if name == quantity:
            return values, read_only(where_known(values, bounds))[()]
        return values, read_only(where_known(np.hypot(*values), of_magnitude(values, bounds)))[()]


def _magnitude_slope(vector, slope):
    """Derivative of a vector's magnitude from the vector's derivative, whose magnitude it is where the vector is 0."""
    (x, y), size = vector, np.hypot(*vector)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(size > 0.0, (x * slope[0] + y * slope[1]) / size, np.hypot(*slope))[()]

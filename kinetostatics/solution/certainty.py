"""How sure each value of a solution is: proven bounds on rounding, and what uncertain inputs do."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..engines.error_bounds import of_magnitude, where_known
from ..engines.jax_backend import Backend
from ..engines.program import program_of
from ..errors import ConditionWarning, ParameterError
from ..mechanics import quantities
from ..numbers import checks
from ..numbers.arithmetic import read_only
from . import second_order
from .parameters import Parameters, fixed, keeping, leaves_of, require_free, unknown
from .slopes import slopes


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Uncertainty of a quantity at each crank angle, all in the unit and shape of the quantity.

    Attributes
    ----------
    inputs : dict of path to array
        What the standard uncertainty of each input alone makes.
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
        """Tolerance and, as a bound is no standard deviation, rounding added to it."""
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

        No value of a certified computation in exact arithmetic differs from the solution's by more. Exact are the
        numbers given to constructors, as floats, and the crank angles; what is derived from them, directions of guides
        and gravity among it, is bounded. A guide through two points counts as rounded once.

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
            travel has another value on the way back, as large as the step: which side of it holds is not known.

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
        name = quantities.without_bars(self, quantity)
        values, bounds = self._with_bounds(name, tight)
        return _rounding(values, bounds, name != quantity)

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
            is an array of its `total`. Printed, it tells the largest over the crank angles.

        Raises
        ------
        QuantityError, NotGivenError
            As for `error_bound`; derivatives too are of recorded arithmetic alone.
        ParameterError
            There is no such number, or an uncertainty is negative or not finite.

        Warns
        -----
        ConditionWarning
            At some crank angle what the second order of the inputs makes, products of two among it, is more than a
            tenth of the first and more than a thousandth of the first's median, or there is no value with an input
            larger or smaller by its uncertainty, or with two larger.

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
            warnings.warn(f"{self.mechanism.name}: {second_order.told([doubt])}", ConditionWarning, stacklevel=2)
        return found

    def with_doubt(self, quantity, inputs):
        """The same, and the `second_order.Doubt` that it says too little, or None."""
        named = isinstance(inputs, Mapping) and all(isinstance(path, str) for path in inputs)
        checks.require("uncertainty", None if named else f"inputs must map paths to numbers, got {inputs!r}")
        checks.require("uncertainty", *(unknown(self, path) for path in inputs if path not in self.places))
        require_free("uncertainty", self.mechanism, inputs, fixed(self.places, self.mechanism))
        given = {path: (value, self.places[path].rule.unit, {"low": 0.0}) for path, value in inputs.items()}
        inputs = checks.singles("uncertainty", **given)
        checks.require("uncertainty", checks.quantity(quantity))
        name = quantities.without_bars(self, quantity)
        values, bounds = self._with_bounds(name)
        rounding = _rounding(values, bounds, name != quantity)
        found, doubt = self._slopes(name, inputs, values, rounding) if inputs else ({}, None)
        if name != quantity:
            vector = quantities.components(self, name)
            found = {path: _of_magnitude(vector, slope) for path, slope in found.items()}
        parts = {path: np.abs(slope) * inputs[path] for path, slope in found.items()}
        return Uncertainty(parts, rounding, quantities.unit_of(self, name)), doubt

    def _slopes(self, name, inputs, values, rounding):
        """Derivatives of a quantity by numbers of the scene, by path; and a doubt where they change with the inputs."""
        state = keeping(self, self.places, inputs).dynamics
        program, leaves = program_of(state, (name,))
        known = leaves_of(self.places, state)
        by = {path: known[path] for path in inputs}
        backend = Backend("compiled" if self.engine.compiled else "numpy")
        found = slopes(program, by, state, leaves, backend)[name]
        first = {path: np.reshape(found[path] * inputs[path], (-1, *self.shape)) for path in by}
        values, rounding = (np.reshape(part, (-1, *self.shape)) for part in (values, rounding))
        try:
            terms = second_order.Terms(lambda leaves: backend.run(program, state, leaves), values, leaves, by, inputs)
            beyond = second_order.found(terms, len(by), self.crank_angle, first, rounding)
            doubt = None if beyond is None else beyond.doubt(name, quantities.unit_of(self, name), inputs)
        except ParameterError as why:  # a slider beyond its table, for one
            doubt = second_order.Doubt(name, "and may be more", f"with them moved, {why}")
        return found, doubt

    def _with_bounds(self, name, tight=False):
        """Values of a quantity, and bounds on their errors."""
        return [found[name] for found in self.engine.with_bounds(self.dynamics, (name,), tight)]


def _rounding(values, bounds, of_its_magnitude):
    """Bound on the error of a quantity, or of the magnitude of a vector."""
    if of_its_magnitude:
        values, bounds = np.hypot(*values), of_magnitude(values, bounds)
    return read_only(where_known(values, bounds))[()]


def _of_magnitude(vector, slope):
    """Derivative of the magnitude of a vector from that of the vector; of one that vanishes the magnitude of that."""
    (x, y), size = vector, np.hypot(*vector)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(size > 0.0, (x * slope[0] + y * slope[1]) / size, np.hypot(*slope))[()]

"""Interval enclosures: the library's own kernels on `arb` numbers, which contain the exact result.

(Johansson 2017, *Arb: efficient arbitrary-precision midpoint-radius interval arithmetic*.) The mechanism has the
doubles of the solution as exact numbers. A guide through two points is exact in its direction only: its unit vector
has length 1 to rounding.
"""

import importlib
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from ....errors import MissingLibraryError, NotGivenError
from ....machine.crank import ray
from ....machine.guide import Guide
from ....machine.loads import Load, ProcessForce, Table
from ....mechanics.dynamics import Dynamics
from ....mechanics.load_values import title_of, without_forces
from ....mechanics.quantities import components
from ....numbers.formatting import with_units
from ....numbers.parameter_tree import map_numbers, replace_unchecked

MIN_BITS, MAX_BITS = 128, 4096


@with_units()
@dataclass(frozen=True, eq=False)
class Enclosure:
    """Interval enclosures of a quantity at the crank angles of a solution.

    Attributes
    ----------
    middle : tuple of arrays (N,)
        Components of the quantity (see `quantities.components`) in its SI unit: midpoints of the enclosures, rounded to
        the nearest double.
    exact : tuple of arrays (N,) of `flint.arb`
        The unrounded midpoints, as arb numbers of radius 0; `mpmath.mpf` converts them.
    radius : float
        Largest radius of an enclosure, relative to the largest value.
    bits : int
        Working precision.
    agreement : float or None
        Largest difference from the independent path at the angles checked, relative to the largest value.

    Examples
    --------
    As `ks.precision.certified` and `enclosure` return it; needs the extra `precision`.

    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> found = ks.precision.enclosure(s, "balancing_torque")
    >>> found.radius < 1e-30, found.bits >= 128
    (True, True)
    """

    middle: tuple[Any, ...]
    exact: tuple[Any, ...]
    radius: float
    bits: int
    agreement: float | None = None

    @property
    def largest(self):
        """Largest magnitude over the crank angles."""
        return float(np.max(magnitude(self.middle)))


def require_one_design(solution):
    if np.ndim(solution.crank_angle) > 1 or solution.shape != np.shape(solution.crank_angle):
        raise NotGivenError(
            f"{solution.mechanism.name}: a certificate needs a single design, but this solution has shape "
            f"{solution.shape}"
        )


def enclosure(solution, quantity, digits=30) -> Enclosure:
    """Enclose a quantity by the library's own kernels on arb numbers; the bits double until `digits` are certain.

    Parameters
    ----------
    solution : Solution
        Solution of one design.
    quantity : str
        As for `quantities.components`.
    digits : int
        The radius is at most 10^-digits of the largest value.

    Returns
    -------
    Enclosure

    Raises
    ------
    NotGivenError
        A load or cam is computed in double precision only, or a crank angle is at or beyond a limit position.
    MissingLibraryError
        python-flint is not installed.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> (exact,) = ks.precision.enclosure(s, "balancing_torque").exact  # arb numbers
    >>> round(abs(float(exact[1] - float(s.balancing_torque[1]))), 9)  # N m
    0.0
    """
    flint = require_library("flint")
    require_one_design(solution)
    bits = MIN_BITS
    while True:
        with flint.ctx.workprec(bits):
            run = on_arb(flint.arb, solution)
            closing = _certainly_closes(run, solution)
            values = _evaluate_on_arb(quantity, lambda run=run: components(run, quantity))
            values = [np.frompyfunc(flint.arb, 1, 1)(part) for part in values]
            exact = tuple(np.frompyfunc(flint.arb.mid, 1, 1)(part) for part in values)
            middle = tuple(part.astype(float) for part in exact)
            radii = magnitude([np.frompyfunc(flint.arb.rad, 1, 1)(part).astype(float) for part in values])
        radii = np.where(closing & np.isfinite(magnitude(middle)), radii, np.inf)
        found = Enclosure(middle, exact, float(radii.max()), bits)
        if all(value.is_zero() for part in values for value in part):
            return found
        if found.largest and found.radius <= 10.0**-digits * found.largest:
            return replace(found, radius=found.radius / found.largest)
        if bits >= MAX_BITS:
            raise NotGivenError(
                f"{place_text(solution, int(np.argmax(radii)))}: no enclosure of {quantity} as narrow as 1e-{digits} "
                f"of its largest value, even with {bits} bits: it is at a limit position, or the quantity is zero "
                "throughout"
            )
        bits *= 2


def _certainly_closes(run, solution):
    """Whether all groups certainly close at each angle, (N,); an error if one certainly does not."""
    closing = np.ones(run.crank_angle.shape, dtype=bool)
    for group in run.mechanism.groups:
        margin = group.closure(run.placement)
        failing = np.flatnonzero(margin <= 0)
        if failing.size:
            raise NotGivenError(
                f"{place_text(solution, failing[0])}: {type(group).__name__} is at a limit position or does not close "
                f"(its closure margin is {margin[failing[0]].str(5)}), so no certificate exists"
            )
        closing &= margin > 0
    return closing


def on_arb(arb, solution) -> Dynamics:
    """The solution with arb numbers as parameters, and tables and functions of its loads evaluated."""
    angle = _to_arb(np.atleast_1d(np.asarray(solution.crank_angle, dtype=float)), arb)
    mechanism = _to_arb(solution.mechanism, arb)
    for cam in (group.cam for group in mechanism.groups if hasattr(group, "cam")):
        what = f"cam {type(cam).__name__}"
        for values in _evaluate_on_arb(what, partial(cam.polar, angle, ray(angle))):
            _require_exact(what, values, arb)
    speed, acceleration = _to_arb((solution.crank_speed, solution.crank_acceleration), arb)
    friction, sense = _to_arb((solution.friction, solution.sense), arb)
    idle = Dynamics(mechanism, angle, speed, acceleration, (), friction, sense)
    named = ((item, f"load {place}, {title_of(item)},") for place, item in enumerate(solution.loads, 1))
    return replace(idle, loads=tuple(_load_on_arb(arb, item, what, idle, solution) for item, what in named))


def _load_on_arb(arb, item, what, motion, solution):
    exact = _to_arb(item, arb)
    if not isinstance(item, Load):
        push = _evaluate_on_arb(what, lambda: exact.push(without_forces(motion)))
        _require_exact(what, push, arb)
        return ProcessForce(push, item.on)
    value = item.value_now
    if not callable(value):
        _require_exact(what, getattr(exact, item.VALUE, 0.0), arb)
        return exact
    if isinstance(value, Table):
        found = value.read(motion, [np.atleast_1d(part) for part in value.pieces(solution, partial(_to_arb, arb=arb))])
    else:
        found = _evaluate_on_arb(what, lambda: value(without_forces(motion)))
    _require_exact(what, found, arb)
    return replace_unchecked(exact, **{item.VALUE: found})


def _to_arb(item, arb):
    """The item with arb numbers as parameters; a guide through points keeps its exact direction."""

    def number(value):
        if isinstance(value, np.ndarray):
            return np.frompyfunc(lambda part: arb(float(part)), 1, 1)(value)
        return arb(value) if isinstance(value, int) else arb(float(value))

    def guide(own):
        offset = map_numbers(own.guide_offset, number)
        if own.exact is None:
            return replace_unchecked(own, angle=map_numbers(own.angle, number), guide_offset=offset)
        direction = own.direction
        if direction != (1.0, 0.0):
            x, y = (arb(float(part)) for part in direction)
            length = (x * x + y * y).sqrt()
            direction = x / length, y / length
        return replace_unchecked(own, angle=None, guide_offset=offset, exact=direction)

    return map_numbers(item, number, {Guide: guide})


def _evaluate_on_arb(what, compute):
    try:
        return compute()
    except (TypeError, ValueError) as error:
        raise NotGivenError(f"no certificate: {what} cannot be computed on arb numbers ({error})") from error


def _require_exact(what, values, arb):
    """Raise if values are neither enclosures nor a constant: then the angles were rounded to doubles."""
    if np.ndim(values) and not all(isinstance(value, arb) for value in np.ravel(values)):
        raise NotGivenError(f"no certificate: {what} is computed in double precision for numbers of any kind")


def magnitude(parts):
    return np.abs(parts[0]) if len(parts) == 1 else np.hypot(*parts)


def place_text(solution, index):
    angle = float(np.ravel(solution.crank_angle)[index])
    return f"{solution.mechanism.name} at crank angle {angle!r} rad ({np.degrees(angle):.9g} deg)"


def require_library(name):
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise MissingLibraryError(
            'the certified reference needs python-flint and mpmath: pip install "kinetostatics[precision]"'
        ) from error

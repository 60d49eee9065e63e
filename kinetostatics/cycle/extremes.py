"""Exact extrema of quantities over the period, refined between samples by evaluating the mechanism itself.

`extremes` returns those of one quantity, `extremes_frame` a table of the smallest and largest of all.
"""

import warnings
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from ..errors import ConditionWarning, NotGivenError, ParameterError
from ..mechanics import jamming, quantities
from ..mechanics.quantities import Quantity, components, largest_term, of_scene, unit_of, values
from ..numbers import checks
from ..numbers.arithmetic import UNIT_ROUNDOFF
from ..numbers.lazy import cached_property
from .limit_positions import MAX_WIDTH, require_single
from .load_functions import resolution_note, with_resolution
from .piecewise import signed_peak
from .rounding import FLOOR, PLACED, BoundedExtremes, extremes_text, without_rounding, zeroed
from .turning_points import extrema_of, paths

PROBE_PLACES = np.array([0.07, 0.23, 0.41, 0.66, 0.89])
"""Places in the period, relative to it, at which functions are compared with their values a period later."""
GROWTH_TOLERANCE = 1e-6
"""Growth in a period, relative to the largest value, above which a function does not repeat."""
MAX_ORDINARY_CONDITION = 1e6
"""Condition below which values have ordinary size and negligible rounding."""
TAIL_SHARE = 0.2
"""Size of the last coefficients of a series, relative to the rounding of the quantity, that counts as rounding."""
FUNCTION_STEP = np.radians(0.25)
"""Crank-angle step, rad, at which a user's function is compared with its series."""
MISSED = 1e-9
"""Least difference, relative to the largest value, that shows a pulse missed between the points of a piece."""
MIN_OPEN_WIDTH = 0.005
"""Width of a piece, rad, below which a partly finite piece is not halved."""
SHOWN = ("smallest", "smallest at [deg]", "largest", "largest at [deg]")


@dataclass(frozen=True, eq=False)
class Extremes:
    """Extrema of one quantity over the period of the solution, usually one turn, in order of crank angle.

    Attributes
    ----------
    quantity : str
    angle : array (K,)
        Crank angles in [0, period), rad.
    value : array (K,)
        Values of the quantity, SI. At a limit position or the end of a gap the limit of the quantity, infinite if it
        grows without bound.
    maximum : array (K,) of bool
        Whether each is a maximum.
    constant : float
        The value of a quantity that has no extremum because it does not change; NaN otherwise.
    left_out : array (L,)
        Crank angles around which no value has a correct digit, rad.
    solution : Solution or None
        None for a user's function.
    note : str
        Resolution of load functions without `kinks`; empty if none of them affects the quantity.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 0.0, crank_speed=33.5)
    >>> found = ks.extremes(s, "slider_velocity")
    >>> np.degrees(found.angle).round(3), found.value.round(4), found.maximum
    (array([ 81.651, 278.349]), array([-10.1625,  10.1625]), array([False,  True]))
    """

    quantity: str
    angle: np.ndarray
    value: np.ndarray
    maximum: np.ndarray
    constant: float = np.nan
    left_out: np.ndarray = field(default_factory=lambda: np.empty(0), repr=False)
    solution: Any = field(default=None, repr=False)
    note: str = ""

    @cached_property
    def error_bound(self):
        """Proven bound on the rounding error of each value at its angle, (K,).

        Raises
        ------
        NotGivenError
            As for `Solution.error_bound`, or the quantity is your own function.
        """
        if self.solution is None:
            raise NotGivenError("no bound can be given: the quantity is your own function")
        if not len(self):
            return np.empty(0)
        vector = quantities.quantity(self.solution, self.quantity).vector
        at = self.solution.at(self.angle)
        return at.error_bound(f"|{self.quantity}|" if vector else self.quantity)

    @property
    def range(self):
        """Smallest and largest value over the turn; both are the constant if it has no extremum."""
        return (float(self.value.min()), float(self.value.max())) if len(self) else (self.constant, self.constant)

    @property
    def largest(self):
        """Value of largest magnitude over the turn, with its sign; positive if both signs are as large to rounding."""
        return signed_peak(*self.range)

    def __len__(self):
        return len(self.angle)

    def __repr__(self):
        return extremes_text(self)


def extremes(solution, quantity):
    """All extrema of one quantity over the period of the solution: one turn, or several for a four-stroke load.

    The turn is split at the kinks of loads, friction and cam laws. On each piece the quantity is a Chebyshev series;
    pieces are halved until the series is exact to rounding. The zeros of its slope are evaluated by the mechanism
    itself. Load functions without `kinks` are first sampled at the `resolution` of the solution, a `quantity` that is a
    function every quarter of a degree. At a jump the extrema are the values on its two sides.

    Values with less than two correct digits, by `Solution.condition`, do not count; the limits of the quantity from
    each side replace them, also at the ends of gaps.

    Parameters
    ----------
    solution : Solution
        Of one design; its own crank angles do not matter.
    quantity : str or function
        A scalar attribute ("balancing_torque"), a joint (magnitude of its reaction), a vector attribute
        ("shaking_force": its magnitude), or a function of a solution that returns an array over its crank angles.

    Returns
    -------
    Extremes
        `.angle` and `.value` in order of angle; empty for a quantity that is constant to rounding.

    Raises
    ------
    QuantityError
        The solution does not have the quantity.
    ParameterError
        The solution is a batch of designs, or depends on a table over its own crank angles. Or a load function does not
        repeat after its period, or the quantity is a function that grows in each period.

    Warns
    -----
    ConditionWarning
        Around some crank angles no value has a correct digit, the quantity grows without bound, or friction jams.
    HintWarning
        A load function without `kinks` changes between its samples (`Scene.check_resolution`).

    Examples
    --------
    >>> import kinetostatics as ks
    >>> s = ks.solve(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 0.0, crank_speed=33.5)
    >>> ks.extremes(s, "balancing_torque").value.round(1)  # N m
    array([ 34479. , -28315.7,  28315.7, -34479. ])
    >>> print(f"{ks.extremes(s, 'O').largest:.1f} N")  # magnitude of the reaction
    232305.7 N
    """
    checks.require("extremes", checks.solution("solution", solution), checks.quantity(quantity, function=True))
    found = extrema(solution, quantity)
    if text := warning(solution, [found]):
        warnings.warn(text, ConditionWarning, stacklevel=2)
    return found


def warning(solution, several):
    """Sentence of a `ConditionWarning` on the extremes of a solution, or None."""
    unbounded = [item for item in several if np.isinf(item.value).any()]
    left_out = np.unique(np.concatenate([item.left_out for item in several]))
    sentences = []
    jams = jamming.jammed_angles(solution.sampled.even) if solution.friction.acting else np.empty(0)
    if jams.size:
        ends = f"{_degrees(jams[:1])} ... {_degrees(jams[-1:])}"
        sentences.append(f"friction jams between {ends} deg (solution.friction_margin), values there do not count")
    if left_out.size:
        angles = _degrees(left_out)
        sentences.append(f"around crank angles {angles} deg no value has a correct digit, so none counts there")
    for item in unbounded:
        angle = np.unique(item.angle[np.isinf(item.value)])
        sentences.append(f"{item.quantity} grows without bound at {_degrees(angle)} deg")
    unknown = [item.quantity for item in several if not len(item) and np.isnan(item.constant)]
    if unknown:
        why = f": it {solution.sampled.unclosed}" if solution.sampled.gaps else " with a correct digit"
        sentences.append(f"{', '.join(unknown)} has no value{why}")
    return f"{solution.mechanism.name}: {'; '.join(sentences)} (solution.condition)" if sentences else None


def _degrees(angles):
    return ", ".join(f"{np.degrees(angle):.6g}" for angle in angles)


def extrema(solution, quantity, pulsed=True):
    """The extrema without a warning; those of named quantities are cached for all solutions of the same turn.

    A `quantity` that is a function may have its own pulses. With `pulsed` False all its kinks are those of friction and
    loads, and it is not sampled every quarter of a degree.
    """
    require_single(solution, "extremes", quantity)
    grows = callable(quantity) or solution.mechanism.grows(quantity)
    turn = solution.sampled_for_forces if grows else solution.sampled
    note = resolution_note(solution, quantity)
    if callable(quantity):
        return replace(_extrema(solution, turn, quantity, pulsed), note=note)
    if quantity not in turn.extrema:
        turn.extrema[quantity] = _extrema(solution, turn, quantity)
    found = turn.extrema[quantity]
    arrays = {name: getattr(found, name).copy() for name in ("angle", "value", "maximum", "left_out")}
    return replace(found, solution=solution, note=note, **arrays)


def largest_of(found):
    """Largest value of `Extremes` and its crank angle, NaN for a constant."""
    if not len(found):
        return found.constant, np.nan
    place = int(np.argmax(found.value))
    return float(found.value[place]), float(found.angle[place])


def _extrema(solution, turn, quantity, pulsed=False):
    def function(at):
        return np.asarray(values(at, quantity))

    is_function = callable(quantity)
    position = unit_of(solution, quantity) == "m"
    name = quantity if isinstance(quantity, str) else "a function of the solution"
    left_out = np.empty(0) if position else turn.lost
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        samples = np.asarray(function(turn.at))
        if samples.shape != turn.angle.shape:
            raise ParameterError(
                f"extremes: {quantity!r} has shape {samples.shape}, not one value for each of {turn.angle.shape} crank "
                "angles"
            )
        if is_function:
            _require_repeating(turn, function, float(np.max(np.abs(samples), initial=0.0)))
        good = np.isfinite(samples) & (position | turn.usable)
        size, floor = _size_and_rounding(turn, quantity, samples, good, position)
        if not is_function and not turn.limits.size and np.ptp(samples) <= floor[0]:
            return _constant(name, samples[good], left_out)
        root_of_force = not is_function and of_scene(solution)[quantity].kind == "contact"
        scale = 2.0 * size if root_of_force else 1.0
        pieces, known, rough, rounding = _resolved(turn, quantity, good, floor, scale, pulsed)
        cuts = turn.limits[~good[np.searchsorted(turn.angle, turn.limits)]]
        found = paths(turn, pieces, known, rough, function, rounding, size, cuts, scale)
        angle, value, maximum = extrema_of(turn, function, found, size)
    if not angle.size:
        return _constant(name, samples[good], left_out)
    return Extremes(name, angle, value, maximum, np.nan, left_out)


def _constant(name, values, left_out):
    empty = np.empty(0)
    return Extremes(name, empty, empty, empty.astype(bool), float(np.max(values)) if values.size else np.nan, left_out)


def _resolved(turn, quantity, good, floor, scale, pulsed):
    """Resolved pieces of a quantity, its values (NaN without correct digits), a mask of rough pieces, and its rounding.

    Values (1 or 2, pieces, points + 2) are the quantity or its components; with a `scale` its square, whose rounding
    is `scale` times as large.
    """

    def function(at):
        found = (quantity(at),) if callable(quantity) else components(at, quantity)
        return np.square(found) if scale != 1.0 else np.array(found)

    def rounding(pieces):
        if not turn.limits.size:
            return np.full(len(pieces.half), floor[0])
        return np.interp(pieces.check_angles, turn.angle, np.where(np.isfinite(floor), floor, np.inf)).max(axis=1)

    def steep(pieces, values):
        """Error of steep values, as on the flank of a step, from the rounding of crank angles."""
        rise = np.nan_to_num(np.ptp(values[..., 1:-1], axis=-1)).max(axis=0)
        return rise / (2.0 * pieces.half[:, 0]) * np.spacing(turn.period)

    def unresolved(pieces, errors, values):
        finite = np.isfinite(values[0, :, 1:-1])
        open_part = finite.any(axis=1) & ~finite.all(axis=1) & (2.0 * pieces.half[:, 0] > MIN_OPEN_WIDTH)
        with np.errstate(invalid="ignore"):
            floors = TAIL_SHARE * scale * rounding(pieces) + steep(pieces, values)
            return (errors > floors).any(axis=0) | open_part | (missed(pieces, values) if pulsed else False)

    def missed(pieces, values):
        """Whether the function differs from its series between the points of a piece."""
        asked = 2.0 * pieces.half[:, 0] > FUNCTION_STEP * pieces.count
        asked &= np.isfinite(values[0, :, 1:-1]).all(axis=1)
        if asked.any():
            places = np.linspace(-1.0, 1.0, 2 + int(MAX_WIDTH / FUNCTION_STEP))[1:-1]
            middle = 0.5 * (pieces.edges[:-1] + pieces.edges[1:])[asked]
            angle = middle[:, None] + pieces.half[asked] * places
            misfit = np.abs(evaluate(angle)[0] - pieces.evaluate(pieces.series(values[0, :, 1:-1]), angle))
            asked[asked] = ~(misfit <= MISSED * np.nanmax(np.abs(values))).all(axis=1)
        return asked

    def evaluate(angle, _=None):
        return turn.evaluate(function, angle.ravel()).reshape(-1, *angle.shape)

    first = np.where(good, function(turn.at), np.nan)[:, turn.points]
    pieces, known, rough = turn.pieces.resolved(first, evaluate, unresolved)
    return pieces, known, rough, rounding(pieces) + 2.0 * steep(pieces, known) / scale


def _require_repeating(turn, function, size):
    """Refuse a function that grows by the same amount in each period, as the angle of a link that makes full turns."""
    first, second = (
        np.asarray(function(turn.at.moved_to(turn.period * (PROBE_PLACES + turns)))) for turns in (0.0, 1.0)
    )
    growth = float(np.mean(second - first))
    if abs(growth) > GROWTH_TOLERANCE * size and np.all(
        np.abs(second - first - growth) < GROWTH_TOLERANCE * abs(growth)
    ):
        raise ParameterError(
            f"extremes: the function of the solution grows by {growth:.6g} in each period of {turn.period:.6g} rad. "
            "It has no extremes, like the angle of a link that makes full turns; use a periodic function"
        )


def _size_and_rounding(turn, quantity, samples, good, position):
    """Largest value of a quantity excluding its growth at limit positions, and its rounding at each sample."""
    calm = good & (turn.condition < MAX_ORDINARY_CONDITION)
    calm = calm if calm.any() else good
    size = float(np.max(np.abs(samples[calm]), initial=0.0))
    terms = largest_term(turn.at if calm.all() else turn.at.moved_to(turn.angle[calm]), quantity) if calm.any() else 0.0
    floor = np.full(samples.shape, FLOOR * max(terms, size))
    if calm.all():
        return size, floor
    condition = np.sqrt(np.minimum(turn.condition, 1 / UNIT_ROUNDOFF)) if position else turn.condition
    return size, np.fmax(floor, UNIT_ROUNDOFF * condition * np.maximum(np.abs(samples), size))


class ExtremesRow(NamedTuple):
    """Extremes of a quantity as a row of a table.

    Attributes
    ----------
    quantity : Quantity
    ends : tuple of float
        As `SHOWN` names them.
    errors : tuple of float
        Bounds on the errors of `ends`; NaN where nothing is proven, and for crank angles.
    """

    quantity: Quantity
    ends: tuple[float, ...]
    errors: tuple[float, ...]

    def in_units(self, units):
        """The row in `OutputUnits`; crank angles stay in degrees."""
        factor, unit = units.of(self.quantity.unit)
        ends, errors = ((low * factor, at, high * factor, to) for low, at, high, to in self[1:])
        return ExtremesRow(self.quantity._replace(unit=unit), ends, errors)


def extremes_frame(solution):
    """Smallest and largest true extremum of every quantity over the period, with its crank angle, a pandas DataFrame.

    Energies are left out, and so are forces on the frame, which `Solution.ground` tabulates.

    Values within their proven rounding error, or small relative to the largest term of their kind, are 0; angles within
    `PLACED` of 0 are 0. ``attrs["resolution"]`` is the resolution of load functions without `kinks`, if there are any.

    Warns
    -----
    ConditionWarning
        Once for all quantities: around some crank angles values have no correct digit, or grow without bound.
    """
    return with_resolution(frames(extremes_by_name(solution))[0], solution)


def frames(rows):
    """Two tables of the rows of `extremes_by_name`: the values, and bounds on their errors."""
    import pandas as pd

    tables = zip(*((row.ends, row.errors) for row in rows.values()), strict=True)
    heads = [(row.quantity.label, row.quantity.unit) for row in rows.values()]
    columns = ["quantity", "unit", *SHOWN]
    lines = ([(*head, *numbers) for head, numbers in zip(heads, table, strict=True)] for table in tables)
    return tuple(pd.DataFrame(table, columns=columns).set_index("quantity") for table in lines)


def extremes_by_name(solution):
    """`ExtremesRow` of every quantity by its name; as for `extremes_frame`."""
    quantities_of = of_scene(solution)
    found = {
        name: extrema(solution, name)
        for name, quantity in quantities_of.items()
        if quantity.kind not in ("check", "energy", "ground")
        and not (quantity.kind == "rate" and solution.placement.links[quantity.owner].ratio_slope is None)
    }
    if text := warning(solution, found.values()):
        warnings.warn(text, ConditionWarning, stacklevel=3)
    bounded = BoundedExtremes(solution, found)
    return {name: extremes_row(bounded, name) for name in found}


def extremes_row(bounded, name):
    """`ExtremesRow` of a quantity of `BoundedExtremes`: 0 where an end is rounding."""
    solution = bounded.solution
    ends, angles, errors = zip(*(bounded.end(name, find) for find in (np.argmin, np.argmax)), strict=True)
    ends = without_rounding(solution, name, ends, errors)
    degrees = np.degrees(zeroed(angles, PLACED))
    numbers = tuple(float(item) for end in zip(ends, degrees, strict=True) for item in end)
    return ExtremesRow(of_scene(solution)[name], numbers, (errors[0], np.nan, errors[1], np.nan))

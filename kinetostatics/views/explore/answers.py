"""Numbers behind the curves of a scene: extremes, means, ratios, sensitivities, tolerance bands, speed of its motor.

The table comes row by row, so that a server can answer a drag between two rows.
"""

from collections.abc import Callable, Iterator
from functools import cache
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np

from ...cycle.comparison import EXTREMUM, Comparison, ratio
from ...cycle.extremes import ExtremesRow, extrema, extremes_row, warning
from ...cycle.means import mean_absolute_torque
from ...cycle.rounding import MAX_LISTED, BoundedExtremes
from ...design.constraints import parse_output
from ...design.optimisation import ANGLES
from ...design.problem import Problem
from ...drive.steady_running import steady
from ...errors import DesignError, KinetostaticsError, ParameterError
from ...mechanics.quantities import of_scene
from ...numbers.formatting import angle, digits_of, number, pretty_unit
from ...numbers.spreads import parse_spread
from ...numbers.units import factor
from ...solution.certainty import doubt_text
from ...solution.parameters import paths_without_derivative
from ..canvas import display_unit
from .fields import shown_unit

COUNT = 360
"""Crank angles of a solution for extremes and means, which do not depend on them, and of a band by default."""
SHARE_DIGITS = 3
"""Digits of a sensitivity."""
INFINITY = "∞"
COVERAGE = 2.0
"""Half width of a tolerance band in standard uncertainties: about 95 % of machines, each value normal."""
MEANS: dict[str, tuple[str, Callable]] = {
    "mean |balancing torque|": ("N m", mean_absolute_torque),
    "mean balancing torque": ("N m", attrgetter("mean_torque")),
    "mean drive power": ("W", attrgetter("mean_power")),
    "energy per turn": ("J", attrgetter("energy_per_turn")),
}
"""Unit of each mean over the period, and its function of a solution."""


class QuantityRow(NamedTuple):
    """Extremes of a quantity over the period, SI, and the ratio of its largest magnitudes.

    `reference` is the largest magnitude in the reference, `ratio` that over the largest magnitude here, as of
    `ks.compare`; NaN without a reference. `notes` are the sentences of warnings.
    """

    name: str
    extremes: ExtremesRow
    reference: float = np.nan
    ratio: float = np.nan
    notes: tuple[str, ...] = ()

    @property
    def range(self):
        """Largest less smallest value."""
        smallest, _, largest, _ = self.extremes.ends
        return largest - smallest


class FigureRow(NamedTuple):
    """A figure of the whole period, SI, beside that of the reference; `ratio` is reference / value, as of `ks.compare`.

    `problem` is the reason if there is no value.
    """

    label: str
    unit: str
    value: float
    reference: float = np.nan
    ratio: float = np.nan
    problem: str = ""


class Reference:
    """Solution of a reference, with its extremes and means, each computed once."""

    def __init__(self, solution):
        self.solution = solution
        self.ends = cache(lambda name: _ends(solution, name))
        self.mean = cache(lambda label: _mean(label, solution))


def quantity_rows(solution, names, reference=None) -> Iterator[QuantityRow]:
    """Rows of the extremes of quantities, one a step; `reference` is a `Reference` or None."""
    for name in names:
        row, own = _ends(solution, name)
        notes = [warning(solution, [own])]
        if reference is None or name not in of_scene(reference.solution):
            yield QuantityRow(name, row, notes=tuple(filter(None, notes)))
            continue
        other, found = reference.ends(name)
        notes.append(warning(reference.solution, [found]))
        peaks = [max(map(abs, item.ends[::2])) for item in (other, row)]
        yield QuantityRow(name, row, peaks[0], ratio(*peaks), tuple(filter(None, notes)))


def _ends(solution, name):
    found = extrema(solution, name)
    return extremes_row(BoundedExtremes(solution, {name: found}), name), found


def figure_rows(solution, reference=None) -> Iterator[FigureRow]:
    """Rows of the means over the period, one a step, then with a reference those of matching torque extrema.

    The extrema are left out if they are many, as under a measured load.
    """
    for label, (unit, _) in MEANS.items():
        value, problem = _mean(label, solution)
        other, _ = (np.nan, "") if reference is None else reference.mean(label)
        yield FigureRow(label, unit, value, other, ratio(other, value), problem)
    if reference is None:
        return
    found = Comparison(reference.solution, solution)
    plain, matched = found.torque_extremes
    if plain.value.size <= MAX_LISTED:
        rows = zip(plain.value, matched, found.torque_extremum_ratios, strict=True)
        for number, (other, value, share) in enumerate(rows, 1):
            yield FigureRow(f"{EXTREMUM} {number}", "N m", float(value), float(other), float(share))


def _mean(label, solution):
    """Mean of a solution, or NaN and the reason."""
    _, mean = MEANS[label]
    try:
        return float(mean(solution)), ""
    except KinetostaticsError as error:
        return np.nan, str(error)


class Sensitivity(NamedTuple):
    """Derivative `slope` of an output by the number at a path, in the unit of the output over that of the number.

    `share` is the change of the output in percent for one percent of the number; NaN where either is zero.
    """

    path: str
    slope: float
    share: float


class Sensitivities(NamedTuple):
    """Value of an output of a scene, its unit, and its `Sensitivity` by every number, the largest share first."""

    value: float
    unit: str
    rows: tuple[Sensitivity, ...]


def sensitivities(scene, text) -> Sensitivities:
    """Exact derivatives of an output by every number of a scene, also those that are zero.

    `text` names the output as for `ks.design.optimise`: "largest O", "mean_absolute balancing_torque".
    `KinetostaticsError` if the output is unknown or has no finite value, or if its quantity grows without bound or has
    no correct digit somewhere. A load of the user's own must do nothing but recorded arithmetic.
    """
    output: Any = parse_output(text, scene)
    solution = scene.solve(COUNT)
    if text := warning(solution, [extrema(solution, output.quantity)]):
        raise DesignError(f"{output} has no derivatives. {text}")
    fixed = paths_without_derivative(scene.places, scene.mechanism)
    own = {path: value for path, value in scene.parameters.items() if isinstance(value, float) and path not in fixed}
    bounds = {path: (value - abs(value) - 1.0, value + abs(value) + 1.0) for path, value in own.items()}
    problem = Problem(scene, bounds, (output.quantity,), angles=ANGLES)
    value, slopes = problem.output(output, problem.start)
    if not np.isfinite(value):
        raise DesignError(f"{output} has no finite value")
    rows = [
        Sensitivity(path, float(slope), float(slope * own[path] / value) if own[path] and value else np.nan)
        for path, slope in zip(own, slopes, strict=True)
    ]
    rows.sort(key=lambda row: (np.isnan(row.share), -np.nan_to_num(abs(row.share))))
    return Sensitivities(float(value), output.unit, tuple(rows))


class Band(NamedTuple):
    """Tolerance band of a curve, SI: `low` and `high` at each crank angle (N,), `note` where first order is too low."""

    name: str
    low: np.ndarray
    high: np.ndarray
    note: str = ""


def bands(solution, names, uncertainties) -> Iterator[Band]:
    """First-order bands of `COVERAGE` standard uncertainties, SI by path, around curves, one a step.

    The band of a vector is that of its magnitude. `KinetostaticsError` as of `Solution.uncertainty`.
    """
    for name in names:
        vector = of_scene(solution)[name].vector
        drawn = f"|{name}|" if vector else name
        (found, doubt), values = solution.with_doubt(drawn, uncertainties), solution[drawn]
        reach = COVERAGE * found.tolerance
        low = np.maximum(values - reach, 0.0) if vector else values - reach
        yield Band(name, low, values + reach, "" if doubt is None else doubt_text([doubt]))


def standard_uncertainties(spreads, scene):
    """Standard deviations, SI, of spreads such as [tolerances] of a case file, by those paths that the scene has."""
    found = {}
    for path, text in spreads.items():
        if path in scene.units:
            spread = parse_spread(text)
            found[path] = spread.deviation * factor(spread.unit, scene.units[path])
    return found


# Messages of these, with numbers as texts: no digit is shown that is uncertain


def ask(session, request):
    """Rows of the table of a state, one a step: extremes of the quantities to show, then figures of the period."""
    solution = session.scene(request["state"]).solve(COUNT)
    reference = None if request.get("reference") is None else session.reference(request["reference"])
    names = [name for name in request.get("show", ()) if name in of_scene(solution)]
    for row in quantity_rows(solution, names, reference):
        yield {"extremes": _quantity_texts(row)}
    largest = max(map(abs, extrema(solution, "balancing_torque").range))
    for figure in figure_rows(solution, reference):
        yield {"figure": _figure_texts(figure, largest)}


def _quantity_texts(row):
    quantity, ends, errors = row.extremes
    smallest, smallest_at, largest, largest_at = ends
    scale, unit = display_unit(quantity.unit, [[smallest, largest]])
    low, high = (number(scale * ends[place], bound=scale * errors[place], infinity=INFINITY) for place in (0, 2))
    at = [angle(degrees) for degrees in (smallest_at, largest_at)]
    rest = [number(scale * value, infinity=INFINITY) for value in (row.range, row.reference)]
    texts = dict(zip(("smallest", "smallest_at", "largest", "largest_at"), (low, at[0], high, at[1]), strict=True))
    texts |= {"range": rest[0], "reference": rest[1], "ratio": _ratio_text(row.ratio)}
    label = f"|{quantity.label}|" if quantity.vector else quantity.label
    return {"name": row.name, "label": label, "unit": pretty_unit(unit), "notes": row.notes} | texts


def _figure_texts(row, torque):
    """Texts of a figure; all torques have the unit for the largest `torque`."""
    scale, unit = display_unit(row.unit, [[torque] if row.unit == "N m" else [row.value, row.reference]])
    value, reference = (number(scale * item, infinity=INFINITY) for item in (row.value, row.reference))
    texts = {"value": value, "reference": reference, "ratio": _ratio_text(row.ratio)}
    return {"label": row.label, "unit": pretty_unit(unit), "problem": row.problem} | texts


def _ratio_text(value):
    return number(value, digits_of("", "ratio"), infinity=INFINITY)


def ask_sensitivities(session, request):
    """Sensitivities of an output of a state: shares in percent per percent, and slopes as texts in shown units."""
    scene = session.scene(request["state"])
    found = sensitivities(scene, request["output"])
    scale, unit = display_unit(found.unit, [[found.value]])
    rows = []
    for path, slope, share in found.rows:
        own, per = shown_unit(scene.units[path])
        units = f"{pretty_unit(unit) or '1'} per {pretty_unit(per) or '1'}"
        rows.append({"path": path, "share": share, "slope": f"{number(slope * scale / own, SHARE_DIGITS)} {units}"})
    yield {"value": number(scale * found.value), "unit": pretty_unit(unit), "rows": rows}


def ask_tolerances(session, request):
    """Uncertainties of a state, then a band for each quantity to show; by default those in [tolerances] of the case."""
    scene, given = session.scene(request["state"]), request.get("spreads")
    spreads = session.case.tolerances if session.case else {}
    given = standard_uncertainties(spreads, scene) if given is None else given
    yield {"spreads": given}
    solution = scene.solve(request.get("count", COUNT))
    names = [name for name in request.get("show", ()) if name in of_scene(solution)]
    for band in bands(solution, names, given) if given else ():
        yield {"band": band._asdict()}


# Speed of the motor over the crank angle, for a case with a drive


def motor_of(session, state):
    """Motor of a variant and its flywheel, kg m2; None and 0.0 without a drive."""
    variant = session.case.variants[state.get("variant", session.first)] if session.case else None
    return (None, 0.0) if variant is None or variant.motor is None else (variant.motor, variant.flywheel)


def running(session, request):
    """Steady running of a state, then of the reference."""
    for name in ("state", "reference"):
        if (state := request.get(name)) is not None:
            yield {"running": name} | motor_speed(session, state)


def motor_speed(session, state):
    """Speed of the motor in steady running, a curve as those of `look`, with its crank angles and period, degrees."""
    motor, flywheel = motor_of(session, state)
    if motor is None:
        raise ParameterError(f"explore: variant {state.get('variant', session.first)!r} has no drive")
    run = steady(session.scene(state), motor, flywheel, angles=COUNT)
    factor, unit = shown_unit("rad/s")
    shown = {"label": "motor speed", "unit": pretty_unit(unit), "factor": factor, "vector": False}
    return {
        "angle": np.degrees(run.crank_angle),
        "period": float(np.degrees(2.0 * np.pi * run.turns)),
        "quantities": {"motor speed": shown | {"values": np.array(run.motor_speed)}},
    }

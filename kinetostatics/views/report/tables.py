"""Tables of a report as text: values with units and significant digits, published figures in brackets.

`readings` gives every quantity at every selectable angle; the other functions give one table of the page each.
"""

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...casefile.case import sizing_table
from ...casefile.reading import require
from ...casefile.variant import run_under_motors
from ...cycle.comparison import Comparison, Row, left_out
from ...cycle.load_functions import resolution_note
from ...cycle.losses import lose
from ...cycle.means import mean_absolute_torque
from ...cycle.rounding import curve_values
from ...errors import KinetostaticsError, NotGivenError, ParameterError
from ...mechanics.quantities import of_scene, unit_of
from ...numbers import checks, formatting
from ...numbers.formatting import DIGITS, angle, digits_of, heading, parse_heading, pretty_unit, round_bound_up
from ...numbers.output_units import shown_units
from ..canvas import display_unit, drawn_limit, ordinary_size

number = partial(formatting.number, infinity="∞")
"""A number as text in all tables of the report."""


@dataclass(frozen=True)
class Table:
    """A table as text; a cell that is a pair has a smaller text below.

    `words` columns from the left have words, others numbers; with `code`, the first has names from files.
    """

    caption: str
    columns: list[str]
    rows: list[list[Any]]
    words: int = 1
    note: str = ""
    code: bool = False


def texts_of(frame):
    """A frame with its numbers as text; a column `unit` has the units of the rows."""
    texts = frame.astype(object)
    for column in frame:
        for name, value in frame[column].items():
            if column == "unit":
                texts.loc[name, column] = pretty_unit(value)
            elif str(column).endswith("[deg]"):
                texts.loc[name, column] = angle(value)
            else:
                texts.loc[name, column] = number(value, digits_of(str(name), str(column)))
    return texts


def table_of_frame(frame, caption, note=""):
    """Table of a frame with an index of row names; cells of text stay unchanged."""
    frame = shown_units().table(frame)
    columns = [_pretty_heading(str(name)) for name in frame.columns]
    rows = [[str(name), *cells] for name, *cells in texts_of(frame).itertuples()]
    return Table(caption, [frame.index.name or "", *columns], rows, 2 if columns[:1] == ["unit"] else 1, note)


def _pretty_heading(text):
    name, unit = parse_heading(text)
    return heading(name, pretty_unit(unit)) if pretty_unit(unit) else text


def _heading_in_units(text):
    name, unit = parse_heading(text)
    return _pretty_heading(heading(name, shown_units().of(unit)[1]) if unit else name)


def with_published(texts, published, path):
    """A frame of texts with published figures in brackets after ours; an error for those without a row or column."""
    problems = [checks.choice("published: row", quantity, tuple(texts.index)) for quantity in published]
    texts = texts.astype(object)
    for quantity, entries in published.items():
        for column, printed in entries.items() if quantity in texts.index else ():
            problem = checks.choice(f"published: column of {quantity!r}", column, tuple(texts.columns))
            if problem:
                problems.append(problem)
            else:
                texts.loc[quantity, column] += f" ({printed})"
    require(path, *problems)
    return texts


def special_tables(case):
    """Caption, frame and published figures of a case's tables of balancing and of linkages, by name; if it has any."""
    found = {
        "balancing": ("Counterweights and shaking force", case.balancing_table(), case.published.balancing),
        "linkage": ("Swing and transmission", case.linkage_table(), case.published.linkage),
    }
    return {name: item for name, item in found.items() if item[1] is not None}


class MergedRow(NamedTuple):
    """Row of comparisons: numbers of their reference, then of each other, and the ratios; NaN for those without it."""

    label: str
    unit: str
    numbers: list[float]
    bounds: list[float]
    ratios: list[float]
    bounds_of_ratios: list[float]


def merged_rows(comparisons, published=()):
    """Rows of comparisons with one reference, without torque extrema if they are many, and the number left out.

    A row follows its predecessor in its own table. Rows have the units of the report, but those with `published`
    values.
    """
    tables = [{row.label: row for row in comparison.rows} for comparison in comparisons]
    labels: list[str] = []
    for table in tables:
        place = 0
        for label in table:
            if label not in labels:
                labels.insert(place, label)
            place = labels.index(label) + 1
    found = []
    for label in labels:
        first = next(table[label] for table in tables if label in table)
        lacking = Row(label, first.unit, (np.nan, np.nan), np.nan)
        rows = [table.get(label, lacking) for table in tables]
        factor, unit = (1.0, first.unit) if label in published else shown_units().of(first.unit)
        numbers = [factor * value for value in (first.pair[0], *(row.pair[1] for row in rows))]
        bounds = [factor * bound for bound in (first.bounds[0], *(row.bounds[1] for row in rows))]
        ratios, bounds_of_ratios = [row.ratio for row in rows], [row.bound_of_ratio for row in rows]
        found.append(MergedRow(label, unit, numbers, bounds, ratios, bounds_of_ratios))
    more = left_out({row.label: row.numbers for row in found})
    return [row for row in found if row.label not in more], len(more)


def ratio_text(ratio, bound=0.0):
    """A ratio as text, "3.2 ×"; "" for NaN."""
    return "" if np.isnan(ratio) else f"{number(ratio, 4, bound)} ×"


READING_DIGITS = 6
"""Largest number of digits shown of the largest value."""
KINDS = ("force", "reaction", "friction", "slider", "motion", "whole", "ground", "rate")
"""Kinds of quantities in the order of the page."""


def readings(machines):
    """Values of each quantity of any machine, as data for the page, in the order of their kinds."""
    quantities: dict[str, Any] = {}
    for machine in machines.values():
        for name, quantity in of_scene(machine.solution).items():
            if quantity.kind in KINDS and not _is_still(machine.solution, quantity):
                quantities.setdefault(name, quantity)
    found = {}
    texts: dict[str, Any] = {}  # machines of several kinds name several bodies
    for machine in machines.values():
        for name, output in machine.scene.mechanism.outputs.items():
            texts.setdefault(name, {})[output.text] = None
    for name, quantity in sorted(quantities.items(), key=lambda item: KINDS.index(item[1].kind)):
        values = [_values(machine, machine.solution, name) for machine in machines.values()]
        between = [_values(machine, machine.between, name) for machine in machines.values()]
        sizes = [np.hypot(*item) if quantity.vector else item for item in values if item is not None]
        factor, unit = display_unit(quantity.unit, sizes)
        sight = drawn_limit(sizes)
        found[name] = {
            "label": quantity.label,
            "kind": quantity.kind,
            "text": "; ".join(texts.get(name, ())),
            "unit": pretty_unit(unit),
            "factor": factor,
            "vector": quantity.vector,
            "sight": factor * sight if np.isfinite(sight) else None,
            "decimals": decimals(factor * ordinary_size(sizes)),
            "values": [item if item is None else factor * item for item in values],
            "between": [item if item is None else factor * item for item in between],
        }
    return found


def _is_still(solution, quantity):
    return quantity.kind == "rate" and solution.placement.links[quantity.owner].ratio is None


def _values(machine, solution, name):
    """Values over the angles of a solution, (1 or 2, N), or None if the machine lacks the quantity."""
    if name not in of_scene(solution) or _is_still(machine.solution, of_scene(solution)[name]):
        return None
    return curve_values(solution, of_scene(solution)[name], machine.solution)


def decimals(largest):
    """Decimals that give a value of this size `READING_DIGITS` digits."""
    if not largest > 0:
        return 0
    return min(12, max(0, READING_DIGITS - 1 - math.floor(math.log10(largest))))


DOUBLE_DIGITS = 15.95
"""Significant digits of a double."""
OUTLIER_RATIO = 1e4
"""Ratio to the median rounding-error bound above which a bound is listed separately, with its angle."""
ZERO_NOTE = (
    "Numbers that are not listed are zero, but motor, flywheel and tables of values, which stand in the case file."
)


def glance(subject):
    """Overview table: torque, ratio to the reference, support reaction and power balance of each machine."""
    rows: list[list[str]] = []
    torque, power = (shown_units().of(unit)[0] for unit in ("N m", "W"))
    means = {name: float(mean_absolute_torque(solution)) for name, solution in subject.solutions.items()}
    works = [solution.energy_per_turn for solution in subject.solutions.values()]
    for name, machine in subject.machines.items():
        solution, mean = machine.solution, means[name]
        reference = subject.reference_of(name)
        base = means[reference.name]
        joint = "O" if "O" in solution.reactions else solution.reactions[-1]
        peak, reaction = (_largest(machine.extremes[name]) for name in ("balancing_torque", joint))
        gain = "" if machine is reference else ratio_text(base / mean) if mean > 1e-12 * base else "∞"
        drive = (torque * solution.mean_torque, power * solution.mean_power)
        cells = [machine.name, machine.scene.mechanism.name, number(torque * mean, 5), gain]
        cells += [number(part, 5) if any(works) else "" for part in drive]
        lost = number(power * solution.losses.total, 5) if lose(solution) else ""
        rows.append([*cells, peak, reaction, lost, number(solution.power_residual, 2)])
    heads = ["machine", "kind", "mean |torque| [N m]", "ratio of means", "mean torque [N m]", "mean power [W]"]
    heads += ["largest |torque| [N m]", "largest reaction O [N]", "power lost [W]"]
    heads = [*map(_heading_in_units, heads), "power balance"]
    references = " or ".join(subject.comparisons)
    ratio = f" Ratio of means: that of {references} over that of the machine; above 1 the machine takes less."
    note = (
        f"Torque: torque of the drive on the crank, over one period.{ratio if references else ''} Power balance: "
        "difference of the torques by equilibrium and by powers, over the largest power that flows."
    )
    return _without_empty(Table("", heads, rows, 2, note))


def _largest(row):
    """Largest magnitude of a quantity over the turn, with its certain digits."""
    row = row.in_units(shown_units())
    low, _, high, _ = row.ends
    value, error = max((low, row.errors[0]), (high, row.errors[2]), key=lambda end: abs(end[0]))
    return number(abs(value), 5, error)


def _without_empty(table):
    """The table without empty columns."""
    kept = [place for place in range(len(table.columns)) if place < 1 or any(row[place] for row in table.rows)]
    columns, *rows = ([row[place] for place in kept] for row in (table.columns, *table.rows))
    return replace(table, columns=columns, rows=rows, words=sum(place < table.words for place in kept))


def comparisons(subject):
    """Tables of dynamic coefficients against each reference, and of a case's counterweights and linkage."""
    tables = [_coefficients(subject, subject.machines[name], others) for name, others in subject.comparisons.items()]
    case = subject.case
    if case is not None and set(case.variants) == set(subject.machines):
        for caption, frame, published in special_tables(case).values():
            texts = with_published(texts_of(frame), published, case.path)
            tables.append(
                _without_empty(table_of_frame(texts, caption, "Published figures in brackets." * bool(published)))
            )
    return tables


def _coefficients(subject, reference, others):
    """Table of machines with one reference: values, with the ratio of the reference to each below."""
    name, case = reference.name, subject.case
    of_study = case is not None and name == case.reference
    found = [Comparison(reference.solution, item.solution) for item in others]
    merged, omitted = merged_rows(found, case.published.value if of_study else ())
    published = case.published_of([row.label for row in merged]) if of_study else {}
    rows = []
    for label, unit, (first, *values), (bound, *bounds), *ratios in merged:
        cells = map(_value_and_ratio, values, bounds, *ratios)
        reference = number(first, digits_of(label), bound)
        rows.append([label, pretty_unit(unit), reference, *cells, published.get(label, "")])
    note = f"Below each value how many times larger that of {name} is: above 1, the machine has less than {name}."
    if omitted:
        note += f" {omitted} torque extrema between the smallest and the largest are left out."
    return _without_empty(Table("", ["", "unit", name, *(item.name for item in others), "published"], rows, 2, note))


def _value_and_ratio(value, bound, ratio, bound_of_ratio):
    """A machine's value and its ratio with certain digits; "0" if it is negligible beside the reference."""
    if np.isinf(ratio):
        return "0"
    if np.isnan(ratio) and abs(value) < 1e-12:
        return number(value, 2)
    return number(value, bound=bound), ratio_text(ratio, bound_of_ratio)


def extremes(subject):
    """Tables of the extremes of every quantity of each machine, with certain digits."""
    heads = ["", "unit", "smallest", "at [°]", "largest", "at [°]", "digits"]
    tables = []
    for machine in subject.machines.values():
        rows = []
        for name, row in machine.extremes.items():
            quantity, (low, low_at, high, high_at), (low_error, _, high_error, _) = row.in_units(shown_units())
            digits = _proven_digits((low, low_error), (high, high_error))
            if digits is None:
                digits = _digits(machine.solution, name, np.nan_to_num([low_at, high_at]))
            most = DIGITS if digits is None else digits
            smallest, largest = number(low, most, low_error), number(high, most, high_error)
            told = str(digits) if digits is not None and (low or high) else ""
            rows.append(
                [quantity.label, pretty_unit(quantity.unit), smallest, angle(low_at), largest, angle(high_at), told]
            )
        tables.append(Table(machine.name, heads, rows, 2, resolution_note(machine.scene)))
    return tables


def _proven_digits(*ends):
    """Significant digits that error bounds prove; None if a bound is unknown."""
    shares = [error / abs(value) for value, error in ends if value]
    if np.isnan(shares).any() or not np.isfinite([value for value, _ in ends]).all():
        return None
    with np.errstate(divide="ignore"):
        return int(np.clip(np.floor(-np.log10(max(shares, default=0.0))), 0, 15))


def _digits(solution, name, degrees):
    """Significant digits of a quantity's extremes by condition; None for positions, and without a condition."""
    if unit_of(solution, name) == "m":
        return None
    try:
        lost = np.max(solution.at(np.radians(degrees)).condition_of(name))
    except (NotGivenError, ParameterError):  # a load may be a table over the angles
        return None
    return 0 if np.isnan(lost) else int(np.clip(np.floor(DOUBLE_DIGITS - np.log10(lost)), 0, 15))


def certainty(subject):
    """Power check, condition and convergence of friction, a column for each machine."""
    columns = {machine.name: _certainty(machine.solution) for machine in subject.machines.values()}
    names = list(dict.fromkeys(name for column in columns.values() for name in column))
    rows = [[name, *(column.get(name, "") for column in columns.values())] for name in names]
    return Table("", ["", *columns], rows)


def _certainty(solution):
    found = {"power balance, relative to the largest power that flows": number(solution.power_residual, 2)}
    for name, label, unit in (("balancing_torque", "torque", "N m"), ("|O|", "reaction O", "N")):
        if name.strip("|") in solution.reactions or name in solution.scalars:
            factor, shown = shown_units().of(unit)
            title = f"rounding error of the {label}, proven bound [{pretty_unit(shown)}]"
            found[title] = _bound(solution, name, factor)
    try:
        condition = solution.condition
    except NotGivenError:
        return found
    worst = int(np.nanargmax(condition))
    lost = condition[worst]
    found["condition: lengths' relative errors are magnified up to"] = (
        f"{number(lost, 3)} at {number(np.degrees(solution.crank_angle[worst]))}°"
    )
    found["condition at the middle of all crank angles"] = number(float(np.nanmedian(condition)), 3)
    if solution.friction.acting:
        found["friction and reactions converged"] = "yes" if np.all(solution.converged) else "not everywhere"
        found["friction: change by one more pass, at most"] = number(float(np.nanmax(solution.friction_residual)), 2)
        found["friction: margin to jamming, least"] = number(float(np.nanmin(solution.friction_margin)), 4)
    return found


def _bound(solution, name, factor):
    """Largest rounding-error bound over the turn; below it notes on outliers and on angles without a bound."""
    try:
        bounds = factor * solution.error_bound(name)
    except NotGivenError:
        return "not given"
    proven = np.isfinite(bounds)
    if not proven.any():
        return "not proven"
    apart = proven & (bounds > OUTLIER_RATIO * np.median(bounds[proven]))  # at a jump, the bound covers both sides
    notes = []
    if apart.any():
        place = int(np.argmax(np.where(apart, bounds, -1.0)))
        where = f"{number(np.degrees(solution.crank_angle[place]))}°"
        others = "" if (count := np.count_nonzero(apart)) == 1 else f", the largest of {count} outliers"
        notes.append(f"but {round_bound_up(bounds[place])} at {where}, a jump or near a limit{others}")
    if not proven.all():
        notes.append(f"not proven at {np.count_nonzero(~proven)} of {proven.size} angles")
    text = round_bound_up(np.max(bounds[proven & ~apart]))
    return (text, "; ".join(notes)) if notes else text


def calculations(subject, row):
    """Hand calculation of each machine's torque as HTML, at the reference's angle with index `row`."""
    angle = subject.reference.solution.crank_angle[row]
    found = {}
    for name, machine in subject.machines.items():
        try:
            found[name] = machine.solution.explain("balancing_torque", angle)._repr_html_()
        except KinetostaticsError:  # a user's own load or group without formulas
            continue
    return found


SHARED = ("balancing_torque", "O")
"""Quantities with a table of shares."""


def shares(subject):
    """Shares of the peaks of torque and reaction O by source, for machines without friction that close all round."""
    tables = []
    for machine in subject.machines.values():
        for name in SHARED if not machine.solution.friction.acting else ():
            try:
                found = machine.solution.shares(name)
            except KinetostaticsError:  # no quantity of this name, no peak, or gaps
                continue
            tables.append(table_of_frame(found.frame(), f"{machine.name}: {found.label}", found.note))
    return tables


def parts(subject):
    """Tables of the parts of the case, with points to check."""
    if subject.case is None or not subject.case.sizing:
        return []
    found = sizing_table(subject.case.sizing, subject.solutions)
    shown = []
    for name, part in subject.case.sizing.items():
        own = shown_units().table(found.loc[name].rename_axis("number"))
        meanings = {number: f"{row.meaning}; {row.formula}" for number, row in part.rows.items()}
        own = texts_of(own).assign(formula=[meanings[number] for number in own.index])
        rows = [list(row) for row in own.itertuples()]
        notes = "; ".join(found.attrs["notes"][name])
        shown.append(Table(f"{name}: {part.kind}", ["number", *own.columns], rows, 2, notes))
    return shown


def losses(subject):
    """Tables of power lost by joint, for machines with friction."""
    lost = {machine.name: machine.solution.losses for machine in subject.machines.values() if lose(machine.solution)}
    return [
        table_of_frame(item.frame(), name, f"{str(item)[0].upper()}{str(item)[1:]}.") for name, item in lost.items()
    ]


def drive_tables(subject):
    """Periodic running by machine under the motor of the case, its tables, and reasons for failures."""
    from ...drive.savings import energy_table, running_table

    driven = {name: machine.variant for name, machine in subject.machines.items() if machine.motor is not None}
    runs, starts, told = run_under_motors(driven)
    reasons = [f"{name}: {text}" for name, texts in told.items() for text in texts]
    tables = []
    if runs:
        tables.append(table_of_frame(running_table(runs, starts), "Speed, power and start-up"))
        tables.append(table_of_frame(energy_table(runs), "Energy balance of a turn"))
    return runs, tables, reasons


def inputs(subject):
    """Tables of parameters: those common to all machines, and those that differ."""
    machines = list(subject.machines.values())
    paths = list(dict.fromkeys(path for machine in machines for path in machine.given))
    common, apart = [], []
    for path in paths:
        values = [machine.given.get(path, (None, ""))[0] for machine in machines]
        unit = next(machine.given[path][1] for machine in machines if path in machine.given)
        if not any(isinstance(value, str) or (value is not None and np.any(value)) for value in values):
            continue
        factor, shown = display_unit(unit, [np.zeros(1)])
        shown = pretty_unit(shown)
        cells = [_cell(value, factor) for value in values]
        if len(set(cells)) == 1:
            common.append([path, shown, cells[0]])
        else:
            apart.append([path, shown, *cells])
    tables = []
    if common:
        tables.append(Table("Common to all" if apart else "", ["", "unit", "value"], common, 2, ZERO_NOTE, code=True))
    if apart:
        heads = ["", "unit", *(machine.name for machine in machines)]
        tables.append(Table("Differences", heads, apart, 2, code=True))
    return tables


def _cell(value, factor):
    if value is None or isinstance(value, str):
        return value or ""
    several = np.ndim(value) > 0
    return ", ".join(number(factor * item, 10) for item in np.ravel(value)) if several else number(factor * value)

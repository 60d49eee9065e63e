"""Common parts of all figures: axes, labels, units, line styles, legends, and curves with their peaks and gaps.

Curves are over the crank angle. `with_peaks` adds crank angles of extremes, kinks and jumps between those solved.
`shade_gaps` marks crank angles without a value, and `limit_axis` keeps values that grow without bound off the scale.
"""

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..cycle.extremes import extrema
from ..cycle.rounding import PLACED
from ..errors import KinetostaticsError, ParameterError
from ..mechanics.quantities import label_of
from ..numbers import checks
from ..numbers.files import write_atomically
from ..numbers.formatting import parse_heading
from ..numbers.output_units import dimension_name, shown_units
from ..solution.parameters import tables_over_angles


@dataclass(frozen=True)
class AngleConvention:
    """Convention for crank angles: text of the axis, direction of angle 0, degrees from +x, and sense.

    The library's own is `FROM_X`.
    """

    text: str
    zero: float = 0.0
    sense: int = 1

    @property
    def axis(self):
        return f"crank angle {self.text} [deg]"

    def __call__(self, degrees, period=360.0):
        """Convert crank angles from the library's convention, degrees."""
        return degrees if self == FROM_X else np.mod(self.sense * (degrees - self.zero), period)

    def from_x(self, degrees):
        """Convert crank angles to the library's convention, degrees."""
        return self.zero + self.sense * np.asarray(degrees)


FROM_X = AngleConvention("from +x, counter-clockwise")
FROM_Y_CLOCKWISE = AngleConvention("from +y, clockwise", 90.0, -1)
INK, STEEL, ACCENT, LOAD = "0.15", "slategray", "tab:red", "tab:green"
STYLES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
"""Line styles; they distinguish curves in print without colour."""


def axes(ax):
    """The given axes, or new ones."""
    checks.require("plots", None if ax is None or hasattr(ax, "plot") else f"ax must be matplotlib Axes, got {ax!r}")
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # the report needs none of it

    return plt.subplots(layout="constrained")[1]


def several_axes(owner, ax, rows, columns, size, **options):
    """The given axes, or those in rows and columns of a new figure of a size in inches."""
    count = rows * columns
    few = None if ax is None or len(np.ravel(ax)) == count else f"ax must be {count} Axes, got {checks.shown(ax)}"
    checks.require(owner, few)
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt

    return plt.subplots(rows, columns, layout="constrained", figsize=size, **options)[1]


def require_kind(owner, item, kind, wanted):
    """Raise an error unless an item is of a class; it begins with the sentence `wanted`."""
    checks.require(owner, None if isinstance(item, kind) else f"{wanted}, got {checks.shown(item)}")


def solutions_by_label(solutions, name):
    """Solutions by label; a single solution has the label of the quantity."""
    checks.require("plots", checks.quantity(name))
    several = isinstance(solutions, Mapping)
    named = dict(solutions) if several else {"solution": solutions}
    checks.require(
        "plots",
        None if named else "give at least one solution to draw",
        *(checks.solution(str(name) if len(named) > 1 else "solution", solution) for name, solution in named.items()),
    )
    named = named if several else {label_of(solutions, name): solutions}
    for name, solution in named.items():
        if len(solution.shape) != 1:
            raise ParameterError(
                f"plots show one design over its crank angles, but {name!r} has shape {solution.shape}; solve a single "
                "design of the batch"
            )
    return named


def single_solution(solution):
    """The solution; an error for a batch of designs."""
    return next(iter(solutions_by_label({"solution": solution}, "").values()))


def require_columns(name, table, columns):
    """Raise an error if a table lacks columns that a chart shows."""
    found = list(getattr(table, "columns", ()))
    missing = [column for column in columns if column not in found]
    problem = None
    if not hasattr(table, "columns"):
        problem = f"table must be a pandas DataFrame, got a {type(table).__name__}"
    elif missing:
        problem = f"the table has no column {', '.join(map(repr, missing))}; it has {', '.join(map(str, found))}"
        problem += checks.hint(missing[0], found)
    elif not len(table):
        problem = "the table has no rows"
    checks.require(name, problem)


def with_line_styles(named):
    """Tuples of name, solution and line style."""
    return [(name, solution, STYLES[row % len(STYLES)]) for row, (name, solution) in enumerate(named.items())]


def grouped(items, alike):
    """Lists of similar items, by a function of the first item of a list and another item."""
    groups: list[list[Any]] = []
    for item in items:
        group = next((group for group in groups if alike(group[0], item)), None)
        if group is None:
            groups.append([item])
        else:
            group.append(item)
    return groups


LONG_LABEL = 20
"""Letters of a label from which on the legend has two columns at most."""
MAX_LEGEND_SHARE = 0.35
"""Height of a legend, relative to the axes, above which it stands beside them."""
LEGEND_COLUMNS = (3, 2, 1)
"""Numbers of legend columns to try, until the legend fits into the axes."""
SAME_CURVE_TOLERANCE = 2e-3
"""Distance of two curves, relative to the extent of all, below which they count as equal."""
ZERO_TOLERANCE = 1e-9
"""Size of a curve, relative to the largest, below which it counts as zero."""


def distinct_curves(curves, apart=False):
    """Legend labels of curves (N,) or (2, N), each with the name of the curve; coincident curves share a label.

    The label of a zero curve ends in "(0)". With `apart`, curves with separate scales are compared by their own
    extents.
    """
    arrays = {name: np.asarray(curve, dtype=float) for name, curve in curves.items()}
    finite = {name: np.where(np.isfinite(array), array, 0.0) for name, array in arrays.items()}
    largest = max((float(np.max(np.abs(array), initial=0.0)) for array in finite.values()), default=0.0)
    extents = {name: float(np.max(np.ptp(array, axis=-1), initial=0.0)) for name, array in finite.items()}

    def coincide(name, other):
        tolerance = SAME_CURVE_TOLERANCE * (extents[other] if apart else max(extents.values()))
        one, two = arrays[name], arrays[other]
        return one.shape == two.shape and np.allclose(two, one, rtol=0.0, atol=tolerance, equal_nan=True)

    several = len(arrays) > 1
    zero = {name: several and np.max(np.abs(finite[name]), initial=0.0) <= ZERO_TOLERANCE * largest for name in arrays}
    groups = grouped(arrays, coincide)
    return {f"{', '.join(names)}{' (0)' if zero[names[0]] else ''}": names[0] for names in groups}


def period_curve(solution, value, counted=FROM_X):
    """Crank angles, degrees, and values (2, N) over one period, by rising angle in the convention."""
    degrees = np.degrees(solution.crank_angle)
    angle = counted(degrees, np.degrees(solution.period))
    order = slice(None) if counted == FROM_X else np.argsort(angle)
    return np.stack([angle[order], np.broadcast_to(value, angle.shape)[order]])


def draw_curves(ax, curves):
    """Draw curves (2, N) by label, each in its own style; coincident curves are drawn once."""
    for text, name, style in with_line_styles(distinct_curves({name: value for name, (_, value) in curves.items()})):
        ax.plot(*curves[name], linestyle=style, label=text)


def axis_words(column):
    """Heading of a column of a table, "mean_absolute balancing_torque [N m]", as words for an axis."""
    name, unit = parse_heading(column)
    words = name.replace("_", " ").replace(".", " ")
    if words.startswith("ratio "):
        words = f"ratio of {words.removeprefix('ratio ')}, reference / design"
    return f"{words} [{unit or 'SI'}]"


ORDINARY_SHARE = 0.9
"""Fraction of ordinary values if a few grow without bound."""
UNBOUNDED_RATIO = 1e4
"""Ratio to the ordinary values above which others grow without bound."""
DRAWN_RATIO = 3.0
"""Largest ratio of drawn unbounded values to the ordinary ones."""
GAP_REACH = 36
"""Share of the crank angles, 1 / `GAP_REACH`, on each side of a gap where values may grow without bound."""


def ordinary_size(arrays):
    """Largest magnitude of all values that do not grow without bound.

    Values grow without bound if they are far beyond most others, as forces near change points, or beside a gap.
    """
    rows = [np.abs(np.atleast_1d(np.asarray(array, dtype=float))) for array in arrays]
    most = max((float(np.max(row, initial=0.0)) for row in rows), default=0.0)  # NaN with a gap
    mean = sum(float(np.sum(row)) for row in rows) / max(1, sum(row.size for row in rows))
    if UNBOUNDED_RATIO * (mean - (1.0 - ORDINARY_SHARE) * most) >= most and np.isfinite(most):
        return most  # without the slower quantile below, which is at least this difference
    others = []
    for values in rows:
        missing = np.isnan(values)
        if not missing.any():
            others.append(values)
            continue
        reach = max(1, values.shape[-1] // GAP_REACH)
        beside = np.any([np.roll(missing, step, axis=-1) for step in range(-reach, reach + 1)], axis=0)
        others.append(np.where(beside, np.nan, values))
    sizes, away = (np.concatenate([np.ravel(row) for row in part]) for part in (rows, others))
    finite, others = sizes[np.isfinite(sizes)], away[np.isfinite(away)]
    if not finite.size:
        return 0.0
    most, apart = float(finite.max()), float(np.max(others, initial=0.0))
    if 0.0 < DRAWN_RATIO * apart < most:
        return apart
    usual = float(np.quantile(finite, ORDINARY_SHARE))
    return usual if 0.0 < UNBOUNDED_RATIO * usual < float(np.nanmax(sizes)) else most


def hidden_beyond(limit, values):
    """Values (N,) or vectors (2, N), NaN where they are larger than a limit."""
    sizes = np.hypot(*values) if np.ndim(values) > 1 else np.abs(values)
    return np.where(sizes <= limit, values, np.nan)


def drawn_limit(arrays, most=None):
    """Largest drawn magnitude, so that a few unbounded values do not flatten the rest; or infinity.

    `most` is their `ordinary_size`, if it is known.
    """
    most = ordinary_size(arrays) if most is None else most
    beyond = any(np.any(np.abs(array) > most) for array in arrays)
    return DRAWN_RATIO * most if beyond else np.inf


def display_unit(name, arrays):
    """Factor and unit for readable numbers: the unit that the user chooses, else one by the size of the values."""
    return unit_for(name, ordinary_size(list(arrays)))


def unit_for(name, largest):
    """Factor and unit for readable numbers of a known `ordinary_size`."""
    factor, chosen = shown_units().of(name)
    if dimension_name(name) in shown_units().chosen:
        return factor, chosen
    if name == "rad":
        return 180 / np.pi, "deg"
    if name == "Pa" and largest >= 1e5:
        return 1e-6, "MPa"
    return (1e-3, f"k{name}") if name in ("N", "N m", "W", "J") and largest >= 1e4 else (1.0, name)


def close_curve(curve):
    """Curve (2, N) over one turn with its first point repeated at the end."""
    return np.concatenate([curve, curve[:, :1]], axis=1)


def finish_axes(ax, ylabel, legend, period=360, counted=FROM_X):
    """Add labels, grid and legend to the axes of curves over the crank angle, degrees."""
    ax.set_xlabel(counted.axis)
    ax.set_ylabel(ylabel)
    low, high = ax.dataLim.intervalx
    if low >= 0 and high <= period:
        ax.set_xlim(0, period)
        ax.set_xticks(range(0, period + 1, period // 4))
    ax.axhline(0, color=INK, lw=0.5)
    ax.grid(alpha=0.3)
    if legend:
        handles, texts = ax.get_legend_handles_labels()
        most = LEGEND_COLUMNS if max(map(len, texts), default=0) < LONG_LABEL else LEGEND_COLUMNS[1:]
        texts = [textwrap.fill(text, 2 * LONG_LABEL, break_on_hyphens=False) for text in texts]
        style = {"frameon": False, "loc": "upper center", "fontsize": "small", "columnspacing": 1.0}
        for columns in most:
            box = ax.legend(handles, texts, ncols=columns, **style).get_window_extent()
            if box.width <= ax.bbox.width:
                break
        share = box.height / ax.bbox.height
        if share > MAX_LEGEND_SHARE:
            ax.legend(handles, texts, **style | {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)})
            share = 0.0
        ax.margins(y=max(0.18, share / (1.0 - 2.0 * share)))
    if ax.dataLim.ymin >= -ZERO_TOLERANCE * ax.dataLim.ymax:
        ax.set_ylim(bottom=-0.05 * ax.dataLim.ymax or None)
    return ax


def set_equal_scales(ax, moving=()):
    """Set equal scales that show all drawn parts and moving points (N, 2)."""
    ax.relim()
    if len(moving):
        ax.update_datalim(moving)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.autoscale_view()


def with_peaks(named, *quantities):
    """Solutions by label with added crank angles: extremes of quantities, and kinks of tables and friction.

    Each solution is of one design; quantities are as for `extremes`, vectors by their magnitude. All get the angles of
    all, so coincident curves remain so. A solution is unchanged if nothing is known between its crank angles, or these
    do not rise.
    """
    known = {name: solution for name, solution in named.items() if _is_known_between(solution)}
    more = [np.empty(0)]
    for solution in known.values():
        for item in quantities:
            try:
                found = extrema(solution, item)
            except KinetostaticsError:  # such as a force that does not repeat; it can still be drawn
                continue
            more.append(angles_between(solution, found.angle[np.isfinite(found.value)]))
    angles = np.unique(np.concatenate(more))
    if not angles.size:
        return dict(named)
    return {name: _with_angles(solution, angles) if name in known else solution for name, solution in named.items()}


def angles_between(solution, extremes):
    """Rising crank angles of missing extremes, of kinks, and of both sides of jumps."""
    there = np.abs(extremes[:, None] - np.mod(solution.crank_angle, solution.period)).min(axis=1) < PLACED
    return np.unique(np.concatenate([extremes[~there], solution.sampled.beside_kinks]))


def _is_known_between(solution):
    angle = solution.crank_angle
    return (
        np.ndim(angle) == 1 and not tables_over_angles(solution) and angle.size > 1 and bool(np.all(np.diff(angle) > 0))
    )


def _with_angles(solution, more):
    """The solution with added crank angles, in every period that its own angles cover."""
    own, period = solution.crank_angle, solution.period
    span = own[-1] - own[0]
    turns = np.round((span + np.max(np.diff(own))) / period)
    whole = abs(span + np.max(np.diff(own)) - turns * period) < 1e-9 * period
    end = own[0] + (turns * period if whole else span)
    again = period * np.arange(np.floor(own[0] / period), np.floor(end / period) + 1.0)
    more = np.ravel(np.mod(more, period) + again[:, None])
    return solution.at(np.union1d(own, more[(more > own[0]) & (more < end)]))


GAP_STYLE = {"color": "0.9", "lw": 0.0, "zorder": 0.5}
NOTE_STYLE = {"color": "0.35", "fontsize": "x-small"}
MIN_NAMED_GAP = 0.01
"""Smallest width of a gap with a name, relative to the axes."""


def shade_gaps(ax, named, curves, counted):
    """Shade crank angles where curves (2, N) have no value, with the reason."""
    found: dict[tuple[float, float, str], list[str]] = {}
    for name, solution in named.items():
        _, closed = period_curve(solution, solution.closed, counted)
        angle, value = curves[name]
        missing = np.flatnonzero(np.isnan(value))
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1) if missing.size else ()
        for rows in runs:
            start, end = (float(angle[row]) for row in (max(rows[0] - 1, 0), min(rows[-1] + 1, len(angle) - 1)))
            found.setdefault((start, end, _reason_missing(closed[rows].astype(bool), solution)), []).append(name)
    low, high = ax.get_xlim()
    for (start, end, why), names in found.items():
        ax.axvspan(start, end, **GAP_STYLE)
        if end - start > MIN_NAMED_GAP * (high - low):
            text = why if len(names) == len(named) else f"{', '.join(names)}: {why}"
            place = {"transform": ax.get_xaxis_transform(), "rotation": 90, "ha": "center", "va": "bottom"}
            ax.text(0.5 * (start + end), 0.08, text, clip_on=True, **place, **NOTE_STYLE)
    ax.set_xlim(low, high)


def _reason_missing(closed, solution):
    if not closed.all():
        return "cannot be assembled"
    return "jams" if solution.friction else "no value"


def draw_over_turn(ax, named, curves, label, unit, counted):
    """Draw curves (2, N) over the longest period, with gaps shaded and values without bound off the scale.

    Curves of a shorter period are repeated.
    """
    periods = {name: np.degrees(solution.period) for name, solution in named.items()}
    longest = max(periods.values())
    draw_curves(ax, {name: _repeated(curve, periods[name], longest) for name, curve in curves.items()})
    finish_axes(ax, label, len(named) > 1, round(longest), counted)
    limit_axis(ax, [value for _, value in curves.values()], unit)
    shade_gaps(ax, named, curves, counted)
    return ax


def _repeated(curve, period, longest):
    """Curve (2, N) over a period, degrees: over as many as fit into the longest; unchanged if it lacks a part."""
    angle, value = curve
    turns, step = np.arange(round(longest / period)), np.max(np.diff(angle), initial=0.0)
    if not angle[-1] < period <= angle[-1] - angle[0] + 1.5 * step:
        return curve
    return np.stack([np.ravel(angle + period * turns[:, None]), np.tile(value, turns.size)])


def panels(count, columns, width, height, more=0.0):
    """Figure of `count` axes in rows, each of a width and height in inches, and the axes; `more` is added in height."""
    import matplotlib.pyplot as plt

    columns = min(columns, count)
    rows = -(-count // columns)
    size = (width * columns, height * rows + more)
    figure, grid = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    for ax in grid.flat[count:]:
        ax.remove()
    return figure, list(grid.flat[:count])


DPI = 150
"""Dots per inch of figures in files."""
WITHOUT_LAYOUT: Any = {"figure.autolayout": False, "figure.constrained_layout.use": False}


def save_figure(figure, path, salt=None, **options):
    """Save a figure in the format of its file's ending, the same bytes each time; returns the path."""
    import matplotlib.pyplot as plt

    kind = Path(path).suffix[1:] or "png"
    with plt.rc_context({"svg.hashsalt": salt} | WITHOUT_LAYOUT), write_atomically(path) as temporary:
        metadata = {"Date": None} if kind == "svg" else {}
        if engine := figure.get_layout_engine():  # once; with an engine, even "none", `savefig` draws a figure twice
            figure.set_dpi(DPI)
            engine.execute(figure)
            figure.set_layout_engine(None)
        figure.savefig(temporary, format=kind, dpi=DPI, metadata=metadata, **options)
    plt.close(figure)
    return Path(path)


def limit_axis(ax, arrays, unit):
    """Limit the axis to ordinary values if some of the arrays (N,) grow without bound."""
    sight = drawn_limit(arrays)
    if np.isfinite(sight):
        values = np.concatenate(arrays)
        seen = np.clip(values[np.isfinite(values)], -sight, sight)
        low, high = seen.min(), seen.max()
        room = ax.margins()[1] * (high - low)
        ax.set_ylim(low - room, high + room)
        write_notes(ax, [f"beyond the frame: {size_text(arrays, unit)}"])


def size_text(arrays, unit):
    """Text of the largest magnitude of values (N,)."""
    largest = float(np.nanmax(np.abs(np.concatenate(arrays))))
    return f"up to {largest:.3g} {unit}" if np.isfinite(largest) else "without bound"


def write_notes(ax, lines):
    """Write lines into the corner of the axes."""
    box = {"boxstyle": "square,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.7}
    ax.text(0.01, 0.01, "\n".join(lines), transform=ax.transAxes, va="bottom", bbox=box, **NOTE_STYLE)


class CurveEnd(NamedTuple):
    """End of a curve: its row, the direction there in degrees, and the reason; "" if it continues beyond the frame."""

    row: int
    angle: float
    why: str


def curve_ends(solution, curve, drawn):
    """Each `End` of a curve (2, N) of a solution over its period, of which some is drawn and the rest is NaN."""
    there, missing = np.isfinite(drawn).all(axis=0), np.isnan(curve).any(axis=0)
    for step in (1, -1):
        for row in np.flatnonzero(there & ~np.roll(there, -step)).tolist():
            before, behind = (row - step) % there.size, (row + step) % there.size
            x, y = drawn[:, row] - (drawn[:, before] if there[before] else 0.0)
            why = _reason_missing(solution.closed[[behind]], solution) if missing[behind] else ""
            yield CurveEnd(row, float(np.degrees(np.arctan2(y, x))), why)

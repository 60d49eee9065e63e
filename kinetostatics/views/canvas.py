"""What every figure shares: colours, axes, labels, units that read well."""

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np

from ..errors import ParameterError
from ..mechanics.quantities import label_of
from ..numbers import checks
from ..numbers.formatting import parted


@dataclass(frozen=True)
class Counted:
    """How crank angles are counted: the text of an axis, the angle from +x at 0, degrees, and the sense.

    All figures of one folder count in one way; `FROM_X` is that of the library.
    """

    text: str
    zero: float = 0.0
    sense: int = 1

    @property
    def axis(self):
        return f"crank angle {self.text} [deg]"

    def __call__(self, degrees, period=360.0):
        """Crank angles from +x, counter-clockwise, counted so."""
        return degrees if self == FROM_X else np.mod(self.sense * (degrees - self.zero), period)

    def from_x(self, degrees):
        """Crank angles counted so, from +x, counter-clockwise."""
        return self.zero + self.sense * np.asarray(degrees)


FROM_X = Counted("from +x, counter-clockwise")
FROM_Y_CLOCKWISE = Counted("from +y, clockwise", 90.0, -1)
INK, STEEL, ACCENT, LOAD = "0.15", "slategray", "tab:red", "tab:green"
STYLES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
"""Line styles, so that curves differ in print too."""


def axes(ax):
    """The axes given, or new ones."""
    checks.require("plots", None if ax is None or hasattr(ax, "plot") else f"ax must be matplotlib Axes, got {ax!r}")
    return plt.subplots(layout="constrained")[1] if ax is None else ax


def labelled(solutions, name):
    """Solutions by label; a single one is labelled by the quantity shown."""
    checks.require("plots", checks.quantity(name))
    several = isinstance(solutions, Mapping)
    named = dict(solutions) if several else {"solution": solutions}
    checks.require(
        "plots",
        None if named else "there are no solutions to draw",
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


def single(solution):
    """The solution given, if it is one of one design."""
    return next(iter(labelled({"solution": solution}, "").values()))


def require_columns(name, table, columns):
    """A table of a study has the columns that a chart shows."""
    found = list(getattr(table, "columns", ()))
    missing = [column for column in columns if column not in found]
    problem = None
    if not hasattr(table, "columns"):
        problem = f"table must be a pandas DataFrame, got a {type(table).__name__}"
    elif missing:
        problem = f"the table has no column {', '.join(map(repr, missing))}; it has {', '.join(map(str, found))}"
    elif not len(table):
        problem = "the table has no rows"
    checks.require(name, problem)


def styled(named):
    """Name, solution and line style of each."""
    return [(name, solution, STYLES[row % len(STYLES)]) for row, (name, solution) in enumerate(named.items())]


LONG = 20
"""Letters of a label from which on a legend has one column."""
COLUMNS = (3, 2, 1)
"""Of a legend above curves: as many as fit into the axes."""
ALIKE = 2e-3
"""Distance of curves, beside the extent of all, up to which one covers the other."""
NOTHING = 1e-9
"""Size of a curve, beside the largest, below which it is rounding."""


def distinct(curves, apart=False):
    """Labels of curves (N,) or (2, N) for a legend, each with the name of the curve: one for all that cover each other.

    The label of a curve that is zero but for rounding says so. Curves that are drawn apart, each to a scale of its own,
    are compared by their own extents.
    """
    arrays = {name: np.asarray(curve, dtype=float) for name, curve in curves.items()}
    finite = {name: np.where(np.isfinite(array), array, 0.0) for name, array in arrays.items()}
    largest = max((float(np.max(np.abs(array), initial=0.0)) for array in finite.values()), default=0.0)
    extents = {name: float(np.max(np.ptp(array, axis=-1), initial=0.0)) for name, array in finite.items()}
    found: list[list[str]] = []
    for name, array in arrays.items():
        for names in found:
            other, extent = arrays[names[0]], extents[name] if apart else max(extents.values())
            if other.shape == array.shape and np.allclose(array, other, rtol=0.0, atol=ALIKE * extent, equal_nan=True):
                names.append(name)
                break
        else:
            found.append([name])
    several = len(arrays) > 1
    zero = {name: several and np.max(np.abs(finite[name]), initial=0.0) <= NOTHING * largest for name in arrays}
    return {f"{', '.join(names)}{' (0)' if zero[names[0]] else ''}": names[0] for names in found}


def in_order(solution, value, counted=FROM_X):
    """Crank angles and values (2, N) over one period, by growing angle as it is counted."""
    degrees = np.degrees(solution.crank_angle)
    angle = counted(degrees, np.degrees(solution.period))
    order = slice(None) if counted == FROM_X else np.argsort(angle)
    return np.stack([angle[order], np.broadcast_to(value, angle.shape)[order]])


def drawn_over_turn(ax, curves):
    """Draw curves (2, N) by label, each in its own style, those that cover each other as one."""
    for text, name, style in styled(distinct({name: value for name, (_, value) in curves.items()})):
        ax.plot(*curves[name], linestyle=style, label=text)


def readable(column):
    """Heading of a column of a table, "mean_absolute balancing_torque [N m]", as words for an axis."""
    name, unit = parted(column)
    words = name.replace("_", " ").replace(".", " ")
    if words.startswith("ratio "):
        words = f"ratio of {words.removeprefix('ratio ')}, reference / design"
    return f"{words} [{unit or 'SI'}]"


MOST = 0.9
"""Share of values that are ordinary where a few grow without bound."""
BEYOND = 1e4
"""Times the ordinary values from which on others grow without bound."""
SIGHT = 3.0
"""Times the ordinary values up to which those that grow without bound are drawn."""
BESIDE = 36
"""Share of the crank angles, 1 / `BESIDE`, on each side of a gap where values may grow without bound."""


def ordinary(arrays):
    """Largest size of all values, unless some grow without bound: then of the others.

    That are those far beyond most others, as forces near change points, and those beside a gap.
    """
    rows = [np.abs(np.atleast_1d(np.asarray(array, dtype=float))) for array in arrays]
    sizes, away = (np.concatenate([np.ravel(row) for row in part]) for part in (rows, map(_away_from_gaps, rows)))
    finite, others = sizes[np.isfinite(sizes)], away[np.isfinite(away)]
    if not finite.size:
        return 0.0
    most, apart = float(finite.max()), float(np.max(others, initial=0.0))
    if 0.0 < SIGHT * apart < most:
        return apart
    usual, largest = float(np.quantile(finite, MOST)), float(np.nanmax(sizes))
    return usual if 0.0 < BEYOND * usual < largest else most


def _away_from_gaps(values):
    """Values over the crank angles without those beside a gap, where there is one."""
    missing = np.isnan(values)
    if not missing.any():
        return values
    reach = max(1, values.shape[-1] // BESIDE)
    beside = np.any([np.roll(missing, step, axis=-1) for step in range(-reach, reach + 1)], axis=0)
    return np.where(beside, np.nan, values)


def in_sight(arrays):
    """Size up to which values are drawn, so that a few far beyond all others do not flatten these; infinite if none."""
    most = ordinary(arrays)
    beyond = any(np.any(np.abs(array) > most) for array in arrays)
    return SIGHT * most if beyond else np.inf


def display(name, arrays):
    """Factor and unit in which numbers of this size read well."""
    if name == "rad":
        return 180 / np.pi, "deg"
    largest = ordinary(list(arrays))
    if name == "Pa" and largest >= 1e5:
        return 1e-6, "MPa"
    return (1e-3, f"k{name}") if name in ("N", "N m", "W") and largest >= 1e4 else (1.0, name)


def closed(curve):
    """Curve (2, N) over one turn with its first point repeated at the end."""
    return np.concatenate([curve, curve[:, :1]], axis=1)


def finished(ax, ylabel, legend, period=360, counted=FROM_X):
    """The axes of curves over the crank angle, degrees, with labels, grid and legend."""
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
        most = COLUMNS if max(map(len, texts), default=0) < LONG else COLUMNS[-1:]
        texts = [textwrap.fill(text, 2 * LONG, break_on_hyphens=False) for text in texts]
        style = {"frameon": False, "loc": "upper center", "fontsize": "small", "columnspacing": 1.0}
        for columns in most:
            box = ax.legend(handles, texts, ncols=columns, **style).get_window_extent()
            if box.width <= ax.bbox.width:
                break
        share = min(box.height / ax.bbox.height, 0.4)
        ax.margins(y=max(0.18, share / (1.0 - 2.0 * share)))
    return ax

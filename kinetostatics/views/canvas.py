"""What every figure shares: colours, axes, labels, units that read well."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np

from ..errors import ParameterError
from ..mechanics.quantities import label_of
from ..numbers import checks

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


def display(name, arrays):
    """Factor and unit in which numbers of this size read well."""
    if name == "rad":
        return 180 / np.pi, "deg"
    largest = max(float(np.nanmax(np.abs(array))) for array in arrays)
    if name == "Pa" and largest >= 1e5:
        return 1e-6, "MPa"
    return (1e-3, f"k{name}") if name in ("N", "N m", "W") and largest >= 1e4 else (1.0, name)


def closed(curve):
    """Curve (2, N) over one turn with its first point repeated at the end."""
    return np.concatenate([curve, curve[:, :1]], axis=1)


def finished(ax, ylabel, legend, period=360):
    """The axes of curves over the crank angle, degrees, with labels, grid and legend."""
    ax.set_xlabel("crank angle [deg]")
    ax.set_ylabel(ylabel)
    low, high = ax.dataLim.intervalx
    if low >= 0 and high <= period:
        ax.set_xlim(0, period)
        ax.set_xticks(range(0, period + 1, period // 4))
    ax.axhline(0, color=INK, lw=0.5)
    ax.grid(alpha=0.3)
    if legend:
        ax.margins(y=0.18)
        ax.legend(frameon=False, loc="upper center", ncols=3, fontsize="small", columnspacing=1.0)
    return ax

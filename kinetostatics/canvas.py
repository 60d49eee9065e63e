"""What every figure shares: colours, axes, labels, units that read well."""

from collections.abc import Mapping

import matplotlib.pyplot as plt
import numpy as np

from .errors import ParameterError
from .quantities import label

INK, STEEL, ACCENT = "0.15", "slategray", "tab:red"
STYLES = ("-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)))
"""Line styles, so that curves differ in print too."""


def axes(ax):
    """The axes given, or new ones."""
    return plt.subplots(layout="constrained")[1] if ax is None else ax


def labelled(solutions, name):
    """Solutions by label; a single one is labelled by the quantity shown."""
    named = dict(solutions) if isinstance(solutions, Mapping) else {label(name): solutions}
    for name, solution in named.items():
        if len(solution.shape) != 1:
            raise ParameterError(
                f"plots show one design over its crank angles, but {name!r} has shape {solution.shape}; solve a single "
                "design of the batch"
            )
    return named


def styled(named):
    """Name, solution and line style of each."""
    return [(name, solution, STYLES[row % len(STYLES)]) for row, (name, solution) in enumerate(named.items())]


def display(name, arrays):
    """Factor and unit in which numbers of this size read well."""
    if name == "rad":
        return 180 / np.pi, "deg"
    largest = max(float(np.nanmax(np.abs(array))) for array in arrays)
    return (1e-3, f"k{name}") if name in ("N", "N m") and largest >= 1e4 else (1.0, name)


def closed(curve):
    """Curve (2, N) over one turn with its first point repeated at the end."""
    return np.concatenate([curve, curve[:, :1]], axis=1)

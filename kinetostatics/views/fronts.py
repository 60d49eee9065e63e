"""Figures of designs: fronts of two outputs."""

from ..numbers.formatting import parted
from .canvas import ACCENT, INK, axes, display, readable


def front(found, ax=None):
    """Designs of which none is better in both outputs, as `ks.design.pareto` finds them, and the source.

    Parameters
    ----------
    found : design.Front
    ax : matplotlib Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spring = ks.Spring(600e3, free_position=2.0)
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 33.5, loads=[spring])
    >>> vary = {"spring.stiffness": (100e3, 900e3)}
    >>> found = ks.design.pareto(saw, vary, ("largest_absolute B", "rms balancing_torque"), points=3, angles=90)
    >>> ks.plots.front(found).has_data()
    True
    """
    ax = axes(ax)
    scales, headings = [], []
    for column in list(found.table.columns)[:2]:
        name, unit = parted(column)
        factor, shown = display(unit, [found.table[column].to_numpy()])
        scales.append(factor)
        headings.append(readable(f"{name} [{shown or '1'}]"))
    first, second = (found.table.iloc[:, place].to_numpy() * scales[place] for place in (0, 1))
    ax.plot(second, first, "o-", color=INK, label="best designs")
    before = [value * scale for value, scale in zip(found.before, scales, strict=True)]
    ax.plot(before[1], before[0], "x", color=ACCENT, label="before")
    ax.set_ylabel(headings[0])
    ax.set_xlabel(headings[1])
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax

"""Charts of studies: error over time, over distance from a critical place, over the cost of a model; maps of sweeps."""

import textwrap
from functools import partial
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import LogLocator, MaxNLocator

from ..errors import ParameterError
from .canvas import ACCENT, axes, axis_words, panels, require_columns, save_figure
from .labels import label

MIN_DRAWN_ERROR = 1e-17
"""Smallest error drawn, below the rounding of the largest value; zero errors are drawn there."""
MAX_DRAWN_ERROR = 1e3
"""Largest error drawn; larger ones and NaN are drawn there."""
COLOURS = [plt.get_cmap("tab20")(number) for number in (0, 2, 4, 8, 10, 12, 14, 16, 18, 1, 3, 5, 9, 11, 13, 17, 19)]
"""Colours of methods without reds, which mark the library's own."""
MARKERS = "osD^v<>PX*phd"


def _method_styles(table):
    """Plot style of each method of a study, by name."""
    styles = {}
    for number, (name, ours) in enumerate(table.groupby("method", sort=False)["ours"].first().items()):
        styles[name] = {
            "marker": MARKERS[number % len(MARKERS)],
            "color": ACCENT if ours else COLOURS[number % len(COLOURS)],
            "markersize": 7 if ours else 5.5,
            "markeredgecolor": "0.15" if ours else "none",
            "linewidth": 1.6 if ours else 1.0,
            "zorder": 3 if ours else 2,
        }
    return styles


def work_precision(table, ax=None, like=None):
    """Error over time, both logarithmic: a curve for each method with a setting, else a point.

    If a method proves a bound on its error, a line connects the two.

    Parameters
    ----------
    table : pandas.DataFrame
        One quantity of one scene, from `precision.study`; or from `precision.study_running` or `study_motion`.
    ax : Axes, optional
    like : pandas.DataFrame, optional
        A study of more methods, which sets the colours and marks.

    Examples
    --------
    >>> import pandas as pd
    >>> import kinetostatics as ks
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5).solve(8)
    >>> table = ks.precision.study(s, methods=ks.precision.METHODS[:1], repeats=1)
    >>> ks.plots.work_precision(table).get_xscale()
    'log'
    """
    whole = "time [ms]" in getattr(table, "columns", ())
    time = "time [ms]" if whole else "time [ns/angle]"
    require_columns("work_precision", table, ("method", "ours", "setting", "error", time))
    ax = axes(ax)
    given = table.dropna(subset=["error"])
    for name, style in _method_styles(table if like is None else like).items():
        rows = given[given["method"] == name]
        if len(rows):
            setting = rows["setting"].iloc[0]
            text = f"{name} ({setting})" if setting else name
            device = rows["device"].iloc[0] if "device" in rows else "cpu"
            text += "" if device == "cpu" else f", on {device}"
            ax.plot(rows[time], np.maximum(rows["error"], MIN_DRAWN_ERROR), label=text, **style)
            proven = rows.dropna(subset=["bound"]) if "bound" in rows else rows.assign(bound=np.nan)[:0]
            errors = np.maximum(proven["error"], MIN_DRAWN_ERROR)
            ax.vlines(proven[time], errors, proven["bound"], color=style["color"], lw=1.0)
            ax.plot(proven[time], proven["bound"], "_", color=style["color"], markersize=9)
    if "bound" in given and given["bound"].notna().any():
        ax.plot([], [], "_", color=ACCENT, markersize=9, label="proven bound on the error below it")
    ax.set(xscale="log", yscale="log", ylim=(MIN_DRAWN_ERROR / 3, 30))
    ax.set_xlabel("time [ms]" if whole else "time [ns per crank angle]")
    text = "largest error / largest value [1]"
    ax.set_ylabel(f"error of the {table['label'].iloc[0]} [{table['unit'].iloc[0]}]" if whole else text)
    ax.grid(visible=True, which="major", alpha=0.3)
    return ax


def error_by_distance(table, ax=None):
    """Error of every method over the number that approaches a place, logarithmic.

    Dashed: condition times rounding unit; dash-dotted: change by one rounding of the angle; dotted: the bound proven
    by the library for its own values. Errors above a thousand times the largest value, and NaN, are on the upper
    edge.

    Parameters
    ----------
    table : pandas.DataFrame
        One place, from `stability.study`.
    ax : Axes, optional

    Examples
    --------
    >>> from dataclasses import replace
    >>> import kinetostatics as ks
    >>> place = replace(ks.stability.PLACES[0], numbers=(1e-6, 1e-3))
    >>> table = ks.stability.study([place], ks.precision.METHODS[:1])
    >>> ks.plots.error_by_distance(table).get_xlabel() == place.axis
    True
    """
    shown = ("method", "ours", "number", "error", "nan", "raised", "not given", "condition", "axis", "label")
    require_columns("error_by_distance", table, shown)
    ax = axes(ax)
    for name, style in _method_styles(table).items():
        rows = table[(table["method"] == name) & (table["not given"] == "")]
        failing = (rows["nan"] > 0) | (rows["raised"] != "")
        if len(rows):
            errors = rows["error"].where(~failing, MAX_DRAWN_ERROR).clip(MIN_DRAWN_ERROR, MAX_DRAWN_ERROR)
            ax.plot(rows["number"], errors, label=name, **style)
    problem = table.drop_duplicates("number")
    limits = {
        "condition": ({"color": "k", "ls": "--", "label": "condition x rounding"}, 2.0**-53),
        "angle rounding": ({"color": "0.5", "ls": "-.", "label": "one rounding of the crank angle"}, 1.0),
        "bound": ({"color": "k", "ls": ":", "label": "proven bound of ours"}, 1.0),
    }
    for column, (style, factor) in limits.items():
        if column in problem:
            ax.plot(problem["number"], (factor * problem[column]).clip(MIN_DRAWN_ERROR, MAX_DRAWN_ERROR), **style)
    ax.set(xscale="log", yscale="log", ylim=(MIN_DRAWN_ERROR / 3, 3 * MAX_DRAWN_ERROR), xlabel=table["axis"].iloc[0])
    ax.xaxis.set_major_locator(LogLocator(numticks=7))
    ax.set_ylabel(f"error of {table['label'].iloc[0]} [1]")
    ax.grid(visible=True, alpha=0.3)
    return ax


def model_ladder(needs, ax=None):
    """Error over operations: each simplification alone, and the ladder of the cheapest models; log scale.

    Errors far below the tolerance are on the lower edge.

    Parameters
    ----------
    needs : Needs
    ax : Axes, optional

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> needs = ks.needs(ks.Scene(saw, 33.5).solve(90), "balancing_torque", within=0.05, progress=False)
    >>> ks.plots.model_ladder(needs).get_yscale()
    'log'
    """
    if not hasattr(needs, "ladder"):
        raise ParameterError(f"model_ladder: needs must be a Needs, as from ks.needs(...), got {type(needs).__name__}")
    ax = axes(ax)
    floor = 1e-3 * min(needs.within, 1e-2)

    def drawn(models, *style, **named):
        shown = [made for made in models if np.isfinite(made.error)]
        ax.plot([made.operations for made in shown], [max(made.error, floor) for made in shown], *style, **named)
        return shown

    for made in drawn(needs.alone, "o", color="0.6", label="one simplification"):
        place = made.operations, max(made.error, floor)
        label(ax, made.name, place, color="0.3")
    drawn(needs.ladder, "-D", color=ACCENT, markersize=5, drawstyle="steps", label="ladder: cheapest for its error")
    ax.axhline(needs.within, color="0.3", linestyle="--", linewidth=1.0, label=f"tolerance {needs.within:g}")
    drawn([needs.smallest], "*", color="tab:green", markersize=16, zorder=4, label=f"smallest: {needs.smallest.name}")
    ax.set(yscale="log", xlabel="operations per crank angle [1]", ylim=(floor / 2, 30))
    ax.set_ylabel(f"change of {needs.label}, relative to largest value [1]")
    ax.invert_xaxis()
    ax.margins(x=0.15)
    ax.legend(fontsize=7, loc="lower right")
    ax.grid(visible=True, alpha=0.3)
    return ax


def sweep_map(table, parameters, output, ax=None, labels=None):
    """One output of a sweep over the one or two parameters that it varies: a line, or a map in colours.

    Parameters
    ----------
    table : pandas.DataFrame
        From `sweep`; failed designs are left blank.
    parameters : sequence of str
        Columns of one or two parameters.
    output : str
        Column of the output.
    ax : Axes, optional
    labels : mapping of column to text, optional
        Texts of axes, with units; by default the headings as words.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5)
    >>> designs = ks.designs.grid({"slider.mass": "500..700 kg:3", "crank_length": "0.2..0.4 m:3"})
    >>> table = ks.sweep(saw, designs, ["largest O"], angles=90, progress=False)
    >>> ks.plots.sweep_map(table, list(designs), "largest O [N]").get_xlabel()
    'slider mass [kg]'
    """
    parameters = [parameters] if isinstance(parameters, str) else list(parameters or ())
    require_columns("sweep_map", table, (*parameters, output))
    if len(parameters) not in (1, 2) or len(set(parameters)) < len(parameters):
        raise ParameterError(f"sweep_map: one or two different parameters can be drawn, got {parameters}")
    ax = axes(ax)
    text = partial(_axis_text, labels or {})
    if len(parameters) == 1:
        (x,) = parameters
        ordered = table.sort_values(x)
        ax.plot(ordered[x], ordered[output], marker="." if len(table) < 100 else None, color=ACCENT)
        ax.set(xlabel=text(x), ylabel=text(output))
        ax.grid(visible=True, alpha=0.3)
        return ax
    x, y = parameters
    grid = table.pivot_table(index=y, columns=x, values=output, dropna=False)
    if grid.size == len(table):
        drawn = ax.pcolormesh(grid.columns, grid.index, grid.to_numpy(), shading="nearest", cmap="viridis")
    else:
        drawn = ax.scatter(table[x], table[y], c=table[output], s=8, cmap="viridis")
    ax.figure.colorbar(drawn, ax=ax, label=text(output))
    ax.set(xlabel=text(x), ylabel=text(y))
    return ax


def _axis_text(labels, column, width=40):
    """Text of an axis in lines of at most `width` letters."""
    return textwrap.fill(labels.get(column) or axis_words(column), width)


def sweep_page(table, parameters, outputs, path, labels=None):
    """Chart of a sweep saved to a file: a panel for each output, or a scatter matrix with three parameters and more."""
    if len(parameters) < 3:
        figure, axes = panels(len(outputs), 3, 5.4, 4.2)
        for ax, output in zip(axes, outputs, strict=True):
            sweep_map(table, parameters, output, ax=ax, labels=labels)
    else:
        figure = _scatter_matrix(table, [*parameters, *outputs], labels or {})
    return save_figure(figure, path, bbox_inches="tight")


def _scatter_matrix(table, columns, labels):
    from pandas.plotting import scatter_matrix

    shown = table[columns].dropna()
    shown = shown.sample(min(len(shown), 2000), random_state=0)
    shown = shown.rename(columns=lambda column: _axis_text(labels, column, 18))
    side = 1.9 * len(columns)
    marks: Any = {"s": 30 if len(shown) < 200 else 12, "alpha": 0.6, "color": ACCENT}
    grid: Any = scatter_matrix(shown, figsize=(side, side), hist_kwds={"color": "0.6"}, **marks)
    for ax in grid.flat:
        ax.xaxis.set_major_locator(MaxNLocator(3, prune="both"))
    for ax in grid[1:, 0]:
        ax.yaxis.set_major_locator(MaxNLocator(3, prune="both"))
    return grid[0, 0].figure


def precision_page(table, path):
    """Chart of a study, a panel for each variant and quantity, saved as PNG and SVG; returns the paths."""
    tables = {
        f"{part['case'].iloc[0]}, {variant}: {part['label'].iloc[0]}": part
        for (variant, _), part in table.groupby(["variant", "quantity"], sort=False)
    }
    return _draw_page(work_precision, tables, path)


def drive_page(tables, path):
    """Chart of studies of the drive, a panel for each of a mapping of title to table, saved as PNG and SVG."""
    import pandas as pd

    return _draw_page(partial(work_precision, like=pd.concat(tables.values())), tables, path)


def stability_page(table, path):
    """Chart of a stability study, a panel for each place, saved as PNG and SVG; returns the paths."""
    return _draw_page(error_by_distance, dict(list(table.groupby("place", sort=False))), path)


def _draw_page(draw, tables, path):
    """Panels by title, two in a row of a page's width, with one legend below."""
    figure, axes = panels(len(tables), 2, 8.4 / min(2, len(tables)), 3.4, 1.6)
    entries: dict[str, Any] = {}
    for ax, (title, part) in zip(axes, tables.items(), strict=True):
        draw(part, ax=ax)
        ax.set_title(title, fontsize=9)
        entries |= {text: handle for handle, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=2, fontsize=8)
    return [save_figure(figure, Path(f"{path}.{kind}"), Path(path).name) for kind in ("png", "svg")]

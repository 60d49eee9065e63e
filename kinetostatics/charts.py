"""Charts of the studies: error over time, error over the distance from where it hurts, error over the model's cost."""

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import rc_context

from .canvas import ACCENT, axes
from .files import written_whole
from .quantities import label

EXACT = 1e-17
"""Where an error of zero is drawn: below the rounding of the largest value."""
COLOURS = [colour for colour in plt.get_cmap("tab20").colors if colour[0] < 1.6 * max(colour[1:])]
"""Without reds, which are ours."""
MARKERS = "osD^v<>PX*phd"


def _styles(table):
    """How each method of a study is drawn, by name."""
    styles = {}
    for number, (name, ours) in enumerate(table.groupby("method", sort=False)["ours"].first().items()):
        styles[name] = {
            "marker": MARKERS[number % len(MARKERS)],
            "color": ACCENT if ours else COLOURS[number % len(COLOURS)],
            "markersize": 7 if ours else 4.5,
            "markeredgecolor": "0.15" if ours else "none",
            "linewidth": 1.6 if ours else 1.0,
            "zorder": 3 if ours else 2,
        }
    return styles


def work_precision(table, ax=None):
    """Error over time per crank angle, both logarithmic: a curve for each method with a setting, else a point.

    Parameters
    ----------
    table : pandas.DataFrame
        One quantity of one scene, from `precision.study`.
    ax : Axes, optional

    Returns
    -------
    Axes
    """
    ax = axes(ax)
    given = table.dropna(subset=["error"])
    for name, style in _styles(table).items():
        rows = given[given["method"] == name]
        if len(rows):
            setting = rows["setting"].iloc[0]
            text = f"{name} ({setting})" if setting else name
            ax.plot(rows["time [ns/angle]"], np.maximum(rows["error"], EXACT), label=text, **style)
    ax.set(xscale="log", yscale="log", ylim=(EXACT / 3, 30))
    ax.set_xlabel("time [ns per crank angle]")
    ax.set_ylabel("largest error over the turn, relative to largest value [1]")
    ax.grid(visible=True, which="major", alpha=0.3)
    return ax


def error_by_distance(table, ax=None):
    """Error of every method over the number that leads to a place, logarithmic; dashed: condition times rounding.

    Parameters
    ----------
    table : pandas.DataFrame
        One place, from `stability.study`.
    ax : Axes, optional

    Returns
    -------
    Axes
    """
    ax = axes(ax)
    for name, style in _styles(table).items():
        rows = table[(table["method"] == name) & table["error"].notna()]
        if len(rows):
            ax.plot(rows["number"], np.clip(rows["error"], EXACT, 1e3), label=name, **style)
    problem = table.drop_duplicates("number")
    ax.plot(
        problem["number"], np.clip(problem["condition"] * 2.0**-53, EXACT, 1e3), "k--", label="condition x rounding"
    )
    ax.set(xscale="log", yscale="log", ylim=(EXACT / 3, 3e3), xlabel=table["axis"].iloc[0])
    ax.set_ylabel(f"error of {label(table['quantity'].iloc[0])} [1]")
    ax.grid(visible=True, alpha=0.3)
    return ax


def model_ladder(needs, ax=None):
    """Error over operations: each simplification alone, and the ladder of the cheapest models; log scale.

    Parameters
    ----------
    needs : Needs
    ax : Axes, optional

    Returns
    -------
    Axes
    """
    ax = axes(ax)
    alone = [made for made in needs.alone if np.isfinite(made.error)]
    rungs = [made for made in needs.ladder if np.isfinite(made.error)]
    shown = [max(made.error, EXACT) for made in (*alone, *rungs)]
    ax.plot([made.operations for made in alone], shown[: len(alone)], "o", color="0.6", label="one simplification")
    ax.step(
        [made.operations for made in rungs],
        shown[len(alone) :],
        "-D",
        where="pre",
        color=ACCENT,
        markersize=5,
        label="model ladder: cheapest for its error",
    )
    ax.axhline(needs.within, color="0.3", linestyle="--", linewidth=1.0, label=f"tolerance {needs.within:g}")
    best = needs.smallest
    ax.plot(
        best.operations,
        max(best.error, EXACT),
        "*",
        color="tab:green",
        markersize=16,
        zorder=4,
        label=f"smallest: {best.name}",
    )
    for made, height in zip(alone, shown, strict=False):
        ax.annotate(made.name, (made.operations, height), xytext=(5, 3), textcoords="offset points", fontsize=7)
    ax.set(yscale="log", xlabel="operations per crank angle [1]", ylim=(EXACT / 3, 30))
    ax.set_ylabel(f"change of {label(needs.quantity)}, relative to largest value [1]")
    ax.invert_xaxis()
    ax.legend(fontsize=7, loc="lower left")
    ax.grid(visible=True, alpha=0.3)
    return ax


def precision_page(table, path):
    """Chart of a study, a panel for each variant and quantity, saved as PNG and SVG; returns the paths."""
    panels = {
        f"{part['case'].iloc[0]}, {variant}: {label(quantity)}": part
        for (variant, quantity), part in table.groupby(["variant", "quantity"], sort=False)
    }
    return _page(work_precision, panels, path)


def stability_page(table, path):
    """Chart of a stability study, a panel for each place, saved as PNG and SVG; returns the paths."""
    return _page(error_by_distance, dict(list(table.groupby("place", sort=False))), path)


def _page(draw, panels, path):
    """Panels by title, three in a row, with one legend below."""
    columns = min(3, len(panels))
    rows = -(-len(panels) // columns)
    size = (5.0 * max(columns, 2), 3.8 * rows + 1.6)
    figure, grid = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    entries = {}
    for ax, (title, part) in zip(grid.flat, panels.items(), strict=False):
        draw(part, ax=ax)
        ax.set_title(title, fontsize=9)
        entries |= {text: handle for handle, text in zip(*ax.get_legend_handles_labels(), strict=True)}
    for ax in grid.flat[len(panels) :]:
        ax.remove()
    figure.legend(entries.values(), entries.keys(), loc="outside lower center", ncols=3, fontsize=8)
    return _saved(figure, path)


def _saved(figure, path):
    """Figure as PNG and SVG beside each other; returns the paths."""
    paths = []
    for kind in ("png", "svg"):
        target = Path(f"{path}.{kind}")
        with rc_context({"svg.hashsalt": target.stem}), written_whole(target) as temporary:
            metadata = {"Date": None} if kind == "svg" else {}
            figure.savefig(temporary, format=kind, dpi=150, metadata=metadata)
        paths.append(target)
    plt.close(figure)
    return paths

"""Figures of friction: power lost by joint over the crank angle, and as bars of its means."""

from collections.abc import Mapping

import numpy as np

from ..numbers.checks import require
from .canvas import INK, axes, display, finished, labelled, single
from .peaks import with_peaks


def lost_power(solution, ax=None):
    """Power lost by friction over the crank angle, stacked by joint, its mean over the turn dashed.

    Parameters
    ----------
    solution : Solution
        With friction, of one design.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> friction = {"O": ks.PinFriction(0.02, 0.05), "guide": ks.GuideFriction(0.1)}
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, friction=friction).solve(90)
    >>> ks.plots.lost_power(s).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    solution = single(solution)
    _require_friction({"solution": solution})
    ax = axes(ax)
    lost = solution.losses
    drawn = with_peaks({"": solution}, lost.power, *lost.powers.values())[""]
    angle = np.degrees(drawn.crank_angle)
    powers = {name: np.broadcast_to(power(drawn), angle.shape) for name, power in lost.powers.items()}
    factor, unit = display("W", [np.sum(list(powers.values()), axis=0)])
    ax.stackplot(angle, *(factor * power for power in powers.values()), labels=list(powers), alpha=0.85, lw=0)
    ax.axhline(factor * lost.total, color=INK, ls="--", lw=1.0, label="mean")
    ax = finished(ax, f"power lost [{unit}]", legend=False, period=round(np.degrees(solution.period)))
    ax.set_ylim(0, 1.08 * ax.dataLim.ymax or 1.0)
    ax.legend(*_upside_down(ax), frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def losses(solutions, ax=None):
    """Mean power lost over the turn, a bar for each solution, stacked by joint, the sum on top.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With friction.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> friction = {"O": ks.PinFriction(0.02, 0.05), "guide": ks.GuideFriction(0.1)}
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, friction=friction).solve(90)
    >>> [text.get_text() for text in ks.plots.losses({"greased": s}).get_xticklabels()]
    ['greased']
    """
    named = labelled(solutions if isinstance(solutions, Mapping) else {"solution": solutions}, "lost power")
    _require_friction(named)
    ax = axes(ax)
    lost = {name: solution.losses for name, solution in named.items()}
    factor, unit = display("W", [np.array([item.total for item in lost.values()])])
    parts = list(dict.fromkeys(part for item in lost.values() for part in item.lost))
    places, bottom = np.arange(len(lost)), np.zeros(len(lost))
    for part in parts:
        height = factor * np.array([item.lost.get(part, 0.0) for item in lost.values()])
        ax.bar(places, height, 0.6, bottom=bottom, label=part, alpha=0.85)
        bottom = bottom + height
    for place, top in zip(places, bottom, strict=True):
        ax.annotate(f"{top:.3g}", (place, top), (0, 3), textcoords="offset points", ha="center", fontsize="small")
    slanted = max(map(len, lost)) * len(lost) > 45
    ax.set_xticks(places, list(lost), **({"rotation": 25, "ha": "right"} if slanted else {}))
    ax.set_ylabel(f"mean power lost [{unit}]")
    ax.set_xlim(-0.6, len(lost) - 0.4)
    ax.set_ylim(0, 1.12 * bottom.max() or 1.0)
    ax.grid(axis="y", alpha=0.3)
    ax.set_axisbelow(True)
    ax.legend(*_upside_down(ax), frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def _upside_down(ax):
    """Legend in the order in which parts are stacked."""
    return tuple(item[::-1] for item in ax.get_legend_handles_labels())


def _require_friction(named):
    without = [name for name, solution in named.items() if not solution.friction]
    require("plots", f"{', '.join(without)}: nothing rubs; give friction to solve or scene" if without else None)

"""Figure of a helical spring: Haigh diagram with the working point, and a drawing with dimensions."""

from typing import Any

import numpy as np

from ..numbers import checks
from ..sizing.springs import HelicalSpring
from .axis_units import with_units
from .canvas import ACCENT, INK, LOAD, STEEL

SMALL: dict[str, Any] = {"fontsize": "small"}
THIN = {"arrowstyle": "->", "lw": 0.8}
ROUND = np.linspace(0.0, 2.0 * np.pi, 33)
LABELS = ("d {:.4g}", "D {:.4g}", "{:.4g} free", "{:.4g} solid")
DIMENSION = {"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0, "color": INK, "lw": 0.8}


@with_units
def helical_spring(spring, ax=None):
    """Haigh diagram of a helical spring with its limits and its working point, beside a drawing with dimensions.

    Parameters
    ----------
    spring : HelicalSpring
        From ``ks.sizing.helical_spring`` or ``ks.sizing.spring_for``.
    ax : sequence of 2 Axes, optional

    Returns
    -------
    sequence of 2 Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> spring = ks.sizing.helical_spring(20e3, 0.02, preload=400.0)
    >>> haigh, drawing = ks.plots.helical_spring(spring)
    >>> haigh.get_xlabel()
    'mean stress [MPa]'
    """
    import matplotlib.pyplot as plt

    wrong = f"spring must be a HelicalSpring, as of ks.sizing.helical_spring, got {checks.shown(spring)}"
    few = None if ax is None or len(np.ravel(ax)) == 2 else f"ax must be 2 Axes, got {checks.shown(ax)}"
    checks.require("helical_spring", None if isinstance(spring, HelicalSpring) else wrong, few)
    if ax is None:
        ax = plt.subplots(1, 2, layout="constrained", figsize=(8.4, 4.2), width_ratios=(1.6, 1.0))[1]
    haigh, drawing = np.ravel(ax)
    mean, alternating = spring.mean_stress / 1e6, spring.alternating_stress / 1e6
    means = np.array([0.0, spring.endurance[0], spring.ultimate_stress])
    label = f"endless life, {'' if spring.peened else 'not '}peened"
    haigh.plot(means / 1e6, spring.alternating_limit(means) / 1e6, color=INK, label=label)
    ends = spring.set_stress / 1e6 * np.array([1.0, spring.stress(1.0, "Wahl") / spring.stress(1.0)])
    haigh.plot([0.0, ends[0]], [ends[1], 0.0], color=STEEL, ls="--", label="set")
    start, grown = spring.initial_stress / 1e6, spring.fatigue_safety
    haigh.plot([start, start + grown * (mean - start)], [0.0, grown * alternating], color=LOAD, ls=":")
    label = f"spring: safety {grown:.2f}, set {spring.static_safety:.2f}"
    haigh.plot(mean, alternating, "o", color=ACCENT, label=label)
    haigh.set(xlabel="mean stress [MPa]", ylabel="alternating stress [MPa]", xlim=0.0)
    haigh.set_ylim(0.0, 1.35 * max(spring.endurance[1] / 1e6, alternating))
    haigh.legend(frameon=False, fontsize="small", loc="upper right")
    sizes = [1e3 * getattr(spring, name) for name in ("wire_diameter", "coil_diameter", "free_length", "solid_length")]
    draw_spring(drawing, spring, [text.format(size) for text, size in zip(LABELS, sizes, strict=True)])
    title = f"{spring.springs} \N{MULTIPLICATION SIGN} {spring.active_turns:.3g} active turns, mm"
    drawing.set_title(title, fontsize="medium")
    return ax


def draw_spring(ax, spring, names):
    """A spring at its free length; names of wire and coil diameter, free and solid length."""
    wire, coil, turns = spring.wire_diameter, spring.coil_diameter, spring.active_turns
    free, solid, side = spring.free_length, spring.solid_length, 0.5 * (coil + wire)
    ends = np.array([0.0, 1.0, 1.0 + turns, 2.0 + turns])
    turn = np.linspace(0.0, ends[-1], 60 * int(np.ceil(ends[-1])))
    height = np.interp(turn, ends, (0.5 * wire, 1.5 * wire, free - 1.5 * wire, free - 0.5 * wire))
    across, front = 0.5 * coil * np.cos(2.0 * np.pi * turn), np.sin(2.0 * np.pi * turn) >= -1e-9
    for shown, colour in ((~front, "0.85"), (front, STEEL)):
        line = np.stack([height - 0.5 * wire, height + 0.5 * wire], axis=1)
        ax.plot(np.where(shown, across, np.nan), line, color=colour, lw=0.9)
    for place in np.arange(0.0, ends[-1] + 1e-9, 0.5):
        x, y = np.interp(place, turn, across), np.interp(place, turn, height)
        ax.fill(x + 0.5 * wire * np.cos(ROUND), y + 0.5 * wire * np.sin(ROUND), fc="white", ec=INK, lw=0.8)
    for x, top, place, name in ((side + 0.3 * coil, free, 0.8, names[2]), (side + 0.75 * coil, solid, 0.5, names[3])):
        ax.annotate("", (x, 0.0), (x, top), arrowprops=DIMENSION)
        ax.text(x - 0.03 * coil, place * top, name, rotation=90, ha="right", va="center", **SMALL)
        ax.plot([0.5 * coil, x], [top, top], color=INK, lw=0.5)
    below, tip = -0.1 * free, (-side, np.interp(np.floor(ends[-1] + 0.5) - 0.5, turn, height))
    ax.annotate("", (-0.5 * coil, below), (0.5 * coil, below), arrowprops=DIMENSION)
    ax.text(0.0, below, names[1], ha="center", va="bottom", **SMALL)
    ax.annotate(names[0], tip, (tip[0] - 0.2 * coil, tip[1]), ha="right", va="center", arrowprops=THIN, **SMALL)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    ax.axis("off")

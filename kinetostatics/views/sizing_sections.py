"""Figure of the forces inside a bar: envelopes along it, and stress over the turn."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..numbers import checks
from ..solution.sections import Sections
from .axis_units import with_units
from .canvas import ACCENT, FROM_X, INK, STEEL, display_unit

ANGLES = 720
"""Crank angles over the period of envelopes and stresses."""


@with_units
def sections(found, ax=None):
    """Axial force, shear force and bending moment along a bar, and its largest and smallest stress over the turn.

    Bands reach from the smallest to the largest value over the turn; each line is drawn at its worst crank angle.

    Parameters
    ----------
    found : Sections or BarStrength
        From `Solution.sections` or ``ks.sizing.bar_strength``.
    ax : sequence of 4 Axes, optional

    Returns
    -------
    sequence of 4 Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))
    >>> bar = ks.Bar(area=6e-3, modulus=3e-4, masses=[(1.0, 88.5)])
    >>> four = ks.plots.sections(ks.Scene(saw, 33.5).solve(4).sections("coupler", bar))
    >>> four[2].get_ylabel()
    'bending moment [kN m]'
    """
    import matplotlib.pyplot as plt

    found = getattr(found, "sections", found)
    wrong = f"found must be Sections, as of Solution.sections, got {checks.shown(found)}"
    four: Any = ax
    few = None if ax is None or len(np.ravel(ax)) == 4 else f"ax must be 4 Axes, got {checks.shown(ax)}"
    checks.require("sections", None if isinstance(found, Sections) else wrong, few)
    if ax is None:
        four = plt.subplots(4, 1, layout="constrained", figsize=(6.4, 8.0))[1]
    angle = np.linspace(0.0, found.solution.period, ANGLES + 1)
    whole = replace(found, solution=found.solution.moved_to(angle))
    axial = max(found.largest_tension, found.largest_compression)
    peaks = {"axial_force": axial, "shear_force": found.largest_shear, "bending_moment": found.largest_moment}
    for part, (name, worst) in zip(four, peaks.items(), strict=False):
        values = getattr(whole, name)
        factor, unit = display_unit("N m" if name == "bending_moment" else "N", [values])
        at = replace(found, solution=found.solution.moved_to(np.array([worst.angle])))
        ends = factor * values.min(axis=1), factor * values.max(axis=1)
        part.fill_between(found.x, *ends, color=STEEL, alpha=0.25, lw=0, label="over the turn")
        text = f"at {np.degrees(worst.angle):.1f}°, largest at {worst.x:.3g} m"
        part.plot(found.x, factor * getattr(at, name)[:, 0], color=ACCENT, label=text)
        part.set(xlabel="distance from the first pin [m]", ylabel=f"{name.replace('_', ' ')} [{unit}]")
    bar = found.bar
    stress = np.array([whole.axial_force / bar.area + side * whole.bending_moment / bar.modulus for side in (1, -1)])
    for values, style, text in ((stress.max(axis=(0, 1)), "-", "largest"), (stress.min(axis=(0, 1)), "--", "smallest")):
        four[3].plot(np.degrees(angle), values / 1e6, color=INK, ls=style, label=f"{text} in the bar")
    four[3].set(xlabel=FROM_X.axis, ylabel="stress [MPa]", xticks=np.linspace(0.0, np.degrees(angle[-1]), 7))
    for part in four:
        part.axhline(0.0, color=INK, lw=0.5)
        part.margins(x=0.0)
        part.legend(frameon=False, fontsize="small", loc="lower left", bbox_to_anchor=(0.0, 0.97), ncols=2)
    return four

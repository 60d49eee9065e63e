"""Figures of what a search found: cam, torque and support reaction before and after, and fronts.

Figures of designs: fronts of two outputs.
"""

from functools import partial
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from ..design.pareto import Front
from ..numbers import checks
from ..numbers.files import unwritable
from ..numbers.formatting import parted
from .canvas import ACCENT, INK, axes, closed, display, finished, readable, styled
from .curves import hodograph, torque
from .drawings import mechanism
from .figures import saved


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


POINTS = 720


def draw_designs(case, found, folder, file_format="png"):
    """Draw what designs of a case found, by name, into a folder, a page for each; returns the paths."""
    paths = {name: Path(folder) / f"{case.path.stem}_{name}.{file_format}" for name in found}
    checks.require("figures", *dict.fromkeys(unwritable(path, inputs=case.files) for path in paths.values()))
    pages = {
        name: partial(front_page if isinstance(item, Front) else before_and_after, item) for name, item in found.items()
    }
    return [saved(lambda _, draw=pages[name]: draw(), {}, path, case, file_format) for name, path in paths.items()]


def before_and_after(found):
    """Before and after a search: cam, torque, support reaction.

    Parameters
    ----------
    found : Found
        As `ks.design.torque_free_cam` and `ks.design.optimise` return it.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> found = ks.design.torque_free_cam(ks.load_case("sawframe_2r63"), cosine=2, gravity=False)
    >>> figure = ks.plots.before_and_after(found)
    >>> len(figure.axes)
    6
    """
    scenes = {"before": found.before, "after": found.scene}
    solutions = {name: scene.solve(POINTS) for name, scene in scenes.items()}
    cams = {name: cam for name, scene in scenes.items() if (cam := cam_of(scene)) is not None}
    upper = ["cam", "torque", "torque after"] if cams else ["torque", "torque", "torque after"]
    rows: Any = [upper, ["radius" if cams else "mechanism", *scenes]]
    figure, parts = plt.subplot_mosaic(rows, figsize=(11.5, 6.8), layout="constrained")
    if cams:
        pitch_curves(cams, ax=parts["cam"])
        parts["cam"].set_title("pitch curve of the cam")
        cam_radius(cams, ax=parts["radius"])
        parts["radius"].set_title("its distance from O, over the turn")
    else:
        mechanism(solutions["after"], ax=parts["mechanism"])
        parts["mechanism"].set_title("after")
    torque(solutions, ax=parts["torque"])
    torque({"after": solutions["after"]}, ax=parts["torque after"])
    parts["torque"].set_title("torque the drive must give")
    parts["torque after"].set_title("after alone")
    for name, solution in solutions.items():
        hodograph(solution, ax=parts[name], marks=45)
        parts[name].set_title(f"support reaction, {name}")
    return figure


def front_page(found):
    figure, ax = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    front(found, ax=ax)
    return figure


def cam_of(scene):
    """First cam of a scene that is fixed to the frame; None without one."""
    return next((group.cam for group in scene.mechanism.led_by_ground), None)


def pitch_curves(cams, ax=None):
    """Pitch curves of cams by label, around O."""
    ax = axes(ax)
    angle = np.linspace(0.0, 2 * np.pi, POINTS, endpoint=False)
    for name, cam, style in styled(cams):
        radius = cam.radius(angle)[0]
        ax.plot(*closed(1e3 * radius * np.array([np.cos(angle), np.sin(angle)])), linestyle=style, label=name)
    ax.plot(0.0, 0.0, "k+", ms=8)
    ax.annotate("O", (0.0, 0.0), xytext=(4, 4), textcoords="offset points")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="x [mm]", ylabel="y [mm]")
    ax.legend(frameon=False, fontsize="small", loc="center", bbox_to_anchor=(0.5, 0.3))
    return ax


def cam_radius(cams, ax=None):
    """Distance of pitch curves from O over the crank angle, by label."""
    ax = axes(ax)
    angle = np.linspace(0.0, 2 * np.pi, POINTS + 1)
    curves = [1e3 * cam.radius(angle)[0] for cam in cams.values()]
    for (name, _, style), curve in zip(styled(cams), curves, strict=True):
        ax.plot(np.degrees(angle), curve, linestyle=style, label=name)
    finished(ax, "radius [mm]", len(cams) > 1)
    ax.lines[-1].remove()  # the line at zero, far below
    low, high = min(map(np.min, curves)), max(map(np.max, curves))
    ax.set_ylim(low - 0.08 * (high - low), high + 0.25 * (high - low))
    return ax

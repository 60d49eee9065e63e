"""Figures saved to files: of a case (`kinetostatics plot`), of its drive, and of designs before and after a search.

`FIGURES` lists the figures of a case by name, with the condition for each.
"""

import textwrap
from functools import cache, partial
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

import matplotlib.pyplot as plt
import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from ..casefile import reading
from ..cycle.losses import lose
from ..design.pareto_front import Front
from ..errors import ParameterError
from ..mechanics.quantities import of_mechanism
from ..numbers import checks
from ..numbers.files import write_problem
from ..numbers.formatting import parse_heading
from ..numbers.paths import places_by_path
from . import curves, drawings, drives
from .axis_units import scale_axes, with_units
from .cams import draw_each_over_turn
from .canvas import (
    ACCENT,
    FROM_X,
    FROM_Y_CLOCKWISE,
    INK,
    axes,
    axis_words,
    close_curve,
    display_unit,
    distinct_curves,
    finish_axes,
    grouped,
    panels,
    save_figure,
    with_line_styles,
)
from .curves import torque
from .drawings import mechanism
from .hodographs import hodograph
from .mass_centres import mass_centres
from .sketches import sketch
from .strokes import load_strokes, moves_alike

FONT: Any = {"font.size": 9}


def draw_case(case, folder, file_format="png", only=None, progress=iter):
    """Draw the figures of a case into a folder, each of the variants compared with one reference; returns the paths.

    `only` names a single figure, `progress` iterates over the names of the figures while they are drawn. The folder is
    created if missing; each file, "png" or "svg", is written whole or not at all. `ParameterError` if the figure is
    unknown, with the known names, or if the files cannot be written.
    """
    checks.require("figures", checks.case("case", case))
    figures = figures_of(case)
    unknown = (checks.choice("published.figures", name, tuple(FIGURES)) for name in case.published.figures)
    reading.require(case.path, *unknown)
    problem = checks.choice("figure", only, figures) if only else None
    if problem:
        raise ParameterError(problem)
    counted = FROM_Y_CLOCKWISE if _is_chain_unit(case) else FROM_X

    solve = cache(case.solve)

    def page(name, reference):
        shown = [reference, *case.comparisons[reference]]
        figure = figures[name]({variant: solve(variant) for variant in shown}, counted)
        if reference == case.reference and (number := case.published.figures.get(name)):
            text = f"figure{'s' * (',' in number)} {number} of the study"
            figure.text(0.995, 0.995, text, ha="right", va="top", fontsize="small")
            figure.get_layout_engine().set(rect=(0, 0, 1, 0.96))
        return figure

    pages = {
        name if reference == case.reference else f"{reference}_{name}": partial(page, name, reference)
        for reference, compared in case.comparisons.items()
        for name in figures_of(case, [reference, *compared])
        if only in (None, name)
    }
    return _draw_pages(case, pages, folder, file_format, progress)


def draw_drive(case, runs, folder):
    """Draw speed, torques and energy flow of a case's variants in periodic running into a folder; returns the paths."""
    bars = len(drives.energy_parts(runs)) * (1 + len(runs))
    pages = {
        "drive_speed": partial(_one_axes, drives.crank_speed, runs),
        "drive_torque": partial(_one_each, drives.drive_torques, runs, width=6.4, height=3.2, columns=1),
        "drive_energy": partial(_one_axes, drives.energy_flow, runs, 7.2, 1.2 + 0.19 * bars),
    }
    return _draw_pages(case, pages, folder, "png")


def _draw_pages(case, pages, folder, file_format, progress=iter):
    """Draw pages by name into files named after the case; returns the paths."""
    paths = {name: Path(folder) / f"{case.path.stem}_{name}.{file_format}" for name in pages}
    checks.require("figures", *dict.fromkeys(write_problem(path, inputs=case.files) for path in paths.values()))
    found = []
    for name in progress(paths):
        with rc_context(FONT):
            figure = pages[name]()
            scale_axes(figure.axes)
            found.append(save_figure(figure, paths[name], case.path.stem))
    return found


def _is_chain_unit(case):
    return all(item.table.mechanism == "chain-unit" for item in case.variants.values())


def figures_of(case, names=None):
    """Functions that draw the figures of a case, by name; those of `FIGURES` that apply to some variant."""
    variants = list(map(case.variant, case.variants if names is None else names))
    found = {name for item in variants for name in of_mechanism(item.mechanism)}
    cams = {getattr(getattr(item.table, "cam", None), "kind", None) for item in variants}
    if "cosine-law" in cams and all(item.mechanism.slider is not None for item in variants):
        found.add("cosine law")
    if any(map(lose, variants)):
        found.add("friction")
    if any(item.balanced is not None for item in variants):
        found.add("balanced")
    if _is_chain_unit(case):
        found.add("chain unit")
    return {name: draw for name, (draw, needed) in FIGURES.items() if needed is None or needed in found}


def _with_friction(solutions):
    return {name: solution for name, solution in solutions.items() if lose(solution)}


def _one_axes(plot, shown, width=6.4, height=4.0, **axes) -> Figure:
    """A figure with one plot of all given items."""
    figure, ax = plt.subplots(figsize=(width, height), layout="constrained", subplot_kw=axes)
    plot(shown, ax=ax)
    return figure


def _page_of(plot, *size, **axes):
    """Function that draws a plot as a page, with the plot's own convention for crank angles."""
    return lambda solutions, _: _one_axes(plot, solutions, *size, **axes)


def _over_turn(quantity):
    def draw(solutions, counted):
        having = {name: item for name, item in solutions.items() if quantity in of_mechanism(item.mechanism)}
        return _one_axes(partial(curves.over_turn, quantity=quantity, counted=counted), having)

    return draw


def _hodographs(solutions, counted=FROM_X) -> Figure:
    """Hodographs of the support reaction; coincident ones share a panel."""
    reactions = {name: solution.reaction("O") for name, solution in solutions.items()}
    shown = {text: solutions[name] for text, name in distinct_curves(reactions, apart=True).items()}
    return _one_each(partial(hodograph, counted=counted), shown, 5.2, 4.6, 2)


def _one_each(plot, solutions, width=4.4, height=4.2, columns=3) -> Figure:
    """A figure with axes for each variant."""
    figure, axes = panels(len(solutions), columns, width, height)
    for ax, (name, solution) in zip(axes, solutions.items(), strict=True):
        plot(solution, ax=ax)
        ax.set_title(textwrap.fill(name, round(LETTERS_PER_INCH * width), break_on_hyphens=False))
    return figure


PROPORTIONS: WeakKeyDictionary[Any, float] = WeakKeyDictionary()


def _proportion(solution):
    """Width of the drawing of a mechanism over its height."""
    if solution not in PROPORTIONS:
        size = drawings.mechanism(solution, ax=Figure().subplots()).dataLim
        PROPORTIONS[solution] = float(np.clip(size.width / size.height, 0.4, 4.0)) if size.height > 0 else 4.0
    return PROPORTIONS[solution]


def _mechanisms(solutions, counted=FROM_X) -> Figure:
    """Mechanisms of all variants; equal ones are drawn once. Wide ones are stacked, others side by side."""
    alike = grouped(solutions, lambda name, other: moves_alike(solutions[name], solutions[other]))
    shown = {", ".join(group): {name: solutions[name] for name in group} for group in alike}
    wide = max(map(_proportion, solutions.values()))
    width = 8.0 if wide > WIDE_RATIO else max(3.2, min(5.2, 5.5 * wide))
    plot = partial(drawings.mechanism, angles=counted.from_x(DRAWN_ANGLES), counted=counted)
    return _one_each(plot, shown, width, width / wide + TITLE_HEIGHT, 1 if wide > WIDE_RATIO else 2)


def _sketches(solutions, _) -> Figure:
    """Dimensioned sketches of all variants; those with the same numbers share one."""
    numbers = {name: _numbers_of(solution.mechanism) for name, solution in solutions.items()}
    alike = grouped(solutions, lambda name, other: numbers[name] == numbers[other])
    wide = max(map(_proportion, solutions.values()))
    height = float(np.clip(7.0 / wide, 2.4, 5.6)) + TITLE_HEIGHT
    return _one_each(sketch, {", ".join(group): solutions[group[0]] for group in alike}, 7.0, height, 1)


def _numbers_of(mechanism):
    return {path: float(np.ravel(place.value(mechanism))[0]) for path, place in places_by_path(mechanism).items()}


DRAWN_ANGLES = (40.0, 160.0, 280.0)
"""Crank angles at which mechanisms are drawn, degrees."""
WIDE_RATIO = 1.7
"""Width over height above which a mechanism is drawn across the page."""
LETTERS_PER_INCH = 9
"""Letters of a title over an inch of its axes."""
TITLE_HEIGHT = 0.8
"""Height of title and labels of axes, inches."""


def _overview(solutions, counted=FROM_X) -> Figure:
    """The variant with most loads, the torques of all, and the support reactions of the first and the last.

    A wide mechanism is drawn across the page, a tall one over the whole height, others beside the torque.
    """
    shown = list(dict.fromkeys([next(iter(solutions)), next(reversed(solutions))]))
    strokes = {name: len(load_strokes(solution, DRAWN_ANGLES[:1])) for name, solution in solutions.items()}
    drawn = max(reversed(strokes), key=strokes.__getitem__)  # the last of several
    wide = _proportion(solutions[drawn])
    many = len(shown)
    rows: list[Any] = [["mechanism", "torque"], shown]
    widths = heights = None
    if wide > 1.5 * WIDE_RATIO:
        rows, heights = [["mechanism"] * (1 + many), ["torque", *shown]], [0.8, 1.0]
    elif wide < 1 / WIDE_RATIO or many == 1:
        left = float(np.clip(5.4 * wide + TITLE_HEIGHT, 2.0, 4.0))
        rows = [["mechanism", *["torque"] * many], ["mechanism", *shown]]
        widths = [left, *[(11.0 - left) / many] * many]
    figure, axes = plt.subplot_mosaic(
        rows, figsize=(11, 6.4), layout="constrained", width_ratios=widths, height_ratios=heights
    )
    drawings.mechanism(solutions[drawn], angles=counted.from_x(DRAWN_ANGLES), ax=axes["mechanism"], counted=counted)
    axes["mechanism"].set_title(f"{drawn}: {solutions[drawn].mechanism.name}")
    curves.torque(solutions, ax=axes["torque"], counted=counted)
    axes["torque"].set_title("torque the drive must give")
    for name in shown:
        hodograph(solutions[name], ax=axes[name], marks=45, counted=counted)
        axes[name].set_title(f"support reaction, {name}")
    return figure


FIGURES = {
    "overview": (_overview, None),
    "mechanism": (_mechanisms, None),
    "sketch": (_sketches, None),
    "torque": (_over_turn("balancing_torque"), None),
    "acceleration_error": (_page_of(curves.acceleration_error), "cosine law"),
    "hodograph": (_hodographs, None),
    "pressure_angle": (_over_turn("pressure_angle"), "pressure_angle"),
    "cam_force": (_over_turn("cam_force"), "cam_force"),
    "losses": (lambda solutions, _: _one_axes(drives.losses, _with_friction(solutions)), "friction"),
    "lost_power": (
        lambda solutions, _: _one_each(drives.lost_power, _with_friction(solutions), 6.4, 3.2, 1),
        "friction",
    ),
    "mass_centres": (_page_of(mass_centres, 9.0, 3.6), "balanced"),
    "shaking_by_direction": (_page_of(curves.shaking_force, 6.4, 4.8, projection="polar"), "balanced"),
    "shaking_by_crank_angle": (
        _page_of(partial(curves.shaking_force, by="crank angle"), 6.4, 4.8, projection="polar"),
        "balanced",
    ),
    **{
        f"{link}_{kind}": (_page_of(partial(curves.chain_unit_motion, link=link, order=order)), "chain unit")
        for link in ("coupler", "rocker")
        for order, kind in enumerate(("velocity", "acceleration"), 1)
    },
}
"""By name: the function that draws a figure, and the condition for it in `figures_of`."""


@with_units
def front(found, ax=None):
    """Pareto front of two outputs by `ks.design.pareto`, and the design before.

    Parameters
    ----------
    found : design.Front

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
    outputs = []
    for column, before in zip(found.table.columns, found.before, strict=False):
        name, unit = parse_heading(column)
        values = found.table[column].to_numpy()
        factor, shown = display_unit(unit, [values])
        outputs.append((values * factor, before * factor, axis_words(f"{name} [{shown or '1'}]")))
    (y, y_before, y_label), (x, x_before, x_label) = outputs
    ax.plot(x, y, "o-", color=INK, label="best designs")
    ax.plot(x_before, y_before, "x", color=ACCENT, label="before")
    ax.set(ylabel=y_label, xlabel=x_label)
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax


ANGLES_PER_TURN = 720


def draw_designs(case, found, folder, file_format="png"):
    """Draw results of a case's designs by name into a folder, a page each; returns the paths."""
    pages: dict[str, Any] = {}
    for name, item in found.items():
        if isinstance(item, Front):
            pages[name] = partial(_one_axes, front, item, 6.4, 4.4)
        else:
            alone = {f"{name}-{duty}": item.duty(duty) for duty in item.shares} or {name: item}
            pages |= {page: partial(before_and_after, own) for page, own in alone.items()}
    return _draw_pages(case, pages, folder, file_format)


@with_units
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
    solutions = {name: scene.solve(ANGLES_PER_TURN) for name, scene in scenes.items()}
    cams = {name: group.cam for name, scene in scenes.items() for group in scene.mechanism.led_by_ground[:1]}
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


def pitch_curves(cams, ax=None):
    """Pitch curves of cams by label, around O."""
    ax = axes(ax)
    angle = np.linspace(0.0, 2 * np.pi, ANGLES_PER_TURN, endpoint=False)
    for name, cam, style in with_line_styles(cams):
        radius = cam.radius(angle)[0]
        ax.plot(*close_curve(1e3 * radius * np.array([np.cos(angle), np.sin(angle)])), linestyle=style, label=name)
    ax.plot(0.0, 0.0, "k+", ms=8)
    ax.annotate("O", (0.0, 0.0), xytext=(4, 4), textcoords="offset points")
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="x [mm]", ylabel="y [mm]")
    ax.legend(frameon=False, fontsize="small", loc="center", bbox_to_anchor=(0.5, 0.3))
    return ax


def cam_radius(cams, ax=None):
    """Distance of pitch curves from O over the crank angle, by label."""
    ax = axes(ax)
    draw_each_over_turn(ax, cams, lambda cam, angle: 1e3 * cam.radius(angle)[0], ANGLES_PER_TURN)
    low, high = ax.dataLim.intervaly
    finish_axes(ax, "radius [mm]", len(cams) > 1)
    ax.lines[-1].remove()  # the line at zero, far below
    ax.set_ylim(low - 0.08 * (high - low), high + 0.25 * (high - low))
    return ax

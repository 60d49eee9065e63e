"""Figures of sized parts: bearing, joint with play, mounted machine, forces inside a bar, helical spring."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..machine.group import FRAME
from ..machine.loads import TURN
from ..sizing.bearings import Bearing
from ..sizing.foundation import WAYS, Mount
from ..sizing.play import ContactLoss
from ..sizing.springs import HelicalSpring
from ..solution.sections import Sections
from .axis_units import with_units
from .canvas import (
    ACCENT,
    FROM_X,
    INK,
    LOAD,
    STEEL,
    axes,
    close_curve,
    display_unit,
    finish_axes,
    panels,
    require_kind,
    several_axes,
)
from .hodographs import write_angles

BEARING_ANGLES, MARKS = 1440, 8
"""Crank angles over the period of a bearing's load, and those written at hodographs."""


@with_units
def bearing(found):
    r"""Hodographs of the load on each ring of a bearing in the ring's axes, and its size with the equivalent load.

    A roller has no hodograph, because its rotation does not repeat.

    Parameters
    ----------
    found : Bearing
        As of `ks.sizing.bearing`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> saw = ks.load_case("sawframe_2r63").solve("plain", 4)
    >>> figure = ks.plots.bearing(ks.sizing.bearing(saw, "A", capacity=600e3, static_capacity=1e6))
    >>> figure.axes[1].get_title()
    'on the crank:\npoint load'
    """
    require_kind("bearing", found, Bearing, "found must be a Bearing, as of ks.sizing.bearing")
    at = found.solution.moved_to(np.linspace(0.0, found.solution.period, BEARING_ANGLES, endpoint=False))
    curves = zip(found.pin.rings, found.pin.in_rings(at), strict=True)
    rings = {ring: curve for ring, curve in curves if np.isfinite(curve).all()}
    load = np.hypot(*found.pin.load(at))
    factor, unit = display_unit("N", [load])
    figure, (*polar, over) = panels(len(rings) + 1, 3, 4.2, 3.8)
    for ax, (ring, curve) in zip(polar, rings.items(), strict=True):
        ax.plot(*close_curve(factor * curve), color=STEEL)
        rows = range(0, BEARING_ANGLES, BEARING_ANGLES // MARKS)
        ax.plot(*factor * curve[:, rows], "o", ms=3, color=ACCENT)
        write_angles(ax, at, factor * curve, [*rows], 0.08 * factor * np.ptp(curve, axis=1).max(), FROM_X, INK)
        ways = ("x", "y") if ring == FRAME else (f"along the {ring}", "to its left")
        title = f"on the {ring}:\n{found.ring_loads.get(ring, 'no')} load"
        ax.set(xlabel=f"{ways[0]} [{unit}]", ylabel=f"{ways[1]} [{unit}]", title=title)
        ax.plot(0.0, 0.0, "+", ms=10, color=INK)
        ax.set_aspect("equal", adjustable="datalim")
        ax.margins(0.15)
        ax.grid(alpha=0.3)
    degrees = np.degrees(np.append(at.crank_angle, found.solution.period))
    over.plot(degrees, factor * np.append(load, load[0]), color=STEEL, label="|F|")
    over.axhline(factor * found.equivalent_load, color=ACCENT, ls="--", label="equivalent load P")
    over.set(title=f"load at {found.pin.name} over the turn")
    finish_axes(over, f"load [{unit}]", True, round(degrees[-1]))
    over.set_ylim(bottom=0.0)
    return figure


LARGEST_SHOWN = 1.3
"""Limit of the force axis over the largest force without play: beyond it the pendulum does not describe the journal."""
LARGEST_INDEX = 10.0
"""Limit of the index axis."""
NAMED = 0.33
"""Energy of an impact, relative to the largest, above which it is written."""


@with_units
def contact_loss(result, ax=None):
    """Force without play and normal force with it over the crank angle; the index on a second axis.

    Bands show flights of the journal through its play, with the energy of the impact; dotted lines show where the force
    passes through zero.

    Parameters
    ----------
    result : ContactLoss

    Examples
    --------
    >>> import warnings
    >>> import kinetostatics as ks
    >>> with warnings.catch_warnings(action="ignore"):
    ...     found = ks.sizing.contact_loss(ks.load_case("sawframe_2r63").solve("cam-circle", 8), "O", clearance=1e-4)
    >>> ks.plots.contact_loss(found).get_title()
    'joint O: index infinite, largest impact 1.9 J'
    """
    require_kind("contact_loss", result, ContactLoss, "result must be a ContactLoss of ks.sizing")
    ax, degrees = axes(ax), np.degrees(result.angle)
    factor, unit = display_unit("N", [result.force])
    ax.plot(degrees, factor * result.force, color=STEEL, ls="--", label="|F| without play")
    ax.plot(degrees, factor * result.normal, color=INK, label="normal force N")
    ax.axhline(0.0, color=INK, lw=0.6)
    largest = LARGEST_SHOWN * factor * result.force.max()
    ax.set_ylim(max(-0.6 * largest, min(0.0, 1.1 * factor * result.normal.min())), largest)
    for flight in result.flights:
        ends = np.degrees([flight.start, flight.stop])
        for turns in (-1.0, 0.0, 1.0):  # a flight may pass the end of the period
            ax.axvspan(*(ends + turns * np.degrees(result.period)), color=ACCENT, alpha=0.25, lw=0)
        if flight.energy > NAMED * result.impact_energy:
            period, at_top = np.degrees(result.period), ax.get_xaxis_transform()
            place = np.clip(np.mod(ends.mean(), period), 0.05 * period, 0.95 * period)  # clear of the frame
            paper = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.0}
            ax.text(place, 0.97, f"{flight.energy:.2g} J", ha="center", va="top", transform=at_top, bbox=paper)
    for angle in np.degrees(result.reversals):
        ax.axvline(angle, color=ACCENT, lw=0.8, ls=":")
    ax.set(xlim=(0.0, np.degrees(result.period)), xlabel=FROM_X.axis, ylabel=f"force [{unit}]")
    ax.set_xticks(np.linspace(0.0, np.degrees(result.period), 5))
    beside = ax.twinx()
    beside.plot(degrees, result.index_curve, color=LOAD, lw=1.0)
    beside.set_ylim(0.0, min(LARGEST_INDEX, 1.3 * max(1.0, result.index)))
    beside.set_ylabel("index [1]", color=LOAD)
    index = f"{result.index:.2f}" if np.isfinite(result.index) else "infinite"
    ax.set_title(f"joint {result.joint}: index {index}, largest impact {result.impact_energy:.2g} J", pad=22.0)
    ax.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.5, 0.99), ncols=2)
    return ax


@with_units
def mount(result):
    """Velocity of a block's centre over the turn, and loads by harmonic, a row for each direction that moves.

    Bars show the load on a fixed frame, and the load of springs and dampers on the ground.

    Parameters
    ----------
    result : Mount
        As of `ks.sizing.mount`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.solve(ks.crank_slider(0.05, 0.16, slider=ks.Link(1.5)), 0.0, crank_speed=75.4)
    >>> figure = ks.plots.mount(ks.sizing.mount(pump, mass=75.0, stiffness=220e3, damping=0.02))
    >>> [ax.get_ylabel() for ax in figure.axes]
    ['velocity, x [mm/s]', 'amplitude, x [N]']
    """
    require_kind("mount", result, Mount, "result must be a Mount, as of ks.sizing.mount")
    order, angle = result.order, np.linspace(0.0, TURN / result.order[0], 721)
    curves = np.real(1j * order * result.crank_speed * result.displacement @ np.exp(1j * np.outer(order, angle)))
    moving = [way for way, curve in zip(WAYS, curves, strict=True) if np.any(curve)] or ["x"]
    figure, grid = panels(2 * len(moving), 2, 4.6, 2.8)
    for way, over, bars in zip(moving, grid[::2], grid[1::2], strict=True):
        unit, load = WAYS[way]
        over.plot(np.degrees(angle), 1e3 * curves[list(WAYS).index(way)], color=ACCENT, label="velocity")
        over.axhline(1e3 * getattr(result, f"v_rms_{way}"), color=INK, lw=0.8, ls=":", label="rms")
        finish_axes(over, f"velocity, {way} [m{unit}/s]", True, round(np.degrees(angle[-1])))
        table = result.harmonics(way).iloc[:8]
        factor, shown = display_unit(load, [table["force"].to_numpy()])
        loads = factor * table[["force", "ground"]].set_axis([f"{order:g}" for order in table.index])
        words = {"xlabel": "harmonic of the crank", "ylabel": f"amplitude, {way} [{shown}]"}
        loads.plot.bar(ax=bars, color=[STEEL, ACCENT], width=0.8, rot=0, **words)
        bars.legend(["on a fixed frame", "on the ground"], frameon=False, fontsize="small")
    return figure


SECTION_ANGLES = 720
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
    found = getattr(found, "sections", found)
    require_kind("sections", found, Sections, "found must be Sections, as of Solution.sections")
    four: Any = several_axes("sections", ax, 4, 1, (6.4, 8.0))
    angle = np.linspace(0.0, found.solution.period, SECTION_ANGLES + 1)
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


SMALL: dict[str, Any] = {"fontsize": "small"}
THIN = {"arrowstyle": "->", "lw": 0.8}
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 33)
LABELS = ("d {:.4g}", "D {:.4g}", "{:.4g} free", "{:.4g} solid")
DIMENSION_ARROW = {"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0, "color": INK, "lw": 0.8}


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
    wanted = "spring must be a HelicalSpring, as of ks.sizing.helical_spring"
    require_kind("helical_spring", spring, HelicalSpring, wanted)
    ax = several_axes("helical_spring", ax, 1, 2, (8.4, 4.2), width_ratios=(1.6, 1.0))
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
        ax.fill(x + 0.5 * wire * np.cos(CIRCLE), y + 0.5 * wire * np.sin(CIRCLE), fc="white", ec=INK, lw=0.8)
    for x, top, place, name in ((side + 0.3 * coil, free, 0.8, names[2]), (side + 0.75 * coil, solid, 0.5, names[3])):
        ax.annotate("", (x, 0.0), (x, top), arrowprops=DIMENSION_ARROW)
        ax.text(x - 0.03 * coil, place * top, name, rotation=90, ha="right", va="center", **SMALL)
        ax.plot([0.5 * coil, x], [top, top], color=INK, lw=0.5)
    below, tip = -0.1 * free, (-side, np.interp(np.floor(ends[-1] + 0.5) - 0.5, turn, height))
    ax.annotate("", (-0.5 * coil, below), (0.5 * coil, below), arrowprops=DIMENSION_ARROW)
    ax.text(0.0, below, names[1], ha="center", va="bottom", **SMALL)
    ax.annotate(names[0], tip, (tip[0] - 0.2 * coil, tip[1]), ha="right", va="center", arrowprops=THIN, **SMALL)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.1)
    ax.axis("off")

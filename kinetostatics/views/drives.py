"""Figures of drives and friction: crank speed, torques and energy flow in periodic running; power lost by joint."""

from collections.abc import Mapping

import numpy as np

from ..drive.running import Running
from ..numbers import checks
from ..numbers.checks import require
from .axis_units import one_panel_each, with_units
from .canvas import (
    FROM_X,
    INK,
    axes,
    display_unit,
    finish_axes,
    single_solution,
    solutions_by_label,
    with_line_styles,
    with_peaks,
)


@with_units
def crank_speed(runs, ax=None):
    """Crank speed of machines in periodic running over the crank angle, its mean dotted.

    A start or a coast is a `Trajectory`, not a `Running`: draw its `speed` over its `time`.

    Parameters
    ----------
    runs : Running or mapping of label to Running
        As of `ks.drive.steady`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> runs = {f"{inertia} kg m2": ks.drive.steady(pump, motor, flywheel=inertia) for inertia in (0.05, 0.2)}
    >>> ks.plots.crank_speed(runs).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    runs, ax = _runs_by_label(runs, "crank speed"), axes(ax)
    factor, unit = display_unit("rad/s", [run.speed for run in runs.values()])
    for name, run, style in with_line_styles(runs):
        (line,) = ax.plot(*_closed_curve(run, factor * run.speed), linestyle=style, label=name)
        ax.axhline(factor * run.mean_speed, color=line.get_color(), lw=0.8, ls=":")
    ax.plot([], [], color=INK, lw=0.8, ls=":", label="mean over time")
    ax.set_ylabel(f"crank speed [{unit}]")
    return _finish(ax, runs.values())


@with_units
@one_panel_each(6.4, 3.6)
def drive_torques(run, ax=None):
    """Torques at the crank over the crank angle: motor, machine with inertia, loads only.

    Parameters
    ----------
    run : Running or mapping of label to Running
        As of `ks.drive.steady`; several get a panel each.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> ks.plots.drive_torques(ks.drive.steady(pump, motor, flywheel=0.05)).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    _runs_by_label({"run": run}, "run")
    ax = axes(ax)
    ratio = 1.0 if run.motor is None else run.motor.transmission
    curves = {
        "motor": ratio * run.motor_torque,
        "machine, with its inertia": run.crank_torque,
        "loads alone": run.solution.load_torque,
    }
    factor, unit = display_unit("N m", curves.values())
    for name, values, style in with_line_styles(curves):
        ax.plot(*_closed_curve(run, factor * values), linestyle=style, label=name)
    ax.set_ylabel(f"torque at the crank [{unit}]")
    ax.margins(y=0.2)  # room for the legend
    _finish(ax, [run]).legend(loc="upper center", ncols=3, frameon=False, fontsize="small", columnspacing=1.0)
    return ax


@with_units
def energy_flow(runs, ax=None):
    """Energy per turn of machines in periodic running, a bar for each part that supplies or absorbs energy.

    Parameters
    ----------
    runs : Running or mapping of label to Running
        As of `ks.drive.steady`.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> runs = {f"{inertia} kg m2": ks.drive.steady(pump, motor, flywheel=inertia) for inertia in (0.05, 0.2)}
    >>> ks.plots.energy_flow(runs).get_xlabel().split("[")[0]
    'energy per turn '
    """
    runs, ax = _runs_by_label(runs, "run"), axes(ax)
    shown = energy_parts(runs)
    flows = [{part.name: part.energy for part in run.energy_flow.parts} for run in runs.values()]
    energies = np.array([[flow.get(part, 0.0) for part in shown] for flow in flows])
    factor, unit = display_unit("J", [energies])
    height = 0.8 / len(runs)
    for row, (name, values) in enumerate(zip(runs, factor * energies, strict=True)):
        places = np.arange(len(shown)) + (row - 0.5 * (len(runs) - 1)) * height
        bars = ax.barh(places, values, 0.92 * height, label=name)
        ax.bar_label(bars, [f"{value:.4g}" if value else "" for value in values], padding=3, fontsize="small")
    ax.set_yticks(range(len(shown)), shown)
    ax.invert_yaxis()
    ax.axvline(0.0, color=INK, lw=0.8)
    ax.set_xlabel(f"energy per turn [{unit}]")
    ax.margins(x=0.14)
    ax.grid(axis="x", alpha=0.3)
    ax.set_axisbelow(True)
    if len(runs) > 1:
        ax.legend(frameon=False, fontsize="small")
    return ax


def energy_parts(runs):
    """Names of the parts that supply or absorb energy in any of the runs, in order."""
    parts = {part.name: None for run in runs.values() for part in run.energy_flow.parts}
    moving = {part.name for run in runs.values() for part in run.energy_flow.parts if part.energy}
    return [name for name in parts if name in moving]


def _runs_by_label(runs, name):
    """The mapping of label to Running, or a single one by a name; an error for anything else."""
    wanted = 'runs must be a Running or a dict of label to Running, as {"saw": ks.drive.steady(scene, motor)}'
    named = runs if isinstance(runs, Mapping) else {name: runs}
    wrong = [run for run in named.values() if not isinstance(run, Running)]
    checks.require("plots", f"{wanted}, got {checks.shown((wrong or [runs])[0])}" if wrong or not named else None)
    return named


def _closed_curve(run, values):
    """Crank angles in degrees and values, with the first value repeated at the end of the period."""
    return np.degrees(np.append(run.crank_angle, run.period)), np.append(values, values[0])


def _finish(ax, runs):
    period = round(np.degrees(max(run.period for run in runs)))
    ax.set_xlabel(FROM_X.axis)
    ax.set_xticks(range(0, period + 1, period // 4))
    ax.margins(x=0)
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax


@with_units
@one_panel_each(6.4, 3.2)
def lost_power(solution, ax=None):
    """Power lost over the crank angle, stacked by joint, damper and drag, its mean over the turn dashed.

    Parameters
    ----------
    solution : Solution or mapping of label to Solution
        With friction, a damper or drag; of one design. Several get a panel each.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> friction = {"O": ks.PinFriction(0.02, 0.05), "guide": ks.GuideFriction(0.1)}
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, friction=friction).solve(90)
    >>> ks.plots.lost_power(s).get_xlabel()
    'crank angle from +x, counter-clockwise [deg]'
    """
    solution = single_solution(solution)
    _require_losses({"solution": solution})
    ax = axes(ax)
    lost = solution.losses
    drawn = with_peaks({"": solution}, lost.power, *lost.powers.values())[""]
    angle = np.degrees(drawn.crank_angle)
    powers = {name: np.broadcast_to(power(drawn), angle.shape) for name, power in lost.powers.items()}
    factor, unit = display_unit("W", [np.sum(list(powers.values()), axis=0)])
    ax.stackplot(angle, *(factor * power for power in powers.values()), labels=list(powers), alpha=0.85, lw=0)
    ax.axhline(factor * lost.total, color=INK, ls="--", lw=1.0, label="mean")
    ax = finish_axes(ax, f"power lost [{unit}]", legend=False, period=round(np.degrees(solution.period)))
    ax.set_ylim(0, 1.08 * ax.dataLim.ymax or 1.0)
    return _with_stack_legend(ax)


@with_units
def losses(solutions, ax=None):
    """Mean power lost over the turn, a bar for each solution, stacked by joint, damper and drag, with the sum on top.

    Parameters
    ----------
    solutions : Solution or mapping of label to Solution
        With friction, dampers or drag.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> friction = {"O": ks.PinFriction(0.02, 0.05), "guide": ks.GuideFriction(0.1)}
    >>> s = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600)), 33.5, friction=friction).solve(90)
    >>> [text.get_text() for text in ks.plots.losses({"greased": s}).get_xticklabels()]
    ['greased']
    """
    several = isinstance(solutions, Mapping)
    named = solutions_by_label(solutions if several else {"": solutions}, "lost power")
    _require_losses(named)
    ax = axes(ax)
    lost = {name: solution.losses for name, solution in named.items()}
    factor, unit = display_unit("W", [np.array([item.total for item in lost.values()])])
    parts = list(dict.fromkeys(part for item in lost.values() for part in item.lost))
    places, bottom = np.arange(len(lost)), np.zeros(len(lost))
    for part in parts:
        height = factor * np.array([item.lost.get(part, 0.0) for item in lost.values()])
        ax.bar(places, height, 0.6, bottom=bottom, label=part, alpha=0.85)
        bottom = bottom + height
    for place, top in zip(places, bottom, strict=True):
        ax.annotate(f"{top:.3g}", (place, top), (0, 3), textcoords="offset points", ha="center", fontsize="small")
    slanted = max(map(len, lost)) * len(lost) > 45
    texts = list(lost) if several else [""]
    ax.set_xticks(places, texts, **({"rotation": 25, "ha": "right"} if slanted else {}))
    ax.set_ylabel(f"mean power lost [{unit}]")
    ax.set_xlim(-0.6, len(lost) - 0.4)
    ax.set_ylim(0, 1.12 * bottom.max() or 1.0)
    ax.grid(axis="y", alpha=0.3)
    ax.set_axisbelow(True)
    return _with_stack_legend(ax)


def _with_stack_legend(ax):
    """The axes with a legend beside them, its entries in the order of the stack, from the top."""
    handles, texts = (item[::-1] for item in ax.get_legend_handles_labels())
    ax.legend(handles, texts, frameon=False, fontsize="small", loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def _require_losses(named):
    without = [name for name, solution in named.items() if not solution.losses.lost]
    remedy = "no friction is given; give friction to solve or scene, or a damper or drag among the loads"
    require("plots", f"{', '.join(without)}: {remedy}" if without else None)

"""Figures of machines in periodic running: speed, torque of the motor against that of the loads, where energy goes."""

from collections.abc import Mapping

import numpy as np

from ..drive.running import Running
from ..numbers import checks
from .canvas import INK, axes, display, styled


def crank_speed(runs, ax=None):
    """Crank speed of machines in periodic running over the crank angle, its mean dotted.

    Parameters
    ----------
    runs : mapping of label to Running
        As of `ks.drive.steady`.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> runs = {f"{inertia} kg m2": ks.drive.steady(pump, motor, flywheel=inertia) for inertia in (0.05, 0.2)}
    >>> ks.plots.crank_speed(runs).get_xlabel()
    'crank angle [deg]'
    """
    _require_running(runs)
    ax = axes(ax)
    for name, run, style in styled(runs):
        (line,) = ax.plot(*_closed(run, run.speed), linestyle=style, label=name)
        ax.axhline(run.mean_speed, color=line.get_color(), lw=0.8, ls=":")
    ax.set_ylabel("crank speed [rad/s]")
    return _finished(ax)


def drive_torques(run, ax=None):
    """Torques at the crank over the crank angle: of the motor, of the machine with its inertia, of the loads alone.

    Parameters
    ----------
    run : Running
        As of `ks.drive.steady`.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> ks.plots.drive_torques(ks.drive.steady(pump, motor, flywheel=0.05)).get_xlabel()
    'crank angle [deg]'
    """
    _require_running({"run": run})
    ax = axes(ax)
    ratio = 1.0 if run.motor is None else run.motor.transmission
    curves = {
        "motor": ratio * run.motor_torque,
        "machine, with its inertia": run.crank_torque,
        "loads alone": run.solution.load_torque,
    }
    factor, unit = display("N m", curves.values())
    for name, values, style in styled(curves):
        ax.plot(*_closed(run, factor * values), linestyle=style, label=name)
    ax.set_ylabel(f"torque at the crank [{unit}]")
    ax.margins(y=0.2)  # room for the legend
    _finished(ax).legend(loc="upper center", ncols=3, frameon=False, fontsize="small", columnspacing=1.0)
    return ax


def energy_flow(runs, ax=None):
    """Energy per turn of machines in periodic running, a bar for each part that gives or takes any.

    Parameters
    ----------
    runs : mapping of label to Running
        As of `ks.drive.steady`.
    ax : Axes, optional

    Returns
    -------
    Axes

    Examples
    --------
    >>> import kinetostatics as ks
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=ks.ProcessForce(-200.0))
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> runs = {f"{inertia} kg m2": ks.drive.steady(pump, motor, flywheel=inertia) for inertia in (0.05, 0.2)}
    >>> ks.plots.energy_flow(runs).get_xlabel().split("[")[0]
    'energy per turn '
    """
    _require_running(runs)
    ax = axes(ax)
    shown = parts_that_move_energy(runs)
    flows = {name: {part.name: part.energy for part in run.energy_flow.parts} for name, run in runs.items()}
    energies = {name: [flow.get(part, 0.0) for part in shown] for name, flow in flows.items()}
    largest = max((abs(value) for values in energies.values() for value in values), default=0.0)
    factor, unit = (1e-3, "kJ") if largest >= 1e4 else (1.0, "J")
    height = 0.8 / len(flows)
    for row, name in enumerate(flows):
        values = [factor * value for value in energies[name]]
        places = np.arange(len(shown)) + (row - 0.5 * (len(flows) - 1)) * height
        bars = ax.barh(places, values, 0.92 * height, label=name)
        ax.bar_label(bars, [f"{value:.4g}" if value else "" for value in values], padding=3, fontsize="small")
    ax.set_yticks(range(len(shown)), shown)
    ax.invert_yaxis()
    ax.axvline(0.0, color=INK, lw=0.8)
    ax.set_xlabel(f"energy per turn [{unit}]")
    ax.margins(x=0.14)
    ax.grid(axis="x", alpha=0.3)
    ax.set_axisbelow(True)
    if len(flows) > 1:
        ax.legend(frameon=False, fontsize="small")
    return ax


def parts_that_move_energy(runs):
    """Names of the parts that give or take energy in a turn of any of the runs, in order."""
    parts = {part.name: None for run in runs.values() for part in run.energy_flow.parts}
    moving = {part.name for run in runs.values() for part in run.energy_flow.parts if part.energy}
    return [name for name in parts if name in moving]


def _require_running(runs):
    """Refuse what is no mapping of label to Running."""
    wanted = 'runs must be a dict of label to Running, as {"saw": ks.drive.steady(scene, motor)}'
    several = isinstance(runs, Mapping) and runs
    wrong = [name for name, run in runs.items() if not isinstance(run, Running)] if several else []
    given = f"{checks.shown(runs[wrong[0]])} for {wrong[0]!r}" if wrong else checks.shown(runs)
    checks.require("plots", None if several and not wrong else f"{wanted}, got {given}")


def _closed(run, values):
    """Crank angles in degrees and values, the first again at the end of the period."""
    return np.degrees(np.append(run.crank_angle, run.period)), np.append(values, values[0])


def _finished(ax):
    ax.set_xlabel("crank angle [deg]")
    ax.margins(x=0)
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax

"""Figures of machines in periodic running: speed, and torque of the motor against that of the loads."""

import numpy as np

from .canvas import axes, display, styled


def speed(runs, ax=None):
    """Crank speed over the crank angle, its mean dotted; of a mapping of label to Running."""
    ax = axes(ax)
    for name, run, style in styled(runs):
        (line,) = ax.plot(*_closed(run, run.speed), linestyle=style, label=name)
        ax.axhline(run.mean_speed, color=line.get_color(), lw=0.8, ls=":")
    ax.set_ylabel("crank speed [rad/s]")
    return _finished(ax)


def torques(run, ax=None):
    """Torques at the crank over the crank angle: of the motor, of the machine with its inertia, of the loads alone."""
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
    return _finished(ax)


def _closed(run, values):
    """Crank angles in degrees and values, the first again at the end of the period."""
    return np.degrees(np.append(run.crank_angle, run.period)), np.append(values, values[0])


def _finished(ax):
    ax.set_xlabel("crank angle [deg]")
    ax.margins(x=0)
    ax.grid(alpha=0.3)
    ax.legend(frameon=False, fontsize="small")
    return ax

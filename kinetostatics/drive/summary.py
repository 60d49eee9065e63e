"""What running comes to, in tables: speeds, fluctuation, powers, losses, start-up; and where the energy goes."""

import math

from .energy_flow import HELD, ROTOR

OFF = 1.5
"""Times by which the speed under a motor may be off that of the scene before a word is said of it."""


def summary(runs, starts):
    """Table with a column for each machine, a pandas DataFrame, its rows with their units.

    Parameters
    ----------
    runs : mapping of label to Running
    starts : mapping of label to Trajectory or None
        From rest, None where a machine does not start.
    """
    columns = {name: _rows(run, starts[name]) for name, run in runs.items()}
    return _table(columns)


def energy_table(runs):
    """Where the energy of a turn goes, a pandas DataFrame with a column for each of a mapping of label to Running."""
    columns = {
        name: {
            (f"{part.name}, largest less smallest" if part.kind == HELD else part.name, "J"): (
                part.swing if part.kind == HELD else part.energy
            )
            for part in run.energy_flow.parts
        }
        for name, run in runs.items()
    }
    return _table(columns)


def mistaken_speed(run, scene):
    """What is told of a machine whose motor turns it much faster or slower than its scene says; None otherwise."""
    meant, mean = abs(float(scene.crank_speed)), abs(run.mean_speed)
    if meant == 0.0 or meant / OFF <= mean <= meant * OFF:
        return None
    return (
        f"the motor turns the crank at {mean:.6g} rad/s, but the crank speed given is {meant:.6g} rad/s: is the "
        f"transmission of the motor, {run.motor.transmission:.6g}, right?"
    )


def _table(columns):
    """Values by what they are and their unit, of each column, in one table with NaN for what a column lacks."""
    import pandas as pd

    rows = {row: None for column in columns.values() for row in column}
    table = pd.DataFrame({"unit": [unit for _, unit in rows]}, index=[row for row, _ in rows])
    return table.assign(**{name: [column.get(row, math.nan) for row in rows] for name, column in columns.items()})


def _rows(run, start):
    """Values by what they are and their unit."""
    low, high = run.speed_range
    low_angle, high_angle = map(math.degrees, run.speed_range_angles)
    rows = {
        ("mean speed of the crank", "rad/s"): run.mean_speed,
        ("smallest speed", "rad/s"): low,
        ("crank angle of the smallest", "deg"): low_angle,
        ("largest speed", "rad/s"): high,
        ("crank angle of the largest", "deg"): high_angle,
        ("fluctuation, by the mean over time", ""): run.fluctuation,
        ("fluctuation, by the mean of the extremes", ""): run.fluctuation_arithmetic,
        ("mean motor power", "W"): run.mean_power,
        ("rms motor power", "W"): run.rms_power,
        ("peak motor power", "W"): run.peak_power,
        ("peak motor torque, at its shaft", "N m"): run.peak_motor_torque,
        ("rms motor torque, at its shaft", "N m"): run.rms_motor_torque,
        ("energy per turn, at the shaft", "J"): run.energy_per_turn,
    }
    flow = run.energy_flow
    if run.has_air_gap:
        rows["lost in the rotor by slip, mean", "W"] = flow[ROTOR] / flow.turn_time
    if run.scene.friction.acting:
        rows["lost by friction, mean", "W"] = run.mean_friction_loss
        rows |= {
            (f"lost by friction at {joint}, mean", "W"): run.mean_friction_loss_at(joint)
            for joint in run.scene.friction
        }
    if start is not None:
        angle = math.degrees(start.crank_angle[0])
        rows[f"start-up time from crank angle {angle + 0.0:.6g} deg", "s"] = float(start.time[-1])
    return rows

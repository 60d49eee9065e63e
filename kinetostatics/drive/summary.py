"""What running comes to, in one table: speeds, fluctuation, powers, energies, start-up."""

import math

from .motor import Kloss


def summary(runs, starts):
    """Table with a column for each machine, a pandas DataFrame, its rows with their units.

    Parameters
    ----------
    runs : mapping of label to Running
    starts : mapping of label to Trajectory or None
        From rest, None where a machine does not start.
    """
    import pandas as pd

    columns = {name: _rows(run, starts[name]) for name, run in runs.items()}
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
        ("energy per turn, at the shaft", "J"): run.energy_per_turn,
    }
    if run.scene.friction.acting:
        rows["lost by friction, mean", "W"] = run.mean_friction_loss
        rows |= {
            (f"lost by friction at {joint}, mean", "W"): run.mean_friction_loss_at(joint)
            for joint in run.scene.friction
        }
    if isinstance(run.motor, Kloss):
        rows["lost in the rotor per turn, by slip", "J"] = run.rotor_loss_per_turn
    if start is not None:
        rows["start-up time from crank angle 0", "s"] = float(start.time[-1])
    return rows

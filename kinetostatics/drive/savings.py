"""Figures of periodic running in tables: speeds, fluctuation, powers, losses, start-up, and energies of a turn.

`DrivenComparison` compares two machines under their motors: the effect of balancing, or of another flywheel.
"""

import math
from dataclasses import dataclass

import numpy as np

from ..cycle.comparison import Comparison
from ..numbers import checks
from ..numbers.output_units import output_units
from .energy_flow import HELD, ROTOR

DRIVE_FIGURES = {
    "energy per turn, at the shaft": ("energy_per_turn", "J"),
    "energy per turn, through the air gap": ("air_gap_energy_per_turn", "J"),
    "lost in the rotor per turn, by slip": ("rotor_loss_per_turn", "J"),
    "mean motor torque, on the crank": ("mean_torque", "N m"),
    "mean motor power": ("mean_power", "W"),
    "peak motor power": ("peak_power", "W"),
    "peak motor torque, at its shaft": ("peak_motor_torque", "N m"),
    "rms motor torque, at its shaft": ("rms_motor_torque", "N m"),
    "mean speed of the crank": ("mean_speed", "rad/s"),
    "fluctuation, by the mean over time": ("fluctuation", "1"),
    "fluctuation, by the mean of the extremes": ("fluctuation_arithmetic", "1"),
}
"""Attributes of `Running` and their units, by their titles in tables."""
AIR_GAP_FIGURES = ("air_gap_energy_per_turn", "rotor_loss_per_turn")


def _of_drives(name, text):
    """Property of both machines' figure, with its docstring."""
    return property(lambda self: self.of_drives(name), doc=text)


@dataclass(frozen=True, eq=False)
class DrivenComparison(Comparison):
    """Dynamic coefficients of two machines in periodic running and figures of their drives; `compare` returns them.

    Examples
    --------
    >>> import kinetostatics as ks
    >>> work = ks.ProcessForce(ks.Table([0.15, 0.25], [-200.0, -200.0], over="travel", back=[0.0, 0.0]))
    >>> pump = ks.Scene(ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0)), 100.0, loads=work)
    >>> motor = ks.drive.Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    >>> light, heavy = (ks.drive.steady(pump, motor, flywheel=inertia) for inertia in (0.05, 0.5))
    >>> found = ks.compare(light, heavy)  # effect of a larger flywheel on the motor
    >>> [round(torque, 2) for torque in found.peak_motor_torques]
    [5.61, 3.42]
    """

    def of_drives(self, name):
        """A figure of both machines' `Running` by its name, as "rotor_loss_per_turn"; NaN if there is none."""
        runs = self.reference.running, self.balanced.running
        return tuple(np.nan if name in AIR_GAP_FIGURES and not run.has_air_gap else getattr(run, name) for run in runs)

    energies_per_turn = _of_drives("energy_per_turn", "Energy at the motor's shaft in a turn, J.")
    air_gap_energies_per_turn = _of_drives(
        "air_gap_energy_per_turn", "Energy through the air gap of induction motors in a turn, J."
    )
    rotor_losses_per_turn = _of_drives(
        "rotor_loss_per_turn", "Energy lost in the rotors of induction motors by slip in a turn, J."
    )
    peak_motor_torques = _of_drives("peak_motor_torque", "Largest torque at the motor's shaft, with its sign, N m.")
    rms_motor_torques = _of_drives(
        "rms_motor_torque", "Root of the mean over time of the square of the motor's torque, N m."
    )
    fluctuations = _of_drives("fluctuation", "Coefficients of fluctuation by the mean over time.")
    fluctuations_arithmetic = _of_drives(
        "fluctuation_arithmetic", "Coefficients of fluctuation by the mean of largest and smallest speed."
    )

    def flywheels(self, fluctuation=None):
        """Flywheels on the crank with which both have the same coefficient of fluctuation, kg m2.

        Parameters
        ----------
        fluctuation : float, optional
            Default: that of the reference with its own flywheel.
        """
        runs = self.reference.running, self.balanced.running
        wanted = runs[0].fluctuation if fluctuation is None else fluctuation
        return tuple(
            run.crank_flywheel if fluctuation is None and run is runs[0] else run.flywheel_for(wanted) for run in runs
        )

    def flywheel_mass_saved(self, radius, fluctuation=None):
        """Rim mass that the balanced machine saves for the same fluctuation, kg; negative if it needs more.

        Parameters
        ----------
        radius : float
            Radius of the rim, m.
        fluctuation : float, optional
            As for `flywheels`.
        """
        rule = checks.Number("m", low=0.0, strict=True)
        radius = checks.check_values("flywheel_mass_saved", {"radius": rule}, {"radius": radius})["radius"]
        reference, balanced = self.flywheels(fluctuation)
        return (reference - balanced) / radius**2

    def drive_frame(self, fluctuation=None):
        """Figures of both drives, a pandas DataFrame: quantity, unit, value of each machine, ratio, difference."""
        import pandas as pd

        figures = {(text, unit): self.of_drives(name) for text, (name, unit) in DRIVE_FIGURES.items()}
        figures["flywheel for the same fluctuation", "kg m2"] = self.flywheels(fluctuation)
        rows = [
            (text, unit, *pair, _ratio(*map(abs, pair)), abs(pair[0]) - abs(pair[1]))
            for (text, unit), pair in figures.items()
        ]
        columns = ["quantity", "unit", *self.names, "ratio", "saved"]
        return pd.DataFrame(rows, columns=columns).set_index("quantity").dropna(how="all", subset=list(self.names))

    def frame(self, units=None):
        """All coefficients as a pandas DataFrame, those of the drives after those of the mechanisms.

        `units` is a dict of dimension to unit as of `in_units`.
        """
        import pandas as pd

        of_drives = output_units(units, "frame").table(self.drive_frame().drop(columns="saved"))
        return pd.concat([super().frame(units), of_drives])


def _ratio(reference, balanced):
    return reference / balanced if balanced else (np.inf if reference else np.nan)


MAX_SPEED_RATIO = 1.5
"""Ratio of running speed and scene speed beyond which a hint follows."""


def running_table(runs, starts):
    """Table of `Running` and start from rest, None where there is none, by label: a pandas DataFrame with units."""
    return _table({name: _running_rows(run, starts[name]) for name, run in runs.items()})


def energy_table(runs):
    """Energies of a turn, a pandas DataFrame with a column for each entry of a mapping of label to Running."""
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


def speed_hint(run, scene):
    """Hint that the motor turns the crank much faster or slower than the scene's crank speed, or None."""
    meant, mean = abs(float(scene.crank_speed)), abs(run.mean_speed)
    if meant == 0.0 or meant / MAX_SPEED_RATIO <= mean <= meant * MAX_SPEED_RATIO:
        return None
    return (
        f"the motor turns the crank at {mean:.6g} rad/s, but the given crank speed is {meant:.6g} rad/s: is the "
        f"transmission of the motor, {run.motor.transmission:.6g}, right?"
    )


def _table(columns):
    """Table of columns {(title, unit): value}; NaN where a column lacks a row."""
    import pandas as pd

    rows = {row: None for column in columns.values() for row in column}
    table = pd.DataFrame({"unit": [unit for _, unit in rows]}, index=[row for row, _ in rows])
    return table.assign(**{name: [column.get(row, math.nan) for row in rows] for name, column in columns.items()})


def _running_rows(run, start):
    """Values by title and unit."""
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
        ("mean motor torque, on the crank", "N m"): run.mean_torque,
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

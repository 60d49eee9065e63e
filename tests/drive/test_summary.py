"""What running comes to: a column for each machine, NaN where one has no such number."""

import math

import pytest

import kinetostatics as ks
from kinetostatics.drive.summary import mistaken_speed, summary
from support.drives import DISC_MOTOR, PUMP

KLOSS = ks.drive.Motor.kloss(5e3, 150.0, synchronous_speed=157.0, overload=2.5, transmission=5.0)


def test_machines_stand_side_by_side_with_units():
    scene = ks.Scene(PUMP, 1.0, loads=(ks.Gravity(), ks.Torque(-40.0, on="crank")))
    runs = {"line": ks.drive.steady(scene, DISC_MOTOR, 5.0), "Kloss": ks.drive.steady(scene, KLOSS, 5.0)}
    table = summary(runs, {"line": None, "Kloss": ks.drive.start(scene, KLOSS, 5.0)})
    assert list(table) == ["unit", "line", "Kloss"]
    for name, run in runs.items():
        assert table.loc["mean speed of the crank", name] == run.mean_speed
        assert table.loc["energy per turn, at the shaft", name] == pytest.approx(2 * math.pi * 40.0, rel=1e-9)
    assert table.loc["mean motor power", "unit"] == "W"
    for row in ("lost in the rotor by slip, mean", "start-up time from crank angle 0 deg"):
        assert math.isnan(table.loc[row, "line"])
        assert table.loc[row, "Kloss"] > 0.0


def test_a_motor_without_its_transmission_is_told():
    """At 157 rad/s on the crank of a scene that says 1; with the transmission there is nothing to say."""
    for transmission, told in ((1.0, True), (150.0, False)):
        motor = ks.drive.Motor.kloss(5e3, 150.0, synchronous_speed=157.0, overload=2.5, transmission=transmission)
        scene = ks.Scene(PUMP, 1.0, loads=(ks.Torque(-4.0, on="crank"),))
        found = mistaken_speed(ks.drive.steady(scene, motor, 50.0), scene)
        assert (found is not None and "transmission of the motor, 1, right?" in found) == told

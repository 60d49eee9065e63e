"""The command ``drive``: running, energy and start-up, for people and for other programs."""

import json

import numpy as np
import pandas as pd
import pytest

import kinetostatics as ks
from kinetostatics.cli import main
from support.commands import printed_by

pytestmark = pytest.mark.slow

PUMP = """
title = "Pump"
reference = "pump"
[common]
mechanism = "crank-slider"
crank_speed = "100 rad/s"
crank_length = "5 cm"
coupler_length = "20 cm"
slider = { mass = "1 kg" }
[common.drive]
motor = { kind = "kloss", power = "750 W", speed = "99 rad/s", synchronous_speed = "104.7 rad/s", overload = 2.5 }
flywheel = "0.05 kg m^2"
[variants.pump]
[variants.sprung.spring]
stiffness = "20 kN/m"
free_position = "25 cm"
[variants.overloaded]
loads = [{ kind = "torque", value = "-50 N m", on = "crank" }]
"""


@pytest.fixture
def pump(tmp_path):
    path = tmp_path / "pump.toml"
    path.write_text(PUMP)
    return path


def test_drive_prints_running_and_start_or_reasons(pump, capsys):
    printed = printed_by(["drive", str(pump)], capsys)
    rows = {line.split("  ")[0]: line.split() for line in printed.splitlines()}
    variant = ks.load_case(pump).variants["pump"]
    run = ks.drive.steady(variant.scene, variant.motor, variant.flywheel)
    begun = ks.drive.start(variant.scene, variant.motor, variant.flywheel)
    assert rows["mean speed of the crank"][-2] == f"{run.mean_speed:.6g}"
    assert rows["smallest speed"][-2] == f"{run.speed_range[0]:.6g}"
    at = np.radians(float(rows["crank angle of the smallest"][-2]))
    assert run.motion(np.array([at]))[0][0] == pytest.approx(run.speed_range[0], rel=1e-9)
    assert rows["start-up time from crank angle 0 deg"][-1] == f"{begun.time[-1]:.6g}"  # the other does not start
    assert "sprung: crank-slider: it starts and stops after" in printed
    assert "overloaded: crank-slider: the motor is too weak" in printed


def test_drive_writes_a_table_and_figures_with_units(pump, tmp_path, capsys):
    folder = tmp_path / "drive"
    assert main(["drive", str(pump), "--variant", "pump", "--out", str(folder)]) == 0
    names = ["pump_drive.csv", "pump_drive_energy.png", "pump_drive_speed.png", "pump_drive_torque.png"]
    assert sorted(path.name for path in folder.iterdir()) == names
    table = pd.read_csv(folder / "pump_drive.csv")
    assert len(table) == 720
    assert {"variant", "crank_speed [rad/s]", "motor_torque [N m]", "motor_power [W]"} <= set(table.columns)
    printed = capsys.readouterr().out
    assert all(str(folder / name) in printed for name in names)


def test_drive_starts_from_angle_and_shows_energy(pump, capsys):
    printed = printed_by(["drive", str(pump), "--variant", "pump", "--start", "40 deg"], capsys)
    variant = ks.load_case(pump).variants["pump"]
    begun = ks.drive.start(variant.scene, variant.motor, variant.flywheel, np.radians(40.0))
    flow = ks.drive.steady(variant.scene, variant.motor, variant.flywheel).energy_flow
    rows = {line.split("  ")[0]: line.split() for line in printed.splitlines()}
    assert rows["start-up time from crank angle 40 deg"][-1] == f"{begun.time[-1]:.6g}"
    for part in flow.parts:
        name, value = (
            (part.name, part.energy)
            if part.swing != part.swing
            else (f"{part.name}, largest less smallest", part.swing)
        )
        assert rows[name][-1] == f"{value:.6g}"
    lost = flow["rotor, by slip"] / flow.turn_time
    assert float(rows["lost in the rotor by slip, mean"][-1]) == pytest.approx(lost, rel=1e-5)


def test_drive_says_why_nothing_runs(pump, capsys):
    for case, variant, message in (
        (str(pump), "overloaded", "N m are missing"),
        (str(pump), "pomp", "did you mean 'pump'?"),
        ("shaper", None, "has no drive for "),
    ):
        assert main(["drive", case, *(["--variant", variant] if variant else [])]) == 2
        printed = capsys.readouterr()
        assert message in printed.err
        assert not printed.out


def test_json_has_running_numbers_and_reasons(pump, capsys):
    assert main(["drive", str(pump), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    variant = ks.load_case(pump).variants["pump"]
    run = ks.drive.steady(variant.scene, variant.motor, variant.flywheel)
    assert found["running"]["mean speed of the crank"] == {"unit": "rad/s", "pump": run.mean_speed, "sprung": None} | {
        "sprung": found["running"]["mean speed of the crank"]["sprung"]
    }
    energies = {part.name: part.energy for part in run.energy_flow.parts}
    assert found["energy_per_turn"]["rotor, by slip"]["pump"] == energies["rotor, by slip"]
    assert set(found["reasons"]) == {"sprung", "overloaded"}


def test_csv_has_a_row_for_each_quantity(pump, capsys):
    assert main(["drive", str(pump), "--variant", "pump", "--csv"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "table,quantity,unit,pump"
    assert {line.split(",")[0] for line in lines[1:]} == {"running", "energy_per_turn"}

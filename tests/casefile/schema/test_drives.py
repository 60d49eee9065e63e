"""Drives of case files: the motors and flywheels of Python, in text with units, and nothing else changed by them."""

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import case_file, problems, shipped

PUMP = """
title = "pump"
reference = "pump"
[common]
mechanism = "crank-slider"
crank_speed = "100 rad/s"
crank_length = "5 cm"
coupler_length = "20 cm"
slider = { mass = "1 kg" }
process_force = { force = "-200 N" }
"""
KLOSS = """
[common.drive]
motor = { kind = "kloss", power = "0.75 kW", speed = "99 rad/s", synchronous_speed = "104.7 rad/s", overload = 2.5 }
flywheel = "500 kg cm^2"
"""
RPM = np.pi / 30
Motor = ks.drive.Motor
MOTORS = {
    'kind = "kloss", power = "55 kW", speed = "1475 rpm", synchronous_speed = "1500 rpm", overload = 2.5, '
    'transmission = -4, inertia = "0.3 kg m^2"': Motor.kloss(
        55e3, 1475 * RPM, synchronous_speed=1500 * RPM, overload=2.5, transmission=-4.0, inertia=0.3
    ),
    'kind = "linear", torque = "10 N m", speed = "100 rad/s"': Motor.linear(10.0, 100.0),
    'kind = "constant", torque = "-0.01 kN m"': Motor.constant(-10.0),
    'kind = "table", speed = ["0 rad/s", "50 rad/s", "60 rad/s"], torque = ["30 N m", "40 N m", "0 N m"]': Motor.table(
        [0.0, 50.0, 60.0], [30.0, 40.0, 0.0]
    ),
}


@pytest.mark.parametrize(("text", "motor"), MOTORS.items(), ids=lambda item: getattr(item, "kind", type(item).__name__))
def test_each_kind_of_motor_is_that_of_python(tmp_path, text, motor):
    path = case_file(tmp_path, f"{PUMP}[variants.pump.drive]\nmotor = {{ {text} }}\n")
    variant = ks.load_case(path).variants["pump"]
    speed = np.linspace(0.0, 40.0, 9)
    assert type(variant.motor) is type(motor)
    assert variant.flywheel == 0.0
    assert variant.motor.inertia_at_crank == motor.inertia_at_crank
    np.testing.assert_allclose(variant.motor.torque_at_crank(speed), motor.torque_at_crank(speed), rtol=1e-13)


CSV = "speed [rpm], torque [kN m]\n0, 0.3\n1000, 0.5\n1450, 0.2\n1500, 0\n"


def test_motor_from_csv_converts_its_units(tmp_path):
    (tmp_path / "motor.csv").write_text(CSV)
    text = 'motor = { kind = "table", file = "motor.csv", transmission = -2, inertia = "0.1 kg m^2" }'
    path = case_file(tmp_path, f"{PUMP}[variants.pump.drive]\n{text}\n[variants.still]\n")
    case = ks.load_case(path)
    variant = case.variants["pump"]
    rows = np.array([0.0, 1000.0, 1450.0, 1500.0]) * RPM
    by_hand = Motor.table(rows, [300.0, 500.0, 200.0, 0.0], transmission=-2.0, inertia=0.1)
    speed = np.linspace(0.0, rows[-1], 50)
    np.testing.assert_allclose(variant.motor.torque(speed), by_hand.torque(speed), rtol=1e-13)
    assert variant.motor.inertia_at_crank == by_hand.inertia_at_crank
    assert variant.motor.direction == -1.0
    assert tmp_path / "motor.csv" in variant.files
    assert variant.content == case.variants["still"].content
    assert variant.varied({"slider.mass": 2.0}).motor is variant.motor


@pytest.mark.parametrize(
    ("csv", "text", "message"),
    [
        (None, 'file = "motor.csv"', "motor.csv: cannot be read"),
        ("speed [rpm], torque [N]\n0, 1\n1, 0\n", 'file = "motor.csv"', '"N" does not measure the same as "N m"'),
        ("speed, torque [N m]\n0, 1\n1, 0\n", 'file = "motor.csv"', "has no unit"),
        ("speed [rpm], torque [N m]\n5, 1\n1, 0\n", 'file = "motor.csv"', "speeds must rise"),
        ("speed [rpm], torque [N m]\n5, 1\n", 'file = "motor.csv"', "have the same length, at least 2, got 1 and 1"),
        ("angle [rad], torque [N m]\n5, 1\n", 'file = "motor.csv"', "no column 'speed'"),
        (CSV, 'file = "motor.csv", torque = ["1 N m"]', "has a file and torque: give either rows here or a CSV file"),
        (CSV, 'torque = ["1 N m"]', "needs speed and torque, lists of texts, or file"),
        (CSV, "", "needs speed and torque, lists of texts, or file"),
        (CSV, "file = 3", "drive.motor.file"),
        (CSV, 'file = "../motor.csv"', "cannot be read"),
    ],
)
def test_wrong_motor_files_are_reported_with_the_rest(tmp_path, csv, text, message):
    if csv:
        (tmp_path / "motor.csv").write_text(csv)
    drive = f'[variants.pump.drive]\nmotor = {{ kind = "table"{", " * bool(text)}{text} }}\n'
    found = problems(tmp_path, f'{PUMP}[variants.pump]\n{drive}[variants.other]\ncoupler = {{ mass = "-1 kg" }}\n')
    assert message in "\n".join(found)
    assert "variants.other.coupler.mass" in "\n".join(found)


def test_driven_case_runs_as_in_python(tmp_path):
    variant = ks.load_case(case_file(tmp_path, f"{PUMP}{KLOSS}[variants.pump]\n")).variants["pump"]
    pump = ks.crank_slider(0.05, 0.2, slider=ks.Link(1.0))
    motor = Motor.kloss(750.0, 99.0, synchronous_speed=104.7, overload=2.5)
    by_hand = ks.drive.steady(ks.Scene(pump, 100.0, loads=ks.ProcessForce(-200.0)), motor, 0.05)
    run = ks.drive.steady(variant.scene, variant.motor, variant.flywheel)
    np.testing.assert_allclose(run.speed, by_hand.speed, rtol=1e-13)


def test_variants_share_a_drive_and_change_parts_of_it(tmp_path):
    own = '[variants.heavy.drive]\nflywheel = "2 kg m^2"\n[variants.geared.drive.motor]\ntransmission = 3\n'
    variants = ks.load_case(case_file(tmp_path, f"{PUMP}{KLOSS}[variants.pump]\n{own}")).variants
    found = {name: (item.motor.power, item.motor.transmission, item.flywheel) for name, item in variants.items()}
    assert found == {"pump": (750.0, 1.0, 0.05), "heavy": (750.0, 1.0, 2.0), "geared": (750.0, 3.0, 0.05)}


def test_a_drive_changes_no_design_or_content(tmp_path):
    variants = [
        ks.load_case(case_file(tmp_path, f"{PUMP}{drive}[variants.pump]\n")).variants["pump"] for drive in ("", KLOSS)
    ]
    plain, driven = variants
    assert (plain.motor, plain.flywheel) == (None, 0.0)
    assert driven.units == plain.units
    assert driven.content == plain.content
    assert driven.varied({"slider.mass": 2.0}).motor.power == 750.0
    np.testing.assert_array_equal(driven.solve(9).balancing_torque, plain.solve(9).balancing_torque)


def test_sawframe_drive_is_marked_assumed():
    saw = shipped("sawframe_2r63")
    assert {item.flywheel for item in saw.variants.values()} == {1000.0}
    assert saw.variants["plain"].motor.transmission == 1475 / 320

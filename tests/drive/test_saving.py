"""What balancing saves a drive, by `compare` on machines in periodic running."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import shipped

MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875, inertia=0.4)
SAW = shipped("sawframe_2r63").variants


def running_saw(variant, motor=MOTOR):
    scene = SAW[variant].scene
    loads = (*scene.loads, ks.Torque(-700.0 * (1.0 if motor is None else motor.direction), on="crank"))
    return ks.drive.steady(ks.Scene(scene.mechanism, 33.0, loads=loads[: None if motor else -1]), motor, 1000.0)


@pytest.fixture(scope="module")
def pair():
    return running_saw("plain"), running_saw("cam-cosine")


@pytest.mark.slow
def test_compare_takes_running_and_its_solution_alike(pair):
    compared, of_solutions = ks.compare(*pair), ks.compare(*(run.solution for run in pair))
    assert compared.frame().equals(of_solutions.frame())
    assert compared.energies_per_turn == pytest.approx((1400.0 * math.pi,) * 2, rel=1e-12)


@pytest.mark.slow
def test_all_that_the_drives_take_stands_in_the_table(pair):
    frame = ks.compare(*pair).frame()
    for quantity, name in (
        ("energy per turn, through the air gap", "air_gap_energy_per_turn"),
        ("lost in the rotor per turn, by slip", "rotor_loss_per_turn"),
        ("peak motor torque, at its shaft", "peak_motor_torque"),
        ("rms motor torque, at its shaft", "rms_motor_torque"),
        ("fluctuation, by the mean over time", "fluctuation"),
        ("fluctuation, by the mean of the extremes", "fluctuation_arithmetic"),
    ):
        found = frame.loc[quantity]
        values = [getattr(run, name) for run in pair]
        assert [found["reference"], found["balanced"]] == values
        assert found["ratio"] == pytest.approx(abs(values[0] / values[1]))
        assert found["ratio"] > 1.0
    assert frame.index[0] == "mean |balancing torque|"


def test_the_rms_torque_is_the_mean_over_time(pair):
    run = pair[0]
    fine = ks.drive.steady(run.scene, MOTOR, 1000.0, angles=3600)
    mean = np.sum(fine.motor_torque**2 / fine.speed) / np.sum(1.0 / fine.speed)
    assert run.rms_motor_torque == pytest.approx(math.sqrt(mean), rel=1e-9)


def test_flywheel_for_equal_fluctuation_gives_it(pair):
    compared = ks.compare(*pair)
    reference, balanced = compared.flywheels()
    assert reference == pytest.approx(1000.0, rel=1e-14)
    assert pair[1].with_flywheel(balanced).fluctuation == pytest.approx(pair[0].fluctuation, rel=1e-11)
    assert compared.flywheel_mass_saved(0.8) == pytest.approx((reference - balanced) / 0.64, rel=1e-12)
    both = compared.flywheels(0.02)
    assert [run.with_flywheel(size).fluctuation for run, size in zip(pair, both, strict=True)] == pytest.approx(
        [0.02] * 2, rel=1e-11
    )


@pytest.mark.slow
def test_a_motor_without_air_gap_leaves_its_rows_out():
    linear = ks.drive.Motor.linear(4e3, 40.0)
    frame = ks.compare(running_saw("plain", linear), running_saw("cam-cosine", linear)).frame()
    assert "energy per turn, at the shaft" in frame.index
    assert not frame.index.str.contains("air gap|rotor").any()


def test_textbook_running_is_compared_too():
    compared = ks.compare(running_saw("plain", None), running_saw("cam-cosine", None))
    assert compared.fluctuations[0] > 3.0 * compared.fluctuations[1]
    assert compared.flywheels()[1] < 500.0


def test_mixed_comparison_has_coefficients_alone(pair):
    compared = ks.compare(pair[0], SAW["cam-cosine"].solve())
    assert not hasattr(compared, "flywheels")
    assert compared.mean_torque_ratio > 1.0


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda one, two: ks.compare(one, two).flywheels(0.0), "fluctuation must be greater than 0"),
        (lambda one, two: ks.compare(one, two).flywheels(2.5), "fluctuation must be less than 2"),
        (lambda one, two: ks.compare(one, two).flywheel_mass_saved(0.0), "radius must be greater than 0"),
        (lambda one, two: ks.compare(one, MOTOR), "balanced must be a Solution"),
    ],
)
def test_what_cannot_be_compared_is_refused(pair, call, words):
    with pytest.raises(ks.ParameterError, match=words):
        call(*pair)

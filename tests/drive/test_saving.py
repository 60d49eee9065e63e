"""Energy flow and savings."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from support.case_files import shipped

TURN = 2 * np.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875, inertia=0.4)
SAW = shipped("sawframe_2r63").variants
CUT = ks.ProcessForce(lambda motion: np.where(motion.slider_velocity < 0.0, 8e3, 0.0))
DAMPER = ks.PointDamper(300.0, between=("B", (0.0, 0.3)))


def running(*loads, variant="plain", motor=MOTOR, flywheel=1000.0):
    scene = SAW[variant].scene
    return ks.drive.steady(ks.Scene(scene.mechanism, 33.0, loads=(*scene.loads, *loads)), motor, flywheel, angles=[0.0])


MOTORS = {
    "kloss": MOTOR,
    "backwards": ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=-4.6875),
    "linear": ks.drive.Motor.linear(4e3, 40.0),
}


@pytest.mark.parametrize("motor", MOTORS.values(), ids=MOTORS)
@pytest.mark.parametrize("variant", ["plain", "cam-cosine"])
def test_what_the_motor_gives_arrives_somewhere(variant, motor):
    run = running(DAMPER, ks.ProcessForce(-500.0), ks.Torque(-400.0 * motor.direction, on="crank"), motor=motor)
    flow = run.energy_flow
    assert flow.residual < 1e-14
    assert flow["Torque on 'crank'"] == pytest.approx(400.0 * TURN, rel=1e-13)
    assert flow["ProcessForce on 'slider'"] == 0.0
    assert flow["PointDamper between 'B' and (0, 0.3)"] > 100.0


@pytest.mark.slow
def test_cut_and_rotor_slip_take_their_energies():
    run = running(CUT)
    flow = run.energy_flow
    assert flow["ProcessForce on 'slider'"] == pytest.approx(8e3 * 0.6, rel=1e-12)
    angle = (np.arange(4000) + 0.5) * TURN / 4000
    speed = run.motion(angle)[0]
    air_gap = np.mean(MOTOR.torque(4.6875 * speed) * 157.0 / speed) * TURN
    shaft = np.mean(MOTOR.torque(4.6875 * speed) * 4.6875) * TURN
    assert flow["through the air gap"] == pytest.approx(air_gap, rel=1e-6)
    assert flow["rotor, by slip"] == pytest.approx(air_gap - shaft, rel=1e-4)
    assert run.energy_per_turn == pytest.approx(shaft, rel=1e-6)


@pytest.mark.slow
def test_stored_energy_is_kinetic_and_potential():
    run = running(variant="cam-cosine", motor=MOTOR)
    held = {part.name: part.swing for part in run.energy_flow.parts}
    fine = ks.drive.steady(run.scene, MOTOR, 1000.0, angles=7200)
    assert held["flywheel and rotor"] == pytest.approx(np.ptp(0.5 * run.flywheel * fine.speed**2), rel=1e-5)
    assert held["links"] == pytest.approx(np.ptp(fine.solution.kinetic_energy), rel=1e-5)
    spring = ks.Scene(run.scene.mechanism, 33.0, loads=run.scene.loads[1]).solve(7200)
    assert held["Spring on 'slider'"] == pytest.approx(np.ptp(spring.potential_energy), rel=1e-6)


def test_without_loss_no_energy_flows():
    run = running(motor=ks.drive.Motor.linear(4e3, 40.0))
    assert run.energy_per_turn == 0.0
    assert run.mean_power == 0.0
    assert {part.energy for part in run.energy_flow.parts} == {0.0}
    assert run.rms_power > 1e3


def test_a_load_that_drives_gives_energy_to_the_motor():
    run = running(ks.Torque(500.0, on="crank"))
    assert run.energy_flow["Torque on 'crank'"] == pytest.approx(-500.0 * TURN, rel=1e-13)
    assert run.energy_flow["through the air gap"] < 0.0
    assert run.energy_flow["rotor, by slip"] > 0.0
    assert np.isnan(run.energy_flow.frame()["share [1]"]).all()


def test_loads_of_one_kind_are_numbered():
    run = running(ks.Torque(-300.0, on="crank"), ks.Torque(-200.0, on="crank"))
    frame = run.energy_flow.frame()
    assert frame.loc["Torque on 'crank'", "energy per turn [J]"] == pytest.approx(300.0 * TURN, rel=1e-12)
    assert frame.loc["Torque on 'crank' #2", "share [1]"] == pytest.approx(
        200.0 * TURN / run.air_gap_energy_per_turn, rel=1e-12
    )


@pytest.mark.slow
def test_a_period_of_two_turns_counts_each():
    pulse = ks.Table(np.radians([0.0, 100.0, 200.0, 720.0]), [0.0, 900.0, 0.0, 0.0], period=2 * TURN)
    flow = running(ks.Torque(pulse, on="crank"), CUT).energy_flow
    assert flow["Torque on 'crank'"] == pytest.approx(-900.0 * np.radians(200.0) / 2 / 2, rel=1e-9)
    assert flow["ProcessForce on 'slider'"] == pytest.approx(4800.0, rel=1e-12)


@pytest.mark.slow
def test_parts_are_printed_with_their_units():
    flow = running(CUT).energy_flow
    told = repr(flow).splitlines()
    assert told[0].startswith("<EnergyFlow: energy in a turn of 0.1")
    assert told[0].endswith(" s")
    assert len(told) == 1 + len(flow.parts)
    assert all(line.rstrip(">").endswith((" J", " J stored and returned")) for line in told[1:])


# What balancing saves a drive, by `compare` on machines in periodic running


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


@pytest.mark.slow
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


@pytest.mark.slow
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

"""Periodic running as any solution: speed, powers and the summary of several machines."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import kinetostatics as ks
from kinetostatics.drive.savings import running_table, speed_hint
from support.drives import CUT, DISC_MOTOR, FAN, MOTOR, PUMP, SAW, TURN, saw


def test_speed_and_time_are_integrals():
    run = ks.drive.steady(saw(FAN), MOTOR, 100.0, angles=[0.4, 2.9])
    change = quad(lambda angle: float(np.divide(*run.motion(np.array(angle))[::-1])), 0.4, 2.9, epsrel=1e-13)[0]
    assert change == pytest.approx(run.speed[1] - run.speed[0], rel=1e-11)
    time = quad(lambda angle: 1.0 / float(run.motion(np.array(angle))[0]), 0.4, 2.9, epsrel=1e-13)[0]
    assert time == pytest.approx(run.time[1] - run.time[0], rel=1e-12)


def test_running_works_as_any_solution():
    run = ks.drive.steady(saw(CUT), MOTOR, 1000.0)
    other = ks.drive.steady(saw(CUT), MOTOR, 50.0)
    found = ks.extremes(run.solution, "balancing_torque")
    assert found.range[1] >= run.solution.balancing_torque.max() - 1e-9
    assert ks.compare(run.solution, other.solution).mean_torque_ratio > 1.0
    assert len(run.frame()) == 720
    assert len(run.solution.frame()) == 720


# Powers and energies of a machine in periodic running, against sums over many crank angles


def test_rotor_loss_is_slip_times_air_gap_power():
    run = ks.drive.steady(saw(CUT, FAN), MOTOR, 100.0, angles=4096)
    weight = 1.0 / np.abs(run.speed)
    slip = 1.0 - run.motor_speed / 157.0
    loss = TURN * np.mean(slip * run.motor_torque * 157.0 * weight)
    assert run.rotor_loss_per_turn == pytest.approx(loss, rel=1e-4)
    assert run.peak_power >= np.abs(run.motor_power).max()
    assert run.mean_power == pytest.approx(np.sum(run.motor_power * weight) / np.sum(weight), rel=1e-4)


# The solution of a machine in periodic running


RUN = ks.drive.steady(ks.Scene(SAW, 1.0, loads=ks.Gravity()), MOTOR, 30.0)
FEW = np.array([0.1, 2.0, 9.0])


def test_running_has_its_speed_at_other_angles():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    assert np.array_equal(there.crank_speed, speed)
    assert np.array_equal(there.crank_acceleration, acceleration)
    plain = ks.Scene(SAW, speed, acceleration, ks.Gravity()).solve(FEW)
    assert np.array_equal(there.balancing_torque, plain.balancing_torque)
    one = RUN.solution.at(2.0)
    assert one.balancing_torque == pytest.approx(there.balancing_torque[1], rel=1e-13)


def test_motor_torque_holds_between_the_angles():
    there, (speed, acceleration) = RUN.solution.at(FEW), RUN.motion(FEW)
    given = MOTOR.torque_at_crank(speed) - 30.0 * acceleration
    assert there.balancing_torque == pytest.approx(given, rel=1e-12, abs=1e-12 * np.abs(given).max())


def test_running_repeats_and_prints_its_mean_speed():
    assert RUN.solution.period == RUN.period
    assert repr(RUN.solution).startswith("<RunningSolution")
    assert repr(RUN.solution).endswith(f"mean speed {RUN.mean_speed:.9g} rad/s>")


# What running comes to


KLOSS = ks.drive.Motor.kloss(5e3, 150.0, synchronous_speed=157.0, overload=2.5, transmission=5.0)


def test_machines_stand_side_by_side_with_units():
    scene = ks.Scene(PUMP, 1.0, loads=(ks.Gravity(), ks.Torque(-40.0, on="crank")))
    runs = {"line": ks.drive.steady(scene, DISC_MOTOR, 5.0), "Kloss": ks.drive.steady(scene, KLOSS, 5.0)}
    table = running_table(runs, {"line": None, "Kloss": ks.drive.start(scene, KLOSS, 5.0)})
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
        found = speed_hint(ks.drive.steady(scene, motor, 50.0), scene)
        assert (found is not None and "transmission of the motor, 1, right?" in found) == told

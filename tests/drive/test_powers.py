"""Powers and energies of a machine in periodic running, against sums over many crank angles."""

import numpy as np
import pytest

import kinetostatics as ks
from support.drives import CUT, FAN, MOTOR, TURN, saw


def test_rotor_loss_is_slip_times_air_gap_power():
    run = ks.drive.steady(saw(CUT, FAN), MOTOR, 100.0, angles=4096)
    weight = 1.0 / np.abs(run.speed)
    slip = 1.0 - run.motor_speed / 157.0
    loss = TURN * np.mean(slip * run.motor_torque * 157.0 * weight)
    assert run.rotor_loss_per_turn == pytest.approx(loss, rel=1e-4)
    assert run.peak_power >= np.abs(run.motor_power).max()
    assert run.mean_power == pytest.approx(np.sum(run.motor_power * weight) / np.sum(weight), rel=1e-4)

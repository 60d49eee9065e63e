"""Powers and energies of a machine in periodic running, against sums over many crank angles."""

import math

import numpy as np
import pytest

import kinetostatics as ks

TURN = 2 * math.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
FAN = ks.Torque(lambda motion: -2.0 * motion.crank_speed * motion.crank_speed, on="crank")
CUT = ks.ProcessForce(ks.Table(np.linspace(0.0, TURN, 41)[:-1], 4e3 + 4e3 * np.sin(TURN / 40 * np.arange(40))))


def saw(*loads):
    return ks.Scene(SAW, 33.0, loads=(ks.Gravity(), *loads))


def test_rotor_loss_is_slip_times_air_gap_power():
    run = ks.drive.steady(saw(CUT, FAN), MOTOR, 100.0, angles=4096)
    weight = 1.0 / np.abs(run.speed)
    slip = 1.0 - run.motor_speed / 157.0
    loss = TURN * np.mean(slip * run.motor_torque * 157.0 * weight)
    assert run.rotor_loss_per_turn == pytest.approx(loss, rel=1e-4)
    assert run.peak_power >= np.abs(run.motor_power).max()
    assert run.mean_power == pytest.approx(np.sum(run.motor_power * weight) / np.sum(weight), rel=1e-4)

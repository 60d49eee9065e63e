"""Figures of machines in periodic running."""

import math

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.views import drives

TURN = 2 * math.pi
MOTOR = ks.drive.Motor.kloss(55e3, 153.9, synchronous_speed=157.0, overload=2.5, transmission=4.6875)
SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150.0, 1.0, 20.5), slider=ks.Link(600.0))
CUT = ks.ProcessForce(ks.Table(np.linspace(0.0, TURN, 41)[:-1], 4e3 + 4e3 * np.sin(TURN / 40 * np.arange(40))))


def saw(*loads):
    return ks.Scene(SAW, 33.0, loads=(ks.Gravity(), *loads))


def test_figures_show_speed_and_the_torques_at_the_crank():
    run = ks.drive.steady(saw(CUT), MOTOR, 1000.0)
    speed, torques = run.plot()
    assert speed.get_ylabel() == "crank speed [rad/s]"
    drive, machine = (line.get_ydata() for line in torques.get_lines())
    assert drive[:-1:2].shape == (360,)
    assert machine[:-1] == pytest.approx(run.solution.balancing_torque, abs=1e-6)
    assert drive[:-1] == pytest.approx(MOTOR.transmission * run.motor_torque)


@pytest.mark.parametrize("given", [None, 3, {}, {"saw": None}, {"saw": ks.Scene(ks.crank_slider(0.1, 0.4), 10.0)}])
def test_what_is_no_running_is_refused_in_words(given):
    for figure in (drives.crank_speed, drives.energy_flow, drives.drive_torques):
        with pytest.raises(ks.ParameterError, match=r"runs must be a dict of label to Running, as \{"):
            figure(given)

"""Rivals of periodic running come to the same crank speeds, each to the accuracy of its setting."""

import numpy as np
import pytest

from kinetostatics.studies.methods import running
from support.drives import ANGLES, BY_NAME, IDLE, MOTOR, REFERENCE


@pytest.mark.parametrize(
    ("name", "setting", "error"),
    [
        ("stepping until it repeats, DOP853", 1e-3, 1e-2),
        ("stepping until it repeats, LSODA", 1e-5, 1e-3),
        ("shooting, DOP853", 1e-9, 1e-7),
        ("shooting, fixed steps, RK4", 216, 1e-10),
        ("shooting, fixed steps, RK8", 24, 1e-11),
        ("collocation, SciPy solve_bvp", 1e-7, 1e-6),
        ("collocation, Fourier", 33, 1e-10),
        ("collocation, Fourier", 65, 3e-14),
    ],
)
def test_rivals_come_to_the_same_running(name, setting, error):
    problem = running.Problem(IDLE, MOTOR, 1000.0, ANGLES)
    found = BY_NAME[name].prepare(problem, "", setting)()
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < error


def test_the_secant_rule_finds_what_a_turn_gives_back():
    assert running.shot(lambda energy: 0.25 * energy + 3.0 / energy, 1.0, 1e-15) == pytest.approx(2.0, rel=1e-14)

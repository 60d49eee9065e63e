"""Rivals of periodic running come to the same crank speeds, each to the accuracy of its setting."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.one_dof import DrivenMachine
from kinetostatics.studies.methods import running
from kinetostatics.studies.methods.high_precision.certified import exact_speed
from support.drives import ANGLES, BY_NAME, IDLE, MOTOR, REFERENCE, SAW


@pytest.mark.slow
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
    problem = running.PeriodicRunning(IDLE, MOTOR, 1000.0, ANGLES)
    found = BY_NAME[name].prepare(problem, "", setting)()
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < error


def test_the_secant_rule_finds_what_a_turn_gives_back():
    assert running.periodic_energy(lambda energy: 0.25 * energy + 3.0 / energy, 1.0, 1e-15) == pytest.approx(
        2.0, rel=1e-14
    )


# Running at many digits


CUT = ks.ProcessForce(ks.Table(np.radians([7.0, 20.0, 173.0, 187.0, 340.0]), [0.0, 8e3, 8e3, 0.0, 0.0]))
CUTTING = ks.Scene(SAW, 33.5, loads=(ks.Gravity(), CUT))


@pytest.mark.slow
def test_many_digit_running_equals_the_reference():
    pytest.importorskip("flint")
    found = exact_speed(running.PeriodicRunning(IDLE, MOTOR, 1000.0, ANGLES).driven, ANGLES)
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < 3e-16


@pytest.mark.slow
def test_running_with_kinks_equals_many_digits():
    pytest.importorskip("flint")
    problem = running.PeriodicRunning(CUTTING, MOTOR, 1000.0, ANGLES)
    found = BY_NAME["ours, NumPy"].prepare(problem, "", None)()
    assert np.abs(found / exact_speed(problem.driven, ANGLES) - 1.0).max() < 2e-14


@pytest.mark.slow
def test_loads_that_depend_on_the_speed_are_refused():
    damped = ks.Scene(SAW, 1.0, loads=ks.TorsionDamper(1.0, on="crank"))
    with pytest.raises(ks.errors.NotGivenError, match="do not depend on the speed"):
        exact_speed(DrivenMachine("test", damped, MOTOR, 1.0), ANGLES)

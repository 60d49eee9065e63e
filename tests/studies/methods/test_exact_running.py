"""Running at many digits: that of a reference which shares no formula, and ours where loads have kinks."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.drive.driven import Driven
from kinetostatics.studies.methods import running
from kinetostatics.studies.methods.exact_running import exact_speed
from support.drives import ANGLES, BY_NAME, IDLE, MOTOR, REFERENCE, SAW

pytestmark = pytest.mark.slow

CUT = ks.ProcessForce(ks.Table(np.radians([7.0, 20.0, 173.0, 187.0, 340.0]), [0.0, 8e3, 8e3, 0.0, 0.0]))
CUTTING = ks.Scene(SAW, 33.5, loads=(ks.Gravity(), CUT))


def test_running_at_many_digits_is_that_of_the_reference_which_shares_no_formula():
    pytest.importorskip("flint")
    found = exact_speed(running.Problem(IDLE, MOTOR, 1000.0, ANGLES).driven, ANGLES)
    assert np.abs(found / np.array(REFERENCE["speed"], float) - 1.0).max() < 3e-16


def test_ours_is_running_at_many_digits_with_a_load_that_has_kinks():
    pytest.importorskip("flint")
    problem = running.Problem(CUTTING, MOTOR, 1000.0, ANGLES)
    found = BY_NAME["ours, NumPy"].prepare(problem, "", None)()
    assert np.abs(found / exact_speed(problem.driven, ANGLES) - 1.0).max() < 2e-14


def test_loads_that_depend_on_the_speed_are_refused():
    damped = ks.Scene(SAW, 1.0, loads=ks.TorsionDamper(1.0, on="crank"))
    with pytest.raises(ks.errors.NotGivenError, match="do not depend on the speed"):
        exact_speed(Driven("test", damped, MOTOR, 1.0), ANGLES)

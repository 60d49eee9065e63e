"""What is looked at before a solution is handed out, once for every door that makes one."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.solution.checked import checked

SHORT = ks.Scene(ks.crank_slider(0.3, 0.2, slider=ks.Link(600.0)), 30.0)
RUBBING = ks.Scene(ks.crank_slider(0.3, 2.0, slider=ks.Link(600.0)), 30.0, friction={"guide": ks.GuideFriction(0.1)})
TURN = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)


def test_a_mechanism_that_does_not_close_is_refused_or_left_open():
    with pytest.raises(ks.AssemblyError):
        checked(SHORT.unsolved(TURN))
    assert np.isnan(checked(SHORT.unsolved(TURN), "nan").balancing_torque).any()


def test_friction_is_settled_and_one_that_cannot_slide_refused():
    found = checked(RUBBING.unsolved(TURN))
    np.testing.assert_array_equal(found.balancing_torque, RUBBING.solve(TURN).balancing_torque)
    with pytest.raises(ks.ParameterError, match="crank"):
        checked(ks.Scene(RUBBING.mechanism, 0.0, friction=RUBBING.friction).unsolved(TURN))

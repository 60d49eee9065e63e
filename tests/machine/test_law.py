"""What a law of motion is: called with a crank angle, later by a phase, its knots and its error with it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.law import Law, knots_of

RISING = ks.laws.joined(
    ks.laws.cycloidal(1.7, 2.3, 2.0), ks.laws.dwell(2.3, 0.5), ks.laws.cycloidal(2.3, 1.7, 2 * np.pi - 2.5)
)


def test_a_law_comes_later_by_a_phase():
    assert_allclose(RISING.shifted(0.4)(1.3), RISING(0.9), rtol=0, atol=1e-15)
    assert_allclose(RISING.shifted(0.4).knots, np.add(RISING.knots, 0.4))
    assert_allclose(RISING.shifted(0.4).shifted(-0.4)(1.3), RISING(1.3), rtol=1e-14)


def test_what_is_only_called_has_no_knots_and_no_error():
    class Own(Law):
        def __call__(self, phi):
            return ks.laws.cosine(0.3, 2.0)(phi)

    assert Own().knots == knots_of(np.sin) == ()
    assert Own().shifted(0.1).force_error is None
    assert_allclose(Own().shifted(0.1)(0.5), Own()(0.4), rtol=0, atol=1e-15)


def test_a_law_that_does_not_say_what_it_is_cannot_be_called():
    class Empty(Law):
        pass

    with pytest.raises(TypeError, match="Empty must define __call__"):
        Empty()(0.0)

"""What a law of motion is: called with a crank angle, later by a phase, its knots and its error with it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.law import Law, bends_of, knots_of

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


def test_knots_bend_where_the_acceleration_or_the_jerk_jumps_and_nowhere_else():
    rise, back = ks.laws.harmonic(0.05, 0.07, 2.0), ks.laws.cycloidal(0.07, 0.05, 2.0)
    rest = 2 * np.pi - 5.0
    law = ks.laws.joined(rise, ks.laws.dwell(0.07, 1.0), back, ks.laws.dwell(0.05, rest), smooth="velocity")
    found = bends_of(law)
    assert [round(knot.angle, 12) for knot in found if knot.jumps] == [0.0, 2.0]
    assert [round(knot.angle, 12) for knot in found if not knot.jumps] == [3.0, 5.0]
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    assert bends_of(ks.laws.table(angle, 0.05 + 0.01 * np.cos(angle))) == ()
    assert bends_of(ks.laws.cosine(0.01, 0.05)) == ()

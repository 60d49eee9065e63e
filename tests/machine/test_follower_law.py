"""What a follower takes as its law: laws of the library, functions of the user's own, and what is refused."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import kinetostatics as ks
from kinetostatics.machine.follower_law import FollowerLaw

LAW = ks.laws.cosine(0.02, 0.08, 0.3)


def test_it_gives_a_coordinate_and_two_derivatives_at_any_shape():
    angle = np.array([[0.0, 1.0, 2.0]])
    found = FollowerLaw(LAW).polar(angle, None)
    assert_array_equal(found, LAW(angle)[:3])
    assert [part.shape for part in found] == [(1, 3)] * 3


def test_constants_of_a_function_are_spread_over_the_angles():
    rest = FollowerLaw(lambda phi: (0.1, 0.0, 0.0, 0.0))
    assert_array_equal(rest.radius(np.zeros(3)), [[0.1] * 3, [0.0] * 3, [0.0] * 3])


def test_a_group_made_again_keeps_its_law():
    follower = ks.RollerFollower(LAW)
    assert ks.RollerFollower(follower.cam).cam is follower.cam


WRONG = {
    "a number": (0.1, "must be one of ks.laws"),
    "a cam": (ks.cams.Circle(0.1), "must be one of ks.laws"),
    "a class": (FollowerLaw, "must be one of ks.laws"),
    "three values": (lambda phi: (phi, phi, phi), "must repeat|4 arrays"),
    "not finite": (lambda phi: (np.nan * phi,) * 4, "finite values"),
    "not periodic": (lambda phi: (0.1 + phi, 1 + 0 * phi, 0 * phi, 0 * phi), "must repeat after a turn"),
    "failing": (lambda phi: phi + None, "it fails with"),
}


@pytest.mark.parametrize("kind", [ks.RollerFollower, ks.FlatFollower])
@pytest.mark.parametrize("name", WRONG)
def test_what_is_no_law_is_refused(name, kind):
    law, text = WRONG[name]
    with pytest.raises(ks.ParameterError, match=text):
        kind(law)

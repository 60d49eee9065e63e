"""What a follower takes as its law: laws of the library, functions of the user's own, and what is refused."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.machine.follower_law import FollowerLaw

LAW = ks.laws.cosine(0.02, 0.08, 0.3)


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

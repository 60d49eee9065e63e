"""What all followers have in common: the curvature of the roller's path as seen from the crank."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from kinetostatics.machine.follower import bend
from support.followers import KINDS, LAW, scene

ANGLES = np.linspace(0.1, 6.2, 12)


@pytest.mark.parametrize("kind", [name for name in KINDS if "flat" not in name])
def test_the_path_of_the_roller_centre_bends_as_the_pitch_curve_of_the_disk(kind):
    follower = KINDS[kind]()
    joint = scene(follower).solve(ANGLES).placement.joints["R"]
    place = follower.disk.curve(ANGLES)[0]
    assert_allclose(1.0 / bend(joint), follower.disk.curvature_radius(np.angle(place)), rtol=1e-11)


def test_every_follower_names_its_link_and_says_what_touches_the_cam():
    roller, face = ks.Roller(0.01, 0.02, 210e9, 0.3), ks.Face(0.02, 210e9, 0.3)
    made = (ks.RollerFollower(LAW, roller=roller), ks.FlatFollower(LAW, label="2", face=face))
    for follower, moved, pressed in zip(made, ("follower", "follower2"), (roller, face), strict=True):
        assert tuple(follower.links) == (moved,)
        assert follower.pressed is pressed
        assert moved in follower.outputs["contact_force" + follower.label].text
        assert follower.contacts["contact_pressure" + follower.label].body is pressed
    assert ks.RollerFollower(LAW).contacts == {}

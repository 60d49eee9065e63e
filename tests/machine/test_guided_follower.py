"""What followers on a guide share: the law is their motion, and their torque is that of what acts along the guide."""

import pytest
from numpy.testing import assert_allclose

import kinetostatics as ks
from support.followers import ANGLES, BODY, LAW, scene

every_face = pytest.mark.parametrize("kind", [ks.RollerFollower, ks.FlatFollower])


@every_face
def test_the_follower_moves_by_the_law(kind):
    s = scene(kind(LAW, ks.Guide.at(0.4, 0.01), BODY)).solve(ANGLES)
    law = LAW(ANGLES)
    assert_allclose(s.travel("follower"), law.position, rtol=1e-15)
    assert_allclose(s.travel_velocity("follower"), 12.0 * law.velocity, rtol=1e-14)
    assert_allclose(s.travel_acceleration("follower"), 144.0 * law.acceleration - 30.0 * law.velocity, rtol=1e-13)


@every_face
def test_the_torque_is_that_of_spring_and_inertia_whatever_the_offset(kind):
    law = LAW(ANGLES)
    expected = (2.0 * 144.0 * law.acceleration + 5e3 * (law.position - 0.01)) * law.velocity
    for offset in (0.0, 0.02):
        follower = kind(LAW, ks.Guide.at(0.4, offset), BODY)
        machine = ks.Mechanism("cam drive", ks.Crank(None), (follower,))
        s = ks.solve(machine, ANGLES, crank_speed=12.0, loads=ks.Spring(5e3, 0.01, on="follower"))
        assert_allclose(s.balancing_torque, expected, rtol=1e-13)

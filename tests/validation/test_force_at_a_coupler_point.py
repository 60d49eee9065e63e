"""A force at a coupler point of a four-bar at rest, by hand: instant centre, two- and three-force members.

Crank O-A upright, O = (0, 0), A = (0, 3) m; B = (4, 3), rocker pivot O2 = (6, -1), force (100, -200) N at P = (2, 5) of
the coupler. The lines O-A and O2-B meet at the instant centre I = (0, 11). For a crank rate of 1 the coupler turns
with -3/8, so P moves with -3/8 (6, 2) = (-2.25, -0.75), the force works with -225 + 150 = -75 W, and the crank needs
75 N m. The rocker is a two-force member along (-1, 2): moments of the coupler about A, -600 + 8 k = 0, give k = 75.
"""

import numpy as np
import pytest

import kinetostatics as ks


@pytest.fixture
def at_rest():
    four_bar = ks.four_bar(3.0, 4.0, np.sqrt(20.0), rocker_pivot=(6.0, -1.0))
    force = ks.Force(np.hypot(100.0, 200.0), at=("coupler", 2.0, 2.0), direction=np.arctan2(-200.0, 100.0))
    return ks.solve(four_bar, np.pi / 2, crank_speed=0.0, loads=force)


def test_the_pin_is_where_it_is_drawn(at_rest):
    assert at_rest.position("B") == pytest.approx((4.0, 3.0), rel=1e-14)


def test_torque_is_virtual_work_at_instant_centre(at_rest):
    assert float(at_rest.balancing_torque) == pytest.approx(75.0, rel=1e-13)


@pytest.mark.parametrize(
    ("joint", "force"), {"A": (-25, 50), "B": (75, -150), "O2": (-75, 150), "O": (-25, 50)}.items()
)
def test_reactions_are_two_and_three_force_members(at_rest, joint, force):
    assert at_rest.reaction(joint) == pytest.approx(force, rel=1e-12)

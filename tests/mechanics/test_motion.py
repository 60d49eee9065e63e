"""Motion: velocities and accelerations of any point are differences of positions in time."""

import numpy as np
import pytest

import kinetostatics as ks

SPEED, ACCELERATION, STEP = 4.0, -7.0, 1e-4
SAW = ks.crank_slider(0.3, 0.8, guide_angle=0.2, guide_offset=0.05, coupler=ks.Link(1.0, (0.3, 0.1)))
TURN = np.linspace(0.1, 6.2, 11)


def at(time):
    """Crank angles after a time in which the crank speed grows."""
    return ks.solve(SAW, TURN + SPEED * time + 0.5 * ACCELERATION * time**2, crank_speed=SPEED)


@pytest.mark.parametrize("point", ["A", "B", "coupler", ("coupler", 0.5, -0.2), (1.0, 2.0)])
def test_a_point_moves_as_its_positions_in_time_differ(point):
    before, now, after = (at(time).position(point) for time in (-STEP, 0.0, STEP))
    s = ks.solve(SAW, TURN, crank_speed=SPEED, crank_acceleration=ACCELERATION)
    assert s.velocity(point) == pytest.approx((after - before) / (2 * STEP), abs=1e-5)
    assert s.acceleration(point) == pytest.approx((after - 2 * now + before) / STEP**2, abs=1e-4)


def test_a_point_that_is_not_there_is_answered_with_those_that_are():
    with pytest.raises(ks.QuantityError, match="'Q'"):
        at(0.0).position("Q")

"""Where sampled values turn: once at level stretches and ends, not where rounding does."""

import numpy as np
import pytest

import kinetostatics as ks

SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def loaded(force):
    return ks.solve(SAW, [0.0], crank_speed=33.5, loads=[ks.ProcessForce(force)])


def test_extremes_at_a_jump_and_at_the_seam_of_the_turn_are_those_of_the_samples():
    ramp = ks.extremes(loaded(lambda motion: -3e4 * np.mod(motion.crank_angle / (2 * np.pi), 1.0)), "B")
    assert np.all(np.isfinite(ramp.value))
    assert ramp.range[1] == pytest.approx(600 * 33.5**2 * 0.3 * 1.15, rel=1e-12)
    step = ks.extremes(loaded(lambda motion: np.where(np.mod(motion.crank_angle, 2 * np.pi) < np.pi, -3e4, 0.0)), "B")
    assert np.all(np.isfinite(step.angle))
    assert np.all(np.isfinite(step.value))


def test_rounding_of_terms_that_cancel_is_no_extremum():
    law = ks.cams.CosineLaw(0.3, 2.0)
    balanced = ks.solve(
        ks.cam_crank_slider(law, law.coupler_length, slider=ks.Link(600)),
        [0.0],
        crank_speed=33.5,
        loads=[ks.Spring.balancing(600, 33.5, 2.0)],
    )
    assert len(ks.extremes(balanced, "balancing_torque")) == 0
    assert np.all(np.isnan(ks.compare(loaded(0.0), balanced).torque_extremum_ratios))


@pytest.mark.parametrize(
    "wave", [lambda s: 1 + 1e-12 * np.cos(s.crank_angle), lambda s: np.round(10 * np.cos(s.crank_angle))]
)
def test_ripples_and_treads_are_no_extrema(wave):
    assert list(ks.extremes(loaded(0.0), wave).maximum) in ([True, False], [False, True])

"""Where sampled values turn: once at level stretches and ends, not where rounding does."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.turning_points import Path, turning_points

SAW = ks.crank_slider(0.3, 2.0, coupler=ks.Link(150, 1.0, 20.5), slider=ks.Link(600))


def loaded(force):
    return ks.solve(SAW, [0.0], crank_speed=33.5, loads=[ks.ProcessForce(force)])


def turns(values, floor=1e-9, period=0.0):
    values = np.asarray(values, dtype=float)
    count = values.size
    angle = np.arange(count) * (period / count if period else 1.0)
    brackets, value, _, maximum = turning_points(Path(angle, values, np.full(count, floor), period))
    return brackets[1].tolist(), value.tolist(), maximum.tolist()


def test_ends_of_an_open_path_are_extrema_and_a_level_stretch_counts_once():
    assert turns([0, 2, 2, 2, 1]) == ([0.0, 2.0, 4.0], [0.0, 2.0, 1.0], [False, True, False])


def test_a_periodic_path_has_none_at_its_ends():
    angle, value, maximum = turns([1, 0, -1, 0], period=4.0)
    assert (angle, value, maximum) == ([2.0, 4.0], [-1.0, 1.0], [False, True])


def test_rises_within_rounding_are_taken_out_least_first():
    assert turns([0, 5, 4.9, 6, 0], floor=0.2) == ([0.0, 3.0, 4.0], [0.0, 6.0, 0.0], [False, True, False])
    assert len(turns([0, 5, 4.9, 6, 0], floor=0.05)[0]) == 5


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

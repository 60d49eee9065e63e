"""The turn that results are reduced over: period, gaps, and what repeats."""

import itertools

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.turn import Turn, repeating_problem, require_single, runs
from support import sweeping as spikes
from support.every import every

PUMP = ks.crank_slider(0.1, 0.4)


def solved(mechanism=PUMP, *loads):
    return ks.solve(mechanism, np.zeros(1), crank_speed=1.0, loads=loads, on_gap="nan")


def test_a_turn_is_sampled_over_its_period_and_closes():
    turn = Turn.of(solved())
    assert turn.period == 2 * np.pi
    assert 0.0 <= turn.angle[0] < turn.angle[-1] < 2 * np.pi
    assert turn.usable.all()
    assert turn.gaps == ()


def test_a_mechanism_that_does_not_close_has_its_gaps_and_samples_beside_them():
    turn = Turn.of(solved(ks.crank_slider(0.4, 0.3)))
    assert [tuple(np.sin(gap)) for gap in turn.gaps] == [pytest.approx((s * 0.75, s * 0.75)) for s in (1, -1)]
    for edge in turn.limits:
        assert np.abs(turn.angle - edge % (2 * np.pi)).min() < 1e-9


@pytest.mark.parametrize(
    ("marked", "expected"),
    [([0, 1, 1, 0], [[1, 2]]), ([1, 0, 0, 1], [[3, 0]]), ([0, 0], []), ([1, 0, 1, 0], [[2], [0]])],
)
def test_runs_go_around_the_turn(marked, expected):
    found = [run.tolist() for run in runs(np.array(marked, dtype=bool))]
    assert sorted(found) == sorted(expected)


def test_forces_that_do_not_repeat_and_batches_are_told():
    assert repeating_problem(solved(PUMP, ks.ProcessForce(lambda motion: np.sin(motion.crank_angle)))) is None
    assert repeating_problem(solved(PUMP, ks.ProcessForce(lambda motion: motion.crank_angle)))
    with pytest.raises(ks.ParameterError, match="one design at a time"):
        require_single(solved(ks.crank_slider(np.full((2, 1), 0.1), 0.4)), "extremes", "O")


def test_every_kink_of_a_table_is_a_sample_with_others_between():
    table = ks.Table([0.2, 0.4, 0.4000001, 0.4000003, 0.6], [0.0, 0.0, 1.0, 0.0, 0.0], over="travel")
    turn = Turn.of(solved(PUMP, ks.ProcessForce(table)))
    assert turn.kinks.size == 8
    assert np.isin(turn.kinks, turn.angle).all()
    for kink, following in itertools.pairwise(turn.kinks):
        assert np.sum((turn.angle > kink) & (turn.angle < following)) >= 3


@every("seed", [2, 6, 16])
def test_no_extremum_hides_between_kinks_nearer_than_samples(seed):
    scene = spikes.spiky(seed)
    for name in ("balancing_torque", "O"):
        low, high = spikes.ends(scene, name)
        found, size = ks.extremes(scene.solve(13), name).range, max(abs(low), abs(high))
        assert high - 1e-9 * size <= found[1] < high + 1e-7 * size
        assert low - 2e-3 * size < found[0] <= low + 1e-9 * size  # few angles stand where a reaction is least

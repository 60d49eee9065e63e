"""The turn that results are reduced over: period, gaps, and what repeats."""

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.results.turn import Turn, repeating_problem, require_single, runs

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

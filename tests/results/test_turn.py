"""The turn that results are reduced over: period, gaps, and what repeats."""

import itertools

import numpy as np

import kinetostatics as ks
from kinetostatics.results.turn import Turn
from support import sweeping as spikes
from support.every import every

PUMP = ks.crank_slider(0.1, 0.4)


def solved(mechanism=PUMP, *loads):
    return ks.solve(mechanism, np.zeros(1), crank_speed=1.0, loads=loads, on_gap="nan")


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

"""Where sliders stand still and pass places: all of it, for each of many designs."""

from types import SimpleNamespace

import numpy as np

import kinetostatics as ks
from kinetostatics.machine.loads.table_pieces import SAMPLE_OFFSET, STOP_SAMPLES, TURN, stops_and_crossings
from support.every import every


def motion(crank=0.05, offset=0.01):
    return ks.solve(ks.crank_slider(crank, 0.19, guide_offset=offset), np.zeros(1), crank_speed=1.0, on_gap="nan")


def travel(solved, angle):
    return solved.mechanism.place(angle).travels["slider"]


def test_levels_are_passed_twice_a_turn():
    solved, levels = motion(), np.linspace(0.15, 0.22, 7)
    stops, passed = stops_and_crossings(solved, "slider", levels)
    assert stops.shape == (1, 2)
    assert passed.shape == (1, 14)
    assert np.abs(travel(solved, stops).first).max() < 1e-15
    np.testing.assert_allclose(np.sort(travel(solved, passed).position[0]), np.repeat(levels, 2), rtol=0, atol=1e-15)


def test_level_near_a_stop_is_passed_to_and_fro():
    solved = motion()
    stops, _ = stops_and_crossings(solved, "slider", np.array([0.2]))
    farthest = travel(solved, stops).position.max()
    for depth in (1e-5, 1e-9, 1e-13):
        _, passed = stops_and_crossings(solved, "slider", np.array([farthest - depth]))
        assert passed.shape == (1, 2)
        np.testing.assert_allclose(travel(solved, passed).position, farthest - depth, rtol=0, atol=1e-16)


def test_designs_pass_the_levels_in_their_stroke():
    crank = np.array([[0.01], [0.03], [0.05]])
    levels = np.linspace(0.14, 0.24, 11)
    stops, passed = stops_and_crossings(motion(crank), "slider", levels)
    assert stops.shape == (3, 2)
    for row, length in enumerate(crank[:, 0]):
        alone = np.sort(stops_and_crossings(motion(length), "slider", levels)[1][0])
        np.testing.assert_allclose(np.sort(passed[row])[: alone.size], alone, rtol=0, atol=1e-14)
        assert np.isnan(np.sort(passed[row])[alone.size :]).all()


@every("way", [1, -1])
def test_stop_exactly_at_a_sample_is_found(way):
    stop = (SAMPLE_OFFSET + np.linspace(0.0, TURN, STOP_SAMPLES + 1))[100]

    def place(angle):
        cosine, sine = (way * part(angle - stop) for part in (np.cos, np.sin))
        return SimpleNamespace(travels={"slider": SimpleNamespace(position=cosine, first=-sine, second=-cosine)})

    stops, _ = stops_and_crossings(
        SimpleNamespace(mechanism=SimpleNamespace(turns=1, place=place)), "slider", np.zeros(1)
    )
    np.testing.assert_allclose(np.sort(stops[0]), np.sort(np.mod([stop, stop + np.pi], TURN)), rtol=0, atol=1e-12)


def test_what_does_not_close_passes_nothing_there():
    stops, passed = stops_and_crossings(motion(0.25, 0.0), "slider", np.array([0.3]))
    assert np.isfinite(passed).sum() == 2
    assert np.isfinite(stops).sum() <= 2

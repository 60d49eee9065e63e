"""Compiled loops: gaps, limit positions and threads change no word and no bit."""

import warnings
from time import perf_counter

import numpy as np
import pytest

import kinetostatics as ks
from kinetostatics.engines import numba_backend
from kinetostatics.engines.program import program_of
from support.both_engines import ULP, again, assert_same
from support.scenes import (
    ANGLES,
    SAMPLES,
    SCENES,
    SIZES,
    solve,
)


def test_machine_code_gives_the_same_on_one_thread_and_on_several(numba, monkeypatch):
    """Of many designs each thread takes some, of a single one some angles."""
    expected = solve(SCENES["plain"], SAMPLES + SIZES), solve(SCENES["plain"], ANGLES)
    alone = [again(s).reaction("O") for s in expected]
    monkeypatch.setattr(numba_backend, "core_count", lambda: 3)
    monkeypatch.setattr(numba_backend, "VALUES_A_THREAD", 20)
    for s, before in zip(expected, alone, strict=True):
        found = again(s).reaction("O")
        assert np.array_equal(found, before)
        assert np.abs(found - s.reaction("O")).max() <= 8 * ULP * np.abs(before).max()


def test_parameters_stand_in_a_row_for_each_design():
    numbers = 1.0, np.array([[2.0], [3.0]]), np.array([4.0]), 5
    assert numba_backend.parameter_table(numbers, (2,)).tolist() == [[1, 2, 4, 5], [1, 3, 4, 5]]
    assert numba_backend.parameter_table((1.0, np.float64(2.0)), ()).tolist() == [[1, 2]]
    assert (
        numba_backend.parameter_table((1.0, np.array([[[6.0]], [[7.0]]])), (2, 3)).tolist()
        == [[1, 6]] * 3 + [[1, 7]] * 3
    )


def test_a_row_of_a_table_for_one_design_may_have_an_axis_of_designs():
    rows = [np.arange(3.0)[None], 7.0, np.arange(3.0)]
    expected = [[[0.0, 1.0, 2.0]], [[7.0] * 3], [[0.0, 1.0, 2.0]]]
    for shape in ((3,), (1, 3), (1, 1, 3), (5, 3)):
        np.testing.assert_array_equal(numba_backend.row_table(rows, shape), expected)


def test_memory_begins_where_vectors_are_loaded_at_once():
    held = [numba_backend.aligned_memory(count, 3, 8) for count in (1, 2, 5)]
    assert [part.shape for part in held] == [(1, 3, 8), (2, 3, 8), (5, 3, 8)]
    assert [part.ctypes.data % 64 for part in held] == [0, 0, 0]


def too_short(engine, **options):
    mechanism = ks.crank_slider(0.3, 0.25, slider=ks.Link(1.0))
    return ks.solve(mechanism, ANGLES, crank_speed=3.0, engine=engine, **options)


def test_gaps_are_refused_with_the_same_words_or_left_open(interpreted):
    messages = []
    for engine in ("numpy", "compiled"):
        with pytest.raises(ks.AssemblyError) as caught:
            too_short(engine)
        messages.append((str(caught.value), caught.value.intervals))
    assert messages[0] == messages[1]
    assert_same(too_short("compiled", on_gap="nan"), too_short("numpy", on_gap="nan"))


def test_a_limit_position_is_warned_of_with_the_same_words_from_the_same_place(interpreted):
    found = []
    for engine in ("numpy", "compiled"):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ks.solve(ks.crank_slider(0.3, 0.3), [0.2, np.pi / 2], crank_speed=1.0, engine=engine)
        found.append([(item.category, str(item.message), item.filename) for item in caught])
    assert found[0] == found[1]
    assert [(kind, file) for kind, _, file in found[0]] == [(ks.ConditionWarning, __file__)]


@pytest.mark.slow
def test_loops_of_many_outputs_are_vectorised(numba):
    state = ks.load_case("sawframe_2r63").variants["plain"].scene.solve(np.linspace(0.0, 6.0, 3600)).dynamics
    values, leaves = program_of(state, ("O", "A", "B", "guide"))
    bounded = values.bounded()
    assert len(bounded.outputs) > 12
    times = {of: min(seconds(of, state, leaves) for _ in range(20)) for of in (values, bounded)}
    assert times[bounded] < 8.0 * times[values]  # fifteen times, if they are not


def seconds(program, state, leaves):
    begun = perf_counter()
    program.run(state, leaves, compiled=True)
    return perf_counter() - begun

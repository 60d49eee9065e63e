"""What was computed of the last crank angles is not computed again."""

import threading

import numpy as np
import pytest

from kinetostatics.engines import recent


@pytest.fixture
def counted():
    calls = []

    @recent.keep_for_same_angles
    def compute(angle):
        calls.append(angle.size)
        return np.sin(angle)

    return compute, calls


def test_equal_angles_are_computed_once_and_others_anew(counted):
    compute, calls = counted
    angle = np.linspace(0.0, 1.0, 5)
    first = compute(angle)
    assert compute(angle.copy()) is first
    assert np.array_equal(compute(angle + 1.0), np.sin(angle + 1.0))
    angle[0] = 9.0
    assert compute(angle)[0] == np.sin(9.0)
    assert calls == [5, 5, 5]


def test_the_same_numbers_in_another_shape_are_others(counted):
    compute, calls = counted
    assert compute(np.zeros(4)).shape == (4,)
    assert compute(np.zeros((2, 2))).shape == (2, 2)
    assert calls == [4, 4]


def test_too_many_are_not_kept_each_thread_has_its_own_and_all_may_be_forgotten(counted):
    compute, calls = counted
    for _ in range(2):
        compute(np.zeros(recent.MAX_KEPT_ANGLES + 1))
    compute(np.zeros(3))
    thread = threading.Thread(target=compute, args=(np.zeros(3),))
    thread.start()
    thread.join()
    recent.forget_angles()
    compute(np.zeros(3))
    assert calls == [recent.MAX_KEPT_ANGLES + 1] * 2 + [3] * 3

"""Which way a crank turns, whatever numbers tell it."""

import numpy as np
import pytest

from kinetostatics.errors import ParameterError
from kinetostatics.machine.sense import require_sense, sense_of, stands


class Rest:
    """A crank by its speed, acceleration and sense."""

    def __init__(self, crank_speed, crank_acceleration=0.0, sense=None):
        self.crank_speed, self.crank_acceleration, self.sense = crank_speed, crank_acceleration, sense


def test_the_speed_counts_before_the_acceleration_and_a_zero_has_no_sign():
    assert sense_of(-1e-150, 1e3) == -1.0
    assert sense_of(0.0, -1e-300) == -1.0
    assert sense_of(-0.0, 0.0) == 1.0
    assert sense_of(np.array([2.0, 0.0, -0.0]), np.array([-9.0, -9.0, 9.0])).tolist() == [1.0, -1.0, 1.0]


def test_a_crank_that_neither_turns_nor_begins_to_is_refused_by_design():
    assert not stands(Rest(0.0, sense=-1))
    assert stands(Rest(np.array([1.0, 0.0]))).tolist() == [False, True]
    with pytest.raises(ParameterError, match=r"a brake, but .* both 0: give sense=\+1 or sense=-1") as refused:
        require_sense("a brake", Rest(np.array([[1.0], [0.0]])))
    assert refused.value.designs.tolist() == [False, True]
